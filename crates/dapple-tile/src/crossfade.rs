//! Crossfade: blends two images by weights, with or without preserving the variance.
//!
//! The mean of two uncorrelated images has less contrast than either. Dividing the deviation from the mean by the
//! length of the vector of weights, instead of by their sum, preserves its variance: Eric Heitz and Fabrice Neyret,
//! "High-Performance By-Example Noise using a Histogram-Preserving Blending Operator", Proceedings of the ACM on
//! Computer Graphics and Interactive Techniques 1(2), 2018, <https://doi.org/10.1145/3233304>. Their histogram
//! transform is not used here.
//!
//! Difference from the paper: the operator assumes independent images, which does not hold along a cut of least
//! difference. With weights v and w and correlation r, the deviation is divided by sqrt(v² + w² + 2 r v w). This equals
//! the operator for r = 0 and the plain mean for r = 1. The correlation is measured over the blended pixels, and
//! clamped to at least 0 so that opposite images are not amplified.

use crate::TileError;
use dapple_raster::Raster;

dapple_raster::named! {
    /// Weights for mixing two sides where they overlap.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/crossfade.md"))]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Crossfade {
        /// Variance-preserving weights, applied to the differences from the mean of each plane. Where both sides are
        /// far from the mean, the mix can be further from it than either.
        #[default]
        KeepVariance = "keep_variance",
        /// Weights that sum to 1, which flatten the mix.
        Linear = "linear",
    }
}

/// Two images of the same size, with the means of their planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'a> {
    pub(crate) images: [&'a Raster<f32>; 2],
    pub(crate) means: [f64; 2],
}

impl Crossfade {
    /// Blends the images by the weights of the second image, from 0 to 1. Pixels with weight 0 or 1 are copied.
    pub(crate) fn mix(
        self,
        pair: Pair<'_>,
        weights: &Raster<f64>,
    ) -> Result<Raster<f32>, TileError> {
        let correlation = match self {
            Self::KeepVariance => pair.correlation(weights)?,
            // With a correlation of 1, the operator is the plain mean.
            Self::Linear => 1.0,
        };
        let pixels = pair.pixels(weights)?;
        let mixed = pixels.map(|([a, b], weight)| match weight {
            0.0 => a,
            1.0 => b,
            _ => {
                let [v, w] = shares(weight, correlation);
                mix_two([a, b], pair.means, [v, w], weight)
            }
        });
        Ok(Raster::from_vec(weights.size(), mixed.collect())?)
    }
}

/// Returns the factors of the two deviations, for the second image's weight and a correlation.
fn shares(weight: f64, correlation: f64) -> [f64; 2] {
    // Divide by the standard deviation of the weighted mean of two images with unit variance.
    let [v, w] = [1.0 - weight, weight];
    let length = (v * v + w * w + 2.0 * correlation * v * w).sqrt();
    [v / length, w / length]
}

/// Blends two values: the weighted mean of the means, plus both scaled deviations.
fn mix_two(values: [f32; 2], means: [f64; 2], shares: [f64; 2], weight: f64) -> f32 {
    let [a, b] = [0, 1].map(|side| (f64::from(values[side]) - means[side]) * shares[side]);
    (means[0] + weight * (means[1] - means[0]) + (a + b)) as f32
}

impl<'a> Pair<'a> {
    /// Iterates over the pixels, with the values of both images and the weight of the second.
    fn pixels(
        self,
        weights: &'a Raster<f64>,
    ) -> Result<impl Iterator<Item = ([f32; 2], f64)>, TileError> {
        let [a, b] = self.images;
        weights.check_same_size(a.size())?;
        weights.check_same_size(b.size())?;
        let values = a.pixels().iter().zip(b.pixels());
        let pixels = values.zip(weights.pixels());
        Ok(pixels.map(|((a, b), weight)| ([*a, *b], *weight)))
    }

    /// Returns the correlation of the images over all blended pixels, clamped to 0 to 1. It is 0 if one image is
    /// constant there.
    fn correlation(self, weights: &Raster<f64>) -> Result<f64, TileError> {
        // Sum the squares and the products of the deviations, where both images are visible.
        let [mut aa, mut bb, mut ab] = [0.0; 3];
        for ([a, b], weight) in self.pixels(weights)? {
            if weight > 0.0 && weight < 1.0 {
                let [a, b] = [f64::from(a) - self.means[0], f64::from(b) - self.means[1]];
                aa += a * a;
                bb += b * b;
                ab += a * b;
            }
        }
        // Take the roots separately, so that the product of huge sums stays finite.
        let both: f64 = aa.sqrt() * bb.sqrt();
        Ok(if both > 0.0 {
            (ab / both).clamp(0.0, 1.0)
        } else {
            0.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Crossfade, Pair, shares};
    use dapple_hash::{Seed, hash2, unit_f64};
    use dapple_raster::Raster;

    fn white(seed: u64, size: [u32; 2]) -> Raster<f32> {
        let value = |x: u32, y: u32| unit_f64(hash2(Seed(seed), [x.into(), y.into()], 0));
        Raster::from_fn(size, |x, y| value(x, y) as f32).unwrap()
    }

    #[test]
    fn shares_have_length_one_for_independent_and_sum_one_for_equal_images() {
        for weight in [0.0, 0.1, 0.5, 0.9, 1.0] {
            let [[v, w], [p, q]] = [shares(weight, 0.0), shares(weight, 1.0)];
            assert!((v * v + w * w - 1.0).abs() < 1e-15, "independent, {weight}");
            assert!(
                (p + q - 1.0).abs() < 1e-15 && (q - weight).abs() < 1e-15,
                "equal, {weight}"
            );
        }
    }

    #[test]
    fn mix_keeps_the_variance_of_independent_images_and_of_equal_ones() {
        let size = [256, 128];
        let half = Raster::filled(size, 0.5).unwrap();
        let [a, b] = [1, 2].map(|seed| white(seed, size));
        let deviation = |crossfade: Crossfade, images| {
            let pair = Pair {
                images,
                means: [0.5; 2],
            };
            crossfade.mix(pair, &half).unwrap().statistics().deviation
        };
        let whole = a.statistics().deviation;
        for (images, linear) in [([&a, &b], 0.5_f64.sqrt()), ([&a, &a], 1.0)] {
            // The deviations of two finite samples differ by about 1 / sqrt(2 · 32768) = 0.4 %.
            let kept = deviation(Crossfade::KeepVariance, images) / whole;
            assert!((kept - 1.0).abs() < 0.012, "kept {kept}");
            let flattened = deviation(Crossfade::Linear, images) / whole;
            assert!(
                (flattened - linear).abs() < 0.012,
                "flattened to {flattened}"
            );
        }
    }

    #[test]
    fn mix_copies_where_a_weight_is_whole_and_mixes_the_means() {
        let size = [3, 1];
        let weights = Raster::from_vec(size, vec![0.0, 1.0, 0.25]).unwrap();
        let [a, b] =
            [[0.1_f32, 0.2, 1.0], [0.7, 0.8, 3.0]].map(|row| Raster::from_vec(size, row.to_vec()));
        let (a, b) = (a.unwrap(), b.unwrap());
        let pair = Pair {
            images: [&a, &b],
            means: [1.0, 3.0],
        };
        for crossfade in [Crossfade::KeepVariance, Crossfade::Linear] {
            let mixed = crossfade.mix(pair, &weights).unwrap();
            assert_eq!(mixed.pixels(), [0.1, 0.8, 1.5], "{crossfade:?}");
        }
        assert!(
            Crossfade::Linear
                .mix(pair, &Raster::filled([1, 3], 0.5).unwrap())
                .is_err()
        );
    }
}
