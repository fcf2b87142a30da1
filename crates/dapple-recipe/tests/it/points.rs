//! Tests of the control points of `pups` nodes as data.

use dapple_raster::{Field, Raster};
use dapple_recipe::{
    ControlNets, ControlPoint, Images, Node, Picture, Plan, PlanLimits, PupsNode, Recipe,
    RecipeErrorKind,
};
use std::sync::Arc;

/// Returns a recipe whose only node is `t`, a `pups` texture. `pups` is the TOML of its options.
fn recipe(pups: &str, wrap: [bool; 2]) -> Recipe {
    let text = format!(
        "dapple = 1\nseed = 5\nextent = [3.0, 2.0]\nwrap = [{}, {}]\n[nodes.t.pups]\n{pups}\n[material]\nheight = \"t\"\n",
        wrap[0], wrap[1]
    );
    Recipe::from_toml(&text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn images() -> Images {
    let image = Raster::from_fn([16, 16], |x, y| (x * y) as f32 / 225.0).unwrap();
    Images::from([("a.png".to_owned(), Picture::Numbers(Arc::new(image)))])
}

fn nets(recipe: &Recipe) -> ControlNets {
    let nets = recipe.control_nets("t", &images(), 0.0, &PlanLimits::default());
    nets.unwrap().expect("a node of control points")
}

/// Returns the bits of the recipe's heights.
fn bits(recipe: &Recipe) -> Vec<u32> {
    let plan = Plan::new(recipe, &images(), 0.0).unwrap();
    let window = plan.window([48, 32]).unwrap();
    let heights = plan.height().unwrap().to_raster(&window).unwrap();
    heights
        .pixels()
        .iter()
        .map(|value| value.to_bits())
        .collect()
}

const ONE_NET: [&str; 11] = [
    "noise = { spacing = 0.3 }",
    "noise = { spacing = 0.3, net = { axis_scale = 1.5, weight = \"quintic\", orientations = { angle = 0.5 } } }",
    "cells = { spacing = 0.3, points_per_cell = [3, 4] }",
    "cow = { spacing = 0.3, values = [0.2, 0.7], net = { orientations = { same = [0.1, 0.2, 0.3] } } }",
    "space_giraffe = { spacing = 0.5 }",
    "cow_progression = { distances = [0.5, 0.1] }",
    "giraffe_progression = { distances = [0.6, 0.3] }",
    "label_ramp = { spacing = 0.3 }",
    "reference = { file = \"a.png\", options = { spacing = 0.3 } }",
    "iterated_reference = { file = \"a.png\", options = { spacing = 0.4, iterations = 2 } }",
    "points = { points = [{ x = 2.9, y = 0.1, value = 0.25 }, { x = 4.0, y = 1.0, value = 1.0 }] }",
];

#[test]
fn textures_of_one_net_are_textures_of_points_bit_for_bit() {
    for pups in ONE_NET {
        for wrap in [[true, true], [false, true], [true, false], [false, false]] {
            if pups.starts_with("points") && !wrap[0] {
                continue;
            }
            let recipe = recipe(pups, wrap);
            let points = nets(&recipe)
                .points
                .unwrap_or_else(|| panic!("{pups}, {wrap:?}"));
            let mut edited = recipe.clone();
            edited.nodes["t"] = Node::Pups(PupsNode::Points(points));
            assert!(bits(&edited) == bits(&recipe), "{pups}, {wrap:?}");
            // As text, since that is where an editor keeps them.
            let edited = Recipe::from_toml(&edited.to_toml().unwrap()).unwrap();
            assert!(bits(&edited) == bits(&recipe), "{pups}, {wrap:?}");
        }
    }
}

#[test]
fn labels_that_points_share_stay_labels() {
    for pups in [
        "cells = { spacing = 0.3, points_per_cell = [3, 4] }",
        "space_giraffe = { spacing = 0.5 }",
        "label_ramp = { spacing = 0.3 }",
    ] {
        let mut points = nets(&recipe(pups, [false, true])).points.unwrap();
        assert!(points.values.len() * 2 < points.points.len(), "{pups}");
        let is_labeled =
            |label| move |point: &&ControlPoint| (point.value, point.label) == (None, Some(label));
        let n_labeled = |label| points.points.iter().filter(is_labeled(label)).count();
        let all: usize = (0..)
            .zip(&points.values)
            .map(|(label, _)| n_labeled(label))
            .sum();
        assert_eq!(all, points.points.len(), "{pups}");
        points.values[1] = 7.0;
        let mut changed = recipe(pups, [false, true]);
        changed.nodes["t"] = Node::Pups(PupsNode::Points(points));
        assert!(bits(&changed).contains(&7_f32.to_bits()), "{pups}");
        let again = nets(&changed).points.unwrap();
        assert_eq!(again.values[1], 7.0, "{pups}");
    }
    let own = nets(&recipe("cells = { spacing = 0.3 }", [true; 2]))
        .points
        .unwrap();
    assert!(own.points.iter().all(|point| point.label.is_none()));
    assert_eq!(own.values, [0.0; 0]);
}

#[test]
fn a_control_point_has_a_value_or_a_label_with_one() {
    let refusal = |points: &str| {
        let recipe = recipe(&format!("points = {points}"), [true; 2]);
        Plan::new(&recipe, &images(), 0.0)
            .err()
            .map(|error| error.to_string())
    };
    let mixed = "{ points = [{ x = 0, y = 0, label = 1 }, { x = 1, y = 1, value = 0.5 }], values = [0, 1] }";
    assert_eq!(refusal(mixed), None);
    for (points, part) in [
        (
            "{ points = [{ x = 0, y = 0 }] }",
            "either a `value` or a `label`",
        ),
        (
            "{ points = [{ x = 0, y = 0, value = 1, label = 0 }], values = [1] }",
            "either a `value` or a `label`",
        ),
        (
            "{ points = [{ x = 0, y = 0, label = 2 }], values = [0, 1] }",
            "3",
        ),
    ] {
        let refusal = refusal(points).unwrap_or_default();
        assert!(refusal.contains(part), "{points}: {refusal}");
    }
}

#[test]
fn textures_of_layers_and_colors_have_nets_but_no_points() {
    for (pups, n_nets) in [
        ("octaves = { spacing = 0.5, octaves = 3 }", 3),
        (
            "octaves = { spacing = 0.5, octaves = 3, source = \"rescaled\" }",
            1,
        ),
        ("turbulence = { spacing = 0.5, octaves = 1 }", 1),
        ("cellular_noise = { spacing = 0.5, layers = 2 }", 2),
        ("color_noise = { spacing = 0.5 }", 1),
    ] {
        let ControlNets { nets, points } = nets(&recipe(pups, [true; 2]));
        assert_eq!((nets.len(), points.is_none()), (n_nets, true), "{pups}");
    }
}

#[test]
fn edges_of_a_net_join_its_points() {
    let nets = nets(&recipe(ONE_NET[0], [true; 2])).nets;
    let points = nets[0].pups.points();
    let graph = nets[0].graph().unwrap();
    let edges: Vec<_> = graph.edges().collect();
    assert_eq!(edges.len(), 3 * points.len(), "a triangulation of a torus");
    for (from, axis) in edges {
        let there = points.domain().wrap(points.position(from) + axis.vector);
        let off = points.domain().delta(points.position(axis.to), there);
        // Vectors are differences of positions that were snapped to 2^-50 of the side.
        assert!(off.length() < 1e-14, "{from:?} to {axis:?}");
    }
}

#[test]
fn other_nodes_have_no_nets_and_too_many_points_are_refused() {
    let mut recipe = recipe("noise = { spacing = 1e-5 }", [true; 2]);
    let limits = PlanLimits::default();
    let error = recipe
        .control_nets("t", &images(), 0.0, &limits)
        .unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::TooMuch { .. }),
        "{error}"
    );
    let text = "dapple = 1\n[nodes.t.worley]\n[material]\nheight = \"t\"\n";
    recipe = Recipe::from_toml(text).unwrap();
    for name in ["t", "u"] {
        let nets = recipe.control_nets(name, &images(), 0.0, &limits).unwrap();
        assert!(nets.is_none(), "{name}");
    }
}

#[test]
fn a_loop_of_control_points_joins_moves_and_has_points_at_each_time() {
    let moving =
        "noise = { spacing = 0.3, net = { motion = { radius = 0.3 }, orientations = \"random\" } }";
    let recipe = recipe(moving, [true; 2]);
    let at = |time: f64| {
        let plan = Plan::new(&recipe, &images(), time).unwrap();
        let window = plan.window([48, 32]).unwrap();
        plan.height().unwrap().to_raster(&window).unwrap()
    };
    assert!(at(0.0) == at(1.0), "the end is the beginning");
    assert!(at(0.0) != at(0.5), "it moves");
    let nets = recipe.control_nets("t", &images(), 0.5, &PlanLimits::default());
    let points = nets.unwrap().and_then(|nets| nets.points).unwrap();
    let mut edited = recipe.clone();
    edited.nodes["t"] = Node::Pups(PupsNode::Points(points));
    let half = at(0.5)
        .pixels()
        .iter()
        .map(|value| value.to_bits())
        .collect::<Vec<_>>();
    assert!(bits(&edited) == half, "points stay where they are");
}
