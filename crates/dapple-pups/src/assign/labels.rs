//! Assigns labels to points: unique, random, or binary with a probability that depends on the position.

use super::values::random_value;
use crate::PupsError;
use dapple_hash::{Seed, hash1};
use dapple_points::PointSet;
use dapple_raster::Varying;

/// Returns a unique label for every point, which makes each point a separate cell.
#[must_use]
pub fn own_labels(n_points: usize) -> Vec<u32> {
    (0..).take(n_points).collect()
}

/// Returns independent random labels in `0..n_labels`, all equally probable (to within 2^-32).
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if `n_labels` is zero.
pub fn random_labels(n_points: usize, n_labels: u32, seed: Seed) -> Result<Vec<u32>, PupsError> {
    PupsError::check(
        n_labels > 0,
        "number of labels",
        f64::from(n_labels),
        "at least 1",
    )?;
    // Multiply a fixed-point number below 1 by the number of labels.
    let label = |index: i64| (((hash1(seed, [index], 0) >> 32) * u64::from(n_labels)) >> 32) as u32;
    Ok((0..n_points as i64).map(label).collect())
}

/// Returns binary labels: each point's label is 1 with the given probability at its position, else 0.
///
/// This is the "logic that depends on spatial location" of figure 17. A probability of 0.5 gives the labels of a cow.
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if a probability is not between 0 and 1.
///
/// # Examples
///
/// ```
/// use dapple_pups::points::{Domain, poisson_disk};
/// use dapple_pups::{biased_labels, hash::Seed};
///
/// let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(1))?;
/// let labels = biased_labels(&points, &0.9.into(), Seed(2))?;
/// assert!(labels.iter().sum::<u32>() > 220);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn biased_labels(
    points: &PointSet,
    probability: &Varying,
    seed: Seed,
) -> Result<Vec<u32>, PupsError> {
    let label = |(index, &position)| {
        let probability = probability.at(position);
        PupsError::check(
            (0.0..=1.0).contains(&probability),
            "probability of a label",
            probability,
            "between 0 and 1",
        )?;
        Ok(u32::from(
            f64::from(random_value(seed, index)) < probability,
        ))
    };
    (0..).zip(points.positions()).map(label).collect()
}
