//! Builds the bounding volume hierarchy.
//!
//! The tree is built top-down. Every box is split where the surface area heuristic, evaluated at the borders of 16
//! bins along each axis, predicts the lowest cost. Reference: Ingo Wald, "On fast Construction of SAH-based Bounding
//! Volume Hierarchies", IEEE Symposium on Interactive Ray Tracing 2007, doi 10.1109/RT.2007.4342588.

use super::tree::Node;
use core::ops::Range;
use glam::DVec3;

/// Number of bins along an axis; Wald found no gain from more.
const BINS: usize = 16;
/// Maximum number of triangles in a leaf. Smaller ranges are still split if the split costs less than the leaf.
const LEAF_MAX: usize = 8;
/// Cost of visiting a box, relative to the cost of testing a triangle.
const STEP_COST: f64 = 1.0;
/// At this depth and below, boxes are split into equal halves, which bounds the depth of the tree for every mesh.
const DEPTH_SAH_MAX: u32 = 48;
/// Stack size of a traversal: one more than [`DEPTH_SAH_MAX`] plus the 31 halvings of 2^31 triangles, the longest
/// path.
pub(crate) const STACK: usize = 80;

/// An axis-aligned bounding box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    pub(crate) const NONE: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    pub(crate) fn around(points: &[DVec3; 3]) -> Self {
        let [a, b, c] = *points;
        Self {
            low: a.min(b).min(c),
            high: a.max(b).max(c),
        }
    }

    pub(crate) fn and(self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    pub(crate) fn middle(&self) -> DVec3 {
        self.low * 0.5 + self.high * 0.5
    }

    /// Returns half the surface area, in squared units of the mesh; zero for an empty box.
    fn area(&self) -> f64 {
        let side = (self.high - self.low).max(DVec3::ZERO);
        side.x * side.y + side.y * side.z + side.z * side.x
    }
}

/// Hierarchy under construction.
pub(crate) struct Builder {
    bounds: Vec<Bounds>,
    middles: Vec<DVec3>,
    order: Vec<u32>,
    nodes: Vec<Node>,
    margin: f64,
}

/// A split of a range of triangles into two.
struct Split {
    axis: usize,
    /// Bins below this one belong to the first half.
    bin: usize,
    cost: f64,
}

/// Maps coordinates along an axis to bins.
#[derive(Clone, Copy)]
struct Binning {
    low: f64,
    bins_per_unit: f64,
}

impl Binning {
    fn bin(self, place: f64) -> usize {
        // The cast maps NaN and negative values to zero.
        (((place - self.low) * self.bins_per_unit) as usize).min(BINS - 1)
    }
}

impl Builder {
    pub(crate) fn new(bounds: Vec<Bounds>) -> Self {
        let whole = bounds.iter().fold(Bounds::NONE, Bounds::and);
        Self {
            middles: bounds.iter().map(Bounds::middle).collect(),
            order: (0..bounds.len() as u32).collect(),
            nodes: Vec::new(),
            margin: 1e-9 * (whole.high - whole.low).max_element(),
            bounds,
        }
    }

    /// Returns the nodes, with the root first, and the indices of the triangles in the order of the leaves.
    pub(crate) fn build(mut self) -> (Vec<Node>, Vec<u32>) {
        let all = 0..self.order.len();
        if all.is_empty() {
            return (self.nodes, self.order);
        }
        let root = self.leaf(all.clone());
        self.nodes.push(root);
        let mut open = vec![(0_usize, all, 0_u32)];
        while let Some((at, range, depth)) = open.pop() {
            let Some(middle) = self.split(range.clone(), depth) else {
                continue;
            };
            let children = self.nodes.len();
            let halves = [range.start..middle, middle..range.end];
            for (index, half) in halves.into_iter().enumerate() {
                let node = self.leaf(half.clone());
                self.nodes.push(node);
                open.push((children + index, half, depth + 1));
            }
            self.nodes[at].first = children as u32;
            self.nodes[at].count = 0;
        }
        (self.nodes, self.order)
    }

    /// Returns a leaf node for a range of triangles.
    fn leaf(&self, range: Range<usize>) -> Node {
        let bounds = self.bounds_of(range.clone());
        // Rounding to `f32` moves a bound by at most one representable number; the step outward compensates for it.
        let low = (bounds.low - self.margin).to_array();
        let high = (bounds.high + self.margin).to_array();
        Node {
            low: low.map(|part| (part as f32).next_down()),
            high: high.map(|part| (part as f32).next_up()),
            first: range.start as u32,
            count: range.len() as u32,
        }
    }

    fn bounds_of(&self, range: Range<usize>) -> Bounds {
        let boxes = self.order[range].iter();
        boxes.fold(Bounds::NONE, |sum, &index| {
            sum.and(&self.bounds[index as usize])
        })
    }

    /// Partitions a range of triangles into two halves. Returns the start of the second half; `None` if the range
    /// should become a leaf.
    fn split(&mut self, range: Range<usize>, depth: u32) -> Option<usize> {
        let count = range.len();
        if count <= 1 {
            return None;
        }
        let half = range.start + count / 2;
        // Bound the centers of the triangles.
        let middles = range
            .clone()
            .map(|at| self.middles[self.order[at] as usize]);
        let spread = middles.fold(Bounds::NONE, |sum, point| {
            let (low, high) = (point, point);
            sum.and(&Bounds { low, high })
        });
        // Split at the median where the tree is already deep.
        if depth >= DEPTH_SAH_MAX {
            return (count > LEAF_MAX).then_some(half);
        }
        let binnings = [0, 1, 2].map(|axis| {
            let low = spread.low[axis];
            let bins_per_unit = BINS as f64 / (spread.high[axis] - low);
            Binning { low, bins_per_unit }
        });
        // Find the cheapest split, or keep a leaf.
        let whole = self.bounds_of(range.clone()).area();
        let best = self.best_split(range.clone(), &binnings);
        let Some(best) = best.filter(|_| whole > 0.0) else {
            return (count > LEAF_MAX).then_some(half);
        };
        if count <= LEAF_MAX && STEP_COST + best.cost / whole >= count as f64 {
            return None;
        }
        // Partition the triangles at the border between two bins.
        let binning = binnings[best.axis];
        let mut first = Vec::with_capacity(count);
        let mut second = Vec::new();
        for &index in &self.order[range.clone()] {
            let place = self.middles[index as usize][best.axis];
            if binning.bin(place) < best.bin {
                first.push(index);
            } else {
                second.push(index);
            }
        }
        let middle = range.start + first.len();
        first.append(&mut second);
        self.order[range].copy_from_slice(&first);
        Some(middle)
    }

    /// Returns the cheapest split between two bins that has triangles on both sides; `None` if there is none.
    fn best_split(&self, range: Range<usize>, binnings: &[Binning; 3]) -> Option<Split> {
        // Sort the triangles into bins.
        let mut bins = [[(Bounds::NONE, 0_usize); BINS]; 3];
        for &index in &self.order[range] {
            let middle = self.middles[index as usize];
            for axis in 0..3 {
                let (bounds, count) = &mut bins[axis][binnings[axis].bin(middle[axis])];
                *bounds = bounds.and(&self.bounds[index as usize]);
                *count += 1;
            }
        }
        let mut best: Option<Split> = None;
        for (axis, bins) in bins.iter().enumerate() {
            let grow = |(bounds, count): &mut (Bounds, usize), bin: &(Bounds, usize)| {
                *bounds = bounds.and(&bin.0);
                *count += bin.1;
            };
            // Accumulate the bins from the right.
            let mut after = [(Bounds::NONE, 0); BINS];
            let mut sum = (Bounds::NONE, 0);
            for bin in (1..BINS).rev() {
                grow(&mut sum, &bins[bin]);
                after[bin] = sum;
            }
            // Accumulate the bins from the left, and evaluate every border.
            let mut before = (Bounds::NONE, 0);
            for bin in 1..BINS {
                grow(&mut before, &bins[bin - 1]);
                let after = &after[bin];
                if before.1 == 0 || after.1 == 0 {
                    continue;
                }
                let cost = before.0.area() * before.1 as f64 + after.0.area() * after.1 as f64;
                if best.as_ref().is_none_or(|best| cost < best.cost) {
                    best = Some(Split { axis, bin, cost });
                }
            }
        }
        best
    }
}
