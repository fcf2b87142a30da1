//! Perlin's gradient noise, evaluated at any position.
//!
//! Ken Perlin, "An Image Synthesizer", SIGGRAPH 1985, <https://doi.org/10.1145/325334.325247>, with the quintic blend and
//! the gradients of "Improving Noise", SIGGRAPH 2002, <https://doi.org/10.1145/566570.566636>.
//!
//! There are three differences from the 2002 paper. Corners of cells are hashed with a seed instead of being looked up
//! in a table of 256 numbers, so the noise repeats only if it has a period. All gradients are equally likely. Axes are
//! blended from the last to the first, so that a row of pixels needs only two numbers per column of corners.
//!
//! Positions are in units of cells; the side of a cell is the distance between adjacent corners.

use crate::gradients::gradient;
use crate::lines::Lines;
#[cfg(feature = "simd")]
use crate::many;
use dapple_hash::{LatticeHash, Seed};
#[cfg(feature = "simd")]
use dapple_raster::simd;
use dapple_raster::simd::{Level, dispatch};
use dapple_raster::{
    Field, FieldParts, Fractal, FractalShape, Gradient, RasterError, RasterViewMut, Window,
};

/// Number of corners that are hashed at once.
const LANES: usize = 32;

/// Maximum number of corners of a cell that share their first coordinate.
pub(crate) const MOST_CORNERS: usize = 8;

/// Perlin's improved noise. Every corner of a lattice of unit cells has a random gradient. At a corner, the noise is
/// 0 and its slope is that gradient; in between, the noise is smooth.
///
/// The value at integer positions is therefore 0, for every seed. For a grid of blocks or tiles, sample between the
/// corners, for example at the block number times 0.1, or use [`fractal`](Self::fractal), whose octaves are offset.
///
/// Most of the power is between ½ and 1½ cycles per cell. The value and its first and second derivatives are
/// continuous. Over all positions and seeds, the mean is 0 and the variance is `VARIANCE` (0.0931 in 2-D, 0.0729 in
/// 3-D, 0.0857 in 4-D). The absolute value is at most `BOUND` (1, 1.0364 and 1.5366). Values are not normalized. At a
/// position that is not finite, the value is NaN.
///
#[cfg_attr(doc, doc = include_str!("../docs/gradient-noise.md"))]
///
/// # Examples
///
/// ```
/// use dapple_noise::{GradientNoise3, hash::Seed};
///
/// let noise = GradientNoise3::new(Seed(7)).with_period([Some(4), None, None])?;
/// assert_eq!(noise.sample([0.25, 1e9, -3.5]), noise.sample([4.25, 1e9, -3.5]));
/// assert_eq!(noise.sample([3.0, -8.0, 21.0]), 0.0);
/// # Ok::<(), dapple_noise::raster::RasterError>(())
/// ```
///
/// A looping animation with a period of 6 cells of time:
///
/// ```
/// use dapple_noise::{GradientNoise3, hash::Seed, raster::prelude::*};
///
/// let noise = GradientNoise3::new(Seed(7)).with_period([None, None, Some(6)])?;
/// let window = Window::unit([64, 64])?;
/// let [first, last] = [0.5, 6.5].map(|time| noise.slice([time]).to_raster(&window));
/// assert_eq!(first?, last?);
/// # Ok::<(), dapple_noise::raster::RasterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(into = "Description", try_from = "Description")
)]
pub struct GradientNoise<const N: usize> {
    seed: Seed,
    pub(crate) hash: LatticeHash<N>,
    /// Period along each axis, in cells; 0 for no period.
    pub(crate) period: [u32; N],
    /// Offset added to positions along each axis, in cells, stored as the bits of an `f64`; 0 except in the octaves of
    /// a sum.
    offset: [u64; N],
}

/// Gradient noise in two dimensions.
pub type GradientNoise2 = GradientNoise<2>;

/// Gradient noise in three dimensions.
pub type GradientNoise3 = GradientNoise<3>;

/// Gradient noise in four dimensions, such as space and time.
pub type GradientNoise4 = GradientNoise<4>;

impl GradientNoise<2> {
    /// Creates the noise for `seed`.
    #[must_use]
    pub const fn new(seed: Seed) -> Self {
        Self::of(seed)
    }

    /// Maximum absolute value, which some seeds attain in the middle of cells.
    pub const BOUND: f32 = 1.0;

    /// Variance over all positions and seeds.
    pub const VARIANCE: f32 = 0.093_062;
}

impl GradientNoise<3> {
    /// Creates the noise for `seed`.
    #[must_use]
    pub const fn new(seed: Seed) -> Self {
        Self::of(seed)
    }

    /// Upper bound on the absolute value.
    pub const BOUND: f32 = 1.0364;

    /// Variance over all positions and seeds.
    pub const VARIANCE: f32 = 0.072_919;
}

impl GradientNoise<4> {
    /// Creates the noise for `seed`.
    #[must_use]
    pub const fn new(seed: Seed) -> Self {
        Self::of(seed)
    }

    /// Upper bound on the absolute value.
    pub const BOUND: f32 = 1.5366;

    /// Variance over all positions and seeds.
    pub const VARIANCE: f32 = 0.085_703;
}

/// Serialized form of gradient noise.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Description {
    seed: Seed,
    /// Period along each axis, in cells; `None` for no period.
    period: Vec<Option<u32>>,
    /// Offset of an octave along each axis, in cells.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    offset: Vec<f64>,
}

#[cfg(feature = "serde")]
impl<const N: usize> From<GradientNoise<N>> for Description {
    fn from(noise: GradientNoise<N>) -> Self {
        let has_offset = noise.offset != [0; N];
        let offset = noise.offset.map(f64::from_bits);
        Self {
            seed: noise.seed,
            period: noise.periods().to_vec(),
            offset: if has_offset {
                offset.to_vec()
            } else {
                Vec::new()
            },
        }
    }
}

#[cfg(feature = "serde")]
impl<const N: usize> TryFrom<Description> for GradientNoise<N> {
    type Error = RasterError;

    fn try_from(description: Description) -> Result<Self, RasterError> {
        let Description {
            seed,
            period,
            offset,
        } = description;
        RasterError::check_length(period.len(), N)?;
        let period = core::array::from_fn(|axis| period[axis]);
        let mut noise = Self::of(seed).with_period(period)?;
        if !offset.is_empty() {
            RasterError::check_length(offset.len(), N)?;
            for (bits, offset) in noise.offset.iter_mut().zip(offset) {
                RasterError::check_range(offset.is_finite(), "offset", offset, "finite")?;
                *bits = offset.to_bits();
            }
        }
        Ok(noise)
    }
}

impl<const N: usize> GradientNoise<N> {
    const fn of(seed: Seed) -> Self {
        Self {
            seed,
            hash: LatticeHash::new(seed),
            period: [0; N],
            offset: [0; N],
        }
    }

    /// Makes the noise repeat exactly after a number of cells along each axis; `None` for an axis without a period.
    ///
    /// # Errors
    ///
    /// [`Range`](dapple_raster::RasterErrorKind::Range) if a period is 0.
    pub fn with_period(self, period: [Option<u32>; N]) -> Result<Self, RasterError> {
        let holds = !period.contains(&Some(0));
        RasterError::check_range(holds, "period", 0.0, "at least 1 cell")?;
        let period = period.map(|cells| cells.unwrap_or(0));
        Ok(Self { period, ..self })
    }

    /// Returns the period along each axis, in cells; `None` for an axis without a period.
    #[must_use]
    pub fn periods(&self) -> [Option<u32>; N] {
        self.period.map(|cells| (cells > 0).then_some(cells))
    }

    /// Returns the noise as a structure for shaders: the 16 words of `GradientNoise` in the WGSL of `dapple-wgsl`. `weight`
    /// is the weight of an octave in a fractal sum; it does not affect the noise itself.
    ///
    /// # Errors
    ///
    /// [`Range`](dapple_raster::RasterErrorKind::Range) if a period is above 2^31 cells, or if deserialized noise has an
    /// offset that is not a multiple of 2^-24 from 0 to below 128.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_noise::{GradientNoise2, hash::Seed, raster::FractalShape};
    ///
    /// // The octaves of a fractal sum, as a buffer
    /// let sum = GradientNoise2::new(Seed(7)).fractal(6, 0.5, 2.0, FractalShape::Sum)?;
    /// let mut words = Vec::new();
    /// for (noise, _frequency, weight) in sum.octaves() {
    ///     words.extend(noise.shader_words(weight)?);
    /// }
    /// assert_eq!(words.len(), 6 * 16);
    /// # Ok::<(), dapple_noise::raster::RasterError>(())
    /// ```
    pub fn shader_words(&self, weight: f32) -> Result<[u32; 16], RasterError> {
        const { assert!(N <= 4, "a vector of a shader has four components") };
        let mut words = [0; 16];
        for axis in 0..N {
            let period = self.period[axis];
            RasterError::check_range(
                period <= 1 << 31,
                "period of noise in a shader",
                f64::from(period),
                "at most 2^31",
            )?;
            let offset = f64::from_bits(self.offset[axis]);
            let parts = offset * f64::from(1 << 24);
            RasterError::check_range(
                (0.0..128.0).contains(&offset) && parts.fract() == 0.0,
                "offset of noise in a shader",
                offset,
                "a multiple of 2^-24 from 0 to below 128",
            )?;
            words[axis] = self.hash.key(axis);
            words[4 + axis] = period;
            words[8 + axis] = parts as u32;
        }
        words[12] = weight.to_bits();
        Ok(words)
    }

    /// Returns the value at a position in cells.
    #[must_use]
    pub fn sample(&self, position: impl Into<[f64; N]>) -> f32 {
        match self.around(position.into()) {
            Some((offsets, parts)) => Self::between_corners(&offsets, &parts),
            None => f32::NAN,
        }
    }

    /// Returns a position's offset within its cell along each axis, and the hash parts of the corners on both sides;
    /// `None` if a coordinate is not finite.
    #[inline(always)]
    fn around(&self, position: [f64; N]) -> Option<([f32; N], [[u32; 2]; N])> {
        // Use loops: `array::map` is not inlined for three or more axes.
        let mut offsets = [0.0; N];
        let mut parts = [[0; 2]; N];
        for axis in 0..N {
            let place = Place::of(self.moved(position[axis], axis));
            if !place.offset.is_finite() {
                return None;
            }
            offsets[axis] = place.offset;
            let [near, far] = self.pair(place.cell, axis);
            parts[axis] = [self.hash.part(axis, near), self.hash.part(axis, far)];
        }
        Some((offsets, parts))
    }

    /// Interpolates between the corners of a cell.
    #[inline(always)]
    fn between_corners(offsets: &[f32; N], parts: &[[u32; 2]; N]) -> f32 {
        let mut columns = [[Column::default(); MOST_CORNERS]; 2];
        for index in 0..corners(N) {
            let mut row = 0;
            for axis in 1..N {
                row ^= parts[axis][index >> (axis - 1) & 1];
            }
            for side in 0..2 {
                let bits = LatticeHash::<N>::bits(row ^ parts[0][side]);
                columns[side][index] = Column::of(gradient(bits), index, offsets);
            }
        }
        let [left, right] = columns;
        let sides = [Column::blend(left, offsets), Column::blend(right, offsets)];
        Column::between(sides, offsets[0], fade(offsets[0]))
    }

    /// Computes the values at many positions in cells. They equal those of [`sample`](Self::sample) and take about a
    /// quarter of the time. `values` must be as long as `positions`.
    ///
    /// # Errors
    ///
    /// [`Length`](dapple_raster::RasterErrorKind::Length) if the lengths differ.
    pub fn sample_many<P: Copy + Into<[f64; N]>>(
        &self,
        positions: &[P],
        values: &mut [f32],
    ) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        #[cfg(feature = "simd")]
        many::fill(self, simd::level(), positions, values);
        #[cfg(not(feature = "simd"))]
        for (value, &position) in values.iter_mut().zip(positions) {
            *value = self.sample(position);
        }
        Ok(())
    }

    /// Returns the value at a position in cells, equal to [`sample`](Self::sample), and its derivative along each
    /// axis, per cell. All are NaN if a coordinate is not finite.
    #[doc(alias("derivative", "analytic derivatives"))]
    #[must_use]
    pub fn sample_with_gradient(&self, position: impl Into<[f64; N]>) -> (f32, [f32; N]) {
        self.value_and_gradient(position.into())
    }

    /// Returns the gradients at lattice corners along a line parallel to the first axis. `columns` are the first
    /// coordinates of the corners; `at` has the other coordinates, and its first one is ignored.
    pub(crate) fn line(&self, level: Level, at: [i64; N], columns: &[i64]) -> Vec<[f32; N]> {
        let row = self.row(at);
        let mut gradients = Vec::with_capacity(columns.len());
        for columns in columns.chunks(LANES) {
            let mut parts = [0; LANES];
            for (part, &column) in parts.iter_mut().zip(columns) {
                *part = self.part(0, column) ^ row;
            }
            let bits = dispatch!(level, _simd => bits_of::<N>(&parts));
            gradients.extend(bits[..columns.len()].iter().map(|&bits| gradient(bits)));
        }
        gradients
    }

    /// Returns the combined hash part of all of a corner's coordinates except the first, which varies fastest.
    pub(crate) fn row(&self, at: [i64; N]) -> u32 {
        (1..N).fold(0, |row, axis| row ^ self.part(axis, at[axis]))
    }

    /// Returns the hash part of a corner's coordinate along `axis`, wrapped by the period.
    pub(crate) fn part(&self, axis: usize, coordinate: i64) -> u32 {
        let coordinate = match self.period[axis] {
            0 => coordinate,
            period => coordinate.rem_euclid(i64::from(period)),
        };
        self.hash.part(axis, coordinate)
    }

    /// Returns the coordinate plus the noise's offset along `axis`.
    #[inline(always)]
    pub(crate) const fn moved(&self, coordinate: f64, axis: usize) -> f64 {
        coordinate + f64::from_bits(self.offset[axis])
    }

    /// Returns the coordinates of the corners on both sides of a cell along an axis, wrapped by the period.
    #[inline(always)]
    pub(crate) fn pair(&self, cell: i64, axis: usize) -> [i64; 2] {
        match self.period[axis] {
            0 => [cell, cell.wrapping_add(1)],
            period => {
                let near = cell.rem_euclid(i64::from(period));
                [
                    near,
                    if near + 1 == i64::from(period) {
                        0
                    } else {
                        near + 1
                    },
                ]
            }
        }
    }

    /// Returns the noise for each octave of a fractal sum, coarsest first. Each octave has a separate seed and offset.
    /// Its period equals the period of this noise, converted to the octave's cells.
    ///
    /// Without offsets, all octaves with an integer lacunarity would be 0 at integer positions. Offsets are odd
    /// multiples of 2^-9, so that positions on a coarser grid are shifted exactly and periods are preserved.
    pub(crate) fn octaves(&self, count: u32, lacunarity: f64) -> Result<Vec<Self>, RasterError> {
        let range = Fractal::COUNT;
        let holds = range.holds(count.into());
        RasterError::check_range(holds, "number of octaves", count.into(), range.text)?;
        let has_period = self.period.iter().any(|&period| period > 0);
        RasterError::check_range(
            !has_period || lacunarity.fract() == 0.0,
            "lacunarity",
            lacunarity,
            "a whole number if there is a period",
        )?;
        let mut octaves = Vec::new();
        let mut frequency = 1.0;
        for octave in 0..count {
            let mut noise = Self {
                period: self.period,
                ..Self::of(self.seed.child("octave", u64::from(octave)))
            };
            for (axis, offset) in noise.offset.iter_mut().enumerate() {
                let bits = noise.seed.child("offset", axis as u64).0 >> 56;
                *offset = ((2 * bits + 1) as f64 / 512.0).to_bits();
            }
            for period in noise.period.iter_mut().filter(|period| **period > 0) {
                let cells = f64::from(*period) * frequency;
                let holds = cells <= f64::from(u32::MAX);
                RasterError::check_range(holds, "period of an octave", cells, "below 2^32")?;
                *period = cells as u32;
            }
            octaves.push(noise);
            frequency *= lacunarity;
        }
        Ok(octaves)
    }

    /// Creates the fractal sum of several octaves, `Σ gain^i · shape(noise_i(lacunarity^i · position + offset_i))`,
    /// where each octave has a separate seed and offset.
    ///
    /// The sum is not divided by the sum of the weights, `w = Σ |gain|^i` ([`Fractal::weight`]). For gains from 0 to
    /// 1, values are from `-w` to `w` for [`Sum`](FractalShape::Sum), and from 0 to `w` for
    /// [`Ridged`](FractalShape::Ridged) and [`Billow`](FractalShape::Billow).
    ///
    /// # Errors
    ///
    /// [`Range`](dapple_raster::RasterErrorKind::Range) unless there are 1 to 32 octaves, the gain is from -1 to 1,
    /// the lacunarity is from 1 to 16 (a whole number if the noise has a period), and periods stay below 2^32 cells.
    #[doc(alias("fBm", "fbm", "ridged", "billow", "turbulence"))]
    pub fn fractal(
        &self,
        octaves: u32,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    ) -> Result<Fractal<Self>, RasterError> {
        Fractal::new(self.octaves(octaves, lacunarity)?, gain, lacunarity, shape)
    }
}

/// Positions are in cells. Windows are rendered on all cores if the feature `rayon` is enabled.
impl<const N: usize> Field<N> for GradientNoise<N> {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Generator(self)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.sample(position)
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        self.sample_many(positions, values)
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        Lines::new(self, window).render(out)
    }

    fn period(&self) -> [Option<f64>; N] {
        self.periods().map(|cells| cells.map(f64::from))
    }
}

impl<const N: usize> Gradient<N> for GradientNoise<N> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let Some((offsets, parts)) = self.around(position) else {
            return (f32::NAN, [f32::NAN; N]);
        };
        let value = Self::between_corners(&offsets, &parts);
        // Blend weights of both sides of the cell along each axis, and their derivatives
        let (mut weights, mut slopes) = ([[0.0; 2]; N], [0.0; N]);
        for axis in 0..N {
            let t = offsets[axis];
            weights[axis] = [1.0 - fade(t), fade(t)];
            slopes[axis] = 30.0 * t * t * (t - 1.0) * (t - 1.0);
        }
        let mut sum = [0.0; N];
        for corner in 0..1_usize << N {
            let side = |axis: usize| corner >> axis & 1;
            // Linear function of the corner: its gradient and its value here
            let bits = (0..N).fold(0, |bits, axis| bits ^ parts[axis][side(axis)]);
            let linear = gradient::<N>(LatticeHash::<N>::bits(bits));
            let height = |axis: usize| linear[axis] * (offsets[axis] - side(axis) as f32);
            let height = (0..N).map(height).sum::<f32>();
            for axis in 0..N {
                // Product rule: the blend weight changes along the axis, and so does the linear function.
                let others = (0..N).filter(|&other| other != axis);
                let others = others
                    .map(|other| weights[other][side(other)])
                    .product::<f32>();
                let slope = if side(axis) == 1 {
                    slopes[axis]
                } else {
                    -slopes[axis]
                };
                sum[axis] += others * (slope * height + weights[axis][side(axis)] * linear[axis]);
            }
        }
        (value, sum)
    }
}

/// A coordinate split into a cell and an offset from 0 to 1. The offset is NaN if the coordinate is not finite.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) cell: i64,
    pub(crate) offset: f32,
}

/// 1.5 · 2^52. The lower bits of its sum with a number below 2^51 in absolute value contain the nearest integer.
pub(crate) const SHIFT: f64 = 6_755_399_441_055_744.0;

impl Place {
    #[inline(always)]
    pub(crate) fn of(coordinate: f64) -> Self {
        if coordinate.abs() < 2_251_799_813_685_248.0 {
            let shifted = coordinate + SHIFT;
            let cell = shifted
                .to_bits()
                .wrapping_sub(SHIFT.to_bits())
                .cast_signed();
            let cell = cell - i64::from(shifted - SHIFT > coordinate);
            // Convert the cell back; a selection by the comparison would be a branch that is mispredicted half of the
            // time.
            let floor = cell as f64;
            return Self {
                cell,
                // Adding 0 turns a negative zero into zero.
                offset: (coordinate - floor + 0.0) as f32,
            };
        }
        let floor = coordinate.floor();
        Self {
            cell: floor as i64,
            offset: (coordinate - floor) as f32,
        }
    }
}

/// The contribution of a column of corners at an offset `t` along the first axis, which is `slope · t + value`.
#[derive(Clone, Copy, Default)]
pub(crate) struct Column {
    slope: f32,
    value: f32,
}

impl Column {
    /// Returns the contribution of one corner of a column, given its gradient and its index in the order of
    /// [`corner`].
    #[inline(always)]
    pub(crate) fn of<const N: usize>(gradient: [f32; N], index: usize, offsets: &[f32; N]) -> Self {
        let mut value = 0.0;
        for axis in 1..N {
            let far = (index >> (axis - 1) & 1) as f32;
            value += gradient[axis] * (offsets[axis] - far);
        }
        let slope = gradient[0];
        Self { slope, value }
    }

    /// Interpolates between the corners of a column, given in the order of [`corner`], along the second axis first and
    /// the last axis last.
    #[inline(always)]
    pub(crate) fn blend<const N: usize>(
        mut columns: [Self; MOST_CORNERS],
        offsets: &[f32; N],
    ) -> Self {
        for axis in 1..N {
            let by = fade(offsets[axis]);
            for pair in 0..corners(N) >> axis {
                let [near, far] = [columns[2 * pair], columns[2 * pair + 1]];
                columns[pair] = Self {
                    slope: near.slope + by * (far.slope - near.slope),
                    value: near.value + by * (far.value - near.value),
                };
            }
        }
        columns[0]
    }

    /// Interpolates between two columns, at the distance `t` from the left one; `by` is `fade(t)`.
    #[inline(always)]
    pub(crate) fn between([left, right]: [Self; 2], t: f32, by: f32) -> f32 {
        let near = left.slope * t + left.value;
        let far = right.slope * (t - 1.0) + right.value;
        near + by * (far - near)
    }
}

/// Returns random bits for corners, from the hash parts of their coordinates. Compilers vectorize the loop.
#[inline(always)]
fn bits_of<const N: usize>(parts: &[u32; LANES]) -> [u32; LANES] {
    let mut all = [0; LANES];
    for (bits, &part) in all.iter_mut().zip(parts) {
        *bits = LatticeHash::<N>::bits(part);
    }
    all
}

/// Returns a corner of a cell with the same first coordinate. Bit `k` of the index selects one of the two coordinates
/// along axis `k + 1`.
pub(crate) fn corner<const N: usize>(mut cell: [i64; N], index: usize) -> [i64; N] {
    for (axis, coordinate) in cell.iter_mut().enumerate().skip(1) {
        *coordinate = coordinate.wrapping_add((index >> (axis - 1) & 1) as i64);
    }
    cell
}

/// Returns the number of corners of a cell that share their first coordinate, in `axes` dimensions.
pub(crate) const fn corners(axes: usize) -> usize {
    1 << (axes - 1)
}

/// Computes Perlin's quintic fade function, `6 t⁵ - 15 t⁴ + 10 t³`. Its first and second derivatives are 0 at both
/// ends.
#[inline(always)]
pub(crate) fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[cfg(test)]
mod tests;
