//! Scenes, and their rendering to images. Every pixel is the mean of a regular grid of samples.
//!
//! Reference: our own. The lighting of a sample, after Whitted 1980, is in `trace`.

use crate::trace::{Path, World};
use crate::{Camera, Environment, Light, Object, PreviewError};
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use glam::DVec2;

/// Maximum number of samples per pixel along each axis.
const SUPERSAMPLING_MAX: u32 = 64;
/// Maximum number of mirror reflections of a ray.
const BOUNCES_MAX: u32 = 16;

/// Objects, lights, and a camera.
///
/// # Examples
///
/// ```
/// use dapple_color::LinearRgb;
/// use dapple_preview::{Camera, Light, Material, Object, Scene, Shape, Supersampling, glam::DVec3};
///
/// let gray = |_: &_| Material::matte(LinearRgb::gray(0.5));
/// let scene = Scene::new(Camera::look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO))
///     .with_object(Object::new(Shape::sphere(1.0), gray))
///     .with_light(Light::directional(DVec3::Z, LinearRgb::WHITE));
/// let picture = scene.render([3, 3], Supersampling(1))?;
/// assert_eq!(picture.row(1)[1], LinearRgb::gray(0.5));
/// assert_eq!(picture.row(0)[0], LinearRgb::BLACK);
/// # Ok::<(), dapple_preview::PreviewError>(())
/// ```
#[derive(Debug)]
pub struct Scene<'a> {
    /// The camera.
    pub camera: Camera,
    /// The objects.
    pub objects: Vec<Object<'a>>,
    /// The lights.
    pub lights: Vec<Light>,
    /// The ambient light, which reaches every point from all directions and is never blocked. Default: black.
    pub ambient: LinearRgb,
    /// The environment, visible where there is no object. Default: black.
    pub environment: Environment<'a>,
    /// Maximum number of mirror reflections along a ray, from 0 to 16. A ray beyond that sees only the environment.
    /// Default: 1.
    pub bounces: u32,
}

/// Side of the regular grid of samples within a pixel, from 1 to 64. The number of samples is its square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Supersampling(pub u32);

impl<'a> Scene<'a> {
    /// Creates a scene with only a camera.
    #[must_use]
    pub fn new(camera: Camera) -> Self {
        Self {
            camera,
            objects: Vec::new(),
            lights: Vec::new(),
            ambient: LinearRgb::BLACK,
            environment: Environment::Constant(LinearRgb::BLACK),
            bounces: 1,
        }
    }

    /// Adds an object to the scene.
    #[must_use]
    pub fn with_object(mut self, object: Object<'a>) -> Self {
        self.objects.push(object);
        self
    }

    /// Adds a light to the scene.
    #[must_use]
    pub fn with_light(mut self, light: Light) -> Self {
        self.lights.push(light);
        self
    }

    /// Sets the ambient light.
    #[must_use]
    pub fn with_ambient(self, ambient: LinearRgb) -> Self {
        Self { ambient, ..self }
    }

    /// Sets the environment.
    #[must_use]
    pub fn with_environment(self, environment: Environment<'a>) -> Self {
        Self {
            environment,
            ..self
        }
    }

    /// Sets the maximum number of mirror reflections along a ray.
    #[must_use]
    pub fn with_bounces(self, bounces: u32) -> Self {
        Self { bounces, ..self }
    }

    /// Renders an image of `size` columns and rows, top row first. Runs on all cores if the feature `rayon` is on.
    ///
    /// Colors are linear, finite and not tone mapped: they may be above 1.
    ///
    /// # Errors
    ///
    /// [`Raster`](crate::PreviewErrorKind::Raster) if the image has no pixels or more than 2^31,
    /// [`NoDirection`](crate::PreviewErrorKind::NoDirection) if a direction of the camera, a light or a cut is zero,
    /// [`NotSolid`](crate::PreviewErrorKind::NotSolid) if a plane or a mesh is cut, and
    /// [`Range`](crate::PreviewErrorKind::Range) if a number is not finite or outside its documented range.
    pub fn render(
        &self,
        size: [u32; 2],
        samples: Supersampling,
    ) -> Result<Raster<LinearRgb>, PreviewError> {
        let Supersampling(side) = samples;
        let holds = (1..=SUPERSAMPLING_MAX).contains(&side);
        let what = "supersampling";
        PreviewError::check(holds, what, side.into(), "from 1 to 64")?;
        let holds = self.bounces <= BOUNCES_MAX;
        let what = "number of bounces";
        PreviewError::check(holds, what, self.bounces.into(), "from 0 to 16")?;
        let grid = size.map(|pixels| f64::from(pixels) * f64::from(side));
        let view = self.camera.prepare(grid)?;
        let world = World::new(self)?;
        // Average the samples of a pixel, row by row, in `f64`.
        let pixel = |column: u32, row: u32| {
            let corner = DVec2::new(column.into(), row.into()) * f64::from(side);
            let mut sum = [0.0_f64; 3];
            for index in 0..side * side {
                let inside = DVec2::new((index % side).into(), (index / side).into()) + 0.5;
                let path = Path::new(view.ray(corner + inside), view.sample, self.bounces);
                let color = world.light(&path).to_array();
                sum = core::array::from_fn(|part| sum[part] + f64::from(color[part]));
            }
            let count = f64::from(side * side);
            LinearRgb::from(sum.map(|part| (part / count) as f32))
        };
        let pixel = &pixel;
        let row = |row: u32| (0..size[0]).map(move |column| pixel(column, row));
        Ok(Raster::from_rows(size, row)?)
    }
}

#[cfg(test)]
mod tests;
