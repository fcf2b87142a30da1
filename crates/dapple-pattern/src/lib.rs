//! Regular patterns with exact periods: bricks, woven threads, shapes, and shapes scattered over points.

#![forbid(unsafe_code)]

mod error;

pub use error::{PatternError, PatternErrorKind};
