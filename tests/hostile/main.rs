//! Tests all readers with malformed inputs: every reader must return a result or an error within a short time.
//!
//! libFuzzer can run the same functions for any length of time; see `tests/fuzz`.

mod mutate;
#[expect(
    unreachable_pub,
    reason = "the fuzz targets reach them, in a crate of their own"
)]
mod targets;

use mutate::Mutator;
use std::panic::catch_unwind;
use targets::TARGETS;

/// Runs a target on its seed inputs and on `rounds` mutated copies of each.
fn try_out(target: &str, rounds: u64) {
    let found = TARGETS.into_iter().find(|(name, ..)| *name == target);
    let (name, run, seeds) = found.expect("the name of a target");
    let seeds = seeds();
    let run = |input: &[u8]| {
        let outcome = catch_unwind(|| run(input));
        assert!(
            outcome.is_ok(),
            "{name} breaks by these bytes: {}",
            input.escape_ascii()
        );
    };
    for (index, seed) in (0..).zip(&seeds) {
        run(seed);
        for round in 0..rounds {
            run(&Mutator::new(name, index, round).changed(seed, &seeds));
        }
    }
}

#[test]
fn broken_images_are_read_or_refused() {
    try_out("image", 1000);
}

#[test]
fn broken_obj_files_are_read_or_refused() {
    try_out("obj", 1000);
}

#[test]
fn broken_ply_files_are_read_or_refused() {
    try_out("ply", 1000);
}

#[test]
fn broken_gltf_files_are_read_or_refused() {
    try_out("gltf", 1000);
}

#[test]
fn broken_off_files_are_read_or_refused() {
    try_out("off", 2000);
}

#[test]
fn broken_stl_files_are_read_or_refused() {
    try_out("stl", 1000);
}

#[test]
fn broken_recipes_are_baked_or_refused() {
    try_out("recipe", 20);
}

#[test]
fn odd_points_have_graphs_or_are_refused() {
    try_out("points", 20);
}

#[test]
fn textures_of_odd_meshes_are_lifted_or_refused() {
    try_out("lift", 10);
}

#[test]
fn broken_lists_are_read_or_refused() {
    try_out("directions", 500);
}

/// Writes the seed inputs to the folder named by `DAPPLE_FUZZ_SEEDS`, if it is set. `cargo xtask ci fuzz` passes them
/// to libFuzzer.
#[test]
#[expect(
    clippy::disallowed_methods,
    reason = "the one place where inputs become files"
)]
fn inputs_are_written_where_they_are_asked_for() {
    let Some(folder) = std::env::var_os("DAPPLE_FUZZ_SEEDS") else {
        return;
    };
    for (name, _, seeds) in TARGETS {
        let folder = std::path::Path::new(&folder).join(name);
        std::fs::create_dir_all(&folder).expect("a folder for the inputs");
        for (index, seed) in seeds().into_iter().enumerate() {
            std::fs::write(folder.join(format!("seed-{index}")), seed).expect("an input");
        }
    }
}
