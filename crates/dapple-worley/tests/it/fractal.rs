//! Tests of fractal sums: sampling methods, oracle, gradients, periods and ranges.

use super::oracle::{METRICS, position};
use dapple_hash::Seed;
use dapple_raster::{Field, Raster, Window};
use dapple_worley::{
    Cellular, CellularFractal, Combination, Dimensions, Metric, OctaveSeeds, Octaves, Plane,
    Scatter, Space, Vector, Worley, WorleyError, WorleyErrorKind,
};
use glam::DVec2;

const ODD: Octaves = Octaves {
    count: 4,
    lacunarity: 2.7,
    gain: -0.6,
    seeds: OctaveSeeds::Own,
};

/// Returns windows with large and small pixels, near the origin and far from it, and flipped.
fn windows() -> [Window; 5] {
    let window = |origin: [f64; 2], pixel: [f64; 2]| Window {
        origin,
        pixel,
        first: [-3, 5],
        size: [67, 35],
        scale: [1.0; 2],
    };
    [
        window([0.3, -0.7], [1.0 / 64.0, 1.0 / 64.0]),
        window([0.0, 0.0], [0.11, -0.09]),
        window([1e9, -1e9], [1e-3, 0.3]),
        window([-1e5, 77.0], [2.3, 1.7]),
        window([1e12, 5.0], [1e-7, 40.0]),
    ]
}

fn render_equals_value<const N: usize>(
    fractal: &CellularFractal<N>,
    plane: &Plane<N>,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for window in windows() {
        let mut values = Raster::filled(window.size, -1.0)?;
        fractal.render_plane(plane, &window, values.view_mut())?;
        for (column, row) in (0..35).flat_map(|row| (0..67).map(move |column| (column, row))) {
            let at = plane.position(window.position(column, row));
            assert_eq!(
                values.row(row)[column as usize].to_bits(),
                fractal.value(at).to_bits(),
                "{at:?} in {window:?}"
            );
        }
    }
    Ok(())
}

#[test]
fn fractal_render_equals_value_bit_for_bit_in_the_plane() -> Result<(), WorleyError> {
    let plane = Plane::default();
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        let worley = Worley::<2>::new(Seed(101)).with_metric(metric)?;
        let texture = worley.combine(Combination::F2_MINUS_F1);
        render_equals_value(&texture.fractal(Octaves::default())?, &plane)?;
        let ranged = worley
            .combine(Combination::TWO_F3_MINUS_F2_MINUS_F1)
            .with_range([-0.3, 1.7])?;
        render_equals_value(&ranged.fractal(ODD)?.with_range([0.1, 2.3])?, &plane)?;
    }
    let periodic = Worley::<2>::new(Seed(101)).with_period([Some(3), None])?;
    let fractal = periodic
        .combine(Combination::F4)
        .fractal(Octaves::default())?;
    render_equals_value(&fractal, &plane)?;
    let field = &fractal as &dyn Field;
    let window = windows()[0];
    assert_eq!(
        field.to_raster(&window)?.row(3)[5].to_bits(),
        fractal.value(window.position(5, 3)).to_bits(),
        "the field's door"
    );
    Ok(())
}

#[test]
fn fractal_render_equals_value_bit_for_bit_in_space() -> Result<(), WorleyError> {
    let texture = Worley::<3>::new(Seed(102)).combine(Combination::F1);
    let slice = Plane::slice([0.1, -0.2, 7.3].into());
    render_equals_value(&texture.fractal(Octaves::default())?, &slice)?;
    let standing = Plane {
        origin: [0.5, 0.25, -3.0].into(),
        u: [1.3, 0.0, 0.0].into(),
        v: [0.0, 0.4, -0.7].into(),
    };
    render_equals_value(&texture.fractal(ODD)?, &standing)?;
    let oblique = Plane {
        origin: [0.5, 0.25, -3.0].into(),
        u: [0.8, 0.1, -0.3].into(),
        v: [0.2, 0.9, 0.4].into(),
    };
    render_equals_value(&texture.fractal(ODD)?, &oblique)
}

/// Returns the sum by the paper's formula, in double precision.
fn naive<const N: usize>(
    seed: Seed,
    texture: &Cellular<N>,
    octaves: Octaves,
    combination: Combination,
    at: [f64; N],
) -> f64
where
    Dimensions: Space<N>,
{
    let (mut sum, mut frequency, mut weight) = (0.0, 1.0, 1.0);
    for index in 0..octaves.count {
        let seed = match octaves.seeds {
            OctaveSeeds::Same => seed,
            OctaveSeeds::Own => seed.child("octave", u64::from(index)),
        };
        let octave = texture
            .worley()
            .clone()
            .with_seed(seed)
            .combine(combination);
        let scaled = at.map(|part| part * frequency);
        sum += weight * f64::from(octave.value(Vector::<N>::from(scaled)));
        frequency *= octaves.lacunarity;
        weight *= octaves.gain;
    }
    sum
}

fn sums_are_naive_sums<const N: usize>(n: i64) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for (metric, combination) in METRICS.into_iter().zip(
        [Combination::F1, Combination::F2_MINUS_F1, Combination::F4]
            .into_iter()
            .cycle(),
    ) {
        let seed = Seed(103);
        let texture = Worley::<N>::new(seed)
            .with_metric(metric)?
            .combine(combination);
        for octaves in [Octaves::paper(), ODD] {
            let fractal = texture.fractal(octaves)?;
            for index in 0..n {
                let at = position::<N>(Seed(104), index, 100.0);
                let expected = naive(seed, &texture, octaves, combination, at);
                let found = f64::from(fractal.value(Vector::<N>::from(at)));
                // At most 6 additions of numbers below 4 are rounded to 24 bits.
                assert!(
                    (found - expected).abs() < 4e-6,
                    "{metric:?} {octaves:?} at {at:?}: {found} for {expected}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn fractal_is_the_sum_of_its_octaves() -> Result<(), WorleyError> {
    sums_are_naive_sums::<2>(50)?;
    sums_are_naive_sums::<3>(20)?;
    sums_are_naive_sums::<4>(2)
}

#[test]
fn octaves_with_one_seed_are_one_field_and_others_are_not() -> Result<(), WorleyError> {
    let texture = Worley::<3>::new(Seed(105)).combine(Combination::F1);
    let [same, own] = [Octaves::paper(), Octaves::default()];
    let [same, own] = [texture.fractal(same)?, texture.fractal(own)?];
    // At the origin all octaves have the same center: the weights sum to 2 - 2^-5.
    let center = texture.value([0.0; 3]) * (2.0 - 1.0 / 32.0);
    assert!(
        (same.value([0.0; 3]) - center).abs() < 1e-6,
        "{} for {center}",
        same.value([0.0; 3])
    );
    let differ = (0..50).filter(|&index| {
        let at = position::<3>(Seed(106), index, 100.0);
        same.value(at) != own.value(at)
    });
    assert_eq!(differ.count(), 50, "positions where the sums differ");
    Ok(())
}

fn gradients_are_those_of_differences<const N: usize>(
    octaves: Octaves,
    n: i64,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let texture = Worley::<N>::new(Seed(107)).combine(Combination::F2_MINUS_F1);
    let fractal = texture.fractal(octaves)?.with_range([-0.5, 1.5])?;
    // A power of two, so that the octaves' positions are not rounded; 32 times as much is still a small way.
    let h = 1.0 / 16384.0;
    let mut n_smooth = 0;
    for index in 0..n {
        let at = position::<N>(Seed(108), index, 100.0);
        let at: [f64; N] = at.map(|part| (part / h).round() * h);
        let gradient: [f64; N] = fractal.gradient(Vector::<N>::from(at)).into();
        let mut gap = 0.0;
        for axis in 0..N {
            let value = |way: f64| {
                let mut moved = at;
                moved[axis] += way;
                f64::from(fractal.value(Vector::<N>::from(moved)))
            };
            let difference = (value(h) - value(-h)) / (2.0 * h);
            gap = f64::max(gap, (difference - gradient[axis]).abs());
        }
        // Where a distance has a crease within the difference, or a feature point is near, they disagree. Elsewhere
        // the values are rounded by about 1e-7, over a way of 1e-4.
        n_smooth += i64::from(gap < 0.02);
    }
    assert!(
        n_smooth > n * 8 / 10,
        "only {n_smooth} of {n} gradients agree with differences"
    );
    Ok(())
}

#[test]
fn fractal_gradients_are_those_of_differences() -> Result<(), WorleyError> {
    let own = Octaves {
        count: 3,
        seeds: OctaveSeeds::Own,
        ..Octaves::default()
    };
    gradients_are_those_of_differences::<2>(Octaves::default(), 300)?;
    gradients_are_those_of_differences::<2>(own, 300)?;
    gradients_are_those_of_differences::<3>(own, 200)?;
    gradients_are_those_of_differences::<4>(own, 30)
}

#[test]
fn fractals_repeat_exactly_with_the_period_of_the_first_octave() -> Result<(), WorleyError> {
    for (lacunarity, seeds) in [
        (1.0, OctaveSeeds::Own),
        (2.0, OctaveSeeds::Same),
        (2.0, OctaveSeeds::Own),
        (3.0, OctaveSeeds::Own),
    ] {
        let octaves = Octaves {
            count: 5,
            lacunarity,
            seeds,
            ..Octaves::default()
        };
        let worley = Worley::<3>::new(Seed(109)).with_period([Some(5), None, Some(2)])?;
        let fractal = worley.combine(Combination::F3_MINUS_F2).fractal(octaves)?;
        let mut n_others = 0;
        for index in 0..50 {
            // Multiples of 2^-10, so that 3^4 times as much is not rounded.
            let at = position::<3>(Seed(110), index, 100.0);
            let at = at.map(|part| (part * 1024.0).round() / 1024.0);
            let expected = fractal.value(at);
            for [x, z] in [[5.0, 0.0], [0.0, 2.0], [-500.0, 2000.0], [5e6, -2e6]] {
                let moved = [at[0] + x, at[1], at[2] + z];
                assert_eq!(
                    fractal.value(moved).to_bits(),
                    expected.to_bits(),
                    "{octaves:?}: {at:?} and {moved:?}"
                );
            }
            let others = [[1.0, 0.0], [0.0, 1.0]].map(|[x, z]| [at[0] + x, at[1], at[2] + z]);
            n_others += others
                .iter()
                .filter(|&&at| fractal.value(at) != expected)
                .count();
        }
        // It repeats no more often than that.
        assert_eq!(n_others, 100, "{octaves:?}");
    }
    Ok(())
}

#[test]
fn octaves_repeat_no_more_often_than_the_first() -> Result<(), WorleyError> {
    let seed = Seed(118);
    let period = |cells: u32| [Some(3 * cells), Some(2 * cells)];
    let worley = Worley::<2>::new(seed).with_period(period(1))?;
    let octaves = Octaves {
        count: 4,
        lacunarity: 3.0,
        ..Octaves::paper()
    };
    let fractal = worley.combine(Combination::F1).fractal(octaves)?;
    for index in 0..100 {
        let at = position::<2>(Seed(119), index, 100.0);
        let at = at.map(|part| (part * 1024.0).round() / 1024.0);
        let [mut sum, mut weight] = [0.0, 1.0];
        for cells in [1, 3, 9, 27] {
            let octave = Worley::<2>::new(seed).with_period(period(cells))?;
            let scaled = at.map(|part| part * f64::from(cells));
            sum += weight * f64::from(octave.sample::<1>(scaled)[0].distance);
            weight *= 0.5;
        }
        // Three additions of numbers below 4 are rounded to 24 bits.
        let found = f64::from(fractal.value(at));
        assert!((found - sum).abs() < 2e-6, "{at:?}: {found} for {sum}");
    }
    Ok(())
}

#[test]
fn pictures_of_one_period_fit_together_bit_for_bit() -> Result<(), WorleyError> {
    let worley = Worley::<2>::new(Seed(111)).with_period([Some(4), Some(2)])?;
    let fractal = worley
        .combine(Combination::F2_MINUS_F1)
        .fractal(Octaves::default())?;
    let picture = |origin: DVec2| {
        let window = Window::new(origin, DVec2::new(4.0, 2.0), [128, 64])?;
        fractal.to_raster(&window)
    };
    let expected = picture(DVec2::ZERO)?;
    for origin in [[4.0, 0.0], [-8.0, 6.0], [4e6, -2e6]] {
        assert_eq!(picture(origin.into())?, expected, "{origin:?}");
    }
    Ok(())
}

#[test]
fn bad_octaves_are_refused_with_their_number() -> Result<(), WorleyError> {
    let texture = Worley::<2>::new(Seed(112)).combine(Combination::F1);
    let periodic = texture
        .worley()
        .clone()
        .with_period([Some(1 << 20), None])?;
    let periodic = periodic.combine(Combination::F1);
    let default = Octaves::default();
    let count = |count| Octaves { count, ..default };
    let lacunarity = |lacunarity| Octaves {
        lacunarity,
        ..default
    };
    let gain = |gain| Octaves { gain, ..default };
    for (texture, octaves, what) in [
        (&texture, count(0), "number of octaves"),
        (&texture, count(33), "number of octaves"),
        (&texture, lacunarity(0.5), "lacunarity"),
        (&texture, lacunarity(16.5), "lacunarity"),
        (&texture, lacunarity(f64::NAN), "lacunarity"),
        (&texture, gain(1.5), "gain"),
        (&texture, gain(-1.5), "gain"),
        (&texture, gain(f64::NAN), "gain"),
        (&periodic, lacunarity(1.5), "lacunarity"),
        (&periodic, count(13), "period of an octave"),
    ] {
        let error = texture.fractal(octaves).unwrap_err();
        assert!(
            matches!(error.kind(), WorleyErrorKind::Range { what: found, .. } if *found == what),
            "{octaves:?}: {error}"
        );
    }
    for good in [count(1), count(32), lacunarity(1.0), gain(-1.0), gain(0.0)] {
        assert!(texture.fractal(good).is_ok(), "{good:?}");
    }
    // 2^20 times 2^11 cells fit into 32 bits.
    assert!(periodic.fractal(count(12)).is_ok(), "12 octaves");
    Ok(())
}

#[test]
fn ranges_map_their_ends_to_zero_and_one() -> Result<(), WorleyError> {
    let texture = Worley::<2>::new(Seed(113)).combine(Combination::F2_MINUS_F1);
    let fractal = texture.fractal(Octaves::default())?;
    let [low, high] = [0.25, 0.75];
    let ranged = texture.clone().with_range([low, high])?;
    let ranged_fractal = fractal.clone().with_range([low, high])?;
    for index in 0..100 {
        let at = position::<2>(Seed(114), index, 100.0);
        let map = |value: f32| (value - low) / (high - low);
        // The mapping is one product and one sum, of numbers below 8.
        assert!(
            (ranged.value(at) - map(texture.value(at))).abs() < 2e-6,
            "{at:?}"
        );
        assert!(
            (ranged_fractal.value(at) - map(fractal.value(at))).abs() < 2e-6,
            "{at:?}"
        );
        let slope = ranged.gradient(at) / texture.gradient(at);
        assert!(
            (slope - 2.0).abs().max_element() < 1e-6,
            "{slope} at {at:?}"
        );
    }
    for bad in [
        [1.0, 1.0],
        [2.0, 1.0],
        [f32::NAN, 1.0],
        [0.0, f32::INFINITY],
        [-f32::MAX, f32::MAX],
        [0.0, 1e-45],
    ] {
        assert!(texture.clone().with_range(bad).is_err(), "{bad:?}");
        assert!(fractal.clone().with_range(bad).is_err(), "{bad:?}");
    }
    Ok(())
}

/// Returns the numbers of values below and above a measured range, among `n` new positions.
fn covers_most(range: [f32; 2], n: i64, value: impl Fn([f64; 2]) -> f32) -> [i64; 2] {
    let mut outside = [0; 2];
    for index in 0..n {
        let value = value(position::<2>(Seed(115), index, 1e5));
        outside[0] += i64::from(value < range[0]);
        outside[1] += i64::from(value > range[1]);
    }
    outside
}

#[test]
fn measured_ranges_cover_all_but_one_in_a_thousand_at_either_end() -> Result<(), WorleyError> {
    for (combination, scatter) in [
        (Combination::F2_MINUS_F1, Scatter::default()),
        (Combination::F1, Scatter::Unclamped { density: 2.0 }),
        (Combination::F4, Scatter::Jittered { jitter: 1.0 }),
    ] {
        let texture = Worley::<2>::new(Seed(116))
            .with_scatter(scatter)?
            .combine(combination);
        let range = texture.measure_range(Seed(117), 50_000)?;
        let ends = covers_most(range, 50_000, |at| texture.value(at));
        // 50 at each end, with a standard deviation of 7 for the range and as much for the values.
        assert!(
            ends.iter().all(|end| (15..=85).contains(end)),
            "{combination:?} {scatter:?}: {ends:?} of 50 000 values are outside of {range:?}"
        );
    }
    let fractal = Worley::<2>::new(Seed(116))
        .combine(Combination::F1)
        .fractal(Octaves::default())?;
    let range = fractal.measure_range(Seed(117), 20_000)?;
    let ends = covers_most(range, 20_000, |at| fractal.value(at));
    // 20 at each end, with a standard deviation of 6.3.
    assert!(
        ends.iter().all(|end| (1..=52).contains(end)),
        "the fractal: {ends:?} of 20 000 values are outside of {range:?}"
    );
    assert!(fractal.measure_range(Seed(1), 999).is_err(), "too few");
    assert_eq!(
        fractal.measure_range(Seed(1), 1000)?,
        fractal.measure_range(Seed(1), 1000)?,
        "the same seed"
    );
    Ok(())
}
