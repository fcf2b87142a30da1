//! Small meshes with known areas, angles and defects, for tests.

use crate::{Mesh, Surface};
use glam::DVec3;
use proptest::prelude::*;

/// Creates a mesh from corners given as arrays.
pub(crate) fn mesh(corners: &[[f64; 3]], faces: &[[u32; 3]]) -> Mesh {
    let positions = corners.iter().map(|&corner| DVec3::from_array(corner));
    Mesh::new(positions.collect(), faces).expect("the mesh is valid")
}

/// Creates the surface of a mesh that has no defects.
pub(crate) fn surface(mesh: Mesh) -> Surface {
    Surface::new(mesh).expect("the mesh has no defects")
}

/// Returns a regular tetrahedron with edges of length sqrt(8) around the origin.
pub(crate) fn tetrahedron() -> Mesh {
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    mesh(&corners, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
}

/// Returns the unit cube from 0 to 1, with two triangles per side.
pub(crate) fn cube() -> Mesh {
    let corners: Vec<[f64; 3]> = (0..8_u8)
        .map(|bits| [0, 1, 2].map(|axis| f64::from(bits >> axis & 1)))
        .collect();
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces: Vec<[u32; 3]> = sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    mesh(&corners, &faces)
}

/// Returns a sheet of `columns` × `rows` squares of two triangles each, at the positions of the grid points.
pub(crate) fn sheet(columns: u32, rows: u32, position: impl Fn(u32, u32) -> DVec3) -> Mesh {
    let points = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
    let positions = points.map(|(column, row)| position(column, row)).collect();
    let at = |column: u32, row: u32| row * (columns + 1) + column;
    let squares = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let faces: Vec<[u32; 3]> = squares
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    Mesh::new(positions, &faces).expect("the mesh is valid")
}

/// Returns a sheet in the plane z = 0, from the origin to `columns` and `rows`, with normals along z.
pub(crate) fn plane(columns: u32, rows: u32) -> Mesh {
    sheet(columns, rows, |column, row| {
        DVec3::new(column.into(), row.into(), 0.0)
    })
}

/// Returns a strip of `n` unit squares around the z axis. The last square is joined to the first, with half a twist
/// if `twisted` is true.
///
/// Without a twist it is a prism whose normals point outward.
pub(crate) fn ring(n: u32, twisted: bool) -> Mesh {
    let angle = |column: u32| core::f64::consts::TAU * f64::from(column) / f64::from(n);
    // Radius for which the chord of every square has length 1.
    let radius = 0.5 / libm::sin(core::f64::consts::PI / f64::from(n));
    let corners: Vec<[f64; 3]> = [0.0, 1.0]
        .iter()
        .flat_map(|&z| (0..n).map(move |column| (angle(column), z)))
        .map(|(angle, z)| [radius * libm::cos(angle), radius * libm::sin(angle), z])
        .collect();
    let faces: Vec<[u32; 3]> = (0..n)
        .flat_map(|a| {
            let next = [(a + 1) % n, n + (a + 1) % n];
            let [b, c] = if twisted && a + 1 == n {
                [next[1], next[0]]
            } else {
                next
            };
            [[a, b, c], [a, c, n + a]]
        })
        .collect();
    mesh(&corners, &faces)
}

/// Generates random meshes of up to 24 triangles on up to 9 vertices. Many vertices coincide or are collinear, exactly
/// or nearly.
pub(crate) fn soup() -> impl Strategy<Value = Mesh> {
    let part = prop_oneof![
        4 => (0_i8..3).prop_map(f64::from),
        1 => prop::sample::select(vec![-0.0, 1e-13, 1.0 + 1e-13, 0.5, 1e-200, 2.0 - 1e-16, 1e-8, 1e30]),
    ];
    let corner = prop::array::uniform3(part);
    prop::collection::vec(corner, 1..9).prop_flat_map(|corners| {
        let face = prop::array::uniform3(0..corners.len() as u32);
        prop::collection::vec(face, 0..24).prop_map(move |faces| mesh(&corners, &faces))
    })
}
