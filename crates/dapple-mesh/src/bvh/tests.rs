//! Tests of the hierarchy against a search through all triangles.

use super::{Bvh, NearestPoint, Probe, Ray, RayHit};
use crate::{FaceIdx, Mesh};
use glam::DVec3;

/// A generator of random numbers from 0 to 1: the high bits of a multiplicative congruential generator by L'Ecuyer,
/// Mathematics of Computation 68, 1999.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(2_862_933_555_777_941_757) | 1;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        let [x, y, z] = [0; 3].map(|_| self.next());
        DVec3::new(x, y, z) * 2.0 - 1.0
    }
}

fn bvh(positions: Vec<DVec3>, faces: &[[u32; 3]]) -> Bvh {
    Bvh::new(&Mesh::new(positions, faces).unwrap())
}

/// Returns small random triangles. Every seventh is duplicated, and every ninth has no area.
fn soup(count: u32) -> Bvh {
    let mut numbers = Numbers(12_345);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for index in 0..count {
        let at = positions.len() as u32;
        let corner = numbers.point();
        let [a, b] = [numbers.point() * 0.1, numbers.point() * 0.1];
        let b = if index % 9 == 0 { a * 2.0 } else { b };
        positions.extend([corner, corner + a, corner + b]);
        triangles.push([at, at + 1, at + 2]);
        if index % 7 == 0 {
            triangles.push([at, at + 1, at + 2]);
        }
    }
    bvh(positions, &triangles)
}

/// Returns a sheet of `side × side` squares in the plane `y = 0`, from the origin.
fn flat_grid(side: u32) -> Bvh {
    let at = |i: u32, j: u32| j * (side + 1) + i;
    let positions: Vec<DVec3> = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| DVec3::new(i.into(), 0.0, j.into())))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..side)
        .flat_map(|j| (0..side).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, d, c], [a, c, b]]
        })
        .collect();
    bvh(positions, &triangles)
}

/// Returns the nearest hit among all triangles, by brute force. On a tie, it is the triangle with the lowest index.
fn first_of_all(bvh: &Bvh, ray: &Ray, limit: f64) -> Option<RayHit> {
    let (ray, shift) = bvh.near_ray(ray);
    let probe = Probe::new(&ray);
    let slots = 0..bvh.corners.len() as u32;
    let hits = slots.filter_map(|slot| bvh.meet(&probe, shift, slot));
    let hits = hits.filter(|hit| hit.distance <= limit);
    hits.min_by(|a, b| {
        let by_index = a.face.cmp(&b.face);
        a.distance.total_cmp(&b.distance).then(by_index)
    })
}

/// Compares the hierarchy with a brute-force search. Returns the number of rays with a hit.
fn compare(bvh: &Bvh, rays: impl Iterator<Item = Ray>) -> u32 {
    let mut found = 0;
    for (index, ray) in rays.enumerate() {
        for limit in [f64::INFINITY, 1.5] {
            let hit = bvh.first_hit(&ray, limit);
            let expected = first_of_all(bvh, &ray, limit);
            assert_eq!(hit, expected, "ray {index} up to {limit}");
            let before = expected.is_some_and(|hit| hit.distance < limit);
            assert_eq!(
                bvh.is_blocked(&ray, limit),
                before,
                "ray {index} to {limit}"
            );
            found += u32::from(hit.is_some());
        }
    }
    found
}

#[test]
fn bvh_finds_what_a_search_through_all_triangles_finds() {
    let bvh = soup(1200);
    let mut numbers = Numbers(777);
    let rays = (0..4000).map(|index| {
        // Origins inside the mesh, around it, and far away.
        let origin = numbers.point() * [0.9, 3.0, 1e4][index % 3];
        let direction = (numbers.point() - origin).normalize();
        Ray { origin, direction }
    });
    let found = compare(&bvh, rays);
    assert!((1000..7000).contains(&found), "{found} hits");
}

#[test]
fn bvh_finds_the_lowest_index_along_the_axes_and_edges_of_a_grid() {
    let bvh = flat_grid(12);
    let mut numbers = Numbers(99);
    let rays = (0..600).map(|index| {
        // Many rays pass exactly through vertices and edges, where up to six triangles are at the same distance.
        let place = ((numbers.point() + 1.0) * 12.0).floor() * 0.5;
        let axis = [DVec3::NEG_Y, DVec3::X, DVec3::new(0.6, -0.8, 0.0)][index % 3];
        let origin = DVec3::new(place.x, if index % 3 == 1 { 0.0 } else { 1.0 }, place.z);
        let direction = axis;
        Ray { origin, direction }
    });
    let found = compare(&bvh, rays);
    assert!(found > 300, "{found} hits");
}

#[test]
fn bvh_holds_triangles_that_cannot_be_told_apart() {
    let bvh = bvh(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]; 100]);
    let (origin, direction) = (DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    let ray = Ray { origin, direction };
    let hit = bvh.first_hit(&ray, f64::INFINITY).unwrap();
    assert_eq!((hit.face, hit.distance), (FaceIdx(0), 1.0));
    let point = bvh.nearest_point(origin).unwrap();
    assert_eq!((point.face, point.distance_sq), (FaceIdx(0), 1.0));
}

#[test]
fn bvh_has_a_bounded_depth_when_every_triangle_is_half_as_far() {
    // Bins along an axis separate one or two of these triangles at a time, so that a tree without a depth limit would
    // be a list.
    let mut positions = Vec::new();
    for power in 0..180 {
        let x = libm::exp2(90.0 - f64::from(power));
        positions.extend([(0.0, 0.0), (x, 0.0), (0.0, x)].map(|(y, z)| DVec3::new(x, y, z)));
    }
    let triangles: Vec<[u32; 3]> = (0..180)
        .map(|at| [3 * at, 3 * at + 1, 3 * at + 2])
        .collect();
    let bvh = bvh(positions, &triangles);
    let origin = DVec3::new(1e28, 1e-3, 1e-3);
    let direction = DVec3::NEG_X;
    let rays = [Ray { origin, direction }].into_iter();
    assert!(compare(&bvh, rays) > 0, "the ray meets a triangle");
}

#[test]
fn closed_mesh_lets_no_ray_through_its_edges_and_vertices() {
    let corners = [
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        -DVec3::X,
        -DVec3::Y,
        -DVec3::Z,
    ];
    let triangles = [
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    let bvh = bvh(corners.to_vec(), &triangles);
    let mut numbers = Numbers(3);
    for index in 0..3000 {
        let triangle = triangles[index % 8].map(|corner| corners[corner as usize]);
        // Target a vertex, the midpoint of an edge, or a random point of an edge, moved inward by more than rounding.
        let part = [0.0, 0.5, numbers.next()][index % 3];
        let target = triangle[0].lerp(triangle[1], part) * (1.0 - 1e-12);
        let origin = numbers.point().normalize() * 5.0;
        let direction = (target - origin).normalize();
        let hit = bvh.first_hit(&Ray { origin, direction }, f64::INFINITY);
        assert!(hit.is_some(), "ray {index} from {origin} to {target}");
    }
}

/// Returns the nearest point among all triangles, by brute force.
fn nearest_of_all(bvh: &Bvh, position: DVec3) -> Option<NearestPoint> {
    let points = (0..bvh.corners.len() as u32).map(|slot| bvh.nearest_of(slot, position));
    points.min_by(|a, b| {
        let by_index = a.face.cmp(&b.face);
        a.distance_sq.total_cmp(&b.distance_sq).then(by_index)
    })
}

#[test]
fn nearest_point_is_that_of_a_search_through_all_faces() {
    let mut numbers = Numbers(4242);
    for bvh in [soup(900), flat_grid(9)] {
        for index in 0..1500 {
            // Positions inside, around and far away, and positions where several faces meet.
            let position = numbers.point() * [0.9, 3.0, 1e4, 0.0][index % 4];
            let position = if index % 3 == 0 {
                position.round()
            } else {
                position
            };
            assert_eq!(
                bvh.nearest_point(position),
                nearest_of_all(&bvh, position),
                "{position}"
            );
        }
    }
}

#[test]
fn nearest_point_of_a_face_is_not_farther_than_any_other() {
    let mut numbers = Numbers(5);
    for _ in 0..300 {
        let corners = [numbers.point(), numbers.point(), numbers.point()];
        let bvh = bvh(corners.to_vec(), &[[0, 1, 2]]);
        let position = numbers.point() * 2.0;
        let point = bvh.nearest_point(position).unwrap();
        for step_b in 0..=12 {
            for step_c in 0..=12 - step_b {
                let [b, c] = [step_b, step_c].map(|step| f64::from(step) / 12.0);
                let other = corners[0] * (1.0 - b - c) + corners[1] * b + corners[2] * c;
                // Tolerance: a few rounding errors of numbers of size 1.
                assert!(
                    point.distance_sq < other.distance_squared(position) + 1e-13,
                    "{corners:?}"
                );
            }
        }
    }
}

#[test]
fn empty_mesh_has_no_hit_and_no_nearest_point() {
    let bvh = bvh(Vec::new(), &[]);
    let (origin, direction) = (DVec3::ZERO, DVec3::X);
    let ray = Ray { origin, direction };
    assert_eq!(bvh.first_hit(&ray, f64::INFINITY), None);
    assert!(!bvh.is_blocked(&ray, f64::INFINITY), "shadows");
    assert_eq!(bvh.nearest_point(origin), None);
    let one = flat_grid(1);
    assert_eq!(one.nearest_point(DVec3::NAN), None, "not a position");
}
