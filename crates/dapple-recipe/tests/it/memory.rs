//! Plans that reuse values from a memory.

use dapple_recipe::{
    Bake, BakeOptions, Images, MapKind, MapRows, Memory, Plan, PlanLimits, Recipe,
};

fn baked(plan: &Plan, band_pixels: u32) -> Vec<(MapKind, MapRows)> {
    let options = BakeOptions {
        size: [48, 32],
        maps: MapKind::ALL.to_vec(),
        band_pixels,
        ..BakeOptions::default()
    };
    Bake::new(plan, &options).unwrap().whole_maps().unwrap()
}

fn with(recipe: &Recipe, time: f64, memory: &Memory) -> Plan {
    Plan::new_with_memory(recipe, &Images::new(), time, &PlanLimits::default(), memory).unwrap()
}

/// The recipe, with a different number in one of its nodes each time.
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

#[test]
fn bits_are_those_of_a_plan_without_a_memory() {
    let memory = Memory::new(1 << 24);
    for name in Recipe::builtin_names() {
        for recipe in changed(Recipe::builtin_text(name).unwrap()) {
            for (time, band_pixels) in [(0.0, 1 << 20), (0.0, 1 << 9), (0.25, 1 << 20)] {
                let plain = baked(&Plan::new(&recipe, &Images::new(), time).unwrap(), 1 << 20);
                assert_eq!(
                    baked(&with(&recipe, time, &memory), band_pixels),
                    plain,
                    "{name} at {time}"
                );
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
    let memory = Memory::new(1 << 20);
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
    let memory = Memory::new(6 * bytes);
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
