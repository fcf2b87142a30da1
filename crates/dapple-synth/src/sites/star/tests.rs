//! Tests of stars against a triangulation by spade.

use super::*;
use crate::shapes::{even_sites, geodesic_sphere, random_sites, sheets, spacing, torus};
use crate::{SiteGrid, Sites};
use dapple_mesh::Surface;
use spade::{DelaunayTriangulation, Point2, Triangulation};

fn stars_equal_spade(surface: &Surface, sites: &Sites, n_sites: usize) -> usize {
    let spacing = spacing(surface, n_sites);
    let grid = SiteGrid::new(sites.positions(), 2.0 * spacing);
    let oriented = Oriented {
        positions: sites.positions(),
        normals: sites.normals(),
        grid: &grid,
        spacing,
    };
    let (mut finder, mut compared) = (StarFinder::default(), 0);
    for center in sites.iter() {
        let mut star = Vec::new();
        finder.find(&oriented, center, &mut star);
        let mut found: Vec<u32> = star.iter().map(|spoke| spoke.to.0).collect();
        found.sort_unstable();
        if let Some(expected) = spade_star(&oriented, center) {
            assert_eq!(found, expected, "site {}", center.0);
            compared += 1;
        }
    }
    compared
}

/// Finds a star by triangulating all sites in reach on the same sheet. `None` if the limit on empty circles could
/// matter.
fn spade_star(sites: &Oriented<'_>, center: SiteIdx) -> Option<Vec<u32>> {
    let tangent = Tangent::new(sites, center);
    let mut triangulation = DelaunayTriangulation::<Point2<f64>>::new();
    let origin = triangulation.insert(Point2::new(0.0, 0.0)).unwrap();
    let mut numbers = vec![center.0];
    for (site, (&position, normal)) in (0..).zip(sites.positions.iter().zip(sites.normals)) {
        let away = position - tangent.position;
        let distance_sq = away.length_squared() * tangent.scale_sq;
        if distance_sq > 0.0 && distance_sq <= 16.0 && normal.dot(tangent.normal) >= 0.0 {
            let at = tangent.map(away, distance_sq).unwrap();
            triangulation.insert(Point2::new(at.x, at.y)).unwrap();
            numbers.push(site);
        }
    }
    let mut star = Vec::new();
    for edge in triangulation.vertex(origin).out_edges() {
        let face = edge.face().as_inner()?;
        let (_, radius_sq) = face.circumcircle();
        if radius_sq > STAR_RADIUS * STAR_RADIUS {
            return None;
        }
        star.push(numbers[edge.to().index()]);
    }
    star.sort_unstable();
    Some(star)
}

#[test]
fn stars_equal_those_of_spade_on_all_surfaces() {
    for (name, surface) in [
        ("sphere", geodesic_sphere(3)),
        ("plane", sheets(&[0.0])),
        ("two sheets", sheets(&[0.0, 0.01])),
        ("torus", torus(24, 12)),
    ] {
        let even = stars_equal_spade(&surface, &even_sites(&surface, 600, 1), 600);
        assert!(even > 400, "{name}: only {even} even stars were compared");
        let random = stars_equal_spade(&surface, &random_sites(&surface, 600, 2), 600);
        assert!(
            random > 300,
            "{name}: only {random} random stars were compared"
        );
    }
}

#[test]
fn star_keeps_to_its_sheet() {
    let surface = sheets(&[0.0, 0.01]);
    let sites = even_sites(&surface, 400, 3);
    let spacing = spacing(&surface, 400);
    let grid = SiteGrid::new(sites.positions(), 2.0 * spacing);
    let oriented = Oriented {
        positions: sites.positions(),
        normals: sites.normals(),
        grid: &grid,
        spacing,
    };
    let mut star = Vec::new();
    for center in sites.iter() {
        star.clear();
        StarFinder::default().find(&oriented, center, &mut star);
        assert!(
            star.len() >= 2,
            "site {} has {} neighbors",
            center.0,
            star.len()
        );
        let height = sites.positions()[center.index()].z;
        for spoke in &star {
            let other = sites.positions()[spoke.to.index()].z;
            assert!(other == height, "site {} reaches the other sheet", center.0);
        }
    }
}

#[test]
fn star_of_a_site_alone_is_empty() {
    let far = 2.0 * STAR_RADIUS * 1.001;
    // One site is too far away, one is straight above, and one is at the same position.
    let positions = [DVec3::ZERO, DVec3::X * far, DVec3::Z, DVec3::ZERO];
    let grid = SiteGrid::new(&positions, 2.0);
    let sites = Oriented {
        positions: &positions,
        normals: &[DVec3::Z; 4],
        grid: &grid,
        spacing: 1.0,
    };
    let mut star = Vec::new();
    StarFinder::default().find(&sites, SiteIdx(0), &mut star);
    assert!(star.is_empty(), "there are neighbors: {star:?}");
}

#[test]
fn star_keeps_the_distance_of_sites_on_a_slope() {
    // In a plain projection, the site on the steep slope would be nearest and hide the site behind it.
    let positions = [
        DVec3::ZERO,
        DVec3::new(0.3, 0.0, 1.4),
        DVec3::new(1.0, 0.0, 0.0),
    ];
    let grid = SiteGrid::new(&positions, 2.0);
    let sites = Oriented {
        positions: &positions,
        normals: &[DVec3::Z; 3],
        grid: &grid,
        spacing: 1.0,
    };
    let mut star = Vec::new();
    StarFinder::default().find(&sites, SiteIdx(0), &mut star);
    let neighbors: Vec<u32> = star.iter().map(|spoke| spoke.to.0).collect();
    assert_eq!(neighbors, [2], "the nearer one in space");
}
