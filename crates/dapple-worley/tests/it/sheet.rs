//! Tests of images for which points are culled, and of slices that are rendered together.

use dapple_hash::Seed;
use dapple_raster::{Field, Raster, RasterErrorKind, Window};
use dapple_worley::{
    Combination, Dimensions, FeatureView, Metric, Octaves, Plane, Scatter, Space, Vector, Worley,
    Worley2, Worley3, Worley4, WorleyError,
};
use glam::{DVec2, DVec3, DVec4};

/// Returns a position that is about equally far from its two nearest points. It is on a line from `at` to a position
/// with another nearest point.
pub(super) fn middle_ground<const N: usize>(worley: &Worley<N>, at: [f64; N]) -> [f64; N]
where
    Dimensions: Space<N>,
{
    let nearest = |at: [f64; N]| worley.sample::<1>(at)[0].id;
    let id = nearest(at);
    let mut ways = (1..).map(|step| f64::from(step) / 16.0);
    let mut there = ways
        .find(|&way| nearest(along(at, way)) != id)
        .expect("some point of all is another one");
    let mut here = 0.0;
    for _ in 0..60 {
        let half = f64::midpoint(here, there);
        if nearest(along(at, half)) == id {
            here = half;
        } else {
            there = half;
        }
    }
    along(at, here)
}

/// Returns the position `way` away along the first axis, and half as far along the second.
fn along<const N: usize>(mut at: [f64; N], way: f64) -> [f64; N] {
    at[0] += way;
    at[1] += way / 2.0;
    at
}

fn picture_equals_value<const N: usize>(
    worley: &Worley<N>,
    combination: Combination,
    plane: &Plane<N>,
    window: &Window,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let texture = worley.combine(combination);
    let mut picture = Raster::filled(window.size, -1.0)?;
    texture.render_plane(plane, window, picture.view_mut())?;
    for row in 0..window.size[1] {
        for (column, &value) in (0..).zip(picture.row(row)) {
            let position = plane.position(window.position(column, row));
            assert_eq!(
                value.to_bits(),
                texture.value(position).to_bits(),
                "{combination:?} at {position:?} of {window:?}"
            );
        }
    }
    Ok(())
}

/// Compares windows with single values around positions that are nearly equally far from two points. The windows are
/// from a whole cell down to a few steps wide.
fn hairs_are_split_right<const N: usize>() -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let combinations = [Combination::F1, Combination::F2, Combination::F2_MINUS_F1];
    for seed in 0..6 {
        let metric = [Metric::Euclidean, Metric::Manhattan][seed as usize % 2];
        let worley = Worley::<N>::new(Seed(seed)).with_metric(metric)?;
        let at = middle_ground(&worley, [0.3 + seed as f64; N]);
        let mut origin = at;
        origin[..2].fill(0.0);
        let plane = Plane::slice(Vector::<N>::from(origin));
        for zoom in [6, 9, 12, 16, 20] {
            let pixel = DVec2::new(1.0, 1.25) / f64::from(1 << zoom);
            let window = Window {
                origin: (DVec2::new(at[0], at[1]) - 24.0 * pixel).into(),
                pixel: pixel.into(),
                first: [0, 0],
                size: [50, 47],
                scale: [1.0; 2],
            };
            for combination in combinations {
                picture_equals_value(&worley, combination, &plane, &window)?;
            }
        }
    }
    Ok(())
}

#[test]
fn hairs_are_split_right_in_the_plane() -> Result<(), WorleyError> {
    hairs_are_split_right::<2>()
}

#[test]
fn hairs_are_split_right_in_space() -> Result<(), WorleyError> {
    hairs_are_split_right::<3>()
}

/// Returns more planes than are rendered together: some close to each other, some not, some rotated, and one twice.
fn planes() -> Vec<Plane<3>> {
    let slice = |x: f64, z: f64| Plane::slice(DVec3::new(x, 0.5, z));
    let mut planes: Vec<_> = (0..18)
        .map(|step| slice(0.0, f64::from(step) / 16.0))
        .collect();
    planes.extend([slice(0.0, 40.0), slice(3.25, 40.0), slice(3.25, 40.0)]);
    planes.push(Plane {
        v: DVec3::Z,
        ..slice(3.25, 40.0)
    });
    planes.push(Plane {
        u: DVec3::new(0.6, 0.8, 0.0),
        ..slice(3.25, 40.0)
    });
    planes
}

#[test]
fn slices_are_pictures_of_their_planes_bit_for_bit() -> Result<(), WorleyError> {
    let worley = Worley3::new(Seed(3));
    let texture = worley.combine(Combination::F2_MINUS_F1);
    let fractal = texture.fractal(Octaves {
        count: 2,
        ..Octaves::default()
    })?;
    let planes = planes();
    // Several blocks wide and bands high; large cells and small ones.
    for (size, extent) in [([530, 70], 12.0), ([40, 70], 9.0)] {
        let window = Window::new(DVec2::ZERO, DVec2::splat(extent), size)?;
        let [mut values, mut sums] = [(); 2]
            .map(|()| Raster::filled([size[0], size[1] * planes.len() as u32], -1.0).unwrap());
        let stack = planes.iter().copied();
        let views = values.view_mut().bands(size[1]);
        texture.render_slices(&window, stack.clone().zip(views).collect())?;
        let views = sums.view_mut().bands(size[1]);
        fractal.render_slices(&window, stack.zip(views).collect())?;
        for (plane, first) in planes.iter().zip((0..).step_by(size[1] as usize)) {
            let [mut value, mut sum] = [(); 2].map(|()| Raster::filled(size, -1.0).unwrap());
            texture.render_plane(plane, &window, value.view_mut())?;
            fractal.render_plane(plane, &window, sum.view_mut())?;
            for row in 0..size[1] {
                assert_eq!(values.row(first + row), value.row(row), "{plane:?}");
                assert_eq!(sums.row(first + row), sum.row(row), "{plane:?}");
            }
        }
    }
    Ok(())
}

/// Renders slices that descend along the third axis, then ascend along the fourth, close enough to share their
/// candidates.
#[test]
fn slices_of_four_dimensions_equal_values_bit_for_bit() -> Result<(), WorleyError> {
    let slice = |z: f64, w: f64| Plane::slice(DVec4::new(0.5, -2.0, z, w));
    let steps = (0..5).map(|step| f64::from(step) / 32.0);
    let downward = steps.clone().map(|step| slice(1.0 - step, 0.25));
    let planes: Vec<_> = downward
        .chain(steps.map(|step| slice(0.75, 0.25 + step)))
        .collect();
    let window = Window::new(DVec2::ZERO, DVec2::new(1.25, 1.0), [40, 33])?;
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        // Few points, so that neighborhoods must grow.
        let worley = Worley4::new(Seed(5)).with_scatter(Scatter::Unclamped { density: 0.25 })?;
        let texture = worley
            .with_metric(metric)?
            .combine(Combination::F3_MINUS_F1);
        let mut values = Raster::filled([40, 33 * planes.len() as u32], -1.0)?;
        let views = values.view_mut().bands(33);
        texture.render_slices(&window, planes.iter().copied().zip(views).collect())?;
        for (plane, first) in planes.iter().zip((0..).step_by(33)) {
            for (column, row) in (0..33).flat_map(|row| (0..40).map(move |column| (column, row))) {
                let expected = texture.value(plane.position(window.position(column, row)));
                let found = values.row(first + row)[column as usize];
                assert_eq!(
                    found.to_bits(),
                    expected.to_bits(),
                    "{metric:?} {plane:?} {column}, {row}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn slices_of_another_size_are_refused_before_anything_is_drawn() -> Result<(), WorleyError> {
    let texture = Worley2::new(Seed(3)).combine(Combination::F1);
    let fractal = texture.fractal(Octaves::default())?;
    let window = Window::new(DVec2::ZERO, DVec2::ONE, [8, 8])?;
    let mut right = Raster::filled([8, 8], -1.0)?;
    let mut wrong = Raster::filled([8, 7], -1.0)?;
    let planes = [Plane::default(); 2];
    for draws_fractal in [false, true] {
        let views = [right.view_mut(), wrong.view_mut()];
        let slices = planes.into_iter().zip(views).collect();
        let result = if draws_fractal {
            fractal.render_slices(&window, slices)
        } else {
            texture.render_slices(&window, slices)
        };
        assert!(matches!(
            result.unwrap_err().kind(),
            RasterErrorKind::SizeMismatch { .. }
        ));
        assert!(right.pixels().iter().all(|&value| value == -1.0));
    }
    texture.render_slices(&window, Vec::new())?;
    Ok(())
}

/// Renders cells from less than a pixel to wider than a block of pixels.
#[test]
fn wide_pictures_hold_what_values_are_at_any_size_of_cells() -> Result<(), WorleyError> {
    let size = [1100, 6];
    let metrics = [Metric::Euclidean, Metric::Chebyshev, Metric::Minkowski(3.0)];
    for (metric, density) in metrics.into_iter().zip([4.0, 0.1, 4.0]) {
        let scatter = Scatter::Unclamped { density };
        let worley = Worley2::new(Seed(9)).with_scatter(scatter)?;
        let worley = worley.with_metric(metric)?;
        let mut pixels_per_cell = 0.31;
        while pixels_per_cell < 400.0 {
            let extent = DVec2::new(f64::from(size[0]), f64::from(size[1])) / pixels_per_cell;
            let window = Window::new(DVec2::new(-0.7, 3.2), extent, size)?;
            for combination in [
                Combination::F1,
                Combination::F2_MINUS_F1,
                Combination::F3_MINUS_F1,
            ] {
                picture_equals_value(&worley, combination, &Plane::default(), &window)?;
            }
            pixels_per_cell *= 1.7;
        }
    }
    Ok(())
}

/// Compares rendered planes and windows of extreme size and orientation with single values.
#[test]
fn odd_planes_and_windows_hold_what_values_are() -> Result<(), WorleyError> {
    let up = |v: DVec3| Plane {
        v,
        ..Plane::<3>::default()
    };
    let nearly_everything = Window::new(DVec2::splat(-4.6e18), DVec2::splat(9.2e18), [20, 18])?;
    let worley = Worley3::new(Seed(1));
    for v in [DVec3::Y, DVec3::new(0.0, 1.0, 1.0)] {
        picture_equals_value(&worley, Combination::F1, &up(v), &nearly_everything)?;
    }
    // Rows that lie upon one another, but for those whose coordinate is infinite.
    let beyond_numbers = Window::new(DVec2::Y * 1e308, DVec2::new(1.0, 1e308), [4, 4])?;
    let texture = worley.combine(Combination::F1);
    let mut picture = Raster::filled([4, 4], -1.0)?;
    texture.render_plane(&up(DVec3::ZERO), &beyond_numbers, picture.view_mut())?;
    assert!(picture.row(0).iter().all(|value| value.is_finite()));
    assert!(picture.row(3).iter().all(|value| value.is_nan()));
    Ok(())
}

/// Checks that signed zeros and NaN have the same bits in images as in single values.
#[test]
fn values_of_nothing_have_the_same_bits_in_pictures() -> Result<(), WorleyError> {
    let window = Window::new(DVec2::ZERO, DVec2::ONE, [20, 20])?;
    let nothing = Worley2::new(Seed(1)).combine(Combination::new([0.0; 4]));
    let nothing = nothing.with_range([1e-30, 1e38])?;
    let picture = nothing.to_raster(&window)?;
    let value = nothing.value(window.position(3, 3));
    assert_eq!(picture.row(3)[3].to_bits(), value.to_bits());

    // Hardly any cell has a point, so that most positions have neither a nearest nor a second one.
    let empty = Worley2::new(Seed(1))
        .with_scatter(Scatter::Unclamped {
            density: 1.0 / 64.0,
        })?
        .with_period([Some(1); 2])?;
    let sums = empty
        .combine(Combination::F2_MINUS_F1)
        .fractal(Octaves::default())?;
    let picture = sums.to_raster(&window)?;
    for (row, column) in [(0, 0), (3, 3), (19, 19)] {
        let value = sums.value(window.position(column, row));
        assert_eq!(
            picture.row(row)[column as usize].to_bits(),
            value.to_bits(),
            "{value}"
        );
    }
    Ok(())
}

/// Checks that features are found if one point is the nearest in a whole tile.
#[test]
fn features_of_f1_alone_are_those_of_samples() -> Result<(), WorleyError> {
    let worley = Worley2::new(Seed(4));
    let window = Window::new(DVec2::ZERO, DVec2::splat(0.25), [128, 96])?;
    let mut ids = Raster::filled(window.size, 0)?;
    let view = FeatureView {
        id: Some(ids.view_mut()),
        ..FeatureView::default()
    };
    worley.render_features(&Plane::default(), &window, [view])?;
    for row in 0..window.size[1] {
        for (column, &id) in (0..).zip(ids.row(row)) {
            let [nearest] = worley.sample(window.position(column, row));
            assert_eq!(id, nearest.id, "column {column} of row {row}");
        }
    }
    Ok(())
}
