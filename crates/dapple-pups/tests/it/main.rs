//! The core against an oracle, and what the crate and its recipes promise, through its public doors: the kernels are
//! compiled once, in the library.

mod bad_input;
mod bits;
mod fading;
mod gradient;
mod oracle;
mod properties;
mod recipes;
mod sets;
