//! Spacing of a recipe's control points, which is constant or depends on the position.

#[cfg(feature = "serde")]
mod data;

use crate::PupsError;
use dapple_hash::Seed;
use dapple_points::{
    Domain, IsCancelled, PointSet, VariablePoissonOptions, poisson_disk_cancellable,
    poisson_disk_radius, radius_from_density, variable_poisson_disk_cancellable,
};
use dapple_raster::{Ramp, Varying};
use glam::DVec2;

/// Spacing of control points, which are always a maximal Poisson-disk set.
///
#[cfg_attr(doc, doc = include_str!("../../docs/spacing.md"))]
///
/// # Examples
///
/// ```
/// use dapple_pups::{Spacing, hash::Seed, points::Domain};
///
/// let points = Spacing::from(0.1).points(Domain::paper_torus(), Seed(7))?;
/// assert!((260..300).contains(&points.len()));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
///
/// Serialized as a number if the smallest distance is the same everywhere, otherwise as `{ distance = … }`,
/// `{ density = … }` or `{ count = … }`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Spacing {
    /// The smallest distance between two points, in units of the domain.
    Distance(Varying),
    /// Points per unit of area, in units of the domain. Gives the smallest distance sqrt(0.697 / density).
    Density(Varying),
    /// Approximate number of points in the domain, equally dense everywhere.
    Count(u32),
}

impl From<f64> for Spacing {
    /// Creates a spacing with the same smallest distance everywhere, in units of the domain.
    fn from(distance: f64) -> Self {
        Self::Distance(distance.into())
    }
}

impl Spacing {
    /// Generates a maximal Poisson-disk set with this spacing.
    ///
    /// # Errors
    ///
    /// [`Points`](crate::PupsErrorKind::Points) if [`poisson_disk`](dapple_points::poisson_disk) fails or, for a
    /// varying spacing, if [`variable_poisson_disk`](dapple_points::variable_poisson_disk) fails.
    pub fn points(&self, domain: Domain, seed: Seed) -> Result<PointSet, PupsError> {
        self.points_cancellable(domain, seed, &|| false)
    }

    /// Generates the same set as [`points`](Self::points), unless `is_cancelled` returns true.
    ///
    /// # Errors
    ///
    /// Same as [`points`](Self::points), and [`Cancelled`](crate::PupsErrorKind::Cancelled).
    pub fn points_cancellable(
        &self,
        domain: Domain,
        seed: Seed,
        is_cancelled: &IsCancelled,
    ) -> Result<PointSet, PupsError> {
        let radius = match self {
            Self::Distance(distance) => distance.clone(),
            Self::Density(density) => radius_from_density(density),
            Self::Count(n_points) => poisson_disk_radius(domain, *n_points)?.into(),
        };
        let points = match radius {
            Varying::Constant(radius) => {
                poisson_disk_cancellable(domain, radius, seed, is_cancelled)
            }
            radius => {
                let options = VariablePoissonOptions::default();
                variable_poisson_disk_cancellable(domain, &radius, &options, seed, is_cancelled)
            }
        };
        points.map_err(PupsError::of_part)
    }

    /// Estimates the number of [`points`](Self::points) in the domain without generating them. The estimate is more
    /// likely too large than too small, and may be infinite.
    ///
    /// For distances that are constant or a ramp, the estimate is an upper bound. With many points, it is at most twice
    /// the number. Any other variation is sampled at a few thousand positions only. The estimate for an invalid spacing
    /// is 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_pups::{Spacing, hash::Seed, points::Domain};
    ///
    /// let (spacing, domain) = (Spacing::from(0.1), Domain::paper_torus());
    /// let points = spacing.points(domain, Seed(7))?;
    /// assert!(spacing.expected_points(domain) >= points.len() as f64);
    /// # Ok::<(), dapple_pups::PupsError>(())
    /// ```
    #[must_use]
    pub fn expected_points(&self, domain: Domain) -> f64 {
        let radius = match self {
            Self::Distance(distance) => distance.clone(),
            Self::Density(density) => radius_from_density(density),
            Self::Count(n_points) => return 1.2 * f64::from(*n_points) + 8.0,
        };
        match radius {
            Varying::Constant(radius) => expected_in(domain.size, radius),
            radius => expected_by_parts(domain, &radius),
        }
    }

    /// Returns the smallest distance between points; `None` if it varies.
    pub(crate) fn uniform_distance(&self, domain: Domain) -> Result<Option<f64>, PupsError> {
        let distance = match self {
            Self::Distance(distance) => distance.clone(),
            Self::Density(density) => radius_from_density(density),
            Self::Count(n_points) => poisson_disk_radius(domain, *n_points)?.into(),
        };
        Ok(match distance {
            Varying::Constant(distance) => Some(distance),
            _ => None,
        })
    }

    /// Returns a text that identifies the spacing; `None` if the spacing comes from a raster or a function.
    pub(crate) fn description(&self) -> Option<String> {
        match self {
            Self::Distance(varying) | Self::Density(varying) => matches!(
                varying,
                Varying::Constant(_) | Varying::Ramp(_) | Varying::GeometricRamp(_)
            )
            .then(|| format!("{self:?}")),
            Self::Count(_) => Some(format!("{self:?}")),
        }
    }

    /// Returns the spacing with all distances divided by `factor`, which gives `factor²` times as many points.
    #[must_use]
    pub fn finer(&self, factor: f64) -> Self {
        match self {
            Self::Distance(distance) => Self::Distance(scaled(distance, 1.0 / factor)),
            Self::Density(density) => Self::Density(scaled(density, factor * factor)),
            Self::Count(n_points) => {
                // Saturates. The number of points is then above the limit anyway.
                Self::Count((f64::from(*n_points) * factor * factor).round() as u32)
            }
        }
    }
}

/// Estimated maximum number of points in an area equal to the squared minimum distance. Random maximal sets have 0.70.
const POINTS_PER_SQUARE: f64 = 0.75;

/// Number of cells along each axis of the domain. In each cell, a varying spacing is replaced by its minimum.
const PARTS: u32 = 64;

/// Estimates the maximum number of points in a rectangle, including its borders, with minimum distance `radius`.
fn expected_in(size: DVec2, radius: f64) -> f64 {
    if radius > 0.0 {
        let sides = size / radius + 1.0;
        POINTS_PER_SQUARE * sides.x * sides.y + 1.0
    } else {
        0.0
    }
}

/// Sums estimates over a grid of cells in the domain. The radius of a cell is the smallest of the radii at its
/// corners.
fn expected_by_parts(domain: Domain, radius: &Varying) -> f64 {
    let part = domain.size / f64::from(PARTS);
    let at = |x: u32, y: u32| {
        let radius = radius.at(domain.origin + part * DVec2::new(x.into(), y.into()));
        if radius > 0.0 { radius } else { f64::INFINITY }
    };
    let row = |y: u32| (0..=PARTS).map(|x| at(x, y)).collect::<Vec<_>>();
    // Points on the border of the domain count in addition to the points of its area.
    let is_border = |index: u32| f64::from(u8::from(index == 0 || index == PARTS - 1));
    // Adjacent rows of cells share a row of corners, so each is evaluated once.
    let mut above = row(0);
    let mut sum = 1.0;
    for y in 0..PARTS {
        let below = row(y + 1);
        for (x, (above, below)) in (0..).zip(above.windows(2).zip(below.windows(2))) {
            // Use the smallest distance at the corners, where points are densest.
            let corners = above.iter().chain(below).copied();
            let smallest = corners.fold(f64::INFINITY, f64::min);
            let sides = part / smallest + DVec2::new(is_border(x), is_border(y));
            sum += POINTS_PER_SQUARE * sides.x * sides.y;
        }
        above = below;
    }
    sum
}

/// Multiplies a varying number by a factor.
fn scaled(varying: &Varying, factor: f64) -> Varying {
    let ramp = |ramp: &Ramp| Ramp {
        start: ramp.start * factor,
        end: ramp.end * factor,
        ..*ramp
    };
    match varying {
        Varying::Constant(value) => Varying::Constant(value * factor),
        Varying::Ramp(of) => Varying::Ramp(ramp(of)),
        Varying::GeometricRamp(of) => Varying::GeometricRamp(ramp(of)),
        other => {
            let other = other.clone();
            Varying::function(move |position| other.at(position) * factor)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Spacing;
    use dapple_hash::Seed;
    use dapple_points::Domain;
    use dapple_raster::{Ramp, Varying};
    use glam::DVec2;

    /// Returns spacings that vary along the diagonal of a domain, and constant ones.
    fn spacings(domain: Domain) -> Vec<Spacing> {
        let ramp = Ramp {
            from: domain.origin,
            to: domain.end(),
            start: 0.01,
            end: 0.15,
        };
        let densities = Ramp {
            start: 200.0,
            end: 2000.0,
            ..ramp
        };
        vec![
            Spacing::from(0.02),
            Spacing::from(0.4),
            Spacing::Count(12),
            Spacing::Count(3000),
            Spacing::Density(Varying::Constant(500.0)),
            Spacing::Density(Varying::Ramp(densities)),
            Spacing::Distance(Varying::Ramp(ramp)),
            Spacing::Distance(Varying::GeometricRamp(ramp)),
        ]
    }

    #[test]
    fn expected_points_are_never_too_few_and_not_many_times_too_many() {
        let torus = Domain::torus(DVec2::new(-1.0, 2.0), DVec2::new(2.0, 1.0));
        let rectangle = Domain {
            wrap: [false; 2],
            ..torus
        };
        for domain in [torus, rectangle] {
            for spacing in spacings(rectangle) {
                // A spacing that varies does not repeat, so it needs the rectangle.
                let varies = matches!(
                    spacing,
                    Spacing::Distance(Varying::Ramp(_) | Varying::GeometricRamp(_))
                        | Spacing::Density(Varying::Ramp(_))
                );
                let domain = if varies { rectangle } else { domain };
                let made = spacing.points(domain, Seed(7)).unwrap().len() as f64;
                let expected = spacing.expected_points(domain);
                assert!(expected >= made, "{spacing:?}: {expected} of {made}");
                assert!(
                    expected <= 2.0 * made + 20.0,
                    "{spacing:?}: {expected} of {made}"
                );
            }
        }
    }

    #[test]
    fn expected_points_of_what_is_refused_are_none_or_any_number() {
        let domain = Domain::paper_torus();
        for refused in [0.0, -1.0, f64::NAN] {
            assert_eq!(
                Spacing::from(refused).expected_points(domain),
                0.0,
                "{refused}"
            );
        }
        assert_eq!(Spacing::from(1e-300).expected_points(domain), f64::INFINITY);
    }
}
