//! Radii for arbitrary densities, such as photographs, including those with edges, gaps and grain.
//!
//! A point set cannot follow a density that changes strongly within the distance between its points, and
//! [`variable_poisson_disk`](crate::variable_poisson_disk) rejects a radius whose slope is 1 or more. Here the radius
//! is sampled on a lattice, and each position p gets the minimum of `radius(q) + slope · |p - q|` over all positions
//! `q`: the largest radius below the given one whose slope is limited. The points therefore thin out gradually around
//! small, dense spots, and no small spot is lost.
//!
//! Distances are path lengths in steps to the eight neighbors, which are up to 8 % longer than straight lines. They
//! are computed by a forward and a backward sweep over the lattice: Gunilla Borgefors, "Distance transformations in
//! digital images", Computer Vision, Graphics, and Image Processing 34(3), 1986,
//! <https://doi.org/10.1016/S0734-189X(86)80047-0>. With wrapped axes, the sweeps are repeated until nothing changes.
//! Lengths are in units of the domain.

use super::density::{RSA_DENSITY, radius_for_count};
use crate::{Domain, PointsError, PointsErrorKind};
use dapple_raster::{Raster, Varying, Wrap};
use glam::DVec2;
use std::sync::Arc;

/// Maximum slope of the radius along an axis or a diagonal. In between, a bilinear radius can be 1.42 times as steep,
/// which is still below 1.
const SLOPE: f64 = 0.5;
/// Number of times the radius is rescaled toward the desired number of points. Each time removes about 90 % of the
/// error.
const ROUNDS: usize = 6;

/// Returns the radius at which about `n_points` points follow an arbitrary density, whose scale does not matter.
///
/// The density is sampled at `places` positions, in columns and rows. It must be at least 0; where it is 0, points
/// are as far apart as the maximum slope of ½ allows. A lattice finer than half the distance between points has no
/// benefit.
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] for a domain without area, [`PointsErrorKind::NotPositive`] if `n_points` or the mean
/// of the density is not above zero and finite, [`PointsErrorKind::TooMany`] if `places` has no positions or more
/// than 2^26.
///
/// # Examples
///
/// ```
/// use dapple_points::raster::Varying;
/// use dapple_points::{Domain, gentle_radius_for_count, hash::Seed, variable_poisson_disk};
///
/// // All points are in the right half.
/// let half = Varying::function(|position| f64::from(position.x > 0.0));
/// let domain = Domain::paper_torus();
/// let radius = gentle_radius_for_count(domain, &half, 1000.0, [128, 128])?;
/// let points = variable_poisson_disk(domain, &radius, &Default::default(), Seed(7))?;
/// assert!((900..1100).contains(&points.len()));
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn gentle_radius_for_count(
    domain: Domain,
    density: &Varying,
    n_points: f64,
    places: [u32; 2],
) -> Result<Varying, PointsError> {
    let n_places = u64::from(places[0]) * u64::from(places[1]);
    if !(1..=PLACES_MAX).contains(&n_places) {
        return Err(PointsError::new(PointsErrorKind::TooMany {
            needed: n_places as f64,
            limit: PLACES_MAX,
        }));
    }
    // This call checks the domain and the density.
    let radius = radius_for_count(domain, density, n_points)?;
    let lattice = Lattice::new(&domain, places);
    let steep = lattice.read(&radius);
    // Maximum useful radius, also where the density is 0
    let most = domain.size.max_element();
    let mut scale = 1.0;
    let mut gentle = Vec::new();
    for _ in 0..ROUNDS {
        gentle = steep
            .iter()
            .map(|&radius| (scale * radius).min(most))
            .collect();
        lattice.limit(&mut gentle);
        let inverse: f64 = gentle.iter().map(|radius| 1.0 / (radius * radius)).sum();
        let found = RSA_DENSITY * domain.area() * inverse / gentle.len() as f64;
        scale *= (found / n_points).sqrt();
    }
    let radii = gentle.into_iter().map(|radius| radius as f32).collect();
    let raster = Raster::from_vec(places, radii).map_err(|_| {
        PointsError::new(PointsErrorKind::TooMany {
            needed: n_places as f64,
            limit: PLACES_MAX,
        })
    })?;
    let wrap = |wraps| if wraps { Wrap::Repeat } else { Wrap::Clamp };
    Ok(Varying::Raster {
        raster: Arc::new(raster),
        origin: domain.origin,
        extent: domain.size,
        wrap: domain.wrap.map(wrap),
    })
}

/// Maximum number of lattice positions.
const PLACES_MAX: u64 = 1 << 26;

/// The lattice positions of a domain, in columns and rows.
struct Lattice<'a> {
    domain: &'a Domain,
    columns: usize,
    rows: usize,
    /// Maximum increase of the radius from a lattice position to the next one along a row, a column and a diagonal.
    rises: [f64; 3],
}

impl<'a> Lattice<'a> {
    fn new(domain: &'a Domain, places: [u32; 2]) -> Self {
        let step = domain.size / DVec2::new(places[0].into(), places[1].into());
        let diagonal = (step.x * step.x + step.y * step.y).sqrt();
        Self {
            domain,
            columns: places[0] as usize,
            rows: places[1] as usize,
            rises: [step.x, step.y, diagonal].map(|length| SLOPE * length),
        }
    }

    /// Samples the radius at all positions, row by row. NaN becomes infinity.
    fn read(&self, radius: &Varying) -> Vec<f64> {
        let count = DVec2::new(self.columns as f64, self.rows as f64);
        let mut radii = Vec::with_capacity(self.columns * self.rows);
        for row in 0..self.rows {
            for column in 0..self.columns {
                let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) / count;
                let radius = radius.at(self.domain.origin + self.domain.size * place);
                radii.push(if radius.is_nan() {
                    f64::INFINITY
                } else {
                    radius
                });
            }
        }
        radii
    }

    /// Lowers radii until none is too steep.
    fn limit(&self, radii: &mut [f64]) {
        loop {
            let mut is_changed = false;
            for index in 0..radii.len() {
                is_changed |= self.lower(radii, index, -1);
            }
            for index in (0..radii.len()).rev() {
                is_changed |= self.lower(radii, index, 1);
            }
            // Without a wrapped axis, two sweeps are sufficient.
            if !is_changed || self.domain.wrap == [false; 2] {
                return;
            }
        }
    }

    /// Lowers one radius to the limit that its neighbors on one side (preceding or following) impose.
    fn lower(&self, radii: &mut [f64], index: usize, side: i64) -> bool {
        let (column, row) = (index % self.columns, index / self.columns);
        let [x, y, diagonal] = self.rises;
        let mut least = radii[index];
        for (right, down, rise) in [
            (side, 0, x),
            (-1, side, diagonal),
            (0, side, y),
            (1, side, diagonal),
        ] {
            let [wraps_x, wraps_y] = self.domain.wrap;
            let column = neighbor(column, right, self.columns, wraps_x);
            let row = neighbor(row, down, self.rows, wraps_y);
            if let (Some(column), Some(row)) = (column, row) {
                least = least.min(radii[row * self.columns + column] + rise);
            }
        }
        let is_lower = least < radii[index];
        radii[index] = least;
        is_lower
    }
}

/// Returns the index `step` away on an axis; `None` if it is beyond the end of an axis that does not wrap.
fn neighbor(place: usize, step: i64, length: usize, wraps: bool) -> Option<usize> {
    let beside = place as i64 + step;
    if wraps {
        return Some(beside.rem_euclid(length as i64) as usize);
    }
    usize::try_from(beside)
        .ok()
        .filter(|&beside| beside < length)
}

#[cfg(test)]
mod tests {
    use super::{Lattice, SLOPE, gentle_radius_for_count};
    use crate::{Domain, PointsErrorKind, variable_poisson_disk};
    use dapple_hash::Seed;
    use dapple_raster::Varying;
    use glam::DVec2;

    /// Returns black, white and gray squares with hard edges.
    fn squares() -> Varying {
        Varying::function(|at| {
            let [x, y] = (at * 3.0).floor().to_array();
            let square = (x + 2.0 * y) as i64;
            [0.0, 0.05, 1.0][square.rem_euclid(3) as usize]
        })
    }

    fn unit(wrap: [bool; 2]) -> Domain {
        Domain {
            wrap,
            ..Domain::rectangle(DVec2::ZERO, DVec2::new(1.0, 0.75))
        }
    }

    /// Returns the length of the shortest path in steps to the eight neighbors, with as many diagonal steps as
    /// possible.
    fn steps(from: [f64; 2], to: [f64; 2], domain: &Domain, places: [f64; 2]) -> f64 {
        let along = |axis: usize| {
            let straight = (from[axis] - to[axis]).abs();
            if domain.wrap[axis] {
                straight.min(places[axis] - straight)
            } else {
                straight
            }
        };
        let [x, y] = [along(0), along(1)];
        let step = domain.size / DVec2::from(places);
        let diagonal = x.min(y);
        diagonal * step.length() + (x - diagonal) * step.x + (y - diagonal) * step.y
    }

    #[test]
    fn limit_is_the_least_over_all_places() {
        for wrap in [[false; 2], [true, false], [true; 2]] {
            let domain = unit(wrap);
            let lattice = Lattice::new(&domain, [13, 9]);
            let steep: Vec<f64> = (0..117).map(|i| 0.02 + f64::from(i * 37 % 23)).collect();
            let mut gentle = steep.clone();
            lattice.limit(&mut gentle);
            let place = |index: usize| [(index % 13) as f64, (index / 13) as f64];
            for (index, &radius) in gentle.iter().enumerate() {
                let allowed = steep.iter().enumerate().map(|(other, radius)| {
                    radius + SLOPE * steps(place(index), place(other), &domain, [13.0, 9.0])
                });
                let least = allowed.fold(f64::INFINITY, f64::min);
                // Tolerance: sums of a dozen steps in another order.
                assert!((radius - least).abs() < 1e-12, "{wrap:?}, place {index}");
            }
        }
    }

    #[test]
    fn counts_are_met_for_a_density_with_edges() {
        for (wrap, n_points) in [([true; 2], 500.0), ([false; 2], 3000.0)] {
            let domain = unit(wrap);
            let radius = gentle_radius_for_count(domain, &squares(), n_points, [96, 72]).unwrap();
            let points = variable_poisson_disk(domain, &radius, &Default::default(), Seed(3));
            let found = points.unwrap().len() as f64;
            // Slopes of one half lose some points; see `variable_poisson_disk`.
            assert!(
                (found / n_points - 1.0).abs() < 0.12,
                "{found} of {n_points}"
            );
        }
    }

    #[test]
    fn bad_input_is_a_typed_error() {
        let domain = unit([true; 2]);
        let kind = |density: f64, n_points, places| {
            let radius = gentle_radius_for_count(domain, &density.into(), n_points, places);
            radius.map(|_| ()).map_err(|error| error.kind().clone())
        };
        for places in [[0, 5], [1 << 14, 1 << 13]] {
            let error = kind(1.0, 10.0, places).unwrap_err();
            assert!(
                matches!(error, PointsErrorKind::TooMany { .. }),
                "{error:?}"
            );
        }
        for (density, n_points) in [(0.0, 10.0), (f64::NAN, 10.0), (1.0, 0.0), (1.0, f64::NAN)] {
            let error = kind(density, n_points, [4, 4]).unwrap_err();
            assert!(
                matches!(error, PointsErrorKind::NotPositive { .. }),
                "{error:?}"
            );
        }
    }

    #[test]
    fn value_stability_gentle_radius() {
        let radius = gentle_radius_for_count(unit([true; 2]), &squares(), 400.0, [32, 24]).unwrap();
        let at = |x, y| radius.at(DVec2::new(x, y));
        let found = [at(0.1, 0.1), at(0.5, 0.3), at(0.9, 0.7)];
        assert_eq!(
            found,
            [
                0.08200636506080627,
                0.10525857657194138,
                0.05700637400150299
            ]
        );
    }
}
