use super::*;
use crate::Surface;
use crate::test_meshes::{cube, mesh, plane, ring, soup, tetrahedron};
use glam::DVec3;
use proptest::prelude::*;

/// The mesh with its corners put together from several meshes.
fn union(meshes: &[Mesh]) -> Mesh {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let first = positions.len() as u32;
        positions.extend(mesh.positions());
        faces.extend(
            mesh.faces()
                .iter()
                .map(|face| face.map(|vertex| vertex.0 + first)),
        );
    }
    Mesh::new(positions, &faces).expect("the meshes are valid")
}

/// The mesh with some faces turned over.
fn turned(mesh: &Mesh, which: impl Fn(usize) -> bool) -> Mesh {
    let over = |(face, [a, b, c]): (usize, &[VertexIdx; 3])| {
        if which(face) {
            [a.0, c.0, b.0]
        } else {
            [a.0, b.0, c.0]
        }
    };
    let faces: Vec<[u32; 3]> = mesh.faces().iter().enumerate().map(over).collect();
    Mesh::new(mesh.positions().to_vec(), &faces).expect("the mesh is valid")
}

/// Six times the volume inside of a closed mesh.
fn volume(mesh: &Mesh) -> f64 {
    let part = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c));
    mesh.faces()
        .iter()
        .map(|face| part(face.map(|vertex| mesh.positions()[vertex.index()])))
        .sum()
}

fn area(mesh: &Mesh) -> f64 {
    Surface::new(mesh.clone())
        .expect("the mesh has no defects")
        .area()
}

#[test]
fn repair_of_a_sound_mesh_changes_nothing() {
    for sound in [
        tetrahedron(),
        cube(),
        plane(3, 2),
        ring(5, false),
        Mesh::default(),
    ] {
        let (after, repair) = sound.repair();
        assert_eq!(after, sound, "the mesh");
        assert_eq!(
            (repair.turned_faces, repair.cut_edges),
            (0, 0),
            "what was done"
        );
        assert_eq!(repair.before, repair.after, "the counts");
    }
}

#[test]
fn repair_welds_the_corners_of_a_soup_of_separate_triangles() {
    let cube = cube();
    let positions = cube
        .faces()
        .iter()
        .flatten()
        .map(|vertex| cube.positions()[vertex.index()])
        .collect();
    let faces: Vec<[u32; 3]> = (0..12)
        .map(|face| [3 * face, 3 * face + 1, 3 * face + 2])
        .collect();
    let (after, repair) = Mesh::new(positions, &faces).expect("valid").repair();
    assert_eq!(
        (
            repair.before.duplicate_vertices,
            repair.after.boundary_edges
        ),
        (28, 0)
    );
    assert_eq!((after.positions().len(), repair.after.components), (8, 1));
}

#[test]
fn repair_drops_what_nothing_uses_and_says_where_the_rest_was() {
    let corners = [
        [9.0; 3],
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
    ];
    let (after, repair) = mesh(&corners, &[[1, 1, 2], [4, 3, 1], [1, 2, 3]]).repair();
    assert_eq!(
        after,
        mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[1, 2, 0]])
    );
    assert_eq!(repair.vertex_before, [1, 2, 3].map(VertexIdx));
    assert_eq!(repair.face_before, [FaceIdx(1)]);
}

#[test]
fn repair_turns_closed_meshes_outward_and_open_ones_to_the_larger_side() {
    for which in [
        |_: usize| true,
        |face: usize| face % 2 == 0,
        |face: usize| face == 0,
        |face: usize| face > 0,
    ] {
        let (after, repair) = turned(&cube(), which).repair();
        assert_eq!(repair.after, cube().report(), "the counts");
        assert_eq!(volume(&after), 6.0, "outward");
        let (after, repair) = turned(&plane(2, 1), which).repair();
        let up = Surface::new(after)
            .expect("no defects")
            .face_normal(FaceIdx(0));
        let over = (0..4).filter(|&face| which(face)).count();
        assert_eq!(repair.turned_faces, over.min(4 - over), "the fewer faces");
        // Of two equal parts that of the first face stays, which is turned over here.
        assert_eq!(
            up.z,
            if over >= 2 { -1.0 } else { 1.0 },
            "the larger side of {over}"
        );
    }
}

#[test]
fn repair_turns_every_piece_by_itself() {
    let far = turned(&cube(), |_| true)
        .positions()
        .iter()
        .map(|corner| *corner + 1000.0)
        .collect();
    let far = Mesh::new(
        far,
        &turned(&cube(), |_| true)
            .faces()
            .iter()
            .map(|face| face.map(|vertex| vertex.0))
            .collect::<Vec<_>>(),
    );
    let (after, repair) =
        union(&[cube(), far.expect("valid"), turned(&plane(1, 2), |_| true)]).repair();
    assert_eq!(repair.turned_faces, 12, "the second cube only");
    assert_eq!(
        (repair.after.components, repair.after.winding_edges),
        (3, 0)
    );
    assert_eq!(after.faces()[..12], *cube().faces(), "the first cube");
}

#[test]
fn repair_cuts_a_moebius_strip_once() {
    let (after, repair) = ring(9, true).repair();
    assert_eq!((repair.cut_edges, repair.after.winding_edges), (1, 0));
    assert_eq!(
        (after.positions().len(), repair.after.components),
        (20, 1),
        "two vertices more"
    );
    assert_eq!(repair.after.boundary_edges, 20, "the cut has two sides");
    assert_eq!(after.repair().0, after, "again");
}

#[test]
fn repair_cuts_a_projective_plane() {
    // The six vertices of the hemi-icosahedron, every two of which are neighbors.
    let faces = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 5, 1],
        [1, 2, 4],
        [2, 3, 5],
        [3, 4, 1],
        [4, 5, 2],
        [5, 1, 3],
    ];
    let corners: Vec<[f64; 3]> = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
        .map(|t: f64| [t, t * t, t * t * t])
        .to_vec();
    let plane = mesh(&corners, &faces);
    assert_eq!(plane.report().boundary_edges, 0, "closed");
    let (after, repair) = plane.repair();
    assert!(repair.cut_edges > 0, "it has one side");
    assert!(Surface::new(after.clone()).is_ok(), "it has two sides now");
    assert_eq!(after.faces().len(), 10, "all faces");
    assert_eq!(after.repair().0, after, "again");
}

#[test]
fn repair_flips_a_cap_and_leaves_no_crack() {
    // A square whose diagonal meets a vertex in its middle on one side only; the cap between is flat.
    let corners = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.0, 1.0, 0.0],
    ];
    let faces = [[0, 1, 2], [2, 4, 0], [2, 3, 4], [3, 0, 4]];
    let (after, repair) = mesh(&corners, &faces).repair();
    assert_eq!(
        (
            repair.before.degenerate_faces,
            repair.after.degenerate_faces
        ),
        (1, 0)
    );
    assert_eq!(
        (
            repair.after.boundary_edges,
            repair.after.components,
            repair.after.faces
        ),
        (4, 1, 4)
    );
    assert_eq!(
        repair.face_before,
        [0, 0, 2, 3].map(FaceIdx),
        "the parts of the first face"
    );
    assert_eq!(area(&after), 4.0, "the square");
}

#[test]
fn repair_mends_a_chain_of_caps_and_leaves_no_crack() {
    // The upper and the lower half of a square meet along a line that only the upper one divides, in n parts.
    for n in [2, 3, 4, 50] {
        let line = (0..=n).map(|part| [f64::from(part), 0.0, 0.0]);
        let ends = [[f64::from(n), -1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
        let corners: Vec<[f64; 3]> = line.chain(ends).collect();
        let mut faces = vec![[0, n + 1 + 1, n + 1], [0, n + 1, n]];
        faces.extend((0..n).map(|part| [part, part + 1, n + 3]));
        faces.extend((1..n).map(|part| [0, part + 1, part]));
        let (after, repair) = mesh(&corners, &faces).repair();
        assert_eq!(
            repair.before.degenerate_faces,
            n as usize - 1,
            "caps of {n}"
        );
        assert_eq!(
            (repair.after.boundary_edges, repair.after.components),
            (5, 1),
            "no crack in {n}"
        );
        // Sums of small whole and half numbers are exact but for the roots in the lengths of edges.
        assert!(
            (area(&after) - 1.5 * f64::from(n)).abs() < 1e-12,
            "the area of {n}"
        );
    }
}

#[test]
fn repair_welds_a_needle_and_leaves_no_crack() {
    // A square from four triangles around its middle, one of which was torn open by 1e-17.
    let corners = [
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [0.0, 0.0, 0.0],
        [1e-17, 0.0, 0.0],
    ];
    let faces = [
        [0, 1, 4],
        [1, 5, 4],
        [1, 2, 5],
        [2, 4, 5],
        [2, 3, 4],
        [3, 0, 4],
    ];
    let (after, repair) = mesh(&corners, &faces).repair();
    assert_eq!((repair.before.degenerate_faces, repair.after.faces), (2, 4));
    assert_eq!((repair.after.boundary_edges, repair.after.vertices), (4, 5));
    // A few roundings of the area.
    assert!((area(&after) - 4.0).abs() < 1e-14, "the square");
}

#[test]
fn repair_drops_a_cap_at_a_border() {
    let (after, repair) = mesh(
        &[[-1.7, 0.0, -1.0], [-1.0, 0.0, -1.0], [1.0, 0.0, -1.0]],
        &[[1, 0, 2]],
    )
    .repair();
    assert_eq!(after, Mesh::default());
    assert_eq!(repair.before.degenerate_faces, 1);
}

#[test]
fn repair_of_files_gives_surfaces() {
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/meshes/degenerate"
    );
    // Faces, components and open edges afterward.
    let want = [
        ("cube", 12, 1, 0),
        ("degenerate_edge", 1, 1, 3),
        ("double_sided", 2, 1, 4),
        ("duplicate_edge", 2, 1, 4),
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

/// The triangles of an OBJ file, polygons as fans.
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

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
