//! Tests of windows of endless sets against a brute-force construction of a part of the plane.

use super::block::{Block, Stop};
use super::{EndlessPoint, EndlessPoissonDisk, EndlessVariablePoissonDisk, N_ROUNDS};
use crate::{
    DiskRule, Domain, PointSet, PointsError, PointsErrorKind, RSA_DENSITY, SpectrumOptions,
    poisson_disk, spectrum,
};
use core::f64::consts::TAU;
use dapple_hash::{CellHash, Seed, rand_core::Rng, unit_f64};
use glam::DVec2;

/// Returns the points in a canonical order.
fn sorted(mut points: Vec<EndlessPoint>) -> Vec<EndlessPoint> {
    points.sort_by(|a, b| {
        let (a, b) = (a.position, b.position);
        a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x))
    });
    points
}

/// Returns the points of a window, in a canonical order.
fn window(set: &EndlessPoissonDisk, min: DVec2, max: DVec2) -> Vec<EndlessPoint> {
    sorted(set.points(min, max).unwrap())
}

fn is_inside(position: DVec2, min: DVec2, max: DVec2) -> bool {
    position.cmpge(min).all() && position.cmplt(max).all()
}

/// Constructs the points by brute force: throws the darts of the cells from `-first` to `first` in order, and
/// compares each with all earlier points. The minimum radius is 1.
fn naive(
    seed: Seed,
    first: i64,
    radius: impl Fn([f64; 2]) -> f64,
    rule: DiskRule,
) -> Vec<EndlessPoint> {
    let step = 1.0 / f64::from(1 << 22);
    let width = (0.5_f64.sqrt() / step).floor();
    let mut darts = Vec::new();
    for (y, x) in (-first..=first).flat_map(|y| (-first..=first).map(move |x| (y, x))) {
        let hash = CellHash::new(seed, [x, y]);
        for round in 0..u32::from(N_ROUNDS) {
            let [u, v] = sobol(round);
            let bits = hash.at(0);
            let within = [(bits >> 32) as u32 ^ u, bits as u32 ^ v]
                .map(|bits| (f64::from(bits) / 4_294_967_296.0 * width).floor());
            let position = [
                (x as f64 * width + within[0]) * step,
                (y as f64 * width + within[1]) * step,
            ];
            let radius = radius(position);
            let thin = unit_f64(hash.at(2 + u32::from(N_ROUNDS) + round));
            if radius == 1.0 || thin < 1.0 / (radius * radius) {
                let point = EndlessPoint {
                    position: position.into(),
                    radius,
                    id: hash.at(1),
                };
                darts.push((round, hash.at(2 + round), point));
            }
        }
    }
    darts.sort_by_key(|&(round, rank, _)| (round, rank));
    let mut points: Vec<EndlessPoint> = Vec::new();
    for (_, _, dart) in darts {
        let keeps = |point: &EndlessPoint| {
            let least = rule.distance(point.radius, dart.radius);
            point.position.distance_squared(dart.position) >= least * least
        };
        if points.iter().all(keeps) {
            points.push(dart);
        }
    }
    points
}

/// Returns point `i` of the 2-D Sobol sequence: bit reversal for x, and the matrix of binomials modulo 2 for y.
fn sobol(i: u32) -> [u32; 2] {
    let odd_binomial = |n: u32, k: u32| n & k == k;
    let mut y = 0;
    for row in 0..5 {
        let ones = (0..5).filter(|&column| i >> column & 1 == 1 && odd_binomial(column, row));
        y |= (ones.count() as u32 & 1) << (31 - row);
    }
    [i.reverse_bits(), y]
}

#[test]
fn windows_hold_the_points_of_a_construction_by_brute_force() {
    // No dependency reaches from the edge of 45 cells, 32 radii, into the window.
    let expected = naive(
        Seed(3).child("endless poisson disk", 0),
        45,
        |_| 1.0,
        DiskRule::Average,
    );
    let set = EndlessPoissonDisk::new(1.0, Seed(3)).unwrap();
    let (min, max) = (DVec2::new(-13.0, -20.5), DVec2::new(20.0, 14.25));
    let inside = expected
        .into_iter()
        .filter(|point| is_inside(point.position, min, max));
    assert_eq!(window(&set, min, max), sorted(inside.collect()));
}

#[test]
fn windows_of_a_variable_radius_hold_the_points_of_a_construction_by_brute_force() {
    let radius = |[x, y]: [f64; 2]| (1.0 + 0.2 * x.abs() + 0.02 * y).clamp(1.0, 3.0);
    let (min, max) = (DVec2::new(-9.0, -6.0), DVec2::new(5.0, 7.5));
    for rule in [DiskRule::Average, DiskRule::Larger, DiskRule::Smaller] {
        let seed = Seed(5).child("endless variable poisson disk", 0);
        let expected = naive(seed, 45, radius, rule);
        let set = EndlessVariablePoissonDisk::new([1.0, 3.0], radius, Seed(5))
            .unwrap()
            .with_rule(rule);
        let inside = expected
            .into_iter()
            .filter(|point| is_inside(point.position, min, max));
        let found = sorted(set.points(min, max).unwrap());
        assert_eq!(found, sorted(inside.collect()), "{rule}");
        assert!(found.len() > 40, "{rule}");
    }
}

#[test]
fn chunks_agree_wherever_they_are_and_whatever_their_size() {
    let mut stream = Seed(1).stream();
    let mut unit = || unit_f64(stream.next_u64());
    for (n, radius) in [0.3, 1.0, 7.5, 1.9]
        .into_iter()
        .cycle()
        .take(60)
        .enumerate()
    {
        let period = [None, None, Some(11.5 * radius), Some(1000.0)];
        let set = EndlessPoissonDisk::new(radius, Seed(n as u64))
            .unwrap()
            .with_period([period[n % 4], period[n % 3]])
            .unwrap();
        let far = [0.0, 1e4, -1e9, 1e9 + 0.1, -1e6][n % 5];
        let min = DVec2::new(far, -0.3 * far) + DVec2::new(unit(), unit()) * 100.0;
        let size = DVec2::new(unit(), unit()) * 60.0 * radius;
        let all = window(&set, min, min + size);
        // Four parts, and a window that overlaps all of them.
        let cut = min + size * DVec2::new(unit(), unit());
        let max = min + size;
        let parts = [
            (min, cut),
            (DVec2::new(cut.x, min.y), DVec2::new(max.x, cut.y)),
            (DVec2::new(min.x, cut.y), DVec2::new(cut.x, max.y)),
            (cut, max),
        ];
        let joined = parts
            .into_iter()
            .flat_map(|(min, max)| set.points(min, max).unwrap());
        assert_eq!(sorted(joined.collect()), all, "{radius} at {min}");
        let inner = (min + size * 0.3, min + size * 0.7);
        let inside = all
            .iter()
            .copied()
            .filter(|point| is_inside(point.position, inner.0, inner.1));
        let expected: Vec<_> = inside.collect();
        assert_eq!(window(&set, inner.0, inner.1), expected);
    }
}

#[test]
fn a_window_of_several_blocks_agrees_with_small_windows() {
    let set = EndlessPoissonDisk::new(1.0, Seed(9)).unwrap();
    let all = window(&set, DVec2::splat(-100.0), DVec2::splat(110.0));
    for x in [-20.0, -10.5, 80.0] {
        let (min, max) = (DVec2::new(x, -12.0), DVec2::new(x + 11.0, -5.0));
        let inside = all
            .iter()
            .copied()
            .filter(|point| is_inside(point.position, min, max));
        assert_eq!(window(&set, min, max), inside.collect::<Vec<_>>());
    }
}

#[test]
fn the_margin_around_a_block_changes_nothing() {
    let plane = EndlessPoissonDisk::new(1.0, Seed(9)).unwrap().plane;
    let mut n_refused = 0;
    for corner in (0..20).map(|n| 50 * n) {
        let cells = [[corner, corner + 9], [-corner, 20 - corner]];
        let solve = |margin| Block::new(&plane, cells, margin, &|_| 1.0).solve();
        let expected = solve(40).unwrap();
        for margin in 2..12 {
            match solve(margin) {
                Ok(points) => assert_eq!(points, expected, "{margin} at {corner}"),
                Err(stop) => {
                    assert_eq!(stop, Stop::Margin);
                    n_refused += 1;
                }
            }
        }
        assert_eq!(plane.block(cells, &|_| 1.0).unwrap(), expected);
    }
    assert!((20..150).contains(&n_refused), "{n_refused}");
}

#[test]
fn points_keep_their_distance_exactly() {
    for (radius, origin) in [
        (0.1, 0.0),
        (1.0, 1e6),
        (2.9999, -1e8),
        (1e-200, 0.0),
        (1e200, 0.0),
    ] {
        let set = EndlessPoissonDisk::new(radius, Seed(2)).unwrap();
        let min = DVec2::splat(origin);
        let size = DVec2::splat(80.0 * radius);
        let points = set.points(min, min + size).unwrap();
        let ids: std::collections::BTreeSet<u64> = points.iter().map(|point| point.id).collect();
        assert_eq!(ids.len(), points.len());
        // Scale exactly, so that squares do not underflow.
        let scale = 1.0 / f64::from_bits(radius.to_bits() & f64::INFINITY.to_bits());
        let positions = points.iter().map(|point| (point.position - min) * scale);
        let domain = Domain::rectangle(DVec2::ZERO, size * scale);
        let least = PointSet::new(domain, positions.collect()).unwrap();
        let least = least.minimum_distance().unwrap() / scale;
        // The minimum of 4000 distances is barely larger than the radius.
        assert!(
            (radius..1.01 * radius).contains(&least),
            "{least} beside {radius}"
        );
    }
}

#[test]
fn the_density_is_nine_tenths_of_a_maximal_set_everywhere() {
    let set = EndlessPoissonDisk::new(0.5, Seed(4)).unwrap();
    for origin in [0.0, -1e9] {
        let points = set.points([origin, 0.0], [origin + 100.0, 100.0]).unwrap();
        let share = points.len() as f64 * 0.25 / 1e4 / RSA_DENSITY;
        // Measured 0.919 for 10^6 points; sets of 25,000 deviate by less than 0.003.
        assert!((0.91..0.93).contains(&share), "{share}");
    }
}

/// Returns a repeating endless set with about 10,000 points per period, and a maximal set on the same torus.
fn tori(seed: u64) -> [PointSet; 2] {
    let domain = Domain::torus(DVec2::ZERO, DVec2::splat(127.0));
    let set = EndlessPoissonDisk::new(1.0, Seed(seed))
        .unwrap()
        .with_period([Some(127.0); 2])
        .unwrap();
    let points = set.points([0.0; 2], [127.0; 2]).unwrap();
    let positions = points.into_iter().map(|point| point.position).collect();
    [
        PointSet::new(domain, positions).unwrap(),
        poisson_disk(domain, 1.0, Seed(seed)).unwrap(),
    ]
}

#[test]
fn the_spectrum_is_isotropic_and_shows_no_lattice() {
    let sets: Vec<[PointSet; 2]> = (0..4).map(tori).collect();
    let [ours, maximal] = [0, 1].map(|which| {
        let sets: Vec<PointSet> = sets.iter().map(|pair| pair[which].clone()).collect();
        spectrum(&sets, &SpectrumOptions::default()).unwrap()
    });
    // The isotropic value is 1; maximal sets reach 1.05 with as few samples.
    assert!(
        (0.9..1.1).contains(&ours.anisotropy()),
        "{}",
        ours.anisotropy()
    );
    // Compare the low-frequency power and the first peak with a maximal set.
    let [low, maximal_low] = [&ours, &maximal].map(|s| s.mean_power(0.1, 0.5));
    assert!(low < 2.5 * maximal_low && low < 0.3, "{low} {maximal_low}");
    let ratio = ours.peak_power() / maximal.peak_power();
    assert!((0.8..1.1).contains(&ratio), "{ratio}");
    // Power at the frequencies of the cells: without a lattice it is exponentially distributed with a mean of about 1;
    // a lattice of N points has a power of N.
    for [points, _] in &sets {
        for frequency in [[1, 0], [0, 1], [1, 1], [2, 0], [0, 2]] {
            // 180 cells of at most 1 / √2 along a side of 127.
            let wave = DVec2::new(f64::from(frequency[0]), f64::from(frequency[1])) * 180.0 / 127.0;
            let (mut sine, mut cosine) = (0.0, 0.0);
            for (_, position) in points.iter() {
                let (s, c) = libm::sincos(TAU * wave.dot(position));
                (sine, cosine) = (sine + s, cosine + c);
            }
            let power = (sine * sine + cosine * cosine) / points.len() as f64;
            // One in 10^5 exponential numbers is above 12.
            assert!(power < 12.0, "{frequency:?}: {power}");
        }
    }
}

#[test]
fn neighbors_are_as_far_as_in_a_maximal_set() {
    let [ours, maximal] = tori(11);
    // Pair correlation: mean number of neighbors by distance, relative to random points.
    let pairs = |points: &PointSet, distance: f64| {
        points.mean_neighbor_count(distance) / (points.len() as f64 * distance * distance)
    };
    for distance in [1.1, 1.5, 2.0, 3.0] {
        let ratio = pairs(&ours, distance) / pairs(&maximal, distance);
        // The additional points of a maximal set fit tightly, with several neighbors barely farther than the radius.
        assert!((0.7..1.03).contains(&ratio), "{distance}: {ratio}");
    }
    let gap = ours.largest_empty_circle().unwrap().radius;
    assert!((1.0..1.6).contains(&gap), "{gap}");
}

#[test]
fn points_repeat_after_a_period_and_keep_their_distance_around_it() {
    // The shortest possible period, one of four narrow cells, one that is not a multiple of a step, and a long one.
    for (radius, period) in [(1.0, 2.0), (1.0, 2.2), (0.1, 0.3), (3.0, 1e6), (1.0, 10.0)] {
        let set = EndlessPoissonDisk::new(radius, Seed(8))
            .unwrap()
            .with_period([Some(period); 2])
            .unwrap();
        let size = DVec2::splat(period.min(60.0 * radius));
        let here = window(&set, DVec2::ZERO, size);
        assert!(!here.is_empty());
        let shift = DVec2::new(period, -3.0 * period);
        // Tolerance: one rounding of a coordinate up to three periods.
        let slack = DVec2::splat(4.0 * period * f64::EPSILON);
        let there = window(&set, shift - slack, shift + size + slack);
        for point in &here {
            let copies = there.iter().filter(|copy| {
                copy.id == point.id
                    && (copy.position - shift - point.position)
                        .abs()
                        .cmple(slack)
                        .all()
            });
            assert_eq!(copies.count(), 1, "{point:?} of {radius}, {period}");
        }
        if size.x == period {
            let domain = Domain::torus(DVec2::ZERO, size);
            let positions = here.iter().map(|point| point.position).collect();
            let points = PointSet::new(domain, positions).unwrap();
            let least = points.minimum_distance().unwrap_or(radius);
            // A difference around the torus is rounded once more.
            assert!(
                least >= radius * (1.0 - 1e-15),
                "{least} beside {radius}, {period}"
            );
        }
    }
}

#[test]
fn a_variable_radius_is_followed_by_distances_and_densities() {
    let radius = |[x, _]: [f64; 2]| 1.0 + 0.02 * x;
    let set = EndlessVariablePoissonDisk::new([1.0, 4.0], radius, Seed(6)).unwrap();
    let points = set.points([0.0, 0.0], [150.0, 150.0]).unwrap();
    for (n, a) in points.iter().enumerate() {
        assert_eq!(a.radius, radius(a.position.to_array()));
        for b in &points[..n] {
            let least = 0.5 * (a.radius + b.radius);
            assert!(a.position.distance(b.position) >= least);
        }
    }
    for strip in 0..5 {
        let (left, right) = (30.0 * f64::from(strip), 30.0 * f64::from(strip + 1));
        let inside = points
            .iter()
            .filter(|point| point.position.x >= left && point.position.x < right);
        // Integral of 1 / r² over the strip
        let share = 150.0 / 0.02 * (1.0 / radius([left, 0.0]) - 1.0 / radius([right, 0.0]));
        let density = inside.count() as f64 / share;
        // 400 to 2000 points, whose number deviates by 2 %.
        assert!((0.60..0.67).contains(&density), "{left}: {density}");
    }
    // With a constant radius, the set is as dense as a set with a fixed radius.
    let even = EndlessVariablePoissonDisk::new([1.0, 2.0], |_| 2.0, Seed(6)).unwrap();
    let n_points = even.points([0.0, 0.0], [300.0, 300.0]).unwrap().len();
    let density = n_points as f64 * 4.0 / 9e4;
    assert!((0.62..0.65).contains(&density), "{density}");
}

#[test]
fn a_radius_beyond_its_bounds_is_clamped() {
    let [low, high] = [0.1, 100.0].map(|radius| {
        EndlessVariablePoissonDisk::new([1.0, 2.0], move |_| radius, Seed(6))
            .unwrap()
            .points([0.0, 0.0], [20.0, 20.0])
            .unwrap()
    });
    assert!(low.iter().all(|point| point.radius == 1.0));
    assert!(high.iter().all(|point| point.radius == 2.0));
    assert!(low.len() > 3 * high.len());
}

#[test]
fn a_set_of_a_variable_radius_repeats_if_its_radius_does_not() {
    let radius = |[x, _]: [f64; 2]| 1.0 + 0.1 * x;
    let set = EndlessVariablePoissonDisk::new([1.0, 2.0], radius, Seed(6)).unwrap();
    let set = set.with_period([Some(16.0), None]).unwrap();
    let here = sorted(set.points([0.0, 0.0], [16.0, 20.0]).unwrap());
    let there = sorted(set.points([160.0, 0.0], [176.0, 20.0]).unwrap());
    assert_eq!(here.len(), there.len());
    for (here, there) in here.iter().zip(&there) {
        let moved = here.position + DVec2::new(160.0, 0.0);
        assert_eq!((moved, here.id), (there.position, there.id));
    }
}

#[test]
fn bad_numbers_are_refused() {
    let kind =
        |result: Result<_, PointsError>| result.map(|_: usize| ()).unwrap_err().kind().clone();
    let out_of_range = |kind| matches!(kind, PointsErrorKind::OutOfRange { .. });
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        let made = EndlessPoissonDisk::new(radius, Seed(1)).map(|_| 0);
        assert!(out_of_range(kind(made)), "{radius}");
        let made = EndlessVariablePoissonDisk::new([1.0, radius], |_| 1.0, Seed(1)).map(|_| 0);
        assert!(out_of_range(kind(made)), "{radius}");
    }
    let made = EndlessVariablePoissonDisk::new([1.0, 16.1], |_| 1.0, Seed(1)).map(|_| 0);
    assert!(out_of_range(kind(made)), "ratio");
    let set = EndlessPoissonDisk::new(1.0, Seed(1)).unwrap();
    for (min, max) in [
        ([f64::NAN, 0.0], [1.0, 1.0]),
        ([0.0, 0.0], [1.0, f64::NAN]),
        ([0.0, 0.0], [-1.0, 1.0]),
        ([0.0, -1e12], [1.0, 1.0]),
        ([0.0, 0.0], [f64::INFINITY, 1.0]),
    ] {
        let made = set.points(min, max).map(|points| points.len());
        assert!(out_of_range(kind(made)), "{min:?} {max:?}");
    }
    let many = set.points([0.0; 2], [1e5; 2]).map(|points| points.len());
    assert!(matches!(kind(many), PointsErrorKind::TooMany { .. }));
    assert_eq!(set.points([3.0, 0.0], [3.0, 1e9]).unwrap(), []);
    // Windows at the maximum distance work.
    let farthest = (1_u64 << 39) as f64;
    for corner in [-farthest, farthest - 8.0] {
        let n_points = set.points([corner; 2], [corner + 8.0; 2]).unwrap().len();
        assert!((30..50).contains(&n_points), "{n_points} at {corner}");
    }
    for period in [0.0, 1.9, f64::NAN, 1e13] {
        let made = set.clone().with_period([None, Some(period)]).map(|_| 0);
        let kind = kind(made);
        let is_short = matches!(kind, PointsErrorKind::PeriodTooShort { axis: 1, .. });
        assert!(is_short || out_of_range(kind), "{period}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let radius = |[x, _]: [f64; 2]| if x > 5.0 { bad } else { 1.0 };
        let set = EndlessVariablePoissonDisk::new([1.0, 2.0], radius, Seed(1)).unwrap();
        let made = set.points([0.0; 2], [10.0; 2]).map(|points| points.len());
        assert!(
            matches!(kind(made), PointsErrorKind::Radius { .. }),
            "{bad}"
        );
    }
}

#[test]
fn value_stability_endless_poisson_disk() {
    let fold = |points: Vec<EndlessPoint>| {
        let parts = points.iter().map(|point| {
            let [x, y] = point.position.to_array().map(f64::to_bits);
            x.rotate_left(17) ^ y.rotate_left(31) ^ point.radius.to_bits() ^ point.id
        });
        // The order of the points is unspecified.
        (points.len(), parts.fold(0, u64::wrapping_add))
    };
    let set = EndlessPoissonDisk::new(0.7, Seed(7)).unwrap();
    let plain = set.points([1e6, -4.0], [1e6 + 8.0, 4.0]).unwrap();
    let tile = set.with_period([Some(9.1), None]).unwrap();
    let tile = tile.points([-20.0, -4.0], [-12.0, 4.0]).unwrap();
    let radius = |[x, y]: [f64; 2]| 0.5 + 0.1 * (x + y).abs();
    let variable = EndlessVariablePoissonDisk::new([0.5, 1.5], radius, Seed(7)).unwrap();
    let variable = variable.points([-8.0; 2], [8.0; 2]).unwrap();
    let found = [plain, tile, variable].map(fold);
    assert_eq!(
        found,
        [
            (83, 8580914702571024190),
            (86, 11435513938386813234),
            (223, 1749064485043918570)
        ]
    );
}
