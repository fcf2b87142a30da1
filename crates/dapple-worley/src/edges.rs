//! A texture with the distance to the nearest edge of the Voronoi cell.

use crate::render::Output;
use crate::{Dimensions, Metric, Plane, Space, Worley};
use dapple_raster::{Field, FieldParts, RasterError, RasterViewMut, Window};

/// A texture whose value is the distance to the nearest edge of the Voronoi cell; see [`Worley::edge_distance`].
///
/// # Examples
///
/// ```
/// use dapple_worley::{Worley2, hash::Seed, raster::{Field, Window}};
///
/// let worley = Worley2::new(Seed(7));
/// let edges = worley.edge_distances();
/// let window = Window::new([0.0; 2], [4.0; 2], [64, 64])?;
/// let raster = edges.to_raster(&window)?;
/// assert_eq!(raster.row(3)[5], worley.edge_distance(window.position(5, 3)));
/// # Ok::<(), dapple_worley::raster::RasterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EdgeDistances<const N: usize> {
    /// The basis, with the metric set to Euclidean.
    pub(crate) worley: Worley<N>,
}

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Returns the texture of the distances to the nearest edge of the Voronoi cell.
    #[must_use]
    pub fn edge_distances(&self) -> EdgeDistances<N> {
        let worley = Self {
            metric: Metric::Euclidean,
            ..self.clone()
        };
        EdgeDistances { worley }
    }
}

impl<const N: usize> EdgeDistances<N>
where
    Dimensions: Space<N>,
{
    /// Returns the basis.
    #[must_use]
    pub fn worley(&self) -> &Worley<N> {
        &self.worley
    }

    /// Returns the [`Worley::edge_distance`] at `position`.
    #[must_use]
    pub fn value(&self, position: impl Into<[f64; N]>) -> f32 {
        self.worley.edge_distance(position)
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
        window.check_size(out.size())?;
        let picture = self.worley.feature_picture(plane, window);
        picture.render(picture.bands(Some(out)).map(Output::Edges).collect());
        Ok(())
    }
}

impl<const N: usize> Field<N> for EdgeDistances<N>
where
    Dimensions: Space<N>,
{
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Generator(self)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.value(position)
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        self.render_plane(&Plane::of_window(window), &window.in_plane(), out)
    }

    fn period(&self) -> [Option<f64>; N] {
        self.worley.period()
    }
}
