//! What becomes of the keys of sixteen pixels.

use crate::fixed::Place;
use crate::metric::Norm;
use crate::{Axes, Combination, Space, Worley, WorleyError};
use fearless_simd::{f32x16, prelude::*};

/// A combination, scaled and shifted: `shift + scale · (C1·F1 + …)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tone {
    pub(crate) combination: Combination,
    pub(crate) scale: f32,
    pub(crate) shift: f32,
}

impl Tone {
    /// The combination as it is.
    pub(crate) fn plain(combination: Combination) -> Self {
        Self {
            combination,
            scale: 1.0,
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
        let map = |value: f32| (value - low) / extent;
        Ok(Self {
            scale: self.scale / extent,
            shift: map(self.shift),
            ..self
        })
    }

    /// At a place.
    pub(crate) fn at<const N: usize>(&self, worley: &Worley<N>, place: Place<N>) -> f32
    where
        Axes: Space<N>,
    {
        if self.combination.depth() <= 2 {
            self.of(&worley.distances::<2>(place))
        } else {
            self.of(&worley.distances::<4>(place))
        }
    }

    /// From distances, at least [`Combination::depth`] of them.
    pub(crate) fn of(&self, distances: &[f32]) -> f32 {
        self.shift + self.scale * self.combination.of(distances)
    }

    /// From the keys of sixteen pixels.
    #[inline(always)]
    pub(crate) fn of_keys<S: Simd, M: Norm, const K: usize>(
        &self,
        norm: M,
        keys: [f32x16<S>; K],
    ) -> f32x16<S> {
        let mut sum = f32x16::splat(keys[0].simd, 0.0);
        for (rank, &coefficient) in self.combination.coefficients().iter().take(K).enumerate() {
            if coefficient != 0.0 {
                sum += norm.distances(keys[rank]) * coefficient;
            }
        }
        sum * self.scale + self.shift
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

    /// Takes in the keys of up to sixteen pixels.
    #[inline(always)]
    pub(crate) fn put<S: Simd, M: Norm, const K: usize>(
        &self,
        norm: M,
        keys: [f32x16<S>; K],
        out: &mut [f32],
    ) {
        let simd = keys[0].simd;
        let mut values = self.tone.of_keys(norm, keys);
        if out.len() == 16 {
            if let Some(weight) = self.weight {
                values = f32x16::from_slice(simd, out) + values * weight;
            }
            values.store_slice(out);
            return;
        }
        let mut lanes = [0.0; 16];
        if let Some(weight) = self.weight {
            lanes[..out.len()].copy_from_slice(out);
            values = f32x16::from_slice(simd, &lanes) + values * weight;
        }
        values.store_slice(&mut lanes);
        out.copy_from_slice(&lanes[..out.len()]);
    }
}
