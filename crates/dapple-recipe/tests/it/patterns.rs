//! Tests of pattern nodes, and of secondary outputs of nodes.

use dapple_recipe::raster::{Field as _, Named as _, Raster};
use dapple_recipe::{
    Images, NEW_NODES, Plan, PlanCache, PlanLimits, Recipe, RecipeError, RecipeErrorKind,
};

/// Returns the recipe with these nodes.
fn recipe(nodes: &str) -> Recipe {
    let text = format!("dapple = 1\nseed = 5\n{nodes}\n[material]\n");
    Recipe::from_toml(&text).unwrap_or_else(|error| panic!("{nodes}: {error}"))
}

/// Plans a recipe and renders a node of it.
fn try_rendered(recipe: &Recipe, node: &str) -> Result<Raster<f32>, RecipeError> {
    let plan = Plan::new(recipe, &Images::new(), 0.0)?;
    Ok(plan.field(node)?.to_raster(&plan.window([48, 32])?)?)
}

fn rendered(nodes: &str, node: &str) -> Raster<f32> {
    try_rendered(&recipe(nodes), node).unwrap_or_else(|error| panic!("{nodes}: {error}"))
}

#[test]
fn outputs_equal_the_node_with_that_value_and_seed() {
    for &value in dapple_pattern::BrickValue::NAMES {
        let nodes = format!(
            "[nodes]\nwall.bricks = {{ bond = \"flemish\", jitter = 0.5 }}\n\
             a.output = {{ of = \"wall\", value = \"{value}\" }}\n\
             b.bricks = {{ bond = \"flemish\", jitter = 0.5, value = \"{value}\", seed = \"wall\" }}"
        );
        assert_eq!(rendered(&nodes, "a"), rendered(&nodes, "b"), "{value}");
    }
    for &value in dapple_pattern::WeaveValue::NAMES {
        let nodes = format!(
            "[nodes]\ncloth.weave = {{ draft = \"twill\", jitter = 0.5 }}\n\
             a.output = {{ of = \"cloth\", value = \"{value}\" }}\n\
             b.weave = {{ draft = \"twill\", jitter = 0.5, value = \"{value}\", seed = \"cloth\" }}"
        );
        assert_eq!(rendered(&nodes, "a"), rendered(&nodes, "b"), "{value}");
    }
    for &value in dapple_pattern::StampValue::NAMES {
        let nodes = format!(
            "[nodes]\nstones.scatter = {{ shape = \"pebble\", density = 2 }}\n\
             a.output = {{ of = \"stones\", value = \"{value}\" }}\n\
             b.scatter = {{ shape = \"pebble\", density = 2, value = \"{value}\", seed = \"stones\" }}"
        );
        assert_eq!(rendered(&nodes, "a"), rendered(&nodes, "b"), "{value}");
    }
    for &value in dapple_pattern::GaborValue::NAMES {
        let nodes = format!(
            "[nodes]\nfibers.gabor = {{ frequency = 4 }}\n\
             a.output = {{ of = \"fibers\", value = \"{value}\" }}\n\
             b.gabor = {{ frequency = 4, value = \"{value}\", seed = \"fibers\" }}"
        );
        assert_eq!(rendered(&nodes, "a"), rendered(&nodes, "b"), "{value}");
    }
    let nodes = "[nodes]\n\
        star.shape = { kind = \"star\", frequency = 2 }\n\
        a.output = { of = \"star\", value = \"mask\" }\n\
        b.shape = { kind = \"star\", frequency = 2, value = \"mask\" }";
    assert_eq!(rendered(nodes, "a"), rendered(nodes, "b"));
    // The range of a Worley node belongs to its own value.
    let nodes = "[nodes]\n\
        cells.worley = { frequency = 4, value = \"f1\", range = [0.0, 1.0] }\n\
        a.output = { of = \"cells\", value = \"cell_value\" }\n\
        b.worley = { frequency = 4, value = \"cell_value\", seed = \"cells\" }";
    assert_eq!(rendered(nodes, "a"), rendered(nodes, "b"));
    // A constant is its own value.
    let nodes = "[nodes]\na.output = { of = 0.25 }";
    assert_eq!(rendered(nodes, "a").pixels(), [0.25; 48 * 32]);
}

#[test]
fn outputs_that_a_node_lacks_are_refused_with_those_that_it_has() {
    let error = |nodes: &str| try_rendered(&recipe(nodes), "a").expect_err(nodes);
    let unknown =
        error("[nodes]\nwall.bricks = {}\na.output = { of = \"wall\", value = \"hieght\" }");
    assert_eq!(
        unknown.to_string(),
        "in the node `a`: the node has no value `hieght`, but height, edge_distance, random, random2, random3, u, v, \
         column, row, direction; did you mean `height`?"
    );
    let single = error("[nodes]\ngrain.noise = {}\na.output = { of = \"grain\" }");
    let RecipeErrorKind::SingleOutput { node, kinds } = single.kind() else {
        panic!("{single}");
    };
    assert_eq!(node, "`grain`");
    assert!(
        kinds.contains(&"worley") && kinds.contains(&"bricks"),
        "{kinds:?}"
    );
    let none = error("[nodes]\nwall.bricks = {}\na.output = { of = \"wlal\" }");
    assert_eq!(none.nearest(), Some("wall"), "{none}");
    let cycle = error("[nodes]\na.output = { of = \"b\" }\nb.output = { of = \"a\" }");
    assert!(
        matches!(cycle.kind(), RecipeErrorKind::Cycle { .. }),
        "{cycle}"
    );
}

#[test]
fn outputs_in_a_cache_follow_the_options_of_their_node() {
    let text = |bond: &str| {
        format!(
            "[nodes]\nwall.bricks = {{ bond = \"{bond}\" }}\na.output = {{ of = \"wall\", value = \"u\" }}"
        )
    };
    let (images, limits, cache) = (
        Images::new(),
        PlanLimits::default(),
        PlanCache::new(1 << 24),
    );
    let mut pictures = Vec::new();
    for bond in ["running", "stack", "running"] {
        let recipe = recipe(&text(bond));
        let cached = Plan::new_with_cache(&recipe, &images, 0.0, &limits, &cache).unwrap();
        let picture = cached.node_picture("a", [32, 32], None).unwrap();
        let fresh = Plan::new(&recipe, &images, 0.0).unwrap();
        assert_eq!(
            picture,
            fresh.node_picture("a", [32, 32], None).unwrap(),
            "{bond}"
        );
        pictures.push(picture);
    }
    assert_ne!(pictures[0], pictures[1]);
    assert_eq!(pictures[0], pictures[2]);
}

#[test]
fn outputs_of_moving_nodes_move() {
    let nodes = "[nodes]\n\
        cells.worley = { frequency = 4, motion = { cells = 2 } }\n\
        a.output = { of = \"cells\", value = \"cell_value\" }";
    let cache = PlanCache::new(1 << 24);
    let picture = |time: f64| {
        let (images, limits) = (Images::new(), PlanLimits::default());
        let plan = Plan::new_with_cache(&recipe(nodes), &images, time, &limits, &cache).unwrap();
        assert!(plan.moves(), "the node of the output moves");
        plan.node_picture("a", [32, 32], None).unwrap()
    };
    let [first, later, again] = [0.0, 0.25, 0.0].map(picture);
    assert_ne!(first, later);
    assert_eq!(first, again);
}

#[test]
fn patterns_whose_period_does_not_fit_the_tile_are_refused() {
    for (nodes, message) in [
        (
            "[nodes]\na.bricks = { frequency = [4, 3] }",
            "in the node `a`: the number of courses in the period is 3, but it must be even, for courses or bricks \
             alternate",
        ),
        (
            "[nodes]\na.bricks = { frequency = [4.5, 4] }",
            "in the node `a`: the number of cells along a side of the tile is 4.5, but it must be a whole number, at \
             least 1 (extent times frequency, since the recipe repeats)",
        ),
    ] {
        let error = try_rendered(&recipe(nodes), "a").expect_err(nodes);
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn shapes_repeat_with_the_tile_where_the_recipe_does() {
    // The circle at the left side continues on the right.
    let nodes = "[nodes]\na.shape = { center = [0.0, 0.5], size = 0.25 }";
    let raster = rendered(nodes, "a");
    let [left, right] = [0, 47].map(|column| raster.row(16)[column]);
    assert_eq!(left, right);
    assert!(left < -0.2, "{left}");
    // Without repeats, there is a single circle.
    let alone = recipe(&format!("wrap = [false, true]\n{nodes}"));
    let raster = try_rendered(&alone, "a").unwrap();
    assert!(raster.row(16)[47] > 0.7, "{}", raster.row(16)[47]);
    let error = try_rendered(&recipe("[nodes]\na.shape = { frequency = 1.5 }"), "a").unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::Range { .. }),
        "{error}"
    );
}

#[test]
fn smooth_minima_equal_the_minimum_past_the_radius_and_are_lower_by_a_quarter_between() {
    let value = |node: &str| rendered(&format!("[nodes]\na.{node}"), "a").row(0)[0];
    assert_eq!(
        value("smooth_minimum = { inputs = [0.25, 0.75], radius = 0.5 }"),
        0.25
    );
    assert_eq!(
        value("smooth_maximum = { inputs = [0.25, 0.75], radius = 0.5 }"),
        0.75
    );
    assert_eq!(
        value("smooth_minimum = { inputs = [0.5, 0.5], radius = 0.5 }"),
        0.375
    );
    assert_eq!(
        value("smooth_maximum = { inputs = [0.5, 0.5], radius = 0.5 }"),
        0.625
    );
    // The overlap is ¼: its square, divided by four times the radius.
    assert_eq!(
        value("smooth_minimum = { inputs = [0.75, 0.5], radius = 0.5 }"),
        0.5 - 0.03125
    );
    assert_eq!(
        value("smooth_minimum = { inputs = [0.5, 0.5], radius = 0.0 }"),
        0.5
    );
    let negative = recipe("[nodes]\na.smooth_minimum = { inputs = [1.0], radius = -1.0 }");
    let error = try_rendered(&negative, "a").unwrap_err();
    assert_eq!(
        error.to_string(),
        "in the node `a`: the radius is -1, but it must be from 0 to 1e6"
    );
}

#[test]
fn new_nodes_of_patterns_build_on_a_tile_of_one_unit() {
    for (kind, (group, options)) in dapple_recipe::KINDS.into_iter().zip(NEW_NODES) {
        if group == "patterns" {
            let text = format!(
                "{{\"dapple\":1,\"nodes\":{{\"a\":{{\"{kind}\":{options}}}}},\"material\":{{}}}}"
            );
            let raster = try_rendered(&Recipe::from_json(&text).unwrap(), "a").unwrap();
            assert!(
                raster.pixels().iter().all(|value| value.is_finite()),
                "{kind}"
            );
        }
    }
}

#[test]
fn the_wall_of_the_readme_has_at_most_12_nodes_and_bakes() {
    let readme = include_str!("../../README.md");
    let wall = readme.split("```toml\n").nth(2).expect("a second recipe");
    let recipe = Recipe::from_toml(wall.split("```").next().expect("its end")).unwrap();
    assert!(recipe.nodes.len() <= 12, "{} nodes", recipe.nodes.len());
    let height = try_rendered(&recipe, "height").unwrap();
    let [least, most] = [f32::INFINITY, f32::NEG_INFINITY];
    let least = height.pixels().iter().copied().fold(least, f32::min);
    let most = height.pixels().iter().copied().fold(most, f32::max);
    assert!(
        (0.0..0.3).contains(&least) && (0.7..=1.0).contains(&most),
        "{least} to {most}"
    );
}
