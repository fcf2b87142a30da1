//! Fixed-point positions: a cell and an integer number of steps within it.
//!
//! All search methods use these coordinates. A coordinate is rounded down to a multiple of 2^-21 of a cell; the
//! coordinates of feature points are such multiples, too. Differences are therefore exact integers, wherever the
//! points are and whichever corner is the origin. A difference is rounded to `f32` once; below 8 cells, even that is
//! exact. Searches of one position, of many positions and of a window thus agree to the last bit, and an image at 1e9
//! is as sharp as at 0.

/// Binary logarithm of the number of steps in a cell.
pub(crate) const STEP_BITS: u32 = 21;

/// Number of steps in a cell, along each axis.
pub(crate) const STEPS: i32 = 1 << STEP_BITS;

/// Size of a step, in cells.
pub(crate) const STEP: f32 = 1.0 / STEPS as f32;

/// Maximum magnitude of a coordinate, in cells. The indices of the neighboring cells must fit into `i64`, too.
pub(crate) const FARTHEST: f64 = (1_u64 << 62) as f64;

/// A fixed-point position: its cell, and its steps from the cell's lower corner, in `0..STEPS`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place<const N: usize> {
    pub(crate) cell: [i64; N],
    pub(crate) steps: [i32; N],
}

/// A [`Place`] in a space with any number of axes. Coordinates along missing axes are zero.
pub(crate) type FlatPlace = Place<MOST_AXES>;

/// Maximum number of axes in a space.
pub(crate) const MOST_AXES: usize = 4;

impl<const N: usize> Place<N> {
    /// Converts a position in cells. Returns `None` if a coordinate is not finite or its magnitude is above 2^62.
    #[inline]
    pub(crate) fn new(position: [f64; N]) -> Option<Self> {
        let mut place = Self {
            cell: [0; N],
            steps: [0; N],
        };
        for axis in 0..N {
            (place.cell[axis], place.steps[axis]) = split(position[axis])?;
        }
        Some(place)
    }
}

/// Splits a coordinate into its cell and the steps from the cell's lower edge; `None` as in [`Place::new`].
#[inline]
pub(crate) fn split(coordinate: f64) -> Option<(i64, i32)> {
    if coordinate.abs() < NEAR {
        return Some(split_near(coordinate));
    }
    split_far(coordinate)
}

/// Magnitude below which coordinates are split by [`split_near`]: their steps are below 2^51.
const NEAR: f64 = (1_u64 << 30) as f64;

/// 1.5 · 2^52. All `f64` within a quarter of it are integers, and their low bits hold the difference from this number.
pub(crate) const WHOLE: f64 = (3_u64 << 51) as f64;

/// Splits a coordinate without converting between integers and floating point, since conversions would dominate the
/// time.
#[inline]
fn split_near(mut coordinate: f64) -> (i64, i32) {
    // Below zero, `split_far` rounds to the precision of numbers up to one.
    if coordinate < 0.0 && coordinate > -0.5 {
        coordinate = (coordinate + 1.0) - 1.0;
    }
    // Scaling by a power of two is exact.
    let steps = coordinate * f64::from(STEPS);
    // Round to the nearest integer, then down.
    let nearest = steps + WHOLE;
    let is_above = nearest - WHOLE > steps;
    let whole = nearest
        .to_bits()
        .wrapping_sub(WHOLE.to_bits())
        .cast_signed()
        - i64::from(is_above);
    (whole >> STEP_BITS, whole as i32 & (STEPS - 1))
}

/// Splits a coordinate of any magnitude.
#[inline(never)]
fn split_far(coordinate: f64) -> Option<(i64, i32)> {
    // This comparison is false for NaN.
    let has_cell = coordinate.abs() <= FARTHEST;
    if !has_cell {
        return None;
    }
    // Avoid `floor`, which is a function call on processors without an instruction for it.
    let truncated = coordinate as i64;
    let floor = truncated - i64::from(truncated as f64 > coordinate);
    let steps = ((coordinate - floor as f64) * f64::from(STEPS)) as i32;
    // Just below an integer, the difference can be rounded up to a whole cell.
    let carry = steps >> STEP_BITS;
    Some((floor + i64::from(carry), steps - (carry << STEP_BITS)))
}

/// Returns the components along the first `N` axes.
#[inline(always)]
pub(crate) fn first_axes<T: Copy, const N: usize>(parts: [T; MOST_AXES]) -> [T; N] {
    core::array::from_fn(|axis| parts[axis])
}

/// Converts steps to cells, rounded to `f32` once.
#[inline(always)]
pub(crate) fn cells(steps: i64) -> f32 {
    steps as f32 * STEP
}
