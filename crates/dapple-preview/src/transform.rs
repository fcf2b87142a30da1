//! The translation, rotation and scale of an object in the world.

use crate::PreviewError;
use crate::ray::Ray;
use glam::{DMat3, DQuat, DVec3};

/// A transform from object space to the world, which applies a scale, then a rotation, then a translation.
///
/// # Examples
///
/// ```
/// use dapple_mesh::rotation;
/// use dapple_preview::{Transform, glam::DVec3};
///
/// let tilted = Transform::from_translation(DVec3::Y).with_rotation(rotation(DVec3::X, 0.3));
/// assert_eq!(tilted.scale, 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// The position of the object's origin in the world. Default: the origin.
    pub translation: DVec3,
    /// The rotation of the object, normalized if its length differs from 1. Default: no rotation.
    pub rotation: DQuat,
    /// The size of one unit of the object in units of the world, above zero. Default: 1.
    pub scale: f64,
}

impl Default for Transform {
    fn default() -> Self {
        Self::from_translation(DVec3::ZERO)
    }
}

impl Transform {
    /// Creates a translation without rotation or scaling.
    #[must_use]
    pub fn from_translation(translation: DVec3) -> Self {
        Self {
            translation,
            rotation: DQuat::IDENTITY,
            scale: 1.0,
        }
    }

    /// Sets the rotation.
    #[must_use]
    pub fn with_rotation(self, rotation: DQuat) -> Self {
        Self { rotation, ..self }
    }

    /// Sets the scale.
    #[must_use]
    pub fn with_scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    pub(crate) fn prepare(&self) -> Result<Placement, PreviewError> {
        PreviewError::check_vector("translation of an object", self.translation)?;
        PreviewError::check_length("scale of an object", self.scale)?;
        let length = self.rotation.length();
        let holds = (1e-9..=1e9).contains(&length);
        let what = "length of a rotation as a quaternion";
        PreviewError::check(holds, what, length, "from 1e-9 to 1e9")?;
        Ok(Placement {
            translation: self.translation,
            rotation: DMat3::from_quat(self.rotation * (1.0 / length)),
            scale: self.scale,
            inverse_scale: 1.0 / self.scale,
        })
    }
}

/// A validated transform, with the rotation as a matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    translation: DVec3,
    rotation: DMat3,
    pub(crate) scale: f64,
    pub(crate) inverse_scale: f64,
}

impl Placement {
    /// Transforms a direction from world to object space. Its length is preserved.
    pub(crate) fn direction_to_object(&self, direction: DVec3) -> DVec3 {
        // The transpose of a rotation is its inverse.
        DVec3::new(
            self.rotation.x_axis.dot(direction),
            self.rotation.y_axis.dot(direction),
            self.rotation.z_axis.dot(direction),
        )
    }

    /// Transforms a direction from object to world space. Its length is preserved.
    pub(crate) fn direction_to_world(&self, direction: DVec3) -> DVec3 {
        self.rotation.x_axis * direction.x
            + self.rotation.y_axis * direction.y
            + self.rotation.z_axis * direction.z
    }

    /// Transforms a point from object to world space.
    pub(crate) fn point_to_world(&self, point: DVec3) -> DVec3 {
        self.direction_to_world(point) * self.scale + self.translation
    }

    /// Transforms a ray from world to object space, where distances along it are in units of the object.
    pub(crate) fn ray_to_object(&self, ray: &Ray) -> Ray {
        Ray {
            origin: self.direction_to_object(ray.origin - self.translation) * self.inverse_scale,
            direction: self.direction_to_object(ray.direction),
        }
    }
}
