//! Tests of the errors of a plan.

use dapple_raster::{Field, FieldExt as _, glam::DVec2};
use dapple_recipe::{Images, Plan, PlanLimits, Recipe, RecipeError, RecipeErrorKind};

/// Returns the error of a recipe with these nodes, whose height is the node `a`.
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
fn wavelet_noise_on_a_tile_that_is_not_square_repeats_after_the_tile_alone() {
    let text = |nodes| {
        format!("dapple = 1\nextent = [12, 8]\n[nodes]\na = {nodes}\n[material]\nheight = \"a\"\n")
    };
    for nodes in [
        "{ wavelet = { frequency = 1 } }",
        "{ noise = { basis = \"wavelet\", frequency = 1, octaves = 3 } }",
    ] {
        let recipe = Recipe::from_toml(&text(nodes)).unwrap();
        let plan = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
        let height = plan.height().unwrap();
        let same = |step: DVec2| {
            let places =
                (0..64).map(|index| DVec2::new(f64::from(index % 8), f64::from(index / 8)));
            let same = places.filter(|&at| height.sample(at) == height.sample(at + step));
            same.count()
        };
        assert_eq!(same(DVec2::new(12.0, -8.0)), 64, "{nodes}");
        // The greatest period of both sides.
        for step in [DVec2::X * 4.0, DVec2::Y * 4.0] {
            assert!(same(step) < 4, "{nodes} repeats after {step}");
        }
    }
}

#[test]
fn wavelet_noise_of_sides_that_cannot_repeat_is_told_with_the_number_of_cells() {
    for (frequency, cells) in [(2, 2.0), (5, 5.0)] {
        let error = refusal(&format!("[nodes.a.wavelet]\nfrequency = {frequency}"));
        let is_range = matches!(error.kind(), RecipeErrorKind::Range { what, value, .. }
            if what.contains("wavelet noise") && *value == cells);
        assert!(is_range, "{error}");
    }
}

#[test]
fn relief_past_its_range_is_refused_with_the_range() {
    let plan = |relief: &str| {
        let text = format!("dapple = 1\n[material]\nrelief = {relief}\n");
        Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0)
    };
    for relief in ["1e300", "-1.0001e6", "nan"] {
        let error = plan(relief).expect_err(relief);
        assert!(error.to_string().contains("from -1e6 to 1e6"), "{error}");
    }
    for relief in ["1e6", "-1e6", "0"] {
        assert!(plan(relief).is_ok(), "{relief}");
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
    assert_eq!(
        plan.height().unwrap().sample(DVec2::ZERO),
        999.0,
        "one for each"
    );
}

#[test]
fn a_node_has_the_same_values_wherever_it_stands_in_the_recipe() {
    let node = "[nodes.stones.worley]\nfrequency = 4\n";
    let other = "[nodes.grain.wavelet]\n[nodes.more.noise]\n";
    let sample = |nodes: String| {
        let text = format!("dapple = 1\nseed = 3\n{nodes}[material]\nheight = \"stones\"\n");
        let plan = Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0).unwrap();
        plan.height().unwrap().sample(DVec2::new(0.3, 0.6))
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

/// Returns the counted item that exceeds its limit in a recipe with these nodes, and the name of the node that the
/// error reports.
fn too_much(nodes: &str, limits: &PlanLimits) -> (&'static str, Option<String>) {
    let text = format!("dapple = 1\n{nodes}\n[material]\n");
    let recipe = Recipe::from_toml(&text).unwrap_or_else(|error| panic!("{nodes}: {error}"));
    let error = Plan::new_within(&recipe, &Images::new(), 0.0, limits).expect_err(nodes);
    let RecipeErrorKind::TooMuch { what, value, limit } = *error.kind() else {
        panic!("{nodes}: {error}");
    };
    assert!(value > limit as f64, "{nodes}: {error}");
    (what, error.node().map(str::to_owned))
}

#[test]
fn a_recipe_that_asks_for_too_much_is_refused_before_the_work() {
    let (points, cells) = ("control points", "cells of wavelet noise");
    for (nodes, what) in [
        ("a.noise.frequency = 100_000", points),
        ("a.noise.octaves = 16", points),
        ("a.pups.noise.spacing = 1e-9", points),
        ("a.pups.octaves = { octaves = 16 }", points),
        (
            "a.pups.turbulence = { octaves = 3, lacunarity = 16, spacing = 0.01 }",
            points,
        ),
        ("a.pups.cells.spacing = { count = 4_000_000_000 }", points),
        ("a.pups.cellular_noise = { layers = 16 }", points),
        ("a.pups.color_noise.spacing = { density = 1e8 }", points),
        ("a.pups.cow.spacing = 1e-4", points),
        (
            "a.pups.space_giraffe = { spacing = 0.004, pairs = [256, 256] }",
            points,
        ),
        ("a.pups.cow_progression.distances = [1e-4, 1e-4]", points),
        (
            "a.pups.giraffe_progression.distances = [1e-3, 1e-3]",
            points,
        ),
        ("a.pups.label_ramp.spacing = 1e-4", points),
        ("a.wavelet.frequency = 30_000", cells),
        (
            "a.noise = { basis = \"wavelet\", frequency = 30_000 }",
            cells,
        ),
    ] {
        let nodes = format!("[nodes]\n{nodes}");
        let found = too_much(&nodes, &PlanLimits::default());
        assert_eq!(found, (what, Some("a".to_owned())), "{nodes}");
    }
}

#[test]
fn the_work_of_all_nodes_counts_together() {
    let limits = PlanLimits {
        control_points: 1000,
        ..PlanLimits::default()
    };
    let one = "[nodes]\na.pups.cow.spacing = { count = 600 }\n";
    let text = format!("dapple = 1\n{one}[material]\n");
    let recipe = Recipe::from_toml(&text).unwrap();
    assert!(
        Plan::new_within(&recipe, &Images::new(), 0.0, &limits).is_ok(),
        "one alone"
    );
    let two = format!("{one}b.pups.cow.spacing = {{ count = 600 }}\n");
    assert_eq!(
        too_much(&two, &limits),
        ("control points", Some("b".to_owned()))
    );
}

#[test]
fn warps_of_warps_are_refused_before_they_take_forever() {
    // Each warp evaluates the one before it twice.
    let chain = |count: u32, shift: fn(u32) -> String| {
        let warp = |index: u32| {
            let (before, shift) = (index - 1, shift(index - 1));
            format!("n{index} = {{ warp = {{ input = \"n{before}\", x = {shift}, y = 0 }} }}\n")
        };
        let warps: String = (1..=count).map(warp).collect();
        format!("[nodes]\nn0 = {{ coordinate = {{}} }}\n{warps}")
    };
    let limits = PlanLimits::default();
    let doubled = chain(30, |before| format!("\"n{before}\""));
    let (what, node) = too_much(&doubled, &limits);
    assert_eq!(what, "values for each pixel", "{node:?}");
    let deep = chain(33, |_| "0".to_owned());
    let found = too_much(&deep, &limits);
    assert_eq!(
        found,
        (
            "nested warps, transforms and fractal sums",
            Some("n33".to_owned())
        )
    );
    let many = format!("[nodes]\na = {{ add = {:?} }}\n", vec![1; 5000]);
    assert_eq!(too_much(&many, &limits).0, "values for each pixel");
}

#[test]
fn pictures_that_are_seen_as_a_whole_are_limited_together() {
    let text = "dapple = 1\n[nodes]\na.noise.octaves = 1\nb.tile = { input = \"a\" }\nc.tile = { input = \"b\" }\n[material]\nheight = \"c\"\n";
    let recipe = Recipe::from_toml(text).unwrap();
    let limits = PlanLimits {
        pixels: 2 * 64 * 64,
        ..PlanLimits::default()
    };
    let plan = Plan::new_within(&recipe, &Images::new(), 0.0, &limits).unwrap();
    assert!(plan.whole([64, 64]).is_ok(), "two pictures");
    let error = plan.whole([64, 65]).unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::TooMuch { limit: 8192, .. }),
        "{error}"
    );
    assert_eq!(error.node(), Some("b"), "the first of them");
}

#[test]
fn built_in_recipes_are_far_within_the_limits() {
    let all = PlanLimits::default();
    let limits = PlanLimits {
        control_points: all.control_points / 16,
        wavelet_cells: all.wavelet_cells / 16,
        synthesized_pixels: all.synthesized_pixels / 16,
        values: all.values / 16,
        warps: all.warps / 16,
        pixels: all.pixels / 16,
    };
    for name in Recipe::builtin_names() {
        let recipe = Recipe::builtin(name).unwrap();
        let plan = Plan::new_within(&recipe, &Images::new(), 0.0, &limits);
        assert!(plan.is_ok(), "{name}: {:?}", plan.err());
    }
}

#[test]
fn a_node_that_sees_the_whole_tile_is_refused_as_a_field() {
    let text = "dapple = 1\n[nodes]\na.coordinate = {}\nb.tile = { input = \"a\" }\nc = { absolute = \"b\" }\n[material]\nheight = \"c\"\n";
    let plan = Plan::new(&Recipe::from_toml(text).unwrap(), &Images::new(), 0.0).unwrap();
    for error in [
        plan.height().unwrap_err(),
        plan.field("c").unwrap_err(),
        plan.colors("c").unwrap_err(),
    ] {
        let is_global = matches!(error.kind(), RecipeErrorKind::Global { .. });
        assert!(is_global && error.node() == Some("b"), "{error}");
    }
    assert!(plan.field("a").is_ok(), "which is not made of it");
}

#[test]
fn a_node_that_refuses_its_values_is_an_error_and_not_black() {
    let text = "dapple = 1\n[nodes]\na.coordinate = {}\nb.blend = { layers = [{ input = \"#fff\", weight = \"a\" }, { input = \"#000\", weight = -1 }] }\nc.blend = { layers = [{ input = 1, weight = \"a\" }, { input = 0, weight = -1 }] }\n[material]\n";
    let plan = Plan::new(&Recipe::from_toml(text).unwrap(), &Images::new(), 0.0).unwrap();
    let window = plan.window([4, 4]).unwrap();
    let error = plan.colors("b").unwrap().to_raster(&window).unwrap_err();
    assert!(error.to_string().contains("is -1, but"), "{error}");
    let field = plan.field("c").unwrap();
    let error = field.to_raster(&window).unwrap_err();
    assert!(error.to_string().contains("is -1, but"), "{error}");
    let error = field.sample_many(&[DVec2::ONE], &mut [0.0]).unwrap_err();
    assert!(error.to_string().contains("is -1, but"), "{error}");
}

#[test]
fn gradient_noise_repeats_after_any_whole_number_of_cells() {
    let text = "dapple = 1\nnodes.a.noise = { basis = \"gradient\", frequency = 5 }\n[material]\nheight = \"a\"\n";
    let plan = Plan::new(&Recipe::from_toml(text).unwrap(), &Images::new(), 0.0).unwrap();
    let height = plan.height().unwrap();
    let at = DVec2::new(0.25, 0.625);
    assert_eq!(
        height.sample(at),
        height.sample(at + DVec2::ONE),
        "one tile on"
    );
}
