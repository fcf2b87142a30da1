//! Values with the Euclidean metric, where points are thinned and slices are filled together.

use crate::{
    Axes, Combination, Octaves, Plane, Space, Vector, Worley, Worley2, Worley3, WorleyError,
};
use dapple_hash::Seed;
use dapple_raster::{Raster, RasterErrorKind, Window};
use glam::{DVec2, DVec3};

/// A position that is as near to its nearest point as to the second one, to within a hair: on the way from `at` to
/// another place with another nearest point.
fn middle_ground<const N: usize>(worley: &Worley<N>, at: [f64; N]) -> [f64; N]
where
    Axes: Space<N>,
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

/// So far along the first axis, and half as far along the second.
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
    Axes: Space<N>,
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

/// Windows about places where a hair decides which point is nearer, from a whole cell down to a few steps.
fn hairs_are_split_right<const N: usize>() -> Result<(), WorleyError>
where
    Axes: Space<N>,
{
    let combinations = [Combination::F1, Combination::F2, Combination::F2_MINUS_F1];
    for seed in 0..6 {
        let worley = Worley::<N>::new(Seed(seed));
        let at = middle_ground(&worley, [0.3 + seed as f64; N]);
        let mut origin = at;
        origin[..2].fill(0.0);
        let plane = Plane::slice(Vector::<N>::from(origin));
        for zoom in [6, 9, 12, 16, 20] {
            let pixel = DVec2::new(1.0, 1.25) / f64::from(1 << zoom);
            let window = Window {
                origin: DVec2::new(at[0], at[1]) - 24.0 * pixel,
                pixel,
                first: [0, 0],
                size: [50, 47],
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

/// More planes than are filled together: near to one another and not, turned, and twice the same.
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
    for (size, extent) in [([140, 70], 3.0), ([40, 70], 9.0)] {
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
