//! Tests of the evenness measure on points with known distances.

use super::{evenness, hexagonal_spacing};
use crate::shapes::{plane, scraps, sheet};
use crate::{Sites, scatter};
use dapple_hash::Seed;
use dapple_mesh::Surface;
use glam::DVec3;

#[test]
fn evenness_of_a_hexagonal_lattice_is_one() {
    // 20 by 20 points, one in the middle of each cell of the lattice.
    let height = 0.75_f64.sqrt();
    let patch = sheet([1, 1], [true; 2], |u, v| {
        DVec3::new(u * 20.5, v * 20.0 * height, 0.0)
    });
    let surface = Surface::new(patch).unwrap();
    let mut points = Vec::new();
    for row in 0..20 {
        for column in 0..20 {
            let x = f64::from(column) + 0.25 + 0.5 * f64::from(row % 2);
            let position = DVec3::new(x, (f64::from(row) + 0.5) * height, 0.0);
            let inside = [0, 1].map(|face| surface.project(dapple_mesh::FaceIdx(face), position));
            let point = inside.into_iter().find(|&point| {
                surface
                    .weights(point)
                    .iter()
                    .all(|&weight| weight >= -1e-12)
            });
            points.push(point.unwrap());
        }
    }
    let sites = Sites::new(&surface, points);
    let spacing = hexagonal_spacing(surface.area(), 400);
    let even = evenness(&surface, &sites, 400);
    // The patch is half a cell wider than the lattice.
    assert!((even.mean * spacing - 1.0).abs() < 1e-9, "{even:?}");
    assert!((even.min * spacing - 1.0).abs() < 1e-9, "{even:?}");
    assert!(even.mean > 0.98, "{even:?}");
}

#[test]
fn evenness_of_random_points_is_low() {
    let surface = plane();
    let sites = Sites::new(&surface, scatter(&surface, 20_000, Seed(3)));
    let even = evenness(&surface, &sites, 20_000);
    // Expected: 0.5 over the square root of the density, 0.4653. Borders add a little; the standard error is 0.0017.
    assert!((even.mean - 0.467).abs() < 0.007, "{even:?}");
    assert!(even.min < 0.02, "{even:?}");
}

#[test]
fn evenness_equals_that_of_all_pairs() {
    let surface = plane();
    let sites = Sites::new(&surface, scatter(&surface, 300, Seed(5)));
    let spacing = hexagonal_spacing(surface.area(), 200);
    let nearest = |site: usize| {
        let distance = |other: usize| sites.positions()[site].distance(sites.positions()[other]);
        (0..200)
            .filter(|&other| other != site)
            .map(distance)
            .fold(f64::INFINITY, f64::min)
            / spacing
    };
    let even = evenness(&surface, &sites, 200);
    assert_eq!(
        even.min,
        (0..200).map(nearest).fold(f64::INFINITY, f64::min)
    );
    assert_eq!(even.mean, (0..200).map(nearest).sum::<f64>() / 200.0);
}

#[test]
fn evenness_of_few_sites_is_finite() {
    let surface = scraps(2);
    let sites = Sites::new(&surface, scatter(&surface, 1, Seed(1)));
    assert_eq!(evenness(&surface, &sites, 0).mean, 0.0);
    // A single site has no neighbor within four spacings.
    assert_eq!(evenness(&surface, &sites, 5).mean, 4.0);
    assert_eq!(hexagonal_spacing(1.0, 0), 0.0);
}
