//! Tests of plans that reuse values from a cache.

use dapple_recipe::{
    Bake, BakeOptions, Images, MapKind, MapRows, Plan, PlanCache, PlanLimits, Recipe,
};
use std::collections::BTreeSet;

fn baked(plan: &Plan, band_pixels: u32) -> Vec<(MapKind, MapRows)> {
    let options = BakeOptions {
        size: [48, 32],
        maps: MapKind::ALL.to_vec(),
        band_pixels,
        ..BakeOptions::default()
    };
    Bake::new(plan, &options).unwrap().whole_maps().unwrap()
}

fn with(recipe: &Recipe, time: f64, memory: &PlanCache) -> Plan {
    Plan::new_with_cache(recipe, &Images::new(), time, &PlanLimits::default(), memory).unwrap()
}

/// Returns the recipe, followed by variants that each change one number.
fn changed(text: &str) -> Vec<Recipe> {
    let changes = [
        ("seed = ", "seed = 1"),
        ("to = [0.", "to = [0.0"),
        ("gain = 0.", "gain = 0.1"),
        ("colors = [\"#", "colors = [\"#123456\", \"#"),
        ("relief = 0.", "relief = 0.4"),
    ];
    let mut recipes = vec![Recipe::from_toml(text).unwrap()];
    for (old, new) in changes {
        let text = text.replacen(old, new, 1);
        recipes.extend(
            Recipe::from_toml(&text)
                .ok()
                .filter(|recipe| Plan::new(recipe, &Images::new(), 0.0).is_ok()),
        );
    }
    recipes
}

/// Returns names of built-in recipes that together have all kinds of nodes: each has a kind that the earlier ones lack.
fn names_with_all_kinds() -> impl Iterator<Item = &'static str> {
    let mut kinds = BTreeSet::new();
    Recipe::builtin_names().filter(move |name| {
        let n_before = kinds.len();
        let recipe = Recipe::builtin(name).unwrap();
        for node in recipe.nodes.values() {
            let node = serde_json::to_value(node).unwrap();
            kinds.extend(node.as_object().unwrap().keys().cloned());
        }
        kinds.len() > n_before
    })
}

#[test]
fn bits_are_those_of_a_plan_without_a_memory() {
    let memory = PlanCache::new(1 << 24);
    for name in names_with_all_kinds() {
        for recipe in changed(Recipe::builtin_text(name).unwrap()) {
            for (time, bands) in [(0.0, &[1 << 20, 1 << 9][..]), (0.25, &[1 << 20])] {
                let plain = baked(&Plan::new(&recipe, &Images::new(), time).unwrap(), 1 << 20);
                for &band_pixels in bands {
                    let kept = baked(&with(&recipe, time, &memory), band_pixels);
                    assert_eq!(kept, plain, "{name} at {time}");
                }
            }
        }
        assert!(memory.bytes() <= 1 << 24, "{name}: {}", memory.bytes());
    }
    assert!(memory.bytes() > 1 << 20, "it was used: {}", memory.bytes());
}

#[test]
fn what_moves_is_made_anew_and_what_does_not_is_not() {
    let text = "dapple = 1\nextent = [4.0, 4.0]\n[nodes.still.worley]\n[nodes.moving.worley]\nmotion = { cells = 1 }\n[material]\n";
    let recipe = Recipe::from_toml(text).unwrap();
    let memory = PlanCache::new(1 << 20);
    let picture = |node: &str, time: f64| {
        let before = memory.bytes();
        let picture = with(&recipe, time, &memory)
            .node_picture(node, [16, 16], None)
            .unwrap();
        (picture, memory.bytes() - before)
    };
    let bytes = 16 * 16 * 4;
    let (still, made) = picture("still", 0.0);
    assert_eq!(made, bytes);
    assert_eq!(picture("still", 0.5), (still, 0));
    let (moving, made) = picture("moving", 0.0);
    assert_eq!(made, bytes);
    let (moved, made) = picture("moving", 0.5);
    assert_eq!(made, bytes);
    assert_ne!(moving, moved);
    assert_eq!(picture("moving", 0.0), (moving, 0));
}

#[test]
fn a_full_memory_forgets_what_was_used_longest_ago() {
    let text = "dapple = 1\n[nodes.a.worley]\nfrequency = 4\n[nodes.b.worley]\nfrequency = 4\n[material]\n";
    let recipe = Recipe::from_toml(text).unwrap();
    let bytes = 16 * 16 * 4;
    let memory = PlanCache::new(6 * bytes);
    let plan = with(&recipe, 0.0, &memory);
    for side in [16, 12, 10, 8, 14, 15, 13, 11, 9] {
        plan.node_picture("a", [side, 16], None).unwrap();
        plan.node_picture("b", [side, 16], None).unwrap();
        assert!(memory.bytes() <= 6 * bytes, "{}", memory.bytes());
    }
    let full = memory.bytes();
    plan.node_picture("b", [9, 16], None).unwrap();
    assert_eq!(memory.bytes(), full);
}

#[test]
fn textures_with_other_options_have_the_bits_of_a_plan_without_a_memory() {
    let memory = PlanCache::new(1 << 20);
    let changes = [
        "cells]\nspacing = 0.3",
        "cells]\nspacing = 0.3\npoints_per_cell = [2, 3]",
        "cells]\nspacing = 0.3\nnet = { strength = 0.25 }",
        "cow]\nspacing = 0.3",
        "cow]\nspacing = 0.3\nprobability = 0.2\nnet = { motion = { radius = 0.2 } }",
        "cow]\nspacing = 0.3\nnet = { motion = { radius = 0.3 } }",
        "space_giraffe]\nspacing = 0.5",
        "space_giraffe]\nspacing = 0.5\npairs = [4, 6]\nnet = { motion = { radius = 0.2 } }",
        "turbulence]\nspacing = 0.6\ngain = 0.7",
        "turbulence]\nspacing = 0.6\noctaves = 2\nnet = { axis_scale = 1.5 }",
        "color_noise]\nspacing = 0.3",
        "points]\npoints = [{ x = 0.5, y = 1.0, value = 0.2 }, { x = 1.5, y = 0.25, value = 0.75 }]",
        "points]\npoints = [{ x = 0.5, y = 1.0, value = 0.9 }, { x = 1.5, y = 0.25, value = 0.75 }]",
        "points]\npoints = [{ x = 0.5, y = 0.5, value = 0.9 }, { x = 1.5, y = 0.25, value = 0.75 }]",
    ];
    for _ in 0..2 {
        for (options, time) in changes
            .iter()
            .flat_map(|options| [0.0, 0.25].map(|time| (options, time)))
        {
            let text = format!(
                "dapple = 1\nextent = [2.0, 2.0]\n[nodes.a.pups.{options}\n[material]\nalbedo = \"a\"\n"
            );
            let recipe = Recipe::from_toml(&text).unwrap();
            let plain = Plan::new(&recipe, &Images::new(), time).unwrap();
            let plan = with(&recipe, time, &memory);
            assert_eq!(
                plan.node_picture("a", [24, 24], None).unwrap(),
                plain.node_picture("a", [24, 24], None).unwrap(),
                "{options} at {time}"
            );
        }
    }
}

#[test]
fn wavelets_with_other_weights_have_the_bits_of_a_plan_without_a_memory() {
    let memory = PlanCache::new(1 << 20);
    for weights in ["[1.0]", "[1.0, 0.5]", "[0.25]"] {
        let text = format!("dapple = 1\n[nodes.a.wavelet]\nweights = {weights}\n[material]\n");
        let recipe = Recipe::from_toml(&text).unwrap();
        let plain = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
        let plan = with(&recipe, 0.0, &memory);
        let [kept, plain] =
            [plan, plain].map(|plan| plan.node_picture("a", [24, 24], None).unwrap());
        assert_eq!(kept, plain, "{weights}");
    }
}
