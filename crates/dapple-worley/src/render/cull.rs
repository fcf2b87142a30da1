//! Culling: selects the candidates of a box of pixels, which are the feature points that can be among the nearest of
//! some pixel.
//!
//! A point is a candidate if the smallest key that it has in the box is at most a bound. There are two bounds:
//!
//! * The `K`-th smallest of the keys that the points have at their farthest corner of the box. It is always valid, and
//!   is best for small boxes.
//! * An estimate of the `K`-th smallest key. It is best for large boxes, and is valid for pixels whose resulting keys
//!   are below it.
//!
//! The candidates of a small box are selected from those of a larger box around it.

use super::LANES;
use crate::Metric;
use crate::fixed::{MOST_AXES, STEP, STEP_BITS, STEPS};
use crate::levels::measured;
use crate::metric::Measure;
use core::ops::Range;
use fearless_simd::{Level, f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// The bounds of an area of pixels, in steps from the lower corner of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelBox {
    pub(super) n_axes: usize,
    pub(super) low: [i32; MOST_AXES],
    pub(super) high: [i32; MOST_AXES],
}

impl PixelBox {
    /// Returns the first and the last cell, along each axis of the table, within `ring` cells of the cells that the box
    /// touches. The range may exceed the table.
    pub(super) fn cells(&self, ring: i32) -> [[i32; MOST_AXES]; 2] {
        let mut cells = [[0; MOST_AXES]; 2];
        for axis in 0..self.n_axes {
            cells[0][axis] = (self.low[axis] >> STEP_BITS) - ring;
            cells[1][axis] = (self.high[axis] >> STEP_BITS) + ring;
        }
        cells
    }

    /// Returns the minimum distance from the box to the border of a range of cells, in steps.
    pub(super) fn border(&self, [first, last]: [[i32; MOST_AXES]; 2]) -> i32 {
        let mut border = i32::MAX;
        for axis in 0..self.n_axes {
            border = border
                .min(self.low[axis] - first[axis] * STEPS)
                .min((last[axis] + 1) * STEPS - self.high[axis]);
        }
        border
    }

    /// Returns the squared Euclidean distance from a point to the box, in cells; 0 inside.
    pub(super) fn distance_sq(&self, point: &[i32; MOST_AXES]) -> f32 {
        let mut sum = 0.0;
        for axis in 0..self.n_axes {
            let steps = (self.low[axis] - point[axis]).max(point[axis] - self.high[axis]);
            let part = steps.max(0) as f32 * STEP;
            sum += part * part;
        }
        sum
    }

    /// Returns the length of the box's longest side, in steps.
    pub(super) fn extent(&self) -> i32 {
        let mut extent = 0;
        for axis in 0..self.n_axes {
            extent = extent.max(self.high[axis] - self.low[axis]);
        }
        extent
    }
}

/// Feature points, one array of coordinates for each axis.
#[derive(Debug)]
pub(super) struct PointList {
    pub(super) len: usize,
    /// Coordinates along each axis, in steps from the lower corner of the table; padded by a register.
    pub(super) steps: [Vec<i32>; MOST_AXES],
    /// Indices of the points in the table, if needed.
    pub(super) numbers: Vec<u32>,
    /// Scratch memory for the smallest key that each point has in the box.
    near: Vec<f32>,
}

/// The feature points from which candidates are selected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Points<'a> {
    pub(super) steps: &'a [Vec<i32>; MOST_AXES],
    /// Indices of the points in the table; `None` if they are consecutive.
    pub(super) numbers: Option<&'a [u32]>,
    /// Ranges of indices to select from.
    pub(super) runs: &'a [Range<usize>],
    pub(super) wants_numbers: bool,
}

/// Criterion for keeping a point as a candidate.
#[derive(Clone, Copy, Debug)]
pub(super) enum Keep {
    /// Keeps points that can be among the given number of nearest ones. The factor is the rounding slack of the bound.
    Nearest(usize, f32),
    /// Keeps points whose smallest key in the box is at most this value.
    Within(f32),
}

/// The parameters for culling points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cull<'a> {
    pub(super) metric: Metric,
    pub(super) pixels: &'a PixelBox,
    pub(super) keep: Keep,
}

impl PointList {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            steps: core::array::from_fn(|_| Vec::new()),
            numbers: Vec::new(),
            near: Vec::new(),
        }
    }

    /// Returns the points in `run` as input for culling.
    pub(super) fn points<'a>(&'a self, run: &'a Range<usize>, wants_numbers: bool) -> Points<'a> {
        Points {
            steps: &self.steps,
            numbers: wants_numbers.then_some(&self.numbers),
            runs: core::slice::from_ref(run),
            wants_numbers,
        }
    }

    /// Replaces the list by the candidates among `points`, in the order of `points`.
    pub(super) fn cull(&mut self, level: Level, cull: Cull<'_>, points: Points<'_>) {
        measured!(level, cull.metric, (simd, measure) => {
            self.cull_by(simd, measure, cull, points);
        });
    }

    /// SIMD implementation of [`cull`](Self::cull).
    #[inline(always)]
    fn cull_by<S: Simd, M: Measure>(
        &mut self,
        simd: S,
        measure: M,
        cull: Cull<'_>,
        points: Points<'_>,
    ) {
        let n_axes = cull.pixels.n_axes;
        let room = self.make_room(points, n_axes);
        let infinite = f32x16::splat(simd, f32::INFINITY);
        let mut least = infinite;
        let mut at = 0;
        if self.near.len() < room {
            self.near.resize(room.next_power_of_two(), 0.0);
        }
        // Compute the smallest and largest key of each point in the box. Track the smallest of the largest keys in each
        // lane.
        for run in points.runs {
            for start in run.clone().step_by(LANES) {
                let (key, far) = cull.pixels.keys(simd, measure, points.steps, start);
                let is_there = lanes_before(simd, run.end - start);
                let near = &mut self.near[at..at + LANES];
                is_there.select(key, infinite).store_slice(near);
                least = least.min(is_there.select(far, infinite));
                at += LANES;
            }
        }
        // Find the bound on the smallest keys.
        let bound = match cull.keep {
            Keep::Within(bound) => bound,
            Keep::Nearest(depth, rounding_slack) => smallest_but(depth - 1, least) * rounding_slack,
        };
        // Padding has infinite keys, and must be culled even if the bound is infinite.
        let bound = bound.min(f32::MAX);
        // Append the points within the bound.
        let mut at = 0;
        for run in points.runs {
            for start in run.clone().step_by(LANES) {
                let key = f32x16::from_slice(simd, &self.near[at..at + LANES]);
                self.push(simd, points, n_axes, start, key.simd_le(bound));
                at += LANES;
            }
        }
    }

    /// Clears the list, and reserves memory for `points`. Returns the reserved length.
    fn make_room(&mut self, points: Points<'_>, n_axes: usize) -> usize {
        self.len = 0;
        let slots = points.runs.iter().map(|run| run.len().div_ceil(LANES));
        let room = (slots.sum::<usize>() + 1) * LANES;
        for steps in &mut self.steps[..n_axes] {
            if steps.len() < room {
                steps.resize(room.next_power_of_two(), 0);
            }
        }
        if points.wants_numbers && self.numbers.len() < room {
            self.numbers.resize(room.next_power_of_two(), 0);
        }
        room
    }

    /// Appends the points whose lanes are set in `matters`, starting at index `start` of `points`.
    #[inline(always)]
    fn push<S: Simd>(
        &mut self,
        simd: S,
        points: Points<'_>,
        n_axes: usize,
        start: usize,
        matters: mask32x16<S>,
    ) {
        let to = self.len..self.len + LANES;
        for axis in 0..n_axes {
            let steps = i32x16::from_slice(simd, &points.steps[axis][start..start + LANES]);
            steps
                .compress(matters)
                .store_slice(&mut self.steps[axis][to.clone()]);
        }
        if points.wants_numbers {
            let numbers = match points.numbers {
                Some(numbers) => u32x16::from_slice(simd, &numbers[start..start + LANES]),
                None => u32x16::from_slice(simd, &ASCENDING) + start as u32,
            };
            numbers.compress(matters).store_slice(&mut self.numbers[to]);
        }
        self.len += matters.to_bitmask().count_ones() as usize;
    }
}

/// Index of each lane.
const ASCENDING: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Returns a mask of the first `n` lanes, at most sixteen.
#[inline(always)]
pub(super) fn lanes_before<S: Simd>(simd: S, n: usize) -> mask32x16<S> {
    mask32x16::from_bitmask(simd, u64::MAX >> (64 - n.min(LANES)))
}

impl PixelBox {
    /// Returns the smallest and the largest key that each of sixteen points has in the box.
    #[inline(always)]
    fn keys<S: Simd, M: Measure>(
        &self,
        simd: S,
        measure: M,
        steps: &[Vec<i32>; MOST_AXES],
        start: usize,
    ) -> (f32x16<S>, f32x16<S>) {
        let zero = f32x16::splat(simd, 0.0);
        let [mut near_key, mut far_key] = [zero; 2];
        for axis in (0..MOST_AXES).rev() {
            if axis >= self.n_axes {
                continue;
            }
            let [low, high] = [self.low[axis], self.high[axis]];
            let steps = i32x16::from_slice(simd, &steps[axis][start..start + LANES]);
            // Offsets from the low and from the high end of the box, in cells.
            let ahead = (steps - low).to_float::<f32x16<S>>() * STEP;
            let past = ahead - (high - low) as f32 * STEP;
            // The smallest difference is zero inside of the box; the largest is to the farther end.
            // Terms are at least zero, so accumulating onto zero gives the terms themselves.
            let [near, far] = measure.terms([past.max(-ahead).max(zero), ahead.max(-past)]);
            near_key = measure.accumulate(near, near_key);
            far_key = measure.accumulate(far, far_key);
        }
        (near_key, far_key)
    }
}

/// Returns the smallest lane after the `n` smallest ones are removed. Equal lanes are removed together, which may give
/// a larger result.
///
/// Each lane holds the largest key of a different point in the box, so at least `n + 1` points have keys up to the
/// result.
#[inline(always)]
fn smallest_but<S: Simd>(n: usize, mut far: f32x16<S>) -> f32 {
    for _ in 0..n {
        let is_smallest = far.simd_eq(far.reduce_min());
        far = is_smallest.select(f32x16::splat(far.simd, f32::INFINITY), far);
    }
    far.reduce_min()
}
