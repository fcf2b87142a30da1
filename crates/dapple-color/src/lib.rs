//! sRGB and linear color, color ramps, and maps from heights: normals, ambient occlusion, curvature.
//!
//! Inside of dapple color is linear light in `f32` ([`LinearRgb`]); it becomes sRGB only in a file with 8 or 16 bits
//! per channel, by tables that equal exact arithmetic. Data (heights, masks, normals) is linear everywhere. [`Code`]
//! converts both to and from the numbers in a file.
//!
//! Maps from heights are normals ([`normal_map`]), the visible part of the sky ([`ambient_occlusion`]) and the bend of
//! the surface ([`curvature`]). Lengths are in units of the plane, so that the resolution does not change the maps:
//!
//! ```
//! use dapple_color::{HeightPlane, OcclusionOptions, ambient_occlusion};
//! use dapple_raster::{Raster, Window, Wrap};
//!
//! // A groove along the middle of the unit square, with walls of 45 degrees.
//! let window = Window::unit([64, 64])?;
//! let height = Raster::from_window(&window, |at| (at.x - 0.5).abs() as f32)?;
//! let options = OcclusionOptions { radius: 0.5, ..HeightPlane::for_window(&window, [Wrap::Clamp; 2]).into() };
//! let seen = ambient_occlusion(&height, &options)?;
//! assert!((0.5..0.6).contains(&seen.row(32)[33]), "half of the sky, but for the end of the walls");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod arctangent;
mod bleed;
mod code;
mod curvature;
mod error;
mod hex;
mod linear;
mod normal;
mod occlusion;
mod of_field;
mod oklab;
mod palette;
mod plane;
mod ramp;
mod srgb;
mod texture;

pub use bleed::bleed_color;
pub use code::Code;
pub use curvature::{CurvatureOptions, curvature, curvature_of_part, curvature_to_gray};
pub use dapple_raster as raster;
pub use error::{ColorError, ColorErrorKind};
pub use linear::{LinearRgb, LinearRgba};
#[doc(alias("height map", "heightmap", "bump map", "normal map"))]
pub use normal::normal_map;
pub use normal::{Normal, NormalOptions, NormalY, normal_map_from_gradient, normal_map_of_part};
#[doc(alias("ao", "ambient occlusion"))]
pub use occlusion::ambient_occlusion;
pub use occlusion::{
    OcclusionOptions, ambient_occlusion_cancellable, ambient_occlusion_of_part,
    ambient_occlusion_of_part_cancellable,
};
pub use of_field::{ambient_occlusion_of_field, curvature_of_field, normal_map_of_field};
pub use palette::Palette;
pub use plane::{HeightPlane, continue_heights};
pub use ramp::{ColorRamp, ColorStop, Interpolation, Outside, RampSpace};
pub use texture::{ColorPixel, TexturePixel, TextureRaster};
