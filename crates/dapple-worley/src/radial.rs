//! The radial variant: cells in azimuth, polar angle and radius.
//!
//! Worley mentions that "a radial coordinate version can cover spheres, creating a surface similar to the Death Star"
//! ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>), and gives no formula.
//! Here a position `[x, y, z]` goes to cells along three axes,
//!
//! * `n · φ / 2π`, with the azimuth `φ = atan2(y, x)` and `n` whole cells around, after which the cells repeat exactly;
//! * `m · θ / π`, with the polar angle `θ` from the north pole on +z, and `m` cells from pole to pole;
//! * `k · r`, with the radius `r`, and `k` cells per unit;
//!
//! and the distance is the metric of the basis between such triples. On the equator of the sphere of radius `r`, a cell
//! is `2πr/n` by `πr/m` by `1/k` large; toward the poles cells get narrower, and at a pole all azimuths meet, so that
//! the texture is not continuous there (as a map of the Earth is not). On the axis the azimuth is taken as 0.
//!
//! The gradient is carried back to `[x, y, z]` by the derivatives of the three coordinates. The azimuth's grows without
//! bound toward the axis; on the axis itself, and at the center, the parts that have no value are left out.

use crate::{Cellular, Worley3, WorleyError};
use core::f64::consts::{PI, TAU};
use glam::DVec3;

/// How many cells a radial texture has.
///
#[cfg_attr(doc, doc = include_str!("../docs/radial-cells.md"))]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RadialCells {
    /// Whole cells around the axis: at least 1.
    pub around: u32,
    /// Cells from pole to pole: above 0. Half as many as around make square cells on the equator.
    pub polar: f64,
    /// Cells per unit of radius: 0, for no change along the radius, or more.
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
    /// The texture over radial cells. It replaces the period of the basis.
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

    /// The basis, whose positions are [`cell_position`](Self::cell_position)s.
    #[must_use]
    pub fn worley(&self) -> &Worley3 {
        self.texture.worley()
    }

    /// Where in the cells a position is: along azimuth, polar angle and radius.
    #[must_use]
    pub fn cell_position(&self, position: impl Into<DVec3>) -> DVec3 {
        let at = position.into();
        let RadialCells {
            around,
            polar,
            radial,
        } = self.cells;
        let axial = libm::sqrt(at.x * at.x + at.y * at.y);
        let turn = libm::atan2(at.y, at.x) / TAU;
        DVec3::new(
            (if turn < 0.0 { turn + 1.0 } else { turn }) * f64::from(around),
            libm::atan2(axial, at.z) / PI * polar,
            libm::sqrt(at.length_squared()) * radial,
        )
    }

    /// The value at a position. NaN if it is not finite.
    #[must_use]
    pub fn value(&self, position: impl Into<DVec3>) -> f32 {
        self.texture.value(self.cell_position(position))
    }

    /// The gradient of the value in `[x, y, z]`, per unit.
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
        if axial_sq > 0.0 {
            let azimuth = DVec3::new(-at.y, at.x, 0.0) / axial_sq;
            gradient += azimuth * (of_cells.x * f64::from(around) / TAU);
            let axial = libm::sqrt(axial_sq);
            let angle = DVec3::new(at.x * at.z / axial, at.y * at.z / axial, -axial) / radius_sq;
            gradient += angle * (of_cells.y * polar / PI);
        }
        if radius_sq > 0.0 {
            gradient += at / libm::sqrt(radius_sq) * (of_cells.z * radial);
        }
        gradient
    }
}

#[cfg(test)]
mod tests {
    use super::{Radial, RadialCells};
    use crate::{Combination, Metric, Worley3, WorleyErrorKind};
    use dapple_hash::{Seed, hash1, unit_f64};
    use glam::DVec3;

    fn star(around: u32, polar: f64, radial: f64) -> Radial {
        let hull = Worley3::new(Seed(7))
            .with_metric(Metric::Manhattan)
            .unwrap();
        let cells = RadialCells {
            around,
            polar,
            radial,
        };
        Radial::new(hull.combine(Combination::F2_MINUS_F1), cells).unwrap()
    }

    #[test]
    fn azimuth_closes_without_a_seam() {
        let star = star(12, 6.0, 2.0);
        for index in 0..500 {
            let height = unit_f64(hash1(Seed(1), [index], 0)) - 0.5;
            let [a, b] = [1e-9, -1e-9].map(|y| star.value([0.7, y, height]));
            // Two steps of 2^-21 cells along the azimuth, whose distance changes by as much, twice for F2 - F1.
            assert!((a - b).abs() < 4e-6, "{a} and {b} at height {height}");
        }
    }

    #[test]
    fn gradient_is_that_of_differences() {
        let star = star(9, 5.0, 3.0);
        let mut smooth = 0;
        for index in 0..300 {
            let at = DVec3::from_array(
                [0, 1, 2].map(|axis| unit_f64(hash1(Seed(2), [index], axis)) - 0.4),
            );
            if at.truncate().length() < 0.1 {
                continue;
            }
            let h = 1e-4;
            let slopes = [DVec3::X, DVec3::Y, DVec3::Z]
                .map(|axis| [at + axis * h, at - axis * h].map(|at| f64::from(star.value(at))));
            let differences = DVec3::from_array(slopes.map(|[a, b]| (a - b) / (2.0 * h)));
            // Where the distances have a crease within the difference, or are rounded to steps, they disagree.
            smooth += u32::from((differences - star.gradient(at)).length() < 0.05);
        }
        assert!(smooth > 240, "only {smooth} of 300 gradients agree");
    }

    #[test]
    fn poles_and_center_have_finite_gradients() {
        let star = star(9, 5.0, 3.0);
        for at in [
            DVec3::ZERO,
            DVec3::Z,
            -DVec3::Z,
            DVec3::new(1e-200, 0.0, 1.0),
        ] {
            assert!(star.value(at) >= 0.0, "{at}");
            assert!(!star.gradient(at).is_nan(), "{at}");
        }
        assert!(star.value([f64::NAN, 0.0, 0.0]).is_nan());
    }

    #[test]
    fn bad_numbers_of_cells_are_refused() {
        for (around, polar, radial) in [
            (0, 1.0, 1.0),
            (1, 0.0, 1.0),
            (1, f64::NAN, 0.0),
            (1, 1.0, -1.0),
        ] {
            let texture = Worley3::new(Seed(7)).combine(Combination::F1);
            let error = Radial::new(
                texture,
                RadialCells {
                    around,
                    polar,
                    radial,
                },
            )
            .unwrap_err();
            assert!(
                matches!(error.kind(), WorleyErrorKind::Range { .. }),
                "{error}"
            );
        }
    }
}
