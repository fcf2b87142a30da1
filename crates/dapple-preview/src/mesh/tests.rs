//! The hierarchy against a search through all triangles, and what a mesh refuses.

use super::{Mesh, MeshHit};
use crate::PreviewErrorKind;
use crate::ray::Ray;
use glam::DVec3;

/// Numbers from 0 to 1: the high bits of a multiplicative congruential generator by L'Ecuyer, Mathematics of Computation
/// 68, 1999.
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

/// Small triangles everywhere, every seventh twice and every ninth without an area.
fn soup(count: u32) -> Mesh {
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
    Mesh::smooth(&positions, &triangles).unwrap()
}

/// A square of `side × side` squares in the plane `y = 0`, from the origin.
fn flat_grid(side: u32) -> Mesh {
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
    Mesh::smooth(&positions, &triangles).unwrap()
}

/// The oracle: the nearest of all triangles, of several at one distance the one with the lowest index.
fn nearest_of_all(mesh: &Mesh, ray: &Ray, limit: f64) -> Option<MeshHit> {
    let (ray, shift) = mesh.near_ray(ray);
    let probe = super::Probe::new(&ray);
    let slots = 0..mesh.triangles.len() as u32;
    let hits = slots.filter_map(|slot| mesh.meet(&probe, shift, slot));
    let hits = hits.filter(|hit| hit.distance <= limit);
    hits.min_by(|a, b| {
        let by_index = a.triangle.cmp(&b.triangle);
        a.distance.total_cmp(&b.distance).then(by_index)
    })
}

/// Compares the hierarchy and the oracle, and says how many rays had a hit.
fn compare(mesh: &Mesh, rays: impl Iterator<Item = Ray>) -> u32 {
    let mut found = 0;
    for (index, ray) in rays.enumerate() {
        for limit in [f64::INFINITY, 1.5] {
            let hit = mesh.nearest(&ray, limit);
            let expected = nearest_of_all(mesh, &ray, limit);
            assert_eq!(hit, expected, "ray {index} up to {limit}");
            let before = expected.is_some_and(|hit| hit.distance < limit);
            assert_eq!(mesh.blocks(&ray, limit), before, "ray {index} to {limit}");
            found += u32::from(hit.is_some());
        }
    }
    found
}

#[test]
fn bvh_finds_what_a_search_through_all_triangles_finds() {
    let mesh = soup(1200);
    let mut numbers = Numbers(777);
    let rays = (0..4000).map(|index| {
        // From inside, from around, and from far away.
        let origin = numbers.point() * [0.9, 3.0, 1e4][index % 3];
        let direction = (numbers.point() - origin).normalize();
        Ray { origin, direction }
    });
    let found = compare(&mesh, rays);
    assert!((1000..7000).contains(&found), "{found} hits");
}

#[test]
fn bvh_finds_the_lowest_index_along_the_axes_and_edges_of_a_grid() {
    let mesh = flat_grid(12);
    let mut numbers = Numbers(99);
    let rays = (0..600).map(|index| {
        // Many go exactly through vertices and edges, where up to six triangles are at one distance.
        let place = ((numbers.point() + 1.0) * 12.0).floor() * 0.5;
        let axis = [DVec3::NEG_Y, DVec3::X, DVec3::new(0.6, -0.8, 0.0)][index % 3];
        let origin = DVec3::new(place.x, if index % 3 == 1 { 0.0 } else { 1.0 }, place.z);
        let direction = axis;
        Ray { origin, direction }
    });
    let found = compare(&mesh, rays);
    assert!(found > 300, "{found} hits");
}

#[test]
fn bvh_holds_triangles_that_cannot_be_told_apart() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let mesh = Mesh::smooth(&positions, &[[0, 1, 2]; 100]).unwrap();
    let (origin, direction) = (DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    let hit = mesh
        .nearest(&Ray { origin, direction }, f64::INFINITY)
        .unwrap();
    assert_eq!((hit.triangle, hit.distance), (0, 1.0));
}

#[test]
fn bvh_has_a_bounded_depth_when_every_triangle_is_half_as_far() {
    // Bins along an axis hold one or two of these at a time, so that an unbounded tree would be a list.
    let mut positions = Vec::new();
    for power in 0..180 {
        let x = libm::exp2(90.0 - f64::from(power));
        positions.extend([(0.0, 0.0), (x, 0.0), (0.0, x)].map(|(y, z)| DVec3::new(x, y, z)));
    }
    let triangles: Vec<[u32; 3]> = (0..180)
        .map(|at| [3 * at, 3 * at + 1, 3 * at + 2])
        .collect();
    let mesh = Mesh::flat(&positions, &triangles).unwrap();
    let origin = DVec3::new(1e28, 1e-3, 1e-3);
    let direction = DVec3::NEG_X;
    let rays = [Ray { origin, direction }].into_iter();
    assert!(compare(&mesh, rays) > 0, "the ray meets a triangle");
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
    let mesh = Mesh::smooth(&corners, &triangles).unwrap();
    let mut numbers = Numbers(3);
    for index in 0..3000 {
        let triangle = triangles[index % 8].map(|corner| corners[corner as usize]);
        // A vertex, a middle of an edge, or any place of an edge, moved inward by more than rounding.
        let part = [0.0, 0.5, numbers.next()][index % 3];
        let target = triangle[0].lerp(triangle[1], part) * (1.0 - 1e-12);
        let origin = numbers.point().normalize() * 5.0;
        let direction = (target - origin).normalize();
        let hit = mesh.nearest(&Ray { origin, direction }, f64::INFINITY);
        assert!(hit.is_some(), "ray {index} from {origin} to {target}");
    }
}

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
    assert_eq!(mesh.nearest(&ray, f64::INFINITY), None);
    assert!(!mesh.blocks(&ray, f64::INFINITY), "shadows");
}

#[test]
fn bad_meshes_are_refused() {
    let kind = |positions: &[DVec3], triangles: &[[u32; 3]]| {
        let error = Mesh::smooth(positions, triangles).unwrap_err();
        (error.kind().clone(), error.to_string())
    };
    let (error, text) = kind(&[DVec3::ZERO; 3], &[[0, 1, 2], [0, 3, 1]]);
    let expected = PreviewErrorKind::Corner {
        triangle: 1,
        vertex: 3,
        count: 3,
    };
    assert_eq!(error, expected);
    assert_eq!(
        text,
        "triangle 1 asks for vertex 3, but there are 3 vertices"
    );
    let (error, _) = kind(&[DVec3::new(0.0, f64::NAN, 0.0)], &[]);
    assert!(matches!(error, PreviewErrorKind::Range { .. }), "{error:?}");
}
