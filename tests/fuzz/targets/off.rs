//! Passes the inputs of libFuzzer to the target `off` of `tests/hostile`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dapple_fuzz::targets::off(bytes));
