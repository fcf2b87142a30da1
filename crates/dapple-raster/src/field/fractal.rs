//! Fractal sums of fields, which add copies of a field at several scales.
//!
//! Fractional Brownian motion, ridged and billowed sums as in F. Kenton Musgrave's chapters of Ebert et al., "Texturing
//! and Modeling: A Procedural Approach", 3rd edition, 2003.

use super::common_period;
use super::values::{by_bands, zip_rows};
use crate::{Field, FieldParts, Range, RasterError, RasterViewMut, Scaled, Window, range};

/// A fractal sum of octaves, `Σ gain^i · shape(field_i(lacunarity^i · position))`, not divided by the sum of the
/// weights: fractional Brownian motion, ridges or billows, depending on the shape. Usual values are a lacunarity of 2
/// and a gain of ½.
///
/// Octaves that are copies of one field, such as `vec![field; 5]`, coincide at the origin. Octaves with separate seeds
/// do not; the noise and cell generators of dapple have methods that create such octaves from one seed.
///
/// # Examples
///
///
/// ```
/// use dapple_raster::{FieldExt, Fractal, FractalShape, field_fn};
///
/// let octaves = (0..5).map(|octave| field_fn(move |[x, _y]| (x + f64::from(octave)).fract() as f32));
/// let sum = Fractal::new(octaves, 0.5, 2.0, FractalShape::Sum)?;
/// assert_eq!(sum.sample([0.0, 0.0]), 0.0);
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fractal<F> {
    /// Octaves of the sum, coarsest first.
    octaves: Vec<Octave<F>>,
    shape: FractalShape,
}

#[derive(Clone, Debug)]
struct Octave<F> {
    field: F,
    frequency: f64,
    weight: f32,
}

crate::named! {
    /// Function applied to the values of each octave before they are summed, for values centered at 0.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum FractalShape {
        /// Unchanged values: fractional Brownian motion. Octaves from `-b` to `b` have sums from `-w·b` to `w·b`, where
        /// `w` is [`Fractal::weight`].
        #[default]
        Sum = "sum",
        /// Ridges where values pass through 0: `1 - |value|`. Octaves from `-b` to `b` have sums from `w·(1 - b)` to
        /// `w` for a gain of at least 0.
        Ridged = "ridged",
        /// Creases where values pass through 0, with round hills between them: `|value|`, which Perlin called
        /// turbulence. Octaves from `-b` to `b` have sums from 0 to `w·b` for a gain of at least 0.
        Billow = "billow",
    }
}

impl FractalShape {
    /// Applies the function to an octave's value.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    pub fn of(self, value: f32) -> f32 {
        match self {
            Self::Sum => value,
            Self::Ridged => 1.0 - value.abs(),
            Self::Billow => value.abs(),
        }
    }
}

impl Fractal<()> {
    /// Valid numbers of octaves.
    pub const COUNT: Range = range!(from 1 to 32);
    /// Valid ratios of weights.
    pub const GAIN: Range = range!(from -1 to 1);
    /// Valid ratios of frequencies.
    pub const LACUNARITY: Range = range!(from 1 to 16);
}

impl<F> Fractal<F> {
    /// Creates a sum of `octaves`, coarsest first. Each octave has `lacunarity` times the frequency and `gain` times
    /// the weight of the previous one.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RasterErrorKind::Range) unless there are 1 to 32 octaves, the gain is from -1 to 1 and the
    /// lacunarity from 1 to 16.
    pub fn new(
        octaves: impl IntoIterator<Item = F>,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    ) -> Result<Self, RasterError> {
        RasterError::check_in(Fractal::GAIN, "gain", gain)?;
        RasterError::check_in(Fractal::LACUNARITY, "lacunarity", lacunarity)?;
        let (mut frequency, mut weight) = (1.0, 1.0);
        let mut sum = Self {
            octaves: Vec::new(),
            shape,
        };
        for field in octaves {
            sum.octaves.push(Octave {
                field,
                frequency,
                weight: weight as f32,
            });
            frequency *= lacunarity;
            weight *= gain;
            // One octave more than allowed is enough to refuse the number.
            if !Fractal::COUNT.holds(sum.octaves.len() as f64) {
                break;
            }
        }
        let count = sum.octaves.len();
        RasterError::check_in(Fractal::COUNT, "number of octaves", count as f64)?;
        Ok(sum)
    }

    /// Returns w, the sum of the absolute weights. Octaves with values from -1 to 1 have sums from -w to w (see
    /// [`FractalShape`] for other shapes).
    #[must_use]
    pub fn weight(&self) -> f32 {
        let octaves = self.octaves.iter();
        let weights = octaves.map(|octave| f64::from(octave.weight.abs()));
        weights.sum::<f64>() as f32
    }

    pub(super) const fn shape(&self) -> FractalShape {
        self.shape
    }

    /// Returns the field, the frequency and the weight of each octave, coarsest first.
    pub fn octaves(&self) -> impl Iterator<Item = (&F, f64, f32)> {
        let octaves = self.octaves.iter();
        octaves.map(|octave| (&octave.field, octave.frequency, octave.weight))
    }

    /// Returns the octaves scaled to their frequencies, with their weights.
    pub(super) fn scaled<const N: usize>(&self) -> impl Iterator<Item = (Scaled<&F, N>, f32)> {
        self.octaves.iter().map(|octave| {
            let scaled = Scaled {
                field: &octave.field,
                frequency: [octave.frequency; N],
            };
            (scaled, octave.weight)
        })
    }
}

impl<const N: usize, F: Field<N>> Field<N> for Fractal<F> {
    fn parts(&self) -> FieldParts<'_, N> {
        let octaves = self.octaves();
        let octaves = octaves.map(|(field, frequency, weight)| (field as _, frequency, weight));
        FieldParts::Fractal(octaves.collect(), self.shape)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        let mut sum = 0.0;
        for (octave, weight) in self.scaled() {
            sum += weight * self.shape.of(octave.value(position));
        }
        sum
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        values.fill(0.0);
        let mut others = vec![0.0; positions.len()];
        for (octave, weight) in self.scaled() {
            octave.values(positions, &mut others)?;
            for (value, &other) in values.iter_mut().zip(&others) {
                *value += weight * self.shape.of(other);
            }
        }
        Ok(())
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        by_bands(window, out, |part, mut band, memory| {
            band.fill(0.0);
            for (octave, weight) in self.scaled() {
                octave.render(part, memory.reborrow())?;
                zip_rows(&mut band, memory, |value, other| {
                    *value += weight * self.shape.of(other);
                });
            }
            Ok(())
        })
    }

    fn period(&self) -> [Option<f64>; N] {
        let periods = self.scaled().map(|(octave, _)| octave.period());
        periods.fold([Some(0.0); N], common_period)
    }
}
