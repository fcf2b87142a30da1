//! A zebra without its stripes.

use crate::parts::{cone, ellipsoid, turned};
use crate::solid::{Blend, Tube};
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Position of the tip of the muzzle.
pub const MUZZLE: DVec3 = DVec3::new(0.0, 0.54, 1.13);
/// Position of the middle of the back.
pub const BACK: DVec3 = DVec3::new(0.0, 0.39, -0.1);

/// Side of the lattice's cubes, small enough to find all details.
const SIDE: f64 = 0.04;

/// Builds the zebra. It stands on four legs with its head up and faces +z.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless `n_triangles` is from 16 to 2^24.
pub fn zebra(n_triangles: usize) -> Result<Mesh, ModelError> {
    polygonize_n(&solid(), SIDE, n_triangles)
}

fn solid() -> Blend {
    let neck = [
        [0.0, 0.15, 0.3, 0.22],
        [0.0, 0.42, 0.54, 0.165],
        [0.0, 0.7, 0.72, 0.125],
        [0.0, 0.78, 0.8, 0.12],
    ];
    let front_leg = [
        [0.14, 0.0, 0.32, 0.14],
        [0.145, -0.28, 0.34, 0.085],
        [0.145, -0.5, 0.345, 0.062],
        [0.145, -0.75, 0.34, 0.045],
        [0.145, -0.86, 0.36, 0.055],
        [0.145, -0.9, 0.37, 0.06],
    ];
    let hind_leg = [
        [0.14, 0.1, -0.5, 0.18],
        [0.165, -0.16, -0.5, 0.115],
        [0.15, -0.42, -0.62, 0.075],
        [0.15, -0.52, -0.64, 0.062],
        [0.15, -0.75, -0.58, 0.046],
        [0.15, -0.86, -0.56, 0.055],
        [0.15, -0.9, -0.55, 0.06],
    ];
    let tail = [
        [0.0, 0.3, -0.68, 0.05],
        [0.0, 0.22, -0.82, 0.036],
        [0.0, -0.02, -0.9, 0.032],
        [0.0, -0.2, -0.92, 0.05],
        [0.0, -0.36, -0.92, 0.03],
    ];
    Blend::of(ellipsoid([0.0, 0.12, -0.1], [0.27, 0.27, 0.55]))
        .with(ellipsoid([0.0, 0.17, -0.46], [0.24, 0.25, 0.26]), 0.15)
        .with(ellipsoid([0.0, 0.12, 0.3], [0.22, 0.27, 0.24]), 0.15)
        .with(Tube::through(&neck), 0.12)
        // Mane, head and ears.
        .with(
            turned([0.0, 0.64, 0.5], [0.035, 0.34, 0.1], [0.67, 0.0, 0.0]),
            0.05,
        )
        .with(
            cone([0.0, 0.78, 0.78, 0.12], [0.0, 0.58, 1.02, 0.075]),
            0.06,
        )
        .with(ellipsoid([0.0, 0.55, 1.04], [0.08, 0.08, 0.09]), 0.05)
        .with_pair(
            turned(
                [0.085, 0.94, 0.72],
                [0.042, 0.12, 0.035],
                [-0.2, 0.3, -0.35],
            ),
            0.04,
        )
        .with_pair(Tube::through(&front_leg), 0.1)
        .with_pair(Tube::through(&hind_leg), 0.1)
        .with(Tube::through(&tail), 0.06)
}
