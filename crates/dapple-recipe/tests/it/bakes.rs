//! Tests of bakes: bands, regions, threads and neighborhoods of pixels.

use dapple_color::{ColorRamp, LinearRgb, RampSpace};
use dapple_raster::FieldExt;
use dapple_raster::{Raster, Wrap};
use dapple_recipe::{
    Bake, BakeMemory, BakeOptions, Images, MapKind, MapRows, Picture, Plan, Recipe,
    RecipeErrorKind, Region,
};
use std::sync::Arc;

pub(crate) const ALL_NODES: &str = r##"
dapple = 1
seed = 7
extent = [4.0, 3.0]

[nodes]
shifted = { warp = { input = "cells", x = "bumps", y = 0.25, amount = 0.3 } }
sum = { add = ["shifted", 0.1, "band"] }
product = { multiply = ["sum", "fine"] }
ratio = { divide = ["product", "cells"] }
least = { minimum = ["ratio", "patches"] }
most = { maximum = ["least", "far"] }
rest = { subtract = ["most", "along"] }
size = { absolute = "rest" }
squared = { power = { input = "size", exponent = 2.0 } }
rings = { wave = { input = "far", frequency = 3.0, form = "triangle" } }
flat = { levels = { input = "squared", from = [0.0, 2.0], curve = "smooth" } }
bump = { profile = { input = "cells", shape = { spots = { radius = 0.5 } } } }
height = { mix = { from = "flat", to = "bump", by = "rings" } }
colors = { ramp = { input = "height", colors = ["#102030", "#f0e0c0"] } }
both = { mix = { from = "colors", to = "#ff0000", by = "patches" } }
layered = { blend = { layers = [{ input = "both" }, { input = "noise_colors", weight = "rings" }] } }
noise_colors = { pups = { color_noise = { spacing = 0.5 } } }

[nodes.cells.worley]
frequency = 2.0

[nodes.fine.worley]
frequency = 3.0
value = "cell_value"

[nodes.bumps.wavelet]
frequency = 4.0

[nodes.band.noise]
frequency = 2.0
octaves = 2

[nodes.patches.pups.cow]
spacing = 0.4

[nodes.far.distance]
center = [1.0, 2.5]

[nodes.along.coordinate]
along = [0.25, 0.0]

[material]
height = "height"
albedo = "layered"
roughness = "rings"
metallic = "patches"
emission = "colors"
opacity = "rings"
specular = "patches"
clearcoat = "rings"
"##;

pub(crate) fn plan(text: &str) -> Plan {
    let recipe = Recipe::from_toml(text).unwrap_or_else(|error| panic!("{error}"));
    Plan::new(&recipe, &Images::new(), 0.0).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns all baked maps, each as the bits of its numbers, row by row.
pub(crate) fn bake(plan: &Plan, options: &BakeOptions) -> Vec<Vec<u32>> {
    let mut maps = vec![Vec::new(); options.maps.len()];
    for band in Bake::new(plan, options).unwrap() {
        for (bits, (_, rows)) in maps.iter_mut().zip(band.unwrap().maps) {
            match rows {
                MapRows::Gray(raster) => {
                    bits.extend(raster.pixels().iter().map(|value| value.to_bits()));
                }
                MapRows::Color(raster) => {
                    bits.extend(
                        raster
                            .pixels()
                            .iter()
                            .flat_map(|color| color.to_array().map(f32::to_bits)),
                    );
                }
                MapRows::Normal(raster) => {
                    bits.extend(
                        raster
                            .pixels()
                            .iter()
                            .flat_map(|normal| normal.to_array().map(f32::to_bits)),
                    );
                }
                MapRows::Packed(raster) => {
                    bits.extend(raster.pixels().iter().flatten().map(|part| part.to_bits()));
                }
            }
        }
    }
    maps
}

pub(crate) fn options(size: [u32; 2]) -> BakeOptions {
    BakeOptions {
        size,
        maps: MapKind::ALL.to_vec(),
        ..BakeOptions::default()
    }
}

/// Returns a region of a map. `map` holds all numbers of the pixels; `[width, height]` is the size of the map in
/// pixels.
pub(crate) fn crop(map: &[u32], [width, height]: [u32; 2], region: Region) -> Vec<u32> {
    let numbers = map.len() / (width * height) as usize;
    let row = |row: u32| {
        let first = (row * width + region.first[0]) as usize * numbers;
        map[first..first + region.size[0] as usize * numbers].to_vec()
    };
    (region.first[1]..region.first[1] + region.size[1])
        .flat_map(row)
        .collect()
}

/// Checks that a region of a bake equals a crop of the whole map, and that a bake in bands equals it, too.
pub(crate) fn assert_parts_have_the_bits_of_the_whole(plan: &Plan, size: [u32; 2], region: Region) {
    let whole = bake(plan, &options(size));
    let part = BakeOptions {
        region: Some(region),
        ..options(size)
    };
    let cropped: Vec<_> = whole.iter().map(|map| crop(map, size, region)).collect();
    assert!(cropped == bake(plan, &part), "a region");
    let banded = BakeOptions {
        memory: BakeMemory::Banded,
        ..options(size)
    };
    assert!(whole == bake(plan, &banded), "bands");
}

#[test]
fn a_region_is_the_crop_of_the_whole_bit_for_bit() {
    let plan = plan(ALL_NODES);
    for size in [[96, 72], [97, 71]] {
        let whole = bake(&plan, &options(size));
        for region in [
            Region {
                first: [0, 0],
                size: [13, 9],
            },
            Region {
                first: [40, 31],
                size: [56, 40],
            },
            Region {
                first: [size[0] - 1, size[1] - 1],
                size: [1, 1],
            },
        ] {
            let part = bake(
                &plan,
                &BakeOptions {
                    region: Some(region),
                    ..options(size)
                },
            );
            for ((map, whole), part) in MapKind::ALL.iter().zip(&whole).zip(&part) {
                assert!(
                    crop(whole, size, region) == *part,
                    "{map:?} of {region:?} in {size:?}"
                );
            }
        }
    }
}

#[test]
fn a_wide_bake_in_many_bands_has_the_bits_of_its_regions() {
    // More than the pixels of a band, so that there are several.
    let (size, plan) = ([4_000, 60], plan(ALL_NODES));
    let maps = vec![MapKind::Normal, MapKind::Occlusion, MapKind::Roughness];
    let wide = BakeOptions {
        size,
        maps,
        memory: BakeMemory::Banded,
        band_pixels: 1 << 16,
        ..BakeOptions::default()
    };
    assert!(
        Bake::new(&plan, &wide).unwrap().count() > 1,
        "several bands"
    );
    let region = Region {
        first: [3_900, 0],
        size: [100, 60],
    };
    let whole = bake(&plan, &wide);
    let part = bake(
        &plan,
        &BakeOptions {
            region: Some(region),
            ..wide.clone()
        },
    );
    for ((map, whole), part) in wide.maps.iter().zip(&whole).zip(&part) {
        assert!(crop(whole, size, region) == *part, "{map:?}");
    }
}

#[test]
fn whole_maps_are_the_bands_one_below_the_other() {
    let plan = plan(ALL_NODES);
    // Wide enough for bands of 16 rows.
    let options = BakeOptions {
        maps: vec![
            MapKind::Height,
            MapKind::Orm,
            MapKind::Albedo,
            MapKind::Normal,
        ],
        band_pixels: 1 << 16,
        ..options([1 << 12, 40])
    };
    let bake = Bake::new(&plan, &options).unwrap();
    let bands: Vec<_> = bake.clone().map(Result::unwrap).collect();
    assert!(bands.len() > 2, "there are several");
    let whole = bake.whole_maps().unwrap();
    assert_eq!(whole.len(), options.maps.len());
    for (index, (kind, map)) in whole.iter().enumerate() {
        assert_eq!((*kind, map.size()), (options.maps[index], options.size));
        for band in &bands {
            let rows = &band.maps[index].1;
            let [first, size] = [[0, band.first_row], rows.size()];
            let part = match map {
                MapRows::Gray(map) => MapRows::Gray(map.crop(first, size).unwrap()),
                MapRows::Color(map) => MapRows::Color(map.crop(first, size).unwrap()),
                MapRows::Normal(map) => MapRows::Normal(map.crop(first, size).unwrap()),
                MapRows::Packed(map) => MapRows::Packed(map.crop(first, size).unwrap()),
            };
            assert!(part == *rows, "{kind:?} from row {}", band.first_row);
        }
    }
}

#[test]
fn what_maps_share_with_the_height_has_the_bits_that_it_has_alone() {
    let plan = plan(ALL_NODES);
    let of_height = r#"colors = { ramp = { input = "height","#;
    assert!(ALL_NODES.contains(of_height), "the colors are made of it");
    let maps = vec![MapKind::Albedo, MapKind::Roughness, MapKind::Metallic];
    // In one band, and in several.
    for size in [[97, 71], [4_000, 60]] {
        let alone = BakeOptions {
            maps: maps.clone(),
            band_pixels: 1 << 16,
            ..options(size)
        };
        let mut beside = alone.clone();
        beside.maps.push(MapKind::Normal);
        assert!(bake(&plan, &beside)[..3] == bake(&plan, &alone), "{size:?}");
    }
}

#[cfg(feature = "rayon")]
#[test]
fn a_bake_has_the_same_bits_on_any_number_of_threads() {
    let plan = plan(ALL_NODES);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| bake(&plan, &options([300, 300])))
    };
    let one = on(1);
    for threads in [2, 7] {
        assert!(on(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_recipe_that_repeats_has_its_left_columns_past_its_right_edge() {
    // A power of two, so that positions past the edge are those at the other side to the last bit.
    let text = ALL_NODES
        .replace("extent = [4.0, 3.0]", "extent = [4.0, 4.0]")
        .replace("frequency = 3.0\nvalue", "frequency = 2.0\nvalue");
    // A coordinate does not repeat.
    let text = text.replace("along = [0.25, 0.0]", "along = [0.0, 0.0]");
    let plan = plan(&text);
    let window = plan.window([64, 64]).unwrap();
    let height = plan.height().unwrap();
    let beyond = window.crop([64, 0], [8, 64]).unwrap();
    let [here, there] = [window.crop([0, 0], [8, 64]).unwrap(), beyond].map(|window| {
        use dapple_raster::Field;
        height.to_raster(&window).unwrap()
    });
    assert_eq!(here, there, "one period apart");
}

#[test]
fn a_field_of_a_node_gives_the_same_at_a_position_as_in_a_window() {
    use dapple_raster::Field;
    let plan = plan(ALL_NODES);
    let window = plan.window([37, 29]).unwrap();
    for name in ["height", "shifted", "fine", "bumps", "ratio", "rings"] {
        let field = plan.field(name).unwrap();
        let raster = field.to_raster(&window).unwrap();
        for (column, row) in [(0, 0), (20, 3), (36, 28)] {
            let sample = field.sample(window.position(column, row));
            assert_eq!(
                sample.to_bits(),
                raster.row(row)[column as usize].to_bits(),
                "{name} at {column}, {row}"
            );
        }
    }
    let colors = plan.colors("layered").unwrap();
    let raster = colors.to_raster(&window).unwrap();
    assert_eq!(
        colors.sample(window.position(5, 7)).unwrap(),
        raster.row(7)[5],
        "colors"
    );
    let error = plan.field("layered").unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::NotANumber { .. }),
        "{error}"
    );
    let gray = plan.colors("height").unwrap().sample(window.position(5, 7));
    let number = plan.field("height").unwrap();
    let number = number.sample(window.position(5, 7));
    assert_eq!(gray.unwrap(), LinearRgb::gray(number), "a number is a gray");
    assert_eq!(plan.field("heigth").unwrap_err().nearest(), Some("height"));
}

#[test]
fn what_sees_the_whole_tile_is_refused_in_bands_and_right_in_regions() {
    let text = r#"
dapple = 1
[nodes.slope.coordinate]
along = [1.0, 0.5]
[nodes.even.tile]
input = "slope"
method = "periodic"
[material]
height = "even"
"#;
    let plan = plan(text);
    assert!(plan.sees_whole(), "a tile does");
    let size = [48, 32];
    let banded = BakeOptions {
        memory: BakeMemory::Banded,
        ..options(size)
    };
    let error = Bake::new(&plan, &banded).unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::Global { .. }),
        "{error}"
    );
    assert_eq!(error.node(), Some("even"), "{error}");
    let region = Region {
        first: [30, 20],
        size: [18, 12],
    };
    let whole = bake(&plan, &options(size));
    let part = bake(
        &plan,
        &BakeOptions {
            region: Some(region),
            ..options(size)
        },
    );
    for ((map, whole), part) in MapKind::ALL.iter().zip(&whole).zip(&part) {
        assert!(crop(whole, size, region) == *part, "{map:?}");
    }
    let step = f32::from_bits(whole[0][47]) - f32::from_bits(whole[0][0]);
    assert!(
        step.abs() < 0.3,
        "of a slope of 1, a step of {step} is left at the seam"
    );
}

#[test]
fn an_image_is_read_pixel_by_pixel_at_its_own_size() {
    let image = Raster::from_fn([32, 16], |x, y| {
        LinearRgb::new(x as f32 / 32.0, y as f32 / 16.0, 0.5)
    })
    .unwrap();
    let images = Images::from([(
        "photo.png".to_owned(),
        Picture::Colors(Arc::new(image.clone())),
    )]);
    let text = "dapple = 1\nextent = [2.0, 1.0]\n[nodes.photo.image]\nfile = \"photo.png\"\n[material]\nalbedo = \"photo\"\n";
    let recipe = Recipe::from_toml(text).unwrap();
    assert_eq!(recipe.image_files(), ["photo.png"], "what it names");
    let plan = Plan::new(&recipe, &images, 0.0).unwrap();
    let maps = vec![MapKind::Albedo];
    let mut bake = Bake::new(
        &plan,
        &BakeOptions {
            size: [32, 16],
            maps,
            ..BakeOptions::default()
        },
    )
    .unwrap();
    let (_, rows) = bake.next().unwrap().unwrap().maps.swap_remove(0);
    assert_eq!(rows, MapRows::Color(image), "as it was");
    let error = Plan::new(&recipe, &Images::new(), 0.0).unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::NoImage { .. }),
        "{error}"
    );
}

#[test]
fn a_loop_in_time_joins_and_moves() {
    let text = "dapple = 1\n[nodes.sea.worley]\nfrequency = 4.0\nmotion = { cells = 2 }\n[material]\nheight = \"sea\"\n";
    let recipe = Recipe::from_toml(text).unwrap();
    let at = |time: f64| {
        let plan = Plan::new(&recipe, &Images::new(), time).unwrap();
        bake(
            &plan,
            &BakeOptions {
                size: [32, 32],
                ..BakeOptions::default()
            },
        )
    };
    assert!(at(0.0) == at(1.0), "the end is the beginning");
    assert!(at(0.0) != at(0.5), "it moves");
}

#[test]
fn value_stability_of_a_bake_of_all_nodes() {
    let plan = plan(ALL_NODES);
    let maps = bake(&plan, &options([64, 48]));
    // FNV-1a over the bits of each map.
    let hash = |map: &Vec<u32>| {
        let bytes = map.iter().flat_map(|bits| bits.to_le_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        })
    };
    let hashes: Vec<u64> = maps.iter().map(hash).collect();
    let expected = [
        0x7931_5df6_0699_c483,
        0x58df_b02c_f940_85eb,
        0xbc0e_f54e_2528_f359,
        0xaf86_10bf_445d_28bb,
        0x59a1_32bf_8952_3971,
        0x6410_36c6_e89e_3875,
        0x869a_c710_6856_dc78,
        0xb69b_619d_3ede_50f4,
        0xd0ca_06f3_b95f_7f08,
        // The opacity, the specular and the clear coat are the nodes of the roughness and the metalness.
        0x6410_36c6_e89e_3875,
        0x869a_c710_6856_dc78,
        0x6410_36c6_e89e_3875,
    ];
    assert_eq!(hashes, expected, "the bits of the maps");
}

#[test]
fn a_ramp_mixes_in_the_space_that_it_names_and_else_in_oklab() {
    for (space, expected) in [
        ("", RampSpace::Oklab),
        ("space = \"oklab\"", RampSpace::Oklab),
        ("space = \"srgb\"", RampSpace::Srgb),
        ("space = \"linear\"", RampSpace::Linear),
    ] {
        let text = format!(
            "dapple = 1\n[nodes.a.ramp]\ninput = 0.3\ncolors = [\"#00f\", \"#ff0\"]\n{space}\n[material]\nalbedo = \"a\"\n"
        );
        let plan = plan(&text);
        let options = BakeOptions {
            maps: vec![MapKind::Albedo],
            ..options([2, 2])
        };
        let maps = Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
        let ramp = ColorRamp::from_hex(&["#00f", "#ff0"]).unwrap();
        let color = ramp.with_space(expected).at(0.3);
        let map = MapRows::Color(Raster::filled([2, 2], color).unwrap());
        assert_eq!(maps, [(MapKind::Albedo, map)], "{space}");
    }
}

#[test]
fn normals_wrap_where_the_recipe_does() {
    use dapple_color::{HeightPlane, normal_map};
    // A coordinate does not repeat.
    let plan = plan(&ALL_NODES.replace("along = [0.25, 0.0]", "along = [0.0, 0.0]"));
    let size = [64, 48];
    let maps = vec![MapKind::Height, MapKind::Normal];
    let baked = BakeOptions {
        size,
        maps,
        ..BakeOptions::default()
    };
    let band = Bake::new(&plan, &baked).unwrap().next().unwrap().unwrap();
    let [(_, MapRows::Gray(height)), (_, MapRows::Normal(normals))] = &band.maps[..] else {
        panic!("two maps");
    };
    let plane = HeightPlane {
        strength: 0.1,
        extent: plan.extent(),
        wrap: [Wrap::Repeat; 2],
    };
    let expected = normal_map(height, &plane.into()).unwrap();
    let inside = [1, 1];
    let part = [62, 46];
    assert_eq!(
        normals.crop(inside, part).unwrap(),
        expected.crop(inside, part).unwrap(),
        "away from the edges"
    );
    // At the edges the heights beyond are sampled a rounding of the position away from where they wrap to.
    for (a, b) in normals.row(0).iter().zip(expected.row(0)) {
        assert!(
            (a.x - b.x).abs() < 1e-3 && (a.y - b.y).abs() < 1e-3,
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn a_warp_of_a_node_that_sees_the_whole_tile_moves_its_pixels() {
    let plan = plan(
        r#"
dapple = 1
[nodes]
a = { noise = { octaves = 2 } }
whole = { tile = { input = "a", method = "periodic" } }
moved = { warp = { input = "whole", x = 0.25, y = 0.0 } }
[material]
height = "moved"
"#,
    );
    let numbers = |node: &str| match plan.node_picture(node, [32, 32], None) {
        Ok(Picture::Numbers(raster)) => raster,
        other => panic!("{node}: {other:?}"),
    };
    // The extent is 1, so that a displacement of a quarter is 8 of 32 pixels.
    let (whole, moved) = (numbers("whole"), numbers("moved"));
    for row in 0..32 {
        for column in 0..32 {
            let [from, to] = [whole.row(row)[(column + 8) % 32], moved.row(row)[column]];
            // Positions are rounded to f64 and weights of the interpolation to f32.
            assert!(
                (from - to).abs() < 1e-5,
                "at {column}, {row}: {from} and {to}"
            );
        }
    }
    let banded = BakeOptions {
        memory: BakeMemory::Banded,
        ..BakeOptions::default()
    };
    let error = Bake::new(&plan, &banded).expect_err("bands have no whole tile");
    assert!(matches!(error.kind(), RecipeErrorKind::Global { .. }));
}

#[test]
fn baked_maps_are_bytes_of_textures() {
    use dapple_color::TextureRaster as _;

    let options = BakeOptions {
        size: [8, 6],
        maps: vec![MapKind::Albedo, MapKind::Normal, MapKind::Orm],
        ..BakeOptions::default()
    };
    let plan = plan(ALL_NODES);
    for band in Bake::new(&plan, &options).unwrap() {
        for (kind, map) in band.unwrap().maps {
            let expected = match &map {
                MapRows::Gray(raster) => raster.to_rgba8(),
                MapRows::Color(raster) => raster.to_rgba8_srgb(),
                MapRows::Normal(raster) => raster.to_rgba8(),
                MapRows::Packed(raster) => raster.to_rgba8(),
            };
            assert_eq!(map.to_rgba8(), expected, "{kind:?}");
            let sizes: Vec<_> = map
                .mip_levels()
                .unwrap()
                .iter()
                .map(MapRows::size)
                .collect();
            assert_eq!(sizes, [[8, 6], [4, 3], [2, 1], [1, 1]]);
        }
    }
}
