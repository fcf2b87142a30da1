//! Small meshes for tests.

use dapple_mesh::{Mesh, Surface};
use glam::DVec3;

/// A grid of squares, each in two triangles: `open` tells for each axis whether it does not close up on itself.
pub(crate) fn sheet(n: [u32; 2], open: [bool; 2], at: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let [columns, rows] = [0, 1].map(|axis| n[axis] + u32::from(open[axis]));
    let mut positions = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [u, v] = [(column, n[0]), (row, n[1])].map(|(i, n)| f64::from(i) / f64::from(n));
            positions.push(at(u, v));
        }
    }
    let vertex = |column: u32, row: u32| (row % rows) * columns + column % columns;
    let mut faces = Vec::new();
    for row in 0..n[1] {
        for column in 0..n[0] {
            let [a, b] = [vertex(column, row), vertex(column + 1, row)];
            let [c, d] = [vertex(column, row + 1), vertex(column + 1, row + 1)];
            faces.extend([[a, b, d], [a, d, c]]);
        }
    }
    Mesh::new(positions, &faces).unwrap()
}

pub(crate) fn plane() -> Surface {
    Surface::new(sheet([5, 5], [true; 2], |u, v| DVec3::new(u, v, 0.0))).unwrap()
}

pub(crate) fn torus() -> Surface {
    let torus = |u: f64, v: f64| {
        let [u, v] = [u, v].map(|part| part * core::f64::consts::TAU);
        let radius = 1.0 + 0.4 * libm::cos(v);
        DVec3::new(
            radius * libm::cos(u),
            radius * libm::sin(u),
            0.4 * libm::sin(v),
        )
    };
    Surface::new(sheet([48, 24], [false; 2], torus)).unwrap()
}

/// An octahedron whose faces are split four ways three times, on the unit sphere.
pub(crate) fn sphere() -> Surface {
    let mut positions = vec![
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        -DVec3::X,
        -DVec3::Y,
        -DVec3::Z,
    ];
    let mut faces: Vec<[u32; 3]> = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]];
    faces.extend([[1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]);
    for _ in 0..3 {
        let mut middles = std::collections::BTreeMap::new();
        let mut split = Vec::new();
        for [a, b, c] in faces {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| {
                *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    positions.push((positions[p as usize] + positions[q as usize]).normalize());
                    positions.len() as u32 - 1
                })
            });
            split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = split;
    }
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

/// Triangles that share no vertices: a large one, and ever smaller ones beside it.
pub(crate) fn scraps(n: u32) -> Surface {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    let mut side = 1.0;
    for scrap in 0..n {
        let corner = DVec3::new(2.0 * f64::from(scrap), 0.0, 0.0);
        positions.extend([corner, corner + DVec3::X * side, corner + DVec3::Y * side]);
        faces.push([0, 1, 2].map(|vertex| 3 * scrap + vertex));
        side *= 0.5;
    }
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

/// The model of this name among the real ones beside the workspace, or nothing and a message where they are absent.
pub(crate) fn real(name: &str) -> Option<Mesh> {
    let path = format!(
        "{}/../../../shared/data/meshes/{name}",
        env!("CARGO_MANIFEST_DIR")
    );
    if !std::path::Path::new(&path).exists() {
        println!("skipped: there is no {path}");
        return None;
    }
    Some(dapple_mesh_io::read_model(path).unwrap().mesh)
}
