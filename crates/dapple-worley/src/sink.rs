//! Converts keys to values of a combination, and writes them for sixteen pixels at a time.

use crate::fixed::{FlatPlace, Place};
use crate::metric::Measure;
use crate::render::Basis;
use crate::search::Hit;
use crate::{Combination, Dimensions, MAX_NEAREST, Space, Worley, WorleyError};
use fearless_simd::{f32x16, prelude::*};

/// A combination of distances, mapped to an output range: `shift + W1·F1 + W2·F2 + …`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tone {
    /// Coefficients of the distances, scaled to the range.
    pub(crate) weights: Combination,
    pub(crate) shift: f32,
}

impl Tone {
    /// Creates the combination without a mapping to a range.
    pub(crate) fn plain(combination: Combination) -> Self {
        Self {
            weights: combination,
            shift: 0.0,
        }
    }

    /// Maps the values from `range` to 0 to 1.
    pub(crate) fn with_range(self, [low, high]: [f32; 2]) -> Result<Self, WorleyError> {
        let extent = high - low;
        WorleyError::check(
            extent > 0.0 && extent.is_finite() && extent.recip().is_finite(),
            "extent of the range",
            f64::from(extent),
            "finite and above 0",
        )?;
        let weights = self.weights.coefficients().map(|weight| weight / extent);
        Ok(Self {
            weights: Combination::new(weights),
            // Adding zero turns -0 into 0. Otherwise, adding zero later would change the bits.
            shift: (self.shift - low) / extent + 0.0,
        })
    }

    /// Returns the number of nearest points that the combination needs: the largest n of its `F_n`.
    pub(crate) fn depth(&self) -> usize {
        self.weights.depth()
    }

    /// Returns the value of the combination at `place`.
    pub(crate) fn at<const N: usize>(&self, worley: &Worley<N>, place: &Place<N>) -> f32
    where
        Dimensions: Space<N>,
    {
        let hits = worley.nearest_hits(self.depth(), place);
        self.of(&hits.map(|hit| worley.metric.distance(hit.key)))
    }

    /// Returns the value of the combination for the distances F1, F2, …; there must be at least [`Tone::depth`] of
    /// them.
    pub(crate) fn of(&self, distances: &[f32]) -> f32 {
        let mut sum = self.shift;
        for (&weight, &distance) in self.weights.coefficients().iter().zip(distances) {
            if weight != 0.0 {
                // Skip unused distances, which may be infinite: their product with zero would be NaN.
                sum += distance * weight;
            }
        }
        sum
    }
}

/// A combination and the way its values are written: replacing the output, or added to it with a weight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values {
    pub(crate) tone: Tone,
    /// Weight of the values that are added to the output. If `None`, values replace the output.
    pub(crate) weight: Option<f32>,
}

impl Values {
    /// Writes the value at `place`; NaN if the position is out of range.
    pub(crate) fn put_one(&self, basis: &dyn Basis, place: Option<FlatPlace>, out: &mut f32) {
        let value = place.map_or(f32::NAN, |place| {
            let mut hits = [Hit::NONE; MAX_NEAREST];
            let hits = &mut hits[..self.tone.depth()];
            basis.nearest(&place, hits);
            let mut distances = [0.0; MAX_NEAREST];
            for (distance, hit) in distances.iter_mut().zip(&*hits) {
                *distance = basis.metric().distance(hit.key);
            }
            self.tone.of(&distances)
        });
        *out = match self.weight {
            // A sum could change the bits of NaN.
            Some(_) if value.is_nan() => f32::NAN,
            Some(weight) => *out + value * weight,
            None => value,
        };
    }

    /// Broadcasts the parameters to sixteen lanes, for kernels with `K` keys per pixel. Only the last `depth` keys are
    /// in use.
    #[inline(always)]
    pub(crate) fn lanes<S: Simd, const K: usize>(&self, simd: S, depth: usize) -> ValueLanes<S, K> {
        let coefficients = self.tone.weights.coefficients();
        let mut lanes = ValueLanes {
            shift: f32x16::splat(simd, self.tone.shift),
            weights: [f32x16::splat(simd, 0.0); K],
            counts: [false; K],
            is_added: self.weight.is_some(),
            weight: f32x16::splat(simd, self.weight.unwrap_or(1.0)),
        };
        for rank in 0..K {
            if rank + depth >= K {
                let weight = coefficients[rank + depth - K];
                lanes.weights[rank] = f32x16::splat(simd, weight);
                lanes.counts[rank] = weight != 0.0;
            }
        }
        lanes
    }
}

/// The parameters of [`Values`], broadcast to all lanes.
#[derive(Clone, Copy)]
pub(crate) struct ValueLanes<S: Simd, const K: usize> {
    shift: f32x16<S>,
    weights: [f32x16<S>; K],
    /// For each weight, whether it is nonzero.
    counts: [bool; K],
    /// Whether values are added to the output.
    pub(crate) is_added: bool,
    weight: f32x16<S>,
}

impl<S: Simd, const K: usize> ValueLanes<S, K> {
    /// Writes the values of sixteen pixels, given their sorted keys.
    #[inline(always)]
    pub(crate) fn put<M: Measure>(&self, measure: M, keys: [f32x16<S>; K], out: &mut [f32]) {
        let mut values = self.shift;
        for rank in 0..K {
            // With K = 1, a weight of zero adds zero; it occurs only in a combination without any weight.
            if K == 1 || self.counts[rank] {
                values += measure.distances(keys[rank]) * self.weights[rank];
            }
        }
        if self.is_added {
            values = f32x16::from_slice(values.simd, out) + values * self.weight;
        }
        values.store_slice(out);
    }

    /// Writes the values of fewer than sixteen pixels, given their sorted keys.
    #[inline(always)]
    pub(crate) fn put_part<M: Measure>(&self, measure: M, keys: [f32x16<S>; K], out: &mut [f32]) {
        let mut lanes = [0.0; 16];
        lanes[..out.len()].copy_from_slice(out);
        self.put(measure, keys, &mut lanes);
        out.copy_from_slice(&lanes[..out.len()]);
    }
}
