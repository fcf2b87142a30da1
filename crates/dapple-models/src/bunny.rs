//! A bunny: a rounded animal with long ears.

use crate::parts::{ball, cone, ellipsoid, turned};
use crate::solid::Blend;
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Position of the tip of the nose.
pub const NOSE: DVec3 = DVec3::new(0.0, 0.28, 0.55);
/// Position of the tip of the left ear.
pub const LEFT_EAR: DVec3 = DVec3::new(0.25, 1.05, -0.05);
/// Position of the end of the tail.
pub const TAIL: DVec3 = DVec3::new(0.0, -0.68, -0.67);

/// Side of the lattice's cubes, small enough to find all details.
const SIDE: f64 = 0.08;

/// Builds the bunny. It sits upright and faces +z.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless `n_triangles` is from 16 to 2^24.
pub fn bunny(n_triangles: usize) -> Result<Mesh, ModelError> {
    polygonize_n(&solid(), SIDE, n_triangles)
}

fn solid() -> Blend {
    Blend::of(turned(
        [0.0, -0.42, -0.06],
        [0.4, 0.5, 0.42],
        [0.2, 0.0, 0.0],
    ))
    // Head, cheeks, muzzle and ears.
    .with(ellipsoid([0.0, 0.28, 0.2], [0.27, 0.26, 0.3]), 0.22)
    .with_pair(ball([0.11, 0.2, 0.36], 0.12), 0.1)
    .with(ball([0.0, 0.27, 0.47], 0.08), 0.1)
    .with_pair(
        turned([0.16, 0.76, 0.03], [0.1, 0.34, 0.055], [-0.2, 0.35, -0.2]),
        0.1,
    )
    // Haunches, feet, paws and tail.
    .with_pair(ellipsoid([0.3, -0.62, 0.0], [0.2, 0.28, 0.33]), 0.12)
    .with_pair(
        cone([0.28, -0.86, 0.05, 0.09], [0.26, -0.87, 0.46, 0.08]),
        0.1,
    )
    .with_pair(
        cone([0.18, -0.2, 0.22, 0.12], [0.18, -0.42, 0.42, 0.08]),
        0.1,
    )
    .with(ball([0.0, -0.68, -0.52], 0.15), 0.08)
}
