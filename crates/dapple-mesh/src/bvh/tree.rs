//! Traverses the bounding volume hierarchy for rays and nearest-point queries.
//!
//! Boxes are stored in `f32`, rounded outward, with a margin of 1e-9 times the size of the mesh. The margin is far
//! larger than the rounding of a distance between a ray and a triangle. Therefore the result equals that of a search
//! through all triangles, bit for bit. The module `build` describes how the boxes are chosen.

use super::Ray;
use super::build::{Bounds, Builder, STACK};
use core::ops::Range;
use glam::DVec3;

/// A box that contains either two child nodes or triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
    /// Index of the first of two adjacent children, or of the first triangle.
    pub(crate) first: u32,
    /// Number of triangles; zero for an inner node.
    pub(crate) count: u32,
}

/// The tree, and the order of the triangles in its leaves.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    middle: DVec3,
}

impl Tree {
    /// Builds the tree from the bounds of the triangles, in the order of their indices.
    pub(crate) fn new(bounds: Vec<Bounds>) -> Self {
        let middle = bounds.iter().fold(Bounds::NONE, Bounds::and).middle();
        let (nodes, order) = Builder::new(bounds).build();
        Self {
            nodes,
            order,
            middle,
        }
    }

    /// Returns the indices of the triangles, in the order of the leaves.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// Returns the center of the bounds of the whole mesh.
    pub(crate) fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Visits the leaves whose boxes a ray intersects between two distances, roughly from near to far.
    ///
    /// `leaf` receives a range of indices into [`order`](Self::order), and may return a smaller distance at which the
    /// search ends.
    pub(crate) fn visit(
        &self,
        ray: &Ray,
        start: f64,
        mut end: f64,
        mut leaf: impl FnMut(Range<u32>) -> Option<f64>,
    ) {
        let slabs = Slabs::new(ray, start);
        // A box that is missed has an infinite distance, which must be greater than the end.
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
                    // Enter the nearer child, and push the farther one on the stack.
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
    /// Visits the leaves whose boxes are nearer to a position than a squared distance, roughly from near to far.
    ///
    /// `leaf` receives a range of indices into [`order`](Self::order), and returns the new limit of the squared
    /// distance.
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
                    // Enter the nearer child, and push the farther one on the stack.
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
    /// Returns the squared distance from a position to the box; zero inside. The margin of the box is far larger than
    /// the rounding.
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

/// A ray prepared for intersection tests with many boxes (slab method).
struct Slabs {
    origin: [f64; 3],
    inverse: [f64; 3],
    start: f64,
}

impl Slabs {
    fn new(ray: &Ray, start: f64) -> Self {
        // A ray parallel to a slab gets a finite inverse, so that no product is NaN. The triangles are inside the
        // slab by the margin, so a ray on its boundary may count as outside.
        let inverse = |part: f64| if part == 0.0 { f64::MAX } else { 1.0 / part };
        Self {
            origin: ray.origin.to_array(),
            inverse: ray.direction.to_array().map(inverse),
            start,
        }
    }

    /// Returns the distance at which the ray enters a box, or infinity if it does not intersect the box before `end`.
    #[inline]
    fn enter(&self, node: &Node, end: f64) -> f64 {
        let (mut near, mut far) = (self.start, end);
        for axis in 0..3 {
            let (origin, inverse) = (self.origin[axis], self.inverse[axis]);
            let low = (f64::from(node.low[axis]) - origin) * inverse;
            let high = (f64::from(node.high[axis]) - origin) * inverse;
            let (first, last) = if high < low { (high, low) } else { (low, high) };
            // Comparisons are faster than `max` and `min`, which handle NaN.
            near = if first > near { first } else { near };
            far = if last < far { last } else { far };
        }
        if near <= far { near } else { f64::INFINITY }
    }
}
