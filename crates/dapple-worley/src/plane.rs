//! Planes through 2-D, 3-D and 4-D space.

use crate::fixed::MOST_AXES;
use crate::{Dimensions, Space, Vector};
use dapple_raster::Window;

/// A plane through space on which images are rendered. The position `[x, y]` on it is `origin + x·u + y·v` in space.
///
#[cfg_attr(doc, doc = include_str!("../docs/plane.md"))]
///
/// # Examples
///
/// ```
/// use dapple_worley::{Plane, raster::glam::{DVec2, DVec3}};
///
/// let slice = Plane::<3>::slice(DVec3::new(0.0, 0.0, 7.5));
/// assert_eq!(slice.position(DVec2::new(1.0, 2.0)), DVec3::new(1.0, 2.0, 7.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane<const N: usize>
where
    Dimensions: Space<N>,
{
    /// Position of `[0, 0]` in space.
    pub origin: Vector<N>,
    /// Vector from `[0, 0]` to `[1, 0]`. Rendering is fastest if `u` is along the first axis and `v` is orthogonal to
    /// it.
    pub u: Vector<N>,
    /// Vector from `[0, 0]` to `[0, 1]`.
    pub v: Vector<N>,
}

impl<const N: usize> Plane<N>
where
    Dimensions: Space<N>,
{
    /// Returns the plane along the first two axes, through `origin`.
    #[must_use]
    pub fn slice(origin: Vector<N>) -> Self {
        let along = |axis: usize| {
            let mut way = [0.0; N];
            way[axis] = 1.0;
            Vector::<N>::from(way)
        };
        Self {
            origin,
            u: along(0),
            v: along(1),
        }
    }

    /// Returns the plane that contains a window of space.
    pub(crate) fn of_window(window: &Window<N>) -> Self {
        let mut origin = window.position(0, 0);
        // Positions in the window have their own coordinates along the first two axes.
        origin[..2].fill(0.0);
        Self::slice(origin.into())
    }

    /// Converts a position on the plane to a position in space.
    #[must_use]
    pub fn position(&self, position: impl Into<[f64; 2]>) -> Vector<N> {
        let position = position.into();
        let section = self.section();
        Vector::<N>::from(core::array::from_fn(|axis| {
            section.coordinate(axis, position)
        }))
    }

    /// Converts the plane to a [`Section`], which rendering uses for any number of axes.
    pub(crate) fn section(&self) -> Section {
        let flat = |part: Vector<N>| {
            let mut parts = [0.0; MOST_AXES];
            parts[..N].copy_from_slice(&part.into());
            parts
        };
        Section {
            n_axes: N,
            origin: flat(self.origin),
            u: flat(self.u),
            v: flat(self.v),
        }
    }
}

/// A [`Plane`] with any number of axes. Components along missing axes are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Section {
    pub(crate) n_axes: usize,
    pub(crate) origin: [f64; MOST_AXES],
    pub(crate) u: [f64; MOST_AXES],
    pub(crate) v: [f64; MOST_AXES],
}

impl Section {
    /// Returns the coordinate along `axis`, in space, of a position on the plane.
    #[inline]
    pub(crate) fn coordinate(&self, axis: usize, [x, y]: [f64; 2]) -> f64 {
        self.origin[axis] + (self.u[axis] * x + self.v[axis] * y)
    }

    /// Returns whether positions on another plane have the same coordinates along an axis.
    pub(crate) fn is_same_along(&self, axis: usize, other: &Self) -> bool {
        let parts = |plane: &Self| [plane.origin, plane.u, plane.v].map(|part| part[axis]);
        parts(self) == parts(other)
    }

    /// Returns the axis of space along which rows of pixels differ. `None` if there are several, or if it is the first
    /// axis.
    pub(crate) fn row_axis(&self) -> Option<usize> {
        let mut axes = (0..self.n_axes).filter(|&axis| self.v[axis] != 0.0);
        axes.next()
            .filter(|&axis| axis > 0 && axes.next().is_none())
    }

    /// Returns whether pixels of a row differ along the first axis only, and rows do not differ along it.
    pub(crate) fn is_upright(&self) -> bool {
        self.v[0] == 0.0 && self.u[1..].iter().all(|&part| part == 0.0)
    }
}

impl<const N: usize> Default for Plane<N>
where
    Dimensions: Space<N>,
{
    /// Returns the plane along the first two axes, with zero along the others.
    fn default() -> Self {
        Self::slice(Vector::<N>::from([0.0; N]))
    }
}
