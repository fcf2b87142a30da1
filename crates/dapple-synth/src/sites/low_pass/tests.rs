//! Tests of the low-pass filter against dense sums, and of its invariants.

use super::*;
use crate::Connected;
use crate::shapes::{even_sites, geodesic_sphere, spacing};
use dapple_hash::{Seed, hash1, unit_f64};

/// Returns evenly spaced sites on a sphere, and their graph.
fn even(n_sites: usize) -> (Vec<DVec3>, SiteGraph) {
    let surface = geodesic_sphere(3);
    let sites = even_sites(&surface, n_sites, 21);
    let spacing = spacing(&surface, n_sites);
    let connected = Connected::new(sites.positions(), sites.normals(), spacing).unwrap();
    (sites.positions().to_vec(), connected.graph)
}

/// Returns a hexagonal lattice of spacing 1, its graph, and its central site.
fn hexagonal(half: i32) -> (Vec<DVec3>, SiteGraph, usize) {
    let side = 2 * half + 1;
    let height = 0.75_f64.sqrt();
    let positions: Vec<DVec3> = (0..side * side)
        .map(|site| {
            let (column, row) = (site % side - half, site / side - half);
            let shift = 0.5 * f64::from(row.rem_euclid(2));
            DVec3::new(f64::from(column) + shift, f64::from(row) * height, 0.0)
        })
        .collect();
    let graph = Connected::new(&positions, &vec![DVec3::Z; positions.len()], 1.0)
        .unwrap()
        .graph;
    (positions, graph, (side * side / 2) as usize)
}

fn noise(n: usize) -> Vec<f64> {
    (0..n as i64)
        .map(|site| unit_f64(hash1(Seed(5), [site], 0)))
        .collect()
}

#[test]
fn step_equals_equation_3() {
    let (positions, graph) = even(400);
    let column = noise(positions.len());
    let mut filtered = column.clone();
    LowPass::new(&graph, &positions)
        .unwrap()
        .apply(&mut filtered, 0.3, 1)
        .unwrap();
    for site in 0..positions.len() {
        let neighbors = graph.neighbors(SiteIdx(site as u32));
        let inverse = |to: &SiteIdx| 1.0 / positions[site].distance(positions[to.index()]);
        let sum: f64 = neighbors.iter().map(inverse).sum();
        let mean: f64 = neighbors
            .iter()
            .map(|to| inverse(to) * column[to.index()])
            .sum::<f64>()
            / sum;
        let expected = 0.7 * column[site] + 0.3 * mean;
        // Tolerance: rounding of values below 1.
        assert!((filtered[site] - expected).abs() < 1e-14, "site {site}");
    }
}

#[test]
fn constant_column_does_not_change() {
    let (positions, graph) = even(400);
    let filter = LowPass::new(&graph, &positions).unwrap();
    let mut column = vec![[0.1_f32, 1e30, -7.3]; positions.len()];
    filter.apply(&mut column, 0.37, 30).unwrap();
    assert!(
        column.iter().all(|value| *value == [0.1, 1e30, -7.3]),
        "a value changed"
    );
}

#[test]
fn values_stay_in_the_range_of_the_neighbors() {
    let (positions, graph) = even(400);
    let filter = LowPass::new(&graph, &positions).unwrap();
    for t in [1e-3, 0.1, 0.99] {
        // Few distinct values, so that bounds are reached exactly.
        let mut column: Vec<f32> = noise(positions.len())
            .iter()
            .map(|value| (value * 3.0).floor() as f32 / 3.0)
            .collect();
        for _ in 0..20 {
            let before = column.clone();
            filter.apply(&mut column, t, 1).unwrap();
            for site in 0..column.len() {
                let around = graph
                    .neighbors(SiteIdx(site as u32))
                    .iter()
                    .map(|to| before[to.index()]);
                let low = around.clone().fold(before[site], f32::min);
                let high = around.fold(before[site], f32::max);
                assert!(
                    (low..=high).contains(&column[site]),
                    "site {site} at t = {t}"
                );
            }
        }
        let spread = column.iter().copied().reduce(f32::max).unwrap()
            - column.iter().copied().reduce(f32::min).unwrap();
        assert!(
            t < 0.1 || spread < 0.5,
            "noise is still spread over {spread} of 0.67 at t = {t}"
        );
    }
}

#[test]
fn step_adds_half_t_to_the_variance_in_squared_spacings() {
    let (positions, graph, center) = hexagonal(22);
    let mut column = vec![0.0; positions.len()];
    column[center] = 1.0;
    LowPass::new(&graph, &positions)
        .unwrap()
        .apply(&mut column, 0.1, 20)
        .unwrap();
    let moment = |axis: usize| -> f64 {
        let away = positions
            .iter()
            .map(|at| at[axis] - positions[center][axis]);
        column
            .iter()
            .zip(away)
            .map(|(value, away)| value * away * away)
            .sum()
    };
    for axis in [0, 1] {
        // Twenty steps of variance t / 2: exact on a lattice, except for rounding, which also makes weights differ a
        // little.
        assert!(
            (moment(axis) - 1.0).abs() < 1e-9,
            "axis {axis}: {}",
            moment(axis)
        );
    }
    let mass: f64 = column.iter().sum();
    assert!((mass - 1.0).abs() < 1e-12, "the mass is {mass}");
}

#[test]
fn linear_function_on_a_lattice_does_not_change_inside() {
    let (positions, graph, _) = hexagonal(10);
    let linear = |at: &DVec3| 3.0 * at.x - 2.0 * at.y;
    let mut column: Vec<f64> = positions.iter().map(linear).collect();
    LowPass::new(&graph, &positions)
        .unwrap()
        .apply(&mut column, 0.1, 5)
        .unwrap();
    for (at, value) in positions.iter().zip(&column) {
        // In five steps the effect of the border reaches five sites inward.
        if at.x.abs() < 4.0 && at.y.abs() < 3.5 {
            // Neighbors in opposite directions cancel, up to rounding of values up to 50.
            assert!((value - linear(at)).abs() < 1e-12, "{value} at {at}");
        }
    }
}

#[test]
fn site_without_neighbors_keeps_its_value() {
    let graph = SiteGraph::from_edges(4, [[SiteIdx(0), SiteIdx(2)]]);
    let positions = [DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::Y];
    let filter = LowPass::new(&graph, &positions).unwrap();
    let mut column = [1.0, 2.0, 5.0, 4.0];
    filter.apply(&mut column, 0.25, 1).unwrap();
    // The two connected sites are at the same position.
    assert_eq!(column, [2.0, 2.0, 4.0, 4.0], "only connected sites change");
    assert_eq!(
        filter.weights(SiteIdx(2)),
        [1.0],
        "one neighbor has all of the weight"
    );
}

#[test]
fn low_pass_has_the_same_bits_at_any_number_of_threads() {
    let (positions, graph, _) = hexagonal(40);
    let filtered = || {
        let mut column = noise(positions.len());
        LowPass::new(&graph, &positions)
            .unwrap()
            .apply(&mut column, 0.1, 7)
            .unwrap();
        column
    };
    let expected = filtered();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        assert!(pool.install(filtered) == expected, "{threads} threads");
    }
}

#[test]
fn low_pass_refuses_bad_columns_and_parts() {
    let graph = SiteGraph::from_edges(2, [[SiteIdx(0), SiteIdx(1)]]);
    let kind = |error: SynthError| error.kind().clone();
    let error = LowPass::new(&graph, &[DVec3::ZERO]).unwrap_err();
    assert!(
        matches!(kind(error), SynthErrorKind::Count { count: 1, .. }),
        "one position"
    );
    let filter = LowPass::new(&graph, &[DVec3::ZERO, DVec3::X]).unwrap();
    let error = filter.apply(&mut [0.0; 3], 0.1, 1).unwrap_err();
    assert!(
        matches!(kind(error), SynthErrorKind::Count { count: 3, .. }),
        "three values"
    );
    let error = filter.step(&[0.0; 2], &mut [0.0; 1], 0.1).unwrap_err();
    assert!(
        matches!(kind(error), SynthErrorKind::Count { count: 1, .. }),
        "one new value"
    );
    for t in [-0.1, 1.1, f64::NAN] {
        let error = filter.apply(&mut [0.0; 2], t, 1).unwrap_err();
        assert!(
            matches!(kind(error), SynthErrorKind::Range { .. }),
            "t = {t}"
        );
    }
    let empty = SiteGraph::from_edges(0, []);
    LowPass::new(&empty, &[])
        .unwrap()
        .apply::<f64>(&mut [], 0.1, 3)
        .unwrap();
}

#[test]
fn value_stability_low_pass() {
    let (positions, graph, center) = hexagonal(3);
    let mut column = noise(positions.len());
    LowPass::new(&graph, &positions)
        .unwrap()
        .apply(&mut column, 0.1, 20)
        .unwrap();
    assert_eq!(column[center], 0.304_276_804_067_511_73);
}
