//! Tests of the planes of faces and the transitions between them.

use super::*;
use crate::test_meshes::{cube, mesh, plane, ring, soup, surface, tetrahedron};
use crate::{MeshErrorKind, VertexIdx};
use proptest::prelude::*;

/// Checks that the axes of each plane are orthonormal, that the rotations of transitions have length 1, and that
/// transitions map the edge to the neighbor's edge.
fn check_tables(surface: &Surface) {
    for (face, flat) in (0..).map(FaceIdx).zip(&surface.flats) {
        let corners = surface.mesh.corners(face);
        let size = corners
            .iter()
            .map(|corner| (corner - corners[0]).length())
            .fold(flat.width, f64::max);
        let axes = [
            flat.x.length_squared(),
            flat.y.length_squared(),
            1.0 + flat.x.dot(flat.y),
        ];
        // Tolerance: a few rounding errors of unit vectors.
        assert!(
            axes.iter().all(|part| (part - 1.0).abs() < 1e-15),
            "axes {axes:?}"
        );
        assert!(
            flat.width > 0.0 && flat.apex.y > 0.0 && flat.apex.is_finite(),
            "corners of {flat:?}"
        );
        for (corner, place) in corners.iter().zip(flat.corners()) {
            let position = surface.position(SurfacePoint { face, flat: place });
            // Tolerance: a few rounding errors of the size of the face.
            assert!(
                (position - corner).length() <= 1e-15 * size,
                "corner {corner} of {flat:?}"
            );
        }
        for (edge, fold) in flat.across.iter().enumerate() {
            let Some(fold) = fold else { continue };
            assert!(
                (fold.turn.length_squared() - 1.0).abs() < 1e-15,
                "turn {:?}",
                fold.turn
            );
            let there = surface.flats[fold.to.face.index()];
            let reach = size + there.width + there.apex.length();
            let other = usize::from(fold.to.edge);
            for (from, to) in [(edge, (other + 1) % 3), ((edge + 1) % 3, other)] {
                let moved = fold.turn.rotate(flat.corners()[from]) + fold.shift;
                // Tolerance: a few rounding errors of the sizes of the two faces.
                assert!(
                    (moved - there.corners()[to]).length() <= 2e-15 * reach,
                    "edge {edge} of {flat:?}"
                );
            }
        }
    }
}

#[test]
fn adjacency_is_that_of_the_mesh() {
    for surface in [tetrahedron(), cube(), plane(3, 2), ring(7, false)].map(surface) {
        assert_eq!(
            *surface.adjacency(),
            Adjacency::new(surface.mesh()),
            "neighbors of {} faces",
            surface.mesh().faces().len()
        );
    }
}

#[test]
fn surface_tables_fit_on_plain_meshes() {
    for mesh in [tetrahedron(), cube(), plane(3, 2), ring(5, false)] {
        check_tables(&surface(mesh));
    }
}

#[test]
fn surface_tables_fit_at_extreme_aspects_and_scales() {
    for aspect in [1e-3, 1e-8, 1e-12, 1.2e-15] {
        for scale in [1e-59, 1e-30, 1.0, 3e29] {
            for apex in [0.0, 0.3, 1.0] {
                let corners = [
                    [0.0, 0.0, 0.0],
                    [0.6, 0.8, 0.0],
                    [0.6 * apex, 0.8 * apex, aspect],
                    [0.0, 0.0, -1.0],
                ];
                let corners = corners.map(|corner| corner.map(|part| part * scale));
                for faces in [
                    [[0, 1, 2], [1, 0, 3]],
                    [[1, 2, 0], [0, 3, 1]],
                    [[2, 0, 1], [3, 1, 0]],
                ] {
                    check_tables(&surface(mesh(&corners, &faces)));
                }
            }
        }
    }
}

#[test]
fn surface_new_refuses_defects_with_their_counts() {
    let corners = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let refused = |faces: &[[u32; 3]]| {
        Surface::new(mesh(&corners, faces))
            .expect_err("defects")
            .kind()
            .clone()
    };
    let defects = |degenerate, duplicate, winding| MeshErrorKind::Defects {
        degenerate,
        duplicate,
        winding,
    };
    assert_eq!(
        refused(&[[0, 1, 2], [0, 1, 3]]),
        defects(1, 0, 1),
        "a flat face"
    );
    assert_eq!(
        refused(&[[0, 1, 2], [0, 0, 2]]),
        defects(1, 0, 0),
        "a vertex twice"
    );
    assert_eq!(
        refused(&[[0, 1, 2], [2, 1, 0]]),
        defects(0, 1, 0),
        "twice the same"
    );
    assert_eq!(
        refused(&[[0, 1, 2], [0, 1, 4]]),
        defects(0, 0, 1),
        "two sides"
    );
    assert_eq!(refused(&[]), MeshErrorKind::NoArea, "no faces");
}

#[test]
fn surface_new_refuses_a_face_whose_area_underflows() {
    let small = |scale: f64| {
        mesh(
            &[[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]],
            &[[0, 1, 2]],
        )
    };
    for scale in [1e-320, 1e-200, 1e-100, 1e-61] {
        assert_eq!(small(scale).report().degenerate_faces, 1, "{scale}");
        assert!(Surface::new(small(scale)).is_err(), "{scale}");
    }
    assert!(Surface::new(small(1e-59)).is_ok(), "1e-59");
}

#[test]
fn surface_takes_non_manifold_edges_and_vertices_as_borders() {
    let corners = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, -1.0, 0.0],
    ];
    let book = surface(mesh(&corners, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
    assert_eq!(book.components(), [0, 1, 2]);
}

#[test]
fn surface_areas_sum_over_components() {
    let mut positions = cube().positions().to_vec();
    positions.extend(plane(2, 1).positions().iter().map(|corner| corner + 5.0));
    let mut faces: Vec<[u32; 3]> = plane(2, 1)
        .faces()
        .iter()
        .map(|face| face.map(|vertex| vertex.0 + 8))
        .collect();
    faces.extend(
        cube()
            .faces()
            .iter()
            .map(|face| face.map(|VertexIdx(vertex)| vertex)),
    );
    faces.swap(1, 4);
    let both = surface(Mesh::new(positions, &faces).expect("valid"));
    let want = [0, 1, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1];
    assert_eq!(both.components(), want, "in the order of the lowest faces");
    // Tolerance: areas of half unit squares are exact up to one rounding each.
    for (got, want) in both.component_areas().into_iter().zip([2.0, 6.0]) {
        assert!((got - want).abs() < 1e-14, "{got} for {want}");
    }
    assert!((both.area() - 8.0).abs() < 1e-14, "all");
}

#[test]
fn surface_normals_mix_those_of_the_corners() {
    let cube = surface(cube());
    assert_eq!(cube.face_normal(FaceIdx(0)), DVec3::NEG_Z, "the bottom");
    let middle = cube.point(FaceIdx(0), [0.0, 0.5, 0.5]);
    assert!(cube.normal(middle).z < 0.0, "outward");
    // Tolerance: one or two roundings of a unit vector.
    assert!(
        (cube.normal(middle).length() - 1.0).abs() < 1e-15,
        "unit length"
    );
    let flat = surface(plane(2, 2));
    assert_eq!(
        flat.normal(flat.point(FaceIdx(3), [0.2, 0.3, 0.5])),
        DVec3::Z,
        "up"
    );
}

#[test]
fn value_stability_surface_tables() {
    let corners = [
        [0.0, 0.0, 0.0],
        [3.0, 1.0, 0.0],
        [1.0, 2.0, 2.0],
        [2.0, -1.0, 1.0],
    ];
    let flats = surface(mesh(&corners, &[[0, 1, 2], [1, 0, 3]])).flats;
    let flat = &flats[0];
    assert_eq!(
        flat.apex.to_array(),
        [1.5811388300841895, 2.5495097567963922]
    );
    let y = [-0.19611613513818407, 0.5883484054145521, 0.7844645405527362];
    assert_eq!(flat.y.to_array(), y);
    let fold = surface(tetrahedron()).flats[2].across[1].expect("closed");
    assert_eq!(
        fold.turn.to_array(),
        [0.5000000000000001, 0.8660254037844388]
    );
    assert_eq!(fold.shift.y, -2.4494897427831788);
}

proptest! {
    #[test]
    fn surface_tables_fit_on_any_mended_soup(mesh in soup()) {
        if let Ok(surface) = Surface::new(mesh.repair().0) {
            check_tables(&surface);
        }
    }

    #[test]
    fn surface_point_position_and_projection_go_there_and_back(face in 0_u32..4, b in 0.0..1.0_f64, c in 0.0..1.0_f64) {
        let surface = surface(tetrahedron());
        let point = surface.point(FaceIdx(face), [1.0 - b - c, b, c]);
        let [a_back, b_back, c_back] = surface.weights(point);
        // Tolerance: a few rounding errors of numbers near 1; the edges have length 2.8.
        prop_assert!((a_back - (1.0 - b - c)).abs().max((b_back - b).abs()).max((c_back - c).abs()) < 1e-14);
        let position = surface.position(point);
        prop_assert!((surface.project(FaceIdx(face), position).flat - point.flat).length() < 1e-14);
        let vector = surface.lift(FaceIdx(face), point.flat);
        prop_assert!((surface.flatten(FaceIdx(face), vector) - point.flat).length() < 1e-14);
        prop_assert!(vector.dot(surface.face_normal(FaceIdx(face))).abs() < 1e-14);
    }
}
