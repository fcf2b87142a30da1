//! A stingray: a flat disc with wings and a long thin tail.

use crate::parts::{ball, cone, ellipsoid};
use crate::solid::{Bent, Blend, Scaled, Tube};
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Position of the tip of the snout.
pub const SNOUT: DVec3 = DVec3::new(0.0, 0.0, 0.86);
/// Position of the tip of the left wing.
pub const LEFT_WING: DVec3 = DVec3::new(1.0, 0.16, 0.0);
/// Position of the end of the tail.
pub const TAIL: DVec3 = DVec3::new(0.04, 0.0, -1.42);

/// Side of the lattice's cubes, small enough to find all details.
const SIDE: f64 = 0.04;

/// Builds the stingray. It swims toward +z with its wings lifted and its tail behind it.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless `n_triangles` is from 16 to 2^24.
pub fn ray(n_triangles: usize) -> Result<Mesh, ModelError> {
    polygonize_n(&solid(), SIDE, n_triangles)
}

fn solid() -> Blend {
    // Model a round disc, then flatten it.
    let disc = Blend::of(ellipsoid([0.0, 0.0, 0.18], [0.34, 0.42, 0.5]))
        .with_pair(cone([0.0, 0.0, 0.2, 0.48], [0.9, 0.0, -0.02, 0.1]), 0.25)
        .with(cone([0.0, 0.0, 0.35, 0.36], [0.0, 0.0, 0.78, 0.08]), 0.25)
        .with_pair(cone([0.1, 0.0, -0.25, 0.12], [0.14, 0.0, -0.4, 0.07]), 0.12);
    let disc = Scaled {
        solid: disc,
        scale: DVec3::new(1.0, 0.33, 1.0),
    };
    let tail = [
        [0.0, 0.02, 0.0, 0.10],
        [0.0, 0.03, -0.35, 0.06],
        [0.03, 0.04, -0.7, 0.042],
        [0.08, 0.02, -1.05, 0.032],
        [0.04, 0.0, -1.4, 0.024],
    ];
    Blend::of(Bent::new(disc, 0.16))
        .with(Tube::through(&tail), 0.1)
        .with_pair(ball([0.13, 0.12, 0.42], 0.055), 0.05)
}
