//! Rectangular domains whose opposite sides may be joined.

use crate::{PointsError, PointsErrorKind};
use glam::DVec2;

/// Maximum absolute coordinate and side of a domain, such that positions several periods away are still finite.
const FARTHEST: f64 = 1e300;

/// A rectangle from `origin` with the given `size` that wraps along the axes where `wrap` is true.
///
/// With both axes wrapped it is a torus, with one a cylinder, with none a plain rectangle. Along a wrapped axis the
/// domain includes its start and excludes its end, which is the same position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Domain {
    /// Corner with the smallest coordinates.
    pub origin: DVec2,
    /// Width and height, above zero and at most 1e300.
    pub size: DVec2,
    /// Whether x and y wrap.
    pub wrap: [bool; 2],
}

impl Domain {
    /// Creates a rectangle from `origin` with the given `size`, without wrapping.
    #[must_use]
    pub const fn rectangle(origin: DVec2, size: DVec2) -> Self {
        Self {
            origin,
            size,
            wrap: [false, false],
        }
    }

    /// Creates a torus from `origin` with the given periods, for content that repeats along both axes.
    #[must_use]
    pub const fn torus(origin: DVec2, size: DVec2) -> Self {
        Self {
            origin,
            size,
            wrap: [true, true],
        }
    }

    /// Returns the square `[-1, 1]²`, wrapped along both axes. Caron and Mould's figures use this domain.
    #[must_use]
    pub const fn paper_torus() -> Self {
        Self::torus(DVec2::NEG_ONE, DVec2::splat(2.0))
    }

    /// Checks that the domain is valid, and returns it.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::Domain`] if the origin is not between -1e300 and 1e300, or a side is not above zero and at
    /// most 1e300, or so short relative to the origin that rounding merges its ends.
    pub fn checked(self) -> Result<Self, PointsError> {
        // Comparisons with NaN are false.
        let valid = (0..2).all(|axis| {
            let (origin, size) = (self.origin[axis], self.size[axis]);
            let is_in_range = origin.abs() <= FARTHEST && size > 0.0 && size <= FARTHEST;
            is_in_range && origin + size > origin
        });
        if valid {
            Ok(self)
        } else {
            Err(PointsError::new(PointsErrorKind::Domain { domain: self }))
        }
    }

    /// Returns the domain, extended by `margin` on each side along the axes that do not wrap.
    #[must_use]
    pub fn grown(self, margin: DVec2) -> Self {
        let margin = DVec2::select(self.wrap.into(), DVec2::ZERO, margin);
        Self {
            origin: self.origin - margin,
            size: self.size + margin * 2.0,
            ..self
        }
    }

    /// Returns the area: width times height.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.size.x * self.size.y
    }

    /// Returns the domain's period along each axis: its side length if the axis wraps, and otherwise `None`.
    #[must_use]
    pub fn period(&self) -> [Option<f64>; 2] {
        [0, 1].map(|axis| self.wrap[axis].then_some(self.size[axis]))
    }

    /// Returns the corner with the largest coordinates.
    #[must_use]
    pub fn end(&self) -> DVec2 {
        self.origin + self.size
    }

    /// Returns whether the domain contains a position.
    #[must_use]
    pub fn contains(&self, position: DVec2) -> bool {
        let end = self.end();
        let inside = |axis: usize| {
            let below =
                position[axis] < end[axis] || (!self.wrap[axis] && position[axis] == end[axis]);
            position[axis] >= self.origin[axis] && below
        };
        inside(0) && inside(1)
    }

    /// Wraps a position into the domain along the wrapped axes.
    ///
    /// A position inside the domain is returned unchanged, bit for bit.
    #[must_use]
    #[inline]
    pub fn wrap(&self, position: DVec2) -> DVec2 {
        DVec2::new(self.wrap_axis(0, position.x), self.wrap_axis(1, position.y))
    }

    /// Wraps one coordinate, for axis 0 or 1; see [`wrap`](Self::wrap).
    #[must_use]
    #[inline]
    pub fn wrap_axis(&self, axis: usize, coordinate: f64) -> f64 {
        let (origin, size) = (self.origin[axis], self.size[axis]);
        let end = origin + size;
        if !self.wrap[axis] || (coordinate >= origin && coordinate < end) {
            return coordinate;
        }
        let wrapped = coordinate - ((coordinate - origin) / size).floor() * size;
        // Rounding may leave the result slightly outside; both ends are the same position.
        if wrapped >= origin && wrapped < end {
            wrapped
        } else {
            origin
        }
    }

    /// Returns the shortest vector from `from` to `to`, which goes across wrapped sides where that is shorter.
    ///
    /// Both positions must be inside the domain.
    #[must_use]
    #[inline]
    pub fn delta(&self, from: DVec2, to: DVec2) -> DVec2 {
        let along = |axis: usize| {
            let delta = to[axis] - from[axis];
            if !self.wrap[axis] || delta.abs() * 2.0 <= self.size[axis] {
                delta
            } else if delta > 0.0 {
                delta - self.size[axis]
            } else {
                delta + self.size[axis]
            }
        };
        DVec2::new(along(0), along(1))
    }
}

#[cfg(test)]
mod tests {
    use super::Domain;
    use glam::DVec2;

    #[test]
    fn positions_wrap_into_the_domain_per_axis() {
        let cylinder = Domain {
            wrap: [false, true],
            ..Domain::paper_torus()
        };
        assert_eq!(cylinder.wrap(DVec2::new(5.0, 5.0)), DVec2::new(5.0, -1.0));
        assert_eq!(cylinder.wrap(DVec2::new(0.3, -1.25)), DVec2::new(0.3, 0.75));
        let torus = Domain::paper_torus();
        for far in [1e300, -1e300, 1.0, -1.0 - f64::EPSILON, 0.999_999, -1e-300] {
            assert!(
                torus.contains(torus.wrap(DVec2::splat(far))),
                "{far} stayed outside"
            );
        }
    }

    #[test]
    fn the_shortest_way_may_go_around() {
        let torus = Domain::paper_torus();
        let delta = torus.delta(DVec2::new(0.75, -0.75), DVec2::new(-0.75, 0.5));
        assert_eq!(delta, DVec2::new(0.5, -0.75));
        let rectangle = Domain {
            wrap: [false; 2],
            ..torus
        };
        assert_eq!(
            rectangle.delta(DVec2::new(0.75, -0.75), DVec2::new(-0.75, 0.5)),
            DVec2::new(-1.5, 1.25)
        );
    }

    #[test]
    fn domains_without_area_or_without_end_are_refused() {
        for size in [
            DVec2::ZERO,
            DVec2::new(1.0, -1.0),
            DVec2::new(f64::NAN, 1.0),
            DVec2::INFINITY,
            DVec2::new(1.0, 1.1e300),
        ] {
            assert!(
                Domain::torus(DVec2::ZERO, size).checked().is_err(),
                "{size} was accepted"
            );
        }
        assert!(
            Domain::torus(DVec2::NAN, DVec2::ONE).checked().is_err(),
            "a NaN origin was accepted"
        );
        assert!(
            Domain::torus(DVec2::splat(-1.1e300), DVec2::ONE)
                .checked()
                .is_err(),
            "a far origin was accepted"
        );
        assert!(
            Domain::torus(DVec2::splat(1e17), DVec2::ONE)
                .checked()
                .is_err(),
            "a side that rounding takes away was accepted"
        );
    }
}
