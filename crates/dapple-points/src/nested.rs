//! Nested Poisson-disk sets with decreasing radius, each of which contains the previous one.
//!
//! The coarsest set is an ordinary one. Each following level keeps the previous points and adds points until none
//! fits at its radius. Every level is therefore a maximal Poisson-disk set, and the points of coarser levels come
//! first. A finer level differs from an independent set with the same radius, because its coarse points are farther
//! apart than that radius requires.

use crate::{
    Domain, IsCancelled, PointSet, PointsError, PointsErrorKind, extend_poisson_disk_cancellable,
};
use dapple_hash::Seed;

/// Points in nested levels. Each level is a prefix of the point list; the coarsest is the shortest, and the finest is
/// the whole list.
#[derive(Clone, Debug, PartialEq)]
pub struct NestedPointSet {
    points: PointSet,
    lengths: Vec<usize>,
}

impl NestedPointSet {
    /// Returns all points, which are the finest level.
    #[must_use]
    pub fn points(&self) -> &PointSet {
        &self.points
    }

    /// Returns the number of points of each level, from the coarsest to the finest.
    #[must_use]
    pub fn lengths(&self) -> &[usize] {
        &self.lengths
    }

    /// Returns the points of a level as a separate set, where 0 is the coarsest level; `None` if there is no such
    /// level.
    #[must_use]
    pub fn level(&self, level: usize) -> Option<PointSet> {
        let length = *self.lengths.get(level)?;
        let positions = self.points.positions()[..length].to_vec();
        PointSet::new(*self.points.domain(), positions).ok()
    }

    /// Converts into the set of all points, without levels.
    #[must_use]
    pub fn into_points(self) -> PointSet {
        self.points
    }
}

/// Creates maximal Poisson-disk sets with the given radii, which must not increase. Each set contains the previous
/// one.
///
/// The radii are in units of the domain. Half the radius gives about four times the points; for twice the points,
/// divide the radius by the square root of two.
///
#[cfg_attr(doc, doc = include_str!("../docs/nested-poisson-disk.md"))]
///
/// # Errors
///
/// Same as [`poisson_disk`](crate::poisson_disk) for each radius, plus [`PointsErrorKind::NotDescending`] if a radius
/// is larger than the one before.
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, hash::Seed, nested_poisson_disk};
///
/// let nested = nested_poisson_disk(Domain::paper_torus(), &[0.2, 0.1], Seed(7))?;
/// let [coarse, fine] = [nested.level(0).unwrap(), nested.level(1).unwrap()];
/// assert_eq!(coarse.positions(), &fine.positions()[..coarse.len()]);
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn nested_poisson_disk(
    domain: Domain,
    radii: &[f64],
    seed: Seed,
) -> Result<NestedPointSet, PointsError> {
    nested_poisson_disk_cancellable(domain, radii, seed, &|| false)
}

/// Same as [`nested_poisson_disk`], but fails if `is_cancelled` returns true.
///
/// # Errors
///
/// Same as [`nested_poisson_disk`], plus [`PointsErrorKind::Cancelled`].
pub fn nested_poisson_disk_cancellable(
    domain: Domain,
    radii: &[f64],
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<NestedPointSet, PointsError> {
    let mut points = PointSet::new(domain, Vec::new())?;
    let mut lengths = Vec::with_capacity(radii.len());
    for (level, &radius) in radii.iter().enumerate() {
        let before = radii[level.saturating_sub(1)];
        if radius > before {
            return Err(PointsError::new(PointsErrorKind::NotDescending {
                level,
                radius,
                before,
            }));
        }
        let seed = seed.child("level", level as u64);
        points = extend_poisson_disk_cancellable(&points, radius, seed, is_cancelled)?;
        lengths.push(points.len());
    }
    Ok(NestedPointSet { points, lengths })
}

#[cfg(test)]
mod tests {
    use super::nested_poisson_disk;
    use crate::{Domain, PointsErrorKind};
    use dapple_hash::Seed;

    #[test]
    fn every_level_is_a_maximal_set_and_a_prefix_of_the_next() {
        for wrap in [[true, true], [true, false], [false, false]] {
            let domain = Domain {
                wrap,
                ..Domain::paper_torus()
            };
            // The paper doubles the number of points four times; a repeated radius adds no points.
            let radii = [0.2, 0.142, 0.1, 0.071, 0.05, 0.05];
            let nested = nested_poisson_disk(domain, &radii, Seed(1)).unwrap();
            assert_eq!(nested.lengths().len(), radii.len());
            assert_eq!(nested.lengths()[4], nested.lengths()[5], "no point fits");
            for (level, radius) in radii.into_iter().enumerate() {
                let set = nested.level(level).unwrap();
                let all = nested.points().positions();
                assert_eq!(set.positions(), &all[..set.len()], "level {level}");
                let distance = set.minimum_distance().unwrap();
                assert!(distance >= radius, "level {level}: {distance} apart");
                let gap = set.largest_empty_circle().unwrap().radius;
                // The documented tolerance
                assert!(
                    gap <= radius * (1.0 + 1e-6),
                    "level {level}: a gap of {gap}"
                );
            }
            assert!(
                nested.level(radii.len()).is_none(),
                "there is no such level"
            );
        }
    }

    #[test]
    fn radii_that_grow_are_refused() {
        let error = nested_poisson_disk(Domain::paper_torus(), &[0.1, 0.2], Seed(1)).unwrap_err();
        assert!(
            matches!(
                error.kind(),
                PointsErrorKind::NotDescending { level: 1, .. }
            ),
            "{error}"
        );
        let error = nested_poisson_disk(Domain::paper_torus(), &[0.1, f64::NAN], Seed(1));
        assert!(
            matches!(
                error.unwrap_err().kind(),
                PointsErrorKind::NotPositive { .. }
            ),
            "NaN has another error"
        );
    }

    #[test]
    fn no_radii_make_an_empty_set() {
        let nested = nested_poisson_disk(Domain::paper_torus(), &[], Seed(1)).unwrap();
        assert!(
            nested.points().is_empty() && nested.lengths().is_empty(),
            "{nested:?}"
        );
    }
}
