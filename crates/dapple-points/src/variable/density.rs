//! Computes radii for a desired density or number of points.

use crate::{Domain, PointsError, PointsErrorKind};
use dapple_raster::Varying;
use glam::DVec2;

/// Normalized density N r² / area of random sequential addition (RSA) at saturation, for points at least r apart. It
/// corresponds to a packing fraction of 0.547 for discs of diameter r.
pub const RSA_DENSITY: f64 = 0.697;

/// Number of samples per axis for computing the mean of a density.
const PLACES: u32 = 256;

/// Returns the radius at which a Poisson-disk set has the given density, in points per area: sqrt(0.697 / density).
///
/// # Examples
///
/// ```
/// use dapple_points::{glam::DVec2, radius_from_density};
///
/// let radius = radius_from_density(&0.697.into());
/// assert_eq!(radius.at(DVec2::ZERO), 1.0);
/// ```
#[must_use]
pub fn radius_from_density(density: &Varying) -> Varying {
    scaled_radius(density, RSA_DENSITY)
}

/// Returns the radius at which about `n_points` points follow the given density, whose scale does not matter.
///
/// The density is sampled at 256 × 256 positions. Sides that do not wrap have room for some additional points, about
/// 0.24 per radius of their length (measured).
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] for a domain without area, [`PointsErrorKind::NotPositive`] if `n_points` or the mean of
/// the density is not above zero and finite.
pub fn radius_for_count(
    domain: Domain,
    density: &Varying,
    n_points: f64,
) -> Result<Varying, PointsError> {
    let domain = domain.checked()?;
    let step = domain.size / f64::from(PLACES);
    let mut sum = 0.0;
    for y in 0..PLACES {
        for x in 0..PLACES {
            let place = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            sum += density.at(domain.origin + step * place);
        }
    }
    let mean = sum / f64::from(PLACES * PLACES);
    for (what, value) in [
        ("the number of points", n_points),
        ("the mean density", mean),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(PointsError::new(PointsErrorKind::NotPositive {
                what,
                value,
            }));
        }
    }
    Ok(scaled_radius(
        density,
        RSA_DENSITY * mean * domain.area() / n_points,
    ))
}

/// Returns the radius sqrt(scale / density).
fn scaled_radius(density: &Varying, scale: f64) -> Varying {
    match density {
        Varying::Constant(density) => Varying::Constant((scale / density).sqrt()),
        density => {
            let density = density.clone();
            Varying::function(move |position| (scale / density.at(position)).sqrt())
        }
    }
}
