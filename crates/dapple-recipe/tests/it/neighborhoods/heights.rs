//! Tests of `curvature` and `occlusion` against the maps of a bake.

use super::{numbers, photo, with_image};
use dapple_raster::Raster;
use dapple_recipe::{Bake, BakeOptions, MapKind, MapRows};

#[test]
fn curvature_and_occlusion_of_the_height_are_the_maps_of_a_bake() {
    for (wrap, extent) in [
        ("true, true", "4.0, 3.0"),
        ("false, true", "2.0, 3.0"),
        ("false, false", "1.0, 1.0"),
    ] {
        let text = format!(
            "dapple = 1\nextent = [{extent}]\nwrap = [{wrap}]\n[nodes]\n\
             cells.worley.frequency = 2.0\na.image = {{ file = \"a.png\" }}\nheight.add = [\"cells\", \"a\"]\n\
             bent.curvature = {{ input = \"height\" }}\nseen.occlusion = {{ input = \"height\" }}\n\
             [material]\nheight = \"height\"\nrelief = 0.3\n"
        );
        let plan = with_image(&text, photo());
        let size = [60, 48];
        let options = BakeOptions {
            size,
            maps: vec![MapKind::Curvature, MapKind::Occlusion],
            ..BakeOptions::default()
        };
        let maps = Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
        for ((kind, map), node) in maps.into_iter().zip(["bent", "seen"]) {
            let MapRows::Gray(map) = map else {
                panic!("{kind:?} is gray");
            };
            let least = map.pixels().iter().copied().fold(f32::INFINITY, f32::min);
            let most = map.pixels().iter().copied().fold(0.0, f32::max);
            assert!(most - least > 0.1, "{kind:?} varies");
            // The pixel size is rounded in another order.
            let node = numbers(&plan, node, size);
            let far = farthest(&node, &map);
            assert!(far < 1e-5, "{kind:?}, wrap {wrap}: {far}");
        }
    }
}

fn farthest(a: &Raster<f32>, b: &Raster<f32>) -> f32 {
    let pairs = a.pixels().iter().zip(b.pixels());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}
