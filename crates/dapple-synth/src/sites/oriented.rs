//! Sites of a single level, as the columns that stars and interpolation read.

use crate::SiteGrid;
use glam::DVec3;

/// Sites on a surface, as columns of equal length, with a grid of the same sites.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oriented<'a> {
    /// Positions in space, in units of the mesh.
    pub(crate) positions: &'a [DVec3],
    /// Unit normals that point out of the surface.
    pub(crate) normals: &'a [DVec3],
    /// Spatial index of the sites.
    pub(crate) grid: &'a SiteGrid,
    /// Expected distance between neighbors, in units of the mesh; above zero.
    pub(crate) spacing: f64,
}
