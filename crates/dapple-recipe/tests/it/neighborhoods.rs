//! Tests of nodes that depend on the neighborhood of a pixel: windows, threads, nesting and limits. Each kind is also
//! compared with a naive implementation.

mod blur;
mod extremes;
mod flow;
mod heights;
mod slope;
mod whole;

use crate::bakes::{bake, crop, options, plan};
use dapple_raster::glam::DVec2;
use dapple_raster::{Field as _, FieldExt as _, Raster};
use dapple_recipe::{
    Bake, BakeMemory, BakeOptions, Images, MapKind, Picture, Plan, PlanCache, PlanLimits, Recipe,
    RecipeErrorKind, Region, Shards,
};
use std::sync::Arc;

/// Returns the values of a node at all pixels of the tile.
fn numbers(plan: &Plan, node: &str, size: [u32; 2]) -> Raster<f32> {
    match plan.node_picture(node, size, None).unwrap() {
        Picture::Numbers(raster) => Arc::unwrap_or_clone(raster),
        Picture::Colors(_) => panic!("`{node}` has colors"),
    }
}

/// Returns a plan whose image `a.png` has these numbers.
fn with_image(text: &str, image: Raster<f32>) -> Plan {
    let images = Images::from([("a.png".into(), Picture::Numbers(Arc::new(image)))]);
    Plan::new(&Recipe::from_toml(text).unwrap(), &images, 0.0).unwrap()
}

/// Returns a pseudorandom number from 0 to 1.
fn random(x: u32, y: u32) -> f32 {
    let bits = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    let bits = (bits ^ bits >> 15).wrapping_mul(0xC2B2_AE3D);
    (bits >> 16) as f32 / 65_535.0
}

/// Checks that each pixel of `found` differs from `right(x, y)` by at most `tolerance`.
fn assert_near(found: &Raster<f32>, right: impl Fn(i64, i64) -> f64, tolerance: f64) {
    let [width, height] = found.size().map(i64::from);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let (found, right) = (f64::from(found.row(y as u32)[x as usize]), right(x, y));
        assert!(
            (found - right).abs() <= tolerance,
            "at {x}, {y}: {found} instead of {right}"
        );
    }
}

/// A material with nested neighborhoods of cells and of an image. Its pixels are not square.
const NESTED: &str = r##"
dapple = 1
seed = 3
extent = [4.0, 3.0]

[nodes]
cells = { worley = { frequency = 2.0 } }
photo = { image = { file = "a.png" } }
height = { add = ["cells", "photo"] }
soft = { blur = { input = "height", radius = 0.11 } }
runs = { blur = { input = "soft", radius = 0.2, along = 70.0, one_sided = true } }
steep = { slope = { input = "soft" } }
wide = { slope = { input = "photo", radius = 0.2, relief = 0.5 } }
wide_steep = { slope = { input = "wide", radius = 0.3 } }
worn = { curvature = { input = "height", relief = 0.1, radius = 0.1 } }
dirt = { occlusion = { input = "steep" } }
dirty = { multiply = ["dirt", "worn", "large", "far"] }
grown = { dilate = { input = "height", radius = 0.13 } }
shrunk = { erode = { input = "grown", radius = 0.09 } }
large = { edges = { input = "shrunk", radius = 0.05 } }
far = { distance_to = { input = "large", radius = 0.4 } }
flow = { slope_blur = { input = "grown", height = "soft", radius = 0.08 } }
eddy = { flow_warp = { input = "flow", height = "soft", amount = 0.07, direction = "contour", steps = 5 } }
sharp = { sharpen = { input = "eddy", radius = 0.06 } }
again = { mix = { from = "runs", to = "wide_steep", by = "sharp" } }
twice = { blur = { input = "again", radius = 0.07, along = -20.0 } }
colors = { ramp = { input = "twice", palette = "lagoon" } }
soft_colors = { blur = { input = "colors", radius = 0.05 } }

[material]
height = "twice"
albedo = "soft_colors"
roughness = "steep"
metallic = "dirty"
relief = 0.3
"##;

fn photo() -> Raster<f32> {
    Raster::from_fn([31, 17], |x, y| {
        ((7 * x + 11 * y + x * y) % 16) as f32 / 16.0
    })
    .unwrap()
}

fn nested(wrap: [bool; 2]) -> Plan {
    with_image(&format!("wrap = {wrap:?}\n{NESTED}"), photo())
}

const WRAPS: [[bool; 2]; 3] = [[true, true], [false, false], [true, false]];

#[test]
fn regions_and_bands_are_crops_of_the_whole() {
    for wrap in WRAPS {
        let plan = nested(wrap);
        assert!(!plan.sees_whole(), "no picture of the whole tile is needed");
        let size = [64, 96];
        let whole = bake(&plan, &options(size));
        for (region, band_pixels) in [
            ([[0, 0], [13, 9]], 1 << 20),
            ([[20, 41], [44, 55]], 800),
            ([[63, 95], [1, 1]], 1),
            ([[0, 0], [64, 96]], 64),
            ([[0, 0], [64, 96]], 64 * 37),
        ] {
            let [first, part] = region;
            let region = Region { first, size: part };
            let options = BakeOptions {
                region: Some(region),
                memory: BakeMemory::Banded,
                band_pixels,
                ..options(size)
            };
            for ((kind, whole), part) in MapKind::ALL.iter().zip(&whole).zip(bake(&plan, &options))
            {
                let same = crop(whole, size, region) == part;
                assert!(same, "{kind:?} of {region:?}, wrap {wrap:?}, {band_pixels}");
            }
        }
    }
}

#[test]
fn shards_of_corners_join_to_the_whole() {
    for wrap in WRAPS {
        let plan = nested(wrap);
        let size = [65, 49];
        let corners = BakeOptions {
            samples: dapple_recipe::Samples::Corners,
            ..options(size)
        };
        let whole = bake(&plan, &corners);
        for region in Shards::new(size, [33, 25])
            .unwrap()
            .with_overlap(1)
            .unwrap()
            .iter()
        {
            let options = BakeOptions {
                region: Some(region),
                ..corners.clone()
            };
            for ((kind, whole), part) in MapKind::ALL.iter().zip(&whole).zip(bake(&plan, &options))
            {
                let same = crop(whole, size, region) == part;
                assert!(same, "{kind:?} of {region:?}, wrap {wrap:?}");
            }
        }
    }
}

#[test]
fn threads_and_caches_do_not_change_a_bit() {
    let plan = nested([true, false]);
    let size = [96, 80];
    let on_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| bake(&plan, &options(size)))
    };
    let one = on_threads(1);
    assert!(on_threads(3) == one, "three threads");
    // Redraw with another relief: the slope of the material's relief changes, and blurs are reused.
    let images = Images::from([("a.png".into(), Picture::Numbers(Arc::new(photo())))]);
    let text = format!("wrap = [true, false]\n{NESTED}");
    let (cache, limits) = (PlanCache::new(1 << 26), PlanLimits::default());
    for relief in ["0.3", "0.3", "0.9"] {
        let recipe =
            Recipe::from_toml(&text.replace("relief = 0.3", &format!("relief = {relief}")));
        let recipe = recipe.unwrap();
        let cached = Plan::new_with_cache(&recipe, &images, 0.0, &limits, &cache).unwrap();
        let fresh = Plan::new(&recipe, &images, 0.0).unwrap();
        let same = bake(&cached, &options(size)) == bake(&fresh, &options(size));
        assert!(same, "a cached plan at relief {relief}");
    }
}

#[test]
fn neighborhoods_are_computed_once_for_several_readers() {
    // Each level reads the one below twice. Evaluating each reader's input again would take 2^40 blurs.
    let mut text = "dapple = 1\n[nodes]\nn0.coordinate = {}\n".to_owned();
    for level in 0..40 {
        text += &format!(
            "a{level}.blur = {{ input = \"n{level}\", radius = 0.02 }}\n\
             b{level}.blur = {{ input = \"n{level}\", radius = 0.01 }}\n\
             n{}.maximum = [\"a{level}\", \"b{level}\"]\n",
            level + 1
        );
    }
    let plan = plan(&(text + "[material]\nheight = \"n40\"\n"));
    let raster = numbers(&plan, "n40", [16, 16]);
    assert!(raster.pixels().iter().all(|value| value.is_finite()));
}

const MOVED: &str = r#"
dapple = 1
extent = [2.0, 2.0]
[nodes]
cells = { worley = { frequency = 4.0 } }
soft = { blur = { input = "cells", radius = 0.1 } }
same = { warp = { input = "soft", x = 1.0, y = 0.0, amount = 0.25 } }
moved = { warp = { input = "soft", x = "soft", y = "cells", amount = 0.1 } }
turned = { transform = { input = "soft", frequency = 2.0, rotation = 90.0 } }
sum = { fractal = { input = "soft", octaves = 2 } }
most = { maximum = ["moved", "turned", "sum"] }
edge = { slope = { input = "most" } }
[material]
height = "edge"
"#;

#[test]
fn below_a_warp_the_pixels_of_the_tile_are_interpolated() {
    let plan = plan(MOVED);
    assert!(plan.sees_whole(), "the blur is read between pixels");
    let size = [64, 32];
    let [soft, same] = ["soft", "same"].map(|node| numbers(&plan, node, size));
    // A shift by 8 columns; the interpolation between equal positions rounds.
    let right = |x: i64, y: i64| f64::from(soft.row(y as u32)[((x + 8) % 64) as usize]);
    assert_near(&same, right, 1e-6);
    let whole = bake(&plan, &options(size));
    let region = Region {
        first: [50, 9],
        size: [14, 20],
    };
    let part = BakeOptions {
        region: Some(region),
        ..options(size)
    };
    for (whole, part) in whole.iter().zip(bake(&plan, &part)) {
        assert!(crop(whole, size, region) == part, "a region");
    }
    let banded = BakeOptions {
        memory: BakeMemory::Banded,
        ..options(size)
    };
    let error = Bake::new(&plan, &banded).unwrap_err();
    let is_global = matches!(error.kind(), RecipeErrorKind::Global { .. });
    assert!(is_global && error.node() == Some("soft"), "{error}");
    let error = plan.height().unwrap_err();
    assert_eq!(error.node(), Some("soft"), "{error}");
}

#[test]
fn a_field_has_values_in_windows_and_an_error_at_positions() {
    let plan = plan(MOVED);
    let size = [40, 30];
    let window = plan.window(size).unwrap();
    let field = plan.field("soft").unwrap();
    let raster = field.to_raster(&window).unwrap();
    assert_eq!(raster, numbers(&plan, "soft", size));
    let part = window.crop([13, 7], [9, 20]).unwrap();
    let cropped = raster.crop([13, 7], [9, 20]).unwrap();
    assert_eq!(field.to_raster(&part).unwrap(), cropped);
    let error = field.sample_many(&[DVec2::ONE], &mut [0.0]).unwrap_err();
    assert!(error.to_string().contains("single position"), "{error}");
    assert!(field.sample(DVec2::ONE).is_nan());
    let colors = plan.colors("soft").unwrap();
    let error = colors.sample([0.5, 0.5]).unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::Global { .. }),
        "{error}"
    );
    assert_eq!(
        colors.to_raster(&part).unwrap().row(3)[4].r,
        cropped.row(3)[4]
    );
}

#[test]
fn images_of_whole_tiles_are_read_past_the_sides() {
    // The global node repeats, and so does its blur.
    let text = "dapple = 1\n[nodes]\nx.coordinate = {}\nt.tile = { input = \"x\", method = \"periodic\" }\n\
                soft.blur = { input = \"t\", radius = 0.1 }\n[material]\nheight = \"soft\"\n";
    let plan = plan(text);
    let (size, [t, soft]) = (
        [24, 8],
        ["t", "soft"].map(|node| numbers(&plan, node, [24, 8])),
    );
    assert_near(
        &soft,
        |x, y| blur::naive(&t, [x, y], 0.1, [24.0, 8.0]),
        1e-5,
    );
    assert_eq!(numbers(&plan, "soft", size), soft);
}

#[test]
fn radii_out_of_range_are_refused_with_the_node() {
    let refused = |node: &str| {
        let text = format!("dapple = 1\nextent = [2.0, 1.0]\nnodes.a = {{ {node} }}\n[material]\n");
        let plan =
            Recipe::from_toml(&text).and_then(|recipe| Plan::new(&recipe, &Images::new(), 0.0));
        plan.map(|_| ()).unwrap_err()
    };
    let kinds = [
        "blur",
        "sharpen",
        "edges",
        "dilate",
        "erode",
        "distance_to",
        "slope",
        "curvature",
        "occlusion",
    ];
    for kind in kinds {
        let error = refused(&format!("{kind} = {{ input = 0.5, radius = 2.1 }}"));
        assert!(
            error.to_string().contains("at most the longer side"),
            "{kind}: {error}"
        );
    }
    for radius in ["0", "-0.1", "2.1", "nan", "inf"] {
        let error = refused(&format!("blur = {{ input = 0.5, radius = {radius} }}"));
        let is_radius = matches!(error.kind(), RecipeErrorKind::Range { what: "radius", .. });
        assert!(is_radius && error.node() == Some("a"), "{error}");
    }
    let error = refused("blur = { input = 0.5, radius = 0.1, one_sided = true }");
    assert!(
        matches!(error.kind(), RecipeErrorKind::Conflict { .. }),
        "{error}"
    );
    let error = refused("blur = { input = 0.5, radius = 0.1, along = inf }");
    assert!(
        matches!(error.kind(), RecipeErrorKind::Range { .. }),
        "{error}"
    );
    let error = refused("slope = { input = \"#fff\" }");
    assert!(
        matches!(error.kind(), RecipeErrorKind::NotANumber { .. }),
        "{error}"
    );
}

#[test]
fn large_halos_are_refused_before_any_work() {
    let text = |nodes: &str| {
        format!("dapple = 1\n[nodes]\nx.coordinate = {{}}\n{nodes}[material]\nheight = \"top\"\n")
    };
    let options = |size| BakeOptions {
        size: [size; 2],
        ..BakeOptions::default()
    };
    // The halo is three radii, so twelve tiles for four blurs side by side.
    let side_by_side: String = (0..4)
        .map(|index| format!("a{index}.blur = {{ input = \"x\", radius = 1 }}\n"))
        .collect();
    let plan = plan(&text(
        &(side_by_side + "top.add = [\"a0\", \"a1\", \"a2\", \"a3\"]\n"),
    ));
    let error = Bake::new(&plan, &options(3000)).unwrap_err();
    let is_halo = matches!(error.kind(), RecipeErrorKind::TooMuch { limit: 32_768, value, .. } if *value == 36_000.0);
    assert!(is_halo && error.node() == Some("a0"), "{error}");
    // Even a single pixel needs 1201 × 1201 pixels of `x`.
    let limits = PlanLimits {
        pixels: 1 << 20,
        ..PlanLimits::default()
    };
    let nested =
        "a.blur = { input = \"x\", radius = 1 }\ntop.blur = { input = \"a\", radius = 1 }\n";
    let recipe = Recipe::from_toml(&text(nested)).unwrap();
    let plan = Plan::new_within(&recipe, &Images::new(), 0.0, &limits).unwrap();
    let error = Bake::new(&plan, &options(100)).unwrap_err();
    let is_pixels = matches!(
        error.kind(),
        RecipeErrorKind::TooMuch {
            limit: 1_048_576,
            ..
        }
    );
    assert!(is_pixels && error.node() == Some("a"), "{error}");
}
