//! Tests of sweep distances on surfaces with known distances.

use super::level::step;
use super::*;
use crate::shapes::{cap, moved, sites_on, sphere, square, tube, two_squares};
use crate::{Direction, HierarchyOptions};
use dapple_hash::Seed;
use dapple_mesh::{Mesh, Surface, rotation};
use glam::DVec3;
use proptest::prelude::*;

fn along(hierarchy: &Hierarchy, vector: DVec3) -> Orientation {
    Orientation::from_fn(hierarchy, |_, _| vector)
}

/// Returns the fraction of the edges of the finest level along which the distance increases in the direction of the
/// field. Edges across the field are not counted.
fn rising_share(hierarchy: &Hierarchy, orientation: &Orientation, sweep: &Sweep) -> f64 {
    let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
    let (mut rising, mut count) = (0, 0);
    for a in hierarchy.sites().iter() {
        for &b in hierarchy.levels()[0].graph().neighbors(a) {
            let (a, b) = (a.index(), b.index());
            let way = positions[b] - positions[a];
            let ahead = step(
                way,
                orientation.vectors()[a] + orientation.vectors()[b],
                normals[a] + normals[b],
            );
            if ahead > 0.2 * way.length() {
                count += 1;
                rising += usize::from(sweep.distances(0)[b] > sweep.distances(0)[a]);
            }
        }
    }
    f64::from(rising as u32) / f64::from(count)
}

/// Returns the standard deviation of the difference of two columns.
fn spread(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let mean = a.iter().zip(b).map(|(a, b)| a - b).sum::<f64>() / n;
    let squares = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a - b - mean) * (a - b - mean));
    (squares.sum::<f64>() / n).sqrt()
}

#[test]
fn sweep_is_the_coordinate_on_a_plane() {
    let vector = DVec3::new(0.6, 0.8, 0.0);
    for n_levels in 1..=4 {
        let hierarchy = sites_on(square(), 3000, n_levels);
        let sweep = Sweep::new(&hierarchy, &along(&hierarchy, vector), None).unwrap();
        let positions = hierarchy.sites().positions();
        for level in 0..n_levels {
            for (site, distance) in sweep.distances(level).iter().enumerate() {
                let wanted = (positions[site] - positions[0]).dot(vector);
                // Tolerance: every Δ is exact, so the error is rounding and its growth in the solver.
                assert!(
                    (distance - wanted).abs() < 1e-9,
                    "level {level} of {n_levels}, site {site}: {distance} instead of {wanted}"
                );
            }
        }
    }
}

#[test]
fn order_rises_along_a_plane_and_has_every_site_once() {
    let hierarchy = sites_on(square(), 2000, 3);
    let sweep = Sweep::new(&hierarchy, &along(&hierarchy, DVec3::NEG_Y), None).unwrap();
    for level in 0..3 {
        let order = sweep.order(level);
        let distance = |site: &SiteIdx| sweep.distances(level)[site.index()];
        assert!(
            order.is_sorted_by(|a, b| distance(a) <= distance(b)),
            "level {level} is not in order"
        );
        let mut sites = order.clone();
        sites.sort();
        let all: Vec<SiteIdx> = (0..hierarchy.levels()[level].n_sites() as u32)
            .map(SiteIdx)
            .collect();
        assert_eq!(sites, all, "level {level}");
    }
}

#[test]
fn order_takes_the_lowest_of_several_at_one_distance() {
    let sweep = Sweep {
        levels: vec![Distances {
            distances: vec![0.0, -0.0, 1.0, -1.0, 0.0, -2.0, 1.0],
            components: vec![0, 0, 0, 0, 0, 1, 0],
        }],
    };
    assert_eq!(sweep.order(0), [3, 0, 1, 4, 2, 6, 5].map(SiteIdx));
}

#[test]
fn sweep_turns_with_the_mesh_and_the_directions() {
    let turn = rotation(DVec3::new(2.0, 3.0, 6.0) / 7.0, 0.7);
    let direction = Direction {
        at: DVec3::Z,
        vector: DVec3::new(1.0, 0.5, 0.0),
    };
    let turned_direction = Direction {
        at: turn * direction.at,
        vector: turn * direction.vector,
    };
    let measure = |mesh: Mesh, direction: Direction| {
        let hierarchy = sites_on(mesh, 1500, 3);
        let orientation = Orientation::new(&hierarchy, &[direction]).unwrap();
        let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
        let positions = hierarchy.sites().positions().to_vec();
        (positions, sweep.distances(0).to_vec())
    };
    let (positions, distances) = measure(cap(), direction);
    let (turned_positions, turned) = measure(moved(&cap(), |at| turn * at), turned_direction);
    let near = |site: usize| {
        let at = turn * positions[site];
        let key = |other: &usize| turned_positions[*other].distance(at);
        (0..turned_positions.len())
            .min_by(|a, b| key(a).total_cmp(&key(b)))
            .unwrap()
    };
    let found: Vec<f64> = (0..distances.len())
        .map(|site| turned[near(site)])
        .collect();
    // Rounding can move sites, by less than a spacing of 0.03.
    assert!(
        spread(&found, &distances) < 0.01,
        "{}",
        spread(&found, &distances)
    );
}

#[test]
fn sweep_rises_along_smooth_fields() {
    let hierarchy = sites_on(cap(), 4000, 4);
    let direction = Direction {
        at: DVec3::Z,
        vector: DVec3::X,
    };
    let orientation = Orientation::new(&hierarchy, &[direction]).unwrap();
    let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
    let share = rising_share(&hierarchy, &orientation, &sweep);
    assert!(share > 0.995, "{share} on a cap");

    let hierarchy = sites_on(tube(), 4000, 4);
    let orientation = along(&hierarchy, DVec3::NEG_Z);
    let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
    let share = rising_share(&hierarchy, &orientation, &sweep);
    assert!(share > 0.999, "{share} along a tube");
    // The facets of the tube shorten distances around it, but not along it.
    let heights: Vec<f64> = hierarchy
        .sites()
        .positions()
        .iter()
        .map(|at| -at.z)
        .collect();
    assert!(
        spread(&heights, sweep.distances(0)) < 1e-3,
        "{}",
        spread(&heights, sweep.distances(0))
    );
}

#[test]
fn sweep_around_a_tube_tears_along_a_line_only() {
    for n_levels in 1..=4 {
        let hierarchy = sites_on(tube(), 4000, n_levels);
        let orientation = Orientation::from_fn(&hierarchy, |_, normal| DVec3::Z.cross(normal));
        let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
        let share = rising_share(&hierarchy, &orientation, &sweep);
        // The tear takes one edge out of about 70 around the tube.
        assert!(share > 0.96, "{n_levels} levels: {share}");
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &distance in sweep.distances(0) {
            (low, high) = (low.min(distance), high.max(distance));
        }
        assert!(
            high - low > 5.0,
            "once around is 6.28, but the distances rise by {}",
            high - low
        );
    }
}

#[test]
fn sweep_around_a_point_tears_along_a_line_only() {
    let hierarchy = sites_on(square(), 4000, 3);
    let middle = DVec3::new(0.5, 0.5, 0.0);
    let orientation = Orientation::from_fn(&hierarchy, |at, _| DVec3::Z.cross(at - middle));
    let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
    let share = rising_share(&hierarchy, &orientation, &sweep);
    assert!(share > 0.9, "{share}");
}

#[test]
fn anchor_shifts_the_distances() {
    for (mesh, n_levels) in [(square(), 3), (cap(), 3), (cap(), 1)] {
        let hierarchy = sites_on(mesh, 2000, n_levels);
        let direction = Direction {
            at: DVec3::Z,
            vector: DVec3::new(1.0, 0.2, 0.0),
        };
        let orientation = Orientation::new(&hierarchy, &[direction]).unwrap();
        let plain = Sweep::new(&hierarchy, &orientation, None).unwrap();
        for anchor in [1, 700, 1999] {
            let moved = Sweep::new(&hierarchy, &orientation, Some(SiteIdx(anchor))).unwrap();
            assert_eq!(
                moved.distances(0)[anchor as usize],
                0.0,
                "the anchor is where s is zero"
            );
            for level in 0..n_levels {
                // The edge weights depend on the distances, which start at the anchor.
                let spread = spread(moved.distances(level), plain.distances(level));
                assert!(
                    spread < 0.02 * hierarchy.levels()[level].spacing(),
                    "{anchor}, level {level}: {spread}"
                );
            }
        }
    }
}

#[test]
fn sweep_solves_equation_5_on_one_level() {
    // Oracle: equation 5, repeated until it converges, as in the paper, with the edge weights of the result.
    let hierarchy = sites_on(cap(), 150, 1);
    let orientation = Orientation::from_fn(&hierarchy, |at, _| DVec3::new(at.y + 1.0, at.x, 0.0));
    let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
    let (graph, spacing) = (
        hierarchy.levels()[0].graph(),
        hierarchy.levels()[0].spacing(),
    );
    let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
    let components = components(graph);
    let mut distances = vec![0.0; graph.len()];
    for _ in 0..20_000 {
        let before = distances.clone();
        for a in hierarchy.sites().iter() {
            let (mut sum, mut weights) = (0.0, 0.0);
            for &b in graph.neighbors(a) {
                let (a, b) = (a.index(), b.index());
                let consensus = (orientation.vectors()[a] + orientation.vectors()[b]) / 2.0;
                let normal = (normals[a] + normals[b]).normalize();
                let consensus = (consensus - normal * consensus.dot(normal)).normalize();
                let ahead = positions[a].dot(consensus) - positions[b].dot(consensus);
                let off = (sweep.distances(0)[a] - sweep.distances(0)[b] - ahead) / spacing;
                let weight = 1.0 / positions[a].distance(positions[b]) / (1.0 + off * off);
                sum += weight * (before[b] + ahead);
                weights += weight;
            }
            if weights > 0.0 {
                distances[a.index()] = 0.5 * before[a.index()] + 0.5 * sum / weights;
            }
        }
    }
    for (site, &distance) in sweep.distances(0).iter().enumerate() {
        let wanted = distances[site] - distances[0];
        // Tolerance: after three rounds the edge weights have nearly, but not fully, converged.
        assert!(
            components[site] != 0 || (distance - wanted).abs() < 2e-3,
            "site {site}: {distance} {wanted}"
        );
    }
}

#[test]
fn refined_levels_are_near_the_solution() {
    let hierarchy = sites_on(cap(), 8000, 4);
    let field = |at: DVec3, _: DVec3| DVec3::new(at.y, 1.0, at.x);
    let orientation = Orientation::from_fn(&hierarchy, field);
    let refined = Sweep::new(&hierarchy, &orientation, None).unwrap();
    let finest = &hierarchy.levels()[0];
    let solved =
        LevelSweep::new(&hierarchy, &orientation, 0).solve(&components(finest.graph()), None);
    // Sweeps remove only short waves of the error. The coarser level, with its longer edges, leaves long waves.
    let spread = spread(refined.distances(0), &solved) / finest.spacing();
    assert!(spread < 0.3, "{spread} spacings");
}

#[test]
fn components_come_one_after_the_other() {
    let hierarchy = sites_on(two_squares(), 2000, 3);
    let sweep = Sweep::new(&hierarchy, &along(&hierarchy, DVec3::X), None).unwrap();
    for level in 0..3 {
        let order = sweep.order(level);
        let is_upper = |site: &SiteIdx| hierarchy.sites().positions()[site.index()].z > 1.0;
        let changes = order
            .windows(2)
            .filter(|pair| is_upper(&pair[0]) != is_upper(&pair[1]))
            .count();
        assert_eq!(changes, 1, "level {level}");
        assert_eq!(
            is_upper(&order[0]),
            is_upper(&SiteIdx(0)),
            "the component of the lowest site is first"
        );
    }
    let anchor = hierarchy
        .sites()
        .iter()
        .find(|site| hierarchy.sites().positions()[site.index()].z > 1.0);
    let anchored = Sweep::new(&hierarchy, &along(&hierarchy, DVec3::X), anchor).unwrap();
    assert_eq!(
        anchored.distances(0)[0],
        0.0,
        "the other component keeps its anchor"
    );
    assert_eq!(anchored.distances(0)[anchor.unwrap().index()], 0.0);
}

#[test]
fn sweep_refuses_what_is_not_of_the_hierarchy() {
    let hierarchy = sites_on(square(), 50, 2);
    let other = sites_on(square(), 60, 2);
    let error = Sweep::new(&hierarchy, &along(&other, DVec3::X), None).unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Count { count: 60, .. }),
        "{error}"
    );
    let orientation = along(&hierarchy, DVec3::X);
    let error = Sweep::new(&hierarchy, &orientation, Some(SiteIdx(50))).unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Range { what: "anchor", .. }),
        "{error}"
    );
    assert!(
        Sweep::new(&hierarchy, &orientation, Some(SiteIdx(49))).is_ok(),
        "the last site"
    );
}

#[test]
fn sweep_of_few_sites_holds() {
    for n_sites in [1, 2, 3, 5] {
        for n_levels in [1, 2, 3] {
            let hierarchy = sites_on(two_squares(), n_sites, n_levels);
            let sweep = Sweep::new(&hierarchy, &along(&hierarchy, DVec3::X), None).unwrap();
            assert_eq!(sweep.order(0).len(), n_sites);
            assert!(
                sweep
                    .distances(0)
                    .iter()
                    .all(|distance| distance.is_finite()),
                "{sweep:?}"
            );
        }
    }
}

#[test]
fn step_is_antisymmetric_and_zero_where_nothing_agrees() {
    let (way, sum, normal) = (
        DVec3::new(0.3, -0.1, 0.2),
        DVec3::new(1.0, 0.7, 0.1),
        DVec3::new(0.1, 0.0, 1.9),
    );
    assert_eq!(step(way, sum, normal), -step(-way, sum, normal));
    assert_eq!(step(way, DVec3::ZERO, normal), 0.0);
    assert_eq!(step(way, normal, normal), 0.0);
    assert_eq!(step(way, DVec3::X, DVec3::ZERO), 0.3);
}

#[test]
fn sweep_has_the_same_bits_on_any_number_of_threads() {
    let hierarchy = sites_on(sphere(), 6000, 3);
    let orientation = along(&hierarchy, DVec3::NEG_Y);
    let on = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        pool.install(|| {
            let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
            let order = sweep.order(0);
            (sweep, order)
        })
    };
    assert_eq!(on(1), on(2), "two threads");
    assert_eq!(on(1), on(7), "seven threads");
}

#[test]
fn value_stability_step() {
    let way = DVec3::new(0.3, -0.1, 0.2);
    let found = step(way, DVec3::new(1.0, 0.7, 0.1), DVec3::new(0.1, 0.0, 1.9));
    assert_eq!(found, 0.1786952859082401);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn sweep_of_any_field_is_finite(seed: u64, n_sites in 1_usize..300, n_levels in 1_usize..5, anchor in 0_u32..300) {
        let surface = Surface::new(two_squares()).unwrap();
        let options = HierarchyOptions { n_sites, n_levels, seed: Seed(seed), ..HierarchyOptions::default() };
        let hierarchy = Hierarchy::new(&surface, &options).unwrap();
        let orientation = Orientation::from_fn(&hierarchy, |at, _| DVec3::new(at.y - 0.5, 0.5 - at.x, 0.0));
        let sweep = Sweep::new(&hierarchy, &orientation, (anchor < n_sites as u32).then_some(SiteIdx(anchor))).unwrap();
        for (level, sites) in hierarchy.levels().iter().enumerate() {
            prop_assert!(sweep.distances(level).iter().all(|distance| distance.is_finite()));
            prop_assert_eq!(sweep.order(level).len(), sites.n_sites());
        }
    }
}
