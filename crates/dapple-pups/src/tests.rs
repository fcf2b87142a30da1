//! The core against an oracle, and what the crate promises of it.

mod bad_input;
mod bits;
mod gradient;
mod oracle;
mod properties;
mod sets;
