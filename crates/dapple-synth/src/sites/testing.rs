//! Surfaces and sites for tests.

use crate::Sites;
use dapple_hash::{Seed, hash1, unit_f64};
use dapple_mesh::{FaceIdx, Mesh, Surface, SurfacePoint};
use glam::DVec3;
use std::collections::BTreeMap;

/// A sphere of radius 1: an octahedron whose faces were cut into four so many times.
pub(crate) fn sphere(cuts: u32) -> Surface {
    let mut positions: Vec<DVec3> = DVec3::AXES.iter().flat_map(|&axis| [axis, -axis]).collect();
    let mut faces = Vec::new();
    for x in [0, 1] {
        for y in [2, 3] {
            for z in [4, 5] {
                // Mirrored octants go around the other way.
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

/// The faces of a grid of vertices, row by row, that may close on itself along either axis.
fn grid_faces([columns, rows]: [u32; 2], closed: bool, first: u32) -> Vec<[u32; 3]> {
    let ends = if closed {
        [columns, rows]
    } else {
        [columns - 1, rows - 1]
    };
    let at = |x: u32, y: u32| first + (y % rows) * columns + x % columns;
    (0..ends[1])
        .flat_map(|y| (0..ends[0]).map(move |x| (x, y)))
        .flat_map(|(x, y)| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// The unit square at several heights; those at odd places of the list face down.
pub(crate) fn sheets(heights: &[f64]) -> Surface {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for (sheet, &z) in heights.iter().enumerate() {
        let first = positions.len() as u32;
        for y in 0..5 {
            for x in 0..5 {
                positions.push(DVec3::new(f64::from(x) / 4.0, f64::from(y) / 4.0, z));
            }
        }
        let turn = |[a, b, c]: [u32; 3]| if sheet % 2 == 1 { [a, c, b] } else { [a, b, c] };
        faces.extend(grid_faces([5, 5], false, first).into_iter().map(turn));
    }
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

/// A torus around the z axis with the radii 1 and 0.4.
pub(crate) fn torus(columns: u32, rows: u32) -> Surface {
    let mut positions = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [u, v] = [(column, columns), (row, rows)]
                .map(|(part, of)| core::f64::consts::TAU * f64::from(part) / f64::from(of));
            let out = 1.0 + 0.4 * libm::cos(v);
            positions.push(DVec3::new(
                out * libm::cos(u),
                out * libm::sin(u),
                0.4 * libm::sin(v),
            ));
        }
    }
    let faces = grid_faces([columns, rows], true, 0);
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

/// The distance of neighbors in a hexagonal lattice of so many sites on a surface.
pub(crate) fn spacing(surface: &Surface, n_sites: usize) -> f64 {
    (2.0 * surface.area() / (3.0_f64.sqrt() * n_sites as f64)).sqrt()
}

/// A random point of a surface.
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

/// Random sites, as many as asked for.
pub(crate) fn random_sites(surface: &Surface, n_sites: usize, seed: u64) -> Sites {
    let seed = Seed(seed);
    let points = (0..n_sites as i64).map(|number| random(surface, seed, number));
    Sites::new(surface, points.collect())
}

/// About as many sites as asked for, none nearer to another one on its side than 0.7 spacings.
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
