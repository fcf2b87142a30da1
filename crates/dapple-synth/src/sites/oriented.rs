//! The sites of one level, as what stars and interpolation need of them.

use crate::SiteGrid;
use glam::DVec3;

/// Sites on a surface: columns of one length, and a grid of that many sites.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oriented<'a> {
    /// Where the sites are.
    pub(crate) positions: &'a [DVec3],
    /// Unit vectors out of the surface.
    pub(crate) normals: &'a [DVec3],
    /// The sites near a position.
    pub(crate) grid: &'a SiteGrid,
    /// The distance of neighbors that is expected; above zero.
    pub(crate) spacing: f64,
}
