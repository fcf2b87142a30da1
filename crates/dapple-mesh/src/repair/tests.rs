//! Tests of repairs of single defects.

mod any;

use super::*;
use crate::Surface;
use crate::test_meshes::{cube, mesh, plane, ring, tetrahedron};
use glam::DVec3;

/// Returns the union of several meshes.
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

/// Returns the mesh with flipped faces: those for whose index `which` returns true.
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

/// Returns six times the volume of a closed mesh.
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
        |face: usize| face & 1 == 0,
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
        // The two parts have equal area, so the winding of the first face applies, which is flipped here.
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
    // The six vertices of the hemi-icosahedron, all pairs of which are connected.
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
    // A square whose diagonal has a vertex at its midpoint on one side only; the cap in between is flat.
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
    // The two halves of a square meet along a line that only the upper half divides, into n parts.
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
        // Sums of small integers and halves are exact, except for the square roots of edge lengths.
        assert!(
            (area(&after) - 1.5 * f64::from(n)).abs() < 1e-12,
            "the area of {n}"
        );
    }
}

#[test]
fn repair_welds_a_needle_and_leaves_no_crack() {
    // A square of four triangles around its center, one of which is displaced by 1e-17.
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
    // Tolerance: a few rounding errors of the area.
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
