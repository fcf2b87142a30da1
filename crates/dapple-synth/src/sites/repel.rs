//! Repels points on a surface from each other until they are evenly spaced.
//!
//! Reference: Greg Turk, "Generating Textures on Arbitrary Surfaces Using Reaction-Diffusion", SIGGRAPH 1991, doi
//! 10.1145/127719.122749, section 3.1. A point is pushed away from its neighbors within a radius. The neighbors are
//! mapped to the plane of its face, and keep their distances in space. The point then walks over the surface by the sum
//! of the pushes. Where the paper is silent, or this implementation departs from it:
//!
//! * the radius is `2 sqrt(A / n)`, as in Turk's "Re-Tiling Polygonal Surfaces", SIGGRAPH 1992, doi
//!   10.1145/133994.134008;
//! * the push falls off to zero at the radius, nearly linearly, as `1 - (d / r)^2`, and is divided by `(d / r)^2`, so
//!   that no pressure brings two points together. With a linear push points pile up at borders, and the mean
//!   nearest-neighbor distance is 4 % smaller;
//! * all points move at once, so that the number of threads does not matter, and the gain decreases from step to step;
//! * neighbors that face away by more than 120 degrees are on another sheet and do not push;
//! * at a border a point slides along it.
//!
//! Neighbors are listed with a margin, and no point moves by more than half of the margin before the lists are rebuilt.

use super::near::{CHUNK, Near, Places};
use crate::SiteIdx;
use core::sync::atomic::{AtomicUsize, Ordering};
use dapple_mesh::{FaceEdge, FaceIdx, Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::{DVec2, DVec3};

/// Gain of the first step: displacement of a point, as a fraction of the push on it. At 0.25, an even lattice
/// oscillated in tests.
const GAIN_FIRST: f64 = 0.15;
/// Gain of the last step.
const GAIN_LAST: f64 = 0.045;
/// Margin of the neighbor lists beyond the radius, as a fraction of the radius.
const MARGIN: f64 = 0.2;
/// Neighbor lists are rebuilt if more than 1 in `LIMITED_MOST` free points was limited by its margin.
const LIMITED_MOST: usize = 100;
/// Minimum dot product of the normals of neighbors: at most 120 degrees. Sites count as neighbors up to 90 degrees;
/// points a little beyond push too, since they could otherwise come together where the surface bends.
const FACING: f64 = -0.5;
/// Maximum distance of coincident points in the plane of the face, as a fraction of the radius.
const SAME_PLACE: f64 = 1e-6;
/// Barycentric weights of the three corners of a face.
const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// Inward slope of a walk along a border, so that rounding does not end the walk at the border.
const LEAN: f64 = 1.0 / (1 << 20) as f64;

/// Moves points apart in `iterations` repulsion steps. The first `n_fixed` points push others, but do not move.
///
/// After 40 iterations, random points are about as evenly spaced as repulsion can make them. Runs on all cores with the
/// feature `rayon`, with the same bits on any number of cores.
///
/// # Panics
///
/// If a point refers to a face that the surface does not have.
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::{Sites, evenness, repel, scatter};
///
/// let triangle = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let surface = Surface::new(triangle)?;
/// let mut points = scatter(&surface, 500, Seed(7));
/// repel(&surface, &mut points, 0, 40);
/// assert!(evenness(&surface, &Sites::new(&surface, points), 500).mean > 0.8);
/// # Ok::<(), dapple_synth::SynthError>(())
/// ```
pub fn repel(surface: &Surface, points: &mut [SurfacePoint], n_fixed: usize, iterations: usize) {
    let n_fixed = n_fixed.min(points.len());
    let radius = 2.0 * (surface.area() / points.len().max(1) as f64).sqrt();
    let mut crowd = Crowd::new(surface, points, n_fixed, radius);
    for iteration in 0..iterations {
        let cooling = iteration as f64 / iterations as f64;
        let gain = GAIN_FIRST + (GAIN_LAST - GAIN_FIRST) * cooling;
        let n_limited = crowd.step(points, gain);
        let is_last = iteration + 1 == iterations;
        if !is_last && n_limited > (points.len() - n_fixed) / LIMITED_MOST {
            crowd = Crowd::new(surface, points, n_fixed, radius);
        }
    }
}

/// Points that push each other, with neighbor lists that stay valid for several steps.
struct Crowd<'a> {
    surface: &'a Surface,
    n_fixed: usize,
    radius: f64,
    near: Near,
    positions: Vec<DVec3>,
    /// Positions of the free points when the lists were built.
    listed: Vec<DVec3>,
}

impl<'a> Crowd<'a> {
    fn new(surface: &'a Surface, points: &[SurfacePoint], n_fixed: usize, radius: f64) -> Self {
        let places = Places::new(surface, points);
        Self {
            surface,
            n_fixed,
            radius,
            near: Near::new(&places, n_fixed, radius * (1.0 + MARGIN), FACING),
            listed: places.positions[n_fixed..].to_vec(),
            positions: places.positions,
        }
    }

    /// Moves all free points once. Returns the number of points whose step was limited by the margin of the lists.
    fn step(&mut self, points: &mut [SurfacePoint], gain: f64) -> usize {
        let n_limited = AtomicUsize::new(0);
        let crowd = &*self;
        // Move the points, reading the positions before the step.
        parallel::for_each_chunk(&mut points[self.n_fixed..], CHUNK, |chunk, points| {
            n_limited.fetch_add(crowd.step_chunk(chunk, points, gain), Ordering::Relaxed);
        });
        let (surface, points) = (self.surface, &points[self.n_fixed..]);
        // Update the positions.
        parallel::for_each_chunk(
            &mut self.positions[self.n_fixed..],
            CHUNK,
            |chunk, positions| {
                for (position, &point) in positions.iter_mut().zip(&points[chunk * CHUNK..]) {
                    *position = surface.position(point);
                }
            },
        );
        n_limited.into_inner()
    }

    /// Moves the free points of `chunk` once. Returns the number of points whose step was limited.
    fn step_chunk(&self, chunk: usize, points: &mut [SurfacePoint], gain: f64) -> usize {
        let rows = self.near.chunk(chunk);
        let mut n_limited = 0;
        for (row, point) in points.iter_mut().enumerate() {
            let free = chunk * CHUNK + row;
            let site = self.n_fixed + free;
            let push = self.push(point.face, site, rows.row(row));
            let step = self.surface.flatten(point.face, push) * gain;
            // Distance that the point may still move before its list becomes invalid.
            let moved = self.positions[site].distance(self.listed[free]);
            let room = (0.5 * MARGIN * self.radius - moved).max(0.0);
            n_limited += usize::from(step.length_squared() > room * room);
            *point = go(self.surface, *point, step, room);
        }
        n_limited
    }

    /// Returns the sum of the pushes of `others` on the point `site` in `face`, as a vector in units of the mesh. The
    /// component along the normal of the face is meaningless and must be projected out.
    #[inline]
    fn push(&self, face: FaceIdx, site: usize, others: &[SiteIdx]) -> DVec3 {
        let normal = self.surface.face_normal(face);
        let position = self.positions[site];
        let radius_sq = self.radius * self.radius;
        let same_sq = SAME_PLACE * SAME_PLACE * radius_sq;
        let mut sum = DVec3::ZERO;
        for other in others {
            let from = position - self.positions[other.index()];
            let distance_sq = from.length_squared();
            let up = from.dot(normal);
            let along_sq = distance_sq - up * up;
            if along_sq > same_sq {
                // No branch here: about a quarter of the listed points are beyond the radius, in no order.
                let inside = (radius_sq - distance_sq).max(0.0);
                sum += from * (inside / (distance_sq * along_sq.sqrt()));
            } else if distance_sq < radius_sq {
                // Coincident points have no direction: push them apart along the first axis of the face, by index.
                let length = if site < other.index() { 8.0 } else { -8.0 };
                sum += self.surface.lift(face, DVec2::X) * length;
            }
        }
        sum * (0.125 * self.radius)
    }
}

/// Walks from `from` by `step`, but at most `room` far, and slides along a border. `step` is in the plane of the face.
#[inline]
fn go(surface: &Surface, from: SurfacePoint, step: DVec2, room: f64) -> SurfacePoint {
    let length = step.length();
    // Also stops at NaN.
    if !(length > 0.0 && length.is_finite()) {
        return from;
    }
    let walk = surface.walk(from, step / length, length.min(room));
    if walk.left > 0.0 {
        slide(surface, walk.point, walk.direction * walk.left)
    } else {
        walk.point
    }
}

/// Slides along a border from the point `from`, by the component along the border of `rest`, the remaining step.
fn slide(surface: &Surface, from: SurfacePoint, rest: DVec2) -> SurfacePoint {
    let corners = CORNERS.map(|weights| surface.point(from.face, weights).flat);
    let mut nearest = f64::INFINITY;
    let mut border = DVec2::ZERO;
    // Find the border edge of the face that is nearest to the point.
    for edge in 0..3 {
        let face_edge = FaceEdge {
            face: from.face,
            edge: edge as u8,
        };
        if surface.adjacency().across(face_edge).is_some() {
            continue;
        }
        let along = (corners[(edge + 1) % 3] - corners[edge]).normalize_or_zero();
        let side = along.perp_dot(from.flat - corners[edge]).abs();
        if side < nearest {
            (nearest, border) = (side, along);
        }
    }
    let length = rest.dot(border);
    let inward = border.perp() * (LEAN * length.abs());
    match (border * length + inward).try_normalize() {
        Some(direction) => surface.walk(from, direction, length.abs()).point,
        None => from,
    }
}

#[cfg(test)]
mod tests;
