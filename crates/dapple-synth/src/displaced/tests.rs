//! Displaced spheres, and errors for invalid heights.

use super::*;
use crate::SynthErrorKind;
use crate::shapes::{sphere, square, synthesizer};

const N: usize = 600;

#[test]
fn equal_heights_move_every_vertex_along_its_normal() {
    let sphere = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    let heights = [0.5; N];
    let sites = displaced_sites(&sphere, &heights, -0.5).unwrap();
    let hierarchy = sphere.hierarchy();
    assert_eq!(
        sites.faces(),
        hierarchy.triangles(0).unwrap().mesh.faces(),
        "faces"
    );
    let before = hierarchy.sites();
    for ((&at, &from), &normal) in sites
        .positions()
        .iter()
        .zip(before.positions())
        .zip(before.normals())
    {
        assert_eq!(at, from + normal * -0.25);
    }
    let mesh = displaced_mesh(&sphere, &heights, 0.5).unwrap();
    assert_eq!(mesh.faces(), sphere.surface().mesh().faces(), "faces");
    for at in mesh.positions() {
        // Tolerance: vertex normals of the mesh differ slightly from the sphere's normals.
        assert!((at.length() - 1.25).abs() < 1e-3, "{at}");
    }
}

#[test]
fn heights_are_interpolated_at_vertices() {
    let plane = synthesizer(square(), N, |_, _| DVec3::NEG_Y);
    let sites = plane.hierarchy().sites();
    let heights: Vec<f32> = sites.positions().iter().map(|at| at.x as f32).collect();
    let mesh = displaced_mesh(&plane, &heights, 2.0).unwrap();
    for (&at, &from) in mesh
        .positions()
        .iter()
        .zip(plane.surface().mesh().positions())
    {
        let plain = plane.hierarchy().interpolate(0, &heights, from, DVec3::Z);
        let want = 2.0 * f64::from(plain.unwrap().unwrap());
        assert_eq!(at, from + DVec3::Z * want);
        // Tolerance: sites around a vertex are up to two spacings away, and at the border there are fewer on one side.
        assert!((at.z - 2.0 * from.x).abs() < 0.1, "{at}");
    }
}

#[test]
fn bad_heights_are_refused() {
    let plane = synthesizer(square(), N, |_, _| DVec3::NEG_Y);
    for displaced in [displaced_sites, displaced_mesh] {
        let error = displaced(&plane, &[0.0; 5], 1.0).unwrap_err();
        assert!(
            matches!(error.kind(), SynthErrorKind::Count { count: 5, .. }),
            "{error}"
        );
        for (height, scale) in [(f32::NAN, 1.0), (1.0, f64::NAN), (1.0, f64::INFINITY)] {
            let error = displaced(&plane, &[height; N], scale).unwrap_err();
            assert!(
                matches!(error.kind(), SynthErrorKind::Range { .. }),
                "{error}"
            );
        }
        let error = displaced(&plane, &[1e30; N], 1e20).unwrap_err();
        assert!(matches!(error.kind(), SynthErrorKind::Mesh(_)), "{error}");
    }
}
