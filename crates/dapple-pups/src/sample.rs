//! One position at a time, through a grid of bins.
//!
//! Every bin lists the control points, and images of them, whose supports reach into it, in the order in which weights
//! are summed; so the time for a position does not depend on the number of points. The grid covers the domain. On an
//! axis that does not wrap, the bins of the border reach out as far as there are positions.

use crate::net::{AxisBlock, BLOCK, Instance, Net};
use crate::profile::{Cubic, Profile};
use crate::shift::shift_weight;
use crate::weight::AxialWeight;
use fearless_simd::{Level, dispatch, prelude::*};
use glam::DVec2;

/// How many bins there are for each instance; more bins, fewer candidates in each.
const BINS_PER_INSTANCE: f64 = 2.0;

/// The most bins along one axis.
const BINS_LIMIT: f64 = 16_384.0;

/// Which instances can have a weight where.
#[derive(Debug)]
pub(crate) struct Bins {
    size: [usize; 2],
    /// Bins per unit of length.
    per_unit: DVec2,
    /// The instances of bin `b` are `instances[offsets[b]..offsets[b + 1]]`.
    offsets: Vec<u32>,
    instances: Vec<u32>,
}

impl Bins {
    pub(crate) fn new(net: &Net) -> Self {
        let size = net.domain.size;
        let side = (size.x * size.y / (net.instances.len() as f64 * BINS_PER_INSTANCE)).sqrt();
        let count = |axis: usize| (size[axis] / side).ceil().clamp(1.0, BINS_LIMIT) as usize;
        let bins = [count(0), count(1)];
        let per_unit = DVec2::new(bins[0] as f64, bins[1] as f64) / size;
        let mut grid = Self {
            size: bins,
            per_unit,
            offsets: vec![0; bins[0] * bins[1] + 1],
            instances: Vec::new(),
        };
        grid.fill(net);
        grid
    }

    /// Counts, then places: a compressed row for each bin, with the instances in their order.
    fn fill(&mut self, net: &Net) {
        let mut entries = Vec::new();
        for (index, instance) in (0..).zip(&net.instances) {
            let [columns, rows] = [0, 1].map(|axis| self.reach(net, axis, instance));
            for row in rows {
                for column in columns.clone() {
                    if self.touches(net, instance, column, row) {
                        // There are at most 2^28 bins.
                        let bin = (row * self.size[0] + column) as u32;
                        entries.push((bin, index));
                        self.offsets[bin as usize + 1] += 1;
                    }
                }
            }
        }
        for bin in 1..self.offsets.len() {
            self.offsets[bin] += self.offsets[bin - 1];
        }
        let mut next = self.offsets.clone();
        self.instances = vec![0; entries.len()];
        for (bin, index) in entries {
            self.instances[next[bin as usize] as usize] = index;
            next[bin as usize] += 1;
        }
    }

    /// The bins that the box of an instance reaches along an axis.
    fn reach(
        &self,
        net: &Net,
        axis: usize,
        instance: &Instance,
    ) -> core::ops::RangeInclusive<usize> {
        let [first, last] = [instance.min[axis], instance.max[axis]]
            .map(|coordinate| self.bin(net, axis, coordinate));
        first..=last
    }

    /// The bin of a coordinate along an axis; what lies outside belongs to the border.
    #[inline]
    fn bin(&self, net: &Net, axis: usize, coordinate: f64) -> usize {
        let bin = (coordinate - net.domain.origin[axis]) * self.per_unit[axis];
        // A negative number becomes zero.
        (bin as usize).min(self.size[axis] - 1)
    }

    /// Whether the support of an instance reaches into a bin, or may do so.
    fn touches(&self, net: &Net, instance: &Instance, column: usize, row: usize) -> bool {
        let ends = |axis: usize, bin: usize| {
            let (origin, size) = (net.domain.origin[axis], net.domain.size[axis]);
            let side = 1.0 / self.per_unit[axis];
            let open = |at_border: bool, inner: f64, outer: f64| {
                if at_border && !net.domain.wrap[axis] {
                    outer
                } else {
                    inner
                }
            };
            // Rounding may put a position into the neighboring bin.
            let slack = side * 1e-6 + (origin.abs() + size) * 1e-15;
            let start = open(
                bin == 0,
                origin + side * bin as f64 - slack,
                net.local(axis, f64::MIN),
            );
            let end = open(
                bin + 1 == self.size[axis],
                origin + side * (bin + 1) as f64 + slack,
                net.local(axis, f64::MAX),
            );
            [start, end].map(|coordinate| (coordinate - instance.center[axis]) as f32)
        };
        let [x, y] = [ends(0, column), ends(1, row)];
        let reached = |block: &AxisBlock| {
            (0..BLOCK).all(|slot| {
                let (ax, ay) = (block.x[slot], block.y[slot]);
                let [a, b, c, d] = [y[0], y[1]]
                    .map(|y| x.map(|x| (1.0 - ay * y) - ax * x))
                    .as_flattened()
                    .try_into()
                    .unwrap_or([0.0; 4]);
                a.max(b).max(c.max(d)) > 0.0
            })
        };
        net.blocks(instance).iter().all(reached)
    }

    /// The instances that can have a weight at a position (which [`Net::local`] has brought into range).
    #[inline]
    pub(crate) fn candidates(&self, net: &Net, position: DVec2) -> &[u32] {
        let bin = self.bin(net, 1, position.y) * self.size[0] + self.bin(net, 0, position.x);
        let [start, end] = [bin, bin + 1].map(|bin| self.offsets[bin] as usize);
        &self.instances[start..end]
    }
}

impl Net {
    /// Calls `take(instance, weight)` for every instance with a weight at a position that is in range.
    #[inline]
    pub(crate) fn for_each_weight(&self, position: DVec2, mut take: impl FnMut(&Instance, f32)) {
        for &index in self.bins().candidates(self, position) {
            let instance = &self.instances[index as usize];
            let weight = self.weight(instance, position);
            if weight > 0.0 {
                take(instance, weight);
            }
        }
    }

    /// The weight of an instance at a position.
    #[inline]
    fn weight(&self, instance: &Instance, position: DVec2) -> f32 {
        let x = (position.x - instance.center.x) as f32;
        let y = (position.y - instance.center.y) as f32;
        let blocks = self.blocks(instance);
        let weight = match self.options.weight {
            AxialWeight::Cubic => product(Cubic, blocks, x, y),
            other => product(other, blocks, x, y),
        };
        match self.shifts.get(instance.point as usize) {
            Some(&shift) if weight > 0.0 => {
                dispatch!(Level::baseline(), simd => shifted(simd, weight, shift, x, y))
            }
            _ => weight,
        }
    }

    /// The instance nearest to a position among those that can have a weight there; ties go to the first.
    pub(crate) fn nearest(&self, position: DVec2) -> &Instance {
        let distance_sq = |index: u32| {
            self.instances[index as usize]
                .center
                .distance_squared(position)
        };
        let nearer = |best: u32, index: u32| {
            if distance_sq(index) < distance_sq(best) {
                index
            } else {
                best
            }
        };
        let nearest = self
            .bins()
            .candidates(self, position)
            .iter()
            .copied()
            .reduce(nearer);
        // The support of the nearest instance covers the position, so there is one; the first is only for form.
        &self.instances[nearest.unwrap_or(0) as usize]
    }
}

/// The product of the axial weights: zero as soon as one of them is.
#[inline(always)]
fn product<P: Profile>(profile: P, blocks: &[AxisBlock], x: f32, y: f32) -> f32 {
    let mut product = 1.0;
    for block in blocks {
        let mut u = [0.0; BLOCK];
        for (slot, u) in u.iter_mut().enumerate() {
            *u = ((1.0 - block.y[slot] * y) - block.x[slot] * x).clamp(0.0, 1.0);
        }
        if u.contains(&0.0) {
            return 0.0;
        }
        let (q, t) = u
            .into_iter()
            .fold((1.0, 1.0), |(q, t), u| profile.step(q, t, u));
        product *= profile.finish(q, t, BLOCK);
    }
    product
}

/// Equation 4 for one weight.
#[inline(always)]
fn shifted<S: Simd>(simd: S, weight: f32, shift: [f32; 2], x: f32, y: f32) -> f32 {
    let [weight, x, y] = [weight, x, y].map(|number| S::f32s::splat(simd, number));
    shift_weight(simd, weight, shift, x, y).as_slice()[0]
}
