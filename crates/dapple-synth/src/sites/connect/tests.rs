//! Tests of site graphs, against a triangulation of the plane.

use super::*;
use crate::shapes::{even_sites, geodesic_sphere, random_sites, sheets, spacing, torus};
use dapple_hash::{Seed, hash1, unit_f64};

fn connect(sites: &crate::Sites, spacing: f64) -> Connected {
    Connected::new(sites.positions(), sites.normals(), spacing).unwrap()
}

#[test]
fn graph_of_a_sphere_is_nearly_a_triangulation() {
    let surface = geodesic_sphere(3);
    let sites = even_sites(&surface, 1000, 1);
    let connected = connect(&sites, spacing(&surface, 1000));
    // Euler: a triangulated sphere has 3 n - 6 edges. One-sided edges are few: our measurements found up to 1.2 % at
    // 1000 sites.
    let expected = 3 * sites.len() - 6;
    let edges = connected.graph.n_edges();
    assert!(
        edges.abs_diff(expected) <= expected / 50,
        "{edges} edges instead of {expected}"
    );
    assert!(
        connected.one_sided <= expected / 50,
        "{} edges are one-sided",
        connected.one_sided
    );
}

#[test]
fn graph_is_symmetric_and_one_sided_edges_are_counted() {
    let surface = torus(24, 12);
    let sites = random_sites(&surface, 500, 4);
    let spacing = spacing(&surface, 500);
    let grid = SiteGrid::new(sites.positions(), 2.0 * spacing);
    let oriented = Oriented {
        positions: sites.positions(),
        normals: sites.normals(),
        grid: &grid,
        spacing,
    };
    let stars = Stars::new(&oriented);
    let has = |from: SiteIdx, to: SiteIdx| stars.star(from).iter().any(|spoke| spoke.to == to);
    let mut edges = Vec::new();
    let mut one_sided = 0;
    for a in sites.iter() {
        for b in sites.iter().skip(a.index() + 1) {
            match [has(a, b), has(b, a)] {
                [false, false] => continue,
                [true, true] => {}
                _ => one_sided += 1,
            }
            edges.push([b, a]);
        }
    }
    assert!(one_sided > 0, "the test needs stars that disagree");
    let connected = stars.union();
    assert_eq!(connected.one_sided, one_sided, "edges of one star only");
    assert_eq!(
        connected.graph,
        SiteGraph::from_edges(500, edges),
        "the union of all stars"
    );
    assert_eq!(connected, connect(&sites, spacing), "the public door");
}

#[test]
fn pieces_are_not_connected() {
    let surface = sheets(&[0.0, 5.0, 10.0]);
    let sites = even_sites(&surface, 300, 5);
    let graph = connect(&sites, spacing(&surface, 300)).graph;
    for site in sites.iter() {
        assert!(
            !graph.neighbors(site).is_empty(),
            "site {} is alone",
            site.0
        );
        for to in graph.neighbors(site) {
            let heights = [site, *to].map(|site| sites.positions()[site.index()].z);
            assert!(
                heights[0] == heights[1],
                "sites {} and {} are on two pieces",
                site.0,
                to.0
            );
        }
    }
}

#[test]
fn grid_has_no_diagonals() {
    let positions: Vec<DVec3> = (0..12 * 12)
        .map(|site| DVec3::new(f64::from(site % 12), f64::from(site / 12), 0.0))
        .collect();
    let connected = Connected::new(&positions, &vec![DVec3::Z; 144], 1.0).unwrap();
    assert_eq!(
        connected.graph.n_edges(),
        2 * 12 * 11,
        "rows and columns only"
    );
    assert_eq!(connected.one_sided, 0, "all agree");
}

#[test]
fn connected_has_the_same_bits_at_any_number_of_threads() {
    let surface = geodesic_sphere(3);
    let sites = random_sites(&surface, 3000, 6);
    let spacing = spacing(&surface, 3000);
    let expected = connect(&sites, spacing);
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let connected = pool.install(|| connect(&sites, spacing));
        assert!(connected == expected, "{threads} threads");
    }
}

#[test]
fn few_sites_at_odd_places_are_connected_without_panic() {
    let none = Connected::new(&[], &[], 1.0).unwrap();
    assert_eq!(none.graph.len(), 0, "nothing to connect");
    for spacing in [1e-300, 1e-9, 1.0, 1e30, 1e300] {
        for scale in [0.0, 1e-320, 1e-30, 1.0, 1e30] {
            let positions: Vec<DVec3> = [
                [0, 0, 0],
                [1, 0, 0],
                [2, 0, 0],
                [1, 0, 0],
                [0, 1, 1],
                [0, 0, 3],
            ]
            .map(|[x, y, z]: [i32; 3]| DVec3::new(x.into(), y.into(), z.into()) * scale)
            .to_vec();
            for normal in [DVec3::ZERO, DVec3::Z, DVec3::NAN] {
                let connected = Connected::new(&positions, &[normal; 6], spacing).unwrap();
                assert_eq!(connected.graph.len(), 6, "spacing {spacing}, scale {scale}");
            }
        }
    }
}

#[test]
fn connected_refuses_bad_columns_and_spacings() {
    let refused = |normals: usize, spacing: f64| {
        let error =
            Connected::new(&[DVec3::ZERO; 2], &vec![DVec3::Z; normals], spacing).unwrap_err();
        error.kind().clone()
    };
    assert!(
        matches!(refused(3, 1.0), SynthErrorKind::Count { count: 3, .. }),
        "three normals"
    );
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(refused(2, spacing), SynthErrorKind::Range { .. }),
            "spacing {spacing}"
        );
    }
}

#[test]
fn value_stability_connected() {
    let positions: Vec<DVec3> = (0..500)
        .map(|site| {
            let part = |counter| unit_f64(hash1(Seed(7), [site], counter)) - 0.5;
            DVec3::new(part(0), part(1), part(2)).normalize()
        })
        .collect();
    // The spacing of 500 evenly spaced sites on a sphere of radius 1.
    let connected = Connected::new(&positions, &positions, 0.1704).unwrap();
    let ends = |site: u32| {
        connected
            .graph
            .neighbors(SiteIdx(site))
            .iter()
            .map(move |to| site * to.0)
    };
    let sum: u32 = (0..500).flat_map(ends).sum();
    assert_eq!(
        (connected.graph.n_edges(), connected.one_sided, sum),
        (1500, 3, 185_610_018)
    );
}
