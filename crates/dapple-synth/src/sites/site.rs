//! Sites: sample points on a surface, stored in columns.

use dapple_mesh::{Surface, SurfacePoint};
use glam::DVec3;

/// Index of a site in a hierarchy, from 0. The sites of the coarsest level come first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SiteIdx(pub u32);

impl SiteIdx {
    /// Returns the index as a `usize`, for indexing a column.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// Surface points that receive colors in a synthesis, stored as columns indexed by [`SiteIdx`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sites {
    points: Vec<SurfacePoint>,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
}

impl Sites {
    /// Creates sites from surface points, and computes their positions and normals.
    ///
    /// # Panics
    ///
    /// If a point refers to a face that the surface does not have.
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

    /// Returns the number of sites.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Returns whether there are no sites.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the surface points of the sites: face and position in the face.
    #[must_use]
    pub fn points(&self) -> &[SurfacePoint] {
        &self.points
    }

    /// Returns the positions of the sites in space, in units of the mesh.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Returns the unit normals of the smooth surface at the sites.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Iterates over all sites in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = SiteIdx> + use<> {
        (0..self.points.len() as u32).map(SiteIdx)
    }
}
