//! Regularity of an exemplar: how well the surroundings of a pixel are matched elsewhere in it.
//!
//! The neighborhoods of a sample of pixels, each minus its mean, are compared with all neighborhoods at a sufficient
//! distance from them. The ratio of the mean smallest squared distance to the mean of all squared distances is near 0
//! if an exemplar follows a rule, as hooks, bricks and checkers do. It is about 0.5 for grass and sand, where no detail
//! occurs twice. Regularity is 1 minus this ratio. Means are subtracted because clouds would otherwise count as
//! regular: their smooth parts are similar, but their details are not.
//!
//! A peak in the autocorrelation is less informative: photographs that were made tileable have one, and wiggly checkers
//! do not.
//!
//! Reference: our own.

use crate::guides::Guides;
use crate::matcher::PaddedRows;
use crate::{Candidates, CoarserCenter, Edges, Exemplar, Part, Pass, Reads, Shape};
use dapple_raster::simd;
use dapple_raster::simd::dispatch;
use fearless_simd::prelude::*;

/// Side of the central part of the exemplar that is compared, in pixels. A side of 128 ranks the available exemplars in
/// the same order, but takes four times as long.
const WINDOW: u32 = 64;

/// Side of a neighborhood in pixels, as in the passes of the finest level.
const SIDE: u32 = 7;

/// Minimum distance between two pixels along at least one axis, in pixels. Their neighborhoods then overlap by less
/// than half.
const APART: u32 = 5;

/// Approximate number of neighborhoods that are compared with all others.
const N_QUERIES: u32 = 128;

impl Exemplar {
    /// Measures how well the surroundings of a pixel are matched elsewhere in the exemplar, from 0 (not at all) to 1
    /// (exactly).
    ///
    /// Compares neighborhoods of 7 × 7 pixels, each minus its mean, with others that are at least 5 pixels away along
    /// an axis. The result is 1 minus the mean squared distance to the most similar neighborhood, divided by the mean
    /// squared distance to all of them. Only the central 64 × 64 pixels are compared. Returns 0 if the exemplar is too
    /// small to have two neighborhoods this far apart.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::Raster;
    /// use dapple_synth::{Edges, Exemplar};
    ///
    /// let stripes = Raster::from_fn([32, 32], |x, _| (x % 8) as f32)?;
    /// let stripes = Exemplar::from_planes(&[(&stripes, 1.0)], Edges::Wrap)?;
    /// assert_eq!(stripes.regularity(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn regularity(&self) -> f64 {
        let Some(details) = Details::new(&self.middle(WINDOW)) else {
            return 0.0;
        };
        let n_rows = details.pixels.len() as u32;
        // Use an odd step: with a power of two, some columns or rows would never be sampled.
        let step = (n_rows / N_QUERIES) | 1;
        // Compare each sampled neighborhood with all that are far enough apart.
        let mut nearest = Mean::default();
        let mut any = Mean::default();
        for query in (0..n_rows).step_by(step as usize) {
            let least = dispatch!(simd::level(), simd => details.least_from(simd, query, &mut any));
            if least.is_finite() {
                nearest.add(least);
            }
        }
        match (nearest.count > 0.0, any.sum > 0.0) {
            (true, true) => 1.0 - nearest.get() / any.get(),
            // All neighborhoods are equal.
            (true, false) => 1.0,
            // No two neighborhoods are far enough apart to be compared.
            (false, _) => 0.0,
        }
    }

    /// Returns the central part, with sides of at most `side` pixels. Its edges are cut unless it is the whole
    /// exemplar.
    fn middle(&self, side: u32) -> Self {
        // Find the central rectangle.
        let size = self.size.map(|whole| whole.min(side));
        let [left, top] = [0, 1].map(|axis| ((self.size[axis] - size[axis]) / 2) as usize);
        let len = size[0] as usize * self.n_channels;
        let rows = self
            .pixels
            .chunks_exact((self.size[0] as usize * self.n_channels).max(1));
        let rows = rows.skip(top).take(size[1] as usize);
        Self {
            size,
            n_channels: self.n_channels,
            edges: if size == self.size {
                self.edges
            } else {
                Edges::Cut
            },
            pixels: rows
                .flat_map(|row| &row[left * self.n_channels..][..len])
                .copied()
                .collect(),
            usable: None,
            areas: Vec::new(),
            guides: Guides::default(),
        }
    }
}

/// The neighborhoods of an image, each minus its mean.
struct Details {
    rows: PaddedRows,
    /// Center pixel of each neighborhood.
    pixels: Vec<[u32; 2]>,
    size: [u32; 2],
    edges: Edges,
}

impl Details {
    /// Gathers the neighborhoods, or returns `None` if a side of the image is less than half of a neighborhood's side.
    fn new(image: &Exemplar) -> Option<Self> {
        // Gather all neighborhoods.
        let pass = Pass {
            level: 0,
            parts: vec![Part::new(Shape::Full, SIDE, Reads::Same)],
        };
        let pyramid = image.pyramid(1).ok()?;
        let mut neighborhoods = Candidates::new(&pyramid, &pass, CoarserCenter::Exact).ok()?;
        // Subtract the mean of each channel.
        let dims = neighborhoods.dims();
        for row in neighborhoods.rows.chunks_exact_mut(dims) {
            for channel in 0..image.n_channels {
                let values = || (channel..dims).step_by(image.n_channels);
                let sum: f32 = values().map(|at| row[at]).sum();
                let mean = sum / values().count() as f32;
                values().for_each(|at| row[at] -= mean);
            }
        }
        Some(Self {
            rows: PaddedRows::new(dims, &neighborhoods.rows),
            pixels: (0..neighborhoods.len())
                .map(|row| neighborhoods.pixel(row))
                .collect(),
            size: image.size,
            edges: image.edges,
        })
    }

    /// Returns the smallest squared distance to a neighborhood that is far enough apart, or infinity if there is none.
    /// Adds all distances to `mean`.
    #[inline(always)]
    fn least_from<S: Simd>(&self, simd: S, query: u32, mean: &mut Mean) -> f32 {
        let from = self.pixels[query as usize];
        let values = self.rows.row(query);
        let mut least = f32::INFINITY;
        for (row, &pixel) in (0..).zip(&self.pixels) {
            if self.lie_apart(from, pixel) {
                let distance_sq = self.rows.distance_sq(simd, values, row);
                least = least.min(distance_sq);
                mean.add(distance_sq);
            }
        }
        least
    }

    /// Returns whether two pixels are far enough apart for their neighborhoods to be compared.
    fn lie_apart(&self, a: [u32; 2], b: [u32; 2]) -> bool {
        (0..2).any(|axis| {
            let step = a[axis].abs_diff(b[axis]);
            let around = match self.edges {
                Edges::Cut => step,
                Edges::Wrap => self.size[axis] - step,
            };
            // On an exemplar that wraps, the shorter way counts.
            step.min(around) >= APART
        })
    }
}

/// Running mean.
#[derive(Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f32) {
        self.sum += f64::from(value);
        self.count += 1.0;
    }

    fn get(&self) -> f64 {
        self.sum / self.count
    }
}

#[cfg(test)]
mod tests {
    use crate::{Edges, Exemplar};
    use dapple_hash::{Seed, hash2, unit_f32};
    use dapple_raster::Raster;

    fn exemplar(size: [u32; 2], edges: Edges, value: impl Fn(u32, u32) -> f32) -> Exemplar {
        let plane = Raster::from_fn(size, value).unwrap();
        Exemplar::from_planes(&[(&plane, 1.0)], edges).unwrap()
    }

    fn noise(x: u32, y: u32) -> f32 {
        unit_f32((hash2(Seed(3), [x.into(), y.into()], 0) >> 32) as u32)
    }

    #[test]
    fn regularity_is_one_for_what_repeats_and_for_what_is_flat() {
        for edges in [Edges::Cut, Edges::Wrap] {
            let repeating = exemplar([64, 48], edges, |x, y| noise(x % 16, y % 16));
            assert_eq!(repeating.regularity(), 1.0, "{edges:?}, repeating");
            let flat = exemplar([16, 16], edges, |_, _| 0.5);
            assert_eq!(flat.regularity(), 1.0, "{edges:?}, flat");
        }
    }

    #[test]
    fn regularity_is_low_for_noise_and_for_clouds() {
        let white = exemplar([64, 64], Edges::Cut, noise).regularity();
        // The minimum of 3364 distances with 48 terms each is about half of their mean.
        assert!((0.3..0.6).contains(&white), "{white}");
        let clouds = exemplar([64, 64], Edges::Cut, |x, y| {
            0.1 * (x + y) as f32 + noise(x, y)
        });
        assert!(clouds.regularity() < 0.6, "{}", clouds.regularity());
    }

    #[test]
    fn regularity_does_not_depend_on_contrast_and_brightness() {
        let plain = exemplar([40, 40], Edges::Cut, noise).regularity();
        // Scaling by a power of two is exact; the shift rounds values to 2^-21.
        let scaled = exemplar([40, 40], Edges::Cut, |x, y| 4.0 * noise(x, y)).regularity();
        let shifted = exemplar([40, 40], Edges::Cut, |x, y| 2.0 + noise(x, y)).regularity();
        assert_eq!(plain, scaled, "contrast");
        assert!((plain - shifted).abs() < 1e-5, "{plain} {shifted}");
    }

    #[test]
    fn regularity_is_of_the_middle_of_a_large_exemplar() {
        let at = |x: u32, y: u32| (100..164).contains(&x) && (8..72).contains(&y);
        let value = |x: u32, y: u32| {
            if at(x, y) {
                noise(x % 8, y % 8)
            } else {
                noise(x, y)
            }
        };
        assert_eq!(exemplar([264, 80], Edges::Wrap, value).regularity(), 1.0);
    }

    #[test]
    fn exemplars_too_small_to_say_have_no_regularity() {
        for size in [[1, 1], [3, 80], [4, 4]] {
            for edges in [Edges::Cut, Edges::Wrap] {
                assert_eq!(exemplar(size, edges, noise).regularity(), 0.0, "{size:?}");
            }
        }
    }

    #[test]
    fn value_stability_regularity() {
        let found = exemplar([32, 24], Edges::Wrap, noise).regularity();
        assert_eq!(found, 0.4552760316491423, "noise");
    }
}
