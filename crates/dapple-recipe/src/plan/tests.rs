//! Tests of what a plan refuses.

use crate::{Images, Plan, Recipe, RecipeError, RecipeErrorKind};
use dapple_raster::{Field, glam::DVec2};

/// What is wrong with a recipe of these nodes, whose height is the node `a`.
fn refusal(nodes: &str) -> RecipeError {
    let text = format!("dapple = 1\n{nodes}\n[material]\nheight = \"a\"\n");
    let recipe = Recipe::from_toml(&text).unwrap_or_else(|error| panic!("{nodes}: {error}"));
    Plan::new(&recipe, &Images::new(), 0.0).expect_err(nodes)
}

#[test]
fn a_name_that_no_node_has_is_told_with_the_nearest_one() {
    let error = refusal("[nodes]\nstones = { absolute = 1 }\na = { absolute = \"stnoes\" }");
    assert_eq!(
        error.kind(),
        &RecipeErrorKind::UnknownNode {
            name: "stnoes".into()
        },
        "{error}"
    );
    assert_eq!(
        (error.node(), error.nearest()),
        (Some("a"), Some("stones")),
        "{error}"
    );
    assert_eq!(
        error.to_string(),
        "in the node `a`: there is no node `stnoes`; did you mean `stones`?"
    );
}

#[test]
fn a_circle_is_told_with_the_way_round() {
    let error = refusal(
        "[nodes]\na = { absolute = \"b\" }\nb = { absolute = \"c\" }\nc = { add = [1, \"b\"] }",
    );
    let names = ["b", "c", "b"].map(str::to_owned).to_vec();
    assert_eq!(error.kind(), &RecipeErrorKind::Cycle { names }, "{error}");
}

#[test]
fn a_color_is_refused_where_a_number_is_needed() {
    for nodes in [
        "[nodes]\na = { color = \"#fff\" }",
        "[nodes]\nb = { color = \"#fff\" }\na = { absolute = \"b\" }",
        "[nodes]\na = { levels = { input = \"#102030\" } }",
        "[nodes]\na = { mix = { from = 0, to = 1, by = \"#fff\" } }",
        "[nodes]\na = { minimum = [0, \"#fff\"] }",
    ] {
        let error = refusal(nodes);
        assert!(
            matches!(error.kind(), RecipeErrorKind::NotANumber { .. }),
            "{nodes}: {error}"
        );
    }
}

#[test]
fn numbers_out_of_range_are_told_with_the_range() {
    for nodes in [
        "extent = [0, 1]\n[nodes]\na = { absolute = 1 }",
        "extent = [1, inf]\n[nodes]\na = { absolute = 1 }",
        "[nodes.a.worley]\nfrequency = 2.5",
        "[nodes.a.worley]\nfrequency = 0",
        "[nodes.a.worley]\nfrequency = nan",
        "[nodes.a.noise]\noctaves = 17",
        "[nodes.a.noise]\nfrequency = -1",
        "[nodes.a.noise]\ngain = 0",
        "[nodes.a.levels]\ninput = 1\nfrom = [2, 2]",
        "[nodes.a.levels]\ninput = 1\nto = [0, inf]",
        "[nodes.a.power]\ninput = 1\nexponent = 0",
        "[nodes.a.wave]\ninput = 1\nfrequency = inf",
        "[nodes.a.warp]\ninput = 1\nx = 0\ny = 0\namount = nan",
        "[nodes.a.coordinate]\nalong = [nan, 0]",
        "[nodes.a.distance]\ncenter = [0, inf]",
        "[nodes]\na = { absolute = 1e39 }",
    ] {
        let error = refusal(nodes);
        assert!(
            matches!(error.kind(), RecipeErrorKind::Range { .. }),
            "{nodes}: {error}"
        );
    }
}

#[test]
fn what_a_crate_refuses_is_told_with_the_node() {
    for nodes in [
        "[nodes.a.worley]\nscatter = { poisson = { density = 1000 } }",
        "[nodes.a.worley]\nmetric = { minkowski = 99 }",
        "[nodes.a.worley]\nrange = [1, 1]",
        "[nodes.a.pups.cow]\nspacing = -1",
        "[nodes.a.pups.noise]\nnet = { axis_scale = 0.1 }",
        "[nodes.a.pups.points]\npoints = []",
        "[nodes.a.wavelet]\nfrequency = 5",
        "[nodes.a.profile]\ninput = 1\nshape = { spots = { radius = 0 } }",
    ] {
        let error = refusal(nodes);
        assert_eq!(error.node(), Some("a"), "{nodes}: {error}");
    }
}

#[test]
fn what_excludes_each_other_is_told() {
    for nodes in [
        "[nodes.a.worley]\nvalue = \"cell_value\"\noctaves = { count = 3 }",
        "[nodes.a.worley]\nvalue = \"edge_distance\"\nmetric = \"manhattan\"",
        "[nodes.a.pups.noise]\ndomain = { origin = [0, 0], size = [1, 1], wrap = [true, true] }",
        "[nodes.b.ramp]\ninput = 1\n[nodes]\na = { absolute = 1 }",
        "[nodes.b.ramp]\ninput = 1\npalette = \"gray\"\ncolors = [\"#fff\"]\n[nodes]\na = { absolute = 1 }",
        "[nodes.b.ramp]\ninput = 1\ncolors = [\"#fff\"]\npositions = [0, 1]\n[nodes]\na = { absolute = 1 }",
    ] {
        let error = refusal(nodes);
        assert!(
            matches!(error.kind(), RecipeErrorKind::Conflict { .. }),
            "{nodes}: {error}"
        );
    }
}

#[test]
fn names_and_numbers_of_nodes_have_limits() {
    let error = refusal("[nodes]\n\"a b\" = { absolute = 1 }\na = { absolute = 1 }");
    assert_eq!(
        error.kind(),
        &RecipeErrorKind::Name { name: "a b".into() },
        "{error}"
    );
    let many: String = (0..1100)
        .map(|index| format!("n{index} = {{ absolute = 1 }}\n"))
        .collect();
    let error = refusal(&format!("[nodes]\n{many}"));
    assert!(
        matches!(error.kind(), RecipeErrorKind::Count { .. }),
        "{error}"
    );
    let error = refusal("[nodes]\na = { add = [] }");
    assert!(
        matches!(error.kind(), RecipeErrorKind::Count { .. }),
        "{error}"
    );
}

#[test]
fn a_long_chain_of_nodes_is_followed() {
    let chain: String = (1..1000)
        .map(|index| format!("n{index} = {{ add = [\"n{}\", 1] }}\n", index - 1))
        .collect();
    let text = format!(
        "dapple = 1\n[nodes]\nn0 = {{ absolute = 0 }}\n{chain}[material]\nheight = \"n999\"\n"
    );
    let plan = Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0).unwrap();
    assert_eq!(plan.height().sample(DVec2::ZERO), 999.0, "one for each");
}

#[test]
fn a_node_has_the_same_values_wherever_it_stands_in_the_recipe() {
    let node = "[nodes.stones.worley]\nfrequency = 4\n";
    let other = "[nodes.grain.wavelet]\n[nodes.more.noise]\n";
    let sample = |nodes: String| {
        let text = format!("dapple = 1\nseed = 3\n{nodes}[material]\nheight = \"stones\"\n");
        let plan = Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0).unwrap();
        plan.height().sample(DVec2::new(0.3, 0.6))
    };
    let alone = sample(node.to_owned());
    assert_eq!(alone, sample(format!("{node}{other}")), "first");
    assert_eq!(alone, sample(format!("{other}{node}")), "last");
}

#[test]
fn nodes_that_draw_by_one_name_see_the_same_points() {
    let text = "dapple = 1\n[nodes.a.worley]\nfrequency = 4\n[nodes.b.worley]\nfrequency = 4\nseed = \"a\"\n[nodes.c.worley]\nfrequency = 4\n[material]\n";
    let plan = Plan::new(&Recipe::from_toml(text).unwrap(), &Images::new(), 0.0).unwrap();
    let at = |name: &str| plan.field(name).unwrap().sample(DVec2::new(0.3, 0.6));
    assert_eq!(at("a"), at("b"), "by the name of another");
    assert_ne!(at("a"), at("c"), "by their own names");
}
