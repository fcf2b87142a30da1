//! Tests of normals and positions on a mesh, and of rejected meshes.

use super::Mesh;
use crate::PreviewErrorKind;
use crate::surface::Chart;
use dapple_mesh::Ray;
use glam::DVec3;

#[test]
fn vertex_normals_are_weighted_by_area() {
    // Two triangles at a right angle, one of three times the area of the other.
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y * 3.0, DVec3::NEG_Z];
    let mesh = Mesh::smooth(&positions, &[[0, 1, 2], [0, 1, 3]]).unwrap();
    let expected = DVec3::new(0.0, 1.0, 3.0).normalize();
    assert!(
        (mesh.normals[0] - expected).length() < 1e-15,
        "{}",
        mesh.normals[0]
    );
}

#[test]
fn empty_mesh_is_met_by_no_ray() {
    let mesh = Mesh::smooth(&[], &[]).unwrap();
    let (origin, direction) = (DVec3::ZERO, DVec3::X);
    let ray = Ray { origin, direction };
    assert_eq!(mesh.first_hit(&ray, f64::INFINITY), None);
    assert!(!mesh.is_blocked(&ray, f64::INFINITY), "shadows");
}

#[test]
fn bad_meshes_are_refused() {
    let refused = |positions: &[DVec3], triangles: &[[u32; 3]]| {
        let error = Mesh::smooth(positions, triangles).unwrap_err();
        assert!(matches!(error.kind(), PreviewErrorKind::Mesh(_)), "{error}");
        error.to_string()
    };
    assert_eq!(
        refused(&[DVec3::ZERO; 3], &[[0, 1, 2], [0, 3, 1]]),
        "face 1 names vertex 3, but there are only 3"
    );
    refused(&[DVec3::new(0.0, f64::NAN, 0.0)], &[]);
}

#[test]
fn surface_of_a_mesh_names_the_triangle_and_the_weights_of_its_corners() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::new(1.0, 0.0, 1.0)];
    let mesh = Mesh::smooth(&positions, &[[0, 2, 1], [1, 2, 3]]).unwrap();
    let (origin, direction) = (DVec3::new(0.75, 2.0, 0.5), DVec3::NEG_Y);
    let hit = mesh.first_hit(&Ray { origin, direction }, 9.0).unwrap();
    let detail = mesh.detail(origin + direction * hit.distance, &hit);
    let Chart::Triangle(triangle) = detail.chart else {
        panic!("a mesh has triangles");
    };
    assert_eq!(triangle.index, 1, "the second triangle");
    // Corners at x = 1, 0 and 1, and z = 0, 1 and 1.
    assert_eq!(triangle.weights, [0.5, 0.25, 0.25], "weights");
}
