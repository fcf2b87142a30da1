//! Tests of reports against naive counts.

use super::*;
use crate::test_meshes::{cube, mesh, plane, ring, soup, tetrahedron};
use proptest::prelude::*;

/// Returns the directed edges of a face; an empty list if it contains a vertex twice.
fn directed(face: [VertexIdx; 3]) -> Vec<[VertexIdx; 2]> {
    let [a, b, c] = face;
    if a == b || b == c || c == a {
        vec![]
    } else {
        vec![[a, b], [b, c], [c, a]]
    }
}

/// Returns the faces at an edge, each with whether it traverses the edge from `a` to `b`.
fn faces_at(mesh: &Mesh, [a, b]: [VertexIdx; 2]) -> Vec<(usize, bool)> {
    let at = |(face, corners): (usize, &[VertexIdx; 3])| {
        let edges = directed(*corners);
        let forward = edges.contains(&[a, b]).then_some((face, true));
        forward.or(edges.contains(&[b, a]).then_some((face, false)))
    };
    mesh.faces().iter().enumerate().filter_map(at).collect()
}

/// Returns the number of connected components of `items`. `joined` returns whether two items are connected.
fn count_sets(items: &[usize], joined: impl Fn(usize, usize) -> bool) -> usize {
    let mut left = items.to_vec();
    let mut count = 0;
    while let Some(first) = left.pop() {
        count += 1;
        let mut open = vec![first];
        while let Some(item) = open.pop() {
            let (near, far): (Vec<usize>, Vec<usize>) =
                left.iter().partition(|&&other| joined(item, other));
            open.extend(near);
            left = far;
        }
    }
    count
}

/// Counts defects naively, by comparing all pairs.
fn naive_report(mesh: &Mesh) -> MeshReport {
    let (positions, faces) = (mesh.positions(), mesh.faces());
    let vertices: Vec<VertexIdx> = (0..positions.len() as u32).map(VertexIdx).collect();
    let mut report = MeshReport {
        vertices: positions.len(),
        faces: faces.len(),
        ..MeshReport::default()
    };
    for (high, &b) in vertices.iter().enumerate() {
        for &a in &vertices[..high] {
            match faces_at(mesh, [a, b])[..] {
                [] => {}
                [_] => report.boundary_edges += 1,
                [one, other] => report.winding_edges += usize::from(one.1 == other.1),
                _ => report.non_manifold_edges += 1,
            }
        }
        report.duplicate_vertices += usize::from(positions[..high].contains(&positions[high]));
        let naming: Vec<usize> = (0..faces.len())
            .filter(|&face| faces[face].contains(&b))
            .collect();
        report.unused_vertices += usize::from(naming.is_empty());
        let around: Vec<usize> = naming
            .into_iter()
            .filter(|&face| !directed(faces[face]).is_empty())
            .collect();
        let neighbors = |one: usize, other: usize| {
            vertices.iter().any(|&a| matches!(faces_at(mesh, [a, b])[..], [f, g] if [f.0, g.0] == [one.min(other), one.max(other)]))
        };
        report.non_manifold_vertices += usize::from(count_sets(&around, neighbors) > 1);
    }
    let set = |face: usize| {
        let mut corners = faces[face];
        corners.sort();
        corners
    };
    for (face, &corners) in faces.iter().enumerate() {
        report.duplicate_faces += usize::from((0..face).any(|other| set(face) == set(other)));
        let [a, b, c] = corners.map(|vertex| positions[vertex.index()]);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        // Product of the two shorter edges, in the order of the implementation.
        let flat = area_vector([a, b, c])
            .is_none_or(|vector| vector.length() <= 8e-16 * longest * longest);
        report.degenerate_faces += usize::from(directed(corners).is_empty() || flat);
    }
    report.back_to_back_faces = (0..faces.len())
        .filter(|&face| is_back_to_back(mesh, face))
        .count();
    let all: Vec<usize> = (0..faces.len()).collect();
    report.components = count_sets(&all, |one, other| {
        let both = [one.min(other), one.max(other)];
        directed(faces[one])
            .iter()
            .any(|&edge| matches!(faces_at(mesh, edge)[..], [f, g] if [f.0, g.0] == both))
    });
    report
}

/// Returns whether the first face at the same positions has the opposite winding.
fn is_back_to_back(mesh: &Mesh, face: usize) -> bool {
    let at = mesh.positions();
    let place = |vertex: VertexIdx| at.iter().position(|&other| other == at[vertex.index()]);
    let places = |face: usize| mesh.faces()[face].map(place);
    let set = |face: usize| {
        let mut places = places(face);
        places.sort();
        places
    };
    let [a, b, c] = places(face);
    let first = (0..face).find(|&other| set(other) == set(face));
    let is_other = |first| ![[a, b, c], [b, c, a], [c, a, b]].contains(&places(first));
    a != b && b != c && c != a && first.is_some_and(is_other)
}

#[test]
fn report_of_closed_and_open_meshes_counts_their_borders() {
    for (closed, faces) in [(tetrahedron(), 4), (cube(), 12)] {
        let want = MeshReport {
            vertices: closed.positions().len(),
            faces,
            components: 1,
            ..MeshReport::default()
        };
        assert_eq!(closed.report(), want, "closed");
    }
    assert_eq!(
        plane(3, 2).report().boundary_edges,
        10,
        "around 3 by 2 squares"
    );
    assert_eq!(Mesh::default().report(), MeshReport::default(), "empty");
}

#[test]
fn report_counts_every_defect() {
    let corners = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, -1.0, 0.0],
        [2.0, 0.0, 0.0],
        [-0.0; 3],
    ];
    let faces = [
        [0, 1, 2],
        [0, 1, 3],
        [0, 1, 4],
        [2, 0, 1],
        [0, 1, 5],
        [3, 3, 1],
    ];
    let want = MeshReport {
        vertices: 7,
        faces: 6,
        // The two equal faces share two edges, the edge 01 connects no faces, and the last face contains vertex 3
        // twice.
        components: 5,
        boundary_edges: 6,
        non_manifold_edges: 1,
        non_manifold_vertices: 2,
        winding_edges: 2,
        degenerate_faces: 2,
        duplicate_faces: 1,
        back_to_back_faces: 0,
        duplicate_vertices: 1,
        unused_vertices: 1,
    };
    assert_eq!(mesh(&corners, &faces).report(), want);
}

#[test]
fn report_of_a_bow_tie_counts_the_vertex_in_its_middle() {
    let corners = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
    let report = mesh(&corners, &[[0, 1, 2], [0, 3, 4]]).report();
    assert_eq!((report.non_manifold_vertices, report.components), (1, 2));
}

#[test]
fn report_of_a_moebius_strip_finds_one_edge_that_disagrees() {
    let report = ring(7, true).report();
    assert_eq!(
        (
            report.winding_edges,
            report.components,
            report.boundary_edges
        ),
        (1, 1, 14)
    );
    assert_eq!(
        ring(7, false).report().winding_edges,
        0,
        "without the twist"
    );
}

proptest! {
    #[test]
    fn report_equals_the_naive_count_on_any_soup(mesh in soup()) {
        prop_assert_eq!(mesh.report(), naive_report(&mesh));
    }
}

#[test]
fn both_sides_of_a_sheet_are_back_to_back() {
    let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    // The other side uses separate vertices at the same positions.
    let both = [square, square].concat();
    for (faces, count) in [
        (&[[0, 1, 2], [0, 2, 3]][..], 0),
        (&[[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]], 2),
        (&[[0, 1, 2], [0, 2, 3], [6, 5, 4], [4, 7, 6]], 2),
        (&[[0, 1, 2], [5, 6, 4], [2, 0, 1]], 0),
        (&[[0, 1, 2], [2, 1, 4], [1, 2, 0]], 1),
    ] {
        let report = mesh(&both, faces).report();
        assert_eq!(report.back_to_back_faces, count, "{faces:?}");
    }
}
