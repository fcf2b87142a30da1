//! Cameras, and the rays through the samples of an image.

use crate::ray::Ray;
use crate::{PreviewError, PreviewErrorKind};
use glam::{DVec2, DVec3};

/// A perspective camera: an eye that looks at a point.
///
/// Row 0 of the image is the top, where `up` points. With y up, a camera on the positive z axis that looks at the
/// origin sees x to the right.
///
/// # Examples
///
/// ```
/// use dapple_preview::{Camera, glam::DVec3};
///
/// let camera = Camera::look_at(DVec3::new(0.0, 2.0, 5.0), DVec3::ZERO).with_fov(35_f64.to_radians());
/// assert_eq!(camera.up, DVec3::Y);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The position of the eye, in the world.
    pub eye: DVec3,
    /// The point at the center of the image, in the world.
    pub target: DVec3,
    /// The direction that appears upward in the image. It need not be perpendicular to the view. Default: +y.
    pub up: DVec3,
    /// Vertical field of view, in radians, above 0 and below π. Default: 0.7, which is 40°.
    pub vertical_fov: f64,
}

impl Camera {
    /// Creates a camera at `eye` that looks at `target`, with +y up and a field of view of 0.7 radians.
    #[must_use]
    pub fn look_at(eye: DVec3, target: DVec3) -> Self {
        Self {
            eye,
            target,
            up: DVec3::Y,
            vertical_fov: 0.7,
        }
    }

    /// Sets the up direction.
    #[must_use]
    pub fn with_up(self, up: DVec3) -> Self {
        Self { up, ..self }
    }

    /// Sets the vertical field of view, in radians.
    #[must_use]
    pub fn with_fov(self, vertical_fov: f64) -> Self {
        Self {
            vertical_fov,
            ..self
        }
    }

    /// Prepares the camera for an image of `samples` columns and rows.
    pub(crate) fn prepare(&self, samples: [f64; 2]) -> Result<View, PreviewError> {
        PreviewError::check_vector("eye of the camera", self.eye)?;
        PreviewError::check_vector("target of the camera", self.target)?;
        let fov = self.vertical_fov;
        let holds = (1e-9..core::f64::consts::PI).contains(&fov);
        PreviewError::check(
            holds,
            "field of view of the camera",
            fov,
            "from 1e-9 to below π",
        )?;
        // Build an orthonormal frame: forward, right and down.
        let forward = PreviewError::direction("view of the camera", self.target - self.eye)?;
        let up = PreviewError::direction("up of the camera", self.up)?;
        let across = forward.cross(up);
        // Below this angle, rounding would determine the direction of `right`.
        if across.length_squared() < 1e-24 {
            let what = "up of the camera, seen along its view,";
            return Err(PreviewError::new(PreviewErrorKind::NoDirection { what }));
        }
        let right = across.normalize();
        // Scale right and down to one sample at distance 1.
        let sample = 2.0 * libm::tan(0.5 * fov) / samples[1];
        Ok(View {
            eye: self.eye,
            forward,
            right: right * sample,
            down: -right.cross(forward) * sample,
            middle: DVec2::from(samples) * 0.5,
            sample,
        })
    }
}

/// A camera prepared for a grid of image samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    eye: DVec3,
    forward: DVec3,
    /// Vector from one sample to the next one to the right, at distance 1 from the eye.
    right: DVec3,
    /// Vector from one sample to the next one below, at distance 1 from the eye.
    down: DVec3,
    middle: DVec2,
    /// Width of a sample at the center of the image, at distance 1 from the eye.
    pub(crate) sample: f64,
}

impl View {
    /// Returns the ray through `at`, a point of the image in samples from the top left corner.
    pub(crate) fn ray(&self, at: DVec2) -> Ray {
        let offset = at - self.middle;
        let direction = self.forward + self.right * offset.x + self.down * offset.y;
        Ray {
            origin: self.eye,
            direction: direction.normalize(),
        }
    }
}
