//! Which feature points are nearer than others in a whole rectangle of pixels.
//!
//! The difference of the squared distances to two points is linear, so its smallest value in a rectangle about `m` with
//! sides of `2h` is known: `|a − m|² − |b − m|² − 2h·|a − b|`, where the last product goes axis by axis. If it is above
//! zero, `b` is nearer than `a` in the whole rectangle, and is *preferred*. A point to which `K` others are preferred
//! is not among the `K` nearest of any pixel.
//!
//! This leaves about half of the points that are left by bounds for each point alone.

use super::LANES;
use fearless_simd::{f32x16, mask32x16, prelude::*, u32x16};

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

    /// Takes those of some points to which fewer than `depth` others are preferred.
    #[inline(always)]
    pub(super) fn thin<S: Simd>(
        &mut self,
        simd: S,
        points: &Self,
        (view, depth): (&View, u32),
        rivals: &mut Self,
    ) {
        self.clear(points.len);
        rivals.clear(points.len);
        for start in (0..points.len).step_by(LANES) {
            let seen = view.see(simd, points, start);
            let numbers = [seen.ways[0], seen.ways[1], seen.squares];
            rivals.push(numbers, seen.is_nearby);
        }
        for start in (0..points.len).step_by(LANES) {
            let seen = view.see(simd, points, start);
            let matters = seen.is_there & preferred(seen, rivals).simd_lt(depth);
            let numbers = [&points.x, &points.y, &points.rest]
                .map(|numbers| f32x16::from_slice(simd, &numbers[start..start + LANES]));
            self.push(numbers, matters);
        }
    }

    /// Takes in some of sixteen.
    #[inline(always)]
    fn push<S: Simd>(&mut self, numbers: [f32x16<S>; 3], mask: mask32x16<S>) {
        let to = self.len..self.len + LANES;
        let [x, y, rest] = numbers;
        x.compress(mask).store_slice(&mut self.x[to.clone()]);
        y.compress(mask).store_slice(&mut self.y[to.clone()]);
        rest.compress(mask).store_slice(&mut self.rest[to]);
        self.len += mask.to_bitmask().count_ones() as usize;
    }
}

/// What is to spare of the sum of the squared distance of a point and that of the corners of the rectangle. There are
/// fewer than 64 roundings in two keys and in what compares them, and none of them is of more than 2⁻²⁴ of that.
const SPARE: f32 = 128.0 / (1 << 24) as f32;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Its middle and its sides, in cells.
    middle: [f32; 2],
    sides: [f32; 2],
    /// The square of the distance from the middle to the corners.
    corner: f32,
    /// Points with larger squared distances from the middle are not tried as preferred ones.
    nearby: f32,
}

/// Sixteen points, as seen from the middle of a rectangle.
#[derive(Clone, Copy)]
struct Seen<S: Simd> {
    is_there: mask32x16<S>,
    /// The ways to them times the sides of the rectangle.
    ways: [f32x16<S>; 2],
    /// The squares of their distances.
    squares: f32x16<S>,
    /// The same without what there is to spare.
    lowered: f32x16<S>,
    is_nearby: mask32x16<S>,
}

impl View {
    pub(super) fn new([low, high]: [[f32; 2]; 2], nearby: f32) -> Self {
        let sides = [high[0] - low[0], high[1] - low[1]];
        Self {
            middle: [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0],
            sides,
            corner: (sides[0] * sides[0] + sides[1] * sides[1]) / 4.0,
            nearby,
        }
    }

    /// Sees sixteen points.
    #[inline(always)]
    fn see<S: Simd>(&self, simd: S, points: &FlatPoints, start: usize) -> Seen<S> {
        let n_lanes = (points.len - start).min(LANES);
        let is_there = mask32x16::from_bitmask(simd, u64::MAX >> (64 - n_lanes));
        let at = start..start + LANES;
        let x = f32x16::from_slice(simd, &points.x[at.clone()]) - self.middle[0];
        let y = f32x16::from_slice(simd, &points.y[at.clone()]) - self.middle[1];
        let rest = f32x16::from_slice(simd, &points.rest[at]);
        let squares = x * x + (y * y + rest);
        Seen {
            is_there,
            ways: [x * self.sides[0], y * self.sides[1]],
            squares,
            lowered: squares - (squares + self.corner) * SPARE,
            is_nearby: squares.simd_le(self.nearby) & is_there,
        }
    }
}

/// How many of some points are preferred to each of sixteen.
#[inline(always)]
fn preferred<S: Simd>(seen: Seen<S>, rivals: &FlatPoints) -> u32x16<S> {
    let mut number = u32x16::splat(seen.squares.simd, 0);
    let n = rivals.len;
    let (x, y, squares) = (&rivals.x[..n], &rivals.y[..n], &rivals.rest[..n]);
    for rival in 0..n {
        let apart = (seen.ways[0] - x[rival]).abs() + (seen.ways[1] - y[rival]).abs();
        let is_preferred = (seen.lowered - squares[rival]).simd_gt(apart);
        number = is_preferred.select(number + 1, number);
    }
    number
}
