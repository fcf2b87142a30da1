//! The neighbors of a site: its star in the Delaunay triangulation of the sites around it in its tangent plane.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1, which
//! projects nearby points to a tangent plane and triangulates them there. Here
//!
//! * a site keeps its distance in space and the direction of its projection, so that a steep slope does not bring far
//!   sites near, as a plain projection does;
//! * a site whose normal is more than a right angle from that of the center is on another sheet, and left out;
//! * the star is found by clipping the Voronoi cell of the center, nearest site first, and no triangle away from the
//!   center is made;
//! * two sites are neighbors only if there is an empty circle through them with a radius of at most [`STAR_RADIUS`]
//!   spacings. Without that limit all sites along a border would have to see all of the others, and be connected across
//!   bays of any width.
//!
//! Units: the tangent plane is measured in spacings.

use super::cell::Cell;
use super::grid::Block;
use super::oriented::Oriented;
use crate::SiteIdx;
use glam::{DVec2, DVec3};

/// The largest radius, in spacings of the level, of the empty circle that makes two sites neighbors.
///
/// Even sites leave no empty circles of more than 1 spacing except at borders, and random ones hardly any of more than
/// 2.
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

/// Finds stars among the same sites, one after the other. Those of sites in one cell of the grid share what is looked up.
#[derive(Clone, Debug, Default)]
pub(crate) struct StarFinder {
    cell: Cell,
    /// One for each of [`REACHES`].
    windows: [Window; REACHES.len()],
    /// The squared distances of some sites of a window, as the bits of an `f32`, above their indices.
    order: Vec<u64>,
}

/// All sites in a block of cells.
#[derive(Clone, Debug, Default)]
struct Window {
    block: Option<Block>,
    sites: Vec<SiteIdx>,
    /// Their positions along each axis.
    columns: [Vec<f64>; 3],
    /// Their squared distances from some position.
    distances_sq: Vec<f64>,
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
        for (window, reach) in REACHES.into_iter().enumerate() {
            let reach_sq = reach * reach;
            self.look(sites, &tangent, window, [seen_sq, reach_sq]);
            self.clip(sites, &tangent, window);
            if self.cell.diameter_sq() <= reach_sq {
                break;
            }
            seen_sq = reach_sq;
        }
        let limit_sq = 4.0 * STAR_RADIUS * STAR_RADIUS;
        self.cell.neighbors(limit_sq).for_each(|neighbor| {
            star.push(Spoke {
                to: SiteIdx(neighbor.tag),
                joined: neighbor.joined,
            });
        });
    }

    /// Lists the sites with squared distances above the first and up to the second of two limits, nearest first.
    #[inline]
    fn look(
        &mut self,
        sites: &Oriented<'_>,
        tangent: &Tangent,
        window: usize,
        [above, up_to]: [f64; 2],
    ) {
        let window = &mut self.windows[window];
        window.move_to(sites, tangent.position, up_to.sqrt() * sites.spacing);
        let distances_sq = window.distances_sq(tangent);
        // Every site is written, and those that do not count are written over: branches would be guessed wrong.
        self.order.resize(distances_sq.len(), 0);
        let mut n_listed = 0;
        for (index, &distance_sq) in distances_sq.iter().enumerate() {
            self.order[n_listed] = u64::from((distance_sq as f32).to_bits()) << 32 | index as u64;
            n_listed += usize::from(distance_sq > above && distance_sq <= up_to);
        }
        self.order.truncate(n_listed);
        self.order.sort_unstable();
    }

    /// Clips the cell by the sites listed that are on the same sheet, until they are too far away to matter.
    #[inline]
    fn clip(&mut self, sites: &Oriented<'_>, tangent: &Tangent, window: usize) {
        let window = &self.windows[window];
        for &key in &self.order {
            // The order is that of rounded distances.
            if f64::from(f32::from_bits((key >> 32) as u32)) > self.cell.diameter_sq() * 1.000_001 {
                return;
            }
            let index = key as u32 as usize;
            let site = window.sites[index];
            if sites.normals[site.index()].dot(tangent.normal) < 0.0 {
                continue;
            }
            let away = sites.positions[site.index()] - tangent.position;
            if let Some(at) = tangent.map(away, window.distances_sq[index]) {
                self.cell.clip(at, site.0);
            }
        }
    }
}

impl Window {
    /// Looks up the sites that are in reach of a position, unless they are at hand.
    #[inline]
    fn move_to(&mut self, sites: &Oriented<'_>, position: DVec3, radius: f64) {
        let block = sites.grid.block(position, radius);
        if self.block != Some(block) {
            self.block = Some(block);
            self.fill(sites, block);
        }
    }

    fn fill(&mut self, sites: &Oriented<'_>, block: Block) {
        self.sites.clear();
        sites.grid.visit_block(block, |site| self.sites.push(site));
        let [x, y, z] = &mut self.columns;
        for column in [&mut *x, y, z] {
            column.clear();
        }
        let positions = || self.sites.iter().map(|site| sites.positions[site.index()]);
        x.extend(positions().map(|position| position.x));
        y.extend(positions().map(|position| position.y));
        z.extend(positions().map(|position| position.z));
    }

    /// The squared distances of all sites from one, in spacings.
    #[inline]
    fn distances_sq(&mut self, from: &Tangent) -> &[f64] {
        let n = self.sites.len();
        self.distances_sq.resize(n, 0.0);
        let [x, y, z] = self.columns.each_ref().map(|column| &column[..n]);
        let center = from.position;
        for (index, distance_sq) in self.distances_sq[..n].iter_mut().enumerate() {
            let away = [
                x[index] - center.x,
                y[index] - center.y,
                z[index] - center.z,
            ];
            let length_sq = away[0] * away[0] + away[1] * away[1] + away[2] * away[2];
            *distance_sq = length_sq * from.scale_sq;
        }
        &self.distances_sq
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
