//! Tests of images in recipes: image files and synthesized textures baked at other sizes, and heights past sides that
//! do not repeat.

use dapple_color::{LinearRgb, Normal};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Wrap};
use dapple_recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Picture, Plan, Recipe, Region};
use std::sync::Arc;

fn plan(text: &str, picture: Raster<f32>) -> Plan {
    let images = Images::from([("a.png".to_owned(), Picture::Numbers(Arc::new(picture)))]);
    Plan::new(&Recipe::from_toml(text).unwrap(), &images, 0.0).unwrap()
}

fn noise(size: [u32; 2]) -> Raster<f32> {
    let hash = CellHash::new(Seed(5), []);
    let value = |x: u32, y: u32| unit_f64(hash.at(y << 16 | x));
    Raster::from_fn(size, |x, y| value(x, y) as f32).unwrap()
}

fn checker(size: [u32; 2]) -> Raster<f32> {
    Raster::from_fn(size, |x, y| ((x + y) % 2) as f32).unwrap()
}

/// Bakes one map, in several bands, and returns all of its rows.
fn baked(plan: &Plan, map: MapKind, size: [u32; 2], region: Option<Region>) -> MapRows {
    let options = BakeOptions {
        size,
        region,
        maps: vec![map],
        // Several bands.
        band_pixels: 1,
        ..BakeOptions::default()
    };
    let mut maps = Bake::new(plan, &options).unwrap().whole_maps().unwrap();
    maps.swap_remove(0).1
}

/// Returns the height map.
fn height(plan: &Plan, size: [u32; 2]) -> Raster<f32> {
    match baked(plan, MapKind::Height, size, None) {
        MapRows::Gray(raster) => raster,
        other => panic!("{other:?} is not gray"),
    }
}

/// Returns the image scaled down to `size` columns and rows. Each pixel is a mean weighted by overlap.
fn box_average(picture: &Raster<f32>, size: [u32; 2]) -> Raster<f32> {
    let overlaps = |at: u32, to: u32, from: u32| {
        let step = f64::from(from) / f64::from(to);
        let [first, end] = [0, 1].map(|side| f64::from(at + side) * step);
        (0..from).filter_map(move |pixel| {
            let pixel_end = f64::from(pixel) + 1.0;
            let overlap = end.min(pixel_end) - first.max(pixel.into());
            (overlap > 0.0).then_some((pixel, overlap / step))
        })
    };
    let [width, height] = picture.size();
    let mean = |x: u32, y: u32| -> f64 {
        overlaps(y, size[1], height)
            .map(|(row, of_row)| {
                let of_columns = overlaps(x, size[0], width).map(|(column, of_column)| {
                    of_column * f64::from(picture.row(row)[column as usize])
                });
                of_row * of_columns.sum::<f64>()
            })
            .sum()
    };
    Raster::from_fn(size, |x, y| mean(x, y) as f32).unwrap()
}

fn deviation(raster: &Raster<f32>) -> f64 {
    let n = raster.pixels().len() as f64;
    let values = || raster.pixels().iter().map(|&value| f64::from(value));
    let mean = values().sum::<f64>() / n;
    (values()
        .map(|value| (value - mean) * (value - mean))
        .sum::<f64>()
        / n)
        .sqrt()
}

const IMAGE: &str = r#"
dapple = 1
[nodes.a.image]
file = "a.png"
[material]
height = "a"
"#;

/// A recipe that warps an image by less than a pixel.
const WARPED: &str = r#"
dapple = 1
[nodes]
a.image.file = "a.png"
b.warp = { input = "a", x = 0.5, y = 0.25, amount = 0.001 }
[material]
height = "b"
"#;

#[test]
fn images_are_averaged_over_the_pixels_of_a_smaller_bake() {
    for (factor, [from, to]) in [
        (2.0, [120, 60]),
        (2.5, [120, 48]),
        (3.0, [120, 40]),
        (8.0, [120, 15]),
    ] {
        for picture in [checker([from; 2]), noise([from; 2])] {
            let expected = box_average(&picture, [to; 2]);
            let made = height(&plan(IMAGE, picture.clone()), [to; 2]);
            for (made, expected) in made.pixels().iter().zip(expected.pixels()) {
                // Means of up to 81 numbers in single precision, with ends within 2^-20 of a pixel.
                assert!(
                    (made - expected).abs() < 1e-5,
                    "{factor}: {made} for {expected}"
                );
            }
            // Under a warp pixels have the same size; it lies between the pixels of the bake.
            let warped = deviation(&height(&plan(WARPED, picture), [to; 2]));
            let most = 1.2 * deviation(&expected) + 1e-5;
            assert!(warped < most, "{factor}: {warped}, at most {most}");
        }
    }
}

#[test]
fn sides_are_averaged_each_by_its_own_factor() {
    let picture = noise([90, 30]);
    let made = height(&plan(IMAGE, picture.clone()), [30, 60]);
    // Down, a pixel of the image has two of the bake: places a quarter of a pixel from its center.
    let narrow = box_average(&picture, [30, 30]);
    let expected = Raster::from_fn([30, 60], |x, y| {
        let uv = DVec2::new((f64::from(x) + 0.5) / 30.0, (f64::from(y) + 0.5) / 60.0);
        narrow.sample_bilinear(uv, [Wrap::Repeat; 2])
    });
    for (made, expected) in made.pixels().iter().zip(expected.unwrap().pixels()) {
        assert!((made - expected).abs() < 1e-5, "{made} for {expected}");
    }
}

#[test]
fn images_keep_their_bits_in_bakes_of_their_size_and_larger_ones() {
    let picture = noise([49, 35]);
    let plan = plan(IMAGE, picture.clone());
    assert_eq!(height(&plan, [49, 35]), picture, "of its size");
    let size = [98, 85];
    let expected = Raster::from_fn(size, |x, y| {
        let pixel = DVec2::ONE / DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) * pixel;
        picture.sample_bilinear(at, [Wrap::Repeat; 2])
    });
    assert_eq!(height(&plan, size), expected.unwrap(), "larger");
}

#[test]
fn regions_of_smaller_bakes_are_crops_of_the_whole_bit_for_bit() {
    let [size, region] = [[37, 29], [11, 13]];
    for text in [IMAGE, WARPED] {
        for wrap in ["[true, true]", "[false, true]", "[false, false]"] {
            let text = text.replace("dapple = 1", &format!("dapple = 1\nwrap = {wrap}"));
            let plan = plan(&text, noise([100, 64]));
            let maps = [
                MapKind::Height,
                MapKind::Normal,
                MapKind::Occlusion,
                MapKind::Curvature,
            ];
            for (map, first) in maps
                .iter()
                .flat_map(|map| [[0, 0], [26, 16], [9, 8]].map(|first| (*map, first)))
            {
                let region = Region {
                    first,
                    size: region,
                };
                let part = baked(&plan, map, size, Some(region));
                match (baked(&plan, map, size, None), part) {
                    (MapRows::Gray(whole), MapRows::Gray(part)) => {
                        assert_eq!(whole.crop(first, part.size()).unwrap(), part, "{map:?}");
                    }
                    (MapRows::Normal(whole), MapRows::Normal(part)) => {
                        assert_eq!(whole.crop(first, part.size()).unwrap(), part, "{map:?}");
                    }
                    (whole, _) => panic!("{whole:?} is another kind"),
                }
            }
        }
    }
}

#[test]
fn grown_and_tiled_textures_are_averaged_too() {
    let grown = r#"
dapple = 1
[nodes.a.synth]
file = "a.png"
size = [64, 64]
[material]
height = "a"
"#;
    let plan_of_grown = plan(grown, noise([32, 32]));
    let whole = height(&plan_of_grown, [64, 64]);
    let expected = box_average(&whole, [16, 16]);
    for (made, expected) in height(&plan_of_grown, [16, 16])
        .pixels()
        .iter()
        .zip(expected.pixels())
    {
        assert!((made - expected).abs() < 1e-5, "{made} for {expected}");
    }
    // Each of 4 x 4 copies shows the whole tile at a quarter of its size: means of 4 x 4 pixels of the tile.
    let copies = r#"
dapple = 1
[nodes.a.image]
file = "a.png"
[nodes.b.tile]
input = "a"
[nodes.c.disturb]
input = "b"
copies = [4, 4]
frozen = 1
margin = 2
[material]
height = "c"
"#;
    let made = deviation(&height(&plan(copies, noise([64, 64])), [64, 64]));
    let most = 1.2 * deviation(&box_average(&noise([64, 64]), [16, 16]));
    assert!(made < most, "{made}, at most {most}");
}

#[test]
fn colors_are_averaged_in_linear_light() {
    let checker = checker([64; 2]).map(|&value| LinearRgb::gray(value));
    let images = Images::from([("a.png".to_owned(), Picture::Colors(Arc::new(checker)))]);
    let text = IMAGE.replace("height = \"a\"", "albedo = \"a\"");
    let plan = Plan::new(&Recipe::from_toml(&text).unwrap(), &images, 0.0).unwrap();
    let MapRows::Color(made) = baked(&plan, MapKind::Albedo, [32; 2], None) else {
        panic!("the albedo is a color");
    };
    let is_half = |color: &LinearRgb| *color == LinearRgb::gray(0.5);
    assert!(made.pixels().iter().all(is_half), "half of the light");
}

#[test]
fn planes_of_images_have_constant_maps_up_to_open_sides() {
    for wrap in [[true, true], [false, true], [true, false], [false, false]] {
        // Whole eighths are exact in single precision.
        let slope = [0, 1].map(|axis| if wrap[axis] { 0.0 } else { 0.125 });
        let picture = Raster::from_fn([48, 32], |x, y| {
            (slope[0] * f64::from(x) - 2.0 * slope[1] * f64::from(y)) as f32
        });
        let tiled = "[nodes.b.tile]\ninput = \"a\"\nmethod = \"periodic\"\naxes = [false, false]\n";
        for node in ["a", "b"] {
            let text = format!(
                "dapple = 1\nextent = [48.0, 32.0]\nwrap = {wrap:?}\n[nodes.a.image]\nfile = \"a.png\"\n{tiled}\
                 [material]\nheight = \"{node}\"\nrelief = 1.0\nocclusion_radius = 40.0\ncurvature_radius = 3.0\n"
            );
            let plan = plan(&text, picture.clone().unwrap());
            let first = [40, 24];
            let region = Region {
                first,
                size: [8; 2],
            };
            for region in [None, Some(region)] {
                let of = |map| baked(&plan, map, [48, 32], region);
                let MapRows::Normal(normals) = of(MapKind::Normal) else {
                    panic!("normals are normals");
                };
                let is_same = |normal: &Normal| *normal == normals.pixels()[0];
                assert!(
                    normals.pixels().iter().all(is_same),
                    "{wrap:?} {node}: normals"
                );
                for (map, flat) in [(MapKind::Occlusion, 1.0), (MapKind::Curvature, 0.5)] {
                    let MapRows::Gray(gray) = of(map) else {
                        panic!("{map:?} is gray");
                    };
                    // Arctangents err by 2e-7.
                    let is_flat = |value: &f32| (value - flat).abs() < 1e-6;
                    assert!(
                        gray.pixels().iter().all(is_flat),
                        "{wrap:?} {node}: {map:?}"
                    );
                }
            }
        }
    }
}
