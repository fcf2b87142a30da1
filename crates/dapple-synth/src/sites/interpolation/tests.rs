//! Tests of interpolation against sums over all sites.

use super::*;
use crate::shapes::{even_sites, geodesic_sphere, sheets, spacing};
use crate::{SiteGrid, Sites};
use dapple_mesh::Surface;

/// Calls `check` with about `n_sites` evenly spaced sites of a surface.
fn with_sites(surface: &Surface, n_sites: usize, check: impl Fn(&Oriented<'_>)) {
    let sites: Sites = even_sites(surface, n_sites, 11);
    let spacing = spacing(surface, n_sites);
    let grid = SiteGrid::new(sites.positions(), 2.0 * spacing);
    check(&Oriented {
        positions: sites.positions(),
        normals: sites.normals(),
        grid: &grid,
        spacing,
    });
}

/// Evaluates equation 1, summed over all sites.
fn naive(sites: &Oriented<'_>, column: &[f64], position: DVec3, normal: DVec3) -> Option<f64> {
    let near = |&site: &usize| sites.normals[site].dot(normal) >= 0.0;
    let x = |site: usize| sites.positions[site].distance(position) / (1.1 * sites.spacing);
    let weight = |site: usize| {
        let x = x(site).min(1.0);
        2.0 * x * x * x - 3.0 * x * x + 1.0
    };
    let all = || (0..column.len()).filter(near);
    let weights: f64 = all().map(weight).sum();
    if weights > 1e-9 {
        return Some(all().map(|site| weight(site) * column[site]).sum::<f64>() / weights);
    }
    let nearest = all().min_by(|&a, &b| x(a).total_cmp(&x(b)))?;
    (x(nearest) <= 8.0).then(|| column[nearest])
}

#[test]
fn interpolation_equals_the_naive_sum() {
    let surface = geodesic_sphere(3);
    with_sites(&surface, 500, |sites| {
        let column: Vec<f64> = sites
            .positions
            .iter()
            .map(|at| at.x * 3.0 + at.y * at.z)
            .collect();
        for (at, normal) in surface
            .mesh()
            .positions()
            .iter()
            .zip(surface.mesh().vertex_normals())
        {
            // On the surface, then where only the nearest site counts, then where no site is in reach.
            for scale in [1.0, 1.5, 4.0] {
                let position = *at * scale;
                let value = sites.interpolate(&column, position, normal);
                let expected = naive(sites, &column, position, normal);
                assert_eq!(value.is_some(), expected.is_some(), "at {position}");
                let difference = value.unwrap_or(0.0) - expected.unwrap_or(0.0);
                // Tolerance: the orders of summation differ, for values up to 4; tiny weights lose more digits.
                assert!(
                    difference.abs() < 1e-9,
                    "at {position}: {value:?}, not {expected:?}"
                );
            }
        }
    });
}

#[test]
fn interpolation_of_a_constant_is_the_constant() {
    let surface = geodesic_sphere(3);
    with_sites(&surface, 300, |sites| {
        let column = vec![[0.1_f32, 0.7, 0.3]; sites.positions.len()];
        for at in surface.mesh().positions() {
            let value = sites.interpolate(&column, *at, *at);
            assert_eq!(value, Some([0.1, 0.7, 0.3]), "at {at}");
        }
    });
}

#[test]
fn interpolation_stays_in_the_range_of_the_sites_in_reach() {
    let surface = geodesic_sphere(3);
    with_sites(&surface, 300, |sites| {
        let column: Vec<f64> = (0..sites.positions.len())
            .map(|site| (site * 37 % 101) as f64)
            .collect();
        for at in surface.mesh().positions() {
            let value = sites.interpolate(&column, *at, *at).unwrap();
            let radius = 1.1 * sites.spacing;
            let near: Vec<f64> = column
                .iter()
                .zip(sites.positions)
                .filter(|(_, site)| site.distance(*at) < radius)
                .map(|(value, _)| *value)
                .collect();
            let [low, high] =
                [f64::min, f64::max].map(|pick| near.iter().copied().reduce(pick).unwrap());
            // Tolerance: rounding of a few values up to 100.
            assert!(
                value > low - 1e-12 && value < high + 1e-12,
                "{value} at {at}"
            );
        }
    });
}

#[test]
fn interpolation_of_a_linear_function_is_near_it() {
    let surface = sheets(&[0.0]);
    with_sites(&surface, 900, |sites| {
        let column: Vec<f64> = sites.positions.iter().map(|at| 2.0 * at.x - at.y).collect();
        let slope = 5.0_f64.sqrt();
        let (mut sum, mut count) = (0.0, 0);
        for step in 0..1600 {
            let at = DVec3::new(
                f64::from(step % 40) / 39.0,
                f64::from(step / 40) / 39.0,
                0.0,
            );
            let error =
                (sites.interpolate(&column, at, DVec3::Z).unwrap() - 2.0 * at.x + at.y).abs();
            // The weighted mean position of sites in a ball is in the ball.
            assert!(error < slope * 1.1 * sites.spacing, "{error} at {at}");
            let inside = at.x.min(at.y).min(1.0 - at.x).min(1.0 - at.y) > 1.1 * sites.spacing;
            if inside {
                // Where a single site counts, it is at most the minimum distance of sites away; otherwise another site
                // would fit there.
                assert!(
                    error < slope * 0.75 * sites.spacing,
                    "{error} inside, at {at}"
                );
                sum += error;
                count += 1;
            }
        }
        assert!(
            sum < 0.15 * slope * sites.spacing * f64::from(count),
            "{sum} is the sum of {count} errors"
        );
    });
}

#[test]
fn interpolation_at_a_site_far_from_others_is_its_value() {
    let surface = sheets(&[0.0]);
    with_sites(&surface, 400, |sites| {
        let column: Vec<f64> = sites.positions.iter().map(|at| at.x).collect();
        // At a position off the surface only the nearest site counts.
        let at = sites.positions[17] + DVec3::Z * (1.2 * sites.spacing);
        assert_eq!(
            sites.interpolate(&column, at, DVec3::Z),
            Some(column[17]),
            "the nearest one"
        );
        assert_eq!(
            sites.interpolate(&column, at + DVec3::Z, DVec3::Z),
            None,
            "too far away"
        );
        assert_eq!(
            sites.interpolate(&column, at, -DVec3::Z),
            None,
            "the other side"
        );
        assert_eq!(
            sites.interpolate(&column, DVec3::NAN, DVec3::Z),
            None,
            "nowhere"
        );
        assert_eq!(
            sites.nearest_of_all(at + DVec3::Z),
            Some(SiteIdx(17)),
            "whatever the distance"
        );
    });
}

#[test]
fn interpolation_keeps_to_its_sheet() {
    let surface = sheets(&[0.0, 0.001]);
    with_sites(&surface, 400, |sites| {
        let column: Vec<f64> = sites.positions.iter().map(|at| at.z).collect();
        for (at, normal) in sites.positions.iter().zip(sites.normals) {
            assert_eq!(
                sites.interpolate(&column, *at, *normal),
                Some(at.z),
                "at {at}"
            );
        }
    });
}

#[test]
fn value_stability_interpolation() {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.1],
        [0.0, 0.9, 0.0],
        [0.8, 0.7, 0.2],
    ]
    .map(DVec3::from);
    let grid = SiteGrid::new(&positions, 2.0);
    let sites = Oriented {
        positions: &positions,
        normals: &[DVec3::Z; 4],
        grid: &grid,
        spacing: 1.0,
    };
    let value = sites.interpolate(&[1.0, 2.0, 4.0, 8.0], DVec3::new(0.3, 0.4, 0.1), DVec3::Z);
    assert_eq!(value, Some(3.850_344_871_780_867));
}
