//! The neighborhoods of an exemplar, as rows of numbers.

use crate::neighborhood::{Part, Pass};
use crate::{Pyramid, SynthError};

/// Where a neighborhood on the coarser level is centered, for a pixel whose coordinates halved are not whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CoarserCenter {
    /// At exactly half of the coordinates, with values between pixels (bilinear).
    #[default]
    Exact,
    /// At half of the coordinates, rounded down, as the paper has it: four pixels share their neighborhood.
    Floor,
}

/// All neighborhoods that a pass compares with.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidates {
    /// Values of one neighborhood: offsets times channels, part after part.
    pub(crate) dims: usize,
    /// One row after the other, each value times the root of its part's weight.
    pub(crate) rows: Vec<f32>,
    /// The pixel of each row, as `row * width + column` of the pass' level of the pyramid; ascending.
    pub(crate) pixels: Vec<u32>,
}

impl Candidates {
    /// The neighborhoods of all pixels of the pass' level that do not reach past an edge.
    ///
    /// # Errors
    ///
    /// Typed errors for a level that the pyramid does not have or that is too small, and for parts out of their ranges.
    pub fn new(pyramid: &Pyramid, pass: &Pass, center: CoarserCenter) -> Result<Self, SynthError> {
        let _ = (pyramid, pass, center);
        let _: Option<Part> = None;
        todo!()
    }

    /// The number of values of a neighborhood.
    #[must_use]
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// The number of neighborhoods.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// One neighborhood.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    #[must_use]
    pub fn row(&self, row: usize) -> &[f32] {
        &self.rows[row * self.dims..(row + 1) * self.dims]
    }
}
