//! Small meshes for tests.

use crate::{Hierarchy, HierarchyOptions, Orientation, Synthesizer};
use dapple_hash::Seed;
use dapple_mesh::{Mesh, Surface};
use glam::DVec3;

/// A rectangle of `sides` cells, seen from outside with u to the right and v up, mapped by `at`.
fn sheet([across, up]: [u32; 2], at: impl Fn(f64, f64) -> DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for j in 0..=up {
        for i in 0..=across {
            positions.push(at(
                f64::from(i) / f64::from(across),
                f64::from(j) / f64::from(up),
            ));
            if i < across && j < up {
                let corner = j * (across + 1) + i;
                let above = corner + across + 1;
                faces.push([corner, corner + 1, above + 1]);
                faces.push([corner, above + 1, above]);
            }
        }
    }
    (positions, faces)
}

/// The unit square in the plane z = 0.
pub(crate) fn square() -> Mesh {
    let (positions, faces) = sheet([4, 4], |u, v| DVec3::new(u, v, 0.0));
    Mesh::new(positions, &faces).unwrap()
}

/// The unit square and one of a quarter of the area far above it.
pub(crate) fn two_squares() -> Mesh {
    let (mut positions, mut faces) = sheet([4, 4], |u, v| DVec3::new(u, v, 0.0));
    let (more, upper) = sheet([2, 2], |u, v| DVec3::new(0.5 * u, 0.5 * v, 3.0));
    let first = positions.len() as u32;
    positions.extend(more);
    faces.extend(upper.iter().map(|face| face.map(|vertex| vertex + first)));
    Mesh::new(positions, &faces).unwrap()
}

/// A quarter of the unit sphere's width around the point [0, 0, 1].
pub(crate) fn cap() -> Mesh {
    let (positions, faces) = sheet([8, 8], |u, v| DVec3::new(u - 0.5, v - 0.5, 1.0).normalize());
    Mesh::new(positions, &faces).unwrap()
}

/// The unit sphere: a cube's sides pushed out, with welded seams.
pub(crate) fn sphere() -> Mesh {
    let n = 8;
    let mut positions: Vec<DVec3> = Vec::new();
    let mut faces = Vec::new();
    for (right, up) in [
        (DVec3::Y, DVec3::Z),
        (DVec3::Z, DVec3::X),
        (DVec3::X, DVec3::Y),
        (DVec3::Z, DVec3::Y),
        (DVec3::X, DVec3::Z),
        (DVec3::Y, DVec3::X),
    ] {
        let side =
            |u: f64, v: f64| right.cross(up) + right * (2.0 * u - 1.0) + up * (2.0 * v - 1.0);
        let (points, side_faces) = sheet([n, n], side);
        let welded: Vec<u32> = points
            .iter()
            .map(|point| {
                let found = positions
                    .iter()
                    .position(|other| other.distance(*point) < 1e-9);
                found.unwrap_or_else(|| {
                    positions.push(*point);
                    positions.len() - 1
                }) as u32
            })
            .collect();
        faces.extend(
            side_faces
                .iter()
                .map(|face| face.map(|corner| welded[corner as usize])),
        );
    }
    let positions = positions.into_iter().map(DVec3::normalize).collect();
    Mesh::new(positions, &faces).unwrap()
}

/// An open tube of radius 1 and length 4 along z.
pub(crate) fn tube() -> Mesh {
    let n = 48;
    let (positions, faces) = sheet([n, 24], |u, v| {
        let angle = u * core::f64::consts::TAU;
        DVec3::new(libm::cos(angle), libm::sin(angle), 4.0 * v)
    });
    // The last column is the first one again.
    let weld = |vertex: u32| {
        if vertex % (n + 1) == n {
            vertex - n
        } else {
            vertex
        }
    };
    let faces: Vec<[u32; 3]> = faces.iter().map(|face| face.map(weld)).collect();
    Mesh::new(positions, &faces).unwrap()
}

/// A mesh with its positions changed.
pub(crate) fn moved(mesh: &Mesh, change: impl Fn(DVec3) -> DVec3) -> Mesh {
    let positions = mesh
        .positions()
        .iter()
        .map(|&position| change(position))
        .collect();
    let faces: Vec<[u32; 3]> = mesh
        .faces()
        .iter()
        .map(|face| face.map(|vertex| vertex.0))
        .collect();
    Mesh::new(positions, &faces).unwrap()
}

/// A hierarchy on a mesh.
pub(crate) fn sites_on(mesh: Mesh, n_sites: usize, n_levels: usize) -> Hierarchy {
    let options = HierarchyOptions {
        n_sites,
        n_levels,
        seed: Seed(5),
        ..HierarchyOptions::default()
    };
    Hierarchy::new(&Surface::new(mesh).unwrap(), &options).unwrap()
}

/// Sites on a mesh that run along a field of positions and normals.
pub(crate) fn synthesizer(
    mesh: Mesh,
    n_sites: usize,
    field: impl Fn(DVec3, DVec3) -> DVec3 + Sync,
) -> Synthesizer {
    let hierarchy = sites_on(mesh.clone(), n_sites, 2);
    let orientation = Orientation::from_fn(&hierarchy, field);
    let surface = Surface::new(mesh).unwrap();
    Synthesizer::from_parts(surface, hierarchy, orientation, None).unwrap()
}

/// What `work` gives on 1, 2 and 7 threads.
#[cfg(feature = "rayon")]
pub(crate) fn on_threads<T: Send>(work: impl Fn() -> T + Sync) -> [T; 3] {
    [1, 2, 7].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build();
        pool.unwrap().install(&work)
    })
}
