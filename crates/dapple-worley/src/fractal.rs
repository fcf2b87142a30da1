//! Fractal sums, which add a texture to itself at several scales.
//!
//! Worley sums `G_n(x) = Σ 2^-i F_n(2^i x)` for `i` from 0 to 5, of `F_n` and of their combinations ("A Cellular
//! Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>). His octaves are scaled copies of
//! one field, which is visible at the origin, the center of all the copies. Here each octave has its own seed by
//! default; [`Octaves::paper`] gives the paper's sum.
//!
//! With a period, octave `i` repeats after `lacunarity^i` times as many cells of that octave. The sum therefore
//! repeats with the period of the first octave, and no octave repeats more often.

use crate::cellular::{measure_range, render_windows};
use crate::dispatch::DimensionDispatch as _;
use crate::fixed::Place;
use crate::render::{Output, Picture, render_stack};
use crate::sink::{Tone, Values};
use crate::{Cellular, Dimensions, Plane, Space, Vector, Worley, WorleyError};
use dapple_hash::Seed;
use dapple_raster::{Field, Fractal, Gradient, RasterError, RasterViewMut, Window};

/// Options for a fractal sum: the number of octaves, their frequency and amplitude ratios, and their seeds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Octaves {
    /// Number of octaves, from 1 to 32.
    ///
    /// The default is 6.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/octaves-count.md"))]
    #[cfg_attr(feature = "schema", schemars(transform = { Fractal::COUNT }))]
    pub count: u32,
    /// Frequency ratio of successive octaves, from 1 to 16.
    ///
    /// The default is 2.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/octaves-lacunarity.md"))]
    #[cfg_attr(feature = "schema", schemars(transform = { Fractal::LACUNARITY }))]
    pub lacunarity: f64,
    /// Amplitude ratio of successive octaves, from -1 to 1.
    ///
    /// The default is ½.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/octaves-gain.md"))]
    #[cfg_attr(feature = "serde", serde(alias = "persistence"))]
    #[cfg_attr(feature = "schema", schemars(transform = { Fractal::GAIN }))]
    pub gain: f64,
    /// Seeds of the octaves.
    ///
    /// By default, each octave has its own.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/octave-seeds.md"))]
    pub seeds: OctaveSeeds,
}

/// Whether the octaves of a fractal sum share a seed.
///
#[cfg_attr(doc, doc = include_str!("../docs/octave-seeds.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum OctaveSeeds {
    /// Same seed for all octaves, as in the paper: the octaves are one field, scaled around the origin.
    Same,
    /// Separate seed for each octave, with its own feature points.
    #[default]
    Own,
}

impl Default for Octaves {
    /// Returns six octaves with their own feature points. Each has twice the frequency and half the amplitude of the
    /// previous one.
    fn default() -> Self {
        Self {
            count: 6,
            lacunarity: 2.0,
            gain: 0.5,
            seeds: OctaveSeeds::Own,
        }
    }
}

impl Octaves {
    /// Returns the paper's sum: six octaves of the same field, each with twice the frequency and half the amplitude of
    /// the previous one.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            seeds: OctaveSeeds::Same,
            ..Self::default()
        }
    }
}

/// A fractal sum of octaves of a scalar texture.
///
#[cfg_attr(doc, doc = include_str!("../docs/fractal.md"))]
///
/// # Examples
///
/// ```
/// use dapple_worley::{Combination, Octaves, Worley3, hash::Seed};
///
/// let crumpled = Worley3::new(Seed(7)).combine(Combination::F1).fractal(Octaves::default())?;
/// assert!(crumpled.value([0.5, 0.25, 3.0]) > 0.0);
/// # Ok::<(), dapple_worley::WorleyError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CellularFractal<const N: usize> {
    octaves: Vec<Octave<N>>,
    /// Combination of the distances, shared by all octaves.
    tone: Tone,
    /// Maps the sum to a range; stored as a combination with one coefficient.
    range: Tone,
}

#[derive(Clone, Debug)]
struct Octave<const N: usize> {
    /// The octave's basis, with its own seed and period.
    worley: Worley<N>,
    /// Frequency relative to the first octave.
    frequency: f64,
    /// Amplitude relative to the first octave.
    weight: f32,
}

impl<const N: usize> Cellular<N>
where
    Dimensions: Space<N>,
{
    /// Returns the sum of several octaves of this texture.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if an option is out of its range, if the basis has a period and the
    /// lacunarity is not an integer, or if an octave's period is above 2^32 - 1 cells.
    pub fn fractal(&self, octaves: Octaves) -> Result<CellularFractal<N>, WorleyError> {
        let Octaves {
            count,
            lacunarity,
            gain,
            seeds,
        } = octaves;
        let has_period = self.worley.lattice.period.iter().any(|&period| period > 0);
        WorleyError::check_in(Fractal::COUNT, "number of octaves", count.into())?;
        WorleyError::check_in(Fractal::LACUNARITY, "lacunarity", lacunarity)?;
        WorleyError::check_in(Fractal::GAIN, "gain", gain)?;
        WorleyError::check(
            !has_period || lacunarity.fract() == 0.0,
            "lacunarity",
            lacunarity,
            "a whole number if there is a period",
        )?;
        let mut sum = Vec::new();
        // Octave i has the frequency lacunarity^i and the amplitude gain^i; the paper's sum has 2^i and 2^-i.
        let (mut frequency, mut weight) = (1.0, 1.0);
        for index in 0..count {
            let mut worley = match seeds {
                OctaveSeeds::Same => self.worley.clone(),
                OctaveSeeds::Own => self
                    .worley
                    .clone()
                    .with_seed(self.worley.seed.child("octave", u64::from(index))),
            };
            for period in &mut worley.lattice.period {
                // A higher octave has more cells in the same period; with a whole lacunarity, their number is whole.
                let cells = f64::from(*period) * frequency;
                WorleyError::check(
                    cells <= f64::from(u32::MAX),
                    "period of an octave",
                    cells,
                    "below 2^32",
                )?;
                *period = cells as u32;
            }
            sum.push(Octave {
                worley,
                frequency,
                weight: weight as f32,
            });
            frequency *= lacunarity;
            weight *= gain;
        }
        Ok(CellularFractal {
            octaves: sum,
            tone: self.tone,
            range: Tone::plain(crate::Combination::F1),
        })
    }
}

impl<const N: usize> CellularFractal<N>
where
    Dimensions: Space<N>,
{
    /// Returns the value at `position`; NaN if the position is out of range in one of the octaves (see
    /// [`Worley::sample`]).
    #[must_use]
    pub fn value(&self, position: impl Into<[f64; N]>) -> f32 {
        let position: [f64; N] = position.into();
        let mut sum = 0.0;
        for octave in &self.octaves {
            let Some(place) = octave.place(position) else {
                return f32::NAN;
            };
            sum += self.tone.at(&octave.worley, &place) * octave.weight;
        }
        self.value_of(sum)
    }

    /// Maps a sum of octaves to the range. All NaNs have the same bits.
    fn value_of(&self, sum: f32) -> f32 {
        if sum.is_nan() {
            return f32::NAN;
        }
        self.range.of(&[sum])
    }

    /// Returns the gradient of the value at `position`, per cell of the first octave. All components are NaN where the
    /// value is NaN.
    #[must_use]
    pub fn gradient(&self, position: impl Into<[f64; N]>) -> Vector<N> {
        let position: [f64; N] = position.into();
        let mut sum = [0.0; N];
        for octave in &self.octaves {
            let Some(place) = octave.place(position) else {
                return Vector::<N>::from([f64::NAN; N]);
            };
            // Chain rule: the derivative along the coordinates of the octave is multiplied by its frequency.
            let gradient = self.tone.gradient_at(&octave.worley, &place);
            let slope =
                f64::from(octave.weight * self.range.weights.coefficients()[0]) * octave.frequency;
            for axis in 0..N {
                sum[axis] += f64::from(gradient[axis]) * slope;
            }
        }
        Vector::<N>::from(sum)
    }

    /// Renders the values at the pixel centers of a window of a plane into `out`.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of `out` differs from the window's.
    pub fn render_plane(
        &self,
        plane: &Plane<N>,
        window: &Window,
        out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        self.render_slices(window, vec![(*plane, out)])
    }

    /// Renders several planes, such as the slices of a volume; see [`Cellular::render_slices`].
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of a view differs from the window's.
    /// All views are then unchanged.
    pub fn render_slices(
        &self,
        window: &Window,
        mut slices: Vec<(Plane<N>, RasterViewMut<'_, f32>)>,
    ) -> Result<(), RasterError> {
        for (_, out) in &slices {
            window.check_size(out.size())?;
        }
        for (_, out) in &mut slices {
            out.fill(0.0);
        }
        // Add the octaves one by one to all slices.
        for octave in &self.octaves {
            let values = Values {
                tone: self.tone,
                weight: Some(octave.weight),
            };
            let stack = slices.iter_mut().map(|(plane, out)| {
                let picture = Picture {
                    basis: Dimensions::basis(&octave.worley),
                    section: plane.section(),
                    window,
                    frequency: octave.frequency,
                };
                let bands = picture.bands(Some(out.reborrow()));
                let outputs = bands.map(|rows| Output::Values(values, rows));
                (picture, outputs.collect())
            });
            render_stack(stack.collect());
        }
        // Map the sums to the range.
        let rows = slices.iter_mut().flat_map(|(_, out)| out.rows_mut());
        for value in rows.flatten() {
            *value = self.value_of(*value);
        }
        Ok(())
    }

    /// Measures the range of the values at `n` random positions, ignoring the lowest and the highest thousandth.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if `n` is below 1000.
    pub fn measure_range(&self, seed: Seed, n: u32) -> Result<[f32; 2], WorleyError> {
        measure_range(seed, n, |position: [f64; N]| self.value(position))
    }

    /// Maps the values from `range` to 0 to 1. Values outside of the range are not clamped.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if the range is empty or not finite.
    pub fn with_range(self, range: [f32; 2]) -> Result<Self, WorleyError> {
        Ok(Self {
            range: self.range.with_range(range)?,
            ..self
        })
    }
}

impl<const N: usize> Field<N> for CellularFractal<N>
where
    Dimensions: Space<N>,
{
    fn value(&self, position: [f64; N]) -> f32 {
        self.value(position)
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        let mut tones = vec![0.0; values.len()];
        values.fill(0.0);
        for octave in &self.octaves {
            let scaled = positions.iter().map(|&position| octave.scaled(position));
            let scaled: Vec<_> = scaled.collect();
            // Octaves are added in the order of `value`, so that the bits agree.
            octave.worley.tones(&self.tone, &scaled, &mut tones);
            for (value, tone) in values.iter_mut().zip(&tones) {
                *value += tone * octave.weight;
            }
        }
        for value in values {
            *value = self.value_of(*value);
        }
        Ok(())
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        self.render_plane(&Plane::of_window(window), &window.in_plane(), out)
    }

    fn render_stack(
        &self,
        windows: &[Window<N>],
        outs: Vec<RasterViewMut<'_, f32>>,
    ) -> Result<(), RasterError> {
        render_windows(windows, outs, |window, slices| {
            self.render_slices(window, slices)
        })
    }

    /// Returns the period of the sum, in cells of the first octave. All octaves repeat with it.
    fn period(&self) -> [Option<f64>; N] {
        let first = self.octaves.first();
        first.map_or([None; N], |octave| octave.worley.period())
    }
}

impl<const N: usize> Gradient<N> for CellularFractal<N>
where
    Dimensions: Space<N>,
{
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let gradient: [f64; N] = self.gradient(position).into();
        (self.value(position), gradient.map(|part| part as f32))
    }
}

impl<const N: usize> Octave<N> {
    fn place(&self, position: [f64; N]) -> Option<Place<N>> {
        Place::new(self.scaled(position))
    }

    /// Converts a position from cells of the first octave to cells of this octave.
    fn scaled(&self, position: [f64; N]) -> [f64; N] {
        position.map(|part| part * self.frequency)
    }
}
