//! Which feature points matter to a box of pixels.
//!
//! A point can be among the `K` nearest of some pixel only if it is nearer to the box than a bound. There are two: the
//! `K`-th smallest of the distances from the points to their furthest corner of the box, which always holds and is
//! best for small boxes; and a guess, which is best for large ones, and holds if the distances that result are below
//! it. Small boxes are sifted from those that matter to a larger box about them.

use super::LANES;
use crate::fixed::{STEP, STEP_BITS, STEPS};
use crate::metric::Norm;
use core::ops::Range;
use fearless_simd::{f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// Where some pixels lie, in steps from the lower corner of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelBox<const N: usize> {
    pub(super) low: [i32; N],
    pub(super) high: [i32; N],
}

impl<const N: usize> PixelBox<N> {
    /// The cells of the table within `ring` cells of those that the box touches, as the first and the last along each
    /// axis. May reach past the table.
    pub(super) fn cells(&self, ring: i32) -> [[i32; N]; 2] {
        [
            self.low.map(|low| (low >> STEP_BITS) - ring),
            self.high.map(|high| (high >> STEP_BITS) + ring),
        ]
    }

    /// How far it is from the box to the nearest place outside of these cells, in steps.
    pub(super) fn border(&self, [first, last]: [[i32; N]; 2]) -> i32 {
        let mut border = i32::MAX;
        for axis in 0..N {
            border = border
                .min(self.low[axis] - first[axis] * STEPS)
                .min((last[axis] + 1) * STEPS - self.high[axis]);
        }
        border
    }
}

/// Feature points, axis by axis.
#[derive(Debug)]
pub(super) struct PointList<const N: usize> {
    pub(super) len: usize,
    /// Their coordinates along each axis, in steps from the lower corner of the table. There is room for a register
    /// more.
    pub(super) steps: [Vec<i32>; N],
    /// Which points of the table they are, if somebody wants to know.
    pub(super) numbers: Vec<u32>,
}

/// Where points are sifted from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Points<'a, const N: usize> {
    pub(super) steps: &'a [Vec<i32>; N],
    /// The numbers of the points, if they are not simply counted.
    pub(super) numbers: Option<&'a [u32]>,
    /// Which of them.
    pub(super) runs: &'a [Range<usize>],
    pub(super) wants_numbers: bool,
}

/// Which points are kept.
#[derive(Clone, Copy, Debug)]
pub(super) enum Keep {
    /// Those that can be among so many nearest.
    Nearest(usize),
    /// Those whose smallest key is at most this.
    Within(f32),
}

impl<const N: usize> PointList<N> {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            steps: core::array::from_fn(|_| Vec::new()),
            numbers: Vec::new(),
        }
    }

    /// The points, to be sifted again.
    pub(super) fn points<'a>(
        &'a self,
        run: &'a Range<usize>,
        wants_numbers: bool,
    ) -> Points<'a, N> {
        Points {
            steps: &self.steps,
            numbers: wants_numbers.then_some(&self.numbers),
            runs: core::slice::from_ref(run),
            wants_numbers,
        }
    }

    /// Keeps those of some points that matter to a box, in their order. `near` is memory to work in.
    #[inline(always)]
    pub(super) fn sift<S: Simd, M: Norm>(
        &mut self,
        simd: S,
        norm: M,
        points: Points<'_, N>,
        (pixels, keep): (&PixelBox<N>, Keep),
        near: &mut Vec<f32>,
    ) {
        let room = self.make_room(points);
        match keep {
            Keep::Within(bound) => {
                for run in points.runs {
                    let mut start = run.start;
                    while start < run.end {
                        let (key, _) = keys(simd, norm, points.steps, pixels, start, false);
                        let matters = key.simd_le(bound) & lanes_before(simd, run.end - start);
                        self.push(simd, points, start, matters);
                        start += LANES;
                    }
                }
            }
            Keep::Nearest(depth) => {
                if near.len() < room {
                    near.resize(room.next_power_of_two(), 0.0);
                }
                let infinite = f32x16::splat(simd, f32::INFINITY);
                let mut least = infinite;
                let mut at = 0;
                for run in points.runs {
                    let mut start = run.start;
                    while start < run.end {
                        let (key, far) = keys(simd, norm, points.steps, pixels, start, true);
                        let is_there = lanes_before(simd, run.end - start);
                        is_there
                            .select(key, infinite)
                            .store_slice(&mut near[at..at + LANES]);
                        least = least.min(is_there.select(far, infinite));
                        at += LANES;
                        start += LANES;
                    }
                }
                // An infinite bound keeps what is there, and only that.
                let bound = (smallest_but(depth - 1, least) * M::LOOSE).min(f32::MAX);
                let mut at = 0;
                for run in points.runs {
                    let mut start = run.start;
                    while start < run.end {
                        let key = f32x16::from_slice(simd, &near[at..at + LANES]);
                        self.push(simd, points, start, key.simd_le(bound));
                        at += LANES;
                        start += LANES;
                    }
                }
            }
        }
    }

    /// Empties the list, and makes room for some points; returns for how many.
    pub(super) fn make_room(&mut self, points: Points<'_, N>) -> usize {
        self.len = 0;
        let slots = points.runs.iter().map(|run| run.len().div_ceil(LANES));
        let room = (slots.sum::<usize>() + 1) * LANES;
        for steps in &mut self.steps {
            if steps.len() < room {
                steps.resize(room.next_power_of_two(), 0);
            }
        }
        if points.wants_numbers && self.numbers.len() < room {
            self.numbers.resize(room.next_power_of_two(), 0);
        }
        room
    }

    /// Takes in some of sixteen points.
    #[inline(always)]
    pub(super) fn push<S: Simd>(
        &mut self,
        simd: S,
        points: Points<'_, N>,
        start: usize,
        matters: mask32x16<S>,
    ) {
        let to = self.len..self.len + LANES;
        for axis in 0..N {
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

/// The numbers of the lanes.
const ASCENDING: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// The first lanes, at most sixteen.
#[inline(always)]
pub(super) fn lanes_before<S: Simd>(simd: S, n: usize) -> mask32x16<S> {
    mask32x16::from_bitmask(simd, u64::MAX >> (64 - n.min(LANES)))
}

/// The smallest and, if wanted, the largest keys that sixteen points have in a box.
#[inline(always)]
fn keys<S: Simd, M: Norm, const N: usize>(
    simd: S,
    norm: M,
    steps: &[Vec<i32>; N],
    pixels: &PixelBox<N>,
    start: usize,
    wants_largest: bool,
) -> (f32x16<S>, f32x16<S>) {
    let zero = f32x16::splat(simd, 0.0);
    let [mut near_key, mut far_key] = [zero; 2];
    for axis in (0..N).rev() {
        let [low, high] = [pixels.low[axis], pixels.high[axis]];
        let steps = i32x16::from_slice(simd, &steps[axis][start..start + LANES]);
        let ahead = (steps - low).to_float::<f32x16<S>>() * STEP;
        let past = ahead - (high - low) as f32 * STEP;
        let near = norm.terms(past.max(-ahead).max(zero));
        near_key = if axis == N - 1 {
            near
        } else {
            norm.joins(near, near_key)
        };
        if wants_largest {
            let far = norm.terms(ahead.max(-past));
            far_key = if axis == N - 1 {
                far
            } else {
                norm.joins(far, far_key)
            };
        }
    }
    (near_key, far_key)
}

/// The smallest number of the lanes that is left when `n` have been taken away; more, if some are equal.
///
/// Each lane holds the distance of another point, so it bounds that of the point in this place of the order.
#[inline(always)]
fn smallest_but<S: Simd>(n: usize, mut far: f32x16<S>) -> f32 {
    for _ in 0..n {
        let is_smallest = far.simd_eq(far.reduce_min());
        far = is_smallest.select(f32x16::splat(far.simd, f32::INFINITY), far);
    }
    far.reduce_min()
}
