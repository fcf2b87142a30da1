//! Regular patterns with exact periods: bricks, woven threads, shapes, and shapes scattered over points.

#![forbid(unsafe_code)]

mod bricks;
mod error;
mod lattice;
mod scatter;
mod shape;
mod weave;

pub use bricks::{Bond, BrickField, BrickOptions, BrickValue, Bricks};
pub use dapple_hash as hash;
pub use dapple_raster as raster;
pub use error::{PatternError, PatternErrorKind};
pub use scatter::{StampField, StampOverlap, StampShape, StampValue, Stamps};
pub use shape::{Shape, ShapeField, ShapeKind, ShapeOptions, ShapeValue};
pub use weave::{Draft, Weave, WeaveField, WeaveOptions, WeaveValue};
