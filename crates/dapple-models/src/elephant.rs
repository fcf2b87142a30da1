//! An elephant: a large animal with a trunk.

use crate::parts::{ball, cone, ellipsoid, turned};
use crate::solid::{Blend, Grown, Tube};
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Position of the tip of the trunk.
pub const TRUNK: DVec3 = DVec3::new(0.0, -0.43, 1.34);
/// Position of the middle of the forehead.
pub const FOREHEAD: DVec3 = DVec3::new(0.0, 0.6, 0.75);
/// Position of the middle of the back.
pub const BACK: DVec3 = DVec3::new(0.0, 0.62, -0.25);

/// Side of the lattice's cubes, small enough to find all details.
const SIDE: f64 = 0.045;

/// Builds the elephant. It stands on four thick legs with its ears spread and faces +z.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless `n_triangles` is from 16 to 2^24.
pub fn elephant(n_triangles: usize) -> Result<Mesh, ModelError> {
    polygonize_n(&solid(), SIDE, n_triangles)
}

fn solid() -> Blend {
    let trunk = [
        [0.0, 0.3, 0.75, 0.2],
        [0.0, 0.16, 0.94, 0.16],
        [0.0, -0.12, 1.04, 0.125],
        [0.0, -0.4, 1.06, 0.1],
        [0.0, -0.6, 1.14, 0.08],
        [0.0, -0.6, 1.28, 0.066],
        [0.0, -0.48, 1.32, 0.055],
    ];
    let tail = [
        [0.0, 0.25, -0.85, 0.05],
        [0.0, 0.2, -1.0, 0.042],
        [0.0, -0.12, -1.08, 0.036],
        [0.0, -0.3, -1.08, 0.05],
        [0.0, -0.42, -1.07, 0.036],
    ];
    let ear = Grown {
        solid: turned([0.5, 0.28, 0.42], [0.25, 0.34, 0.02], [0.0, 0.55, -0.15]),
        by: 0.045,
    };
    Blend::of(ellipsoid([0.0, 0.14, -0.25], [0.46, 0.48, 0.66]))
        .with(ball([0.0, 0.36, 0.58], 0.3), 0.25)
        .with(ball([0.0, 0.5, 0.52], 0.2), 0.15)
        .with(Tube::through(&trunk), 0.12)
        .with_pair(
            cone([0.13, 0.1, 0.8, 0.06], [0.2, -0.12, 1.16, 0.035]),
            0.05,
        )
        .with_pair(ear, 0.1)
        .with_pair(cone([0.26, -0.1, 0.2, 0.2], [0.26, -0.8, 0.2, 0.15]), 0.15)
        .with_pair(
            cone([0.26, -0.1, -0.62, 0.22], [0.26, -0.8, -0.66, 0.15]),
            0.15,
        )
        .with(Tube::through(&tail), 0.06)
}
