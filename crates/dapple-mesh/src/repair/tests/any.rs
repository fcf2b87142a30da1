//! Tests of repairs of mesh files and of random triangles.

use super::turned;
use crate::test_meshes::{cube, ring, soup, tetrahedron};
use crate::{Mesh, Surface};
use glam::DVec3;
use proptest::prelude::*;

#[test]
fn repair_of_files_gives_surfaces() {
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/meshes/degenerate"
    );
    // Expected numbers of faces, components and open edges.
    let want = [
        ("cube", 12, 1, 0),
        ("degenerate_edge", 1, 1, 3),
        ("double_sided", 2, 1, 4),
        ("duplicate_edge", 2, 1, 4),
        ("gazebo", 730, 56, 8),
        ("../spot", 5856, 1, 0),
        ("zero_area_face", 0, 0, 0),
        ("zero_length_edge", 1, 1, 3),
    ];
    for (name, faces, components, borders) in want {
        let Some(before) = read(&format!("{folder}/{name}.obj")) else {
            println!("skipped: {name}.obj is not there");
            continue;
        };
        let (after, repair) = before.repair();
        let got = (
            repair.after.faces,
            repair.after.components,
            repair.after.boundary_edges,
        );
        assert_eq!(got, (faces, components, borders), "{name}");
        assert_eq!(Surface::new(after).is_ok(), faces > 0, "{name}");
    }
}

/// Returns the triangles of an OBJ file. Polygons become triangle fans.
#[expect(clippy::disallowed_methods, reason = "reads test data")]
fn read(path: &str) -> Option<Mesh> {
    let text = std::fs::read_to_string(path).ok()?;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let parts: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
                positions.push(DVec3::from_slice(&parts));
            }
            Some("f") => {
                let number = |word: &str| {
                    word.split('/')
                        .next()
                        .and_then(|number| number.parse().ok())
                };
                let corners: Vec<u32> = words.map(|word| number(word).expect("a number")).collect();
                faces.extend(
                    (2..corners.len())
                        .map(|last| [corners[0] - 1, corners[last - 1] - 1, corners[last] - 1]),
                );
            }
            _ => {}
        }
    }
    Mesh::new(positions, &faces).ok()
}

/// Splits a face at a vertex on one of its edges, and fills the gap to the face on the other side with a cap.
///
/// `part` is the vertex's position along the edge, from 0 to 1.
fn crack(mesh: &Mesh, face: usize, edge: usize, part: f64) -> Mesh {
    let mut positions = mesh.positions().to_vec();
    let mut faces: Vec<[u32; 3]> = mesh
        .faces()
        .iter()
        .map(|face| face.map(|vertex| vertex.0))
        .collect();
    let corners = faces[face];
    let [a, b, c] = [0, 1, 2].map(|step| corners[(edge + step) % 3]);
    let middle = positions.len() as u32;
    positions.push(positions[a as usize].lerp(positions[b as usize], part));
    faces[face] = [a, middle, c];
    faces.extend([[middle, b, c], [a, b, middle]]);
    Mesh::new(positions, &faces).expect("valid")
}

#[test]
fn repair_of_flat_faces_on_each_other_leaves_no_crack() {
    let near = 1.0 - 1e-16;
    let found: [&[(usize, usize, f64)]; 3] = [
        // Two caps whose flips could alternate forever.
        &[
            (11, 1, 0.5),
            (3, 0, 0.5),
            (13, 2, 1e-9),
            (0, 0, 0.5),
            (0, 0, 0.5),
            (2, 2, 0.5),
            (2, 0, 1e-9),
        ],
        // Four faces at the longest edge of caps.
        &[
            (0, 0, 0.75),
            (5, 2, near),
            (6, 1, near),
            (3, 0, 0.5),
            (6, 0, 0.5),
            (12, 0, 0.5),
        ],
        // Two caps with the same vertices.
        &[
            (2, 0, 0.5),
            (2, 0, 0.5),
            (1, 1, 0.5),
            (4, 0, 0.5),
            (3, 1, 0.5),
            (3, 0, 0.5),
        ],
    ];
    for cracks in found {
        for closed in [tetrahedron(), cube()] {
            let crack = |mesh: Mesh, &(face, edge, part): &(usize, usize, f64)| {
                crack(&mesh, face % mesh.faces().len(), edge, part)
            };
            let (_, repair) = cracks.iter().fold(closed, crack).repair();
            assert_eq!(
                (repair.after.boundary_edges, repair.after.components),
                (0, 1),
                "{cracks:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn repair_of_a_closed_mesh_with_caps_and_needles_leaves_no_crack(
        cracks in prop::collection::vec((0_usize..1000, 0_usize..3, prop::sample::select(vec![0.5, 0.25, 0.75, 0.0, 1.0, 1e-17, 1.0 - 1e-16])), 1..6),
    ) {
        for closed in [tetrahedron(), cube()] {
            let mut mesh = closed.clone();
            for &(face, edge, part) in &cracks {
                mesh = crack(&mesh, face % mesh.faces().len(), edge, part);
            }
            let (after, repair) = mesh.repair();
            let counts = [repair.after.boundary_edges, repair.after.non_manifold_edges, repair.after.components];
            prop_assert_eq!(counts, [0, 0, 1]);
            let [before, after] = [closed, after].map(|mesh| Surface::new(mesh).expect("no defects").area());
            // Tolerance: vertices move by a few rounding errors of numbers near 1.
            prop_assert!((before - after).abs() < 1e-12);
        }
    }

    #[test]
    fn repair_turns_back_any_faces_of_closed_meshes(mask in 0_u32..4096, n in 3_u32..9) {
        let over = |face: usize| mask >> (face % 12) & 1 == 1;
        for closed in [tetrahedron(), cube()] {
            let (after, repair) = turned(&closed, over).repair();
            prop_assert_eq!(&after, &closed);
            prop_assert_eq!(repair.turned_faces, (0..closed.faces().len()).filter(|&face| over(face)).count());
        }
        let (after, repair) = turned(&ring(n, false), over).repair();
        prop_assert_eq!(&repair.after, &ring(n, false).report());
        prop_assert!(repair.turned_faces <= n as usize);
        prop_assert_eq!(after.repair().0, after);
    }

    #[test]
    fn repair_of_any_soup_gives_a_surface_and_is_idempotent(mesh in soup()) {
        let (after, repair) = mesh.repair();
        prop_assert_eq!(&repair.before, &mesh.report());
        prop_assert_eq!(&repair.after, &after.report());
        let report = &repair.after;
        prop_assert_eq!([report.degenerate_faces, report.duplicate_faces, report.winding_edges, report.unused_vertices], [0; 4]);
        prop_assert_eq!(Surface::new(after.clone()).is_ok(), !after.faces().is_empty());
        prop_assert!(repair.cut_edges > 0 || report.duplicate_vertices == 0);
        for (position, before) in after.positions().iter().zip(&repair.vertex_before) {
            prop_assert_eq!(position, &mesh.positions()[before.index()]);
        }
        prop_assert_eq!(repair.face_before.len(), after.faces().len());
        let (again, second) = after.repair();
        prop_assert_eq!(again, after);
        prop_assert_eq!(second.turned_faces, 0);
    }
}
