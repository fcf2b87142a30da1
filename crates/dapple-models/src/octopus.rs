//! An octopus: a head on eight curved arms.

use crate::parts::{ball, ellipsoid, turned};
use crate::solid::{Blend, Tube};
use crate::{ModelError, polygonize_n};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Position of the top of the head.
pub const CROWN: DVec3 = DVec3::new(0.0, 0.96, -0.16);

/// Side of the lattice's cubes, small enough to find all details.
const SIDE: f64 = 0.05;

/// The horizontal directions of the arms as cosine and sine, at odd multiples of π/8.
const DIRECTIONS: [[f64; 2]; 8] = {
    const LONG: f64 = 0.923_879_532_511_286_7;
    const SHORT: f64 = 0.382_683_432_365_089_8;
    [
        [LONG, SHORT],
        [SHORT, LONG],
        [-SHORT, LONG],
        [-LONG, SHORT],
        [-LONG, -SHORT],
        [-SHORT, -LONG],
        [SHORT, -LONG],
        [LONG, -SHORT],
    ]
};

/// Shapes of the arms. Each is a list of points along the arm from its root: distance outward, height, distance to the
/// left, and radius.
const ARMS: [[[f64; 4]; 7]; 2] = [
    [
        [0.06, 0.02, 0.0, 0.16],
        [0.28, -0.10, 0.0, 0.125],
        [0.50, -0.30, 0.02, 0.10],
        [0.72, -0.36, 0.10, 0.078],
        [0.92, -0.24, 0.20, 0.058],
        [1.00, -0.04, 0.20, 0.043],
        [0.93, 0.08, 0.10, 0.030],
    ],
    [
        [0.06, 0.02, 0.0, 0.16],
        [0.28, -0.06, 0.0, 0.125],
        [0.52, -0.24, -0.04, 0.10],
        [0.74, -0.42, -0.02, 0.078],
        [0.96, -0.46, 0.10, 0.058],
        [1.08, -0.40, 0.27, 0.043],
        [1.02, -0.36, 0.42, 0.030],
    ],
];

/// Builds the octopus. Its head is up, its eyes face +z, and its arms spread in all directions.
///
/// # Errors
///
/// [`ModelErrorKind::Range`](crate::ModelErrorKind::Range) unless `n_triangles` is from 16 to 2^24.
pub fn octopus(n_triangles: usize) -> Result<Mesh, ModelError> {
    polygonize_n(&solid(), SIDE, n_triangles)
}

fn solid() -> Blend {
    let mut body = Blend::of(turned(
        [0.0, 0.55, -0.08],
        [0.33, 0.42, 0.33],
        [-0.25, 0.0, 0.0],
    ))
    .with(ellipsoid([0.0, 0.10, 0.02], [0.24, 0.2, 0.24]), 0.15)
    .with_pair(ball([0.15, 0.26, 0.19], 0.075), 0.06);
    for (index, direction) in DIRECTIONS.into_iter().enumerate() {
        body = body.with(arm(&ARMS[index % 2], direction), 0.12);
    }
    body
}

/// Returns an arm that extends in the horizontal direction `[x, z]`.
fn arm(points: &[[f64; 4]; 7], [x, z]: [f64; 2]) -> Tube {
    let placed =
        points.map(|[out, up, left, radius]| [out * x - left * z, up, out * z + left * x, radius]);
    Tube::through(&placed)
}
