//! Passes the inputs of libFuzzer to the target `stl` of `tests/hostile`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dapple_fuzz::targets::stl(bytes));
