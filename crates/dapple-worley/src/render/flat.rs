//! Projects candidates to the image, and removes dominated candidates.
//!
//! The axes orthogonal to the image contribute the same amount to the key of a point at all pixels. Three numbers
//! therefore describe a point: its column, its row, and its accumulated key terms along the other axes.
//!
//! If a key is a sum of terms, one per axis, the difference between the keys of two points is also a sum over the
//! axes. Along each axis the difference is monotonic, since terms are convex. Its minimum in a rectangle is therefore
//! the sum, over the axes, of the smaller of its values at the two ends. If this sum is above zero, the first point
//! *dominates* the second: it is nearer in the whole rectangle. A point that `K` others dominate is not among the `K`
//! nearest of any pixel.
//!
//! This removes about half of the points that remain after culling by bounds for each point alone.

use super::LANES;
use super::cull::{PixelBox, PointList, lanes_before};
use crate::Metric;
use crate::fixed::STEP;
use crate::levels::{is_wide, measured, wide};
use crate::metric::{Exact, Measure};
use fearless_simd::{Level, f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// The bounds of an area of pixels, in cells, along three axes: those in which columns, rows and slices differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cuboid {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
    /// Whether there are several slices.
    pub(super) is_deep: bool,
}

/// The criterion for removing dominated points, and scratch memory for the test.
#[derive(Debug)]
pub(super) struct Dominance {
    /// Minimum number of dominators for a point to be removed.
    pub(super) depth: usize,
    /// Distance from the center of the rectangle within which points are tested as dominators, in cells. Points farther
    /// away dominate few.
    pub(super) distance: f32,
    /// Scratch memory for the dominators.
    dominators: Dominators,
}

/// Returns whether dominated points can be removed. This requires a metric whose key is a sum, and wide registers.
pub(super) fn culls_dominated(level: Level, metric: Metric) -> bool {
    is_wide(level) && metric.is_exact_sum()
}

impl Dominance {
    pub(super) fn new() -> Self {
        Self {
            depth: 0,
            distance: 0.0,
            dominators: Dominators::new(),
        }
    }

    /// Returns the maximum key, at the far corner of the rectangle, of a point that is tested as a dominator.
    #[inline(always)]
    fn nearby(&self, metric: Metric, cuboid: &Cuboid) -> f32 {
        // The far corner is up to half of the diagonal farther away than the center.
        let sides = [0, 1, 2].map(|axis| cuboid.high[axis] - cuboid.low[axis]);
        let diagonal = metric.distance(metric.key(sides));
        metric.term(self.distance + diagonal / 2.0)
    }
}

/// Margin for rounding, relative to a point's largest key in the rectangle. The keys of two points and their
/// comparison take fewer than 64 roundings, each of at most 2⁻²⁴ of that key. (A second point with larger terms does
/// not dominate in any case.)
const SPARE: f32 = 128.0 / (1 << 24) as f32;

/// Sixteen points, with their key terms at both ends of a rectangle along each axis.
#[derive(Clone, Copy)]
struct Seen<S: Simd> {
    /// Key terms of the points at the low and at the high end of the rectangle, along three axes. The third axis is
    /// unused for a single slice.
    ends: [[f32x16<S>; 2]; 3],
    /// Accumulated key terms of the points along all other axes.
    rest: f32x16<S>,
    /// Largest key of each point in the rectangle.
    far: f32x16<S>,
}

impl<S: Simd> Seen<S> {
    #[inline(always)]
    fn new<const DEEP: bool>(exact: Exact, cuboid: &Cuboid, lanes: [f32x16<S>; 4]) -> Self {
        let Cuboid { low, high, .. } = cuboid;
        let [x, y, z, rest] = lanes;
        // Compute the terms at both ends of the axes of the image.
        let [left, right, top, bottom] =
            exact.terms([x - low[0], x - high[0], y - low[1], y - high[1]]);
        let mut seen = Self {
            ends: [[left, right], [top, bottom], [rest; 2]],
            rest,
            // The largest key is at the corner where both terms are largest.
            far: rest + left.max(right) + top.max(bottom),
        };
        if DEEP {
            seen.ends[2] = exact.terms([z - low[2], z - high[2]]);
            seen.far += seen.ends[2][0].max(seen.ends[2][1]);
        }
        seen
    }
}

/// The points that are tested as dominators.
#[derive(Debug)]
struct Dominators {
    len: usize,
    /// Key terms of each point at the low and at the high end of the rectangle, along three axes.
    ends: [[Vec<f32>; 2]; 3],
    /// Accumulated key terms of each point along all other axes.
    rest: Vec<f32>,
}

impl Dominators {
    fn new() -> Self {
        let ends = || [Vec::new(), Vec::new()];
        Self {
            len: 0,
            ends: [ends(), ends(), ends()],
            rest: Vec::new(),
        }
    }

    /// Clears the list, and reserves memory for `n` points and one more register.
    #[inline(always)]
    fn clear(&mut self, n: usize) {
        self.len = 0;
        let room = n + LANES;
        if self.rest.len() < room {
            let ends = self.ends.as_flattened_mut().iter_mut();
            for numbers in ends.chain([&mut self.rest]) {
                numbers.resize(room.next_power_of_two(), 0.0);
            }
        }
    }

    /// Appends the points whose lanes are set in `mask`.
    #[inline(always)]
    fn push<S: Simd, const DEEP: bool>(&mut self, seen: &Seen<S>, mask: mask32x16<S>) {
        let to = self.len..self.len + LANES;
        for axis in 0..if DEEP { 3 } else { 2 } {
            for end in 0..2 {
                let terms = seen.ends[axis][end].compress(mask);
                terms.store_slice(&mut self.ends[axis][end][to.clone()]);
            }
        }
        seen.rest
            .compress(mask)
            .store_slice(&mut self.rest[to.clone()]);
        self.len += mask.to_bitmask().count_ones() as usize;
    }

    /// For each of sixteen points, counts the points that dominate it.
    #[inline(always)]
    fn count<S: Simd, const DEEP: bool>(&self, seen: &Seen<S>) -> u32x16<S> {
        let mut number = u32x16::splat(seen.far.simd, 0);
        let n = self.len;
        let [[left, right], [top, bottom], [front, back]] = &self.ends;
        let (left, right, rest) = (&left[..n], &right[..n], &self.rest[..n]);
        let (top, bottom) = (&top[..n], &bottom[..n]);
        let (front, back) = (&front[..n], &back[..n]);
        let [across, down, deep] = seen.ends;
        let lowered = seen.rest - seen.far * SPARE;
        // The smallest difference of the keys in the rectangle, reduced by the allowance for rounding.
        for index in 0..n {
            let across = (across[0] - left[index]).min(across[1] - right[index]);
            let down = (down[0] - top[index]).min(down[1] - bottom[index]);
            let mut nearer = across + down + (lowered - rest[index]);
            if DEEP {
                nearer += (deep[0] - front[index]).min(deep[1] - back[index]);
            }
            // A dominator is nearer even where the difference of the keys is smallest.
            number = nearer.simd_gt(0.0).select(number + 1, number);
        }
        number
    }
}

/// The axes of space along which rows and slices of an image differ. Columns differ along the first axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureAxes {
    pub(super) rows: usize,
    pub(super) slices: Option<usize>,
}

/// Feature points projected to the image. Each array has one element per point, and a register of padding.
#[derive(Debug)]
pub(super) struct FlatPoints {
    pub(super) len: usize,
    /// Coordinates along the axes in which columns and rows differ, in cells from the corner of an area. The corner is
    /// less than 8 cells away, so they are exact.
    pub(super) x: Vec<f32>,
    pub(super) y: Vec<f32>,
    /// Coordinates along the axis in which slices differ, in cells.
    pub(super) z: Vec<f32>,
    /// Accumulated key terms along all other axes.
    pub(super) rest: Vec<f32>,
    /// Indices of the points in the table, if needed; otherwise empty.
    pub(super) numbers: Vec<u32>,
    pub(super) wants_numbers: bool,
}

impl FlatPoints {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            x: Vec::new(),
            y: Vec::new(),
            z: Vec::new(),
            rest: Vec::new(),
            numbers: Vec::new(),
            wants_numbers: false,
        }
    }

    /// Clears the list, and reserves memory for `n` points.
    #[inline(always)]
    fn clear(&mut self, n: usize, wants_numbers: bool) {
        self.len = 0;
        self.wants_numbers = wants_numbers;
        let room = n.next_multiple_of(LANES) + LANES;
        if self.x.len() < room {
            for numbers in [&mut self.x, &mut self.y, &mut self.z, &mut self.rest] {
                numbers.resize(room.next_power_of_two(), 0.0);
            }
        }
        if wants_numbers && self.numbers.len() < room {
            self.numbers.resize(room.next_power_of_two(), 0);
        }
    }

    /// Replaces the points by the projections of a list's points, with coordinates relative to the lower corner of
    /// `pixels`.
    pub(super) fn flatten(
        &mut self,
        level: Level,
        metric: Metric,
        points: &PointList,
        pixels: &PixelBox,
        axes: PictureAxes,
    ) {
        measured!(level, metric, (simd, measure) => {
            self.flatten_by(simd, measure, points, pixels, axes);
        });
    }

    /// SIMD implementation of [`flatten`](Self::flatten).
    #[inline(always)]
    fn flatten_by<S: Simd, M: Measure>(
        &mut self,
        simd: S,
        measure: M,
        points: &PointList,
        pixels: &PixelBox,
        axes: PictureAxes,
    ) {
        self.clear(points.len, self.wants_numbers);
        self.len = points.len;
        for start in (0..points.len).step_by(LANES) {
            let at = start..start + LANES;
            // Accumulate the terms of the axes that are orthogonal to the image.
            let mut rest = f32x16::splat(simd, 0.0);
            for axis in (1..pixels.n_axes).rev() {
                if axis != axes.rows && Some(axis) != axes.slices {
                    let [term] = measure.terms([places(simd, points, pixels, axis, start)]);
                    rest = measure.accumulate(term, rest);
                }
            }
            // Store the coordinates along the axes of the image.
            places(simd, points, pixels, 0, start).store_slice(&mut self.x[at.clone()]);
            let rows = places(simd, points, pixels, axes.rows, start);
            rows.store_slice(&mut self.y[at.clone()]);
            if let Some(deep_axis) = axes.slices {
                let depths = places(simd, points, pixels, deep_axis, start);
                depths.store_slice(&mut self.z[at.clone()]);
            }
            rest.store_slice(&mut self.rest[at.clone()]);
            if self.wants_numbers {
                self.numbers[at.clone()].copy_from_slice(&points.numbers[at]);
            }
        }
    }

    /// Replaces the points by those of `points` that fewer than `dominance.depth` others dominate in a cuboid.
    /// Supports only metrics whose key is a sum.
    pub(super) fn take_undominated(
        &mut self,
        level: Level,
        metric: Metric,
        points: &Self,
        cuboid: &Cuboid,
        dominance: &mut Dominance,
    ) {
        wide!(level, simd => if cuboid.is_deep {
            self.take_undominated_axes::<_, true>(simd, metric, points, cuboid, dominance);
        } else {
            self.take_undominated_axes::<_, false>(simd, metric, points, cuboid, dominance);
        });
    }

    /// SIMD implementation of [`take_undominated`](Self::take_undominated). `DEEP` means that there are several slices.
    #[inline(always)]
    fn take_undominated_axes<S: Simd, const DEEP: bool>(
        &mut self,
        simd: S,
        metric: Metric,
        points: &Self,
        cuboid: &Cuboid,
        dominance: &mut Dominance,
    ) {
        self.clear(points.len, points.wants_numbers);
        let nearby = dominance.nearby(metric, cuboid);
        let dominators = &mut dominance.dominators;
        dominators.clear(points.len);
        // Collect the points near the rectangle as dominators.
        for start in (0..points.len).step_by(LANES) {
            let seen = Seen::new::<DEEP>(Exact(metric), cuboid, points.lanes(simd, start));
            let is_there = lanes_before(simd, points.len - start);
            dominators.push::<S, DEEP>(&seen, seen.far.simd_le(nearby) & is_there);
        }
        // Select the points with fewer than `depth` dominators.
        for start in (0..points.len).step_by(LANES) {
            let lanes = points.lanes(simd, start);
            let seen = Seen::new::<DEEP>(Exact(metric), cuboid, lanes);
            let matters = dominators
                .count::<S, DEEP>(&seen)
                .simd_lt(dominance.depth as u32);
            let mask = matters & lanes_before(simd, points.len - start);
            let to = self.len..self.len + LANES;
            let [x, y, z, rest] = lanes;
            x.compress(mask).store_slice(&mut self.x[to.clone()]);
            y.compress(mask).store_slice(&mut self.y[to.clone()]);
            if DEEP {
                z.compress(mask).store_slice(&mut self.z[to.clone()]);
            }
            rest.compress(mask).store_slice(&mut self.rest[to.clone()]);
            if self.wants_numbers {
                let numbers = u32x16::from_slice(simd, &points.numbers[start..start + LANES]);
                numbers.compress(mask).store_slice(&mut self.numbers[to]);
            }
            self.len += mask.to_bitmask().count_ones() as usize;
        }
    }

    /// Returns, for sixteen points starting at index `start`, x, y, z and the accumulated key terms along all other
    /// axes.
    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S, start: usize) -> [f32x16<S>; 4] {
        let at = start..start + LANES;
        [
            f32x16::from_slice(simd, &self.x[at.clone()]),
            f32x16::from_slice(simd, &self.y[at.clone()]),
            f32x16::from_slice(simd, &self.z[at.clone()]),
            f32x16::from_slice(simd, &self.rest[at]),
        ]
    }
}

/// Returns the coordinates of sixteen points of a list along an axis, in cells from the lower corner of `pixels`.
#[inline(always)]
fn places<S: Simd>(
    simd: S,
    points: &PointList,
    pixels: &PixelBox,
    axis: usize,
    start: usize,
) -> f32x16<S> {
    let steps = i32x16::from_slice(simd, &points.steps[axis][start..start + LANES]);
    (steps - pixels.low[axis]).to_float::<f32x16<S>>() * STEP
}
