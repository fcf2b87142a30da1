//! Tests of walks whose ends are known from unrolling the surface.

mod limits;

use super::*;
use crate::FaceIdx;
use crate::test_meshes::{cube, plane, ring, surface, tetrahedron};
use glam::DVec3;

/// Error bound of position and direction after 16 faces, relative to the distance and the size of a face: 2^-46.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Returns a start point: `position` projected onto a face. Also returns the unit direction of `along` in the plane of
/// the face.
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

/// Returns whether the end of a walk is inside its face, up to rounding.
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
    // Across the diagonals of six sides: a closed path of length 3 sqrt 2 through the midpoints of their edges.
    let (from, direction) = start(&cube, 4, [0.5, 0.0, 0.0], [1.0, 0.0, 1.0]);
    let walk = cube.walk(from, direction, 3.0 * libm::sqrt(2.0));
    assert!(
        (cube.position(walk.point) - cube.position(from)).length() < ROUNDING * 6.0,
        "hexagon"
    );
}

#[test]
fn walk_on_a_tetrahedron_follows_the_unrolled_lattice() {
    // The tetrahedron unrolls to a tiling of the plane by triangles; shifts by two edge lengths lead to the same
    // point.
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
    // The transported vector relative to the heading; initially the heading itself.
    let mut vector = DVec2::X;
    let mut point = first;
    // A path with right-angle turns around the corner closes after three legs.
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
                // Along the edge past the vertex at its end, and away from the face at its start.
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
