//! The weight of one control point over a tile of pixels.
//!
//! A tile is [`TILE`] columns by [`ROWS`] rows. For the cubic, the product of axial weights `u² (3 − 2u)` is kept as two
//! products, `q = Π u` and `t = Π (u − 3/2)`, so that an axis costs five operations: `W = q² · t · (−2)^k`, where the
//! power of two is exact. An axis whose `u` is 1 over the whole tile is left out, which changes no bit; a control point
//! with an axis whose `u` is 0 over the whole tile has no weight there. Both are decided with the very numbers that the
//! pixels would get, since rounding is monotonic.

use crate::net::{AxisBlock, BLOCK, Instance};
use crate::power::power;
use crate::weight::{AxialWeight, Lane};
use fearless_simd::{f32x8, prelude::*};

/// Columns of a tile: a register at the widest level.
pub(crate) const TILE: usize = 16;

/// Rows of a tile.
pub(crate) const ROWS: usize = 8;

/// The pixels of one plane of a tile, row by row.
pub(crate) const TILE_PIXELS: usize = TILE * ROWS;

/// Rows that are kept in registers at a time.
const STRIP: usize = 4;

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

/// What becomes of the weights of a tile.
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

    /// Takes in the weights of control point `point` for the pixels from `at` on, in every plane.
    fn add<S: Simd>(&self, simd: S, point: u32, weight: S::f32s, planes: &mut [f32], at: usize);

    /// Makes the values of up to [`TILE`] pixels. Plane `k` of pixel `i` is `planes[k * TILE_PIXELS + i]`; `nearest(i)`
    /// is the control point nearest to pixel `i`, for where no weight is left.
    fn resolve<S: Simd>(
        &self,
        simd: S,
        planes: &[f32],
        values: &mut [Self::Value],
        nearest: impl Fn(usize) -> u32,
    );

    /// What stands for a value at a position that is not finite.
    fn undefined(&self) -> Self::Value;
}

/// The columns and rows of a tile, seen from a control point.
struct Offsets {
    x: [f32; TILE],
    y: [f32; ROWS],
}

/// An axis that matters in a tile: its x, and `1 − a_y d_y` for every row.
#[derive(Clone, Copy, Default)]
struct ActiveAxis {
    x: f32,
    rest: [f32; ROWS],
}

/// The axes of one block that matter in a tile.
#[derive(Clone, Copy, Default)]
struct ActiveBlock {
    axes: [ActiveAxis; BLOCK],
    n: usize,
}

/// What one control point brings to a row of tiles.
#[derive(Clone, Copy)]
pub(crate) struct Splat<'a, P> {
    pub(crate) profile: P,
    pub(crate) instance: &'a Instance,
    pub(crate) blocks: &'a [AxisBlock],
    /// ε times the orientation in the plane.
    pub(crate) shift: Option<[f32; 2]>,
}

impl<P: Profile> Splat<'_, P> {
    /// Adds the weights of this control point to the tiles from `first` to before `end`.
    ///
    /// `columns` are the coordinates of all columns, a multiple of [`TILE`] of them, in ascending or descending order;
    /// `rows` those of the rows. `planes` holds the tiles one after another.
    #[inline(always)]
    pub(crate) fn add_to<S: Simd, K: Sink>(
        &self,
        simd: S,
        sink: &K,
        columns: &[f64],
        rows: &[f64; ROWS],
        tiles: core::ops::Range<usize>,
        planes: &mut [f32],
    ) {
        let center = self.instance.center;
        let y = rows.map(|row| (row - center.y) as f32);
        let tile_length = sink.n_planes() * TILE_PIXELS;
        for tile in tiles {
            let columns = &columns[tile * TILE..(tile + 1) * TILE];
            let ends = [columns[0], columns[TILE - 1]].map(|column| (column - center.x) as f32);
            let planes = &mut planes[tile * tile_length..(tile + 1) * tile_length];
            let mut first = ActiveBlock::default();
            match self.blocks {
                [only] => {
                    if select_axes(simd, only, ends, &y, &mut first) {
                        let offsets = Offsets {
                            x: narrow_offsets(simd, columns, center.x),
                            y,
                        };
                        self.add_to_tile(simd, sink, &offsets, &[first], planes);
                    }
                }
                blocks => {
                    let mut active = Vec::with_capacity(blocks.len());
                    let reached = blocks.iter().all(|block| {
                        active.push(first);
                        active
                            .last_mut()
                            .is_some_and(|active| select_axes(simd, block, ends, &y, active))
                    });
                    if reached {
                        let offsets = Offsets {
                            x: narrow_offsets(simd, columns, center.x),
                            y,
                        };
                        self.add_to_tile(simd, sink, &offsets, &active, planes);
                    }
                }
            }
        }
    }

    /// Adds the weights of one tile.
    #[inline(always)]
    fn add_to_tile<S: Simd, K: Sink>(
        &self,
        simd: S,
        sink: &K,
        offsets: &Offsets,
        blocks: &[ActiveBlock],
        planes: &mut [f32],
    ) {
        for column in (0..TILE).step_by(S::f32s::LEN) {
            let x = S::f32s::from_slice(simd, &offsets.x[column..column + S::f32s::LEN]);
            for row in (0..ROWS).step_by(STRIP) {
                let mut weights = [S::f32s::splat(simd, 1.0); STRIP];
                for (index, block) in blocks.iter().enumerate() {
                    let product = self.block_product(simd, block, x, row);
                    for (weight, product) in weights.iter_mut().zip(product) {
                        *weight = if index == 0 {
                            product
                        } else {
                            *weight * product
                        };
                    }
                }
                for (strip_row, weight) in weights.into_iter().enumerate() {
                    let weight = match self.shift {
                        Some(shift) => {
                            let y = S::f32s::splat(simd, offsets.y[row + strip_row]);
                            shift_weight(simd, weight, shift, x, y)
                        }
                        None => weight,
                    };
                    sink.add(
                        simd,
                        self.instance.point,
                        weight,
                        planes,
                        (row + strip_row) * TILE + column,
                    );
                }
            }
        }
    }

    /// The product of the axial weights of a block, for [`STRIP`] rows from `row`.
    #[inline(always)]
    fn block_product<S: Simd>(
        &self,
        simd: S,
        block: &ActiveBlock,
        x: S::f32s,
        row: usize,
    ) -> [S::f32s; STRIP] {
        let zero = S::f32s::splat(simd, 0.0);
        let one = S::f32s::splat(simd, 1.0);
        let mut q = [one; STRIP];
        let mut t = [one; STRIP];
        for axis in &block.axes[..block.n] {
            let along = x * axis.x;
            for strip_row in 0..STRIP {
                let u = (S::f32s::splat(simd, axis.rest[row + strip_row]) - along)
                    .max(zero)
                    .min(one);
                (q[strip_row], t[strip_row]) = self.profile.step(q[strip_row], t[strip_row], u);
            }
        }
        core::array::from_fn(|strip_row| self.profile.finish(q[strip_row], t[strip_row], block.n))
    }
}

/// The columns as seen from the center, rounded to single precision.
#[inline(always)]
fn narrow_offsets<S: Simd>(simd: S, columns: &[f64], center: f64) -> [f32; TILE] {
    let mut offsets = [0.0; TILE];
    let half = S::f64s::LEN;
    for column in (0..TILE).step_by(2 * half) {
        let low = S::f64s::from_slice(simd, &columns[column..column + half]) - center;
        let high = S::f64s::from_slice(simd, &columns[column + half..column + 2 * half]) - center;
        low.narrow(high)
            .store_slice(&mut offsets[column..column + 2 * half]);
    }
    offsets
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
    let least = top.min(bottom) - left.max(right);
    let most = top.max(bottom) - left.min(right);
    if most.simd_le(f32x8::splat(simd, 0.0)).any_true() {
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
