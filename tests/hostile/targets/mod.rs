//! What must hold for any bytes whatsoever: a plain function for each kind of input, and inputs to begin with.
//!
//! The test `hostile` gives them changed copies of these inputs, and `tests/fuzz` what libFuzzer makes up. A function
//! returns, soon and without much memory, or it panics, which is a finding.

mod bytes;
mod images;
mod meshes;
mod plane;
mod recipes;

pub use images::image;
pub use meshes::{gltf, obj, off, ply};
pub use plane::points;
pub use recipes::{directions, recipe};

use std::error::Error;

/// A kind of input: its name, what takes it, and inputs to begin with.
pub type Target = (&'static str, fn(&[u8]), fn() -> Vec<Vec<u8>>);

/// All kinds of inputs.
pub const TARGETS: [Target; 8] = [
    ("image", image, images::seeds),
    ("obj", obj, meshes::obj_seeds),
    ("ply", ply, meshes::ply_seeds),
    ("gltf", gltf, meshes::gltf_seeds),
    ("off", off, meshes::off_seeds),
    ("recipe", recipe, recipes::seeds),
    ("points", points, plane::seeds),
    ("directions", directions, recipes::direction_seeds),
];

/// What was accepted. A refusal says why, in less than a screen.
fn accepted<T, E: Error>(result: Result<T, E>) -> Option<T> {
    result
        .map_err(|error| {
            let text = error.to_string();
            assert!(
                !text.trim().is_empty(),
                "an error without a text: {error:?}"
            );
        })
        .ok()
}
