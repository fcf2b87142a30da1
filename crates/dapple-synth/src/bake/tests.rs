//! Maps of small surfaces, compared with texels that are interpolated individually.

use super::bake;
use crate::{Atlas, Hierarchy, HierarchyOptions, SynthErrorKind};
use dapple_hash::Seed;
use dapple_mesh::{Mesh, Surface};
use glam::DVec3;

fn octahedron() -> Surface {
    let positions = [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|axis| [axis, -axis]);
    let mut faces = Vec::new();
    for signs in 0..8_u32 {
        let [x, y, z] = [signs & 1, 2 + (signs >> 1 & 1), 4 + (signs >> 2 & 1)];
        let flips = signs.count_ones() % 2 == 1;
        faces.push(if flips { [x, z, y] } else { [x, y, z] });
    }
    Surface::new(Mesh::new(positions.collect(), &faces).unwrap()).unwrap()
}

fn case() -> (Surface, Hierarchy, Atlas) {
    let surface = octahedron();
    let options = HierarchyOptions {
        n_sites: 2000,
        n_levels: 2,
        seed: Seed(3),
        ..HierarchyOptions::default()
    };
    let hierarchy = Hierarchy::new(&surface, &options).unwrap();
    let atlas = Atlas::uniform(&surface, 75).unwrap();
    (surface, hierarchy, atlas)
}

#[test]
fn texels_are_those_of_plain_interpolation() {
    let (surface, hierarchy, atlas) = case();
    let column: Vec<f32> = (0..4000)
        .map(|at| (at * 7919 % 101) as f32 / 101.0)
        .collect();
    let map = bake::<2>(&surface, &hierarchy, &column, &atlas, [-1.0; 2]).unwrap();
    let pairs: Vec<[f32; 2]> = column.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
    let mut shown = 0;
    for row in 0..75 {
        for column in 0..75 {
            let value = map.row(row)[column as usize];
            let Some(point) = atlas.point(&surface, [column, row]) else {
                assert_eq!(value, [-1.0; 2], "background");
                continue;
            };
            shown += 1;
            let normal = surface.normal(point);
            let plain = hierarchy.interpolate(0, &pairs, surface.position(point), normal);
            let plain = plain.unwrap().unwrap();
            // Tolerance: positions are rounded to f32, 1e-6 of a radius here.
            let off = (value[0] - plain[0]).abs().max((value[1] - plain[1]).abs());
            assert!(off < 1e-3, "{column} {row}: {value:?} beside {plain:?}");
        }
    }
    assert!(shown > 2000, "only {shown} texels show a face");
}

#[cfg(feature = "rayon")]
#[test]
fn map_has_the_same_bits_on_any_number_of_threads() {
    let (surface, hierarchy, atlas) = case();
    let column: Vec<f32> = (0..2000).map(|at| (at % 17) as f32).collect();
    let maps = [1, 2, 7].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        pool.install(|| bake::<1>(&surface, &hierarchy, &column, &atlas, [0.0]).unwrap())
    });
    assert_eq!(maps[0], maps[1], "2 threads");
    assert_eq!(maps[0], maps[2], "7 threads");
}

#[test]
fn column_of_another_length_is_refused() {
    let (surface, hierarchy, atlas) = case();
    let error = bake::<3>(&surface, &hierarchy, &[0.0; 2000], &atlas, [0.0; 3]).unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Count { count: 2000, .. }),
        "{error}"
    );
}
