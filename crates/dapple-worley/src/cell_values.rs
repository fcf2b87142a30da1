//! A field with the random number of the Voronoi cell at each position.

use crate::worley::cell_value;
use crate::{Dimensions, FeatureView, Plane, Space, Worley};
use dapple_raster::{Field, FieldParts, RasterError, RasterViewMut, Window};

/// A field that gives each Voronoi cell a random number in `[0, 1)`. The number at a position is the
/// [`Feature::cell_value`](crate::Feature::cell_value) of the nearest feature point.
///
/// # Examples
///
/// ```
/// use dapple_worley::{Worley2, hash::Seed, raster::FieldExt};
///
/// let worley = Worley2::new(Seed(7));
/// let at = [0.25, 0.75];
/// assert_eq!(worley.cell_values().sample(at), worley.nearest(at).cell_value());
/// ```
#[derive(Clone, Debug)]
pub struct CellValues<const N: usize> {
    worley: Worley<N>,
}

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Returns the field of the cells' random numbers, in `[0, 1)`.
    #[must_use]
    pub fn cell_values(&self) -> CellValues<N> {
        CellValues {
            worley: self.clone(),
        }
    }
}

impl<const N: usize> CellValues<N>
where
    Dimensions: Space<N>,
{
    /// Returns the basis.
    #[must_use]
    pub fn worley(&self) -> &Worley<N> {
        &self.worley
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
        let nearest = FeatureView {
            cell_value: Some(out),
            ..FeatureView::default()
        };
        self.worley.render_features(plane, window, [nearest])
    }
}

impl<const N: usize> Field<N> for CellValues<N>
where
    Dimensions: Space<N>,
{
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Generator(self)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        let nearest = self.worley.nearest(position);
        value(nearest.distance, nearest.id)
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        self.worley
            .nearest_of_many(positions, |index, distance, id| {
                values[index] = value(distance, id);
            });
        Ok(())
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        self.render_plane(&Plane::of_window(window), &window.in_plane(), out)
    }

    fn period(&self) -> [Option<f64>; N] {
        self.worley.period()
    }
}

/// Returns a feature point's random number; NaN for a position out of range.
fn value(distance: f32, id: u64) -> f32 {
    if distance.is_nan() {
        return f32::NAN;
    }
    cell_value(id)
}
