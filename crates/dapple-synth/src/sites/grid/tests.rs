//! Tests of the grid against a search through all sites.

use super::{BRICKS_LEAST, SITES_PER_BRICK, SiteGrid};
use crate::SiteIdx;
use dapple_hash::{Seed, hash1, unit_f64};
use glam::DVec3;
use proptest::prelude::*;

fn random(n: i64, seed: u64) -> Vec<DVec3> {
    let part = |site, axis| unit_f64(hash1(Seed(seed), [site], axis));
    (0..n)
        .map(|site| DVec3::new(part(site, 0), part(site, 1), part(site, 2)))
        .collect()
}

fn visited(grid: &SiteGrid, center: DVec3, radius: f64) -> Vec<u32> {
    let mut sites = Vec::new();
    grid.visit(center, radius, |SiteIdx(site)| sites.push(site));
    sites
}

/// Returns the visited sites that are in the ball, in ascending order.
fn in_ball(grid: &SiteGrid, positions: &[DVec3], center: DVec3, radius: f64) -> Vec<u32> {
    let mut sites = visited(grid, center, radius);
    sites.retain(|&site| positions[site as usize].distance(center) < radius);
    sites.sort_unstable();
    sites
}

fn brute_force(positions: &[DVec3], center: DVec3, radius: f64) -> Vec<u32> {
    (0..)
        .zip(positions)
        .filter(|(_, position)| position.distance(center) < radius)
        .map(|(site, _)| site)
        .collect()
}

proptest! {
    #[test]
    fn visit_finds_what_brute_force_finds(
        n in 0..400_i64, side in 0.001..2.0_f64, radius in 0.0..1.5_f64,
        x in -0.5..1.5_f64, y in -0.5..1.5_f64, z in -0.5..1.5_f64,
    ) {
        let positions = random(n, 3);
        let grid = SiteGrid::new(&positions, side);
        let center = DVec3::new(x, y, z);
        prop_assert_eq!(in_ball(&grid, &positions, center, radius), brute_force(&positions, center, radius));
    }

    #[test]
    fn any_numbers_are_survived(side: f64, radius: f64, x: f64, y: f64, z: f64, at: f64) {
        let grid = SiteGrid::new(&[DVec3::new(x, y, z), DVec3::new(y, at, x)], side);
        let mut sites = visited(&grid, DVec3::new(at, x, y), radius);
        sites.sort_unstable();
        sites.dedup();
        prop_assert!(sites.len() <= 2);
    }
}

#[test]
fn sites_are_visited_once_in_a_ball_of_any_size() {
    let positions = random(1000, 5);
    let grid = SiteGrid::new(&positions, 0.03);
    for radius in [10.0, 1e300, f64::INFINITY] {
        let mut sites = visited(&grid, positions[0], radius);
        assert_eq!(sites.len(), 1000, "radius {radius}");
        sites.sort_unstable();
        sites.dedup();
        assert_eq!(sites.len(), 1000, "radius {radius}");
    }
}

#[test]
fn nothing_is_visited_in_a_ball_of_negative_radius() {
    let grid = SiteGrid::new(&random(100, 5), 0.03);
    assert!(
        visited(&grid, DVec3::splat(0.5), -1.0).is_empty(),
        "there is nothing in such a ball"
    );
}

#[test]
fn order_depends_on_positions_and_not_on_numbers() {
    // The largest radius covers the whole grid and scans all bricks; a small one looks bricks up in the table.
    let positions = random(500, 7);
    let turned: Vec<DVec3> = positions.iter().rev().copied().collect();
    let [grid, other] = [&positions, &turned].map(|positions| SiteGrid::new(positions, 0.02));
    for radius in [0.1, 0.3, 2.0] {
        let cells = |grid: &SiteGrid, positions: &[DVec3]| -> Vec<[u32; 3]> {
            visited(grid, DVec3::splat(0.4), radius)
                .into_iter()
                .map(|site| grid.cell(positions[site as usize]))
                .collect()
        };
        assert_eq!(
            cells(&grid, &positions),
            cells(&other, &turned),
            "radius {radius}"
        );
    }
}

#[test]
fn order_is_the_same_through_the_table_and_through_all_bricks() {
    let positions = random(3000, 9);
    let grid = SiteGrid::new(&positions, 0.02);
    let [low, high] = [0.3, 0.6].map(|part| grid.cell(DVec3::splat(part)));
    let mut all = Vec::new();
    grid.visit_all(low, high, |row| {
        all.extend(grid.members[row].iter().map(|site| site.0));
    });
    let ball = visited(&grid, DVec3::splat(0.45), 0.15);
    assert!(ball.len() > 20, "{} sites", ball.len());
    // The ball's box of cells is the same as that of `visit_all`, up to rounding of its ends.
    let inside = |site: &u32| {
        positions[*site as usize].cmpgt(DVec3::splat(0.3)).all()
            && positions[*site as usize].cmplt(DVec3::splat(0.6)).all()
    };
    let [all, ball] = [all, ball].map(|sites| sites.into_iter().filter(inside).collect::<Vec<_>>());
    assert_eq!(all, ball);
}

#[test]
fn memory_is_bounded_for_sparse_sites() {
    let positions: Vec<DVec3> = random(4000, 11)
        .into_iter()
        .map(|position| position * 1e6)
        .collect();
    let grid = SiteGrid::new(&positions, 1e-3);
    assert!(
        grid.bricks.len() <= (4000 / SITES_PER_BRICK).max(BRICKS_LEAST),
        "{} bricks",
        grid.bricks.len()
    );
    let center = positions[17];
    assert_eq!(
        in_ball(&grid, &positions, center, 2e5),
        brute_force(&positions, center, 2e5)
    );
}

#[test]
fn far_clusters_keep_their_small_cells() {
    let mut positions = random(2000, 13);
    positions.extend(random(2000, 14).into_iter().map(|position| position + 1e4));
    let grid = SiteGrid::new(&positions, 0.1);
    let found = visited(&grid, DVec3::splat(0.5), 0.1).len();
    assert!(
        (1..=2000 * 64 / 500).contains(&found),
        "{found} sites visited in cells of a tenth"
    );
}

#[test]
fn value_stability_grid_order() {
    let grid = SiteGrid::new(&random(12, 1), 0.3);
    assert_eq!(visited(&grid, DVec3::splat(0.5), 0.4), ORDER);
}

const ORDER: [u32; 12] = [5, 4, 1, 8, 6, 11, 10, 7, 2, 3, 9, 0];
