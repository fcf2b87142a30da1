//! Tests of recipes through the public interface. Unit tests would compile the nodes and readers a second time.

mod bakes;
mod copies;
mod corners;
mod local;
mod memory;
mod moved;
mod neighborhoods;
mod parameters;
mod patterns;
mod pictures;
mod points;
mod program;
mod progress;
mod refusals;
mod scatter;
#[cfg(feature = "schema")]
mod schema;
mod shader;
mod supersample;
mod synth;
mod text;
mod vectors;
mod words;
