//! Tests far from the origin: images are as sharp as near it, and positions out of range give NaN.

use super::oracle::{METRICS, SCATTERS};
use super::ways::{RANKS, agrees_with_oracle, sample_in_every_way};
use dapple_hash::Seed;
use dapple_raster::{Field, Raster, Window};
use dapple_worley::{
    Combination, Dimensions, FeatureView, Octaves, Plane, Radial, RadialCells, Space, Vector,
    Worley, WorleyError,
};
use glam::DVec3;

/// Walks along the first axis in steps of 1/64 of a cell, and checks that F1 to F4 change at every step.
fn steps_are_told_apart<const N: usize>(
    worley: &Worley<N>,
    start: [f64; N],
    n: u32,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let sample = |index: u32| {
        let mut at = start;
        at[0] += f64::from(index) / 64.0;
        worley
            .sample::<4>(Vector::<N>::from(at))
            .map(|feature| feature.distance)
    };
    let mut before = sample(0);
    for index in 1..n {
        let here = sample(index);
        assert_ne!(
            here[0], before[0],
            "step {index} from {start:?} cannot be told apart"
        );
        for (here, before) in here.iter().zip(before) {
            // Two distances of up to 4 cells are rounded to 24 bits.
            assert!(
                (here - before).abs() <= 1.0 / 64.0 + 1e-6,
                "step {index} from {start:?} jumps from {before} to {here}"
            );
        }
        before = here;
    }
    Ok(())
}

#[test]
fn steps_far_away_can_be_told_apart() -> Result<(), WorleyError> {
    for far in [0.0, 1e6, 1e9, -1e9, 1e12, -1e12] {
        steps_are_told_apart::<2>(&Worley::new(Seed(81)), [far, -far + 0.375], 4000)?;
        steps_are_told_apart::<3>(&Worley::new(Seed(81)), [far, 2.0 * far, 0.5 - far], 2000)?;
        steps_are_told_apart::<4>(&Worley::new(Seed(81)), [far, 0.25, far, -far], 300)?;
    }
    Ok(())
}

#[test]
fn ways_agree_far_away() -> Result<(), WorleyError> {
    for (metric, scatter) in METRICS.iter().flat_map(|&m| SCATTERS.map(|s| (m, s))) {
        let worley = Worley::<2>::new(Seed(82))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        for (index, far) in (0..).zip([1e9, -1e9, 1e12, -1e12]) {
            let at = [far + 0.125 * f64::from(index), 0.75 - far];
            let found = sample_in_every_way(&worley, at)?;
            agrees_with_oracle(&worley, at, 11, &found);
        }
    }
    Ok(())
}

#[test]
fn pattern_far_away_is_as_precise_as_near_the_origin() -> Result<(), WorleyError> {
    // With a period both show the same points. At 2^39 the pixels are still multiples of the last bit.
    let far = (1_u64 << 39) as f64;
    for metric in METRICS {
        let worley = Worley::<2>::new(Seed(83)).with_metric(metric)?;
        let worley = worley.with_period([Some(8), Some(4)])?;
        for combination in RANKS {
            let texture = worley.combine(combination);
            let mut pictures = Vec::new();
            for origin in [[0.5, -1.25], [far + 0.5, -far - 1.25]] {
                let window = Window {
                    origin,
                    pixel: [1.0 / 64.0, 1.0 / 32.0],
                    first: [0, 0],
                    size: [70, 50],
                    scale: [1.0; 2],
                };
                let mut values = Raster::filled(window.size, -1.0)?;
                texture.render(&window, values.view_mut())?;
                pictures.push(values.map(|value| value.to_bits()));
            }
            assert_eq!(pictures[0], pictures[1], "{metric:?} {combination:?}");
        }
    }
    Ok(())
}

/// Returns positions that are out of range along one axis, and valid along the others.
fn positions_without_a_place<const N: usize>() -> Vec<[f64; N]> {
    let bad = [
        f64::NAN,
        -f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        -1e300,
        // The first number beyond 2^62.
        ((1_u64 << 62) + 1024) as f64,
        -(((1_u64 << 62) + 1024) as f64),
    ];
    let mut positions = vec![[f64::NAN; N], [f64::INFINITY; N], [1e19; N]];
    for bad in bad {
        for axis in 0..N {
            let mut position = [0.3; N];
            position[axis] = bad;
            positions.push(position);
        }
    }
    positions
}

fn nothing_has_a_value<const N: usize>() -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for metric in METRICS {
        let worley = Worley::<N>::new(Seed(84)).with_metric(metric)?;
        let varying = worley.clone().with_varying_density(|at| at.into()[0]);
        let periodic = worley.clone().with_period([Some(3); N])?;
        for (worley, at) in [&worley, &varying, &periodic]
            .into_iter()
            .flat_map(|worley| {
                positions_without_a_place::<N>()
                    .into_iter()
                    .map(move |at| (worley, at))
            })
        {
            let position = Vector::<N>::from(at);
            let good = worley.sample::<4>([0.5; N]);
            let mut many = [good; 3];
            worley.sample_many(&[[0.5; N].into(), position, [0.5; N].into()], &mut many)?;
            assert_eq!([many[0], many[2]], [good; 2], "the neighbors of {at:?}");
            for feature in worley.sample::<4>(position).into_iter().chain(many[1]) {
                assert!(feature.distance.is_nan(), "{at:?}: {feature:?}");
                let vector: [f64; N] = feature.vector.into();
                assert!(
                    vector.iter().all(|part| part.is_nan()),
                    "{at:?}: {feature:?}"
                );
                assert_eq!(feature.id, 0, "{at:?}: {feature:?}");
            }
            let texture = worley.combine(Combination::F2_MINUS_F1);
            assert!(texture.value(position).is_nan(), "{at:?}");
            let gradient: [f64; N] = texture.gradient(position).into();
            assert!(
                gradient.iter().all(|part| part.is_nan()),
                "{at:?}: {gradient:?}"
            );
            assert!(worley.edge_distance(position).is_nan(), "{at:?}");
            assert!(worley.sphere_radius(position).is_nan(), "{at:?}");
            assert!(worley.smooth_f1(position, 0.5)?.is_nan(), "{at:?}");
            let fractal = texture.fractal(Octaves::default())?;
            assert!(fractal.value(position).is_nan(), "{at:?}");
            let gradient: [f64; N] = fractal.gradient(position).into();
            assert!(
                gradient.iter().all(|part| part.is_nan()),
                "{at:?}: {gradient:?}"
            );
        }
    }
    Ok(())
}

#[test]
fn positions_without_a_place_have_no_value_from_any_door() -> Result<(), WorleyError> {
    nothing_has_a_value::<2>()?;
    nothing_has_a_value::<3>()?;
    nothing_has_a_value::<4>()
}

#[test]
fn radial_positions_that_are_not_finite_have_no_value() -> Result<(), WorleyError> {
    let cells = RadialCells {
        around: 7,
        polar: 3.0,
        radial: 1.0,
    };
    let radial = Radial::new(Worley::new(Seed(84)).combine(Combination::F1), cells)?;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let at = DVec3::select(axis.cmpgt(DVec3::ZERO), DVec3::splat(bad), DVec3::ONE);
            assert!(radial.value(at).is_nan(), "{at}: {}", radial.value(at));
        }
    }
    Ok(())
}

/// Returns windows that are completely or partly out of range.
fn windows_without_a_place() -> Vec<Window> {
    let edge = (1_u64 << 62) as f64;
    let window = |origin: [f64; 2], pixel: [f64; 2], first: [i64; 2]| Window {
        origin,
        pixel,
        first,
        size: [37, 5],
        scale: [1.0; 2],
    };
    vec![
        window([f64::NAN, 0.0], [0.1, 0.1], [0, 0]),
        window([0.0, f64::NAN], [0.1, 0.1], [0, 0]),
        window([f64::INFINITY, f64::NEG_INFINITY], [0.1, 0.1], [0, 0]),
        window([0.0, 0.0], [f64::NAN, 1.0], [0, 0]),
        window([0.0, 0.0], [1.0, f64::INFINITY], [-2, -2]),
        window([0.0, 0.0], [1e300, 1e300], [-9, -2]),
        window([edge - 16.0 * 1024.0, 0.0], [1024.0, 0.1], [0, 0]),
        window([0.0, -edge + 2048.0], [0.1, -1024.0], [0, 0]),
        // From one end of all places to the other, and beyond.
        window([0.0, 0.0], [edge / 16.0, edge / 2.0], [-18, -2]),
        window([0.5, 0.5], [0.1, 0.1], [i64::MAX - 20, i64::MIN]),
    ]
}

fn windows_hold_what_samples_give<const N: usize>(worley: &Worley<N>) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let texture = worley.combine(Combination::TWO_F3_MINUS_F2_MINUS_F1);
    let fractal = texture.fractal(Octaves {
        count: 3,
        ..Octaves::default()
    })?;
    let plane = Plane::default();
    let mut n_without = 0;
    for window in windows_without_a_place() {
        let mut values = [(); 2].map(|()| Raster::filled(window.size, -1.0).unwrap());
        let mut distances = Raster::filled(window.size, -1.0)?;
        let mut vectors = Raster::filled(window.size, [-1.0; N])?;
        let mut ids = Raster::filled(window.size, 1)?;
        let mut gradients = Raster::filled(window.size, [-1.0; N])?;
        texture.render_plane(&plane, &window, values[0].view_mut())?;
        fractal.render_plane(&plane, &window, values[1].view_mut())?;
        texture.render_gradient(&plane, &window, gradients.view_mut())?;
        let view = FeatureView {
            distance: Some(distances.view_mut()),
            vector: Some(vectors.view_mut()),
            id: Some(ids.view_mut()),
            ..FeatureView::default()
        };
        worley.render_features(&plane, &window, [view])?;
        for (column, row) in (0..5).flat_map(|row| (0..37).map(move |column| (column, row))) {
            let at = plane.position(window.position(column, row));
            let pixel = column as usize;
            let [feature] = worley.sample::<1>(at);
            n_without += u32::from(feature.distance.is_nan());
            let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
            let same_parts = |a: [f32; N], b: Vector<N>| {
                let b: [f64; N] = b.into();
                a.iter().zip(b).all(|(&a, b)| same(a, b as f32))
            };
            assert!(
                same(values[0].row(row)[pixel], texture.value(at)),
                "{at:?} {window:?}"
            );
            assert!(
                same(values[1].row(row)[pixel], fractal.value(at)),
                "{at:?} {window:?}"
            );
            assert!(
                same(distances.row(row)[pixel], feature.distance),
                "{at:?} {window:?}"
            );
            assert!(
                same_parts(vectors.row(row)[pixel], feature.vector),
                "{at:?} {window:?}"
            );
            assert_eq!(ids.row(row)[pixel], feature.id, "{at:?} {window:?}");
            assert!(
                same_parts(gradients.row(row)[pixel], texture.gradient(at)),
                "{at:?} {window:?}"
            );
        }
    }
    assert!(n_without > 900, "only {n_without} pixels have no place");
    Ok(())
}

#[test]
fn windows_without_a_place_hold_what_samples_give() -> Result<(), WorleyError> {
    let worley = Worley::<2>::new(Seed(85));
    windows_hold_what_samples_give(&worley)?;
    windows_hold_what_samples_give(&worley.clone().with_period([Some(3), None])?)?;
    windows_hold_what_samples_give(&worley.with_varying_density(|at| at.x))?;
    windows_hold_what_samples_give(&Worley::<3>::new(Seed(85)))
}

#[test]
fn coordinates_up_to_the_farthest_have_a_place() -> Result<(), WorleyError> {
    let edge = (1_u64 << 62) as f64;
    for metric in METRICS {
        let worley = Worley::<2>::new(Seed(86)).with_metric(metric)?;
        for at in [[edge, -edge], [-edge, edge], [edge - 512.0, 0.5]] {
            let found = worley.sample::<4>(at);
            let mut many = [worley.sample::<4>([0.0, 0.0])];
            worley.sample_many(&[at], &mut many)?;
            assert_eq!(many[0], found, "{at:?}");
            agrees_with_oracle(&worley, at, 5, &found);
        }
    }
    Ok(())
}
