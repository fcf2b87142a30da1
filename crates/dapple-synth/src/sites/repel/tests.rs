//! Tests of repulsion against forces from all points, and of the resulting evenness.

use super::{Crowd, FACING, GAIN_FIRST, MARGIN, repel};
use crate::shapes::{geodesic_sphere, plane, scraps, sheet, torus};
use crate::sites::near::CHUNK;
use crate::{Sites, evenness, scatter};
use dapple_hash::Seed;
use dapple_mesh::{FaceIdx, Surface, SurfacePoint};
use glam::{DVec2, DVec3};

/// Computes the push on a site from all other sites by the formula, in the plane of its face.
fn naive_push(surface: &Surface, sites: &Sites, site: usize, radius: f64) -> DVec2 {
    let face = sites.points()[site].face;
    let mut sum = DVec2::ZERO;
    for other in (0..sites.len()).filter(|&other| other != site) {
        let way = sites.positions()[site] - sites.positions()[other];
        let distance = way.length();
        if distance < radius && sites.normals()[site].dot(sites.normals()[other]) >= FACING {
            let part = distance / radius;
            let strength = 0.125 * radius * (1.0 - part * part) / (part * part);
            sum += surface.flatten(face, way).normalize_or_zero() * strength;
        }
    }
    sum
}

#[test]
fn push_equals_that_of_all_pairs() {
    for surface in [geodesic_sphere(3), torus(48, 24), plane()] {
        let points = scatter(&surface, 1500, Seed(3));
        let sites = Sites::new(&surface, points.clone());
        let radius = 2.0 * (surface.area() / 1500.0).sqrt();
        let n_fixed = 100;
        let crowd = Crowd::new(&surface, &points, n_fixed, radius);
        for site in n_fixed..1500 {
            let free = site - n_fixed;
            let row = crowd.near.chunk(free / CHUNK).row(free % CHUNK);
            let face = sites.points()[site].face;
            let pushed = crowd.push(face, site, row);
            let pushed = surface.flatten(face, pushed);
            let naive = naive_push(&surface, &sites, site, radius);
            // Tolerance: the order of the sum differs, and some random points nearly coincide, which makes large terms.
            let scale = naive.length().max(radius) * 1e-9;
            assert!(
                (pushed - naive).length() < scale,
                "site {site}: {pushed} and {naive}"
            );
        }
    }
}

#[test]
fn lists_hold_all_neighbors_for_as_long_as_they_are_used() {
    let surface = torus(48, 24);
    let mut points = scatter(&surface, 800, Seed(5));
    let radius = 2.0 * (surface.area() / 800.0).sqrt();
    let mut crowd = Crowd::new(&surface, &points, 0, radius);
    for _ in 0..6 {
        crowd.step(&mut points, GAIN_FIRST);
    }
    for (site, position) in crowd.positions.iter().enumerate() {
        let moved = position.distance(crowd.listed[site]);
        // Tolerance: rounding of the walk.
        assert!(
            moved <= 0.5 * MARGIN * radius * (1.0 + 1e-9),
            "site {site} moved by {moved}"
        );
    }
}

#[test]
fn repulsion_makes_points_even() {
    for surface in [geodesic_sphere(3), torus(48, 24), plane()] {
        let mut points = scatter(&surface, 1000, Seed(7));
        repel(&surface, &mut points, 0, 60);
        let even = evenness(&surface, &Sites::new(&surface, points), 1000);
        assert!(even.mean > 0.84 && even.min > 0.5, "{even:?}");
    }
}

#[test]
fn fixed_points_stay_to_the_last_bit() {
    let surface = geodesic_sphere(3);
    let mut points = scatter(&surface, 300, Seed(9));
    let before = points.clone();
    repel(&surface, &mut points, 120, 5);
    assert_eq!(points[..120], before[..120]);
    assert_ne!(points[120..], before[120..]);
    let before = points.clone();
    repel(&surface, &mut points, 300, 5);
    repel(&surface, &mut points, usize::MAX, 5);
    repel(&surface, &mut points, 0, 0);
    assert_eq!(points, before);
}

#[test]
fn points_in_one_place_part() {
    for surface in [geodesic_sphere(3), plane(), scraps(1)] {
        let point = surface.point(FaceIdx(0), [0.2, 0.3, 0.5]);
        let mut points = vec![point; 12];
        repel(&surface, &mut points, 0, 200);
        let even = evenness(&surface, &Sites::new(&surface, points), 12);
        assert!(even.min > 0.3, "{even:?}");
    }
}

#[test]
fn points_stay_inside_of_borders() {
    let surface = plane();
    let mut points = scatter(&surface, 400, Seed(11));
    repel(&surface, &mut points, 0, 40);
    for &point in &points {
        let least = surface.weights(point).into_iter().fold(1.0, f64::min);
        // Tolerance: rounding, and the inward slope of walks along borders.
        assert!(least > -1e-6, "{point:?} has a weight of {least}");
    }
}

#[test]
fn points_slide_along_borders() {
    // Two points near each other on one border of a square of two faces slide to the ends of the border.
    let square = sheet([1, 1], [true; 2], |u, v| DVec3::new(u, v, 0.0));
    let surface = Surface::new(square).unwrap();
    let on_border = |x: f64| surface.project(FaceIdx(0), DVec3::new(x, 0.0, 0.0));
    let mut points = vec![on_border(0.45), on_border(0.55)];
    repel(&surface, &mut points, 0, 300);
    let distance = surface
        .position(points[0])
        .distance(surface.position(points[1]));
    assert!(distance > 0.99, "they are only {distance} apart");
}

#[test]
fn sheets_that_face_away_do_not_push() {
    // Two parallel triangles that face away from each other, like the top and bottom of a thin box.
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let positions = [0.0, 1e-3].map(|z| {
        [
            corner(0.0, 0.0, z),
            corner(1.0, 0.0, z),
            corner(0.0, 1.0, z),
        ]
    });
    let mesh = dapple_mesh::Mesh::new(positions.concat(), &[[0, 2, 1], [3, 4, 5]]).unwrap();
    let surface = Surface::new(mesh).unwrap();
    let below = surface.project(FaceIdx(0), corner(0.3, 0.3, 0.0));
    let above = surface.project(FaceIdx(1), corner(0.31, 0.3, 0.0));
    let mut points = vec![below, above];
    repel(&surface, &mut points, 0, 10);
    assert_eq!(points, [below, above]);
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let surface = torus(48, 24);
    let repelled = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut points = scatter(&surface, 5000, Seed(13));
        pool.install(|| repel(&surface, &mut points, 1000, 10));
        points
    };
    let one = repelled(1);
    assert_eq!(one, repelled(2));
    assert_eq!(one, repelled(7));
}

#[test]
fn nothing_bad_happens_without_points_or_area() {
    repel(&plane(), &mut [], 0, 3);
    let tiny = sheet([2, 2], [true; 2], |u, v| DVec3::new(u, v, 0.0) * 1e-10);
    let huge = sheet([2, 2], [true; 2], |u, v| DVec3::new(u, v, 0.0) * 1e29);
    for mesh in [tiny, huge] {
        let surface = Surface::new(mesh).unwrap();
        let mut points = scatter(&surface, 50, Seed(1));
        points.push(SurfacePoint {
            face: FaceIdx(0),
            flat: DVec2::NAN,
        });
        repel(&surface, &mut points, 0, 5);
        assert!(
            points[..50].iter().all(|point| point.flat.is_finite()),
            "{points:?}"
        );
    }
}

#[test]
fn value_stability_repel() {
    let torus = torus(48, 24);
    let mut points = scatter(&torus, 40, Seed(1));
    repel(&torus, &mut points, 10, 20);
    let positions =
        [points[10], points[25], points[39]].map(|point| torus.position(point).to_array());
    assert_eq!(positions, PINNED);
}

const PINNED: [[f64; 3]; 3] = [
    [
        -0.07908829361773848,
        -1.3665443842964304,
        -0.1388770776372959,
    ],
    [-1.10051604902296, -0.8451257315828968, -0.09408955978938913],
    [0.45014291297291925, -0.5026326352886452, 0.2293967416476316],
];
