//! Tests every sampling method at single positions against the oracle.

use super::oracle::brute_force;
use dapple_raster::{Raster, Window};
use dapple_worley::{
    Combination, Dimensions, Feature, FeatureView, POSITION_STEP, Plane, Space, Vector, Worley,
    WorleyError,
};
use glam::DVec2;

pub(super) const RANKS: [Combination; 4] = [
    Combination::F1,
    Combination::F2,
    Combination::F3,
    Combination::F4,
];

/// Width of a pixel, in cells.
const PIXEL: f64 = 1.0 / 64.0;

/// Returns the four nearest points of a position. All sampling methods must agree on them: one position, many
/// positions, a window of features, and windows of values.
///
/// The position is a multiple of 2^-21 below 2^31, or of 2^-7, so that the window can have it as a pixel center.
pub(super) fn sample_in_every_way<const N: usize>(
    worley: &Worley<N>,
    at: [f64; N],
) -> Result<[Feature<Vector<N>>; 4], WorleyError>
where
    Dimensions: Space<N>,
{
    let at = Vector::<N>::from(at);
    let expected = worley.sample::<4>(at);
    let nothing = Feature {
        distance: -1.0,
        vector: [0.0; N].into(),
        id: 1,
    };
    let mut many = [[nothing; 4]; 2];
    worley.sample_many(&[at; 2], &mut many)?;
    assert_eq!(many, [expected; 2], "many positions: {worley:?} at {at:?}");

    let (plane, window) = window_about::<N>(at.into());
    assert_eq!(
        plane.position(window.position(2, 1)),
        at,
        "the pixel center is rounded"
    );
    let rendered = render_features(worley, &plane, &window, [2, 1])?;
    assert_eq!(
        rendered, expected,
        "a window of features: {worley:?} at {at:?}"
    );
    for (rank, combination) in RANKS.into_iter().enumerate() {
        let mut values = Raster::filled(window.size, -1.0)?;
        let texture = worley.combine(combination);
        texture.render_plane(&plane, &window, values.view_mut())?;
        assert_eq!(
            values.row(1)[2].to_bits(),
            expected[rank].distance.to_bits(),
            "a window of F{}: {worley:?} at {at:?}",
            rank + 1
        );
    }
    Ok(expected)
}

/// Returns a window of 5 × 3 pixels around a position.
fn window_about<const N: usize>(at: [f64; N]) -> (Plane<N>, Window)
where
    Dimensions: Space<N>,
{
    let mut origin = at;
    origin[..2].fill(0.0);
    let window = Window {
        origin: (DVec2::new(at[0], at[1]) - DVec2::new(2.5, 1.5) * PIXEL).into(),
        pixel: [PIXEL; 2],
        first: [0, 0],
        size: [5, 3],
        scale: [1.0; 2],
    };
    (Plane::slice(origin.into()), window)
}

/// Returns the four nearest points of one pixel of a rendered window.
fn render_features<const N: usize>(
    worley: &Worley<N>,
    plane: &Plane<N>,
    window: &Window,
    [column, row]: [u32; 2],
) -> Result<[Feature<Vector<N>>; 4], WorleyError>
where
    Dimensions: Space<N>,
{
    let mut distances = [(); 4].map(|()| Raster::filled(window.size, -1.0).unwrap());
    let mut vectors = [(); 4].map(|()| Raster::filled(window.size, [0.0; N]).unwrap());
    let mut ids = [(); 4].map(|()| Raster::filled(window.size, 1).unwrap());
    let mut views = [(); 4].map(|()| FeatureView::default());
    let rasters = distances.iter_mut().zip(&mut vectors).zip(&mut ids);
    for (view, ((distance, vector), id)) in views.iter_mut().zip(rasters) {
        view.distance = Some(distance.view_mut());
        view.vector = Some(vector.view_mut());
        view.id = Some(id.view_mut());
    }
    worley.render_features(plane, window, views)?;
    let pixel = column as usize;
    Ok([0, 1, 2, 3].map(|rank: usize| Feature {
        distance: distances[rank].row(row)[pixel],
        vector: vectors[rank].row(row)[pixel].map(f64::from).into(),
        id: ids[rank].row(row)[pixel],
    }))
}

/// Checks four nearest points against the oracle, which searches all cells within `reach`.
pub(super) fn agrees_with_oracle<const N: usize>(
    worley: &Worley<N>,
    at: [f64; N],
    reach: i64,
    found: &[Feature<Vector<N>>; 4],
) where
    Dimensions: Space<N>,
{
    let expected = brute_force(worley, at, reach);
    assert!(
        expected.len() > 4 && expected[4].0 < reach as f64,
        "the oracle does not look far enough: {worley:?} at {at:?}"
    );
    // Keys are rounded a few times, and their roots once; powers are good to about 1e-6. So the order of two points
    // is known only if they are further apart than both errors.
    let is_apart =
        |rank: usize| expected[rank + 1].0 - expected[rank].0 > 4e-6 * expected[rank + 1].0;
    for (rank, feature) in found.iter().enumerate() {
        let (distance, id) = expected[rank];
        assert!(
            (f64::from(feature.distance) - distance).abs() <= 2e-6 * distance,
            "F{} of {worley:?} at {at:?}: {} for {distance}",
            rank + 1,
            feature.distance
        );
        if is_apart(rank) && (rank == 0 || is_apart(rank - 1)) {
            assert_eq!(feature.id, id, "F{} of {worley:?} at {at:?}", rank + 1);
        }
        leads_to_its_point(worley, at, feature);
    }
}

/// Checks that the vector from a feature point starts exactly at a point with the feature's id.
fn leads_to_its_point<const N: usize>(
    worley: &Worley<N>,
    at: [f64; N],
    feature: &Feature<Vector<N>>,
) where
    Dimensions: Space<N>,
{
    let vector: [f64; N] = feature.vector.into();
    // Longer vectors are rounded.
    if vector.iter().any(|part| part.abs() >= 8.0) {
        return;
    }
    let corner = at.map(f64::floor);
    let local: [f64; N] = core::array::from_fn(|axis| {
        // A position is rounded down to steps.
        let steps = ((at[axis] - corner[axis]) / f64::from(POSITION_STEP)).floor();
        steps * f64::from(POSITION_STEP) - vector[axis]
    });
    let cell = core::array::from_fn(|axis| corner[axis] as i64 + local[axis].floor() as i64);
    let offset: [f64; N] = local.map(|part| part - part.floor());
    let points = worley.cell_points(cell);
    let is_there = points
        .iter()
        .any(|point| point.id == feature.id && point.offset.into() == offset);
    assert!(
        is_there,
        "no point begins the way {feature:?} to {at:?}: {worley:?}"
    );
}

/// Returns the search distance of the oracle, in cells, at which it misses one of the five nearest points with a
/// probability below 10^-7. Within this distance 30 points are expected, in the metric with the smallest balls.
pub(super) fn reach_of<const N: usize>(worley: &Worley<N>) -> Result<i64, WorleyError>
where
    Dimensions: Space<N>,
{
    let manhattan_ball = [1.0, 2.0, 2.0, 4.0 / 3.0, 2.0 / 3.0][N];
    let volume = 30.0 / worley.scatter().mean()?;
    // However dense the cells are on average, those of a short period may have one point each.
    Ok((libm::pow(volume / manhattan_ball, 1.0 / N as f64).ceil() as i64 + 1).max(4))
}
