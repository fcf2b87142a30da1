//! Pixels in memory for procedural textures: rasters, windows of the plane, wrapping, and fields that compose.
//!
//! A [`Field`] is a function with a value at every position, such as noise. A [`Window`] assigns positions to the
//! pixels of a [`Raster`]. [`FieldExt`] composes fields: frequency, offset, rotation, domain warp, arithmetic,
//! fractal sums ([`Fractal`]).
//!
//! ```
//! use dapple_raster::{field_fn, prelude::*};
//!
//! // Waves along x and y, bent by other waves, and with small ones on top.
//! let wave = |at: f64| (at - at.floor() - 0.5).abs() as f32;
//! let waves = field_fn(move |[x, y]: [f64; 2]| wave(x) + wave(y));
//! let bend = field_fn(move |[x, y]: [f64; 2]| wave(x + y) + wave(x - y));
//! let field = waves.warp((&bend, &bend), 0.25).add((&bend).frequency(8.0).mul(0.1));
//!
//! // 512 × 512 pixels on the square from 0 to 8, and a part of them with the same bits.
//! let window = Window::new([0.0; 2], [8.0; 2], [512, 512])?;
//! let whole = field.to_raster(&window)?;
//! let part = field.to_raster(&window.crop([100, 50], [64, 64])?)?;
//! assert_eq!(part, whole.crop([100, 50], [64, 64])?);
//! # Ok::<(), dapple_raster::RasterError>(())
//! ```
//!
//! # Ways to sample
//!
//! All ways give the same bits at the same position.
//!
//! | positions | call | cost |
//! |---|---|---|
//! | one | [`FieldExt::sample`] | one evaluation |
//! | one, with its derivatives | [`FieldExt::sample_with_gradient`] | exact, by the chain rule; for fields with a [`Gradient`] |
//! | many scattered | [`FieldExt::sample_many`], [`Field::values`] | less per position than `sample` for most generators |
//! | a window of the plane | [`Field::to_raster`], [`Field::render`] into your memory | least per pixel: generators share work between neighbors |
//! | one period | [`Field::tile_raster`] | as a window; the raster tiles exactly |
//! | a plane of a 3-D or 4-D field | [`FieldExt::slice`], then a window | as a window |
//! | planes of a volume | [`Field::render_stack`] | less than plane by plane where planes share work |
//!
//! Pixels of a raster are read by [`Raster::at`] with a [`Wrap`] per axis, between pixels by
//! [`Raster::sample_bilinear`], and averaged over an area by [`Raster::sample_area`]. A [`Varying`] is a number that
//! may depend on the position, for use in generator options.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | fills rasters on all cores; the bits do not change |
//! | `simd` | off | detects the SIMD level of the processor for crates that fill rasters; generators turn it on |
//! | `serde` | off | reads and writes windows and options as data |
//!
//! # Limits
//!
//! * A raster or a window has at most 2^31 pixels. A larger size gives a [`RasterError`] that states it.
//! * Positions are `f64` and field values `f32`. Raster pixels are of any type.
//! * Row 0 is the top; x goes right and y goes down.
//! * A fractal sum has 1 to 32 octaves.
//! * A composed field repeats along the axes along which all its parts repeat. [`Field::period`] is `None` along an
//!   axis without a known period.
//! * The crate reads and writes no files. `dapple-image` does.
//! * Results have the same bits on every platform and any number of threads. The only exceptions are closures that
//!   the caller supplies.
//!
//! # Without std
//!
//! Not possible today. Shared buffers are behind a `Mutex` of std, with and without `rayon`. With `simd`, the detection
//! of the processor's features and the `OnceLock` that holds the result are std's. `floor` and `sqrt` of `f64` are
//! methods of std.

#![forbid(unsafe_code)]

mod error;
mod error_macro;
mod field;
mod groups;
mod named;
mod parts;
mod range;
mod raster;
mod resample;
#[cfg(feature = "schema")]
mod schema;
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
    Change, Constant, Displacement, DisplacementGradient, Extruded, FieldExt, FieldFn, FieldParts,
    Fractal, FractalShape, Gradient, IntoField, Linear, Mapped, Mixed, Pair, PairOperation,
    Rotated, Scaled, Slice, Translated, Warped, common_period, field_fn,
};
pub use glam;
#[doc(hidden)]
pub use groups::Groups;
#[doc(hidden)]
pub use named::Named;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use named::read_named;
#[doc(hidden)]
pub use parts::Parts;
#[doc(hidden)]
pub use range::Range;
pub use raster::Raster;
pub use resample::Texel;
#[cfg(feature = "schema")]
#[doc(hidden)]
pub use schema::named_schema;
#[cfg(feature = "schema")]
#[doc(hidden)]
pub use schemars;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde;
pub use statistics::Statistics;
pub use varying::{Ramp, Varying};
pub use view::{RasterView, RasterViewMut};
pub use window::Window;
pub use wrap::Wrap;
