//! Tests of the public interface against an oracle, and of the documented properties of the crate and its recipes. The
//! kernels are compiled once, in the library.

mod bad_input;
mod bits;
mod fading;
mod gradient;
mod oracle;
mod properties;
mod recipes;
mod sets;
