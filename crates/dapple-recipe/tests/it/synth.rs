//! Tests of the node `synth`.

use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_raster::Raster;
use dapple_recipe::{
    Bake, BakeMemory, BakeOptions, Images, MapKind, MapRows, Picture, Plan, PlanLimits, Recipe,
    RecipeError, RecipeErrorKind, Region,
};
use dapple_synth::{Edges, Endless, EndlessOptions, Exemplar};
use std::sync::Arc;

/// Returns images of stones in courses, and of their heights. Stones are 6 pixels high.
fn images() -> Images {
    let stone = |x: u32, y: u32| {
        ![x + 3 * (y / 6 % 2), y]
            .iter()
            .any(|at| at.is_multiple_of(6))
    };
    let colors = Raster::from_fn([48, 36], |x, y| {
        LinearRgb::new(f32::from(stone(x, y)), (x * y % 7) as f32 / 7.0, 0.25)
    });
    let heights = Raster::from_fn([48, 36], |x, y| f32::from(stone(x, y)));
    let large = Raster::from_fn([96, 72], |x, y| f32::from(stone(x / 2, y / 2)));
    Images::from([
        (
            "stones.png".into(),
            Picture::Colors(Arc::new(colors.unwrap())),
        ),
        (
            "height.png".into(),
            Picture::Numbers(Arc::new(heights.unwrap())),
        ),
        (
            "large.png".into(),
            Picture::Numbers(Arc::new(large.unwrap())),
        ),
    ])
}

/// A recipe whose color and height are synthesized together.
const RECIPE: &str = "\
dapple = 1
seed = 5
[nodes]
color = { synth = { file = \"stones.png\", size = [64, 32], levels = 4, edges = \"wrap\" } }
height = { synth = { file = \"height.png\", example = \"stones.png\", size = [64, 32], levels = 4, edges = \"wrap\", seed = \"color\" } }
[material]
albedo = \"color\"
height = \"height\"
";

fn plan(text: &str) -> Result<Plan, RecipeError> {
    Plan::new(&Recipe::from_toml(text)?, &images(), 0.0)
}

/// Returns the baked albedo and height.
fn bake(plan: &Plan, options: BakeOptions) -> (Vec<LinearRgb>, Vec<f32>) {
    let options = BakeOptions {
        maps: vec![MapKind::Albedo, MapKind::Height],
        ..options
    };
    let (mut colors, mut heights) = (Vec::new(), Vec::new());
    for band in Bake::new(plan, &options).unwrap() {
        for (_, rows) in band.unwrap().maps {
            match rows {
                MapRows::Color(rows) => colors.extend_from_slice(rows.pixels()),
                MapRows::Gray(rows) => heights.extend_from_slice(rows.pixels()),
                other => panic!("{other:?}"),
            }
        }
    }
    (colors, heights)
}

#[test]
fn the_texture_is_that_of_the_library_and_maps_follow_it() {
    let images = images();
    let Picture::Colors(example) = &images["stones.png"] else {
        panic!("stones are colors")
    };
    let options = EndlessOptions {
        seed: Seed(5).child("color", 0),
        n_levels: Some(4),
        period: [Some(64), Some(32)],
    };
    let exemplar = Exemplar::new(example, Edges::Wrap).unwrap();
    let endless = Endless::new(&exemplar, &options).unwrap();
    let window = endless.window([0; 2], [64, 32], |_| ControlFlow::Continue(()));
    let expected = window.unwrap().transfer(example).unwrap();
    let size = [64, 32];
    let whole = BakeOptions {
        size,
        ..BakeOptions::default()
    };
    let (colors, heights) = bake(&plan(RECIPE).unwrap(), whole.clone());
    assert!(
        colors == expected.pixels(),
        "pixel by pixel at its own size"
    );
    let is_stone = colors.iter().map(|color| color.r);
    assert!(is_stone.eq(heights.iter().copied()), "heights follow");
    // A larger map is followed as well, and shows what is between the pixels.
    let text = RECIPE.replace("file = \"height.png\"", "file = \"large.png\"");
    let twice = BakeOptions {
        size: [128, 64],
        ..whole
    };
    let (_, large) = bake(&plan(&text).unwrap(), twice);
    for (at, &height) in large.iter().enumerate() {
        let [x, y] = [at % 128 / 2, at / 128 / 2];
        assert_eq!(height, heights[64 * y + x], "pixel {at}");
    }
}

#[test]
fn bands_and_regions_have_the_bits_of_the_whole() {
    let plan = plan(RECIPE).unwrap();
    let size = [80, 60];
    let options = |memory, region| BakeOptions {
        size,
        memory,
        region,
        ..BakeOptions::default()
    };
    let default = BakeOptions::default().memory;
    let (colors, heights) = bake(&plan, options(default, None));
    assert!(
        bake(&plan, options(BakeMemory::Banded, None)) == (colors.clone(), heights),
        "in bands"
    );
    let region = Region {
        first: [20, 10],
        size: [30, 20],
    };
    let (part, _) = bake(&plan, options(default, Some(region)));
    let crop = (0..20).flat_map(|y| &colors[80 * (10 + y) + 20..][..30]);
    assert!(part.iter().eq(crop), "a region");
}

#[test]
fn what_cannot_be_grown_is_refused_with_its_node() {
    let error = |from: &str, to: &str| {
        assert!(RECIPE.contains(from), "{from}");
        plan(&RECIPE.replace(from, to)).expect_err(to)
    };
    let wide = "size = [64, 32], levels = 4, edges = \"wrap\" }";
    for (to, part) in [
        ("size = [64, 50], levels = 4 }", "period is 50"),
        (
            "size = [0, 32], levels = 4 }",
            "number of pixels along a side is 0",
        ),
        ("levels = 0 }", "number of levels"),
        ("levels = 9 }", "number of levels"),
    ] {
        let error = error(wide, to);
        assert!(error.to_string().contains(part), "{to}: {error}");
        assert_eq!(error.node(), Some("color"), "{to}");
    }
    let missing = error("file = \"stones.png\"", "file = \"other.png\"");
    assert!(matches!(missing.kind(), RecipeErrorKind::NoImage { .. }));
    let unlike = error(
        "file = \"height.png\", example = \"stones.png\"",
        "file = \"height.png\", example = \"large.png\"",
    );
    assert!(
        matches!(unlike.kind(), RecipeErrorKind::Synth(_)),
        "{unlike}"
    );
    // Without a wrap any size is one.
    let free = RECIPE.replace("seed = 5", "seed = 5\nwrap = [false, false]");
    assert!(plan(&free.replace("[64, 32]", "[63, 51]")).is_ok());
    let limits = PlanLimits {
        synthesized_pixels: 64 * 32 * 3 / 2,
        ..PlanLimits::default()
    };
    let recipe = Recipe::from_toml(RECIPE).unwrap();
    let error = Plan::new_within(&recipe, &images(), 0.0, &limits).unwrap_err();
    let kind = error.kind();
    assert!(
        matches!(kind, RecipeErrorKind::TooMuch { value: 4096.0, .. }),
        "{error}"
    );
    assert_eq!(error.node(), Some("height"), "both together");
}

#[test]
fn a_recipe_names_both_images_of_a_node() {
    let recipe = Recipe::from_toml(RECIPE).unwrap();
    assert_eq!(recipe.image_files(), ["stones.png", "height.png"]);
    let again = Recipe::from_toml(&recipe.to_toml().unwrap()).unwrap();
    assert_eq!(again.to_json(), recipe.to_json(), "as it was written");
}
