//! sRGB and linear color, color ramps, and normal maps from heights.
//!
//! Inside of dapple color is linear light in `f32` ([`LinearRgb`]); it becomes sRGB only on the way to a file with 8 or
//! 16 bits per channel, by tables that give the result of exact arithmetic. Data (heights, masks, normals) is linear
//! everywhere. [`Code`] is the door between both and the numbers in a file.

#![forbid(unsafe_code)]

mod code;
mod error;
mod hex;
mod linear;
mod normal;
mod palette;
mod ramp;
mod srgb;

pub use code::Code;
pub use error::{ColorError, ColorErrorKind};
pub use linear::{LinearRgb, LinearRgba};
pub use normal::{Normal, NormalOptions, NormalY, normal_map, normal_map_from_gradient};
pub use palette::Palette;
pub use ramp::{ColorRamp, ColorStop, Interpolation, Outside};
