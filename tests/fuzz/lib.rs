//! The targets of `tests/hostile`, shared with the fuzz targets of libFuzzer.

#[path = "../hostile/targets/mod.rs"]
pub mod targets;
