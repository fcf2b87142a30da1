//! Computes the star of a site: its neighbors in a Delaunay triangulation of nearby sites in its tangent plane.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1, which
//! projects nearby points to a tangent plane and triangulates them there. This implementation differs as follows:
//!
//! * a site keeps the direction of its projection and its distance in space. A plain projection would bring far sites
//!   near on a steep slope;
//! * a site whose normal is more than 90 degrees from the normal of the center is on another sheet and is ignored;
//! * the star is found by clipping the Voronoi cell of the center, nearest site first. Triangles that do not touch the
//!   center are never computed;
//! * two sites are neighbors only if there is an empty circle through them with a radius of at most [`STAR_RADIUS`]
//!   times the site spacing. Without this limit, every site along a border would have to search all other sites, and
//!   would be connected across bays of any width.
//!
//! Units: lengths in the tangent plane are multiples of the site spacing.

use super::cell::Cell;
use super::grid::Block;
use super::oriented::Oriented;
use crate::SiteIdx;
use glam::{DVec2, DVec3};

/// Maximum radius of the empty circle through two neighbors, in multiples of the level's site spacing.
///
/// Evenly spaced sites have no empty circles of more than 1 spacing except at borders, and random sites rarely have any
/// of more than 2.
pub const STAR_RADIUS: f64 = 2.0;

/// Search radii for neighbors, in multiples of the site spacing. They are the diameters of the empty circles of evenly
/// spaced sites, of unevenly spaced sites, and of the largest circles that count.
const REACHES: [f64; 3] = [1.8, 2.8, 2.0 * STAR_RADIUS];

/// A neighbor in a star.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spoke {
    /// Index of the neighbor.
    pub(crate) to: SiteIdx,
    /// Whether the center, this neighbor, and the next neighbor counterclockwise form a triangle.
    pub(crate) joined: bool,
}

/// Finds the stars of sites, one site at a time. Consecutive sites in the same grid cell share the grid lookups.
#[derive(Clone, Debug, Default)]
pub(crate) struct StarFinder {
    cell: Cell,
    /// Cached grid lookups, one per radius in [`REACHES`].
    windows: [Window; REACHES.len()],
    /// Sort keys of the sites of a window within the current limits. The upper half is the squared distance as the bits
    /// of an `f32`, and the lower half is the index in the window.
    order: Vec<u64>,
}

/// Sites in a block of grid cells.
#[derive(Clone, Debug, Default)]
struct Window {
    block: Option<Block>,
    sites: Vec<SiteIdx>,
    /// Positions of the sites along each axis.
    columns: [Vec<f64>; 3],
    /// Squared distances of the sites from the current center, in multiples of the squared site spacing.
    distances_sq: Vec<f64>,
}

/// Tangent plane of a site, in multiples of the site spacing.
struct Tangent {
    position: DVec3,
    normal: DVec3,
    /// Orthogonal axes of the plane; their length is the inverse of the site spacing.
    axes: [DVec3; 2],
    scale_sq: f64,
}

impl StarFinder {
    /// Appends the star of `center` to `star`, counterclockwise as seen from outside.
    ///
    /// Sites at the same position are never neighbors.
    pub(crate) fn find(&mut self, sites: &Oriented<'_>, center: SiteIdx, star: &mut Vec<Spoke>) {
        let tangent = Tangent::new(sites, center);
        self.cell.clear();
        let mut seen_sq = 0.0;
        // Search rings of growing radius, until no site farther away can change the cell.
        for (window, reach) in REACHES.into_iter().enumerate() {
            let reach_sq = reach * reach;
            self.look(sites, &tangent, window, [seen_sq, reach_sq]);
            self.clip(sites, &tangent, window);
            // All further sites are outside of the circles through the corners, so no bisector reaches the cell.
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

    /// Lists the sites whose squared distance is greater than `above` and at most `up_to`, nearest first, in
    /// `self.order`.
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
        // Every site is written, and sites outside the limits are then overwritten, because branches would be
        // mispredicted.
        self.order.resize(distances_sq.len(), 0);
        let mut n_listed = 0;
        for (index, &distance_sq) in distances_sq.iter().enumerate() {
            self.order[n_listed] = u64::from((distance_sq as f32).to_bits()) << 32 | index as u64;
            n_listed += usize::from(distance_sq > above && distance_sq <= up_to);
        }
        self.order.truncate(n_listed);
        self.order.sort_unstable();
    }

    /// Clips the cell by the listed sites on the same sheet, until the remaining sites are too far away to change it.
    #[inline]
    fn clip(&mut self, sites: &Oriented<'_>, tangent: &Tangent, window: usize) {
        let window = &self.windows[window];
        for &key in &self.order {
            // The keys are rounded distances, so allow for the rounding.
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
    /// Looks up the sites within `radius` of `position`, unless the window already holds them.
    #[inline]
    fn move_to(&mut self, sites: &Oriented<'_>, position: DVec3, radius: f64) {
        let block = sites.grid.block(position, radius);
        if self.block != Some(block) {
            self.block = Some(block);
            self.fill(sites, block);
        }
    }

    /// Loads the sites of `block` and their positions into the window.
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

    /// Returns the squared distances of all sites of the window from the center, in multiples of the squared site
    /// spacing.
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
        // Axes with the length of an inverse spacing map positions to multiples of the spacing.
        let scale = 1.0 / sites.spacing;
        Self {
            position: sites.positions[center.index()],
            normal,
            axes: [x * scale, y * scale],
            scale_sq: scale * scale,
        }
    }

    /// Maps a site at the vector `away` from the center to the tangent plane. `None` if the site is straight above or
    /// below the center.
    #[inline]
    fn map(&self, away: DVec3, distance_sq: f64) -> Option<DVec2> {
        let projected = DVec2::new(away.dot(self.axes[0]), away.dot(self.axes[1]));
        let projected_sq = projected.length_squared();
        // Restore the distance in space, which the projection shortens on slopes.
        (projected_sq > 0.0).then(|| projected * (distance_sq / projected_sq).sqrt())
    }
}

#[cfg(test)]
mod tests;
