use super::*;
use crate::test_meshes::{cube, mesh, plane, ring, soup, surface, tetrahedron};
use crate::{FaceIdx, Mesh};
use glam::DVec3;
use proptest::prelude::*;

/// What 16 faces may add to the place and the direction, in parts of the distance and the size of a face: 2^-46.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The point of a face below a position, and a direction along a vector.
fn start(
    surface: &Surface,
    face: u32,
    position: [f64; 3],
    along: [f64; 3],
) -> (SurfacePoint, DVec2) {
    let face = FaceIdx(face);
    let direction = surface.flatten(face, DVec3::from_array(along)).normalize();
    (
        surface.project(face, DVec3::from_array(position)),
        direction,
    )
}

/// Whether the point of a walk is in its face, but for rounding.
fn is_inside(surface: &Surface, point: SurfacePoint) -> bool {
    let corners = surface.flat(point.face).corners();
    (0..3).all(|edge| {
        let along = corners[(edge + 1) % 3] - corners[edge];
        along.perp_dot(point.flat - corners[edge]) >= -1e-13 * along.length()
    })
}

#[test]
fn walk_on_a_plane_equals_straight_line_arithmetic() {
    let plane = surface(plane(40, 40));
    for step in 0..64 {
        let angle = f64::from(step) * 0.1;
        let along = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
        for distance in [0.0, 0.1, 1.0, 7.77, 19.0] {
            let from = DVec3::new(20.3, 20.4, 0.0);
            let face = FaceIdx(2 * (20 * 40 + 20) + 1);
            let walk = plane.walk(
                plane.project(face, from),
                plane.flatten(face, along),
                distance,
            );
            let off = plane.position(walk.point) - (from + along * distance);
            // At most 80 faces.
            assert!(
                off.length() < 5.0 * ROUNDING * (distance + 2.0),
                "{distance} along {along}: {off}"
            );
            let turned = plane.lift(walk.point.face, walk.direction) - along;
            assert!(turned.length() < 5.0 * ROUNDING, "direction {turned}");
            assert_eq!(walk.left, 0.0, "no border");
            assert!(is_inside(&plane, walk.point), "in its face");
        }
    }
}

#[test]
fn walk_around_a_prism_follows_the_unrolled_strip() {
    let prism = surface(ring(12, false));
    let from = SurfacePoint {
        face: FaceIdx(0),
        flat: DVec2::new(0.5, 0.25),
    };
    for slope in [0.0, 0.01, -0.02] {
        let direction = DVec2::new(1.0, slope).normalize();
        let walk = prism.walk(from, direction, 12.0 / direction.x);
        assert_eq!(walk.point.face, FaceIdx(0), "once around");
        let off = walk.point.flat - from.flat - DVec2::Y * 12.0 * slope;
        // 24 faces.
        assert!(off.length() < 2.0 * ROUNDING * 14.0, "slope {slope}: {off}");
        assert!(
            (walk.direction - direction).length() < 2.0 * ROUNDING,
            "direction"
        );
    }
}

#[test]
fn walk_around_a_cube_returns_after_four_sides() {
    let cube = surface(cube());
    let (from, direction) = start(&cube, 4, [0.3, 0.0, 0.2], [1.0, 0.0, 0.0]);
    let walk = cube.walk(from, direction, 4.0);
    // 8 faces.
    assert!(
        (cube.position(walk.point) - cube.position(from)).length() < ROUNDING * 6.0,
        "place"
    );
    assert!(
        (walk.direction - direction).length() < ROUNDING,
        "direction"
    );
    // Across the diagonals of six sides, a closed path of length 3 sqrt 2 through the middles of their edges.
    let (from, direction) = start(&cube, 4, [0.5, 0.0, 0.0], [1.0, 0.0, 1.0]);
    let walk = cube.walk(from, direction, 3.0 * libm::sqrt(2.0));
    assert!(
        (cube.position(walk.point) - cube.position(from)).length() < ROUNDING * 6.0,
        "hexagon"
    );
}

#[test]
fn walk_on_a_tetrahedron_follows_the_unrolled_lattice() {
    // The plane tiled with triangles rolls up to the tetrahedron; shifts by twice an edge lead to the same point.
    let tetrahedron = surface(tetrahedron());
    let edge = libm::sqrt(8.0);
    let from = tetrahedron.point(FaceIdx(0), [0.3, 0.4, 0.3]);
    let height = 0.5 * libm::sqrt(3.0) * edge;
    for (i, j) in [(1, 0), (0, 1), (1, 1), (2, -1), (-3, 2)] {
        let [i, j] = [f64::from(i), f64::from(j)];
        let shift = DVec2::new(2.0 * edge * i + edge * j, 2.0 * height * j);
        let walk = tetrahedron.walk(from, shift.normalize(), shift.length());
        let off = tetrahedron.position(walk.point) - tetrahedron.position(from);
        // At most 32 faces.
        assert!(
            off.length() < 2.0 * ROUNDING * (shift.length() + 3.0),
            "{i} {j}: {off}"
        );
    }
}

#[test]
fn walk_around_a_corner_of_a_cube_turns_a_vector_by_a_right_angle() {
    let cube = surface(cube());
    let (first, mut heading) = start(&cube, 5, [0.25, 0.0, 0.25], [-1.0, 0.0, 0.0]);
    // The vector that is carried, seen from the heading: at first the heading itself.
    let mut vector = DVec2::X;
    let mut point = first;
    // A path with square turns around the corner closes after three legs.
    for _ in 0..3 {
        let walk = cube.walk(point, heading, 0.5);
        point = walk.point;
        heading = walk.direction.perp();
        vector = -vector.perp();
    }
    assert!(
        (cube.position(point) - cube.position(first)).length() < ROUNDING,
        "back at the start"
    );
    let carried = cube.lift(point.face, vector.rotate(heading));
    assert!(
        (carried - DVec3::NEG_Z).length() < ROUNDING,
        "from -x to {carried}"
    );
}

#[test]
fn walk_along_edges_and_through_vertices_stays_on_its_line() {
    let plane = surface(plane(8, 8));
    let first = FaceIdx(2 * (3 * 8 + 3));
    let corner = plane.project(first, DVec3::new(3.0, 3.0, 0.0));
    for along in [
        [1.0, 0.0],
        [0.0, 1.0],
        [1.0, 1.0],
        [-1.0, 0.0],
        [0.0, -1.0],
        [-1.0, -1.0],
        [1.0, -1.0],
        [-1.0, 1.0],
    ] {
        let along = DVec3::new(along[0], along[1], 0.0);
        let walk = plane.walk(
            corner,
            plane.flatten(first, along).normalize(),
            2.5 * along.length(),
        );
        let off = plane.position(walk.point) - DVec3::new(3.0, 3.0, 0.0) - along * 2.5;
        assert!(off.length() < ROUNDING * 5.0, "along {along}: {off}");
        assert!(
            walk.left == 0.0 && is_inside(&plane, walk.point),
            "along {along}"
        );
    }
}

#[test]
fn walk_over_vertices_of_closed_meshes_ends_on_them() {
    for closed in [surface(tetrahedron()), surface(cube())] {
        for face in 0..closed.mesh().faces().len() as u32 {
            let flat = closed.flat(FaceIdx(face));
            for (corner, target) in [(0, 1), (1, 2), (2, 0), (0, 2), (1, 0), (2, 1)] {
                let [from, to] = [corner, target].map(|corner: usize| flat.corners()[corner]);
                let point = SurfacePoint {
                    face: FaceIdx(face),
                    flat: from,
                };
                // Along the edge and on past the vertex at its end; away from the face at its start.
                for (direction, distance) in [
                    (to - from, 2.5),
                    (from - to, 0.75),
                    ((from - to).perp(), 1.5),
                ] {
                    let walk = closed.walk(point, direction.normalize(), distance);
                    assert!(
                        walk.left == 0.0 && is_inside(&closed, walk.point),
                        "face {face}: {walk:?}"
                    );
                }
            }
        }
    }
}

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
        // Two edges for each unit.
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
    // Ten squares as narrow as 1e-12 between two wide ones.
    let across = |column: u32| match column {
        0 => -1.0,
        12 => 1.0,
        column => 1e-12 * (f64::from(column) - 1.0),
    };
    let sheet = crate::test_meshes::sheet(12, 3, |column, row| {
        DVec3::new(across(column), row.into(), 0.0)
    });
    let sheet = surface(sheet);
    for along in [[1.0, 0.0, 0.0], [1.0, 1.5, 0.0], [1.0, 0.25, 0.0]] {
        let (from, direction) = start(&sheet, 0, [-0.5, 0.125, 0.0], along);
        let walk = sheet.walk(from, direction, 1.2);
        let off = sheet.position(walk.point)
            - sheet.position(from)
            - sheet.lift(from.face, direction) * 1.2;
        // 24 faces or a few more.
        assert!(off.length() < 2.0 * ROUNDING * 4.0, "{along:?}: {off}");
        assert_eq!(walk.left, 0.0, "no border");
    }
    // Along the needles, where it takes a path forever to leave one.
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

#[test]
fn value_stability_walk() {
    let cube = surface(cube());
    let from = cube.point(FaceIdx(4), [0.5, 0.25, 0.25]);
    let walk = cube.walk(from, DVec2::new(0.6, 0.8), 3.3);
    assert_eq!(walk.point.face, FaceIdx(7));
    assert_eq!(
        walk.point.flat.to_array(),
        [0.41719300090006256, 0.2616295090390224]
    );
    assert_eq!(
        walk.direction.to_array(),
        [-0.14142135623730967, 0.9899494936611666]
    );
}

/// A closed, open, or rough surface, and a point in one of its faces.
fn somewhere() -> impl Strategy<Value = (Surface, SurfacePoint)> {
    let rough = crate::test_meshes::sheet(9, 9, |column, row| {
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
        // Next to a vertex a path may pass on either side of it, and there and back are different paths.
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
                // A few roundings of the largest part of a position, for each face.
                let largest = surface.mesh().positions().iter().map(|at| at.abs().max_element()).fold(1.0, f64::max);
                let corners = surface.flat(walk.point.face).corners();
                for edge in 0..3 {
                    let along = (corners[(edge + 1) % 3] - corners[edge]).normalize();
                    prop_assert!(along.perp_dot(walk.point.flat - corners[edge]) >= -1e-13 * largest);
                }
            }
        }
    }
}
