//! Fixed-point positions: a cell and an integer number of steps within it.
//!
//! All search methods use these coordinates. A coordinate is rounded down to a multiple of 2^-21 of a cell; the
//! coordinates of feature points are such multiples, too. So differences are exact integers, whatever the points'
//! positions and the corner that is their origin. Only the difference is rounded to `f32`, once; below 8 cells it is
//! exact even then. So searches of one position, of many positions and of a window agree to the last bit, and an image
//! at 1e9 is as sharp as at 0.

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

/// Returns the first `N` components.
#[inline(always)]
pub(crate) fn first_axes<T: Copy, const N: usize>(parts: [T; MOST_AXES]) -> [T; N] {
    core::array::from_fn(|axis| parts[axis])
}

/// Converts steps to cells, rounded to `f32` once.
#[inline(always)]
pub(crate) fn cells(steps: i64) -> f32 {
    steps as f32 * STEP
}
