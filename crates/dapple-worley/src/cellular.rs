//! Scalar textures that combine F1 to F4 at every position.

use crate::fixed::Place;
use crate::ranges::range;
use crate::render::{Output, Picture, render_stack};
use crate::sink::{Tone, Values};
use crate::{Combination, Dimensions, Plane, Space, Vector, Worley, WorleyError, WorleyErrorKind};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Field, FieldParts, Gradient, RasterError, RasterViewMut, Window};

/// A scalar texture: a combination of F1 to F4 at every position.
///
/// # Examples
///
/// ```
/// use dapple_worley::{Combination, Worley2, hash::Seed, raster::{Field, Window}};
///
/// let cracks = Worley2::new(Seed(7)).combine(Combination::F2_MINUS_F1);
/// let window = Window::new([0.0; 2], [4.0; 2], [64, 64])?;
/// let raster = cracks.to_raster(&window)?;
/// assert_eq!(raster.row(3)[5], cracks.value(window.position(5, 3)));
/// # Ok::<(), dapple_worley::raster::RasterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Cellular<const N: usize> {
    pub(crate) worley: Worley<N>,
    pub(crate) tone: Tone,
}

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Returns the texture that combines the distances F1 to F4.
    #[must_use]
    pub fn combine(&self, combination: Combination) -> Cellular<N> {
        Cellular {
            worley: self.clone(),
            tone: Tone::plain(combination),
        }
    }
}

impl<const N: usize> Cellular<N>
where
    Dimensions: Space<N>,
{
    /// Returns the coefficients of the distances, scaled to the texture's range, and the constant that is added to
    /// their sum. For shaders.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_tone(&self) -> (Combination, f32) {
        (self.tone.weights, self.tone.shift)
    }

    /// Returns the basis that the texture combines.
    #[must_use]
    pub fn worley(&self) -> &Worley<N> {
        &self.worley
    }

    /// Returns the value at `position`; NaN if the position is out of range (see [`Worley::sample`]).
    #[must_use]
    pub fn value(&self, position: impl Into<[f64; N]>) -> f32 {
        let place = Place::new(position.into());
        place.map_or(f32::NAN, |place| self.tone.at(&self.worley, &place))
    }

    /// Returns the gradient of the value at `position`, per cell. It is the combination of the distances' gradients.
    ///
    /// The gradient is discontinuous at the borders between cells. All components are NaN if the position is out of
    /// range.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/gradient.md"))]
    #[must_use]
    pub fn gradient(&self, position: impl Into<[f64; N]>) -> Vector<N> {
        let place = Place::new(position.into());
        let gradient = place.map_or([f32::NAN; N], |place| {
            self.tone.gradient_at(&self.worley, &place)
        });
        Vector::<N>::from(gradient.map(f64::from))
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

    /// Renders several planes, such as the slices of a volume. Neighboring planes share their feature points, which is
    /// faster than rendering them one by one, especially if they are close together.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of a view differs from the window's.
    /// All views are then unchanged.
    ///
    /// # Examples
    ///
    /// Render a volume of 32 slices, stacked vertically in one raster:
    ///
    /// ```
    /// use dapple_worley::{Combination, Plane, Worley3, hash::Seed};
    /// use dapple_worley::raster::{Raster, Window, glam::DVec3};
    ///
    /// let texture = Worley3::new(Seed(1)).combine(Combination::F1);
    /// let window = Window::new([0.0; 2], [2.0; 2], [64, 64])?;
    /// let planes = (0..32).map(|slice| Plane::slice(DVec3::new(0.0, 0.0, f64::from(slice) / 32.0)));
    /// let mut volume = Raster::filled([64, 64 * 32], 0.0)?;
    /// texture.render_slices(&window, planes.zip(volume.view_mut().bands(64)).collect())?;
    /// # Ok::<(), dapple_worley::raster::RasterError>(())
    /// ```
    pub fn render_slices(
        &self,
        window: &Window,
        slices: Vec<(Plane<N>, RasterViewMut<'_, f32>)>,
    ) -> Result<(), RasterError> {
        for (_, out) in &slices {
            window.check_size(out.size())?;
        }
        let (planes, outs): (Vec<_>, Vec<_>) = slices.into_iter().unzip();
        let stack = planes.iter().zip(outs).map(|(plane, out)| {
            let picture = self.worley.feature_picture(plane, window);
            (picture, self.outputs(&picture, out))
        });
        render_stack(stack.collect());
        Ok(())
    }

    pub(crate) fn outputs<'v>(
        &self,
        picture: &Picture<'_>,
        out: RasterViewMut<'v, f32>,
    ) -> Vec<Output<'v>> {
        let values = Values {
            tone: self.tone,
            weight: None,
        };
        let bands = picture.bands(Some(out));
        bands.map(|rows| Output::Values(values, rows)).collect()
    }

    /// Measures the range of the values at `n` random positions, ignoring the lowest and the highest thousandth.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if `n` is below 1000.
    pub fn measure_range(&self, seed: Seed, n: u32) -> Result<[f32; 2], WorleyError> {
        measure_range(seed, n, |position: [f64; N]| self.value(position))
    }

    /// Maps the values so that their range is about 0 to 1: one value in a thousand is below 0, and one is above 1.
    ///
    /// The ranges come from a table of measurements. It covers [named combinations](Combination::NAMED), the default
    /// scatter and [`Scatter::Jittered`](crate::Scatter::Jittered) with a jitter of 1, and every metric except
    /// Minkowski's.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/normalized.md"))]
    ///
    /// # Errors
    ///
    /// [`NoRange`](crate::WorleyErrorKind::NoRange) for all other textures, and if the texture already has a range. In
    /// these cases, use [`measure_range`](Self::measure_range) and [`with_range`](Self::with_range).
    pub fn normalized(self) -> Result<Self, WorleyError> {
        let Worley {
            metric, scatter, ..
        } = self.worley;
        let no_range = |measured| WorleyError::new(WorleyErrorKind::NoRange { measured });
        if self.worley.lattice.density.is_some() {
            return Err(no_range("densities that do not vary"));
        }
        if self.tone.shift != 0.0 {
            return Err(no_range("textures that have no range yet"));
        }
        let range = range(N, metric, scatter, self.tone.weights).map_err(no_range)?;
        self.with_range(range)
    }

    /// Maps the values from `range` to 0 to 1. Values outside of the range are not clamped.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/with-range.md"))]
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if the range is empty or not finite.
    pub fn with_range(self, range: [f32; 2]) -> Result<Self, WorleyError> {
        Ok(Self {
            tone: self.tone.with_range(range)?,
            ..self
        })
    }
}

impl<const N: usize> Field<N> for Cellular<N>
where
    Dimensions: Space<N>,
{
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Generator(self)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.value(position)
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        self.worley.tones(&self.tone, positions, values);
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

    fn period(&self) -> [Option<f64>; N] {
        self.worley.period()
    }
}

impl<const N: usize> Gradient<N> for Cellular<N>
where
    Dimensions: Space<N>,
{
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let gradient: [f64; N] = self.gradient(position).into();
        (self.value(position), gradient.map(|part| part as f32))
    }
}

/// Renders windows of N-dimensional space. `render` receives all planes that have the same 2-D window, and renders
/// them together.
pub(crate) fn render_windows<'v, const N: usize>(
    windows: &[Window<N>],
    outs: Vec<RasterViewMut<'v, f32>>,
    render: impl Fn(&Window, Vec<(Plane<N>, RasterViewMut<'v, f32>)>) -> Result<(), RasterError>,
) -> Result<(), RasterError>
where
    Dimensions: Space<N>,
{
    RasterError::check_length(outs.len(), windows.len())?;
    let mut slices = windows.iter().zip(outs).peekable();
    // Render consecutive windows with equal pixels together.
    while let Some((first, out)) = slices.next() {
        let flat = first.in_plane();
        let mut stack = vec![(Plane::of_window(first), out)];
        while let Some((window, out)) = slices.next_if(|(next, _)| next.in_plane() == flat) {
            stack.push((Plane::of_window(window), out));
        }
        render(&flat, stack)?;
    }
    Ok(())
}

/// Measures the range of values at `n` random positions, ignoring the lowest and the highest thousandth.
pub(crate) fn measure_range<const N: usize>(
    seed: Seed,
    n: u32,
    value: impl Fn([f64; N]) -> f32,
) -> Result<[f32; 2], WorleyError> {
    /// Maximum distance of random positions from the origin along each axis, in cells. The range covers many cells, and
    /// `f64` is still finer than a step there.
    const EXTENT: f64 = (1 << 20) as f64;
    WorleyError::check(
        n >= 1000,
        "number of positions",
        f64::from(n),
        "at least 1000",
    )?;
    let position = |index: u32| {
        let hash = CellHash::new(seed, [i64::from(index)]);
        core::array::from_fn(|axis| EXTENT * unit_f64(hash.at(axis as u32)))
    };
    let mut values: Vec<_> = (0..n).map(|index| value(position(index))).collect();
    values.sort_by(f32::total_cmp);
    // Worley normalizes by a measured range, too. Without its extremes, it depends little on the positions.
    let left_out = (n / 1000) as usize;
    Ok([values[left_out], values[values.len() - 1 - left_out]])
}
