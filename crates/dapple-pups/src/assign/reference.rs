//! Computes labels from a reference image's intensities (figures 13 and 14).
//!
//! The paper takes "the intensity of the corresponding pixel": the pixel that contains the control point, without
//! interpolation. The image covers the points' domain, with its first row at the smallest y.

use super::values::random_value;
use crate::PupsError;
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet};
use dapple_raster::{Raster, Wrap};
use glam::DVec2;

/// A grayscale image with intensities from 0 (black) to 1 (white), as a source of labels.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceImage {
    intensities: Raster<f32>,
}

impl ReferenceImage {
    /// Creates a reference image after checking that every intensity is from 0 to 1.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PupsErrorKind::Range) if an intensity is not from 0 to 1, or NaN.
    pub fn new(intensities: Raster<f32>) -> Result<Self, PupsError> {
        for &intensity in intensities.pixels() {
            PupsError::check(
                (0.0..=1.0).contains(&intensity),
                "intensity in the reference image",
                f64::from(intensity),
                "between 0 and 1",
            )?;
        }
        Ok(Self { intensities })
    }

    /// Returns the raster of intensities, from 0 (black) to 1 (white).
    #[must_use]
    pub fn intensities(&self) -> &Raster<f32> {
        &self.intensities
    }

    /// Returns the intensity of the pixel at `position`. The image covers `domain`. Outside of the domain, the image
    /// repeats along axes that wrap; along other axes, its border pixels are extended.
    #[must_use]
    pub fn intensity(&self, domain: &Domain, position: DVec2) -> f32 {
        // Convert the position to fractions of the domain, then to pixels.
        let uv = (domain.wrap(position) - domain.origin) / domain.size;
        let [column, row] =
            [0, 1].map(|axis| (uv[axis] * f64::from(self.intensities.size()[axis])).floor() as i64);
        let wrap = domain
            .wrap
            .map(|wrap| if wrap { Wrap::Repeat } else { Wrap::Clamp });
        *self.intensities.at(column, row, wrap)
    }
}

/// Returns binary labels from a reference image that covers the points' domain. A point's label is 1 (white) if a
/// random number is below the intensity at the point, else 0 (black).
#[must_use]
pub fn reference_labels(points: &PointSet, image: &ReferenceImage, seed: Seed) -> Vec<u32> {
    let label = |(index, &position)| {
        let intensity = image.intensity(points.domain(), position);
        u32::from(random_value(seed, index) < intensity)
    };
    (0..).zip(points.positions()).map(label).collect()
}
