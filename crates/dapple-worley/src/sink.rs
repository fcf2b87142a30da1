//! What becomes of the keys of sixteen pixels.

use crate::fixed::Place;
use crate::metric::Norm;
use crate::{Axes, Combination, Space, Worley, WorleyError};
use fearless_simd::{f32x16, prelude::*};

/// A combination, mapped to a range: `shift + W1·F1 + W2·F2 + …`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tone {
    /// The coefficients times what maps to the range.
    pub(crate) weights: Combination,
    pub(crate) shift: f32,
}

impl Tone {
    /// The combination as it is.
    pub(crate) fn plain(combination: Combination) -> Self {
        Self {
            weights: combination,
            shift: 0.0,
        }
    }

    /// The same with its values mapped so that `range` becomes 0 to 1.
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
            shift: (self.shift - low) / extent,
        })
    }

    /// The greatest n of `F_n` that is needed.
    pub(crate) fn depth(&self) -> usize {
        self.weights.depth()
    }

    /// At a place.
    pub(crate) fn at<const N: usize>(&self, worley: &Worley<N>, place: Place<N>) -> f32
    where
        Axes: Space<N>,
    {
        if self.depth() <= 2 {
            self.of(&worley.distances::<2>(place))
        } else {
            self.of(&worley.distances::<4>(place))
        }
    }

    /// From distances, at least [`Tone::depth`] of them.
    pub(crate) fn of(&self, distances: &[f32]) -> f32 {
        let mut sum = self.shift;
        for (&weight, &distance) in self.weights.coefficients().iter().zip(distances) {
            if weight != 0.0 {
                sum += distance * weight;
            }
        }
        sum
    }

    /// From the keys of sixteen pixels.
    #[inline(always)]
    pub(crate) fn of_keys<S: Simd, M: Norm, const K: usize>(
        &self,
        norm: M,
        keys: [f32x16<S>; K],
    ) -> f32x16<S> {
        let mut sum = f32x16::splat(keys[0].simd, self.shift);
        for (rank, &weight) in self.weights.coefficients().iter().take(K).enumerate() {
            if weight != 0.0 {
                sum += norm.distances(keys[rank]) * weight;
            }
        }
        sum
    }
}

/// Puts tones into rows of values: in place of what is there, or, times a weight, on top of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values {
    pub(crate) tone: Tone,
    /// How much is added to what is there; nothing, if the values go in its place.
    pub(crate) weight: Option<f32>,
}

impl Values {
    /// The value at a place; NaN where there is none.
    pub(crate) fn put_one<const N: usize>(
        &self,
        worley: &Worley<N>,
        place: Option<Place<N>>,
        out: &mut f32,
    ) where
        Axes: Space<N>,
    {
        let value = place.map_or(f32::NAN, |place| self.tone.at(worley, place));
        *out = match self.weight {
            Some(_) if value.is_nan() => f32::NAN,
            Some(weight) => *out + value * weight,
            None => value,
        };
    }

    /// Takes in the keys of sixteen pixels.
    #[inline(always)]
    pub(crate) fn put<S: Simd, M: Norm, const K: usize>(
        &self,
        norm: M,
        keys: [f32x16<S>; K],
        out: &mut [f32],
    ) {
        let mut values = self.tone.of_keys(norm, keys);
        if let Some(weight) = self.weight {
            values = f32x16::from_slice(keys[0].simd, out) + values * weight;
        }
        values.store_slice(out);
    }

    /// Takes in the keys of fewer than sixteen pixels.
    #[inline(always)]
    pub(crate) fn put_part<S: Simd, M: Norm, const K: usize>(
        &self,
        norm: M,
        keys: [f32x16<S>; K],
        out: &mut [f32],
    ) {
        let mut lanes = [0.0; 16];
        lanes[..out.len()].copy_from_slice(out);
        self.put(norm, keys, &mut lanes);
        out.copy_from_slice(&lanes[..out.len()]);
    }
}
