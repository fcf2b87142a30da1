//! Tests of nodes that combine copies and pieces of other nodes.

use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_recipe::{
    Bake, BakeOptions, ImageAlpha, Images, MapKind, MapRows, Plan, Recipe, RecipeError,
    RecipeErrorKind,
};
use dapple_tile::{CornerTiles, Disturbance, Map, MatchBorders};

/// Two repeating textures, `a` and `b`, and a color ramp `c` of `b`.
const TEXTURES: &str = "\
dapple = 1
extent = [4.0, 4.0]
nodes.a = { worley = { value = \"f2_minus_f1\", frequency = 2.0, seed = 1 } }
nodes.b = { worley = { value = \"f2_minus_f1\", frequency = 2.0, seed = 2 } }
nodes.c = { ramp = { input = \"b\", colors = [\"#000000\", \"#ffffff\"] } }
";

/// Renders a node as the albedo. `node` is its TOML. Numbers become grays.
fn albedo(node: &str, size: [u32; 2]) -> Result<Raster<LinearRgb>, RecipeError> {
    let text = format!("{TEXTURES}nodes.x = {node}\n[material]\nalbedo = \"x\"\n");
    let recipe = Recipe::from_toml(&text)?;
    // Writing and reading again must not change the recipe.
    let again = Recipe::from_toml(&recipe.to_toml()?)?;
    assert_eq!(again.to_json()?, recipe.to_json()?, "{node}");
    let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
    let options = BakeOptions {
        size,
        maps: vec![MapKind::Albedo],
        ..BakeOptions::default()
    };
    let mut pixels = Vec::new();
    for band in Bake::new(&plan, &options)? {
        match band?.maps.swap_remove(0) {
            (_, MapRows::Color(rows)) => pixels.extend_from_slice(rows.pixels()),
            other => panic!("{other:?}"),
        }
    }
    Ok(Raster::from_vec(size, pixels)?)
}

fn map(node: &str, size: [u32; 2]) -> Vec<Map> {
    let node = format!("{{ multiply = [\"{node}\", \"#ffffff\"] }}");
    vec![Map::Color(albedo(&node, size).unwrap())]
}

fn color(maps: Vec<Map>) -> Raster<LinearRgb> {
    match maps.into_iter().next() {
        Some(Map::Color(raster)) => raster,
        other => panic!("{other:?}"),
    }
}

/// Returns the seed that the node `x` of [`TEXTURES`] has.
fn seed() -> dapple_hash::Seed {
    let text = format!("{TEXTURES}[material]\n");
    Recipe::from_toml(&text).unwrap().seed.child("x", 0)
}

#[test]
fn disturb_is_the_disturbed_tile_of_the_library() {
    let node = "{ disturb = { input = \"c\", copies = [2, 3], frozen = 2, margin = 6 } }";
    let disturbance = Disturbance {
        frozen: 2,
        margin: 6,
        seed: seed(),
    };
    let expected = disturbance.render_maps(&map("c", [32, 16]), [0, 0], [64, 48]);
    assert_eq!(albedo(node, [64, 48]).unwrap(), color(expected.unwrap()));
}

#[test]
fn corner_tiles_are_those_of_the_library_and_repeat() {
    let node = "{ corner_tiles = { inputs = [\"a\", \"c\"], copies = [2, 2], seed = \"x\" } }";
    let set = CornerTiles::new(&[map("a", [32, 24]), map("c", [32, 24])]).unwrap();
    let set = set.with_period([Some(2); 2]).unwrap();
    let expected = set.render(seed(), [0, 0], [64, 48]).unwrap();
    assert_eq!(albedo(node, [64, 48]).unwrap(), color(expected));
}

#[test]
fn match_borders_is_the_second_of_two_tiles_of_the_library() {
    let node = "{ match_borders = { input = \"c\", border = \"a\", options = { width = 9 } } }";
    let options = MatchBorders {
        width: 9,
        ..MatchBorders::default()
    };
    let tiles = [map("a", [40, 40]), map("c", [40, 40])];
    let expected = options.apply_maps(&tiles).unwrap().swap_remove(1);
    assert_eq!(albedo(node, [40, 40]).unwrap(), color(expected));
}

#[test]
fn copies_that_cannot_be_are_refused_with_the_limit() {
    for (node, part) in [
        (
            "{ disturb = { input = \"a\", copies = [0, 2] } }",
            "number of copies is 0",
        ),
        (
            "{ disturb = { input = \"a\", copies = [3, 3], margin = 4 } }",
            "along a side of a copy is 21.33",
        ),
        (
            "{ disturb = { input = \"a\", copies = [4, 4] } }",
            "a margin of 28 pixels",
        ),
        ("{ disturb = { input = \"a\", ramp = 4 } }", "ramp"),
        ("{ corner_tiles = { inputs = [\"a\"] } }", "2 to 4"),
        (
            "{ corner_tiles = { inputs = [\"a\", \"b\"], copies = [0, 1] } }",
            "number of copies is 0",
        ),
        (
            "{ corner_tiles = { inputs = [\"a\", \"b\"], width = 2.0 } }",
            "width of the cuts is 2",
        ),
        (
            "{ match_borders = { input = \"a\", border = \"b\", options = { width = 0 } } }",
            "width is 0",
        ),
        (
            "{ match_borders = { input = \"a\", border = \"b\", options = { source = \"rim\" } } }",
            "rim",
        ),
    ] {
        let error = albedo(node, [64, 64]).expect_err(node);
        assert!(error.to_string().contains(part), "{node}: {error}");
    }
}

#[test]
fn nodes_say_what_becomes_of_the_alpha_of_an_image() {
    let recipe = |alphas: [&str; 2]| {
        let node = |alpha: &str| format!("{{ image = {{ file = \"leaf.png\"{alpha} }} }}\n");
        let [a, b] = alphas.map(node);
        let text = format!("dapple = 1\nnodes.a = {a}nodes.b = {b}[material]\n");
        Recipe::from_toml(&text)
    };
    let (drop, over) = (", alpha = \"drop\"", ", alpha = \"over:#ff0000\"");
    let alpha = |alphas| {
        let recipe = recipe(alphas).unwrap();
        let sources = recipe.image_sources().unwrap();
        assert_eq!((sources.len(), sources[0].file), (1, "leaf.png"));
        sources[0].alpha
    };
    assert_eq!(alpha(["", ""]), None);
    assert_eq!(alpha([drop, drop]), Some(ImageAlpha::Drop));
    let red = LinearRgb::new(1.0, 0.0, 0.0);
    assert_eq!(alpha([over, over]), Some(ImageAlpha::Over(red)));
    let text = recipe([over, over]).unwrap().to_toml().unwrap();
    assert_eq!(text.matches("over:#ff0000").count(), 2, "{text}");
    let recipe_of_two = recipe([drop, over]).unwrap();
    let error = recipe_of_two.image_sources().unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::Conflict { .. }),
        "{error}"
    );
    for alpha in ["keep", "over", "over:reddish", ""] {
        let error = recipe([&format!(", alpha = \"{alpha}\""), ""]).unwrap_err();
        assert!(error.to_string().contains("over:#ffffff"), "{error}");
    }
}
