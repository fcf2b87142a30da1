//! Even points on a surface, in columns.

use dapple_mesh::{Surface, SurfacePoint};
use glam::DVec3;

/// The number of a site of a hierarchy, from 0; the sites of the coarsest level come first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SiteIdx(pub u32);

impl SiteIdx {
    /// The number as an index into a column.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// Points on a surface that a texture gives colors to: columns indexed by [`SiteIdx`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sites {
    points: Vec<SurfacePoint>,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
}

impl Sites {
    /// The columns of some points of a surface.
    ///
    /// # Panics
    ///
    /// If a point names a face that the surface does not have.
    #[must_use]
    pub fn new(surface: &Surface, points: Vec<SurfacePoint>) -> Self {
        Self {
            positions: points
                .iter()
                .map(|&point| surface.position(point))
                .collect(),
            normals: points.iter().map(|&point| surface.normal(point)).collect(),
            points,
        }
    }

    /// The number of sites.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Where the sites are on the surface.
    #[must_use]
    pub fn points(&self) -> &[SurfacePoint] {
        &self.points
    }

    /// Where the sites are in space.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The unit normals of the smooth surface at the sites.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// All sites, in order.
    pub fn iter(&self) -> impl Iterator<Item = SiteIdx> + use<> {
        (0..self.points.len() as u32).map(SiteIdx)
    }
}
