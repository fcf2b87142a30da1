//! Evaluates noise at many positions, sixteen at a time in SIMD lanes.
//!
//! The operations are the same as for a single position, in the same order, so that the bits are equal.

use crate::GradientNoise;
use crate::gradient::{MOST_CORNERS, Place, SHIFT, corners};
use crate::gradients::gradient_lanes;
use dapple_hash::{lattice_bits, lattice_parts};
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, f32x16, prelude::*, u32x16};

/// Number of positions in a register.
const LANES: usize = 16;

/// Positions nearer to the origin than this have cells, and next cells, that fit 32 bits.
const NEAR: f64 = 2_147_483_646.0;

/// The cells and offsets of sixteen positions along one axis.
struct Line {
    cells: [u32; LANES],
    /// Next cell after each position's cell, wrapped by the period.
    next: [u32; LANES],
    offsets: [f32; LANES],
}

/// Computes the value at each position.
pub(crate) fn fill<const N: usize, P: Copy + Into<[f64; N]>>(
    noise: &GradientNoise<N>,
    level: Level,
    positions: &[P],
    values: &mut [f32],
) {
    dispatch!(level, simd => fill_with(simd, noise, positions, values));
}

#[inline(always)]
fn fill_with<S: Simd, const N: usize, P: Copy + Into<[f64; N]>>(
    simd: S,
    noise: &GradientNoise<N>,
    positions: &[P],
    values: &mut [f32],
) {
    let has_words = (0..N).all(|axis| axis_of(noise, axis).1 <= 1 << 31);
    for (positions, values) in positions.chunks(LANES).zip(values.chunks_mut(LANES)) {
        let mut coordinates = [[0.0; LANES]; N];
        for (lane, &position) in positions.iter().enumerate() {
            let position = position.into();
            for axis in 0..N {
                coordinates[axis][lane] = noise.moved(position[axis], axis);
            }
        }
        // Coordinates of corners must fit signed 32-bit integers; otherwise sample the positions one by one.
        let mut is_near = has_words;
        for line in &coordinates {
            for x in line {
                is_near &= x.abs() < NEAR;
            }
        }
        if is_near {
            let found = value(simd, noise, &coordinates);
            values.copy_from_slice(&found.as_slice()[..values.len()]);
        } else {
            for (value, &position) in values.iter_mut().zip(positions) {
                *value = noise.sample(position);
            }
        }
    }
}

/// Returns the noise values at sixteen positions nearer to the origin than [`NEAR`].
#[inline(always)]
fn value<S: Simd, const N: usize>(
    simd: S,
    noise: &GradientNoise<N>,
    coordinates: &[[f64; LANES]; N],
) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    // Loops are inlined into the code of a SIMD level; closures are not always inlined.
    let mut parts = [[u32x16::splat(simd, 0); 2]; N];
    let mut offsets = [f32x16::splat(simd, 0.0); N];
    for axis in 0..N {
        let (key, period) = axis_of(noise, axis);
        let line = Line::new(&coordinates[axis], period);
        offsets[axis] = f32x16::from_slice(simd, &line.offsets);
        let cells = u32x16::from_slice(simd, &line.cells);
        let next = u32x16::from_slice(simd, &line.next);
        parts[axis] = lattice_parts(simd, key, [cells, next]);
    }
    // For each column and corner: the slope along the first axis, and the value from the other axes
    let mut columns = [[[f32x16::splat(simd, 0.0); 2]; MOST_CORNERS]; 2];
    for index in 0..corners(N) {
        let mut row = u32x16::splat(simd, 0);
        for axis in 1..N {
            row ^= parts[axis][index >> (axis - 1) & 1];
        }
        let bits = lattice_bits([row ^ parts[0][0], row ^ parts[0][1]]);
        for side in 0..2 {
            let gradient = gradient_lanes::<S, N>(simd, bits[side]);
            let mut value = f32x16::splat(simd, 0.0);
            for axis in 1..N {
                let is_far = index >> (axis - 1) & 1 == 1;
                let offset = if is_far {
                    offsets[axis] - one
                } else {
                    offsets[axis]
                };
                value += gradient[axis] * offset;
            }
            columns[side][index] = [gradient[0], value];
        }
    }
    // Blend the columns along the other axes, then between the two sides.
    for axis in 1..N {
        let by = fade(offsets[axis]);
        for column in &mut columns {
            for pair in 0..corners(N) >> axis {
                let [near, far] = [column[2 * pair], column[2 * pair + 1]];
                column[pair] = [
                    near[0] + by * (far[0] - near[0]),
                    near[1] + by * (far[1] - near[1]),
                ];
            }
        }
    }
    let [[left, ..], [right, ..]] = columns;
    let t = offsets[0];
    let near = left[0] * t + left[1];
    let far = right[0] * (t - one) + right[1];
    near + fade(t) * (far - near)
}

/// Returns the hash key of an axis, and its period in cells (0 for no period).
const fn axis_of<const N: usize>(noise: &GradientNoise<N>, axis: usize) -> (u32, u32) {
    (noise.hash.key(axis), noise.period[axis])
}

/// Returns the cell and offset of a coordinate below 2^51 in absolute value, and its floor. Uses operations that
/// vectorize, since `floor` is a function call at the lowest SIMD level of x86-64.
#[inline(always)]
fn near(coordinate: f64) -> (Place, f64) {
    let shifted = coordinate + SHIFT;
    let nearest = shifted - SHIFT;
    let is_past = nearest > coordinate;
    let floor = nearest - if is_past { 1.0 } else { 0.0 };
    let cell = shifted.to_bits().wrapping_sub(SHIFT.to_bits());
    let place = Place {
        cell: cell.cast_signed() - i64::from(is_past),
        // Adding 0 turns a negative zero into zero.
        offset: (coordinate - floor + 0.0) as f32,
    };
    (place, floor)
}

impl Line {
    /// Computes the cells of coordinates nearer to the origin than [`NEAR`], wrapped by `period` if it is not 0.
    #[inline(always)]
    fn new(coordinates: &[f64; LANES], period: u32) -> Self {
        let mut line = Self {
            cells: [0; LANES],
            next: [0; LANES],
            offsets: [0.0; LANES],
        };
        for lane in 0..LANES {
            let (place, _) = near(coordinates[lane]);
            line.cells[lane] = place.cell as u32;
            line.next[lane] = line.cells[lane].wrapping_add(1);
            line.offsets[lane] = place.offset;
        }
        if period > 0 {
            let whole = f64::from(period);
            let inverse = 1.0 / whole;
            for cell in &mut line.cells {
                let number = f64::from(cell.cast_signed());
                // The quotient is off by at most one, and all products are integers below 2^53.
                let mut rest = number - near(number * inverse).1 * whole;
                rest += if rest < 0.0 { whole } else { 0.0 };
                rest -= if rest >= whole { whole } else { 0.0 };
                *cell = rest as u32;
            }
            for (next, &cell) in line.next.iter_mut().zip(&line.cells) {
                *next = if cell == period - 1 { 0 } else { cell + 1 };
            }
        }
        line
    }
}

/// Computes Perlin's quintic fade function in every lane.
#[inline(always)]
fn fade<S: Simd>(t: f32x16<S>) -> f32x16<S> {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}
