//! The neighbors of a site: its star in the Delaunay triangulation of the sites around it in its tangent plane.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1, which
//! projects nearby points to a tangent plane and triangulates them there. Here
//!
//! * a site keeps its distance in space and the direction of its projection, so that a steep slope does not bring far sites
//!   near, as a plain projection does;
//! * a site whose normal is more than a right angle from that of the center is on another sheet, and left out;
//! * the star is found by clipping the Voronoi cell of the center, nearest site first, and no triangle away from the center is made;
//! * two sites are neighbors only if there is an empty circle through them with a radius of at most [`STAR_RADIUS`]
//!   spacings. Without that limit all sites along a border would have to see all of the others, and be connected across
//!   bays of any width.
//!
//! Units: the tangent plane is measured in spacings.

use crate::SiteIdx;
use crate::cell::Cell;
use crate::oriented::Oriented;
use glam::{DVec2, DVec3};

/// The largest radius, in spacings of the level, of the empty circle that makes two sites neighbors.
///
/// Even sites leave no empty circles of more than 1 spacing except at borders, and random ones hardly any of more than 2.
pub const STAR_RADIUS: f64 = 2.0;

/// How far to look for neighbors, in spacings: as far as the diameter of the empty circles of even sites, then of
/// uneven ones, then of the largest that count.
const REACHES: [f64; 3] = [1.8, 2.8, 2.0 * STAR_RADIUS];

/// A neighbor in a star.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spoke {
    /// The neighbor.
    pub(crate) to: SiteIdx,
    /// Whether the center, it, and the next neighbor counterclockwise are a triangle.
    pub(crate) joined: bool,
}

/// Finds stars, one after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct StarFinder {
    cell: Cell,
    near: Vec<Near>,
    /// The squared distances of the sites in `near`, as the bits of an `f32`, above their indices.
    order: Vec<u64>,
}

/// A site in the tangent plane of another one.
#[derive(Clone, Copy, Debug)]
struct Near {
    at: DVec2,
    site: SiteIdx,
}

/// The tangent plane of a site.
struct Tangent {
    position: DVec3,
    normal: DVec3,
    /// Orthogonal, and as long as one over the spacing.
    axes: [DVec3; 2],
    scale_sq: f64,
}

impl StarFinder {
    /// Appends the star of a site, counterclockwise as seen from outside.
    ///
    /// A site that lies where another one does is never its neighbor.
    pub(crate) fn find(&mut self, sites: &Oriented<'_>, center: SiteIdx, star: &mut Vec<Spoke>) {
        let tangent = Tangent::new(sites, center);
        self.cell.clear();
        let mut seen_sq = 0.0;
        for reach in REACHES {
            let reach_sq = reach * reach;
            self.look(sites, &tangent, [seen_sq, reach_sq]);
            self.clip();
            if self.cell.diameter_sq() <= reach_sq {
                break;
            }
            seen_sq = reach_sq;
        }
        let limit_sq = 4.0 * STAR_RADIUS * STAR_RADIUS;
        star.extend(self.cell.neighbors(limit_sq).map(|neighbor| Spoke {
            to: SiteIdx(neighbor.tag),
            joined: neighbor.joined,
        }));
    }

    /// Lists the sites with squared distances above the first and up to the second of two limits, nearest first.
    #[inline]
    fn look(&mut self, sites: &Oriented<'_>, tangent: &Tangent, [above, up_to]: [f64; 2]) {
        self.near.clear();
        self.order.clear();
        let radius = up_to.sqrt() * sites.spacing;
        sites.grid.visit(tangent.position, radius, |site| {
            let away = sites.positions[site.index()] - tangent.position;
            let distance_sq = away.length_squared() * tangent.scale_sq;
            if !(distance_sq > above && distance_sq <= up_to)
                || sites.normals[site.index()].dot(tangent.normal) < 0.0
            {
                return;
            }
            if let Some(at) = tangent.map(away, distance_sq) {
                let key = u64::from((at.length_squared() as f32).to_bits());
                self.order.push(key << 32 | self.near.len() as u64);
                self.near.push(Near { at, site });
            }
        });
        self.order.sort_unstable();
    }

    /// Clips the cell by the sites listed, until they are too far away to matter.
    #[inline]
    fn clip(&mut self) {
        for &key in &self.order {
            let near = self.near[key as u32 as usize];
            // The order is that of rounded distances.
            if near.at.length_squared() > self.cell.diameter_sq() * 1.000_001 {
                return;
            }
            self.cell.clip(near.at, near.site.0);
        }
    }
}

impl Tangent {
    fn new(sites: &Oriented<'_>, center: SiteIdx) -> Self {
        let normal = sites.normals[center.index()];
        let (x, y) = normal.any_orthonormal_pair();
        let scale = 1.0 / sites.spacing;
        Self {
            position: sites.positions[center.index()],
            normal,
            axes: [x * scale, y * scale],
            scale_sq: scale * scale,
        }
    }

    /// Where a site at a vector from the center is in the plane, if it is not straight above or below.
    #[inline]
    fn map(&self, away: DVec3, distance_sq: f64) -> Option<DVec2> {
        let projected = DVec2::new(away.dot(self.axes[0]), away.dot(self.axes[1]));
        let projected_sq = projected.length_squared();
        (projected_sq > 0.0).then(|| projected * (distance_sq / projected_sq).sqrt())
    }
}

#[cfg(test)]
mod tests;
