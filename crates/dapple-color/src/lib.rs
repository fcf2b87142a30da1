//! sRGB and linear color, color ramps, and maps from heights: normals, ambient occlusion, curvature.
//!
//! Inside of dapple color is linear light in `f32` ([`LinearRgb`]); it becomes sRGB only on the way to a file with 8 or
//! 16 bits per channel, by tables that give the result of exact arithmetic. Data (heights, masks, normals) is linear
//! everywhere. [`Code`] is the door between both and the numbers in a file.
//!
//! Heights become normals ([`normal_map`]), the part of the sky that each place sees ([`ambient_occlusion`]) and how the
//! surface bends ([`curvature`]). Lengths are in units of the plane, so that the resolution does not change the maps:
//!
//! ```
//! use dapple_color::{HeightPlane, OcclusionOptions, ambient_occlusion};
//! use dapple_raster::{Raster, Window};
//!
//! // A groove along the middle of the unit square, with walls of 45 degrees.
//! let window = Window::unit([64, 64])?;
//! let height = Raster::from_window(&window, |at| (at.x - 0.5).abs() as f32)?;
//! let options = OcclusionOptions { radius: 0.5, ..HeightPlane::for_window(&window).into() };
//! let seen = ambient_occlusion(&height, &options)?;
//! assert!((0.5..0.6).contains(&seen.row(32)[33]), "half of the sky, but for the end of the walls");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod arctangent;
mod code;
mod curvature;
mod error;
mod hex;
mod linear;
mod normal;
mod occlusion;
mod oklab;
mod palette;
mod plane;
mod ramp;
mod srgb;

pub use code::Code;
pub use curvature::{CurvatureOptions, curvature, curvature_of_part, curvature_to_gray};
pub use error::{ColorError, ColorErrorKind};
pub use linear::{LinearRgb, LinearRgba};
pub use normal::{
    Normal, NormalOptions, NormalY, normal_map, normal_map_from_gradient, normal_map_of_part,
};
pub use occlusion::{OcclusionOptions, ambient_occlusion, ambient_occlusion_of_part};
pub use palette::Palette;
pub use plane::HeightPlane;
pub use ramp::{ColorRamp, ColorStop, Interpolation, Outside, RampSpace};
