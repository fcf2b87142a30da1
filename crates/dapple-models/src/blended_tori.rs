//! Three tori through each other.

use crate::solid::{Blend, Torus};
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// The distance from the origin to the middle of the tubes; they meet at this distance on the axes.
pub const RING: f64 = 0.78;
/// The radius of the tubes.
pub const TUBE: f64 = 0.2;

/// A side of the lattice that is small enough for all parts.
const SIDE: f64 = 0.1;

/// Three tori around the axes x, y and z, melted together: four tubes meet on each axis at +[`RING`] and -[`RING`].
///
/// The surface has seven handles.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless 16 to 2^24 triangles are wanted.
pub fn blended_tori(n_triangles: usize) -> Result<Mesh, ModelError> {
    let torus = |axis| Torus {
        center: DVec3::ZERO,
        axis,
        ring: RING,
        tube: TUBE,
    };
    let solid = Blend::of(torus(DVec3::X))
        .with(torus(DVec3::Y), 0.2)
        .with(torus(DVec3::Z), 0.2);
    polygonize_n(&solid, SIDE, n_triangles)
}
