//! Renders the nearest feature points (distances, vectors, positions, ids, random numbers) and gradients.

use crate::dispatch::DimensionDispatch as _;
use crate::fixed::STEP;
use crate::render::{Output, Picture};
use crate::sink::Tone;
use crate::{Cellular, Dimensions, MAX_NEAREST, Plane, Space, Worley};
use dapple_raster::{RasterError, RasterViewMut, Window};

/// Output views for one rank of nearest feature point, such as the second nearest. Outputs that are `None` are not
/// computed.
///
#[cfg_attr(doc, doc = include_str!("../docs/feature.md"))]
///
/// # Examples
///
/// ```
/// use dapple_worley::{FeatureView, Plane, Worley2, hash::Seed, raster::{Raster, Window, glam::DVec2}};
///
/// let worley = Worley2::new(Seed(7));
/// let window = Window::new(DVec2::ZERO, DVec2::splat(4.0), [64, 64])?;
/// let mut ids = Raster::filled(window.size, 0)?;
/// let nearest = FeatureView { id: Some(ids.view_mut()), ..FeatureView::default() };
/// worley.render_features(&Plane::default(), &window, [nearest])?;
/// assert_eq!(ids.row(3)[5], worley.sample::<1>(window.position(5, 3))[0].id);
/// # Ok::<(), dapple_worley::raster::RasterError>(())
/// ```
#[derive(Debug)]
pub struct FeatureView<'a, const N: usize> {
    /// Distances, in cells.
    pub distance: Option<RasterViewMut<'a, f32>>,
    /// Vectors from the feature points to the pixels, in cells.
    pub vector: Option<RasterViewMut<'a, [f32; N]>>,
    /// Positions of the feature points, in cells.
    pub position: Option<RasterViewMut<'a, [f64; N]>>,
    /// Ids of the feature points.
    pub id: Option<RasterViewMut<'a, u64>>,
    /// Random numbers of the feature points, in `[0, 1)`; see [`Feature::cell_value`](crate::Feature::cell_value). NaN
    /// at a pixel that is out of range.
    pub cell_value: Option<RasterViewMut<'a, f32>>,
}

impl<const N: usize> Default for FeatureView<'_, N> {
    /// Returns a view without outputs.
    fn default() -> Self {
        Self {
            distance: None,
            vector: None,
            position: None,
            id: None,
            cell_value: None,
        }
    }
}

/// The rows of a band, for one rank of nearest feature point. Outputs that are not computed have no rows.
#[derive(Debug, Default)]
pub(crate) struct FeatureRows<'a> {
    pub(crate) distance: Vec<&'a mut [f32]>,
    /// Vectors with interleaved components.
    pub(crate) vector: Vec<&'a mut [f32]>,
    /// Positions with interleaved components.
    pub(crate) position: Vec<&'a mut [f64]>,
    pub(crate) id: Vec<&'a mut [u64]>,
    pub(crate) cell_value: Vec<&'a mut [f32]>,
}

impl FeatureRows<'_> {
    /// Returns whether ids are needed.
    pub(crate) fn wants_ids(&self) -> bool {
        !self.id.is_empty() || !self.cell_value.is_empty()
    }
}

/// Returns a feature point's coordinate along one axis, in cells: the pixel's coordinate minus `way`, the component of
/// the vector from the point to the pixel.
pub(crate) fn position((cell, steps): (i64, i32), way: f32) -> f64 {
    cell as f64 + f64::from(steps) * f64::from(STEP) - f64::from(way)
}

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Renders the `K` nearest feature points at the pixel centers of a window of a plane, nearest point first. The
    /// results equal those of [`sample`](Self::sample), bit for bit. `K` is from 1 to 4.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of a view differs from the window's.
    pub fn render_features<const K: usize>(
        &self,
        plane: &Plane<N>,
        window: &Window,
        mut views: [FeatureView<'_, N>; K],
    ) -> Result<(), RasterError> {
        const {
            assert!(
                K >= 1 && K <= MAX_NEAREST,
                "F1 to F4 are there to be asked for"
            );
        };
        for view in &views {
            let sizes = [
                view.distance.as_ref().map(RasterViewMut::size),
                view.vector.as_ref().map(RasterViewMut::size),
                view.position.as_ref().map(RasterViewMut::size),
                view.id.as_ref().map(RasterViewMut::size),
                view.cell_value.as_ref().map(RasterViewMut::size),
            ];
            for size in sizes.into_iter().flatten() {
                window.check_size(size)?;
            }
        }
        // Collect the rows of each band from the views.
        let picture = self.feature_picture(plane, window);
        let n_bands = picture.n_bands();
        let mut bands: Vec<Vec<FeatureRows<'_>>> = Vec::new();
        bands.resize_with(n_bands, Vec::new);
        for view in &mut views {
            let mut distance = picture.bands(view.distance.take());
            let mut vector = picture.bands(view.vector.take());
            let mut position = picture.bands(view.position.take());
            let mut id = picture.bands(view.id.take());
            let mut cell_value = picture.bands(view.cell_value.take());
            for band in &mut bands {
                band.push(FeatureRows {
                    distance: distance.next().unwrap_or_default(),
                    vector: vector.next().map(flattened).unwrap_or_default(),
                    position: position.next().map(flattened).unwrap_or_default(),
                    id: id.next().unwrap_or_default(),
                    cell_value: cell_value.next().unwrap_or_default(),
                });
            }
        }
        picture.render(bands.into_iter().map(Output::Features).collect());
        Ok(())
    }

    pub(crate) fn feature_picture<'a>(
        &'a self,
        plane: &Plane<N>,
        window: &'a Window,
    ) -> Picture<'a> {
        Picture {
            basis: Dimensions::basis(self),
            section: plane.section(),
            window,
            frequency: 1.0,
        }
    }
}

impl<const N: usize> Cellular<N>
where
    Dimensions: Space<N>,
{
    /// Renders the gradients at the pixel centers of a window of a plane into `out`. The results equal those of
    /// [`gradient`](Self::gradient), bit for bit.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/gradient.md"))]
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of `out` differs from the window's.
    pub fn render_gradient(
        &self,
        plane: &Plane<N>,
        window: &Window,
        out: RasterViewMut<'_, [f32; N]>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let picture = self.worley.feature_picture(plane, window);
        let bands = picture.bands(Some(out));
        let bands = bands.map(|rows| Output::Gradients(self.tone, flattened(rows)));
        picture.render(bands.collect());
        Ok(())
    }
}

/// Converts rows of vectors to rows of interleaved components.
pub(crate) fn flattened<T, const N: usize>(rows: Vec<&mut [[T; N]]>) -> Vec<&mut [T]> {
    rows.into_iter().map(|row| row.as_flattened_mut()).collect()
}

impl Tone {
    /// Returns the gradient of the combination at a pixel, given the vectors to it from its nearest points.
    #[inline]
    pub(crate) fn gradient<const N: usize>(
        &self,
        metric: crate::Metric,
        vectors: &[[f32; N]],
    ) -> [f32; N] {
        let mut sum = [0.0; N];
        for (&vector, coefficient) in vectors.iter().zip(self.weights.coefficients()) {
            if coefficient != 0.0 {
                // The gradient of a combination is the combination of the gradients of F1 to F4.
                let gradient = metric.gradient(vector);
                for axis in 0..N {
                    sum[axis] += coefficient * gradient[axis];
                }
            }
        }
        sum
    }

    /// Returns the gradient at `place`.
    pub(crate) fn gradient_at<const N: usize>(
        &self,
        worley: &Worley<N>,
        place: &crate::fixed::Place<N>,
    ) -> [f32; N]
    where
        Dimensions: Space<N>,
    {
        let vectors = worley
            .nearest_hits(self.depth(), place)
            .map(|hit| hit.vector);
        self.gradient(worley.metric, &vectors)
    }
}
