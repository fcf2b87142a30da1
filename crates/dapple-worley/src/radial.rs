//! Maps cellular textures to radial coordinates: azimuth, polar angle and radius.
//!
//! Worley mentions that "a radial coordinate version can cover spheres, creating a surface similar to the Death Star"
//! ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>), and gives no formula.
//! Here a position `[x, y, z]` is mapped to cells along three axes:
//!
//! * `n · φ / 2π`, with the azimuth `φ = atan2(y, x)`. The `n` cells around the axis are a whole number and an exact
//!   period;
//! * `m · θ / π`, with the polar angle `θ` from the north pole at +z, and `m` cells from pole to pole;
//! * `k · r`, with the radius `r`, and `k` cells per unit.
//!
//! The distance is the basis's metric between such triples. On the equator of the sphere of radius `r`, the size of a
//! cell is `2πr/n` by `πr/m` by `1/k`. Toward the poles cells get narrower. At a pole all azimuths meet, so the texture
//! is not continuous there, like a map of the Earth. On the axis the azimuth is defined as 0.
//!
//! The gradient is transformed back to `[x, y, z]` by the derivatives of the three coordinates. The derivative of the
//! azimuth is unbounded toward the axis. On the axis and at the center, undefined derivatives are omitted.

use crate::{Cellular, Worley3, WorleyError};
use core::f64::consts::{PI, TAU};
use glam::DVec3;

/// Number of cells of a radial texture along each axis.
///
#[cfg_attr(doc, doc = include_str!("../docs/radial-cells.md"))]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RadialCells {
    /// Number of cells around the axis, a whole number of at least 1.
    pub around: u32,
    /// Number of cells from pole to pole; above 0. Half of `around` gives square cells on the equator.
    pub polar: f64,
    /// Number of cells per unit of radius; at least 0. With 0, the texture is constant along the radius.
    pub radial: f64,
}

/// A scalar texture over cells in azimuth, polar angle and radius.
///
#[cfg_attr(doc, doc = include_str!("../docs/radial.md"))]
///
/// # Examples
///
/// ```
/// use dapple_worley::{Combination, Metric, Radial, RadialCells, Worley3, hash::Seed};
///
/// let hull = Worley3::new(Seed(7)).with_metric(Metric::Manhattan)?.combine(Combination::F1);
/// let star = Radial::new(hull, RadialCells { around: 24, polar: 12.0, radial: 0.0 })?;
/// assert!(star.value([0.5, -0.3, 0.2]) >= 0.0);
/// # Ok::<(), dapple_worley::WorleyError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Radial {
    texture: Cellular<3>,
    cells: RadialCells,
}

impl Radial {
    /// Maps a texture to radial cells, replacing the period of its basis.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if a number of cells is out of its range.
    pub fn new(texture: Cellular<3>, cells: RadialCells) -> Result<Self, WorleyError> {
        let RadialCells {
            around,
            polar,
            radial,
        } = cells;
        let check = WorleyError::check;
        check(
            polar > 0.0 && polar.is_finite(),
            "number of cells from pole to pole",
            polar,
            "above 0",
        )?;
        check(
            radial >= 0.0 && radial.is_finite(),
            "number of cells per radius",
            radial,
            "at least 0",
        )?;
        let worley = texture.worley.with_period([Some(around), None, None])?;
        Ok(Self {
            texture: Cellular { worley, ..texture },
            cells,
        })
    }

    /// Returns the texture's basis. Its positions are [`cell_position`](Self::cell_position)s.
    #[must_use]
    pub fn worley(&self) -> &Worley3 {
        self.texture.worley()
    }

    /// Converts a position to cells along azimuth, polar angle and radius.
    #[must_use]
    pub fn cell_position(&self, position: impl Into<DVec3>) -> DVec3 {
        let at = position.into();
        let RadialCells {
            around,
            polar,
            radial,
        } = self.cells;
        let axial = libm::sqrt(at.x * at.x + at.y * at.y);
        // Azimuth in turns; negative ones are moved up by a turn below.
        let turn = libm::atan2(at.y, at.x) / TAU;
        DVec3::new(
            (if turn < 0.0 { turn + 1.0 } else { turn }) * f64::from(around),
            libm::atan2(axial, at.z) / PI * polar,
            libm::sqrt(at.length_squared()) * radial,
        )
    }

    /// Returns the value at `position`; NaN if the position is not finite.
    #[must_use]
    pub fn value(&self, position: impl Into<DVec3>) -> f32 {
        self.texture.value(self.cell_position(position))
    }

    /// Returns the gradient of the value with respect to `[x, y, z]`.
    #[must_use]
    pub fn gradient(&self, position: impl Into<DVec3>) -> DVec3 {
        let at = position.into();
        let RadialCells {
            around,
            polar,
            radial,
        } = self.cells;
        let of_cells = self.texture.gradient(self.cell_position(at));
        let (axial_sq, radius_sq) = (at.x * at.x + at.y * at.y, at.length_squared());
        let mut gradient = DVec3::ZERO;
        // Add the derivatives of the azimuth and of the polar angle, which are defined except on the axis.
        if axial_sq > 0.0 {
            // ∂φ = (−y, x, 0) / (x² + y²), and ∂θ = (xz/ρ, yz/ρ, −ρ) / r² with the distance ρ from the axis.
            let azimuth = DVec3::new(-at.y, at.x, 0.0) / axial_sq;
            gradient += azimuth * (of_cells.x * f64::from(around) / TAU);
            let axial = libm::sqrt(axial_sq);
            let angle = DVec3::new(at.x * at.z / axial, at.y * at.z / axial, -axial) / radius_sq;
            gradient += angle * (of_cells.y * polar / PI);
        }
        // Add the derivative of the radius.
        if radius_sq > 0.0 {
            gradient += at / libm::sqrt(radius_sq) * (of_cells.z * radial);
        }
        gradient
    }
}
