//! Noise bands, which are scaled and shifted copies of the tile.

use super::place::{Period, Place, floor};
use dapple_hash::{Seed, hash1};

/// A band of wavelet noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band<const N: usize> {
    pub(super) weight: f32,
    /// Number of cells of this band per cell of the first band: a power of two.
    pub(super) frequency: f64,
    /// Offset of the tile along each axis, in cells; from 0 to below the tile's size. Zero for the first band.
    pub(super) offset: [f64; N],
}

impl<const N: usize> Band<N> {
    /// Creates a band for every weight that is not zero.
    pub(super) fn all(weights: &[f32], size: [u32; N], seed: Seed) -> Vec<Self> {
        let bands = (0_u64..).zip(weights);
        let bands = bands.filter(|(_, weight)| **weight != 0.0);
        bands
            .map(|(index, &weight)| Self::new(index, weight, size, seed))
            .collect()
    }

    fn new(index: u64, weight: f32, size: [u32; N], seed: Seed) -> Self {
        let seed = seed.child("wavelet noise offset", index);
        let offset = |axis: usize| hash1(seed, [axis as i64], 0) % u64::from(size[axis]);
        Self {
            weight,
            frequency: (1_u64 << index) as f64,
            offset: match index {
                0 => [0.0; N],
                _ => core::array::from_fn(|axis| offset(axis) as f64),
            },
        }
    }

    /// Converts tile coordinates of the noise to tile coordinates of this band.
    #[inline(always)]
    pub(super) fn places(&self, periods: [Period; N], mut places: [Place; N]) -> [Place; N] {
        for (axis, place) in places.iter_mut().enumerate() {
            *place = self.place(periods[axis], *place, axis);
        }
        places
    }

    /// Converts a tile coordinate of the noise along one axis, with the given period, to this band's.
    #[inline(always)]
    pub(super) fn place(&self, period: Period, place: Place, axis: usize) -> Place {
        // The first band is the noise itself.
        if self.frequency == 1.0 {
            return place;
        }
        let fine = self.frequency * place.fraction;
        let whole = floor(fine);
        Place {
            // All parts are integers below 2^41: a side has at most 2^25 cells, and a band at most 2^15 of its cells
            // in one of them.
            cell: period.wrap(self.frequency * place.cell + (self.offset[axis] + whole)),
            fraction: fine - whole,
        }
    }
}
