//! Fractal sums of fields: the same texture at several scales on top of each other.
//!
//! Fractional Brownian motion, ridged and billowed sums as in F. Kenton Musgrave's chapters of Ebert et al., "Texturing
//! and Modeling: A Procedural Approach", 3rd edition, 2003.

use super::common_period;
use super::values::{by_bands, zip_rows};
use crate::{Field, Frequency, RasterError, RasterViewMut, Window};
use glam::DVec2;

/// The largest number of octaves of a sum.
const MOST_OCTAVES: usize = 32;

/// A sum of octaves, `Σ gain^i · shape(field_i(lacunarity^i · position))`, not divided by the sum of the weights.
///
/// # Examples
///
/// Octaves that are fields of their own have no place in common where all of them are alike:
///
/// ```
/// use dapple_raster::{Field, Fractal, FractalShape, field_fn, glam::DVec2};
///
/// let octaves = (0..5).map(|octave| field_fn(move |p| (p.x + f64::from(octave)).fract() as f32));
/// let sum = Fractal::new(octaves, 0.5, 2.0, FractalShape::Sum)?;
/// assert_eq!(sum.sample(DVec2::ZERO), 0.0);
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fractal<F> {
    /// The octaves, coarsest first.
    octaves: Vec<Frequency<F>>,
    weights: Vec<f32>,
    shape: FractalShape,
}

crate::named! {
    /// The function that the values of each octave pass through before they are summed; made for values about 0.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum FractalShape {
        /// The values as they are: fractional Brownian motion. Octaves from `-b` to `b` have sums from `-w·b` to `w·b`, where
        /// `w` is [`Fractal::weight`].
        #[default]
        Sum = "sum",
        /// `1 - |value|`: ridges where values go through 0. Octaves from `-b` to `b` have sums from `w·(1 - b)` to `w`, for
        /// a gain that is not negative.
        Ridged = "ridged",
        /// `|value|`: creases where values go through 0, and round hills between them; Perlin called it turbulence. Octaves
        /// from `-b` to `b` have sums from 0 to `w·b`, for a gain that is not negative.
        Billow = "billow",
    }
}

impl FractalShape {
    #[inline]
    fn of(self, value: f32) -> f32 {
        match self {
            Self::Sum => value,
            Self::Ridged => 1.0 - value.abs(),
            Self::Billow => value.abs(),
        }
    }
}

impl<F: Field> Fractal<F> {
    /// The sum of `octaves`, coarsest first, each `lacunarity` times finer and `gain` times as high as the one before.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RasterErrorKind::Range) unless there are 1 to 32 octaves, the gain is from -1 to 1 and the lacunarity from 1 to
    /// 16.
    pub fn new(
        octaves: impl IntoIterator<Item = F>,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    ) -> Result<Self, RasterError> {
        RasterError::check_range((-1.0..=1.0).contains(&gain), "gain", gain, "from -1 to 1")?;
        let holds = (1.0..=16.0).contains(&lacunarity);
        RasterError::check_range(holds, "lacunarity", lacunarity, "from 1 to 16")?;
        let (mut frequency, mut weight) = (1.0, 1.0);
        let mut sum = Self {
            octaves: Vec::new(),
            weights: Vec::new(),
            shape,
        };
        for field in octaves.into_iter().take(MOST_OCTAVES + 1) {
            sum.octaves.push(Frequency {
                field,
                frequency: DVec2::splat(frequency),
            });
            sum.weights.push(weight as f32);
            frequency *= lacunarity;
            weight *= gain;
        }
        let count = sum.octaves.len();
        let holds = (1..=MOST_OCTAVES).contains(&count);
        RasterError::check_range(holds, "number of octaves", count as f64, "from 1 to 32")?;
        Ok(sum)
    }

    /// The sum of the absolute weights: octaves with values from -1 to 1 have sums from minus this number to this
    /// number (see [`FractalShape`] for other shapes).
    #[must_use]
    pub fn weight(&self) -> f32 {
        let weights = self.weights.iter().map(|weight| f64::from(weight.abs()));
        weights.sum::<f64>() as f32
    }

    fn octaves(&self) -> impl Iterator<Item = (&Frequency<F>, f32)> {
        self.octaves.iter().zip(self.weights.iter().copied())
    }
}

impl<F: Field> Field for Fractal<F> {
    fn sample(&self, position: DVec2) -> f32 {
        let mut sum = 0.0;
        for (octave, weight) in self.octaves() {
            sum += weight * self.shape.of(octave.sample(position));
        }
        sum
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        values.fill(0.0);
        let mut others = vec![0.0; positions.len()];
        for (octave, weight) in self.octaves() {
            octave.sample_many(positions, &mut others)?;
            for (value, &other) in values.iter_mut().zip(&others) {
                *value += weight * self.shape.of(other);
            }
        }
        Ok(())
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        by_bands(window, out, |part, mut band, memory| {
            band.fill(0.0);
            for (octave, weight) in self.octaves() {
                octave.render(part, memory.reborrow())?;
                zip_rows(&mut band, memory, |value, other| {
                    *value += weight * self.shape.of(other);
                });
            }
            Ok(())
        })
    }

    fn period(&self) -> [Option<f64>; 2] {
        let periods = self.octaves.iter().map(Field::period);
        periods.fold([Some(0.0); 2], common_period)
    }
}
