//! Colors for textures: sRGB and linear light, color ramps, bytes for a GPU, and maps from heights: normals, ambient
//! occlusion, curvature.
//!
//! ```
//! use dapple_color::{HeightPlane, Palette, TextureRaster, ambient_occlusion, curvature, normal_map};
//! use dapple_raster::{Raster, Window, Wrap};
//!
//! // A hill on the unit square, and its color.
//! let window = Window::unit([256, 256])?;
//! let height = Raster::from_window(&window, |at| (at.x * (1.0 - at.x)) as f32)?;
//! let color = Palette::Lagoon.ramp().apply(&height);
//!
//! // Its normal map, the visible part of the sky, and the bend of its surface.
//! let plane = HeightPlane::for_window(&window, [Wrap::Clamp; 2]);
//! let normals = normal_map(&height, &plane.into())?;
//! let seen = ambient_occlusion(&height, &plane.into())?;
//! let bent = curvature(&height, &plane.into())?;
//!
//! // Bytes for a GPU: `Rgba8UnormSrgb` for color, `Rgba8Unorm` for normals.
//! let (albedo, normal) = (color.to_rgba8_srgb(), normals.to_rgba8());
//! # assert_eq!((albedo.len(), normal.len()), (256 * 256 * 4, 256 * 256 * 4));
//! # assert!(seen.row(9)[9] <= 1.0 && bent.row(128)[128] > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to get | from a raster | from a field in a window | from a part of a raster | cost |
//! |---|---|---|---|---|
//! | normals | [`normal_map`] | [`normal_map_of_field`] | [`normal_map_of_part`] | reads one pixel around |
//! | exact normals | [`normal_map_from_gradient`] | | | no neighbors |
//! | ambient occlusion | [`ambient_occlusion`] | [`ambient_occlusion_of_field`] | [`ambient_occlusion_of_part`] | grows with the logarithm of the radius above 16 pixels |
//! | curvature | [`curvature`] | [`curvature_of_field`] | [`curvature_of_part`] | reads [`CurvatureOptions::halo`] pixels around |
//!
//! Use the `_of_field` functions for chunks of a terrain: they read the field beyond the sides of the window, so that
//! adjacent chunks match. The `_of_part` functions need a margin around the part, and give the same bits as for the
//! whole raster.
//!
//! | to | use |
//! |---|---|
//! | color values | [`ColorRamp::apply`], [`ColorRamp::at`]; [`Palette`] has ready-made ramps |
//! | make bytes and mip levels for a GPU | [`TextureRaster`] |
//! | convert to and from file codes of 8 or 16 bits | [`Code`], [`LinearRgb::to_srgb`], [`LinearRgb::from_srgb`] |
//! | extend colors into transparent pixels | [`bleed_color`] |
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | makes maps and converts rasters on all cores; the bits do not change |
//! | `serde` | off | reads and writes colors, ramps and options as data |
//!
//! # Limits
//!
//! * Color in memory is linear light in `f32`. It becomes sRGB only in codes of 8 or 16 bits. Heights, masks and
//!   normals are linear everywhere.
//! * The sRGB curve is exact for 8 and 16 bits: each code equals the result of exact arithmetic.
//! * Ramps mix in Oklab by default, where equal steps look equal, or in sRGB codes or linear light ([`RampSpace`]).
//! * Lengths are in units of the plane, so that the resolution does not change the maps.
//! * Green of a normal points up by default, as in OpenGL. [`NormalY`] flips it for DirectX.
//! * The radius of occlusion and of curvature is at most 16,384 pixels.
//! * Tone mapping is left to the caller. Files, and the conversion of their color spaces, are in `dapple-image`.
//! * Results have the same bits on every platform and any number of threads.
//!
//! # Without std
//!
//! Not possible today. `dapple-raster` needs std, the tables of the sRGB curve are in a `LazyLock` of std, and `floor`
//! and `sqrt` are methods of std.

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
#[doc(hidden)]
pub use srgb::srgb_shader_words;
pub use texture::{ColorPixel, TexturePixel, TextureRaster};
