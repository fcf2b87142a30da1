//! sRGB and linear color, color ramps, and normal maps from heights.
//!
//! Inside of dapple color is linear light in `f32` ([`LinearRgb`]); it becomes sRGB only on the way to a file with 8 or
//! 16 bits per channel, by tables that give the result of exact arithmetic. Data (heights, masks, normals) is linear
//! everywhere. [`Code`] is the door between both and the numbers in a file.

#![forbid(unsafe_code)]

mod code;
mod linear;
mod srgb;

pub use code::Code;
pub use linear::{LinearRgb, LinearRgba};
