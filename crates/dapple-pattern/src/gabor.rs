//! Gabor noise by sparse convolution, and its phase: wood fiber, brushed metal, ripples of sand, hair.
//!
//! A. Lagae, S. Lefebvre, G. Drettakis and P. Dutré, "Procedural Noise using Sparse Gabor Convolution", ACM Transactions
//! on Graphics 28(3), 2009, <https://doi.org/10.1145/1531326.1531360>, with the random phases of A. Lagae and G. Drettakis,
//! "Filtering Solid Gabor Noise", ACM Transactions on Graphics 30(4), 2011, <https://doi.org/10.1145/2010324.1964946>. The
//! phase is that of T. Tricard et al., "Procedural Phasor Noise", ACM Transactions on Graphics 38(4), 2019,
//! <https://doi.org/10.1145/3306346.3322990>.
//!
//! There are two differences. A cell has a fixed number of impulses, since a Poisson number leaves spots without any. The
//! kernel is `(1 − r²)³` instead of a Gaussian that is cut off: it differs by at most 0.05 from `exp(−3.76 r²)`, ends
//! smoothly at a distance of one cell, and needs no exponential function.
//!
//! Positions are in cells.

use crate::PatternError;
use crate::lattice::{self, check_period, wrapped_cell};
use crate::near::{self, NearCells};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Field, Range, RasterError, RasterViewMut, Window, range};

dapple_raster::named! {
    /// Value of Gabor noise.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum GaborValue {
        /// Sum of waves, with mean 0 and variance 1.
        #[default]
        Noise = "noise",
        /// Phase of the waves in turns, from 0 to below 1 (phasor noise): stripes of equal strength.
        Phase = "phase",
    }
}

/// Options of [`GaborNoise`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaborOptions {
    /// Period along each axis in cells; `None` for an axis without a period.
    pub period: [Option<u32>; 2],
    /// Frequency of the waves in waves per cell, from 0 to 64; by default 2. The kernel has a radius of one cell, so
    /// higher values give a narrower range of frequencies and directions.
    pub waves: f64,
    /// Number of impulses per cell, from 1 to 64; by default 8. Time is proportional to it. With 8 or more, values are
    /// nearly normally distributed.
    pub impulses: u32,
    /// Direction of the stripes, clockwise from the x axis in degrees, from −360 to 360; by default 0.
    pub angle: f64,
    /// Range of random directions around the angle in degrees, from 0 to 180 (all directions); by default 20.
    pub spread: f64,
}

/// Ranges of options, for the schema of recipes.
#[doc(hidden)]
impl GaborOptions {
    pub const WAVES: Range = range!(from 0 to 64);
    pub const IMPULSES: Range = range!(from 1 to 64);
    pub const ANGLE: Range = range!(from -360 to 360);
    pub const SPREAD: Range = range!(from 0 to 180);
}

impl Default for GaborOptions {
    fn default() -> Self {
        Self {
            period: [None; 2],
            waves: 2.0,
            impulses: 8,
            angle: 0.0,
            spread: 20.0,
        }
    }
}

/// Gabor noise: waves of about one length and direction, in random places.
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_pattern::{GaborNoise, GaborOptions, GaborValue};
/// use dapple_raster::FieldExt as _;
///
/// // Fibers along x that repeat after 4 cells, with 3 waves per cell
/// let options = GaborOptions { period: [Some(4), Some(4)], waves: 3.0, spread: 10.0, ..Default::default() };
/// let fibers = GaborNoise::new(Seed(7), options)?;
/// let (noise, phase) = (fibers.field(GaborValue::Noise), fibers.field(GaborValue::Phase));
/// assert_eq!(noise.sample([0.25, 0.5]), noise.sample([4.25, -3.5]));
/// assert!((0.0..1.0).contains(&phase.sample([0.25, 0.5])));
/// # Ok::<(), dapple_pattern::PatternError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GaborNoise {
    seed: Seed,
    options: GaborOptions,
}

impl GaborNoise {
    /// Creates the noise.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if an option is out of range.
    pub fn new(seed: Seed, options: GaborOptions) -> Result<Self, PatternError> {
        use GaborOptions as Of;
        check_period(options.period)?;
        for (range, what, value) in [
            (Of::WAVES, "number of waves per cell", options.waves),
            (Of::IMPULSES, "number of impulses", options.impulses.into()),
            (Of::ANGLE, "angle", options.angle),
            (Of::SPREAD, "spread of directions", options.spread),
        ] {
            PatternError::check_in(range, what, value)?;
        }
        Ok(Self {
            seed: seed.child("gabor", 0),
            options,
        })
    }

    /// Returns the field of a value of the noise, over positions in cells.
    #[must_use]
    pub fn field(&self, value: GaborValue) -> GaborField {
        GaborField {
            noise: self.clone(),
            value,
            scale: self.scale(),
        }
    }

    /// Returns the factor that scales the sum of the waves to a variance of 1.
    #[doc(hidden)]
    #[must_use]
    pub fn scale(&self) -> f64 {
        // The variance of a wave is 1/2, and the integral of the squared kernel is π/7.
        let variance = f64::from(self.options.impulses) * core::f64::consts::PI / 14.0;
        1.0 / variance.sqrt()
    }

    /// Returns the impulses of all cells of a period as words for a shader, 12 words per impulse, row by row of cells.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if the noise does not repeat along both axes, or has too many impulses
    /// for a texture.
    #[doc(hidden)]
    pub fn shader_words(&self) -> Result<Vec<u32>, PatternError> {
        let [columns, rows] = lattice::period_words(self.options.period);
        let cells = f64::from(columns) * f64::from(rows);
        let (what, range) = (
            "period of Gabor noise",
            "above 0 along both axes for a shader",
        );
        PatternError::check(cells > 0.0, what, 0.0, range)?;
        let count = cells * f64::from(self.options.impulses);
        let (what, range) = ("number of impulses in a shader", "at most 2^21");
        PatternError::check(count <= f64::from(1 << 21), what, count, range)?;
        let cells = (0..i64::from(rows)).flat_map(|y| (0..i64::from(columns)).map(move |x| [x, y]));
        let impulses = cells.flat_map(|cell| self.impulses(cell));
        let numbers = impulses.flat_map(|impulse| {
            let ([x, y], [wave_x, wave_y]) = (impulse.position, impulse.wave);
            [x, y, wave_x, wave_y, impulse.phase, 0.0]
        });
        Ok(numbers.flat_map(lattice::shader_words).collect())
    }

    /// Returns the impulses of a cell, with positions relative to the corner of the cell.
    fn impulses(&self, cell: [i64; 2]) -> impl Iterator<Item = Impulse> {
        let wrapped = wrapped_cell(cell, self.options.period);
        let hash = CellHash::new(self.seed, wrapped);
        (0..self.options.impulses).map(move |index| {
            let draw = |number: u32| unit_f64(hash.at(4 * index + number));
            let degrees = self.options.angle + (draw(2) - 0.5) * self.options.spread;
            let (sin, cos) = libm::sincos(degrees.to_radians());
            Impulse {
                position: [draw(0), draw(1)],
                wave: [-sin * self.options.waves, cos * self.options.waves],
                phase: draw(3),
            }
        })
    }
}

/// An impulse of the noise: a wave that fades out around a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impulse {
    position: [f64; 2],
    /// Gradient of the phase in turns per cell.
    wave: [f64; 2],
    /// Phase at the point, in turns.
    phase: f64,
}

impl Impulse {
    /// Returns the weight of the impulse at a position, and its phase there in turns; `None` if the position is out of
    /// its reach.
    #[inline(always)]
    fn at(&self, position: [f64; 2]) -> Option<[f64; 2]> {
        let [x, y] = [
            position[0] - self.position[0],
            position[1] - self.position[1],
        ];
        let rest = 1.0 - (x * x + y * y);
        let phase = self.phase + x * self.wave[0] + y * self.wave[1];
        (rest > 0.0).then_some([rest * rest * rest, phase])
    }
}

/// A value of [`GaborNoise`] as a field over positions in cells.
///
/// At a position that is not finite, the value is NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct GaborField {
    noise: GaborNoise,
    value: GaborValue,
    /// Factor that scales the sum of the waves to a variance of 1.
    scale: f64,
}

impl NearCells for GaborField {
    type Item = Impulse;

    fn near(&self, cell: [i64; 2], center: [f64; 2], half: [f64; 2], near: &mut Vec<Impulse>) {
        for y in -1..=1 {
            for x in -1..=1 {
                let other = [cell[0].wrapping_add(x), cell[1].wrapping_add(y)];
                let impulses = self.noise.impulses(other).map(|mut impulse| {
                    impulse.position[0] += x as f64;
                    impulse.position[1] += y as f64;
                    impulse
                });
                near.extend(impulses.filter(|impulse| Self::meets(impulse, center, half)));
            }
        }
    }

    fn meets(impulse: &Impulse, center: [f64; 2], half: [f64; 2]) -> bool {
        let [x, y] = [0, 1].map(|axis| {
            let distance = (impulse.position[axis] - center[axis]).abs();
            (distance - half[axis]).max(0.0)
        });
        // Rounding must not leave out an impulse.
        x * x + y * y < 1.000_001
    }

    fn value_of(&self, near: &[Impulse], position: [f64; 2]) -> f32 {
        let waves = near.iter().filter_map(|impulse| impulse.at(position));
        match self.value {
            GaborValue::Noise => {
                let sum: f64 = waves.map(|[weight, phase]| weight * cosine(phase)).sum();
                (self.scale * sum) as f32
            }
            GaborValue::Phase => {
                let (mut cos, mut sin) = (0.0, 0.0);
                for [weight, phase] in waves {
                    cos += weight * cosine(phase);
                    sin += weight * cosine(phase - 0.25);
                }
                let turns = libm::atan2(sin, cos) / core::f64::consts::TAU;
                let turns = (turns - turns.floor()) as f32;
                // Rounding leads to a whole turn, which is none.
                if turns < 1.0 { turns } else { 0.0 }
            }
        }
    }
}

impl Field for GaborField {
    fn value(&self, position: [f64; 2]) -> f32 {
        near::value(self, position)
    }

    fn values(&self, positions: &[[f64; 2]], values: &mut [f32]) -> Result<(), RasterError> {
        near::values(self, positions, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        near::render(self, window, out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.noise
            .options
            .period
            .map(|period| period.map(f64::from))
    }
}

/// Returns the cosine of an angle in turns, by the Taylor polynomial of degree 9 of the sine; its error is below 4e-6.
#[inline(always)]
fn cosine(turns: f64) -> f64 {
    // The sine of the distance from a quarter turn, which is at most a quarter turn
    let turns = turns - (turns + 0.5).floor();
    let angle = core::f64::consts::TAU * (0.25 - turns.abs());
    let square = angle * angle;
    let series = 1.0 / 120.0 + square * (-1.0 / 5040.0 + square * (1.0 / 362_880.0));
    angle * (1.0 + square * (-1.0 / 6.0 + square * series))
}

#[cfg(test)]
mod tests {
    use super::{GaborField, GaborNoise, GaborOptions, GaborValue, cosine};
    use core::f64::consts::TAU;
    use dapple_hash::Seed;
    use dapple_raster::{Field as _, FieldExt as _, Named as _, Window};

    fn noise() -> GaborNoise {
        let options = GaborOptions {
            period: [Some(4), Some(3)],
            spread: 120.0,
            ..GaborOptions::default()
        };
        GaborNoise::new(Seed(7), options).unwrap()
    }

    /// Computes a value from all impulses of 5 × 5 cells, with the cosine of libm.
    fn oracle(field: &GaborField, [x, y]: [f64; 2]) -> f64 {
        let (mut cos, mut sin) = (0.0, 0.0);
        let cell = [x, y].map(|coordinate| coordinate.floor() as i64);
        for other in (0..25).map(|index| [cell[0] + index % 5 - 2, cell[1] + index / 5 - 2]) {
            for impulse in field.noise.impulses(other) {
                let dx = x - impulse.position[0] - other[0] as f64;
                let dy = y - impulse.position[1] - other[1] as f64;
                let rest = (1.0 - dx * dx - dy * dy).max(0.0);
                let turns = impulse.phase + dx * impulse.wave[0] + dy * impulse.wave[1];
                let weight = rest * rest * rest;
                cos += weight * libm::cos(TAU * turns);
                sin += weight * libm::sin(TAU * turns);
            }
        }
        match field.value {
            GaborValue::Noise => field.scale * cos,
            GaborValue::Phase => libm::atan2(sin, cos) / TAU,
        }
    }

    #[test]
    fn values_are_those_of_all_impulses_around() {
        let window = Window::new([-1.3, 2.2], [5.0, 4.0], [83, 71]).unwrap();
        for &value in GaborValue::ALL {
            let field = noise().field(value);
            let raster = field.to_raster(&window).unwrap();
            let positions: Vec<_> = (0..83 * 71)
                .map(|pixel| window.position(pixel % 83, pixel / 83))
                .collect();
            let mut values = vec![0.0; positions.len()];
            field.values(&positions, &mut values).unwrap();
            assert_eq!(raster.pixels(), values);
            let mut worst: f64 = 0.0;
            for (&position, &found) in positions.iter().zip(&values) {
                assert_eq!(field.value(position).to_bits(), found.to_bits());
                let error = f64::from(found) - oracle(&field, position);
                worst = worst.max(match value {
                    GaborValue::Noise => error.abs(),
                    // A phase is undefined where the waves cancel out.
                    GaborValue::Phase => (error - error.round()).abs().min(0.001),
                });
            }
            // Up to about 25 impulses, each with the error of the cosine
            let tolerance = if value == GaborValue::Noise {
                1e-4
            } else {
                0.001
            };
            assert!(worst <= tolerance, "{value}: {worst}");
        }
    }

    #[test]
    fn periods_are_exact_and_windows_are_crops() {
        for &value in GaborValue::ALL {
            let field = noise().field(value);
            assert_eq!(field.period(), [Some(4.0), Some(3.0)]);
            let at = |x, y| Window::new([x, y], [4.0, 3.0], [64, 64]).unwrap();
            let here = field.to_raster(&at(0.0, 0.0)).unwrap();
            let there = field.to_raster(&at(4e6, -3072.0)).unwrap();
            assert_eq!(here.pixels(), there.pixels());
            let part = field.to_raster(&at(0.0, 0.0).crop([7, 30], [20, 30]).unwrap());
            assert_eq!(part.unwrap(), here.crop([7, 30], [20, 30]).unwrap());
        }
    }

    #[test]
    fn noise_has_mean_0_and_variance_1_and_the_given_waves() {
        let window = Window::new([0.0; 2], [64.0; 2], [512; 2]).unwrap();
        let options = GaborOptions {
            spread: 0.0,
            ..GaborOptions::default()
        };
        let noise = GaborNoise::new(Seed(3), options).unwrap();
        let field = noise.field(GaborValue::Noise);
        let raster = field.to_raster(&window).unwrap();
        let numbers = raster.pixels().iter().map(|&value| f64::from(value));
        let n = 512.0 * 512.0;
        let mean = numbers.clone().sum::<f64>() / n;
        let variance = numbers.map(|value| value * value).sum::<f64>() / n;
        // Values of 64 × 64 cells, each with about one independent number: a deviation of 1/64, twice that of squares
        assert!(mean.abs() < 0.05, "{mean}");
        assert!((variance - 1.0).abs() < 0.1, "{variance}");
        // Half a wave across the stripes, the noise is the opposite; along the stripes, it is nearly the same.
        let shifted = |x: f64, y: f64| {
            let shifted = field.clone().offset([x, y]).to_raster(&window).unwrap();
            let pairs = raster.pixels().iter().zip(shifted.pixels());
            pairs.map(|(a, b)| f64::from(a * b)).sum::<f64>() / n
        };
        assert!(shifted(0.0, 0.25) < -0.7, "{}", shifted(0.0, 0.25));
        assert!(shifted(0.25, 0.0) > 0.7, "{}", shifted(0.25, 0.0));
    }

    #[test]
    fn the_cosine_is_that_of_libm() {
        for step in -4000..4000 {
            let turns = f64::from(step) * 0.000_917;
            let error = cosine(turns) - libm::cos(TAU * turns);
            assert!(error.abs() < 4e-6, "{turns}: {error}");
        }
    }

    #[test]
    fn options_out_of_range_are_refused() {
        let refused = |change: fn(&mut GaborOptions)| {
            let mut options = GaborOptions::default();
            change(&mut options);
            GaborNoise::new(Seed(7), options).is_err()
        };
        assert!(refused(|of| of.waves = -1.0) && refused(|of| of.waves = f64::NAN));
        assert!(refused(|of| of.impulses = 0) && refused(|of| of.impulses = 65));
        assert!(refused(|of| of.angle = 361.0) && refused(|of| of.spread = 181.0));
        assert!(refused(|of| of.period = [None, Some(0)]));
        assert!(!refused(|_| ()));
    }

    #[test]
    fn value_stability_gabor() {
        let found = [GaborValue::Noise, GaborValue::Phase].map(|value| {
            let field = noise().field(value);
            [[0.5, 0.5], [1.25, 2.75]].map(|at| field.sample(at).to_bits())
        });
        let expected = [
            [1_069_844_061, 1_057_979_210],
            [1_065_124_331, 1_031_390_444],
        ];
        assert_eq!(found, expected);
    }
}
