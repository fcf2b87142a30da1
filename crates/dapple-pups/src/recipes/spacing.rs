//! How far apart the control points of a recipe are, everywhere or depending on the position.

#[cfg(feature = "serde")]
mod data;

use crate::PupsError;
use dapple_hash::Seed;
use dapple_points::{
    Domain, PointSet, VariablePoissonOptions, poisson_disk, poisson_disk_about,
    poisson_disk_radius, radius_from_density, variable_poisson_disk,
};
use dapple_raster::{Ramp, Varying};

/// How far apart control points are; they are always a maximal Poisson-disk set.
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
/// As data it is a number, where the smallest distance is the same everywhere, or `{ distance = … }`, `{ density = … }` or
/// `{ count = … }`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Spacing {
    /// The smallest distance between two points, in units of the domain.
    Distance(Varying),
    /// Points per area, in units of the domain: a distance of sqrt(0.697 / density).
    Density(Varying),
    /// About this many points in the domain, equally dense everywhere.
    Count(u32),
}

impl From<f64> for Spacing {
    /// The same smallest distance everywhere, in units of the domain.
    fn from(distance: f64) -> Self {
        Self::Distance(distance.into())
    }
}

impl Spacing {
    /// A maximal Poisson-disk set with this spacing.
    ///
    /// # Errors
    ///
    /// [`Points`](crate::PupsErrorKind::Points) for what [`poisson_disk`] or, if the spacing varies,
    /// [`variable_poisson_disk`] refuses.
    pub fn points(&self, domain: Domain, seed: Seed) -> Result<PointSet, PupsError> {
        let radius = match self {
            Self::Distance(distance) => distance.clone(),
            Self::Density(density) => radius_from_density(density),
            Self::Count(n_points) => return Ok(poisson_disk_about(domain, *n_points, seed)?),
        };
        Ok(match radius {
            Varying::Constant(radius) => poisson_disk(domain, radius, seed)?,
            radius => {
                let options = VariablePoissonOptions::default();
                variable_poisson_disk(domain, &radius, &options, seed)?
            }
        })
    }

    /// The smallest distance, if it is the same everywhere.
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

    /// The same spacing with all distances divided by `factor`: `factor²` times as many points.
    #[must_use]
    pub fn finer(&self, factor: f64) -> Self {
        match self {
            Self::Distance(distance) => Self::Distance(scaled(distance, 1.0 / factor)),
            Self::Density(density) => Self::Density(scaled(density, factor * factor)),
            Self::Count(n_points) => {
                // Saturates, and then there are too many points.
                Self::Count((f64::from(*n_points) * factor * factor).round() as u32)
            }
        }
    }
}

/// A number that varies, multiplied everywhere.
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
