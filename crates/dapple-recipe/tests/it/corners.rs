//! Tests of bakes with samples on corners, as terrain heights need them.

use crate::bakes::{ALL_NODES, bake, crop, options, plan};
use dapple_raster::FieldExt as _;
use dapple_raster::glam::DVec2;
use dapple_recipe::{Bake, BakeOptions, MapKind, MapRows, Plan, Region, Samples};

fn corners(size: [u32; 2]) -> BakeOptions {
    BakeOptions {
        samples: Samples::Corners,
        ..options(size)
    }
}

/// Returns a plan of cells on a tile of 4 × 3 units that repeats along the axes of `wrap`.
fn cells(wrap: [bool; 2]) -> Plan {
    plan(&format!(
        "dapple = 1\nextent = [4.0, 3.0]\nwrap = {wrap:?}\nnodes.cells.worley.frequency = 2.0\n\
         [material]\nheight = \"cells\"\nrelief = 0.2\n"
    ))
}

fn heights(plan: &Plan, size: [u32; 2]) -> Vec<f32> {
    let options = BakeOptions {
        maps: vec![MapKind::Height],
        ..corners(size)
    };
    let bits = bake(plan, &options).swap_remove(0);
    bits.into_iter().map(f32::from_bits).collect()
}

#[test]
fn samples_on_corners_are_those_of_the_field_there() {
    // The steps of 1/8 unit are exact.
    for wrap in [[true; 2], [false; 2], [true, false]] {
        let plan = cells(wrap);
        let field = plan.height().unwrap();
        let heights = heights(&plan, [33, 25]);
        for row in 0..25_u32 {
            for column in 0..33_u32 {
                let corner = DVec2::new(f64::from(column), f64::from(row)) / 8.0;
                let [value, right] = [heights[(row * 33 + column) as usize], field.sample(corner)];
                assert_eq!(value.to_bits(), right.to_bits(), "{wrap:?} {column} {row}");
            }
        }
    }
}

#[test]
fn the_last_samples_equal_the_first_along_axes_that_repeat() {
    // The steps are not exact in binary.
    let size = [31, 24];
    for wrap in [[true; 2], [true, false], [false, true]] {
        let text = format!("wrap = {wrap:?}\n{ALL_NODES}");
        let maps = bake(&plan(&text), &corners(size));
        let part = |map: &Vec<u32>, first, part| crop(map, size, Region { first, size: part });
        for (map, kind) in maps.iter().zip(MapKind::ALL) {
            let columns = [0, size[0] - 1].map(|x| part(map, [x, 0], [1, size[1]]));
            let rows = [0, size[1] - 1].map(|y| part(map, [0, y], [size[0], 1]));
            assert_eq!(columns[0] == columns[1], wrap[0], "{kind:?} {wrap:?}");
            assert_eq!(rows[0] == rows[1], wrap[1], "{kind:?} {wrap:?}");
        }
    }
    // The copy is what the field has at the other side but for the rounding of positions.
    let plan = cells([true; 2]);
    let (heights, field) = (heights(&plan, size), plan.height().unwrap());
    for row in 0..23 {
        let y = 3.0 * f64::from(row) / 23.0;
        let right = field.sample(DVec2::new(4.0, y));
        let value = heights[row as usize * 31 + 30];
        // Cells are compared in steps of 2^-21 of a cell.
        assert!((value - right).abs() < 1e-5, "{value} {right}");
    }
}

#[test]
fn neighboring_regions_share_their_border_samples() {
    let plan = plan(ALL_NODES);
    let size = [65, 49];
    let whole = bake(&plan, &corners(size));
    let of = |first, size_of_part| {
        let region = Region {
            first,
            size: size_of_part,
        };
        let options = BakeOptions {
            region: Some(region),
            band_pixels: 100,
            ..corners(size)
        };
        (region, bake(&plan, &options))
    };
    for (first, part) in [
        ([0, 0], [33, 25]),
        ([32, 0], [33, 25]),
        ([0, 24], [33, 25]),
        ([32, 24], [33, 25]),
        ([64, 0], [1, 49]),
        ([0, 48], [65, 1]),
        ([64, 48], [1, 1]),
    ] {
        let (region, maps) = of(first, part);
        for (map, whole) in maps.iter().zip(&whole) {
            assert_eq!(*map, crop(whole, size, region), "{region:?}");
        }
    }
}

#[test]
fn nodes_that_see_the_whole_tile_have_its_distinct_samples() {
    // Four copies of 8 samples each; on corners a last one is added.
    let text = "dapple = 1\nextent = [4.0, 4.0]\n\
        nodes.cells.worley.frequency = 2.0\n\
        nodes.copies = { disturb = { input = \"cells\", copies = [4, 4], frozen = 1, margin = 2 } }\n\
        nodes.moved = { warp = { input = \"copies\", x = 0.5, y = 0.0, amount = 1.0 } }\n\
        [material]\nheight = \"copies\"\nroughness = \"moved\"\n";
    let size = [33, 33];
    let maps = bake(
        &plan(text),
        &BakeOptions {
            maps: vec![MapKind::Height, MapKind::Roughness],
            ..corners(size)
        },
    );
    let number = |map: usize, x: usize, y: usize| f32::from_bits(maps[map][y * 33 + x]);
    let field = plan(text).field("cells").unwrap();
    for copy in [0, 8, 16, 24, 32] {
        // The corner of a copy is unchanged: it is the corner of the input.
        assert_eq!(number(0, copy, copy), field.sample(DVec2::ZERO));
    }
    for x in 0..29 {
        // Half a unit is four samples.
        let [moved, there] = [number(1, x, 5), number(0, x + 4, 5)];
        // The interpolation between equal positions rounds.
        assert!((moved - there).abs() < 1e-6, "{x}: {moved} {there}");
    }
}

#[test]
fn slopes_are_those_of_the_distances_of_corners() {
    let plan = plan(
        "dapple = 1\nextent = [4.0, 3.0]\nwrap = [false, false]\n\
         nodes.plane = { coordinate = { along = [0.25, 0.0] } }\n\
         [material]\nheight = \"plane\"\nrelief = 2.0\n",
    );
    let options = BakeOptions {
        maps: vec![MapKind::Normal],
        ..corners([5, 4])
    };
    let maps = Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
    let [(_, MapRows::Normal(normals))] = &maps[..] else {
        panic!("{maps:?}");
    };
    // The height rises by 0.25 · 2 for each unit.
    let right = DVec2::new(-0.5, 1.0).normalize();
    for normal in normals.pixels() {
        let [x, _, z] = normal.to_array().map(f64::from);
        // Normals are rounded to f32.
        assert!((x - right.x).abs() < 1e-6 && (z - right.y).abs() < 1e-6);
    }
}

#[test]
fn a_single_corner_is_refused() {
    let error = Bake::new(&cells([true; 2]), &corners([1, 5])).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("corners") && message.contains("at least 2"),
        "{message}"
    );
}
