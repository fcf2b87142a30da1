//! New points between those of an even set, which make it four times as dense and almost as even.
//!
//! A triangulation has about three edges for each point, so with the middles of its edges there are four times as many
//! points, and a hexagonal lattice becomes a hexagonal lattice. The edges are those of Delaunay's triangulation in the
//! plane of a point's face: two points have one if some circle through both has no other point inside. This is our own
//! choice: Turk starts with random points.

use super::evenness::hexagonal_spacing;
use super::near::{CHUNK, Near, Places};
use crate::SiteIdx;
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec2;

/// The largest distance of two points with an edge, in spacings.
const REACH: f64 = 2.2;
/// The largest distance of the center of an empty circle from the middle of its edge, in spacings, so that no long edges
/// lie along borders.
const CENTER_REACH: f64 = 1.2;
/// The distance of middles, in spacings, below which their edges cross: only one of them is kept.
const CLASH: f64 = 0.3;

/// An edge between two points, and the way from one to the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    from: SurfacePoint,
    direction: DVec2,
    pub(crate) length: f64,
    pub(crate) middle: SurfacePoint,
}

impl Edge {
    /// Two points that split the edge in three.
    pub(crate) fn thirds(&self, surface: &Surface) -> [SurfacePoint; 2] {
        [1.0, 2.0].map(|third| {
            surface
                .walk(self.from, self.direction, self.length * third / 3.0)
                .point
        })
    }
}

/// The edges between points that are near each other, in the order of the points.
pub(crate) fn edges(surface: &Surface, points: &[SurfacePoint]) -> Vec<Edge> {
    let spacing = hexagonal_spacing(surface.area(), points.len());
    let places = Places::new(surface, points);
    let near = Near::new(&places, 0, REACH * spacing, 0.0);
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
    remove_clashes(surface, &mut edges, CLASH * spacing);
    edges
}

/// The neighbors of a site, laid out in the plane of its face.
#[derive(Debug, Default)]
struct Star {
    site: u32,
    arms: Vec<Arm>,
}

#[derive(Clone, Copy, Debug)]
struct Arm {
    other: u32,
    length: f64,
    flat: DVec2,
}

impl Star {
    /// Maps the neighbors into the plane around the site, the nearest first, with their distances in space kept.
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

    /// Adds the edges to those neighbors that have a higher number, so that each edge is found once.
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

    /// Whether some circle through the site and the end of an arm has no other neighbor inside.
    ///
    /// Its center is at `flat / 2 + t perp(flat)`; every neighbor bounds t from one side.
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

/// Removes the later ones of edges whose middles are nearer to each other than `clash` on the same sheet.
fn remove_clashes(surface: &Surface, edges: &mut Vec<Edge>, clash: f64) {
    let middles: Vec<SurfacePoint> = edges.iter().map(|edge| edge.middle).collect();
    let places = Places::new(surface, &middles);
    let near = Near::new(&places, 0, clash, 0.0);
    let mut kept = vec![true; edges.len()];
    for edge in 0..edges.len() {
        let others = near.chunk(edge / CHUNK).row(edge % CHUNK);
        kept[edge] = !others
            .iter()
            .any(|other| other.index() < edge && kept[other.index()]);
    }
    let mut kept = kept.into_iter();
    edges.retain(|_| kept.next() == Some(true));
}

#[cfg(test)]
mod tests;
