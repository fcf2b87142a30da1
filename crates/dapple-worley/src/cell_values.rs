//! The random number of the Voronoi cell at each position, as a field.

use crate::worley::cell_value;
use crate::{FeatureView, Plane, Worley2};
use dapple_raster::glam::DVec2;
use dapple_raster::{Field, RasterError, RasterViewMut, Window};

/// A random number in `[0, 1)` for each Voronoi cell: [`Feature::cell_value`](crate::Feature::cell_value) of the
/// nearest feature point.
///
/// # Examples
///
/// ```
/// use dapple_worley::{Worley2, hash::Seed, raster::{Field, glam::DVec2}};
///
/// let worley = Worley2::new(Seed(7));
/// let at = DVec2::new(0.25, 0.75);
/// assert_eq!(worley.cell_values().sample(at), worley.sample::<1>(at)[0].cell_value());
/// ```
#[derive(Clone, Debug)]
pub struct CellValues {
    worley: Worley2,
}

impl Worley2 {
    /// The texture whose value is the random number of the Voronoi cell, in `[0, 1)`.
    #[must_use]
    pub fn cell_values(&self) -> CellValues {
        CellValues {
            worley: self.clone(),
        }
    }
}

impl Field for CellValues {
    fn sample(&self, position: DVec2) -> f32 {
        let [nearest] = self.worley.sample(position);
        value(nearest.distance, nearest.id)
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        self.worley
            .nearest_of_many(positions, |index, distance, id| {
                values[index] = value(distance, id);
            });
        Ok(())
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        let nearest = FeatureView {
            cell_value: Some(out),
            ..FeatureView::default()
        };
        self.worley
            .render_features(&Plane::default(), window, [nearest])
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.worley.plane_period()
    }
}

/// The random number of a feature point, or NaN for a position without a place.
fn value(distance: f32, id: u64) -> f32 {
    if distance.is_nan() {
        return f32::NAN;
    }
    cell_value(id)
}
