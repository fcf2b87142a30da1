//! Tests of the properties of Poisson-disk sets, independent of their construction.

use super::mask::Coverage;
use super::solve::Solution;
use super::{
    PoissonDisk, extend_poisson_disk, poisson_disk, poisson_disk_about, poisson_disk_cancellable,
    poisson_disk_radius,
};
use crate::{
    Domain, IsCancelled, PointIdx, PointSet, PointsError, PointsErrorKind, RSA_DENSITY,
    SpectrumOptions, VariablePoissonOptions, nested_poisson_disk_cancellable, spectrum,
    variable_poisson_disk_cancellable,
};
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Ramp, Varying, parallel};
use fearless_simd::Level;
use glam::DVec2;

/// Maximum relative excess of an empty circle's radius over the set's radius, as documented.
const GAP_TOLERANCE: f64 = 1e-6;

/// Domains with every kind of wrapping: square, thin, far from the origin; none narrower than two radii of 0.1.
fn domains() -> Vec<Domain> {
    let mut domains = Vec::new();
    for wrap in [[false, false], [true, false], [false, true], [true, true]] {
        for size in [
            DVec2::ONE,
            DVec2::new(3.0, 0.2),
            DVec2::new(0.2, 2.0),
            DVec2::splat(0.2),
            DVec2::new(0.35, 0.46),
        ] {
            let origin = DVec2::new(-0.3, 1000.0);
            domains.push(Domain { origin, size, wrap });
        }
    }
    domains
}

/// Checks that no two points are closer than the radius, and that no further point fits.
fn assert_is_maximal(set: &PointSet, radius: f64) {
    let case = format!("{} points, {:?}, radius {radius}", set.len(), set.domain());
    if let Some(distance) = set.minimum_distance() {
        assert!(distance >= radius, "{case}: two are {distance} apart");
    }
    let gap = set
        .largest_empty_circle()
        .expect("a maximal set has points");
    assert!(
        gap.radius <= radius * (1.0 + GAP_TOLERANCE),
        "{case}: an empty circle has radius {}",
        gap.radius
    );
}

#[test]
fn sets_are_maximal_in_every_domain() {
    for domain in domains() {
        for seed in 0..6 {
            assert_is_maximal(&poisson_disk(domain, 0.1, Seed(seed)).unwrap(), 0.1);
        }
    }
}

#[test]
fn sets_are_maximal_when_large() {
    for (seed, wrap) in [[true, true], [true, false], [false, true], [false, false]]
        .into_iter()
        .enumerate()
    {
        let domain = Domain {
            wrap,
            ..Domain::paper_torus()
        };
        let set = poisson_disk(domain, 0.0123, Seed(seed as u64)).unwrap();
        assert_is_maximal(&set, 0.0123);
    }
}

#[test]
fn a_domain_smaller_than_the_radius_holds_one_point() {
    for size in [
        DVec2::splat(0.5),
        DVec2::new(1e-9, 0.5),
        DVec2::splat(1e-300),
    ] {
        let set = poisson_disk(Domain::rectangle(DVec2::ZERO, size), 1.0, Seed(1)).unwrap();
        assert_eq!(set.len(), 1, "in a rectangle of {size}");
    }
}

#[test]
fn a_line_is_filled_like_a_plane() {
    let line = Domain::rectangle(DVec2::ZERO, DVec2::new(1.0, 1e-12));
    let set = poisson_disk(line, 0.001, Seed(5)).unwrap();
    let xs: Vec<f64> = set.positions().iter().map(|position| position.x).collect();
    for pair in xs.windows(2) {
        let gap = pair[1] - pair[0];
        assert!(
            (0.001..=0.002 * (1.0 + GAP_TOLERANCE)).contains(&gap),
            "a gap of {gap}"
        );
    }
    // Rényi's parking constant: random intervals that do not overlap cover 0.7476 of a line. The tolerance of 0.02 is
    // three standard deviations of the number of 748 intervals, which varies by 0.2 · sqrt(748), plus the two ends.
    assert!(
        (set.len() as f64 * 0.001 - 0.7476).abs() < 0.02,
        "{} intervals",
        set.len()
    );
}

#[test]
fn density_is_that_of_random_sequential_addition() {
    let radius = poisson_disk_radius(Domain::paper_torus(), 50_000).unwrap();
    let set = poisson_disk(Domain::paper_torus(), radius, Seed(11)).unwrap();
    let density = set.normalized_density(radius);
    // The number of points of a set of N varies by about 0.25 · sqrt(N): here 0.001 of the density.
    assert!((density - RSA_DENSITY).abs() < 0.004, "N r² is {density}");
}

#[test]
fn spectrum_is_isotropic_and_that_of_darts() {
    let radius = poisson_disk_radius(Domain::paper_torus(), 2000).unwrap();
    let sets: Vec<PointSet> = (0..30)
        .map(|seed| poisson_disk(Domain::paper_torus(), radius, Seed(seed)).unwrap())
        .collect();
    let found = spectrum(&sets, &SpectrumOptions::default()).unwrap();
    assert!(
        found.anisotropy() <= 1.1,
        "anisotropy {}",
        found.anisotropy()
    );
    // Brute-force random sequential addition has a peak of 1.75 (research note). Here rings have fewer frequencies:
    // 0.15 is three standard deviations of the largest ring.
    assert!(
        (found.peak_power() - 1.75).abs() < 0.15,
        "peak {}",
        found.peak_power()
    );
}

/// Throws darts sequentially, except at squares of a fine grid that a single disc covers. Stops after `misses`
/// consecutive rejected darts.
fn throw_darts(domain: Domain, radius: f64, misses: u32, seed: Seed) -> PointSet {
    const SIDE: u32 = 100;
    let square = domain.size / f64::from(SIDE);
    let at = |x: u32, y: u32| domain.origin + DVec2::new(f64::from(x), f64::from(y)) * square;
    let mut open: Vec<DVec2> = (0..SIDE * SIDE).map(|i| at(i % SIDE, i / SIDE)).collect();
    let mut positions: Vec<DVec2> = Vec::new();
    let (mut missed, mut dart) = (0, 0);
    while missed < misses && !open.is_empty() {
        let hash = CellHash::new(seed, [dart]);
        let corner = open[(unit_f64(hash.at(2)) * open.len() as f64) as usize];
        let unit = DVec2::new(unit_f64(hash.at(0)), unit_f64(hash.at(1)));
        let position = domain.wrap(corner + unit * square);
        let is_free = positions
            .iter()
            .all(|&other| domain.delta(other, position).length() >= radius);
        if is_free {
            positions.push(position);
            open.retain(|&corner| {
                let delta = domain.delta(position, corner + 0.5 * square);
                delta.length() + 0.5 * square.length() >= radius
            });
        }
        missed = if is_free { 0 } else { missed + 1 };
        dart += 1;
    }
    PointSet::new(domain, positions).unwrap()
}

#[test]
fn points_are_as_many_as_darts_by_brute_force_in_every_domain() {
    for wrap in [[true, true], [true, false], [false, false]] {
        let domain = Domain {
            wrap,
            ..Domain::paper_torus()
        };
        let mean = |count: &dyn Fn(Seed) -> usize| {
            (0..100).map(|seed| count(Seed(seed)) as f64).sum::<f64>() / 100.0
        };
        let ours = mean(&|seed| poisson_disk(domain, 0.3, seed).unwrap().len());
        let darts = mean(&|seed| throw_darts(domain, 0.3, 2000, seed).len());
        // Counts near 35 vary by 1.5, so the difference of two means of 100 varies by 0.2; darts miss one gap in 50
        // sets.
        assert!(
            (ours - darts).abs() < 0.7,
            "{wrap:?}: {ours} beside {darts}"
        );
    }
}

#[test]
fn number_of_points_is_about_what_was_asked_for() {
    for wrap in [[true, true], [true, false], [false, true], [false, false]] {
        for n_points in [20, 200, 2000] {
            let domain = Domain {
                wrap,
                size: DVec2::new(2.0, 1.0),
                ..Domain::paper_torus()
            };
            let total: usize = (0..20)
                .map(|seed| {
                    poisson_disk_about(domain, n_points, Seed(seed))
                        .unwrap()
                        .len()
                })
                .sum();
            let ratio = total as f64 / 20.0 / f64::from(n_points);
            // The border correction is first-order and ignores corners.
            assert!(
                (ratio - 1.0).abs() < 0.05,
                "{wrap:?}: {ratio} of {n_points}"
            );
        }
    }
}

#[test]
#[cfg(feature = "rayon")]
fn number_of_threads_changes_nothing() {
    for domain in [
        Domain::paper_torus(),
        Domain {
            wrap: [true, false],
            ..Domain::paper_torus()
        },
    ] {
        let sets = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| poisson_disk(domain, 0.004, Seed(3)).unwrap())
        });
        assert!(
            sets[0] == sets[1] && sets[0] == sets[2],
            "threads changed the points"
        );
    }
}

#[test]
fn every_simd_level_gives_the_same_bits() {
    let torus = Domain::paper_torus();
    let solver = PoissonDisk::new(torus, 0.02).unwrap();
    let with = |level: Level| {
        let coverage = Coverage::new(&solver.grid, level);
        let mut solution = Solution::new(&solver.grid, &coverage, level, &|| false).unwrap();
        solution.fill(Seed(3)).unwrap();
        solution.positions().unwrap()
    };
    let expected = solver.sample(Seed(3)).unwrap();
    let best = Level::new();
    assert_eq!(with(best), expected.positions(), "the best level");
    assert_eq!(
        with(Level::baseline()),
        expected.positions(),
        "the baseline"
    );
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(token) = best.as_sse4_2() {
        assert_eq!(with(Level::Sse4_2(token)), expected.positions(), "SSE 4.2");
    }
}

#[test]
fn given_points_stay_first_and_where_they_are() {
    for domain in domains() {
        let coarse = poisson_disk(domain, 0.1, Seed(1)).unwrap();
        let fine = extend_poisson_disk(&coarse, 0.05, Seed(2)).unwrap();
        assert_eq!(
            &fine.positions()[..coarse.len()],
            coarse.positions(),
            "in {domain:?}"
        );
        assert_is_maximal(&fine, 0.05);
        let same = extend_poisson_disk(&fine, 0.05, Seed(3)).unwrap();
        assert_eq!(same, fine, "a maximal set took more points");
    }
}

#[test]
fn given_points_on_borders_and_corners_are_taken() {
    for wrap in [[false, false], [true, true]] {
        let domain = Domain {
            wrap,
            ..Domain::paper_torus()
        };
        let mut ends = vec![DVec2::NEG_ONE, DVec2::new(0.5, -1.0), DVec2::ZERO];
        if !wrap[0] {
            ends.extend([DVec2::ONE, DVec2::new(-1.0, 1.0)]);
        }
        let given = PointSet::new(domain, ends).unwrap();
        assert_is_maximal(&extend_poisson_disk(&given, 0.1, Seed(4)).unwrap(), 0.1);
    }
}

#[test]
fn given_points_that_are_too_close_are_refused() {
    let torus = Domain::paper_torus();
    let given = vec![DVec2::ZERO, DVec2::new(-0.98, 0.3), DVec2::new(0.98, 0.35)];
    let given = PointSet::new(torus, given).unwrap();
    let error = extend_poisson_disk(&given, 0.1, Seed(1)).unwrap_err();
    assert!(
        matches!(
            error.kind(),
            PointsErrorKind::TooClose {
                points: [PointIdx(1), PointIdx(2)],
                ..
            }
        ),
        "{error}"
    );
    let other = PoissonDisk::new(Domain::rectangle(DVec2::ZERO, DVec2::ONE), 0.1).unwrap();
    let error = other.extend(&given, Seed(1)).unwrap_err();
    assert!(
        matches!(error.kind(), PointsErrorKind::DifferentDomains { .. }),
        "{error}"
    );
}

#[test]
fn bad_radii_are_refused() {
    let torus = Domain::paper_torus();
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = poisson_disk(torus, radius, Seed(0)).unwrap_err();
        assert!(
            matches!(error.kind(), PointsErrorKind::NotPositive { .. }),
            "{error}"
        );
    }
    let error = poisson_disk(torus, 1.01, Seed(0)).unwrap_err();
    assert!(
        matches!(error.kind(), PointsErrorKind::PeriodTooShort { .. }),
        "{error}"
    );
    for radius in [1e-4, 1e-9, 1e-300, f64::MIN_POSITIVE] {
        let error = poisson_disk(torus, radius, Seed(0)).unwrap_err();
        assert!(
            matches!(error.kind(), PointsErrorKind::TooMany { .. }),
            "{error}"
        );
    }
    let long = Domain::rectangle(DVec2::ZERO, DVec2::new(1e300, 1e-300));
    let error = poisson_disk(long, 1.0, Seed(0)).unwrap_err();
    assert!(
        matches!(error.kind(), PointsErrorKind::TooMany { .. }),
        "{error}"
    );
    let error = poisson_disk_about(torus, 0, Seed(0)).unwrap_err();
    assert!(matches!(error.kind(), PointsErrorKind::NoPoints), "{error}");
}

#[test]
fn strips_of_any_width_hold_a_maximal_set() {
    for width in [1e-3, 1e-9, 1e-10, 1e-12, 1e-100] {
        for size in [DVec2::new(width, 20.0), DVec2::new(20.0, width)] {
            for seed in 0..5 {
                let strip = Domain::rectangle(DVec2::ZERO, size);
                let set = poisson_disk(strip, 0.3, Seed(seed)).unwrap();
                let distance = set.minimum_distance().unwrap();
                let circle = set.largest_empty_circle().unwrap();
                assert!(
                    distance >= 0.3 && circle.radius <= 0.3 * (1.0 + 2e-6),
                    "{size}: {distance}, {circle:?}"
                );
            }
        }
    }
}

#[test]
fn value_stability_poisson_disk() {
    let set = poisson_disk(Domain::paper_torus(), 0.1, Seed(7)).unwrap();
    let bits = set.positions().iter().fold(0_u64, |sum, position| {
        (sum.rotate_left(1) ^ position.x.to_bits()).rotate_left(1) ^ position.y.to_bits()
    });
    assert_eq!(set.len(), 282);
    assert_eq!(bits, 8764673758391801309);
}

/// A function that creates points unless canceled.
type Make<'a> = &'a dyn Fn(&IsCancelled) -> Result<PointSet, PointsError>;

/// Creates points with a callback that cancels at call number `last` and later, and returns the number of calls.
fn cancelled_at(last: usize, make: Make<'_>) -> usize {
    let n_calls = AtomicUsize::new(0);
    let made = make(&|| n_calls.fetch_add(1, Relaxed) >= last);
    let n_calls = n_calls.into_inner();
    let is_cancelled = made.is_err_and(|error| *error.kind() == PointsErrorKind::Cancelled);
    assert_eq!(is_cancelled, n_calls > last, "at call {last}");
    n_calls
}

#[test]
fn sets_can_be_cancelled_at_every_call_and_are_asked_often() {
    let domain = Domain::paper_torus();
    let ramp = Varying::Ramp(Ramp {
        from: DVec2::NEG_ONE,
        to: DVec2::ONE,
        start: 0.008,
        end: 0.012,
    });
    let plane = Domain {
        wrap: [false; 2],
        ..domain
    };
    let options = VariablePoissonOptions::default();
    let makers: [Make<'_>; 3] = [
        &|stop| poisson_disk_cancellable(domain, 0.01, Seed(1), stop),
        &|stop| {
            let nested = nested_poisson_disk_cancellable(domain, &[0.01, 0.005], Seed(1), stop)?;
            Ok(nested.points().clone())
        },
        &|stop| variable_poisson_disk_cancellable(plane, &ramp, &options, Seed(1), stop),
    ];
    for make in makers {
        let n_calls = cancelled_at(usize::MAX, make);
        let n_points = make(&|| false).unwrap().len();
        // A thousand points take less than a millisecond.
        assert!(
            n_calls * 2000 > n_points,
            "{n_calls} calls, {n_points} points"
        );
        for last in (0..n_calls).step_by(n_calls / 12) {
            let n_calls = cancelled_at(last, make);
            // Each thread may have called once more before it was notified.
            assert!(
                n_calls <= last + parallel::n_threads() + 1,
                "{n_calls} from {last} on"
            );
        }
    }
}
