//! Which way the texture runs: a vector at every site from a few directions of the user (section 4.1).

use crate::SynthError;
use dapple_mesh::{Hierarchy, Surface};
use glam::DVec3;

/// A direction that the texture is to have near a position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Direction {
    /// A position; the nearest site gets the direction.
    pub at: DVec3,
    /// Any vector; its part in the tangent plane counts.
    pub vector: DVec3,
}

/// A unit tangent vector O at every site: the texture's "down".
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    vectors: Vec<DVec3>,
}

impl Orientation {
    /// Interpolates directions over the surface by pull-push; without any direction, it is `fallback` everywhere.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Direction`](crate::SynthErrorKind::Direction).
    pub fn new(
        surface: &Surface,
        hierarchy: &Hierarchy,
        directions: &[Direction],
    ) -> Result<Self, SynthError> {
        // SKELETON: the projected z axis. To be replaced.
        let _ = (surface, directions);
        let vectors = hierarchy.sites().normals().iter().map(|&normal| {
            (DVec3::Z - normal * normal.z).normalize_or(normal.any_orthonormal_vector())
        });
        Ok(Self {
            vectors: vectors.collect(),
        })
    }

    /// The unit vectors at the sites.
    #[must_use]
    pub fn vectors(&self) -> &[DVec3] {
        &self.vectors
    }
}
