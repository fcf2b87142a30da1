//! Meshes, surfaces and sites for tests.

use crate::{
    Edges, Exemplar, Hierarchy, HierarchyOptions, Orientation, Sites, SurfaceTexture, Synthesizer,
    hexagonal_spacing,
};
use dapple_hash::{Seed, hash1, hash2, unit_f64};
use dapple_mesh::{FaceIdx, Mesh, Surface, SurfacePoint};
use dapple_raster::Raster;
use glam::DVec3;
use std::collections::BTreeMap;

/// Returns a rectangular grid of `n` squares, each split into two triangles. `at` places the vertices, given u and v
/// from 0 to 1. Seen from outside, u points right and v points up. For each axis, `open` is false if the grid closes on
/// itself.
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

/// Joins several meshes into one with the faces of all.
fn joined(meshes: &[Mesh]) -> Mesh {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let first = positions.len() as u32;
        positions.extend_from_slice(mesh.positions());
        faces.extend(
            mesh.faces()
                .iter()
                .map(|face| face.map(|vertex| vertex.0 + first)),
        );
    }
    Mesh::new(positions, &faces).unwrap()
}

/// Returns `n` triangles with random corners in the unit cube.
pub(crate) fn tangle(n: u32) -> Mesh {
    let part = |corner: u32, axis: i64| unit_f64(hash2(Seed(3), [corner.into(), axis], 0));
    let corner = |corner: u32| DVec3::from([0, 1, 2].map(|axis| part(corner, axis)));
    let faces: Vec<_> = (0..n).map(|face| [0, 1, 2].map(|i| 3 * face + i)).collect();
    Mesh::new((0..3 * n).map(corner).collect(), &faces).unwrap()
}

/// Returns the unit square in the plane z = 0.
pub(crate) fn square() -> Mesh {
    sheet([4; 2], [true; 2], |u, v| DVec3::new(u, v, 0.0))
}

/// Returns the unit square, and a square of a quarter of its area far above it.
pub(crate) fn two_squares() -> Mesh {
    let upper = sheet([2; 2], [true; 2], |u, v| DVec3::new(0.5 * u, 0.5 * v, 3.0));
    joined(&[square(), upper])
}

/// Returns a patch of the unit sphere around the point [0, 0, 1]: the unit square at z = 1, projected onto the sphere.
pub(crate) fn cap() -> Mesh {
    sheet([8; 2], [true; 2], |u, v| {
        DVec3::new(u - 0.5, v - 0.5, 1.0).normalize()
    })
}

/// Returns the unit sphere: the faces of a cube, welded and projected onto the sphere.
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
        let side = sheet([n; 2], [true; 2], side);
        let welded: Vec<u32> = side
            .positions()
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
        let faces_of_side = side.faces().iter();
        faces.extend(faces_of_side.map(|face| face.map(|corner| welded[corner.index()])));
    }
    let positions = positions.into_iter().map(DVec3::normalize).collect();
    Mesh::new(positions, &faces).unwrap()
}

/// Returns an open tube of radius 1 and length 4 along z.
pub(crate) fn tube() -> Mesh {
    sheet([48, 24], [false, true], |u, v| {
        let angle = u * core::f64::consts::TAU;
        DVec3::new(libm::cos(angle), libm::sin(angle), 4.0 * v)
    })
}

/// Returns the unit square in the plane z = 0, consisting of 5 × 5 squares.
pub(crate) fn plane() -> Surface {
    Surface::new(sheet([5; 2], [true; 2], |u, v| DVec3::new(u, v, 0.0))).unwrap()
}

/// Returns copies of the unit square at several heights. The copies with odd indices face down.
pub(crate) fn sheets(heights: &[f64]) -> Surface {
    let sheets = heights.iter().enumerate().map(|(place, &z)| {
        let up = sheet([4; 2], [true; 2], |u, v| DVec3::new(u, v, z));
        let turn = |[a, b, c]: [u32; 3]| if place % 2 == 1 { [a, c, b] } else { [a, b, c] };
        let faces = up
            .faces()
            .iter()
            .map(|face| turn(face.map(|vertex| vertex.0)));
        Mesh::new(up.positions().to_vec(), &faces.collect::<Vec<_>>()).unwrap()
    });
    Surface::new(joined(&sheets.collect::<Vec<_>>())).unwrap()
}

/// Returns a torus around the z axis with radii of 1 and 0.4.
pub(crate) fn torus(columns: u32, rows: u32) -> Surface {
    let torus = |u: f64, v: f64| {
        let [u, v] = [u, v].map(|part| part * core::f64::consts::TAU);
        let radius = 1.0 + 0.4 * libm::cos(v);
        DVec3::new(
            radius * libm::cos(u),
            radius * libm::sin(u),
            0.4 * libm::sin(v),
        )
    };
    Surface::new(sheet([columns, rows], [false; 2], torus)).unwrap()
}

/// Returns a sphere of radius 1: an octahedron whose faces are split into four, `cuts` times.
pub(crate) fn geodesic_sphere(cuts: u32) -> Surface {
    let mut positions: Vec<DVec3> = DVec3::AXES.iter().flat_map(|&axis| [axis, -axis]).collect();
    let mut faces = Vec::new();
    for x in [0, 1] {
        for y in [2, 3] {
            for z in [4, 5] {
                // Mirrored octants have the opposite orientation.
                let is_mirrored = (x + y + z) % 2 == 1;
                faces.push(if is_mirrored { [x, z, y] } else { [x, y, z] });
            }
        }
    }
    for _ in 0..cuts {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32, positions: &mut Vec<DVec3>| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let ab = middle(a, b, &mut positions);
            let bc = middle(b, c, &mut positions);
            let ca = middle(c, a, &mut positions);
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        faces = finer;
    }
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

/// Returns a row of triangles without shared vertices, each with half the side length of the previous one.
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

/// Returns the real model called `name` in `shared/`, next to the workspace. If it does not exist, prints a message and
/// returns `None`.
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

/// Returns a mesh with its positions mapped by `change`.
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

/// Builds a hierarchy of sites on a mesh.
pub(crate) fn sites_on(mesh: Mesh, n_sites: usize, n_levels: usize) -> Hierarchy {
    let options = HierarchyOptions {
        n_sites,
        n_levels,
        seed: Seed(5),
        ..HierarchyOptions::default()
    };
    Hierarchy::new(&Surface::new(mesh).unwrap(), &options).unwrap()
}

/// Returns the spacing of a hexagonal lattice of `n_sites` sites on a surface.
pub(crate) fn spacing(surface: &Surface, n_sites: usize) -> f64 {
    hexagonal_spacing(surface.area(), n_sites)
}

/// Returns a random point on a surface.
fn random(surface: &Surface, seed: Seed, number: i64) -> SurfacePoint {
    let n_faces = surface.mesh().faces().len() as u32;
    let largest = (0..n_faces)
        .map(|face| surface.face_area(FaceIdx(face)))
        .fold(0.0, f64::max);
    let mut counter = 0;
    let mut next = || {
        counter += 1;
        unit_f64(hash1(seed, [number], counter))
    };
    loop {
        let face = FaceIdx((next() * f64::from(n_faces)) as u32);
        let root = next().sqrt();
        let other = next();
        if next() * largest < surface.face_area(face) {
            return surface.point(face, [1.0 - root, root * (1.0 - other), root * other]);
        }
    }
}

/// Returns `n_sites` random sites.
pub(crate) fn random_sites(surface: &Surface, n_sites: usize, seed: u64) -> Sites {
    let seed = Seed(seed);
    let points = (0..n_sites as i64).map(|number| random(surface, seed, number));
    Sites::new(surface, points.collect())
}

/// Returns about `n_sites` sites. Sites whose normals agree are at least 0.75 spacings apart.
pub(crate) fn even_sites(surface: &Surface, n_sites: usize, seed: u64) -> Sites {
    let seed = Seed(seed);
    let least = 0.75 * spacing(surface, n_sites);
    let mut kept: Vec<(SurfacePoint, DVec3, DVec3)> = Vec::new();
    for number in 0..20 * n_sites as i64 {
        let point = random(surface, seed, number);
        let (at, normal) = (surface.position(point), surface.normal(point));
        let is_far = |(_, other, up): &(SurfacePoint, DVec3, DVec3)| {
            at.distance(*other) > least || up.dot(normal) < 0.0
        };
        if kept.iter().all(is_far) {
            kept.push((point, at, normal));
        }
    }
    Sites::new(surface, kept.into_iter().map(|(point, ..)| point).collect())
}

/// Returns a synthesizer with sites on a mesh, oriented by a function of position and normal.
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

/// Returns the results of `work` on 1, 2 and 7 threads.
#[cfg(feature = "rayon")]
pub(crate) fn on_threads<T: Send>(work: impl Fn() -> T + Sync) -> [T; 3] {
    [1, 2, 7].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build();
        pool.unwrap().install(&work)
    })
}

/// Returns a texture in which each site's source is the pixel whose column is the site's index, in a map of one row.
/// Any column of values can then serve as a map.
pub(crate) fn pixel_per_site(n_sites: usize) -> SurfaceTexture {
    let row = Raster::filled([n_sites as u32, 1], 0.0).unwrap();
    let exemplar = Exemplar::from_planes(&[(&row, 1.0)], Edges::Cut).unwrap();
    let sources = vec![(0..n_sites as u32).collect()];
    SurfaceTexture::new(&exemplar.pyramid(1).unwrap(), sources, None)
}

/// Converts a column of values to a map of one row, for [`pixel_per_site`].
pub(crate) fn row<T: Clone>(column: &[T]) -> Raster<T> {
    Raster::from_vec([column.len() as u32, 1], column.to_vec()).unwrap()
}
