//! Tests that windows, sampling methods, SIMD levels and numbers of threads give equal bits.

use super::oracle::{METRICS, SCATTERS, position, vectors};
use super::ways::reach_of;
use dapple_hash::{Seed, hash1, unit_f64};
use dapple_raster::simd::for_every_level;
use dapple_raster::{Raster, Window};
use dapple_worley::{
    Combination, Dimensions, FeatureView, Plane, Space, Vector, Worley, WorleyError,
};
use glam::DVec2;

pub(super) const COMBINATIONS: [Combination; 5] = [
    Combination::F1,
    Combination::F2_MINUS_F1,
    Combination::TWO_F3_MINUS_F2_MINUS_F1,
    Combination::F4,
    Combination::new([0.3, -0.7, 0.0, 1.1]),
];

/// Returns windows with large and small pixels, near the origin and far from it, flipped, and of odd sizes.
pub(super) fn windows() -> Vec<Window> {
    let window = |origin: [f64; 2], pixel: [f64; 2], size: [u32; 2]| Window {
        origin,
        pixel,
        first: [-3, 5],
        size,
        scale: [1.0; 2],
    };
    vec![
        window([0.0, 0.0], [1.0 / 64.0, 1.0 / 64.0], [97, 70]),
        window([0.3, -0.7], [1.0 / 16.0, -1.0 / 15.0], [61, 50]),
        window([1e9, -1e9], [-0.09, 0.13], [70, 67]),
        window([3.1, 1e6], [0.25, 0.25], [50, 37]),
        window([-7.0, 2.0], [0.9, 0.31], [33, 17]),
        window([0.0, 0.0], [17.3, 1e-3], [19, 18]),
        window([1e12, 5.0], [1e-7, 40.0], [17, 3]),
        window([f64::MAX, f64::NAN], [1e300, 1.0], [5, 3]),
        Window {
            scale: [11.7, 0.3],
            ..window([0.3, -0.7], [1.0 / 700.0, 1.0 / 19.0], [75, 66])
        },
    ]
}

/// A combination for each kernel: one, two and up to four nearest points. All of [`COMBINATIONS`] are compared only in
/// 2-D, where a sample takes a tenth of the time.
const DEPTHS: [Combination; 3] = [COMBINATIONS[0], COMBINATIONS[1], COMBINATIONS[4]];

fn ways_agree<const N: usize>(
    worley: &Worley<N>,
    planes: &[Plane<N>],
    combinations: &[Combination],
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for (combination, plane) in combinations
        .iter()
        .flat_map(|c| planes.iter().map(move |p| (c, p)))
    {
        let texture = worley.combine(*combination);
        for window in windows() {
            let mut expected = Raster::filled(window.size, 0.0)?;
            for row in 0..window.size[1] {
                for column in 0..window.size[0] {
                    let at = plane.position(window.position(column, row));
                    expected.view_mut().row_mut(row)[column as usize] = texture.value(at);
                }
            }
            for_every_level(|level| {
                let mut out = Raster::filled(window.size, -1.0).unwrap();
                texture
                    .render_plane(plane, &window, out.view_mut())
                    .unwrap();
                let differ = out.pixels().iter().zip(expected.pixels());
                let differ = differ.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
                assert_eq!(
                    differ,
                    0,
                    "{:?} {:?} {combination:?} {plane:?} {window:?} {level:?}",
                    worley.metric(),
                    worley.scatter()
                );
            });
        }
    }
    Ok(())
}

fn random<const N: usize>(seed: Seed, index: u64) -> Vector<N>
where
    Dimensions: Space<N>,
{
    let unit = |axis| unit_f64(hash1(seed.child("plane", index), [axis as i64], 0));
    Vector::<N>::from(core::array::from_fn(|axis| 2.0 * unit(axis) - 1.0))
}

#[test]
fn render_equals_sample_bit_for_bit_in_the_plane() -> Result<(), WorleyError> {
    for (index, scatter) in SCATTERS.into_iter().enumerate() {
        let worley = Worley::new(Seed(11)).with_scatter(scatter)?;
        let metric = METRICS[index % METRICS.len()];
        let plane = [Plane::default()];
        ways_agree::<2>(&worley, &plane, &COMBINATIONS)?;
        ways_agree::<2>(&worley.with_metric(metric)?, &plane, &COMBINATIONS)?;
    }
    Ok(())
}

#[test]
fn render_equals_sample_bit_for_bit_in_space() -> Result<(), WorleyError> {
    let seed = Seed(12);
    let oblique = Plane {
        origin: random::<3>(seed, 0),
        u: random::<3>(seed, 1),
        v: random::<3>(seed, 2),
    };
    let planes = [Plane::slice([0.1, 0.2, -5.3].into()), oblique];
    for metric in METRICS {
        ways_agree::<3>(&Worley::new(seed).with_metric(metric)?, &planes, &DEPTHS)?;
    }
    let planes = [Plane::slice([0.1, 0.2, -5.3, 1e4].into())];
    ways_agree::<4>(&Worley::new(seed).with_density(1.0)?, &planes, &DEPTHS)
}

fn features_agree<const N: usize>(worley: &Worley<N>, plane: &Plane<N>) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let texture = worley.combine(Combination::new([0.5, -1.0, 0.0, 0.25]));
    for window in windows() {
        let mut distances = [(); 2].map(|()| Raster::filled(window.size, -1.0).unwrap());
        let mut vectors = Raster::filled(window.size, [0.0; N])?;
        let mut ids = [(); 4].map(|()| Raster::filled(window.size, 1).unwrap());
        let mut gradients = Raster::filled(window.size, [0.0; N])?;
        let mut views = [(); 4].map(|()| FeatureView::default());
        for (view, ids) in views.iter_mut().zip(&mut ids) {
            view.id = Some(ids.view_mut());
        }
        let [first, last] = &mut distances;
        views[0].distance = Some(first.view_mut());
        views[3].distance = Some(last.view_mut());
        views[1].vector = Some(vectors.view_mut());
        worley.render_features(plane, &window, views)?;
        texture.render_gradient(plane, &window, gradients.view_mut())?;
        for row in 0..window.size[1] {
            for column in 0..window.size[0] {
                let at = plane.position(window.position(column, row));
                let expected = worley.sample::<4>(at);
                let pixel = column as usize;
                let found =
                    [&distances[0], &distances[1]].map(|raster| raster.row(row)[pixel].to_bits());
                let wanted = [&expected[0], &expected[3]].map(|feature| feature.distance.to_bits());
                assert_eq!(
                    found,
                    wanted,
                    "{:?} {window:?} {pixel} {row}",
                    worley.metric()
                );
                let found = [0, 1, 2, 3].map(|rank: usize| ids[rank].row(row)[pixel]);
                assert_eq!(
                    found,
                    expected.map(|feature| feature.id),
                    "{window:?} {pixel} {row}"
                );
                let bits = |vector: Vector<N>| -> [u64; N] { vector.into().map(f64::to_bits) };
                let vector = Vector::<N>::from(vectors.row(row)[pixel].map(f64::from));
                assert_eq!(
                    bits(vector),
                    bits(expected[1].vector),
                    "{window:?} {pixel} {row}"
                );
                let gradient = Vector::<N>::from(gradients.row(row)[pixel].map(f64::from));
                assert_eq!(
                    bits(gradient),
                    bits(texture.gradient(at)),
                    "{window:?} {pixel} {row}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn rendered_features_and_gradients_are_those_of_samples() -> Result<(), WorleyError> {
    for metric in METRICS {
        features_agree::<2>(
            &Worley::new(Seed(2)).with_metric(metric)?,
            &Plane::default(),
        )?;
    }
    let periodic = Worley::new(Seed(2)).with_period([Some(2), Some(1)])?;
    features_agree::<2>(&periodic, &Plane::default())?;
    features_agree::<2>(
        &Worley::new(Seed(2)).with_scatter(SCATTERS[3])?,
        &Plane::default(),
    )?;
    features_agree::<3>(&Worley::new(Seed(2)), &Plane::slice([0.0, 0.0, 0.7].into()))?;
    features_agree::<4>(
        &Worley::new(Seed(2)),
        &Plane::slice([0.0, 0.0, 0.7, -3.0].into()),
    )
}

fn many_equal_single_ones<const N: usize, const K: usize>(
    worley: &Worley<N>,
    spread: f64,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let mut positions: Vec<Vector<N>> = (0..333)
        .map(|index| Vector::<N>::from(position(Seed(8), index, spread)))
        .collect();
    positions[37] = Vector::<N>::from([f64::NAN; N]);
    positions[99] = Vector::<N>::from([4e18; N]);
    let expected: Vec<_> = positions.iter().map(|&at| worley.sample::<K>(at)).collect();
    for_every_level(|level| {
        let mut found = vec![worley.sample::<K>([0.5; N]); positions.len()];
        worley.sample_many(&positions, &mut found).unwrap();
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let same = found.iter().zip(expected).all(|(a, b)| {
                a == b && a.distance.to_bits() == b.distance.to_bits() || b.distance.is_nan()
            });
            assert!(
                same && (index != 37 || found[0].distance.is_nan()),
                "{:?} {:?} {level:?} at {:?}: {found:?} for {expected:?}",
                worley.metric(),
                worley.scatter(),
                positions[index]
            );
        }
    });
    Ok(())
}

#[test]
fn many_positions_equal_single_ones_bit_for_bit() -> Result<(), WorleyError> {
    for scatter in SCATTERS {
        for metric in METRICS {
            let spread = if scatter == SCATTERS[4] { 1e12 } else { 40.0 };
            let plane = Worley::<2>::new(Seed(4))
                .with_scatter(scatter)?
                .with_metric(metric)?;
            many_equal_single_ones::<2, 4>(&plane, spread)?;
            many_equal_single_ones::<2, 1>(&plane.with_period([Some(5), None])?, spread)?;
        }
        let space = Worley::<3>::new(Seed(4)).with_scatter(scatter)?;
        many_equal_single_ones::<3, 2>(
            &space.with_period([None, Some(3), Some(1)])?,
            spread_of(scatter),
        )?;
    }
    many_equal_single_ones::<4, 3>(&Worley::<4>::new(Seed(4)), 1e3)
}

/// Returns the feature points within `reach` cells as distances, ids and vectors, nearest first. Vectors are computed
/// exactly, and rounded to `f32` once.
fn nearest_of_all<const N: usize>(
    worley: &Worley<N>,
    at: [f64; N],
    reach: i64,
) -> Vec<(f32, u64, [f64; N])>
where
    Dimensions: Space<N>,
{
    let ways = vectors(worley, at, reach).into_iter();
    let mut all: Vec<_> = ways
        .map(|(vector, id)| {
            let vector = vector.map(|part| part as f32);
            (worley.metric().length(vector), id, vector.map(f64::from))
        })
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

#[test]
fn nearest_points_are_those_of_all_points_bit_for_bit() -> Result<(), WorleyError> {
    fn check<const N: usize>(worley: &Worley<N>, n: i64) -> Result<(), WorleyError>
    where
        Dimensions: Space<N>,
    {
        let reach = reach_of(worley)?;
        let positions = (0..n).map(|index| position::<N>(Seed(21), index, 1e4));
        let expected: Vec<_> = positions
            .map(|at| (at, nearest_of_all(worley, at, reach)))
            .collect();
        for_every_level(|level| {
            for (at, all) in &expected {
                for (rank, found) in worley.sample::<4>(*at).iter().enumerate() {
                    let (distance, id, vector) = all[rank];
                    assert_eq!(
                        found.distance.to_bits(),
                        distance.to_bits(),
                        "F{} at {at:?}, {level:?}, {worley:?}",
                        rank + 1
                    );
                    // Of equal distances, one key may be the smaller one.
                    let is_tied = all.iter().filter(|other| other.0 == distance).count() > 1;
                    if !is_tied {
                        let found = (found.id, found.vector.into());
                        assert_eq!(found, (id, vector), "{at:?}, {level:?}, {worley:?}");
                    }
                }
            }
        });
        Ok(())
    }
    for metric in METRICS {
        for scatter in SCATTERS {
            let worley = Worley::<2>::new(Seed(6)).with_scatter(scatter)?;
            check(&worley.with_metric(metric)?, 400)?;
        }
        check(&Worley::<3>::new(Seed(6)).with_metric(metric)?, 200)?;
        check(&Worley::<4>::new(Seed(6)).with_metric(metric)?, 30)?;
    }
    Ok(())
}

fn spread_of(scatter: dapple_worley::Scatter) -> f64 {
    if scatter == SCATTERS[0] { 1e9 } else { 10.0 }
}

#[test]
fn windows_are_crops_bit_for_bit() -> Result<(), WorleyError> {
    let texture = Worley::<2>::new(Seed(3)).combine(Combination::F2_MINUS_F1);
    let whole = Window::new(DVec2::new(-3.0, 1e5), DVec2::splat(7.3), [700, 200])?;
    let mut all = Raster::filled(whole.size, 0.0)?;
    texture.render_plane(&Plane::default(), &whole, all.view_mut())?;
    for (first, size) in [
        ([1, 3], [77, 60]),
        ([480, 131], [220, 69]),
        ([699, 199], [1, 1]),
    ] {
        let part = whole.crop(first.map(i64::from), size)?;
        let mut pixels = Raster::filled(size, 0.0)?;
        texture.render_plane(&Plane::default(), &part, pixels.view_mut())?;
        assert_eq!(pixels, all.crop(first, size)?, "{first:?}");
    }
    Ok(())
}
