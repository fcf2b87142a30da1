//! Tests of shapes against their definitions at points along rays.

use super::{Body, Cut, Shape};
use crate::PreviewErrorKind;
use crate::ray::Ray;
use crate::surface::Part;
use core::f64::consts::{FRAC_PI_2, PI};
use glam::DVec3;

/// Returns five low-discrepancy numbers from 0 to 1: the fractional parts of `index` times powers of the root of `x⁶ =
/// x + 1`.
fn spread(index: u32) -> [f64; 5] {
    let root = 0.881_271_497_064_361_6_f64;
    let mut power = 1.0;
    [0; 5].map(|_| {
        power *= root;
        (f64::from(index) * power).fract()
    })
}

/// Returns a ray from a point in a cube around the origin toward a point in a smaller cube.
fn ray(index: u32) -> Ray {
    let [a, b, c, d, e] = spread(index).map(|part| 2.0 * part - 1.0);
    let origin = DVec3::new(a, b, c) * 3.0;
    let target = DVec3::new(d, a * e, e);
    let direction = (target - origin).normalize();
    Ray { origin, direction }
}

/// Returns the signed distance of a point from a torus, negative inside.
fn torus_distance(point: DVec3, major: f64, minor: f64) -> f64 {
    let outward = (point.x * point.x + point.z * point.z).sqrt() - major;
    (outward * outward + point.y * point.y).sqrt() - minor
}

/// Checks hits of a shape by marching along rays: a hit must be on the surface, and no point before it may be inside.
/// `outside` is the signed distance. Returns the numbers of hits on the skin and on the cut.
fn compare(shape: &Shape, cut: Option<Cut>, outside: impl Fn(DVec3) -> f64) -> [u32; 2] {
    let body = shape.prepare(cut).unwrap();
    let mut found = [0; 2];
    for index in 0..1500 {
        let ray = ray(index);
        if outside(ray.origin) <= 1e-9 {
            continue;
        }
        let steps = (0..4000).map(|step| f64::from(step) * 2e-3);
        let first_inside = steps.into_iter().find(|&t| outside(ray.at(t)) < 0.0);
        let Some(hit) = body.hit(&ray, f64::INFINITY) else {
            assert_eq!(
                first_inside, None,
                "ray {index} is inside, but there is no hit"
            );
            continue;
        };
        let detail = body.detail(&ray, &hit);
        // Rounding of numbers up to 6, through the square root of a quartic.
        let error = outside(detail.position);
        assert!(error.abs() < 1e-12, "ray {index} hits {error} outside");
        let is_first = first_inside.is_none_or(|t| hit.distance <= t);
        assert!(is_first, "ray {index} hits too late: {}", hit.distance);
        assert!((detail.normal.length() - 1.0).abs() < 1e-12, "ray {index}");
        found[usize::from(detail.part == Part::Cut)] += 1;
    }
    found
}

#[test]
fn torus_hit_is_the_first_point_inside_of_a_march() {
    for (major, minor) in [(1.0, 0.4), (1.2, 0.05), (0.7, 0.7)] {
        let shape = Shape::torus(major, minor);
        let found = compare(&shape, None, |point| torus_distance(point, major, minor));
        assert!(found[0] > 50, "{found:?}");
        assert_eq!(found[1], 0, "nothing is cut");
    }
}

#[test]
fn sphere_hit_is_the_first_point_inside_of_a_march() {
    let found = compare(&Shape::sphere(0.8), None, |point| point.length() - 0.8);
    assert!(found[0] > 300, "{found:?}");
}

#[test]
fn half_torus_hit_is_the_first_point_inside_of_a_march() {
    let normal = DVec3::new(2.0, 1.0, 0.0);
    let cut = Cut::HalfSpace {
        normal,
        offset: 0.3,
    };
    let found = compare(&Shape::torus(1.0, 0.4), Some(cut), |point| {
        let beyond = point.dot(normal.normalize()) - 0.3;
        torus_distance(point, 1.0, 0.4).max(beyond)
    });
    assert!(found[0] > 100 && found[1] > 30, "{found:?}");
}

#[test]
fn sectors_of_a_torus_hit_at_the_first_point_inside_of_a_march() {
    // The quarter between +x and -z, and its complement.
    let in_quarter = |point: DVec3| (-point.x).max(point.z);
    let torus = |point| torus_distance(point, 1.0, 0.4);
    let shape = Shape::torus(1.0, 0.4);
    let (start, sweep) = (0.0, FRAC_PI_2);
    let found = compare(&shape, Some(Cut::Sector { start, sweep }), |point| {
        torus(point).max(in_quarter(point))
    });
    assert!(found[0] > 30 && found[1] > 30, "quarter: {found:?}");
    let (start, sweep) = (FRAC_PI_2, 1.5 * PI);
    let found = compare(&shape, Some(Cut::Sector { start, sweep }), |point| {
        torus(point).max(-in_quarter(point))
    });
    assert!(found[0] > 100 && found[1] > 30, "the rest: {found:?}");
}

#[test]
fn torus_hit_from_inside_is_the_way_out() {
    let shape = Shape::torus(1.0, 0.25);
    let (origin, direction) = (DVec3::X, DVec3::X);
    let ray = Ray { origin, direction };
    let hit = shape.prepare(None).unwrap().hit(&ray, f64::INFINITY);
    let distance = hit.map(|hit| hit.distance).unwrap_or_default();
    // A root is found to 1e-15 of the outer radius.
    assert!((distance - 0.25).abs() < 1e-14, "{distance}");
}

#[test]
fn torus_is_missed_through_its_hole_and_beside_it() {
    let shape = Shape::torus(1.0, 0.25);
    let body = shape.prepare(None).unwrap();
    for x in [0.0, 0.7, 1.3] {
        let (origin, direction) = (DVec3::new(x, 5.0, 0.0), DVec3::NEG_Y);
        let ray = Ray { origin, direction };
        assert!(body.hit(&ray, f64::INFINITY).is_none(), "at {x}");
    }
}

#[test]
fn torus_hit_is_exact_from_far_away() {
    let shape = Shape::torus(1.0, 0.25);
    let (origin, direction) = (DVec3::new(1.0, 1e6, 0.0), DVec3::NEG_Y);
    let ray = Ray { origin, direction };
    let hit = shape
        .prepare(None)
        .unwrap()
        .hit(&ray, f64::INFINITY)
        .unwrap();
    // The distance is rounded to 1e-10 there.
    assert!(
        (hit.distance - (1e6 - 0.25)).abs() < 3e-10,
        "{}",
        hit.distance
    );
}

#[test]
fn rectangle_ends_where_it_says() {
    let shape = Shape::rectangle(1.0, 0.5);
    let body = shape.prepare(None).unwrap();
    let meets = |x: f64, z: f64| {
        let (origin, direction) = (DVec3::new(x, 2.0, z), DVec3::NEG_Y);
        body.blocks(&Ray { origin, direction }, f64::INFINITY)
    };
    assert!(meets(0.99, 0.49) && meets(-0.99, -0.49), "inside");
    assert!(!meets(1.01, 0.0) && !meets(0.0, -0.51), "outside");
}

#[test]
fn plane_is_not_met_by_rays_along_it() {
    let body = Shape::Plane.prepare(None).unwrap();
    for height in [0.0, 1.0] {
        let (origin, direction) = (DVec3::Y * height, DVec3::X);
        let ray = Ray { origin, direction };
        assert!(body.hit(&ray, f64::INFINITY).is_none(), "at {height}");
    }
}

#[test]
fn shapes_without_an_inside_cannot_be_cut() {
    let (normal, offset) = (DVec3::Y, 0.0);
    let cut = Some(Cut::HalfSpace { normal, offset });
    for (shape, name) in [
        (Shape::Plane, "plane"),
        (Shape::rectangle(1.0, 1.0), "rectangle"),
    ] {
        let error = shape.prepare(cut).map(|_: Body<'_>| ()).unwrap_err();
        assert_eq!(*error.kind(), PreviewErrorKind::NotSolid { shape: name });
    }
}
