//! Slices of textures of four dimensions, as fields of the plane.

use crate::{Cellular, EdgeDistances, Fractal, Plane};
use dapple_raster::glam::{DVec2, DVec4};
use dapple_raster::{Field, RasterError, RasterViewMut, Window};

/// A slice along the first two axes through a texture of four dimensions: a solid at one depth and one moment.
///
/// # Examples
///
/// ```
/// use dapple_worley::{Combination, Worley4, hash::Seed, raster::{Field, glam::DVec2}};
///
/// let sea = Worley4::new(Seed(7)).with_period([None, None, None, Some(2)])?.combine(Combination::F1);
/// let at = DVec2::new(0.25, 0.75);
/// assert_eq!(sea.slice([0.0, 0.5]).sample(at), sea.slice([0.0, 2.5]).sample(at), "a loop");
/// # Ok::<(), dapple_worley::WorleyError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Slice {
    texture: Texture,
    plane: Plane<4>,
}

#[derive(Clone, Debug)]
enum Texture {
    Cellular(Cellular<4>),
    Fractal(Fractal<4>),
    Edges(EdgeDistances<4>),
}

impl Cellular<4> {
    /// The slice at a place along the third and the fourth axis, in cells.
    #[must_use]
    pub fn slice(&self, place: [f64; 2]) -> Slice {
        Slice::new(Texture::Cellular(self.clone()), place)
    }
}

impl Fractal<4> {
    /// The slice at a place along the third and the fourth axis, in cells of the first octave.
    #[must_use]
    pub fn slice(&self, place: [f64; 2]) -> Slice {
        Slice::new(Texture::Fractal(self.clone()), place)
    }
}

impl EdgeDistances<4> {
    /// The slice at a place along the third and the fourth axis, in cells.
    #[must_use]
    pub fn slice(&self, place: [f64; 2]) -> Slice {
        Slice::new(Texture::Edges(self.clone()), place)
    }
}

impl Slice {
    fn new(texture: Texture, [z, w]: [f64; 2]) -> Self {
        let plane = Plane::slice(DVec4::new(0.0, 0.0, z, w));
        Self { texture, plane }
    }
}

impl Field for Slice {
    fn sample(&self, position: DVec2) -> f32 {
        let position = self.plane.position(position);
        match &self.texture {
            Texture::Cellular(cellular) => cellular.value(position),
            Texture::Fractal(fractal) => fractal.value(position),
            Texture::Edges(edges) => edges.value(position),
        }
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        let positions = positions
            .iter()
            .map(|&position| self.plane.position(position));
        let positions: Vec<_> = positions.collect();
        match &self.texture {
            Texture::Cellular(cellular) => cellular.values(&positions, values),
            Texture::Fractal(fractal) => fractal.values(&positions, values),
            Texture::Edges(edges) => {
                for (value, &position) in values.iter_mut().zip(&positions) {
                    *value = edges.value(position);
                }
            }
        }
        Ok(())
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        match &self.texture {
            Texture::Cellular(cellular) => cellular.render_plane(&self.plane, window, out),
            Texture::Fractal(fractal) => fractal.render_plane(&self.plane, window, out),
            Texture::Edges(edges) => edges.render_plane(&self.plane, window, out),
        }
    }

    fn period(&self) -> [Option<f64>; 2] {
        match &self.texture {
            Texture::Cellular(cellular) => cellular.worley.plane_period(),
            Texture::Fractal(fractal) => fractal.plane_period(),
            Texture::Edges(edges) => edges.worley.plane_period(),
        }
    }
}
