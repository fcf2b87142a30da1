//! Tests of the command as a program, in temporary folders.

#![expect(
    clippy::disallowed_methods,
    reason = "tests look at the files that the command reads and writes"
)]

mod alpha;
mod bakes;
mod batch;
mod color_inputs;
mod copies;
mod durable;
mod examples;
mod exr_inputs;
mod files;
mod foreign;
mod inspections;
mod interrupt;
mod lifting;
mod meshes;
mod outputs;
mod photos;
mod refusals;
mod results;
mod shards;
#[cfg(feature = "studio")]
mod studio;
mod support;
mod synthesis;
mod turned_examples;
mod watch;
mod wgsl;
mod whole_materials;
mod words;
