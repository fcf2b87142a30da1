//! Triangulates polygons and strips.
//!
//! Readers first convert each polygon to a fan of triangles around its first corner, since a file may refer to
//! vertices before it defines them. [`Polygons`] records which faces belong to one polygon. Once all positions are
//! known, it replaces the fans of concave polygons by ear clipping. Fans of convex polygons stay.
//!
//! Ear clipping follows Gary Meisters, *Polygons Have Ears*, American Mathematical Monthly 82(6), 1975, in the
//! projection of the polygon along the axis nearest to its normal (Martin Newell's normal). Every corner is kept,
//! including corners on a straight side: their vertices may belong to a neighbor, and dropping them would open a
//! crack. Existing triangulation crates drop such corners.

use core::cmp::Ordering;
use core::ops::Range;
use glam::{DVec2, DVec3};
use std::collections::VecDeque;

/// Maximum number of tests of corner pairs over all polygons of a file; concave polygons beyond it stay fans. A
/// polygon seldom takes more than a hundred tests per corner, but a malicious polygon takes a number quadratic in its
/// corners.
const TESTS_MAX: usize = 1 << 28;

/// Polygons with more than three corners. Each is a range of faces that form a fan.
#[derive(Default)]
pub(crate) struct Polygons {
    fans: Vec<Range<usize>>,
}

/// Triangulations of concave polygons: the range of faces, and triangles of indices into the polygon's corners.
#[derive(Default)]
pub(crate) struct Ears {
    polygons: Vec<(Range<usize>, Vec<[u32; 3]>)>,
    /// Number of self-intersecting polygons.
    n_crossing: usize,
    /// Whether the number of tests exceeded the limit.
    is_cut_short: bool,
}

/// Sine of the angle below which a right turn counts as straight. Files contain rounded corners on straight edges.
const STRAIGHT: f64 = 1.0 / (1 << 20) as f64;

/// Corners of a polygon in its plane, counterclockwise, as a linked ring from which ears are cut.
struct Ring {
    at: Vec<DVec2>,
    next: Vec<u32>,
    before: Vec<u32>,
    /// Corners that may be inside an ear, sorted by x. These are the corners where the initial polygon does not turn
    /// left.
    reflex: Vec<u32>,
    /// Skip list over `reflex`. Each entry has its own index if the corner is live, that is, neither cut nor convex by
    /// now; otherwise it has the index of a later entry, and all entries in between are dead.
    live: Vec<u32>,
    /// Index of each corner in `reflex`; `u32::MAX` if it is not there.
    rank: Vec<u32>,
    is_cut: Vec<bool>,
    tests_left: usize,
}

/// How strictly a corner must qualify as an ear.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ear {
    /// The ear has a positive area, and no corner inside it or on its edges.
    Proper,
    /// The ear does not turn right by more than rounding, and has no corner inside.
    Weak,
}

/// Returns the triangle fan around the first corner of a polygon.
pub(crate) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let pairs = corners.iter().skip(1).zip(corners.iter().skip(2));
    pairs.map(|(&b, &c)| [corners[0], b, c])
}

/// Returns the triangles of a strip. Each corner forms a triangle with the two before it; every second triangle is
/// reversed.
pub(crate) fn strip<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let triangles = corners.windows(3).enumerate();
    triangles.map(|(i, w)| {
        if i % 2 == 0 {
            [w[0], w[1], w[2]]
        } else {
            [w[0], w[2], w[1]]
        }
    })
}

/// Returns the corners of the polygon that a fan was made from.
fn corners_of<T: Copy>(fan: &[[T; 3]]) -> Vec<T> {
    let first = fan.iter().take(1).flat_map(|face| face[..2].to_vec());
    first.chain(fan.iter().map(|face| face[2])).collect()
}

impl Polygons {
    /// Appends the fan of a polygon to `faces`.
    pub(crate) fn push<T: Copy>(&mut self, corners: &[T], faces: &mut Vec<[T; 3]>) {
        let first = faces.len();
        faces.extend(fan(corners));
        if corners.len() > 3 {
            self.fans.push(first..faces.len());
        }
    }

    /// Triangulates the concave polygons among `faces`. `vertex` maps a corner to its index in `positions`.
    pub(crate) fn ears<T: Copy>(
        self,
        faces: &[[T; 3]],
        positions: &[DVec3],
        vertex: impl Fn(T) -> u32,
    ) -> Ears {
        let (mut ears, mut tests_left) = (Ears::default(), TESTS_MAX);
        for range in self.fans {
            let corners = corners_of(&faces[range.clone()]).into_iter();
            let corners = corners.map(|corner| positions.get(vertex(corner) as usize).copied());
            // A missing vertex is reported elsewhere.
            let Some(corners) = corners.collect::<Option<Vec<_>>>() else {
                continue;
            };
            let plane = in_plane(&corners);
            if turns_left(&plane) {
                continue;
            }
            if tests_left == 0 {
                ears.is_cut_short = true;
                continue;
            }
            let mut ring = Ring::new(plane, tests_left);
            let triangles = ring.triangles();
            tests_left = ring.tests_left;
            match triangles {
                Some(triangles) => ears.polygons.push((range, triangles)),
                None if tests_left == 0 => ears.is_cut_short = true,
                None => ears.n_crossing += 1,
            }
        }
        ears
    }
}

impl Ears {
    /// Replaces the fans of concave polygons in a list of values per face corner.
    pub(crate) fn apply<T: Copy>(&self, faces: &mut [[T; 3]]) {
        for (range, triangles) in &self.polygons {
            let faces = &mut faces[range.clone()];
            let corners = corners_of(faces);
            for (face, triangle) in faces.iter_mut().zip(triangles) {
                *face = triangle.map(|corner| corners[corner as usize]);
            }
        }
    }

    /// Returns the texts for [`Model::left_out`](dapple_mesh::Model::left_out) about polygons that stay fans.
    pub(crate) fn left_out(&self) -> impl Iterator<Item = String> {
        let crossing = match self.n_crossing {
            0 => None,
            1 => Some("the shape of a polygon that crosses itself; it is a fan".to_owned()),
            n => Some(format!(
                "the shapes of {n} polygons that cross themselves; they are fans"
            )),
        };
        let rest = "the shapes of concave polygons with very many corners; they are fans";
        let rest = self.is_cut_short.then(|| rest.to_owned());
        crossing.into_iter().chain(rest)
    }
}

/// Projects the corners along the coordinate axis nearest to the normal. The first corner becomes the origin, and the
/// orientation is chosen so that the area is not negative.
fn in_plane(corners: &[DVec3]) -> Vec<DVec2> {
    let first = corners[0];
    let from_first = |at: usize| corners[at % corners.len()] - first;
    let pairs = (0..corners.len()).map(|i| from_first(i).cross(from_first(i + 1)));
    let normal = pairs.sum::<DVec3>();
    let size = normal.abs();
    let project = |at: &DVec3| {
        let at = at - first;
        let [plane, height] = if size.z >= size.x && size.z >= size.y {
            [DVec2::new(at.x, at.y), DVec2::new(normal.z, 0.0)]
        } else if size.y >= size.x {
            [DVec2::new(at.z, at.x), DVec2::new(normal.y, 0.0)]
        } else {
            [DVec2::new(at.y, at.z), DVec2::new(normal.x, 0.0)]
        };
        if height.x < 0.0 {
            DVec2::new(plane.y, plane.x)
        } else {
            plane
        }
    };
    corners.iter().map(project).collect()
}

/// Returns twice the signed area of a triangle, positive if counterclockwise.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns whether the path from `a` through `b` to `c` turns right by more than rounding errors.
fn turns_right(a: DVec2, b: DVec2, c: DVec2) -> bool {
    let sides = (b - a).length_squared() * (c - b).length_squared();
    area(a, b, c) < -STRAIGHT * sides.sqrt()
}

/// Returns whether a polygon is convex: no corner turns right, and no triangle of its fan is reversed.
fn turns_left(at: &[DVec2]) -> bool {
    let n = at.len();
    let is_left = |i: usize| !turns_right(at[i], at[(i + 1) % n], at[(i + 2) % n]);
    let is_upright = |i: usize| !turns_right(at[0], at[i], at[i + 1]);
    (0..n).all(is_left) && (1..n - 1).all(is_upright)
}

impl Ring {
    fn new(at: Vec<DVec2>, tests_left: usize) -> Self {
        let n = at.len();
        // Corner indices are below 2^32, since a face stores them.
        let numbers = |shift: usize| (0..n).map(|i| ((i + shift) % n) as u32).collect();
        let mut ring = Self {
            next: numbers(1),
            before: numbers(n - 1),
            reflex: Vec::new(),
            live: Vec::new(),
            rank: vec![u32::MAX; n],
            is_cut: vec![false; n],
            tests_left,
            at,
        };
        let is_reflex = |&i: &u32| ring.area(i) <= 0.0;
        let mut reflex: Vec<_> = (0..n as u32).filter(is_reflex).collect();
        reflex.sort_by(|&a, &b| by_x(ring.at(a), ring.at(b)));
        for (rank, &corner) in (0..).zip(&reflex) {
            ring.rank[corner as usize] = rank;
        }
        // Sentinel for the end
        ring.live = (0..=reflex.len() as u32).collect();
        ring.reflex = reflex;
        ring
    }

    fn at(&self, corner: u32) -> DVec2 {
        self.at[corner as usize]
    }

    /// Returns a corner with its two neighbors.
    fn triangle(&self, corner: u32) -> [u32; 3] {
        let at = corner as usize;
        [self.before[at], corner, self.next[at]]
    }

    /// Returns twice the signed area of the triangle of a corner and its neighbors.
    fn area(&self, corner: u32) -> f64 {
        let [a, b, c] = self.triangle(corner).map(|corner| self.at(corner));
        area(a, b, c)
    }

    /// Triangulates the polygon; `None` if it intersects itself, or the test limit is reached.
    fn triangles(&mut self) -> Option<Vec<[u32; 3]>> {
        if self.crosses()? {
            return None;
        }
        let n = self.at.len();
        let mut triangles = Vec::with_capacity(n - 2);
        let mut wanted = Ear::Proper;
        let mut queue: VecDeque<u32> = (0..n as u32).collect();
        let mut n_before = 0;
        while triangles.len() < n - 3 {
            let Some(corner) = queue.pop_front() else {
                // Rejected corners may be ears after others were cut. Only a polygon that touches itself has no proper
                // ear.
                if triangles.len() == n_before {
                    match wanted {
                        Ear::Proper => wanted = Ear::Weak,
                        Ear::Weak => return None,
                    }
                }
                n_before = triangles.len();
                queue.extend((0..n as u32).filter(|&corner| !self.is_cut[corner as usize]));
                continue;
            };
            if self.is_cut[corner as usize] || !self.is_ear(corner, wanted)? {
                continue;
            }
            let [before, _, next] = self.triangle(corner);
            triangles.push([before, corner, next]);
            self.cut(corner);
            // Skip the neighbor: cutting adjacent ears would make a fan of slivers.
            if queue.front() == Some(&next) {
                queue.pop_front();
            }
            queue.extend([before, next]);
            wanted = Ear::Proper;
        }
        let last = (0..n as u32).find(|&corner| !self.is_cut[corner as usize])?;
        let last = self.triangle(last);
        let [a, b, c] = last.map(|corner| self.at(corner));
        triangles.push(last);
        (!turns_right(a, b, c)).then_some(triangles)
    }

    /// Cuts off the ear at a corner: removes the corner from the ring.
    fn cut(&mut self, corner: u32) {
        let [before, _, next] = self.triangle(corner);
        self.is_cut[corner as usize] = true;
        self.next[before as usize] = next;
        self.before[next as usize] = before;
        self.pass_over(corner);
        for beside in [before, next] {
            if self.area(beside) > 0.0 {
                self.pass_over(beside);
            }
        }
    }

    /// Counts a test; `None` if the test limit is reached.
    fn count_test(&mut self) -> Option<()> {
        self.tests_left = self.tests_left.checked_sub(1)?;
        Some(())
    }

    /// Returns whether a corner is an ear; `None` if the test limit is reached.
    fn is_ear(&mut self, corner: u32, wanted: Ear) -> Option<bool> {
        self.count_test()?;
        let ear = self.triangle(corner);
        let [a, b, c] = ear.map(|corner| self.at(corner));
        let is_upright = match wanted {
            Ear::Proper => area(a, b, c) > 0.0,
            Ear::Weak => !turns_right(a, b, c),
        };
        if !is_upright {
            return Some(false);
        }
        let [least, most] = [a.min(b).min(c), a.max(b).max(c)];
        // Test the live reflex corners whose x is in the range of the ear.
        let first = self
            .reflex
            .partition_point(|&other| self.at(other).x < least.x);
        let mut rank = self.live(first);
        while let Some(&other) = self.reflex.get(rank) {
            rank = self.live(rank + 1);
            let at = self.at(other);
            if at.x > most.x {
                break;
            }
            self.count_test()?;
            if ear.contains(&other) || at.y < least.y || at.y > most.y {
                continue;
            }
            let sides = [area(a, b, at), area(b, c, at), area(c, a, at)];
            let is_inside = match wanted {
                Ear::Weak => sides.iter().all(|&side| side > 0.0),
                Ear::Proper if at == a || at == b || at == c => self.enters(other, [a, b, c]),
                Ear::Proper => sides.iter().all(|&side| side >= 0.0),
            };
            if is_inside {
                return Some(false);
            }
        }
        Some(true)
    }

    /// Returns the first live entry of `reflex` at index `from` or later.
    fn live(&mut self, from: usize) -> usize {
        let mut at = from;
        while self.live[at] as usize != at {
            // Halve the path for the next search.
            self.live[at] = self.live[self.live[at] as usize];
            at = self.live[at] as usize;
        }
        at
    }

    /// Marks a corner as dead in the list of reflex corners.
    fn pass_over(&mut self, corner: u32) {
        if let Some(live) = self.live.get_mut(self.rank[corner as usize] as usize) {
            *live = self.rank[corner as usize] + 1;
        }
    }

    /// Returns whether the polygon's boundary at `other` enters the triangle. `other` coincides with a corner of the
    /// triangle.
    fn enters(&self, other: u32, [a, b, c]: [DVec2; 3]) -> bool {
        let at = self.at(other);
        let [from, to] = match at {
            _ if at == a => [b, c],
            _ if at == b => [c, a],
            _ => [a, b],
        };
        let [before, _, next] = self.triangle(other).map(|corner| self.at(corner));
        let is_between = |way: DVec2| area(at, from, way) > 0.0 && area(at, way, to) > 0.0;
        is_between(before) || is_between(next)
    }

    /// Returns whether two edges cross in their interiors; `None` if the test limit is reached.
    fn crosses(&mut self) -> Option<bool> {
        let ends = |side: u32| {
            let ends = [side, self.next[side as usize]];
            ends.map(|corner| self.at(corner))
        };
        let mut sides: Vec<_> = (0..self.at.len() as u32).map(ends).collect();
        let least = |[a, b]: &[DVec2; 2]| a.min(*b);
        sides.sort_by(|a, b| by_x(least(a), least(b)));
        // Test pairs of sides whose x ranges overlap.
        for (i, &[a, b]) in sides.iter().enumerate() {
            let (lower, upper) = (a.min(b), a.max(b));
            for &[c, d] in &sides[i + 1..] {
                if c.min(d).x > upper.x {
                    break;
                }
                self.count_test()?;
                if c.max(d).y < lower.y || c.min(d).y > upper.y {
                    continue;
                }
                let is_apart = |p: f64, q: f64| (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
                let is_crossing = is_apart(area(a, b, c), area(a, b, d))
                    && is_apart(area(c, d, a), area(c, d, b));
                if is_crossing {
                    return Some(true);
                }
            }
        }
        Some(false)
    }
}

/// Compares two points by x. All coordinates are finite.
fn by_x(a: DVec2, b: DVec2) -> Ordering {
    a.x.total_cmp(&b.x)
}

#[cfg(test)]
mod tests;
