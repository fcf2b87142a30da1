//! Cache of coarser-level samples between two passes. Holds the central part of each site's square, which the next pass
//! reads again.

use crate::domain::{Samples, Square};

/// Cached squares of a pass: one per site, `side` samples wide.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleCache {
    side: usize,
    n_channels: usize,
    values: Vec<f32>,
    nearest: Vec<u32>,
}

/// Mutable cached square of one site.
#[derive(Debug)]
pub(crate) struct CachedSite<'a> {
    side: usize,
    values: &'a mut [f32],
    nearest: &'a mut [u32],
}

impl SampleCache {
    /// Allocates the squares of all sites. A side of 0 allocates nothing.
    pub(crate) fn new(n_sites: usize, side: usize, n_channels: usize) -> Self {
        let n_samples = n_sites * side * side;
        Self {
            side,
            n_channels,
            values: vec![0.0; n_samples * n_channels],
            nearest: vec![0; n_samples],
        }
    }

    /// Iterates over the squares of all sites; empty if the side is 0.
    pub(crate) fn sites(&mut self) -> impl Iterator<Item = CachedSite<'_>> {
        let side = self.side;
        let n_samples = (side * side).max(1);
        let values = self
            .values
            .chunks_exact_mut((n_samples * self.n_channels).max(1));
        let nearest = self.nearest.chunks_exact_mut(n_samples);
        values
            .zip(nearest)
            .map(move |(values, nearest)| CachedSite {
                side,
                values,
                nearest,
            })
    }

    /// Copies the cached square of `site` into `samples` if it is the same size as `square`. Returns whether it was
    /// copied.
    pub(crate) fn paste(&self, site: u32, square: &Square, samples: &mut Samples) -> bool {
        let n = self.side * self.side;
        // The previous pass retained no squares, or none of this size.
        if self.side != square.side() {
            return false;
        }
        let first = site as usize * n;
        samples
            .nearest
            .copy_from_slice(&self.nearest[first..first + n]);
        samples
            .values
            .copy_from_slice(&self.values[first * self.n_channels..][..n * self.n_channels]);
        true
    }
}

impl CachedSite<'_> {
    /// Stores the central part of `samples`, a square that is `from` samples wide.
    pub(crate) fn copy(&mut self, samples: &Samples, from: usize) {
        let side = self.side;
        let n_channels = self.values.len() / self.nearest.len();
        let margin = (from - side) / 2;
        // Copy the central rows and columns.
        for row in 0..side {
            let source = (row + margin) * from + margin;
            let target = row * side;
            self.nearest[target..][..side].copy_from_slice(&samples.nearest[source..][..side]);
            self.values[target * n_channels..][..side * n_channels]
                .copy_from_slice(&samples.values[source * n_channels..][..side * n_channels]);
        }
    }
}
