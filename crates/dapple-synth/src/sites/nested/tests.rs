//! Tests of nested points: evenly spaced on every level, with the same bits on every machine.

use super::{morton, nested_points};
use crate::shapes::{geodesic_sphere, plane, real, scraps, torus};
use crate::sites::share::Pieces;
use crate::{Hierarchy, HierarchyOptions, Sites, SynthErrorKind, evenness};
use dapple_hash::Seed;
use dapple_mesh::{Mesh, Surface};
use glam::DVec3;
use proptest::prelude::*;

const ITERATIONS: usize = 6;

fn assert_even(surface: &Surface, counts: &[usize], seed: u64) {
    let points = nested_points(surface, counts, Seed(seed), ITERATIONS);
    assert_eq!(points.len(), counts[counts.len() - 1]);
    let sites = Sites::new(surface, points);
    for &count in counts {
        let even = evenness(surface, &sites, count);
        // The required minimum; measured values are 0.92 and 0.6.
        assert!(
            even.mean >= 0.88 && even.min >= 0.5,
            "{count} points, seed {seed}: {even:?}"
        );
    }
}

#[test]
fn every_level_is_even_on_simple_surfaces() {
    for surface in [geodesic_sphere(3), torus(48, 24), plane()] {
        for seed in 0..3 {
            assert_even(&surface, &[750, 3000, 12_000], seed);
        }
    }
}

#[test]
fn every_level_is_even_on_a_real_model() {
    if let Some(mesh) = real("spot.obj") {
        let surface = Surface::new(mesh).unwrap();
        assert_even(&surface, &[16_384, 65_536, 262_144], 1);
    }
}

#[test]
fn fewer_levels_are_the_beginning_of_more() {
    let surface = torus(48, 24);
    let three = nested_points(&surface, &[100, 400, 1600], Seed(3), ITERATIONS);
    let two = nested_points(&surface, &[100, 400], Seed(3), ITERATIONS);
    assert_eq!(three[..400], two[..]);
}

#[test]
fn new_points_of_a_level_are_in_mortons_order() {
    let surface = geodesic_sphere(3);
    let points = nested_points(&surface, &[500, 2000], Seed(5), ITERATIONS);
    let positions: Vec<DVec3> = points
        .iter()
        .map(|&point| surface.position(point))
        .collect();
    for level in [&positions[..500], &positions[500..]] {
        let low = level.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = level.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let scale = f64::from((1 << 21) - 1) / (high - low).max_element();
        assert!(
            level.is_sorted_by_key(|&position| morton((position - low) * scale)),
            "they are not sorted"
        );
    }
}

#[test]
fn morton_takes_bits_in_turn() {
    assert_eq!(morton(DVec3::new(1.0, 0.0, 0.0)), 0b001);
    assert_eq!(morton(DVec3::new(2.0, 1.0, 3.0)), 0b101_110);
    assert_eq!(morton(DVec3::splat(2_097_151.0)), (1 << 63) - 1);
}

#[test]
fn pieces_get_their_shares_on_every_level() {
    let surface = scraps(12);
    let pieces = Pieces::new(&surface);
    let points = nested_points(&surface, &[3, 12, 48, 191], Seed(7), ITERATIONS);
    for count in [3, 12, 48, 191] {
        let mut counts = vec![0; 12];
        for point in &points[..count] {
            counts[point.face.index()] += 1;
        }
        assert_eq!(counts, pieces.shares(count), "{count} points");
    }
}

#[test]
fn few_points_are_as_many_as_asked_for() {
    for surface in [geodesic_sphere(3), plane(), scraps(1), scraps(30)] {
        for n in 1..=10_usize {
            let points = nested_points(&surface, &[n.div_ceil(4), n], Seed(9), ITERATIONS);
            assert_eq!(points.len(), n);
            assert!(
                points.iter().all(|point| point.flat.is_finite()),
                "{points:?}"
            );
        }
    }
}

#[test]
fn strange_counts_give_no_surprises() {
    let surface = torus(48, 24);
    let lengths = |counts: &[usize]| nested_points(&surface, counts, Seed(1), 2).len();
    assert_eq!(lengths(&[]), 0);
    assert_eq!(lengths(&[0]), 0);
    assert_eq!(lengths(&[0, 0, 5]), 5);
    assert_eq!(lengths(&[300, 200]), 300);
    assert_eq!(lengths(&[10, 3000]), 3000);
    assert_eq!(nested_points(&surface, &[20, 80], Seed(1), 0).len(), 80);
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let surface = torus(48, 24);
    let points = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| nested_points(&surface, &[1500, 6000], Seed(11), ITERATIONS))
    };
    let one = points(1);
    assert_eq!(one, points(2));
    assert_eq!(one, points(7));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn soups_of_triangles_get_all_their_points(
        corners in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64), 3..40),
        picks in prop::collection::vec((0..40_usize, 0..40_usize, 0..40_usize), 1..40),
        n in 1..400_usize,
    ) {
        let positions: Vec<DVec3> = corners.iter().map(|&(x, y, z)| DVec3::new(x, y, z)).collect();
        let count = positions.len();
        let faces: Vec<[u32; 3]> = picks.iter().map(|&(a, b, c)| [a, b, c].map(|v| (v % count) as u32)).collect();
        let Ok(surface) = Surface::new(Mesh::new(positions, &faces).unwrap()) else {
            return Ok(());
        };
        let points = nested_points(&surface, &[n.div_ceil(4), n], Seed(1), 3);
        prop_assert_eq!(points.len(), n);
        prop_assert!(points.iter().all(|point| point.flat.is_finite()));
    }
}

#[test]
fn hierarchies_refuse_counts_out_of_range() {
    let surface = geodesic_sphere(3);
    let refused = |options: HierarchyOptions| match Hierarchy::new(&surface, &options) {
        Err(error) => match error.kind() {
            SynthErrorKind::Count { what, .. } => *what,
            kind => panic!("{kind:?}"),
        },
        Ok(_) => "nothing",
    };
    let options = HierarchyOptions {
        n_sites: 50,
        ..HierarchyOptions::default()
    };
    assert_eq!(refused(options.clone()), "nothing");
    for n_sites in [0, (1 << 28) + 1, usize::MAX] {
        assert_eq!(
            refused(HierarchyOptions {
                n_sites,
                ..options.clone()
            }),
            "sites"
        );
    }
    for n_levels in [0, 17, usize::MAX] {
        assert_eq!(
            refused(HierarchyOptions {
                n_levels,
                ..options.clone()
            }),
            "levels"
        );
    }
    assert_eq!(
        refused(HierarchyOptions {
            iterations: 10_001,
            ..options.clone()
        }),
        "iterations"
    );
    assert_eq!(
        refused(HierarchyOptions {
            n_levels: 16,
            ..options
        }),
        "nothing"
    );
}

#[test]
fn value_stability_nested_points() {
    let torus = torus(48, 24);
    let points = nested_points(&torus, &[500, 2000], Seed(1), ITERATIONS);
    let positions =
        [points[0], points[499], points[1999]].map(|point| torus.position(point).to_array());
    assert_eq!(positions, PINNED);
}

const PINNED: [[f64; 3]; 3] = [
    [
        -0.8365437614391107,
        -1.053300301706996,
        -0.20005572755235349,
    ],
    [0.8771875997122826, 0.7929306978865193, 0.352682612766732],
    [0.7539264653892169, 0.9757261849188711, 0.32083615184607933],
];
