//! Checks properties that must hold for any bytes. There is one function for each kind of input, with seed inputs.
//!
//! The test `hostile` passes mutated copies of the seed inputs to the functions, and `tests/fuzz` passes inputs from
//! libFuzzer. A function must return soon and use little memory. A panic is a failure.

mod bytes;
mod images;
mod lifting;
mod meshes;
mod plane;
mod recipes;

pub use images::image;
pub use lifting::lift;
pub use meshes::{gltf, obj, off, ply, stl};
pub use plane::points;
pub use recipes::{directions, recipe};

use std::error::Error;

/// A kind of input: its name, the function that checks it, and its seed inputs.
pub type Target = (&'static str, fn(&[u8]), fn() -> Vec<Vec<u8>>);

/// All kinds of inputs.
pub const TARGETS: [Target; 10] = [
    ("image", image, images::seeds),
    ("obj", obj, meshes::obj_seeds),
    ("ply", ply, meshes::ply_seeds),
    ("gltf", gltf, meshes::gltf_seeds),
    ("off", off, meshes::off_seeds),
    ("stl", stl, meshes::stl_seeds),
    ("recipe", recipe, recipes::seeds),
    ("points", points, plane::seeds),
    ("lift", lift, lifting::seeds),
    ("directions", directions, recipes::direction_seeds),
];

/// Returns the value of a successful result, and `None` for an error, whose message must not be empty.
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
