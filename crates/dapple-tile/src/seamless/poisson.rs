//! Computes the periodic image whose gradients are nearest to the source's gradients.
//!
//! Source: the guided interpolation of Patrick Pérez, Michel Gangnet and Andrew Blake, "Poisson image editing", ACM
//! Transactions on Graphics 22 (SIGGRAPH 2003), <https://doi.org/10.1145/882262.882269>, here without a boundary, since
//! a torus has none.
//!
//! The target is a field of differences between neighbors. Inside, these are the differences of the source; across the
//! wrap, they are the differences that [`WrapGradient`] selects. The result is nearest to the field by least squares,
//! and has the same mean as the source. Along an axis that does not repeat, the ends are unconstrained.
//!
//! Inside, the source satisfies the field exactly, so the only error is across the wrap. The result is the source minus
//! the smooth part of [`periodic`](super::periodic), with that error instead of the jump. With [`WrapGradient::Zero`],
//! the error equals the jump, and both methods give the same bits.

use super::periodic::{border, jumps, without_jumps};
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;

dapple_raster::named! {
    /// Target gradient across the wrap, where the source has none.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum WrapGradient {
        /// Zero: the last pixel continues to the first. The result is the same image as
        /// [`Method::Periodic`](crate::Method::Periodic).
        #[default]
        Zero = "zero",
        /// Mean of the gradients just inside of the two borders.
        Extrapolate = "extrapolate",
    }
}

/// Makes tiles from all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    wrap: WrapGradient,
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let tile = |plane| {
        let error = |axis: usize| axes[axis].then(|| wrap_errors(plane, wrap, axis));
        without_jumps(plane, &[error(0), error(1)], is_cancelled)
    };
    planes.iter().map(tile).collect()
}

/// Returns the target gradient across the wrap minus the actual one, for each pixel of a border.
fn wrap_errors(plane: &Raster<f32>, wrap: WrapGradient, axis: usize) -> Vec<f64> {
    let mut errors = jumps(plane, axis);
    if wrap == WrapGradient::Extrapolate {
        // The target is the mean of the gradients at both borders.
        let last = plane.size()[axis] - 1;
        // An axis of one pixel has no second pixel. Its gradient is then zero.
        let second = last.min(1);
        for (index, sign) in [(0, -0.5), (second, 0.5), (last - second, -0.5), (last, 0.5)] {
            for (error, value) in errors.iter_mut().zip(border(plane, axis, index)) {
                *error += sign * value;
            }
        }
    }
    errors
}

#[cfg(test)]
mod tests;
