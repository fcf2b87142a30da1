//! Textures of labels: every position has the label of its strongest control point, and every label has a value.
//!
//! The paper labels a pixel by "the control point with the highest weight"; if several are equal, the first is used
//! here. Weights of control points with equal labels are not added.

use crate::{Pups, PupsError};
use dapple_points::PointIdx;
use dapple_raster::{Field, FieldParts, Raster, RasterError, RasterViewMut, Window};

/// A texture that gives every position the value of its strongest control point's label.
///
/// No other values occur, except NaN at a position that is not finite.
///
/// # Examples
///
/// ```
/// use dapple_pups::points::{Domain, white_noise};
/// use dapple_pups::raster::{FieldExt, glam::DVec2};
/// use dapple_pups::{LabelTexture, Pups, hash::Seed, random_labels};
///
/// let points = white_noise(Domain::paper_torus(), 50, Seed(1))?;
/// let labels = random_labels(50, 3, Seed(2))?;
/// let texture = LabelTexture::new(Pups::delaunay(&points)?, labels, vec![0.0, 0.5, 1.0])?;
/// let position = DVec2::new(0.3, -0.2);
/// let label = texture.label(position).unwrap();
/// assert_eq!(texture.sample(position), texture.values()[label as usize]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LabelTexture {
    pups: Pups,
    labels: Vec<u32>,
    values: Vec<f32>,
}

/// A texture that gives every position the vector, such as a color, of its strongest control point's label. It is a
/// [`LabelTexture`] whose values have `N` components.
#[derive(Clone, Debug)]
pub struct VectorLabelTexture<const N: usize> {
    pups: Pups,
    labels: Vec<u32>,
    values: Vec<[f32; N]>,
}

/// Checks that every label has a value, and that all values are finite.
fn check(pups: &Pups, labels: &[u32], n_values: usize, numbers: &[f32]) -> Result<(), PupsError> {
    PupsError::check_count("labels", labels.len(), pups.n_points())?;
    if let Some(&label) = labels.iter().find(|&&label| label as usize >= n_values) {
        PupsError::check_count("values of labels", n_values, label as usize + 1)?;
    }
    for &number in numbers {
        let finite = number.is_finite();
        PupsError::check(finite, "value of a label", f64::from(number), "finite")?;
    }
    Ok(())
}

/// Renders, for each pixel of a window, `value` of its strongest control point into `out`.
fn render_labels<T: Copy>(
    pups: &Pups,
    window: &Window,
    mut out: RasterViewMut<'_, T>,
    value: impl Fn(PointIdx) -> T,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    // Find the strongest control point of each pixel, and look up its value.
    let mut strongest = Raster::filled(window.size, PointIdx(u32::MAX))?;
    pups.render_strongest(window, strongest.view_mut())?;
    for (row, values) in (0..).zip(out.rows_mut()) {
        for (out, &point) in values.iter_mut().zip(strongest.row(row)) {
            *out = value(point);
        }
    }
    Ok(())
}

impl LabelTexture {
    /// Creates a texture from the label of each control point and the value of each label.
    ///
    /// # Errors
    ///
    /// [`Count`](crate::PupsErrorKind::Count) if the number of labels is not the number of control points or a label
    /// has no value, [`Range`](crate::PupsErrorKind::Range) if a value is not finite.
    pub fn new(pups: Pups, labels: Vec<u32>, values: Vec<f32>) -> Result<Self, PupsError> {
        check(&pups, &labels, values.len(), &values)?;
        Ok(Self {
            pups,
            labels,
            values,
        })
    }

    /// Returns the net of the control points.
    #[must_use]
    pub fn pups(&self) -> &Pups {
        &self.pups
    }

    /// Returns the label of each control point.
    #[must_use]
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Returns the value of each label.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Returns the label at `position`; `None` if the position is not finite.
    #[must_use]
    pub fn label(&self, position: impl Into<[f64; 2]>) -> Option<u32> {
        let point = self.pups.strongest(position)?;
        Some(self.labels[point.index()])
    }

    /// Renders the labels at the pixel centers of a window. The label is `u32::MAX` where a position is not finite.
    ///
    /// # Errors
    ///
    /// [`Empty`](dapple_raster::RasterErrorKind::Empty) or [`TooLarge`](dapple_raster::RasterErrorKind::TooLarge) if
    /// the size of the window is invalid.
    pub fn label_raster(&self, window: &Window) -> Result<Raster<u32>, RasterError> {
        let mut raster = Raster::filled(window.size, u32::MAX)?;
        let label = |point: PointIdx| self.labels.get(point.index()).copied();
        render_labels(&self.pups, window, raster.view_mut(), |point| {
            label(point).unwrap_or(u32::MAX)
        })?;
        Ok(raster)
    }

    /// Replaces the values of the labels.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new).
    pub fn with_values(self, values: Vec<f32>) -> Result<Self, PupsError> {
        Self::new(self.pups, self.labels, values)
    }

    /// Replaces the value of each label by a vector, such as a color.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new).
    pub fn with_vectors<const N: usize>(
        self,
        values: Vec<[f32; N]>,
    ) -> Result<VectorLabelTexture<N>, PupsError> {
        VectorLabelTexture::new(self.pups, self.labels, values)
    }

    /// Returns the value of a point's label; NaN if `point` is `None`.
    fn of_point(&self, point: Option<PointIdx>) -> f32 {
        let label = point.and_then(|point| self.labels.get(point.index()));
        label.map_or(f32::NAN, |&label| self.values[label as usize])
    }
}

impl Field for LabelTexture {
    fn parts(&self) -> FieldParts<'_> {
        FieldParts::Generator(self)
    }

    fn value(&self, position: [f64; 2]) -> f32 {
        self.of_point(self.pups.strongest(position))
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        render_labels(&self.pups, window, out, |point| self.of_point(Some(point)))
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.pups.domain().period()
    }
}

impl<const N: usize> VectorLabelTexture<N> {
    /// Creates a texture from the label of each control point and the vector of each label.
    ///
    /// # Errors
    ///
    /// Same as [`LabelTexture::new`].
    pub fn new(pups: Pups, labels: Vec<u32>, values: Vec<[f32; N]>) -> Result<Self, PupsError> {
        check(&pups, &labels, values.len(), values.as_flattened())?;
        Ok(Self {
            pups,
            labels,
            values,
        })
    }

    /// Returns the vector at `position`; NaN if the position is not finite.
    #[must_use]
    pub fn sample(&self, position: impl Into<[f64; 2]>) -> [f32; N] {
        self.of_point(self.pups.strongest(position))
    }

    /// Renders the vectors at the pixel centers of a window into `out`.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of `out` differs from the window's.
    pub fn render(
        &self,
        window: &Window,
        out: RasterViewMut<'_, [f32; N]>,
    ) -> Result<(), RasterError> {
        render_labels(&self.pups, window, out, |point| self.of_point(Some(point)))
    }

    /// Renders the vectors at the pixel centers of a window to a new raster.
    ///
    /// # Errors
    ///
    /// [`Empty`](dapple_raster::RasterErrorKind::Empty) or [`TooLarge`](dapple_raster::RasterErrorKind::TooLarge) if
    /// the size of the window is invalid.
    pub fn to_raster(&self, window: &Window) -> Result<Raster<[f32; N]>, RasterError> {
        let mut raster = Raster::filled(window.size, [0.0; N])?;
        self.render(window, raster.view_mut())?;
        Ok(raster)
    }

    fn of_point(&self, point: Option<PointIdx>) -> [f32; N] {
        let label = point.and_then(|point| self.labels.get(point.index()));
        label.map_or([f32::NAN; N], |&label| self.values[label as usize])
    }
}
