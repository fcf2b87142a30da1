//! A hierarchy of boxes around triangles, for rays and for nearest points.
//!
//! Boxes are kept in `f32`, rounded outward, with a margin of 1e-9 of the size of the mesh: far more than the rounding of
//! a ray's distance to a triangle, so that the nearest triangle is, to the last bit, the one that a search through all
//! triangles finds. `build` says how the boxes are chosen.

use super::Ray;
use super::build::{Bounds, Builder, STACK};
use core::ops::Range;
use glam::DVec3;

/// A box, and either its two children or its triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
    /// The first of two neighboring children, or the first triangle.
    pub(crate) first: u32,
    /// The number of triangles; zero for a box with children.
    pub(crate) count: u32,
}

/// The tree, and the order in which its leaves hold the triangles.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    middle: DVec3,
}

impl Tree {
    /// The tree of the boxes of triangles, in the order of their indices.
    pub(crate) fn new(bounds: Vec<Bounds>) -> Self {
        let middle = bounds.iter().fold(Bounds::NONE, Bounds::and).middle();
        let (nodes, order) = Builder::new(bounds).build();
        Self {
            nodes,
            order,
            middle,
        }
    }

    /// The indices of the triangles in the order of the leaves.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The middle of the box around everything.
    pub(crate) fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Visits the leaves that a ray meets between two distances, mostly the nearer before the farther.
    ///
    /// `leaf` gets the places of triangles in [`order`](Self::order), and may bring the end of the search nearer.
    pub(crate) fn visit(
        &self,
        ray: &Ray,
        start: f64,
        mut end: f64,
        mut leaf: impl FnMut(Range<u32>) -> Option<f64>,
    ) {
        let slabs = Slabs::new(ray, start);
        // A box that is not met is infinitely far, which must be past the end.
        end = end.min(f64::MAX);
        let Some(root) = self.nodes.first() else {
            return;
        };
        let mut stack = [(0_u32, 0.0_f64); STACK];
        let mut depth = 0;
        let (mut at, mut near) = (0, slabs.enter(root, end));
        loop {
            if near <= end {
                let node = &self.nodes[at as usize];
                if node.count > 0 {
                    if let Some(nearer) = leaf(node.first..node.first + node.count) {
                        end = end.min(nearer);
                    }
                } else {
                    let [a, b] = [node.first, node.first + 1];
                    let [near_a, near_b] =
                        [a, b].map(|child| slabs.enter(&self.nodes[child as usize], end));
                    let [first, second] = if near_b < near_a {
                        [(b, near_b), (a, near_a)]
                    } else {
                        [(a, near_a), (b, near_b)]
                    };
                    if second.1 <= end {
                        stack[depth] = second;
                        depth += 1;
                    }
                    (at, near) = first;
                    continue;
                }
            }
            if depth == 0 {
                return;
            }
            depth -= 1;
            (at, near) = stack[depth];
        }
    }
}

impl Tree {
    /// Visits the leaves whose boxes are nearer to a position than a squared distance, mostly the nearer before the farther.
    ///
    /// `leaf` gets the places of triangles in [`order`](Self::order), and gives the squared distance that still counts.
    pub(crate) fn visit_near(
        &self,
        position: DVec3,
        mut limit_sq: f64,
        mut leaf: impl FnMut(Range<u32>) -> f64,
    ) {
        let Some(root) = self.nodes.first() else {
            return;
        };
        let mut stack = [(0_u32, 0.0_f64); STACK];
        let mut depth = 0;
        let (mut at, mut near_sq) = (0, root.distance_sq(position));
        loop {
            if near_sq <= limit_sq {
                let node = &self.nodes[at as usize];
                if node.count > 0 {
                    limit_sq = leaf(node.first..node.first + node.count);
                } else {
                    let [a, b] = [node.first, node.first + 1]
                        .map(|child| (child, self.nodes[child as usize].distance_sq(position)));
                    let [first, second] = if b.1 < a.1 { [b, a] } else { [a, b] };
                    if second.1 <= limit_sq {
                        stack[depth] = second;
                        depth += 1;
                    }
                    (at, near_sq) = first;
                    continue;
                }
            }
            if depth == 0 {
                return;
            }
            depth -= 1;
            (at, near_sq) = stack[depth];
        }
    }
}

impl Node {
    /// The squared distance of a position from the box; zero inside. The margin of the box is far more than its rounding.
    #[inline]
    fn distance_sq(&self, position: DVec3) -> f64 {
        let mut sum = 0.0;
        for axis in 0..3 {
            let below = f64::from(self.low[axis]) - position[axis];
            let above = position[axis] - f64::from(self.high[axis]);
            let gap = below.max(above).max(0.0);
            sum += gap * gap;
        }
        sum
    }
}

/// A ray for tests against many boxes.
struct Slabs {
    origin: [f64; 3],
    inverse: [f64; 3],
    start: f64,
}

impl Slabs {
    fn new(ray: &Ray, start: f64) -> Self {
        // A ray along a slab gets a finite inverse, so that no product is NaN. The triangles are inside of the slab by the
        // margin, so a ray within a side of it may count as outside.
        let inverse = |part: f64| if part == 0.0 { f64::MAX } else { 1.0 / part };
        Self {
            origin: ray.origin.to_array(),
            inverse: ray.direction.to_array().map(inverse),
            start,
        }
    }

    /// How far along the ray a box begins, or infinity if it is not met before `end`.
    #[inline]
    fn enter(&self, node: &Node, end: f64) -> f64 {
        let (mut near, mut far) = (self.start, end);
        for axis in 0..3 {
            let (origin, inverse) = (self.origin[axis], self.inverse[axis]);
            let low = (f64::from(node.low[axis]) - origin) * inverse;
            let high = (f64::from(node.high[axis]) - origin) * inverse;
            let (first, last) = if high < low { (high, low) } else { (low, high) };
            // Comparisons and not `max` and `min`, which take care of NaN at a price.
            near = if first > near { first } else { near };
            far = if last < far { last } else { far };
        }
        if near <= far { near } else { f64::INFINITY }
    }
}
