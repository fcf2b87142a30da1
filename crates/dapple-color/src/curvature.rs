//! Mean curvature of heights: positive on ridges and hills, negative in grooves and pits.
//!
//! With subscripts for derivatives, the surface `z = s h(x, y)` has the mean curvature
//!
//! ```text
//! -((1 + z_y²) z_xx - 2 z_x z_y z_xy + (1 + z_x²) z_yy) / (2 (1 + z_x² + z_y²)^(3/2)).
//! ```
//!
//! It is positive where the surface is convex and negative where it is concave. On a spherical hill, it is the
//! reciprocal of the sphere's radius at every point, whatever the slope.
//!
//! Reference: Manfredo P. do Carmo, "Differential Geometry of Curves and Surfaces", 1976, section 3.3, example 5, with
//! the opposite sign, as is usual in curvature maps.
//!
//! Derivatives are central differences over a radius of whole pixels in each direction, and second derivatives are
//! second differences over the same radius, which are weighted means of the second derivative. Lengths are in units of
//! the plane and curvature is in reciprocal units, so the result does not depend on the resolution if the radius is at
//! least a pixel. If an intermediate result is not finite, the curvature is 0.

use crate::{ColorError, HeightPlane, plane};
use dapple_raster::Raster;
use dapple_raster::glam::DVec2;

/// Options for computing curvature: the plane of the heights, and the radius of the differences.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CurvatureOptions {
    /// Plane of the heights.
    pub plane: HeightPlane,
    /// Radius of the differences in units of the plane, at least 0. [default: 1/128] It is rounded to whole pixels and
    /// is at least one pixel.
    pub radius: f64,
}

impl Default for CurvatureOptions {
    fn default() -> Self {
        HeightPlane::default().into()
    }
}

impl From<HeightPlane> for CurvatureOptions {
    /// Creates options for heights in `plane`, with the default radius.
    fn from(plane: HeightPlane) -> Self {
        Self {
            plane,
            radius: 0.007_812_5,
        }
    }
}

impl CurvatureOptions {
    /// Returns the halo: the margin around a pixel, in columns and rows, on which the pixel's value depends. `size`
    /// is the size of the raster in pixels.
    ///
    /// Inside a crop with these margins, the result has the same bits; see [`curvature_of_part`]. For options that
    /// [`curvature`] rejects, the halo is 1 × 1.
    #[must_use]
    pub fn halo(&self, size: [u32; 2]) -> [u32; 2] {
        self.spans(size).unwrap_or([1; 2])
    }

    /// Converts the radius to columns and rows.
    fn spans(&self, size: [u32; 2]) -> Result<[u32; 2], ColorError> {
        self.plane.check("strength of the curvature")?;
        let pixel = self.plane.pixel(size);
        plane::check_radius("radius of the curvature", self.radius, pixel)?;
        // The small term makes exact half pixels round up, whatever the rounding error of the extent.
        Ok([pixel.x, pixel.y].map(|pixel| ((self.radius / pixel + 0.5 + 1e-9) as u32).max(1)))
    }
}

/// Computes the mean curvature of a raster of heights, in reciprocal units of the plane. Uses all cores if the feature
/// `rayon` is enabled.
///
/// Positive is convex (ridges, hills), negative is concave. [`curvature_to_gray`] converts it to a gray value.
///
/// # Errors
///
/// [`NotFinite`](crate::ColorErrorKind::NotFinite) if the strength or the radius is NaN or infinite,
/// [`Extent`](crate::ColorErrorKind::Extent) if the extent is not above zero and finite,
/// [`Radius`](crate::ColorErrorKind::Radius) if the radius is negative or more than 16384 pixels,
/// [`Raster`](crate::ColorErrorKind::Raster) if a raster that does not repeat would become too large when extended by
/// the radius.
///
/// # Examples
///
/// ```
/// use dapple_color::{HeightPlane, curvature, curvature_to_gray};
/// use dapple_raster::{Raster, Window, Wrap};
///
/// // A hill around the middle of the unit square.
/// let window = Window::unit([64, 64])?;
/// let hill = Raster::from_window(&window, |at| -(at - 0.5).length_squared() as f32)?;
/// let bent = curvature(&hill, &HeightPlane::for_window(&window, [Wrap::Clamp; 2]).into())?;
/// assert!((bent.row(32)[32] - 2.0).abs() < 0.01, "the top is that of a sphere of radius 1/2");
/// assert!(curvature_to_gray(bent.row(32)[32], 0.1) > 0.59);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn curvature(
    height: &Raster<f32>,
    options: &CurvatureOptions,
) -> Result<Raster<f32>, ColorError> {
    options.spans(height.size())?;
    let margin = options.plane.open_margin(options.halo(height.size()));
    if margin == [0; 2] {
        return curvature_of_part(height, height.size(), options);
    }
    let extended = plane::with_margin(height, margin)?;
    let bent = curvature_of_part(&extended, height.size(), options)?;
    Ok(bent.crop(margin, height.size())?)
}

/// Computes the curvature of a part of a raster of `whole` pixels. The extent in the options is the whole raster's
/// extent; see [`curvature`].
///
/// The wrap in the options selects the neighbors past the edges of the part; heights are not extrapolated there.
/// Every pixel that is farther from the part's edges than the whole raster's [halo](CurvatureOptions::halo) has the
/// same bits as when the whole raster is computed.
///
/// # Errors
///
/// Same as [`curvature`].
pub fn curvature_of_part(
    height: &Raster<f32>,
    whole: [u32; 2],
    options: &CurvatureOptions,
) -> Result<Raster<f32>, ColorError> {
    let size = height.size();
    let spans = options.spans(whole)?;
    let [step_x, step_y] = spans.map(i64::from);
    let scales = Scales::new(options, whole, spans);
    let [wrap_x, wrap_y] = options.plane.wrap;
    let mut bent = Raster::filled(size, 0.0)?;
    plane::fill_rows(&mut bent, |row, values| {
        let [above, below] =
            [-step_y, step_y].map(|step| height.row(wrap_y.index(i64::from(row) + step, size[1])));
        let here = height.row(row);
        for (column, value) in values.iter_mut().enumerate() {
            let left = plane::index(wrap_x, column as i64 - step_x, size[0]);
            let right = plane::index(wrap_x, column as i64 + step_x, size[0]);
            *value = scales.mean_curvature([
                [above[left], above[column], above[right]],
                [here[left], here[column], here[right]],
                [below[left], below[column], below[right]],
            ]);
        }
    });
    Ok(bent)
}

/// Converts a curvature to a gray value from 0 to 1: 0.5 for flat, brighter for convex.
///
/// `radius` is in units of the plane. A hill with the shape of a sphere of that radius or a smaller one is white, and
/// a pit of that shape is black. NaN becomes 0.5.
#[must_use]
pub fn curvature_to_gray(curvature: f32, radius: f32) -> f32 {
    let part = curvature * radius;
    if part.is_nan() {
        return 0.5;
    }
    0.5 + 0.5 * part.clamp(-1.0, 1.0)
}

/// Factors that convert height differences to derivatives.
struct Scales {
    /// Factors for the difference of a pixel's two neighbors, along x and y.
    first: DVec2,
    /// Factors for the second difference at a pixel, along x and y.
    second: DVec2,
    /// Factor for the mixed difference, which is the difference along x of the differences along y.
    mixed: f64,
}

impl Scales {
    fn new(options: &CurvatureOptions, size: [u32; 2], spans: [u32; 2]) -> Self {
        let strength = options.plane.strength;
        let step = options.plane.pixel(size) * DVec2::from(spans.map(f64::from));
        Self {
            first: strength / (2.0 * step),
            second: strength / (step * step),
            mixed: strength / (4.0 * step.x * step.y),
        }
    }

    /// Returns the mean curvature at the center of 3 × 3 heights.
    #[inline(always)]
    fn mean_curvature(&self, heights: [[f32; 3]; 3]) -> f32 {
        let [above, here, below] = heights;
        let difference = |from: f32, to: f32| f64::from(to) - f64::from(from);
        let x = difference(here[0], here[2]) * self.first.x;
        let y = difference(above[1], below[1]) * self.first.y;
        let xx = (difference(here[1], here[2]) - difference(here[0], here[1])) * self.second.x;
        let yy = (difference(here[1], below[1]) - difference(above[1], here[1])) * self.second.y;
        let xy = (difference(below[0], below[2]) - difference(above[0], above[2])) * self.mixed;
        // Squared lengths of the tangents along x and y, and of the normal whose z component is 1.
        let [across_sq, down_sq] = [1.0 + x * x, 1.0 + y * y];
        let length_sq = across_sq + y * y;
        let bend = down_sq * xx - 2.0 * x * y * xy + across_sq * yy;
        let curvature = (-bend / (2.0 * length_sq * length_sq.sqrt())) as f32;
        if curvature.is_finite() {
            curvature
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests;
