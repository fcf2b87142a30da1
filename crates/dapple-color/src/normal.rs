//! Computes normal maps from heights or exact gradients.
//!
//! A height `h` over the plane has the normal `normalize(-s ∂h/∂x, ±s ∂h/∂y, 1)`, where `s` is the strength. Rows go
//! down in dapple, so the sign of the y component is plus for Y up (OpenGL) and minus for Y down (DirectX). The
//! derivatives of a raster are central differences over two pixels, `(h[i+1] - h[i-1]) / (2 pixel)`. Along an axis
//! where heights repeat, neighbors at the edge come from the opposite edge, so the normal map of a tile tiles too.
//! Other heights [continue](crate::continue_heights) with their slope.
//!
//! Reference: James F. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978, for the perturbed normal.
//!
//! Slopes are height differences per unit of the *plane*, in which the raster has a given extent, not per pixel.
//! Twice the resolution therefore gives the same normals on finer pixels. Where a component of the slope is not
//! finite, the normal is flat.

use crate::{Code, ColorError, HeightPlane, plane};
use dapple_raster::Raster;
use dapple_raster::glam::DVec2;

/// A unit normal vector: x to the right, y up or down according to [`NormalY`], z out of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Normal {
    /// Component to the right, from -1 to 1.
    pub x: f32,
    /// Component up (OpenGL) or down (DirectX), from -1 to 1; see [`NormalY`].
    pub y: f32,
    /// Component out of the surface, from 0 to 1.
    pub z: f32,
}

dapple_raster::named! {
    /// Direction of a normal's second component, the green channel of its color.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum NormalY {
        /// Up, as in OpenGL, glTF, Blender, Unity and Godot.
        #[default]
        OpenGl = "opengl",
        /// Down, as in DirectX and Unreal.
        DirectX = "directx",
    }
}

/// Options for computing normals from heights or gradients.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct NormalOptions {
    /// Plane of the heights.
    pub plane: HeightPlane,
    /// Direction of the green channel. [default: up]
    pub y: NormalY,
}

impl From<HeightPlane> for NormalOptions {
    /// Creates options for heights in `plane`, with green up.
    fn from(plane: HeightPlane) -> Self {
        let y = NormalY::default();
        Self { plane, y }
    }
}

impl NormalOptions {
    /// Returns the normal for a slope, given as the height change per unit of the plane to the right and downward.
    #[must_use]
    pub fn normal(&self, slope: DVec2) -> Normal {
        let strength = self.plane.strength;
        let up = match self.y {
            NormalY::OpenGl => strength,
            NormalY::DirectX => -strength,
        };
        let [x, y] = [-strength * slope.x, up * slope.y];
        let length = (x * x + y * y + 1.0).sqrt();
        if !length.is_finite() {
            return Normal::FLAT;
        }
        let [x, y, z] = [x, y, 1.0].map(|part| (part / length) as f32);
        Normal { x, y, z }
    }

    fn check(&self) -> Result<(), ColorError> {
        self.plane.check("strength of the normal map")
    }
}

/// Computes the normals of a raster of heights. Uses all cores if the feature `rayon` is enabled.
///
#[cfg_attr(doc, doc = include_str!("../docs/normal-map.md"))]
///
/// # Errors
///
/// [`NotFinite`](crate::ColorErrorKind::NotFinite) if the strength is NaN or infinite,
/// [`Extent`](crate::ColorErrorKind::Extent) if the extent is not above zero and finite,
/// [`Raster`](crate::ColorErrorKind::Raster) if a raster that does not repeat would become too large when extended by
/// one pixel.
///
/// # Examples
///
/// ```
/// use dapple_color::{NormalOptions, normal_map};
/// use dapple_raster::Raster;
///
/// let flat = Raster::filled([16, 16], 0.5_f32)?;
/// let normals = normal_map(&flat, &NormalOptions::default())?;
/// assert_eq!(normals.row(3)[5].to_codes::<u8>(), [128, 128, 255]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn normal_map(
    height: &Raster<f32>,
    options: &NormalOptions,
) -> Result<Raster<Normal>, ColorError> {
    options.check()?;
    let margin = options.plane.open_margin([1; 2]);
    if margin == [0; 2] {
        return normal_map_of_part(height, height.size(), options);
    }
    let extended = plane::with_margin(height, margin)?;
    let normals = normal_map_of_part(&extended, height.size(), options)?;
    Ok(normals.crop(margin, height.size())?)
}

/// Computes the normals of a part of a raster of `whole` pixels. The extent in the options is the whole raster's
/// extent; see [`normal_map`].
///
/// The wrap in the options selects the neighbors past the edges of the part; heights are not extrapolated there.
/// Every pixel that is more than one pixel from the edges of the part has the same bits as when the whole raster is
/// computed.
///
/// # Errors
///
/// Same as [`normal_map`].
pub fn normal_map_of_part(
    height: &Raster<f32>,
    whole: [u32; 2],
    options: &NormalOptions,
) -> Result<Raster<Normal>, ColorError> {
    options.check()?;
    let size = height.size();
    // Factor from the difference of two neighbors to a slope.
    let scale = DVec2::new(whole[0].into(), whole[1].into()) / (2.0 * options.plane.extent);
    let [wrap_x, wrap_y] = options.plane.wrap;
    let last = size[0] - 1;
    let [before_first, after_last] = [-1, i64::from(size[0])].map(|at| wrap_x.index(at, size[0]));
    let normals = Raster::from_rows(size, |row| {
        let [above, below] = [-1, 1].map(|step| wrap_y.index(i64::from(row) + step, size[1]));
        let [above, here, below] = [above, row, below].map(|row| height.row(row));
        (0..size[0]).map(move |column| {
            let left = if column > 0 { column - 1 } else { before_first };
            let right = if column < last {
                column + 1
            } else {
                after_last
            };
            let difference = DVec2::new(
                f64::from(here[right as usize]) - f64::from(here[left as usize]),
                f64::from(below[column as usize]) - f64::from(above[column as usize]),
            );
            options.normal(difference * scale)
        })
    })?;
    Ok(normals)
}

/// Computes the normals for a raster of exact slopes, given as the height change per unit of the plane to the right
/// and downward.
///
/// Only the strength and the direction of green are read from the options. Uses all cores if the feature `rayon` is
/// enabled.
///
/// # Errors
///
/// [`NotFinite`](crate::ColorErrorKind::NotFinite) if the strength is NaN or infinite,
/// [`Extent`](crate::ColorErrorKind::Extent) if the extent is not above zero and finite.
pub fn normal_map_from_gradient(
    gradient: &Raster<[f32; 2]>,
    options: &NormalOptions,
) -> Result<Raster<Normal>, ColorError> {
    options.check()?;
    Ok(gradient.par_map(|&[x, y]| options.normal(DVec2::new(x.into(), y.into()))))
}

impl Normal {
    /// Normal of a flat surface.
    pub const FLAT: Self = Self {
        x: 0.0,
        y: 0.0,
        z: 1.0,
    };

    /// Returns the three components, x first.
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }

    /// Converts the normal to image codes: `round((component + 1) / 2 · max)`, with red for x, green for y and blue
    /// for z, all linear.
    ///
    /// A flat normal becomes (128, 128, 255), or (32768, 32768, 65535) in 16 bits.
    #[must_use]
    pub fn to_codes<C: Code>(self) -> [C; 3] {
        self.to_array().map(|part| C::from_unit(part * 0.5 + 0.5))
    }

    /// Sets x and y to 0 where they were decoded from a code next to the middle of the range: 127 or 128 in 8 bits,
    /// 32767 or 32768 in 16 bits.
    ///
    /// No code has the value 0, so images store 128, which decodes to a slope of 1/255. Rotated or mirrored, that
    /// slope becomes a different code, although a flat surface has no direction. Components from 8 bits are
    /// recognized by their ratios to the other components: these are ratios of odd numbers up to 255, whatever the
    /// length of the vector before normalization. Components from 16 bits are recognized by their small size.
    #[must_use]
    pub fn centered(self) -> Self {
        let Self { x, y, z } = self;
        let is_middle = |part: f32| {
            part.abs() < STEP_OF_16_BITS
                || STEPS_OF_8_BITS.contains(&part.abs())
                    && [x, y, z].into_iter().all(|other| is_odd(other / part))
        };
        let parts = [x, y].map(|part| if is_middle(part) { 0.0 } else { part });
        if parts == [x, y] {
            return self;
        }
        let [x, y] = parts;
        Self::unit([x, y, z])
    }

    /// Converts image codes to a unit vector by the usual rule: `2 code / max - 1`, normalized.
    ///
    /// No code has the value 0, so a flat normal is read back tilted by `1 / max` in x and in y. Codes whose vector
    /// cannot be normalized become a flat normal.
    #[must_use]
    pub fn from_codes<C: Code>(codes: [C; 3]) -> Self {
        Self::unit(codes.map(|code| 2.0 * code.to_unit() - 1.0))
    }

    /// Returns the unit vector in a direction, or a flat normal if the direction has no length.
    pub(crate) fn unit([x, y, z]: [f32; 3]) -> Self {
        let length = (x * x + y * y + z * z).sqrt();
        if length > 0.0 {
            let [x, y, z] = [x, y, z].map(|part| part / length);
            Self { x, y, z }
        } else {
            Self::FLAT
        }
    }
}

/// Maximum component that comes from a 16-bit code next to the middle. Such a component is 2^-16 for a vector of unit
/// length, and the component of the next code is three times as large. The length of a decoded vector is within a
/// quarter of 1.
const STEP_OF_16_BITS: f32 = 1.5 / (1 << 16) as f32;

/// Range of a component that comes from an 8-bit code next to the middle: 1/255 divided by the length of a decoded
/// vector, which is near 1.
const STEPS_OF_8_BITS: core::ops::RangeInclusive<f32> = 0.9 / 255.0..=1.1 / 255.0;

/// Returns whether a ratio is an odd number, up to the rounding of decoded codes to `f32` (1e-7 of 1/255, times 255).
fn is_odd(ratio: f32) -> bool {
    let rest = (ratio.abs() * 0.5).fract();
    (rest - 0.5).abs() < 0.01
}

#[cfg(test)]
mod tests;
