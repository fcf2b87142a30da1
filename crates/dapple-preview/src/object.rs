//! Objects in a scene.

use crate::shape::Body;
use crate::transform::Placement;
use crate::{Cut, Material, PreviewError, Shape, Surface, Transform};
use core::fmt;
use glam::DVec3;

/// A shape with a transform and a material.
///
/// # Examples
///
/// ```
/// use dapple_color::LinearRgb;
/// use dapple_preview::{Material, Object, Shape, glam::DVec3};
///
/// let ball = Object::new(Shape::sphere(1.0), |surface| {
///     let stripe = surface.position.y * 4.0;
///     Material::matte(LinearRgb::gray((stripe - stripe.floor()) as f32))
/// })
/// .at(DVec3::new(0.0, 1.0, 0.0));
/// # let _ = ball;
/// ```
pub struct Object<'a> {
    shape: Shape,
    transform: Transform,
    cut: Option<Cut>,
    look: Look<'a>,
}

/// A function that returns an object's material at a surface point.
type Look<'a> = Box<dyn Fn(&Surface) -> Material + Send + Sync + 'a>;

impl<'a> Object<'a> {
    /// Creates an object at the origin of the world, with the material that `look` returns for each surface point.
    ///
    /// `look` is called from several threads, and must depend on the surface alone.
    #[must_use]
    pub fn new(shape: Shape, look: impl Fn(&Surface) -> Material + Send + Sync + 'a) -> Self {
        Self {
            shape,
            transform: Transform::default(),
            cut: None,
            look: Box::new(look),
        }
    }

    /// Moves the object's origin to `translation`, a position in the world.
    #[must_use]
    pub fn at(mut self, translation: DVec3) -> Self {
        self.transform.translation = translation;
        self
    }

    /// Sets the transform from object space to the world.
    #[must_use]
    pub fn with_transform(self, transform: Transform) -> Self {
        Self { transform, ..self }
    }

    /// Cuts the object open. Only spheres and tori can be cut.
    #[must_use]
    pub fn with_cut(self, cut: Cut) -> Self {
        let cut = Some(cut);
        Self { cut, ..self }
    }

    pub(crate) fn prepare(&self) -> Result<Placed<'_>, PreviewError> {
        Ok(Placed {
            body: self.shape.prepare(self.cut)?,
            placement: self.transform.prepare()?,
            look: &*self.look,
        })
    }
}

impl fmt::Debug for Object<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Object")
            .field("shape", &self.shape)
            .field("transform", &self.transform)
            .field("cut", &self.cut)
            .finish_non_exhaustive()
    }
}

/// A validated object, with its placement in the world.
pub(crate) struct Placed<'a> {
    pub(crate) body: Body<'a>,
    pub(crate) placement: Placement,
    pub(crate) look: &'a (dyn Fn(&Surface) -> Material + Send + Sync + 'a),
}
