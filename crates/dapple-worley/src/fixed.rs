//! Fixed-point positions: a cell and a whole number of steps within it.
//!
//! All methods use these coordinates. A coordinate is rounded down to a multiple of 2^-21 of a cell, and so are the
//! coordinates of feature points. Their differences are then exact whole numbers, wherever they are and from whichever
//! corner they are counted, and only the difference is rounded, once, to `f32` (below 8 cells not even that). So the
//! single position, the many positions and the window agree to the last bit, and a picture at 1e9 is as sharp as at 0.

/// The binary logarithm of the steps of a cell.
pub(crate) const STEP_BITS: u32 = 21;

/// The steps of a cell, along each axis.
pub(crate) const STEPS: i32 = 1 << STEP_BITS;

/// The size of a step, in cells.
pub(crate) const STEP: f32 = 1.0 / STEPS as f32;

/// The farthest coordinate that has a cell: the neighbors of a cell must be whole numbers too.
pub(crate) const FARTHEST: f64 = (1_u64 << 62) as f64;

/// A position: the cell that it is in, and the steps from the cell's lower corner, `0..STEPS`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place<const N: usize> {
    pub(crate) cell: [i64; N],
    pub(crate) steps: [i32; N],
}

/// A place in a space with any number of axes; the coordinates of missing axes are zero.
pub(crate) type FlatPlace = Place<MOST_AXES>;

/// The most axes of a space.
pub(crate) const MOST_AXES: usize = 4;

impl<const N: usize> Place<N> {
    /// The place of a position in cells, or `None` if a coordinate is not finite or further out than 2^62.
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

/// The cell of a coordinate and the steps from its lower edge.
#[inline]
pub(crate) fn split(coordinate: f64) -> Option<(i64, i32)> {
    // This comparison is false for NaN.
    let has_cell = coordinate.abs() <= FARTHEST;
    if !has_cell {
        return None;
    }
    // Not `floor`, which is a function call on processors without an instruction for it.
    let truncated = coordinate as i64;
    let floor = truncated - i64::from(truncated as f64 > coordinate);
    let steps = ((coordinate - floor as f64) * f64::from(STEPS)) as i32;
    // Just below a whole number the difference can be rounded up to a whole cell.
    let carry = steps >> STEP_BITS;
    Some((floor + i64::from(carry), steps - (carry << STEP_BITS)))
}

/// The components along the axes of a space.
#[inline(always)]
pub(crate) fn first_axes<T: Copy, const N: usize>(parts: [T; MOST_AXES]) -> [T; N] {
    core::array::from_fn(|axis| parts[axis])
}

/// A number of steps as cells, rounded to `f32` once.
#[inline(always)]
pub(crate) fn cells(steps: i64) -> f32 {
    steps as f32 * STEP
}
