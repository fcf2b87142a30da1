//! Three intersecting tori.

use crate::solid::{Blend, Torus};
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Distance from the origin to the center lines of the tubes. The tubes meet at this distance on the axes.
pub const RING: f64 = 0.78;
/// Radius of the tubes.
pub const TUBE: f64 = 0.2;

/// Side of the lattice's cubes, small enough to find all details.
const SIDE: f64 = 0.1;

/// Builds three tori around the axes x, y and z, blended together. Four tubes meet on each axis at +[`RING`] and
/// -[`RING`].
///
/// The surface has seven handles.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless `n_triangles` is from 16 to 2^24.
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
