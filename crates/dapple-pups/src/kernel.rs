//! The weights of one control point over a band of pixels.
//!
//! A band is [`ROWS`] rows high. The columns that a support can touch in it are taken [`TILE`] at a time, from its left
//! edge on. For the cubic, the product of axial weights `u² (3 − 2u)` is kept as two products, `q = Π u` and
//! `t = Π (u − 3/2)`, so that an axis costs few operations: `W = q² · t · (−2)^k`, where the power of two is exact.
//!
//! An axis whose `u` is 1 over a whole tile is left out, which changes no bit; a control point with an axis whose `u` is
//! 0 over a whole tile has no weight there. Both are decided with the very numbers that the pixels would get, since
//! rounding is monotonic.

use crate::line::Line;
use crate::net::{AxisBlock, BLOCK, Instance};
use crate::power::power;
use crate::weight::{AxialWeight, Lane};
use core::ops::Range;
use fearless_simd::{f32x8, prelude::*};

/// Columns of a tile: a register at the widest level.
pub(crate) const TILE: usize = 16;

/// Rows of a band.
pub(crate) const ROWS: usize = 8;

/// How the axes of a block are multiplied up.
pub(crate) trait Profile: Copy + Send + Sync {
    /// Takes in an axis, given its `u`, in `[0, 1]`.
    fn step<V: Lane>(self, q: V, t: V, u: V) -> (V, V);

    /// The product after `n` axes of which none was left out; the ones left out count as if they never were.
    fn finish<V: Lane>(self, q: V, t: V, n: usize) -> V;
}

/// The cubic of equation 1.
#[derive(Clone, Copy)]
pub(crate) struct Cubic;

impl Profile for Cubic {
    #[inline(always)]
    fn step<V: Lane>(self, q: V, t: V, u: V) -> (V, V) {
        (q * u, t * (u - 1.5))
    }

    #[inline(always)]
    fn finish<V: Lane>(self, q: V, t: V, n: usize) -> V {
        const POWERS: [f32; BLOCK + 1] = [1.0, -2.0, 4.0, -8.0, 16.0, -32.0, 64.0, -128.0, 256.0];
        q * q * (t * POWERS[n])
    }
}

/// Any other axial weight.
impl Profile for AxialWeight {
    #[inline(always)]
    fn step<V: Lane>(self, q: V, t: V, u: V) -> (V, V) {
        (q * self.of_complement(u), t)
    }

    #[inline(always)]
    fn finish<V: Lane>(self, q: V, _: V, _: usize) -> V {
        q
    }
}

/// What becomes of the weights of a band.
///
/// Weights are added to planes of numbers, which begin at zero; when all control points have been taken in, the planes
/// are resolved into values.
pub(crate) trait Sink: Sync {
    /// What a pixel is made of.
    type Value: Copy + Send;

    /// How many planes there are.
    fn n_planes(&self) -> usize;

    /// How many values there are to a pixel.
    fn per_pixel(&self) -> usize;

    /// Takes in the weights of control point `point` for a register of pixels from `at` on, in every plane.
    fn add<S: Simd>(&self, simd: S, point: u32, weight: S::f32s, planes: &mut Planes, at: usize);

    /// Makes the values of a row of pixels, given its part of every plane. `nearest(i)` is the control point nearest to
    /// pixel `i`, for where no weight is left.
    fn resolve<'a, S: Simd>(
        &self,
        simd: S,
        plane: impl Fn(usize) -> &'a [f32],
        values: &mut [Self::Value],
        nearest: impl Fn(usize) -> u32,
    );

    /// What stands for a value at a position that is not finite.
    fn undefined(&self) -> Self::Value;
}

/// The numbers that a band is summed in: planes of [`ROWS`] rows, whose tiles each begin on a cache line, so that no
/// register of numbers lies across two.
#[derive(Default)]
pub(crate) struct Planes {
    numbers: Vec<f32>,
    /// Where the first cache line begins.
    origin: usize,
    /// From a row to the next.
    pub(crate) stride: usize,
}

impl Planes {
    /// Zeroed planes with rows of at least `width` numbers.
    pub(crate) fn clear(&mut self, n_planes: usize, width: usize) {
        self.stride = width.next_multiple_of(TILE);
        self.numbers.clear();
        self.numbers
            .resize(n_planes * ROWS * self.stride + TILE, 0.0);
        // Where this is not possible, it is only slower.
        self.origin = self
            .numbers
            .as_ptr()
            .align_offset(TILE * size_of::<f32>())
            .min(TILE);
    }

    /// A register of numbers of a plane.
    #[inline(always)]
    pub(crate) fn register<S: Simd>(&mut self, plane: usize, at: usize) -> &mut [f32] {
        let start = self.origin + plane * ROWS * self.stride + at;
        &mut self.numbers[start..start + S::f32s::LEN]
    }

    /// The first `width` numbers of a row of a plane.
    #[inline(always)]
    pub(crate) fn row(&self, plane: usize, row: usize, width: usize) -> &[f32] {
        let start = self.origin + (plane * ROWS + row) * self.stride;
        &self.numbers[start..start + width]
    }
}

/// An axis that matters in a tile: its x, and `1 − a_y d_y` for every row.
#[derive(Clone, Copy, Default)]
struct ActiveAxis {
    x: f32,
    rest: [f32; ROWS],
}

/// The axes of one block that matter in a tile.
#[derive(Clone, Copy, Default)]
pub(crate) struct ActiveBlock {
    axes: [ActiveAxis; BLOCK],
    n: usize,
}

/// The pixels of a band.
pub(crate) struct Grid<'a> {
    /// Columns, filled up to whole tiles with the last real one.
    pub(crate) xs: &'a [f64],
    /// The real ones.
    pub(crate) line: &'a Line,
    /// Rows; the last real one may come again.
    pub(crate) ys: [f64; ROWS],
}

/// One control point, or image of one.
#[derive(Clone, Copy)]
pub(crate) struct Splat<'a, P> {
    pub(crate) profile: P,
    pub(crate) instance: &'a Instance,
    pub(crate) blocks: &'a [AxisBlock],
    /// ε times the orientation in the plane.
    pub(crate) shift: Option<[f32; 2]>,
}

/// A tile as seen from a control point.
struct Tile {
    x: [f32; TILE],
    y: [f32; ROWS],
    /// Where it begins in a plane.
    start: usize,
    /// Which columns of the plane the support can touch.
    columns: Range<usize>,
    /// Which rows: the upper four, the lower four.
    halves: [bool; 2],
}

impl<P: Profile> Splat<'_, P> {
    /// Adds the weights of this control point to a band.
    #[inline(always)]
    pub(crate) fn add_to<S: Simd, K: Sink>(
        &self,
        simd: S,
        sink: &K,
        grid: &Grid,
        active: &mut Vec<ActiveBlock>,
        planes: &mut Planes,
    ) {
        let Instance {
            center, min, max, ..
        } = *self.instance;
        let mut columns = grid.line.touched(min.x, max.x);
        if columns.is_empty() {
            return;
        }
        let y = grid.ys.map(|y| (y - center.y) as f32);
        if columns.len() > 2 * TILE {
            let Some([left, right]) = self.reach(simd, &y) else {
                return;
            };
            let [left, right] = [left, right].map(|x| center.x + f64::from(x));
            columns = grid.line.touched(left.max(min.x), right.min(max.x));
        }
        let half = |row: usize| {
            let (a, b) = (grid.ys[row], grid.ys[row + ROWS / 2 - 1]);
            a.min(b) <= max.y && a.max(b) >= min.y
        };
        if columns.is_empty() {
            return;
        }
        let halves = [half(0), half(ROWS / 2)];
        let mut tile = Tile {
            x: [0.0; TILE],
            y,
            start: 0,
            columns: columns.clone(),
            halves,
        };
        active.resize(self.blocks.len(), ActiveBlock::default());
        // A support that is narrower than a tile gets its axes picked once, for the one or two tiles that it lies in.
        let aligned = columns.start / TILE * TILE..columns.end.next_multiple_of(TILE);
        let group = if columns.len() <= TILE {
            aligned.len()
        } else {
            TILE
        };
        for first in aligned.step_by(group) {
            let ends = [first, first + group - 1].map(|column| (grid.xs[column] - center.x) as f32);
            let mut pairs = self.blocks.iter().zip(active.iter_mut());
            if !pairs.all(|(block, active)| select_axes(simd, block, ends, &y, active)) {
                continue;
            }
            for start in (first..first + group).step_by(TILE) {
                tile.start = start;
                narrow_offsets(simd, &grid.xs[start..start + TILE], center.x, &mut tile.x);
                self.add_to_tile(simd, sink, &tile, active, planes);
            }
        }
    }

    /// The stretch of x, as seen from the center, outside of which no pixel of the rows `y` has a weight. Nothing if
    /// none has.
    #[inline(always)]
    fn reach<S: Simd>(&self, simd: S, y: &[f32; ROWS]) -> Option<[f32; 2]> {
        // What three roundings can add to a quotient.
        const SLACK: f32 = 4.0 * f32::EPSILON;
        let zero = f32x8::splat(simd, 0.0);
        let one = f32x8::splat(simd, 1.0);
        let far = f32x8::splat(simd, f32::INFINITY);
        let (mut from, mut to) = (f32::NEG_INFINITY, f32::INFINITY);
        for block in self.blocks {
            let ax = f32x8::from_slice(simd, &block.x);
            let ay = f32x8::from_slice(simd, &block.y);
            let [top, bottom] = [y[0], y[ROWS - 1]].map(|y| one - ay * y);
            let most = top.max(bottom);
            let bound = most / ax;
            let bound = bound + bound.abs() * SLACK * ax.simd_ge(zero).select(one, zero - one);
            to = to.min(ax.simd_gt(zero).select(bound, far).reduce_min());
            from = from.max(ax.simd_lt(zero).select(bound, zero - far).reduce_max());
        }
        (from <= to).then_some([from, to])
    }

    /// Adds the weights of one tile.
    #[inline(always)]
    fn add_to_tile<S: Simd, K: Sink>(
        &self,
        simd: S,
        sink: &K,
        tile: &Tile,
        blocks: &[ActiveBlock],
        planes: &mut Planes,
    ) {
        for column in (0..TILE).step_by(S::f32s::LEN) {
            let first = tile.start + column;
            if first >= tile.columns.end || first + S::f32s::LEN <= tile.columns.start {
                continue;
            }
            // A row takes two registers, and an axis a few: 32 registers of 16 lanes hold all rows, 16 registers four.
            match tile.halves {
                [true, true] if S::f32s::LEN >= 16 => {
                    self.add_rows::<S, K, ROWS>(simd, sink, tile, blocks, planes, [column, 0]);
                }
                [upper, lower] => {
                    if upper {
                        self.add_rows::<S, K, 4>(simd, sink, tile, blocks, planes, [column, 0]);
                    }
                    if lower {
                        self.add_rows::<S, K, 4>(simd, sink, tile, blocks, planes, [column, 4]);
                    }
                }
            }
        }
    }

    /// Adds the weights of a register's columns in `N` rows.
    #[inline(always)]
    fn add_rows<S: Simd, K: Sink, const N: usize>(
        &self,
        simd: S,
        sink: &K,
        tile: &Tile,
        blocks: &[ActiveBlock],
        planes: &mut Planes,
        [column, first_row]: [usize; 2],
    ) {
        let x = S::f32s::from_slice(simd, &tile.x[column..column + S::f32s::LEN]);
        let mut weights = [S::f32s::splat(simd, 1.0); N];
        for (index, block) in blocks.iter().enumerate() {
            let products = self.block_products::<S, N>(simd, block, x, first_row);
            for (weight, product) in weights.iter_mut().zip(products) {
                *weight = if index == 0 {
                    product
                } else {
                    *weight * product
                };
            }
        }
        for (row, weight) in (first_row..).zip(weights) {
            let weight = match self.shift {
                Some(shift) => {
                    let y = S::f32s::splat(simd, tile.y[row]);
                    shift_weight(simd, weight, shift, x, y)
                }
                None => weight,
            };
            let at = row * planes.stride + tile.start + column;
            sink.add(simd, self.instance.point, weight, planes, at);
        }
    }

    /// The products of the axial weights of a block, in `N` rows.
    #[inline(always)]
    fn block_products<S: Simd, const N: usize>(
        &self,
        simd: S,
        block: &ActiveBlock,
        x: S::f32s,
        first_row: usize,
    ) -> [S::f32s; N] {
        let zero = S::f32s::splat(simd, 0.0);
        let one = S::f32s::splat(simd, 1.0);
        let mut q = [one; N];
        let mut t = [one; N];
        for axis in &block.axes[..block.n] {
            let along = x * axis.x;
            let rest = &axis.rest[first_row..first_row + N];
            for row in 0..N {
                let u = S::f32s::splat(simd, rest[row]) - along;
                (q[row], t[row]) = self.profile.step(q[row], t[row], u.max(zero).min(one));
            }
        }
        core::array::from_fn(|row| self.profile.finish(q[row], t[row], block.n))
    }
}
/// The columns as seen from the center, rounded to single precision.
#[inline(always)]
fn narrow_offsets<S: Simd>(simd: S, xs: &[f64], center: f64, offsets: &mut [f32; TILE]) {
    let half = S::f64s::LEN;
    for column in (0..TILE).step_by(2 * half) {
        let low = S::f64s::from_slice(simd, &xs[column..column + half]) - center;
        let high = S::f64s::from_slice(simd, &xs[column + half..column + 2 * half]) - center;
        low.narrow(high)
            .store_slice(&mut offsets[column..column + 2 * half]);
    }
}

/// Picks the axes of a block that are neither 1 nor 0 over the whole tile. False if one of them is 0: then the control
/// point has no weight in the tile.
#[inline(always)]
fn select_axes<S: Simd>(
    simd: S,
    block: &AxisBlock,
    ends: [f32; 2],
    y: &[f32; ROWS],
    active: &mut ActiveBlock,
) -> bool {
    let one = f32x8::splat(simd, 1.0);
    let ax = f32x8::from_slice(simd, &block.x);
    let ay = f32x8::from_slice(simd, &block.y);
    let [left, right] = ends.map(|x| ax * x);
    let [top, bottom] = [y[0], y[ROWS - 1]].map(|y| one - ay * y);
    let zero = f32x8::splat(simd, 0.0);
    let least = top.min(bottom) - left.max(right);
    let most = top.max(bottom) - left.min(right);
    if most.simd_le(zero).any_true() {
        return false;
    }
    let y = f32x8::from_slice(simd, y);
    let mut bits = least.simd_lt(one).to_bitmask();
    active.n = 0;
    while bits != 0 {
        let axis = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let slot = &mut active.axes[active.n];
        slot.x = block.x[axis];
        (one - y * block.y[axis]).store_slice(&mut slot.rest);
        active.n += 1;
    }
    true
}

/// Equation 4: `w^(1 − K)` where the position lies on the side of the orientation, `w^(1 / (1 + K))` on the other.
///
/// With `n = ε (x − c)·v` and `d = |x − c|` both exponents are `(d − max(n, 0)) / (d + min(n, 0))`. At the control
/// point itself the angle has no meaning; there the weight is 1 and stays so.
#[inline(always)]
pub(crate) fn shift_weight<S: Simd>(
    simd: S,
    weight: S::f32s,
    shift: [f32; 2],
    x: S::f32s,
    y: S::f32s,
) -> S::f32s {
    let zero = S::f32s::splat(simd, 0.0);
    let distance = (x * x + y * y).sqrt();
    let along = x * shift[0] + y * shift[1];
    let exponent = (distance - along.max(zero)) / (distance + along.min(zero));
    let exponent = distance
        .simd_gt(zero)
        .select(exponent, S::f32s::splat(simd, 1.0));
    power(simd, weight, exponent)
}
