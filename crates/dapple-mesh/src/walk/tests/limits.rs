//! Tests of walks to borders, across needles, with numbers that are not finite, and on arbitrary meshes.

use super::{ROUNDING, is_inside, start};
use crate::test_meshes::{cube, mesh, plane, ring, sheet, soup, surface, tetrahedron};
use crate::{FaceIdx, Mesh, Surface, SurfacePoint};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

#[test]
fn walk_stops_at_a_border_with_the_rest_left() {
    let plane = surface(plane(4, 4));
    for (along, want) in [
        ([1.0, 0.0], 2.5),
        ([0.0, 1.0], 2.25),
        ([-1.0, 0.0], 1.5),
        ([0.0, -1.0], 1.75),
    ] {
        let (from, direction) = start(
            &plane,
            2 * (4 + 1) + 1,
            [1.5, 1.75, 0.0],
            [along[0], along[1], 0.0],
        );
        let walk = plane.walk(from, direction, 10.0);
        assert!(
            (walk.left - (10.0 - want)).abs() < ROUNDING * 10.0,
            "along {along:?}: {}",
            walk.left
        );
        let end = plane.position(walk.point);
        let border = [end.x, end.y, 4.0 - end.x, 4.0 - end.y]
            .into_iter()
            .fold(1.0, f64::min);
        assert!(
            border.abs() < ROUNDING && is_inside(&plane, walk.point),
            "at the border: {end}"
        );
        let back = plane.walk(from, -direction, -10.0);
        assert_eq!(
            (back.point, back.left, back.direction),
            (walk.point, -walk.left, -walk.direction),
            "backward"
        );
    }
}

#[test]
fn walk_stops_at_a_non_manifold_edge() {
    let corners = [
        [0.0; 3],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let book = surface(mesh(&corners, &[[0, 2, 1], [0, 1, 3], [0, 1, 4]]));
    let (from, direction) = start(&book, 0, [0.25, 0.25, 0.0], [-1.0, 0.0, 0.0]);
    assert_eq!(book.walk(from, direction, 1.0).left, 0.75);
}

#[test]
fn walk_of_no_distance_stays_and_what_is_not_finite_goes_nowhere() {
    let cube = surface(cube());
    let from = cube.point(FaceIdx(3), [0.2, 0.3, 0.5]);
    let stays = |from, direction, distance: f64| {
        let walk = cube.walk(from, direction, distance);
        format!("{:?} {:?}", walk.point, walk.left) == format!("{from:?} {distance:?}")
    };
    assert!(stays(from, DVec2::X, 0.0), "no distance");
    for distance in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(stays(from, DVec2::X, distance), "{distance}");
    }
    assert!(stays(from, DVec2::new(f64::NAN, 0.0), 1.0), "no direction");
    let nowhere = SurfacePoint {
        flat: DVec2::NAN,
        ..from
    };
    assert!(stays(nowhere, DVec2::X, 1.0), "no point");
    assert_eq!(
        cube.walk(from, DVec2::ZERO, 1.0).point,
        from,
        "the zero direction"
    );
}

#[test]
fn walk_ends_after_many_edges() {
    let prism = surface(ring(3, false));
    let from = SurfacePoint {
        face: FaceIdx(0),
        flat: DVec2::new(0.5, 0.25),
    };
    for distance in [1e6, 1e30, f64::MAX] {
        let walk = prism.walk(from, DVec2::X, distance);
        // Two edges per unit of distance.
        assert!(
            walk.left > 0.0 && (walk.left - (distance - 32768.0)).abs() <= 1.0 + 1e-16 * distance,
            "{}",
            walk.left
        );
        assert!(is_inside(&prism, walk.point), "on the prism");
    }
}

#[test]
fn walk_crosses_needles_as_if_they_were_not_there() {
    // Ten squares with a width of 1e-12 between two wide ones.
    let across = |column: u32| match column {
        0 => -1.0,
        12 => 1.0,
        column => 1e-12 * (f64::from(column) - 1.0),
    };
    let narrow = sheet(12, 3, |column, row| {
        DVec3::new(across(column), row.into(), 0.0)
    });
    let sheet = surface(narrow);
    for along in [[1.0, 0.0, 0.0], [1.0, 1.5, 0.0], [1.0, 0.25, 0.0]] {
        let (from, direction) = start(&sheet, 0, [-0.5, 0.125, 0.0], along);
        let walk = sheet.walk(from, direction, 1.2);
        let off = sheet.position(walk.point)
            - sheet.position(from)
            - sheet.lift(from.face, direction) * 1.2;
        // 24 faces or slightly more.
        assert!(off.length() < 2.0 * ROUNDING * 4.0, "{along:?}: {off}");
        assert_eq!(walk.left, 0.0, "no border");
    }
    // Along the needles, where a path stays in one face for a long distance.
    let (from, direction) = start(&sheet, 8, [3.2e-12, 0.1, 0.0], [1e-13, 1.0, 0.0]);
    assert_eq!(
        sheet.walk(from, direction, 2.0).left,
        0.0,
        "along the needles"
    );
}

#[test]
fn walk_around_the_tip_of_a_spike_ends() {
    let n = 6;
    let rim = (0..n).map(|step| {
        let angle = core::f64::consts::TAU * f64::from(step) / f64::from(n);
        [1e-9 * libm::cos(angle), 1e-9 * libm::sin(angle), 0.0]
    });
    let corners: Vec<[f64; 3]> = rim.chain([[0.0, 0.0, 1.0]]).collect();
    let faces: Vec<[u32; 3]> = (0..n).map(|step| [step, (step + 1) % n, n]).collect();
    let spike = surface(mesh(&corners, &faces));
    let tip = spike.point(FaceIdx(0), [0.0, 0.0, 1.0]);
    for angle in 0..32 {
        let angle = 0.2 * f64::from(angle);
        let walk = spike.walk(tip, DVec2::new(libm::cos(angle), libm::sin(angle)), 3.0);
        assert!(
            spike.position(walk.point).is_finite() && walk.left <= 3.0,
            "from the tip: {walk:?}"
        );
    }
}

/// Generates a closed, open or rough surface, and a point in one of its faces.
fn somewhere() -> impl Strategy<Value = (Surface, SurfacePoint)> {
    let rough = sheet(9, 9, |column, row| {
        let height = libm::sin(f64::from(column * 7 + row * 3)) + 0.1 * f64::from(row);
        DVec3::new(column.into(), row.into(), height)
    });
    let meshes: Vec<Mesh> = vec![tetrahedron(), cube(), ring(5, false), rough];
    (
        prop::sample::select(meshes),
        0_u32..10_000,
        [0.01..1.0_f64, 0.01..1.0, 0.01..1.0],
    )
        .prop_map(|(mesh, face, weights)| {
            let surface = surface(mesh);
            let face = FaceIdx(face % surface.mesh().faces().len() as u32);
            let sum: f64 = weights.iter().sum();
            let point = surface.point(face, weights.map(|weight| weight / sum));
            (surface, point)
        })
}

proptest! {
    #[test]
    fn walk_there_and_back_ends_at_the_start((surface, from) in somewhere(), angle in 0.0..6.3_f64, distance in 0.0..12.0_f64) {
        let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
        let there = surface.walk(from, direction, distance);
        let gone = distance - there.left;
        let back = surface.walk(there.point, -there.direction, gone);
        prop_assert!(is_inside(&surface, there.point));
        // Near a vertex a path may pass on either side of it, so the way back may differ.
        let off = surface.position(back.point) - surface.position(from);
        prop_assert!(off.length() < 8.0 * ROUNDING * (distance + 3.0), "{}", off);
        let turned = surface.lift(from.face, direction) + surface.lift(back.point.face, back.direction);
        prop_assert!(turned.length() < 8.0 * ROUNDING || back.point.face != from.face, "{}", turned);
    }

    #[test]
    fn walk_in_two_parts_equals_the_walk_in_one((surface, from) in somewhere(), angle in 0.0..6.3_f64, part in 0.0..1.0_f64) {
        let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
        let whole = surface.walk(from, direction, 5.0);
        let half = surface.walk(from, direction, 5.0 * part);
        if half.left == 0.0 {
            let rest = surface.walk(half.point, half.direction, 5.0 - 5.0 * part);
            let off = surface.position(rest.point) - surface.position(whole.point);
            prop_assert!(off.length() < 8.0 * ROUNDING * 8.0, "{}", off);
        }
    }

    #[test]
    fn walk_on_any_mended_soup_ends_on_it(mesh in soup(), face in 0_u32..24, x in -1.0..1.0_f64, y in -1.0..1.0_f64, distance in -9.0..9.0_f64) {
        if let Ok(surface) = Surface::new(mesh.repair().0) {
            let face = FaceIdx(face % surface.mesh().faces().len() as u32);
            for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.25, 0.25]] {
                let from = surface.point(face, weights);
                let walk = surface.walk(from, DVec2::new(x, y), distance);
                prop_assert!(walk.left * distance >= 0.0 && walk.left.abs() <= distance.abs());
                prop_assert!(walk.point.flat.is_finite() && walk.direction.is_finite());
                // Near the tip of a spike a path may cross the maximum of 65,536 edges, with a few rounding errors of
                // the largest coordinate at each.
                let largest = surface.mesh().positions().iter().map(|at| at.abs().max_element()).fold(1.0, f64::max);
                let corners = surface.flat(walk.point.face).corners();
                for edge in 0..3 {
                    let along = (corners[(edge + 1) % 3] - corners[edge]).normalize();
                    prop_assert!(along.perp_dot(walk.point.flat - corners[edge]) > -65536.0 * 8.0 * f64::EPSILON * largest);
                }
            }
        }
    }
}
