//! Scalar textures of the basis: a combination at every position.

use crate::fixed::Place;
use crate::render::Picture;
use crate::sink::{Tone, Values};
use crate::{Axes, Combination, Plane, Space, Vector, Worley};
use dapple_raster::{Field, RasterError, RasterViewMut, Window};
use glam::DVec2;

/// A scalar texture: a combination of F1 to F4 at every position.
///
/// # Examples
///
/// ```
/// use dapple_worley::{Combination, Worley2, hash::Seed, raster::{Field, Window, glam::DVec2}};
///
/// let cracks = Worley2::new(Seed(7)).combine(Combination::F2_MINUS_F1);
/// let window = Window::new(DVec2::ZERO, DVec2::splat(4.0), [64, 64])?;
/// let raster = cracks.to_raster(&window)?;
/// assert_eq!(raster.row(3)[5], cracks.sample(window.position(5, 3)));
/// # Ok::<(), dapple_worley::raster::RasterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Cellular<const N: usize> {
    worley: Worley<N>,
    tone: Tone,
}

impl<const N: usize> Worley<N>
where
    Axes: Space<N>,
{
    /// The texture whose values are a combination of the distances.
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
    Axes: Space<N>,
{
    /// The value at a position. NaN if the position has no place, see [`Worley::sample`].
    #[must_use]
    pub fn value(&self, position: impl Into<Vector<N>>) -> f32 {
        let place = Place::new(position.into().into());
        place.map_or(f32::NAN, |place| self.tone.at(&self.worley, place))
    }

    /// The values at the pixel centers of a window of a plane, into memory of its size.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if `out` has another size than the window.
    pub fn render_plane(
        &self,
        plane: &Plane<N>,
        window: &Window,
        out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        self.picture(plane, window).render(out);
        Ok(())
    }

    pub(crate) fn picture<'a>(&'a self, plane: &'a Plane<N>, window: &'a Window) -> Picture<'a, N> {
        Picture {
            worley: &self.worley,
            plane,
            window,
            frequency: 1.0,
            values: Values { tone: self.tone, weight: None },
        }
    }
}

impl Field for Cellular<2> {
    fn sample(&self, position: DVec2) -> f32 {
        self.value(position)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        self.render_plane(&Plane::default(), window, out)
    }
}
