//! Tests of triangle meshes of sites: complete for evenly spaced sites, and with correct counts elsewhere.

use super::*;
use crate::SiteGrid;
use crate::shapes::{even_sites, geodesic_sphere, random_sites, sheets, spacing, torus};
use dapple_hash::{Seed, hash1, unit_f64};

fn triangles(positions: &[DVec3], normals: &[DVec3], spacing: f64) -> SiteTriangles {
    let grid = SiteGrid::new(positions, 2.0 * spacing);
    let grid = &grid;
    SiteTriangles::new(&Oriented {
        positions,
        normals,
        grid,
        spacing,
    })
    .unwrap()
}

/// Returns the number of edges with a single triangle. Asserts that no edge has two triangles on one side.
fn open_edges(mesh: &Mesh) -> usize {
    let mut edges = BTreeSet::new();
    for face in mesh.faces() {
        for at in 0..3 {
            let edge = [face[at].0, face[(at + 1) % 3].0];
            assert!(edge[0] != edge[1], "a triangle has a site twice: {face:?}");
            assert!(
                edges.insert(edge),
                "two triangles are on one side of {edge:?}"
            );
        }
    }
    edges
        .iter()
        .filter(|[a, b]| !edges.contains(&[*b, *a]))
        .count()
}

/// Returns the Euler characteristic: vertices minus edges plus triangles.
fn euler(mesh: &Mesh) -> i64 {
    let n_edges = (3 * mesh.faces().len() + open_edges(mesh)) / 2;
    mesh.positions().len() as i64 - n_edges as i64 + mesh.faces().len() as i64
}

#[test]
fn triangles_close_a_sphere_and_a_torus() {
    for (name, surface, expected) in [
        ("sphere", geodesic_sphere(3), 2),
        ("torus", torus(48, 24), 0),
    ] {
        let sites = even_sites(&surface, 1000, 31);
        let made = triangles(sites.positions(), sites.normals(), spacing(&surface, 1000));
        assert_eq!(
            (made.holes, made.borders),
            (0, 0),
            "{name}: nothing is left open"
        );
        assert_eq!(open_edges(&made.mesh), 0, "{name}: the mesh is closed");
        assert_eq!(euler(&made.mesh), expected, "{name}: Euler's number");
        assert!(
            made.filled * 20 < made.agreed,
            "{name}: {} triangles fill holes",
            made.filled
        );
        for face in made.mesh.faces() {
            let [a, b, c] = face.map(|vertex| made.mesh.positions()[vertex.index()]);
            let up = sites.normals()[face[0].index()];
            assert!(
                (b - a).cross(c - a).dot(up) > 0.0,
                "{name}: a triangle faces inward"
            );
        }
    }
}

#[test]
fn triangles_of_random_sites_have_no_edge_with_three() {
    for (surface, seed) in [
        (geodesic_sphere(3), 1),
        (torus(24, 12), 2),
        (sheets(&[0.0, 0.02]), 3),
    ] {
        let sites = random_sites(&surface, 1000, seed);
        let made = triangles(sites.positions(), sites.normals(), spacing(&surface, 1000));
        open_edges(&made.mesh);
        assert_eq!(
            made.agreed + made.filled,
            made.mesh.faces().len(),
            "the counts add up"
        );
        assert!(
            made.agreed > 1500,
            "only {} triangles are agreed on",
            made.agreed
        );
    }
}

#[test]
fn triangles_of_a_patch_leave_its_border_open() {
    let surface = sheets(&[0.0]);
    let sites = even_sites(&surface, 400, 32);
    let made = triangles(sites.positions(), sites.normals(), spacing(&surface, 400));
    assert_eq!(
        (made.borders, made.holes),
        (1, 0),
        "one loop around the patch"
    );
    assert_eq!(euler(&made.mesh), 1, "a disc");
}

#[test]
fn triangles_of_a_square_grid_are_halves_of_its_squares() {
    // The four corners of each square lie on a circle, so no diagonal is in any star.
    let positions: Vec<DVec3> = (0..100)
        .map(|site| DVec3::new(f64::from(site % 10), f64::from(site / 10), 0.0))
        .collect();
    let made = triangles(&positions, &[DVec3::Z; 100], 1.0);
    assert_eq!(
        (made.agreed, made.filled),
        (0, 2 * 81),
        "two for each square"
    );
    assert_eq!(
        (made.holes, made.borders),
        (0, 1),
        "only the border is open"
    );
}

#[test]
fn few_sites_have_few_triangles() {
    assert_eq!(triangles(&[], &[], 1.0).mesh.faces().len(), 0, "no sites");
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    assert_eq!(
        triangles(&corners[..1], &[DVec3::Z], 1.0).borders,
        0,
        "one site"
    );
    assert_eq!(
        triangles(&corners[..2], &[DVec3::Z; 2], 1.0).borders,
        1,
        "around an edge"
    );
    let made = triangles(&corners, &[DVec3::Z; 3], 1.0);
    assert_eq!(
        (made.agreed, made.borders),
        (1, 1),
        "one triangle, with a border"
    );
}

#[test]
fn value_stability_triangles() {
    let positions: Vec<DVec3> = (0..500)
        .map(|site| {
            let part = |counter| unit_f64(hash1(Seed(7), [site], counter));
            (DVec3::new(part(0), part(1), part(2)) - 0.5).normalize()
        })
        .collect();
    let made = triangles(&positions, &positions, 0.1704);
    let places = (0..).zip(made.mesh.faces());
    let sum: u64 = places
        .map(|(at, [a, b, c])| at * u64::from(a.0 + 2 * b.0 + 3 * c.0))
        .sum();
    assert_eq!(
        (made.agreed, made.filled, made.holes, sum),
        (987, 9, 0, 927_216_095)
    );
}
