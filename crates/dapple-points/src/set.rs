//! A list of positions in a domain.

use crate::{Domain, PointsError, PointsErrorKind};
use glam::DVec2;

/// Index of a point in its set, starting at 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(transparent)
)]
pub struct PointIdx(pub u32);

impl PointIdx {
    /// Returns the index as `usize`, for use with slices.
    #[must_use]
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// Points in a domain, in a fixed order that depends on the function that created them.
///
/// The serialized form (feature `serde`) is the domain and the positions; reading validates them like
/// [`PointSet::new`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Unchecked")
)]
pub struct PointSet {
    domain: Domain,
    positions: Vec<DVec2>,
}

/// Serialized form of a point set, before validation.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "PointSet", deny_unknown_fields)]
struct Unchecked {
    domain: Domain,
    positions: Vec<DVec2>,
}

#[cfg(feature = "serde")]
impl TryFrom<Unchecked> for PointSet {
    type Error = PointsError;

    fn try_from(data: Unchecked) -> Result<Self, PointsError> {
        Self::new(data.domain, data.positions)
    }
}

impl PointSet {
    /// Creates a set from positions, which are wrapped into the domain along wrapped axes.
    ///
    /// Any number of points is accepted, including none, and points may coincide.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::Domain`] for a domain without area, [`PointsErrorKind::Outside`] for a position that is not
    /// finite or is outside along an axis that does not wrap, [`PointsErrorKind::TooMany`] for more than 2^31 points.
    pub fn new(domain: Domain, mut positions: Vec<DVec2>) -> Result<Self, PointsError> {
        let domain = domain.checked()?;
        if positions.len() > 1 << 31 {
            return Err(PointsError::new(PointsErrorKind::TooMany {
                needed: positions.len() as f64,
                limit: 1 << 31,
            }));
        }
        for (point, position) in (0..).map(PointIdx).zip(&mut positions) {
            let wrapped = domain.wrap(*position);
            if !position.is_finite() || !domain.contains(wrapped) {
                return Err(PointsError::new(PointsErrorKind::Outside {
                    point,
                    position: *position,
                }));
            }
            *position = wrapped;
        }
        Ok(Self { domain, positions })
    }

    /// Returns the domain of the points.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns the number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns whether the set is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns the positions, indexed by [`PointIdx`].
    #[must_use]
    pub fn positions(&self) -> &[DVec2] {
        &self.positions
    }

    /// Returns the position of a point.
    ///
    /// # Panics
    ///
    /// If the point does not exist.
    #[must_use]
    pub fn position(&self, point: PointIdx) -> DVec2 {
        self.positions[point.index()]
    }

    /// Iterates over the points and their positions, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (PointIdx, DVec2)> + '_ {
        // A set has at most 2^31 points, so the index fits.
        self.positions
            .iter()
            .enumerate()
            .map(|(index, &position)| (PointIdx(index as u32), position))
    }
}

#[cfg(test)]
mod tests {
    use super::PointSet;
    use crate::{Domain, PointsErrorKind};
    use glam::DVec2;

    #[test]
    fn positions_are_wrapped_and_checked() {
        let torus = Domain::paper_torus();
        let set = PointSet::new(torus, vec![DVec2::new(1.5, 0.0), DVec2::ZERO]).unwrap();
        assert_eq!(set.positions(), [DVec2::new(-0.5, 0.0), DVec2::ZERO]);
        let rectangle = Domain {
            wrap: [false; 2],
            ..torus
        };
        for bad in [DVec2::new(1.5, 0.0), DVec2::NAN, DVec2::INFINITY] {
            let error = PointSet::new(rectangle, vec![DVec2::ZERO, bad]).unwrap_err();
            assert!(
                matches!(error.kind(), PointsErrorKind::Outside { point, .. } if point.0 == 1),
                "{error}"
            );
        }
    }
    #[cfg(feature = "serde")]
    #[test]
    fn sets_are_read_as_they_were_written_or_refused() {
        let positions = vec![
            DVec2::new(-0.75, 0.5),
            DVec2::ZERO,
            DVec2::new(0.1, 1.0 / 3.0),
        ];
        let set = PointSet::new(Domain::paper_torus(), positions).unwrap();
        let text = serde_json::to_string(&set).unwrap();
        assert_eq!(serde_json::from_str::<PointSet>(&text).unwrap(), set);
        let start = r#"{"domain":{"origin":[0.0,0.0],"size":"#;
        let read = |rest: &str| serde_json::from_str::<PointSet>(&format!("{start}{rest}"));
        let wrapped = read(r#"[2.0,2.0],"wrap":[true,false]},"positions":[[-0.5,2.0]]}"#).unwrap();
        assert_eq!(wrapped.positions(), [DVec2::new(1.5, 2.0)]);
        for (bad, cause) in [
            (
                r#"[0.0,1.0],"wrap":[true,true]},"positions":[]}"#,
                "has size",
            ),
            (
                r#"[1.0,1.0],"wrap":[true,false]},"positions":[[0.0,1.5]]}"#,
                "point 0 at",
            ),
            (
                r#"[1.0,1.0],"wrap":[true,true]},"positions":[[0.0,1e999]]}"#,
                "out of range",
            ),
            (
                r#"[1.0,1.0],"wrap":[true,true]},"positions":[],"n":1}"#,
                "unknown field",
            ),
        ] {
            let error = read(bad).unwrap_err().to_string();
            assert!(error.contains(cause), "{error}");
        }
    }
}
