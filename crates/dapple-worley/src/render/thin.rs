//! Which feature points are nearer than others in a whole rectangle of pixels.
//!
//! Where terms are added up, what a point is nearer than another is a sum over the axes, and along each axis it grows or
//! shrinks all the way, since terms are convex. So its smallest value in a rectangle is the sum of the smaller ones of
//! two ends. If that is above zero, the one point is *preferred* to the other: it is nearer in the whole rectangle. A
//! point to which `K` others are preferred is not among the `K` nearest of any pixel.
//!
//! This leaves about half of the points that are left by bounds for each point alone.

use super::LANES;
use super::sieve::{PixelBox, PointList, Points, lanes_before};
use crate::fixed::STEP;
use crate::metric::Norm;
use fearless_simd::{f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// A rectangle of pixels along two axes, in cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) low: [f32; 2],
    pub(super) high: [f32; 2],
}

/// Which points are not kept.
#[derive(Clone, Copy, Debug)]
pub(super) struct Thinning {
    /// Those to which so many others are preferred,
    pub(super) depth: usize,
    /// if those others are about this near to the middle of the rectangle: farther ones are preferred to few.
    pub(super) distance: f32,
}

impl Thinning {
    /// Those that are near have no larger keys than this at the far corner.
    #[inline(always)]
    fn nearby<M: Norm>(&self, norm: M, rectangle: &Rectangle) -> f32 {
        let [width, height] = [0, 1].map(|axis| rectangle.high[axis] - rectangle.low[axis]);
        let diagonal = norm.distance(norm.key([width, height]));
        norm.key_along_one_axis(self.distance + diagonal / 2.0)
    }
}

/// What is to spare of the largest key of a point: there are fewer than 64 roundings in its key, in that of another
/// point, and in what compares them, and none of them is of more than 2⁻²⁴ of that. (Another point with larger terms is
/// not preferred in any case.)
const SPARE: f32 = 128.0 / (1 << 24) as f32;

/// Sixteen points, as seen from a rectangle.
#[derive(Clone, Copy)]
struct Seen<S: Simd> {
    /// Along the two axes, their terms at the low and at the high end.
    ends: [[f32x16<S>; 2]; 2],
    /// What the other axes add.
    rest: f32x16<S>,
    /// The largest keys that they have.
    far: f32x16<S>,
}

impl<S: Simd> Seen<S> {
    #[inline(always)]
    fn new<M: Norm>(
        norm: M,
        rectangle: &Rectangle,
        places: [f32x16<S>; 2],
        rest: f32x16<S>,
    ) -> Self {
        let mut ends = [[rest; 2]; 2];
        let mut far = rest;
        for axis in 0..2 {
            ends[axis][0] = norm.terms(places[axis] - rectangle.low[axis]);
            ends[axis][1] = norm.terms(places[axis] - rectangle.high[axis]);
            far += ends[axis][0].max(ends[axis][1]);
        }
        Self { ends, rest, far }
    }
}

/// Points that may be preferred to others.
#[derive(Debug)]
pub(super) struct Rivals {
    len: usize,
    /// Along the two axes, their terms at the low and at the high end.
    ends: [[Vec<f32>; 2]; 2],
    /// What the other axes add.
    rest: Vec<f32>,
}

impl Rivals {
    pub(super) fn new() -> Self {
        let ends = || [Vec::new(), Vec::new()];
        Self {
            len: 0,
            ends: [ends(), ends()],
            rest: Vec::new(),
        }
    }

    /// Takes all away, and makes room for so many and a register more.
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

    /// Takes in some of sixteen points.
    #[inline(always)]
    fn push<S: Simd>(&mut self, seen: &Seen<S>, mask: mask32x16<S>) {
        let to = self.len..self.len + LANES;
        for axis in 0..2 {
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

    /// How many are preferred to each of sixteen points.
    #[inline(always)]
    fn preferred<S: Simd>(&self, seen: &Seen<S>) -> u32x16<S> {
        let mut number = u32x16::splat(seen.far.simd, 0);
        let n = self.len;
        let [[left, right], [top, bottom]] = &self.ends;
        let (left, right, rest) = (&left[..n], &right[..n], &self.rest[..n]);
        let (top, bottom) = (&top[..n], &bottom[..n]);
        let [across, down] = seen.ends;
        let lowered = seen.rest - seen.far * SPARE;
        for rival in 0..n {
            let across = (across[0] - left[rival]).min(across[1] - right[rival]);
            let down = (down[0] - top[rival]).min(down[1] - bottom[rival]);
            let nearer = across + down + (lowered - rest[rival]);
            number = nearer.simd_gt(0.0).select(number + 1, number);
        }
        number
    }
}

/// Feature points in the plane of the picture.
#[derive(Debug)]
pub(super) struct FlatPoints {
    pub(super) len: usize,
    /// Their coordinates along the first two axes, in cells from some corner that is less than 8 cells away, and so
    /// exact. There is room for a register more.
    pub(super) x: Vec<f32>,
    pub(super) y: Vec<f32>,
    /// What the other axes add to their keys.
    pub(super) rest: Vec<f32>,
}

impl FlatPoints {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            x: Vec::new(),
            y: Vec::new(),
            rest: Vec::new(),
        }
    }

    /// Takes all away, and makes room for so many.
    #[inline(always)]
    pub(super) fn clear(&mut self, n: usize) {
        self.len = 0;
        let room = n.next_multiple_of(LANES) + LANES;
        if self.x.len() < room {
            for numbers in [&mut self.x, &mut self.y, &mut self.rest] {
                numbers.resize(room.next_power_of_two(), 0.0);
            }
        }
    }

    /// Keeps some of the points that are seen from a rectangle. Only for metrics whose terms are added up.
    #[inline(always)]
    pub(super) fn thin<S: Simd, M: Norm>(
        &mut self,
        simd: S,
        norm: M,
        (points, rectangle): (&Self, &Rectangle),
        (thinning, rivals): (&Thinning, &mut Rivals),
    ) {
        self.clear(points.len);
        rivals.clear(points.len);
        let nearby = thinning.nearby(norm, rectangle);
        for start in (0..points.len).step_by(LANES) {
            let [x, y, rest] = points.lanes(simd, start);
            let seen = Seen::new(norm, rectangle, [x, y], rest);
            let is_there = lanes_before(simd, points.len - start);
            rivals.push(&seen, seen.far.simd_le(nearby) & is_there);
        }
        for start in (0..points.len).step_by(LANES) {
            let [x, y, rest] = points.lanes(simd, start);
            let seen = Seen::new(norm, rectangle, [x, y], rest);
            let matters = rivals.preferred(&seen).simd_lt(thinning.depth as u32);
            let mask = matters & lanes_before(simd, points.len - start);
            let to = self.len..self.len + LANES;
            x.compress(mask).store_slice(&mut self.x[to.clone()]);
            y.compress(mask).store_slice(&mut self.y[to.clone()]);
            rest.compress(mask).store_slice(&mut self.rest[to]);
            self.len += mask.to_bitmask().count_ones() as usize;
        }
    }

    /// Sixteen points.
    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S, start: usize) -> [f32x16<S>; 3] {
        let at = start..start + LANES;
        [
            f32x16::from_slice(simd, &self.x[at.clone()]),
            f32x16::from_slice(simd, &self.y[at.clone()]),
            f32x16::from_slice(simd, &self.rest[at]),
        ]
    }
}

impl<const N: usize> PointList<N> {
    /// As [`FlatPoints::thin`], for pixels that differ along the first axis and `row_axis` only.
    #[inline(always)]
    pub(super) fn thin<S: Simd, M: Norm>(
        &mut self,
        simd: S,
        norm: M,
        (points, pixels, row_axis): (Points<'_, N>, &PixelBox<N>, usize),
        (thinning, rivals): (&Thinning, &mut Rivals),
    ) {
        rivals.clear(self.make_room(points));
        let view = ListView {
            pixels,
            row_axis,
            rectangle: Rectangle {
                low: [0.0; 2],
                high: [0, row_axis]
                    .map(|axis| (pixels.high[axis] - pixels.low[axis]) as f32 * STEP),
            },
        };
        let nearby = thinning.nearby(norm, &view.rectangle);
        for run in points.runs {
            for start in run.clone().step_by(LANES) {
                let seen = view.see(simd, norm, points.steps, start);
                let is_there = lanes_before(simd, run.end - start);
                rivals.push(&seen, seen.far.simd_le(nearby) & is_there);
            }
        }
        for run in points.runs {
            for start in run.clone().step_by(LANES) {
                let seen = view.see(simd, norm, points.steps, start);
                let matters = rivals.preferred(&seen).simd_lt(thinning.depth as u32);
                let is_there = lanes_before(simd, run.end - start);
                self.push(simd, points, start, matters & is_there);
            }
        }
    }
}

/// From where the points of a list are seen: their coordinates are counted from the lower corner of the pixels.
struct ListView<'a, const N: usize> {
    pixels: &'a PixelBox<N>,
    row_axis: usize,
    rectangle: Rectangle,
}

impl<const N: usize> ListView<'_, N> {
    /// Sixteen points.
    #[inline(always)]
    fn see<S: Simd, M: Norm>(
        &self,
        simd: S,
        norm: M,
        steps: &[Vec<i32>; N],
        start: usize,
    ) -> Seen<S> {
        let mut rest = f32x16::splat(simd, 0.0);
        let mut places = [rest; N];
        for axis in 0..N {
            let steps = i32x16::from_slice(simd, &steps[axis][start..start + LANES]);
            places[axis] = (steps - self.pixels.low[axis]).to_float::<f32x16<S>>() * STEP;
            if axis != 0 && axis != self.row_axis {
                rest += norm.terms(places[axis]);
            }
        }
        let places = [places[0], places[self.row_axis]];
        Seen::new(norm, &self.rectangle, places, rest)
    }
}
