//! The targets of `tests/hostile`, for the fuzz targets of libFuzzer.

#[path = "../hostile/targets/mod.rs"]
pub mod targets;
