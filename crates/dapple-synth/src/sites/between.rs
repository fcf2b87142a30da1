//! Finds the Delaunay edges of an evenly spaced point set and their midpoints. Adding the midpoints makes the set four
//! times as dense and almost as even.
//!
//! A triangulation has about three edges per point, so points and midpoints together are four times as many, and a
//! hexagonal lattice becomes a finer hexagonal lattice. Delaunay edges are found in the plane of a point's face: two
//! points have an edge if some circle through both has no other point inside. This refinement is our own choice; Turk
//! starts with random points.

use super::evenness::hexagonal_spacing;
use super::near::{CHUNK, Near, Places};
use crate::SiteIdx;
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec2;

/// Maximum length of an edge, in multiples of the point spacing.
const REACH: f64 = 2.2;
/// Maximum distance from the center of an empty circle to the midpoint of its edge, in multiples of the point spacing.
/// The limit excludes long edges along borders.
const CENTER_REACH: f64 = 1.2;
/// Two edges count as crossing if their midpoints are closer than this, in multiples of the point spacing. Only one of
/// them is kept.
const CLASH: f64 = 0.3;

/// An edge between two points, as a walk over the surface: start, direction in the plane of the start's face, and
/// length in units of the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    from: SurfacePoint,
    direction: DVec2,
    pub(crate) length: f64,
    pub(crate) middle: SurfacePoint,
}

impl Edge {
    /// Returns the two points that divide the edge into thirds.
    pub(crate) fn thirds(&self, surface: &Surface) -> [SurfacePoint; 2] {
        [1.0, 2.0].map(|third| {
            surface
                .walk(self.from, self.direction, self.length * third / 3.0)
                .point
        })
    }
}

/// Returns the Delaunay edges between nearby points, in the order of the points.
pub(crate) fn edges(surface: &Surface, points: &[SurfacePoint]) -> Vec<Edge> {
    let spacing = hexagonal_spacing(surface.area(), points.len());
    let places = Places::new(surface, points);
    let near = Near::new(&places, 0, REACH * spacing, 0.0);
    // Find the edges of each point with its later neighbors.
    let chunks = parallel::map(points.len().div_ceil(CHUNK), |chunk| {
        let mut edges = Vec::with_capacity(3 * CHUNK);
        let mut star = Star::default();
        for row in 0..CHUNK.min(points.len() - chunk * CHUNK) {
            let site = chunk * CHUNK + row;
            star.lay_out(surface, points, &places, (site, near.chunk(chunk).row(row)));
            star.add_edges(surface, points[site], spacing, &mut edges);
        }
        edges
    });
    let mut edges = chunks.into_iter().flatten().collect();
    // Drop edges that cross earlier ones: stars of nearby points can disagree.
    remove_clashes(surface, &mut edges, CLASH * spacing);
    edges
}

/// A site with its neighbors, mapped to the plane of the site's face.
#[derive(Debug, Default)]
struct Star {
    site: u32,
    arms: Vec<Arm>,
}

/// A neighbor of the site of a star: its index, its distance in space, and its position in the plane relative to the
/// site.
#[derive(Clone, Copy, Debug)]
struct Arm {
    other: u32,
    length: f64,
    flat: DVec2,
}

impl Star {
    /// Maps the neighbors to the plane of the site's face, sorted by distance. Distances from the site are preserved.
    fn lay_out(
        &mut self,
        surface: &Surface,
        points: &[SurfacePoint],
        places: &Places,
        (site, near): (usize, &[SiteIdx]),
    ) {
        self.site = site as u32;
        self.arms.clear();
        for &other in near {
            let way = places.positions[other.index()] - places.positions[site];
            let length = way.length();
            let flat = surface.flatten(points[site].face, way).normalize_or_zero() * length;
            self.arms.push(Arm {
                other: other.0,
                length,
                flat,
            });
        }
        self.arms
            .sort_unstable_by(|a, b| a.length.total_cmp(&b.length).then(a.other.cmp(&b.other)));
    }

    /// Appends the site's edges to neighbors with a higher index, so that each edge is found once.
    fn add_edges(
        &self,
        surface: &Surface,
        from: SurfacePoint,
        spacing: f64,
        edges: &mut Vec<Edge>,
    ) {
        for arm in &self.arms {
            if arm.other > self.site && self.has_empty_circle(arm, CENTER_REACH * spacing) {
                let (length, direction) = (arm.length, arm.flat / arm.length);
                // Find the midpoint on the surface; the straight edge leaves a curved one.
                let middle = surface.walk(from, direction, 0.5 * length).point;
                edges.push(Edge {
                    from,
                    direction,
                    length,
                    middle,
                });
            }
        }
    }

    /// Returns whether some circle through the site and the neighbor of `arm` has no other neighbor inside.
    ///
    /// The center of such a circle is `flat / 2 + t perp(flat)`. Every other neighbor bounds t from one side, and the
    /// circle exists if the interval of t is not empty.
    fn has_empty_circle(&self, arm: &Arm, reach: f64) -> bool {
        if arm.flat == DVec2::ZERO {
            return false;
        }
        let across = arm.flat.perp();
        let (mut low, mut high) = (-reach / arm.length, reach / arm.length);
        for other in &self.arms {
            if other.other == arm.other {
                continue;
            }
            // For p outside of the circle, |p - center|² >= |center|², or p · (p - flat) >= 2 t p · perp(flat).
            let side = 2.0 * other.flat.dot(across);
            let outside = other.flat.dot(other.flat - arm.flat);
            if side > 0.0 {
                high = high.min(outside / side);
            } else if side < 0.0 {
                low = low.max(outside / side);
            } else if outside < 0.0 {
                return false;
            }
            if low >= high {
                return false;
            }
        }
        true
    }
}

/// Removes every edge whose midpoint is nearer than `clash` to the midpoint of an earlier retained edge on the same
/// sheet.
fn remove_clashes(surface: &Surface, edges: &mut Vec<Edge>, clash: f64) {
    let middles: Vec<SurfacePoint> = edges.iter().map(|edge| edge.middle).collect();
    let places = Places::new(surface, &middles);
    let near = Near::new(&places, 0, clash, 0.0);
    let mut kept = vec![true; edges.len()];
    for edge in 0..edges.len() {
        let others = near.chunk(edge / CHUNK).row(edge % CHUNK);
        // Edges that were dropped do not drop others.
        kept[edge] = !others
            .iter()
            .any(|other| other.index() < edge && kept[other.index()]);
    }
    let mut kept = kept.into_iter();
    edges.retain(|_| kept.next() == Some(true));
}

#[cfg(test)]
mod tests;
