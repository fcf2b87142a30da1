//! Points on a surface that push each other apart until they lie evenly.
//!
//! Reference: Greg Turk, "Generating Textures on Arbitrary Surfaces Using Reaction-Diffusion", SIGGRAPH 1991, doi
//! 10.1145/127719.122749, section 3.1: a point is pushed away from the neighbors within a radius, mapped into the
//! plane of its face with their distances in space kept, and walks over the surface as far as it is pushed. Where this
//! departs or the paper is silent:
//!
//! * the radius is `2 sqrt(A / n)`, as in Turk's "Re-Tiling Polygonal Surfaces", SIGGRAPH 1992, doi
//!   10.1145/133994.134008;
//! * the push falls off to zero at the radius, nearly linearly, as `1 - (d / r)^2`, and is divided by `(d / r)^2`, so
//!   that no pressure brings two points together: with a linear push points pile up at borders, and the mean distance
//!   of nearest neighbors is 4 % less;
//! * all points move at once, so that the number of threads does not matter, and by less from step to step;
//! * neighbors that face away by more than 120 degrees are on another sheet and do not push;
//! * at a border a point goes on along it.
//!
//! Neighbors are listed with a margin, and no point moves further than half of it before the lists are made anew.

use super::near::{CHUNK, Near, Places};
use crate::SiteIdx;
use core::sync::atomic::{AtomicUsize, Ordering};
use dapple_mesh::{FaceEdge, FaceIdx, Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::{DVec2, DVec3};

/// A point moves by this part of the push at first; with a quarter an even lattice was seen to swing.
const GAIN_FIRST: f64 = 0.15;
/// A point moves by this part of the push at last.
const GAIN_LAST: f64 = 0.045;
/// Neighbors are listed as far as this part of the radius beyond it.
const MARGIN: f64 = 0.2;
/// Lists are made anew when more than one point in this number of points wanted to leave its margin.
const LIMITED_MOST: usize = 100;
/// The least product of the normals of neighbors. Neighbors count as such from a right angle on; those a little past it
/// push too, or else they could come together where the surface bends.
const FACING: f64 = -0.5;
/// Points nearer than this part of the radius are taken to be in the same place.
const SAME_PLACE: f64 = 1e-6;
/// The weights of the corners of a face that give each corner.
const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// The inward part of the way of a point that goes along a border, so that rounding does not end its way.
const LEAN: f64 = 1.0 / (1 << 20) as f64;

/// Moves the points from number `n_fixed` on apart; those before it push, but stay.
///
/// With forty iterations random points become about as even as they ever will. Runs on all cores where the feature
/// `rayon` is on, with the same bits on any number of them.
///
/// # Panics
///
/// If a point names a face that the surface does not have.
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

/// Points that push each other, and what they need to know between two makings of the lists.
struct Crowd<'a> {
    surface: &'a Surface,
    n_fixed: usize,
    radius: f64,
    near: Near,
    positions: Vec<DVec3>,
    /// Where the free points were when the lists were made.
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

    /// Moves all free points once, and counts those that wanted to go further than their lists hold.
    fn step(&mut self, points: &mut [SurfacePoint], gain: f64) -> usize {
        let n_limited = AtomicUsize::new(0);
        let crowd = &*self;
        parallel::for_each_chunk(&mut points[self.n_fixed..], CHUNK, |chunk, points| {
            n_limited.fetch_add(crowd.step_chunk(chunk, points, gain), Ordering::Relaxed);
        });
        let (surface, points) = (self.surface, &points[self.n_fixed..]);
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

    fn step_chunk(&self, chunk: usize, points: &mut [SurfacePoint], gain: f64) -> usize {
        let rows = self.near.chunk(chunk);
        let mut n_limited = 0;
        for (row, point) in points.iter_mut().enumerate() {
            let free = chunk * CHUNK + row;
            let site = self.n_fixed + free;
            let push = self.push(point.face, site, rows.row(row));
            let step = self.surface.flatten(point.face, push) * gain;
            let moved = self.positions[site].distance(self.listed[free]);
            let room = (0.5 * MARGIN * self.radius - moved).max(0.0);
            n_limited += usize::from(step.length_squared() > room * room);
            *point = go(self.surface, *point, step, room);
        }
        n_limited
    }

    /// The sum of the pushes of other points on one in a face, in units of length. Its part along the normal of the face
    /// has no meaning.
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
                // Without a branch: about a quarter of the listed points are past the radius, in no order.
                let inside = (radius_sq - distance_sq).max(0.0);
                sum += from * (inside / (distance_sq * along_sq.sqrt()));
            } else if distance_sq < radius_sq {
                let length = if site < other.index() { 8.0 } else { -8.0 };
                sum += self.surface.lift(face, DVec2::X) * length;
            }
        }
        sum * (0.125 * self.radius)
    }
}

/// Goes a step over the surface, but not further than `room`, and at a border along it.
#[inline]
fn go(surface: &Surface, from: SurfacePoint, step: DVec2, room: f64) -> SurfacePoint {
    let length = step.length();
    // Not true for NaN either.
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

/// Goes on from a point on a border along it, as far as the rest of the step reaches that way.
fn slide(surface: &Surface, from: SurfacePoint, rest: DVec2) -> SurfacePoint {
    let corners = CORNERS.map(|weights| surface.point(from.face, weights).flat);
    let mut nearest = f64::INFINITY;
    let mut border = DVec2::ZERO;
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
