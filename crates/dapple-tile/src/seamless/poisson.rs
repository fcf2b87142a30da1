//! The image whose gradients are nearest to those of the source, once around the torus.
//!
//! Source: the guided interpolation of Patrick Pérez, Michel Gangnet and Andrew Blake, "Poisson image editing", ACM
//! Transactions on Graphics 22 (SIGGRAPH 2003), <https://doi.org/10.1145/882262.882269>, here without a boundary: a
//! torus has none.
//!
//! The target is a field of differences between neighbors: inside they are those of the source, across the wrap
//! [`WrapGradient`] chooses them. The result is nearest to the field by least squares, and keeps the mean. Along an
//! axis that does not repeat, the ends are free.
//!
//! Inside, the source meets the field already; what remains is the error across the wrap. So the result is the source
//! minus the smooth part of [`periodic`](super::periodic), with that error in place of the jump. With
//! [`WrapGradient::Zero`] error and jump are the same, and so are both methods, bit for bit.

use super::periodic::{border, jumps, without_jumps};
use crate::TileError;
use dapple_raster::Raster;

dapple_raster::named! {
    /// The target gradient across the wrap, where the source has none.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum WrapGradient {
        /// None: the last pixel continues to the first. The same image as [`Method::Periodic`](crate::Method::Periodic).
        #[default]
        Zero = "zero",
        /// The mean of the gradients just inside of the two borders.
        Extrapolate = "extrapolate",
    }
}

/// The tiles of all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    wrap: WrapGradient,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    let tile = |plane| {
        let error = |axis: usize| axes[axis].then(|| wrap_errors(plane, wrap, axis));
        without_jumps(plane, &[error(0), error(1)])
    };
    planes.iter().map(tile).collect()
}

/// The target gradient across the wrap minus the actual one, for each pixel of a border.
fn wrap_errors(plane: &Raster<f32>, wrap: WrapGradient, axis: usize) -> Vec<f64> {
    let mut errors = jumps(plane, axis);
    if wrap == WrapGradient::Extrapolate {
        let last = plane.size()[axis] - 1;
        // With one pixel there is no second one, and the gradient is zero.
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
