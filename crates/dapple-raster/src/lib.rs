//! Pixels in memory: rasters, windows of the plane, wrapping, and the [`Field`] trait.
//!
//! A [`Raster`] owns its pixels; a [`RasterView`] borrows a rectangle of them, a [`RasterViewMut`] borrows it for
//! writing. A [`Window`] says where pixels lie in the plane, so that part of a picture has, to the last bit, the
//! positions that it has in the whole. A [`Field`] is anything that has a value at every position and can fill a
//! window with them, and [`FieldExt`] composes fields.
//!
//! ```
//! use dapple_raster::{Raster, Window};
//!
//! let window = Window::unit([4, 4])?;
//! let raster = Raster::from_window(&window, |position| position.x as f32)?;
//! assert_eq!(raster.row(0), [0.125, 0.375, 0.625, 0.875]);
//! # Ok::<(), dapple_raster::RasterError>(())
//! ```
//!
//! Row 0 is the top; x goes right, y goes down. Positions are `f64`, values are whatever the raster holds. The crate
//! knows no file format and touches no file.

#![forbid(unsafe_code)]

mod error;
mod error_macro;
mod field;
mod named;
mod parts;
mod raster;
mod resample;
mod statistics;
mod varying;
mod view;
mod window;
mod wrap;

#[doc(hidden)]
pub mod parallel;
pub mod prelude;
#[doc(hidden)]
pub mod simd;
pub mod text;

pub use error::{RasterError, RasterErrorKind};
#[doc(alias("heightmap", "height map", "noise"))]
pub use field::Field;
pub use field::{
    Change, Constant, Displacement, DisplacementGradient, Extruded, FieldExt, FieldFn, Fractal,
    FractalShape, Gradient, IntoField, Linear, Mapped, Mixed, Pair, PairOperation, Rotated, Scaled,
    Slice, Translated, Warped, common_period, field_fn,
};
pub use glam;
#[doc(hidden)]
pub use named::Named;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use named::read_named;
#[doc(hidden)]
pub use parts::Parts;
pub use raster::Raster;
pub use resample::Texel;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde;
pub use statistics::Statistics;
pub use varying::{Ramp, Varying};
pub use view::{RasterView, RasterViewMut};
pub use window::Window;
pub use wrap::Wrap;
