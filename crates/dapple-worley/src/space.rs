//! Marker types for spaces of two, three and four dimensions, and their vectors.

use crate::dispatch::DimensionDispatch;
use core::fmt;
use glam::{DVec2, DVec3, DVec4};

/// Marker type on which [`Space`] is implemented for each number of axes.
#[derive(Debug)]
pub struct Dimensions;

/// A space with `N` axes. [`Dimensions`] implements it for 2, 3 and 4; other implementations are not possible.
pub trait Space<const N: usize>: DimensionDispatch<N> {
    /// The vector type: `DVec2`, `DVec3` or `DVec4`.
    type Vector: Copy + fmt::Debug + PartialEq + From<[f64; N]> + Into<[f64; N]> + Send + Sync;
}

/// The vector type of the space with `N` axes.
pub type Vector<const N: usize> = <Dimensions as Space<N>>::Vector;

impl Space<2> for Dimensions {
    type Vector = DVec2;
}

impl Space<3> for Dimensions {
    type Vector = DVec3;
}

impl Space<4> for Dimensions {
    type Vector = DVec4;
}
