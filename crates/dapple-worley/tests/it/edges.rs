//! Compares rendered edge distances with single evaluations, and with a brute-force search over all bisecting planes.

use super::bits::windows;
use super::oracle::{SCATTERS, brute_force_vectors};
use super::sheet::middle_ground;
use dapple_hash::Seed;
use dapple_raster::simd::for_every_level;
use dapple_raster::{Raster, Window};
use dapple_worley::{Dimensions, Plane, Space, Worley, WorleyError};
use glam::DVec2;

fn picture_equals_distance<const N: usize>(
    worley: &Worley<N>,
    plane: &Plane<N>,
    window: &Window,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let [width, height] = window.size;
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let positions: Vec<_> = pixels
        .map(|(column, row)| plane.position(window.position(column, row)))
        .collect();
    let expected: Vec<_> = positions
        .iter()
        .map(|&at| worley.edge_distance(at))
        .collect();
    let edges = worley.edge_distances();
    for_every_level(|level| {
        let mut raster = Raster::filled(window.size, -1.0).unwrap();
        edges
            .render_plane(plane, window, raster.view_mut())
            .unwrap();
        let found = positions.iter().zip(raster.pixels()).zip(&expected);
        for ((at, found), expected) in found {
            assert_eq!(
                found.to_bits(),
                expected.to_bits(),
                "{found} for {expected} at {at:?}, {:?}, {window:?}, {level:?}",
                worley.scatter()
            );
        }
    });
    Ok(())
}

#[test]
fn edge_picture_equals_edge_distance_bit_for_bit() -> Result<(), WorleyError> {
    for scatter in SCATTERS {
        let worley = Worley::new(Seed(21)).with_scatter(scatter)?;
        for window in windows() {
            picture_equals_distance::<2>(&worley, &Plane::default(), &window)?;
        }
        let periodic = worley.with_period([Some(1), Some(3)])?;
        picture_equals_distance::<2>(&periodic, &Plane::default(), &windows()[0])?;
    }
    Ok(())
}

#[test]
fn edge_picture_equals_edge_distance_in_slices() -> Result<(), WorleyError> {
    let window = Window::new(DVec2::new(-3.0, 7.0), DVec2::new(2.5, -1.5), [41, 23])?;
    let slanted = Plane {
        origin: [0.1, 0.2, -5.3].into(),
        u: [0.7, 0.1, 0.2].into(),
        v: [0.0, 1.1, -0.3].into(),
    };
    let worley = Worley::<3>::new(Seed(22));
    for plane in [Plane::slice([0.1, 0.2, -5.3].into()), slanted] {
        picture_equals_distance(&worley, &plane, &window)?;
    }
    let plane = Plane::slice([0.0, 0.0, 2.5, 1e4].into());
    picture_equals_distance(&Worley::<4>::new(Seed(23)), &plane, &window)
}

/// Uses windows around positions on an edge, from a whole cell down to a few steps wide.
#[test]
fn edge_picture_equals_edge_distance_on_edges() -> Result<(), WorleyError> {
    for seed in 0..4 {
        let worley = Worley::<2>::new(Seed(seed));
        let at = DVec2::from(middle_ground(&worley, [0.3 + seed as f64; 2]));
        for zoom in [2, 6, 9, 12, 16, 20] {
            let extent = DVec2::new(1.0, -1.0) / f64::from(1 << zoom);
            let window = Window::new(at - extent / 2.0, extent, [40, 18])?;
            picture_equals_distance(&worley, &Plane::default(), &window)?;
        }
    }
    Ok(())
}

#[test]
fn edge_picture_is_zero_on_the_edges_of_a_lattice() -> Result<(), WorleyError> {
    let jittered = dapple_worley::Scatter::Jittered { jitter: 0.0 };
    let worley = Worley::<2>::new(Seed(24)).with_scatter(jittered)?;
    // Pixels lie on the borders of unit cells, which are the edges.
    let window = Window::new(DVec2::splat(-1.0 / 64.0), DVec2::splat(4.0), [128; 2])?;
    picture_equals_distance(&worley, &Plane::default(), &window)?;
    let mut raster = Raster::filled(window.size, -1.0)?;
    let edges = worley.edge_distances();
    edges.render_plane(&Plane::default(), &window, raster.view_mut())?;
    let n_zero = raster
        .pixels()
        .iter()
        .filter(|&&value| value == 0.0)
        .count();
    assert_eq!(n_zero, 128 * 128 - 124 * 124, "four columns and four rows");
    Ok(())
}

#[test]
fn edge_picture_is_that_of_all_planes() -> Result<(), WorleyError> {
    let worley = Worley::<2>::new(Seed(5)).with_density(1.0)?;
    let window = Window::new(DVec2::new(-30.0, 12.0), DVec2::new(8.0, 6.0), [64, 48])?;
    let mut raster = Raster::filled(window.size, -1.0)?;
    let edges = worley.edge_distances();
    edges.render_plane(&Plane::default(), &window, raster.view_mut())?;
    for index in (0..64 * 48).step_by(23) {
        let (column, row) = (index % 64, index / 64);
        let at = window.position(column, row);
        let all = brute_force_vectors(&worley, at, 6);
        let [x, y] = all[0].1;
        let planes = all[1..].iter().map(|(_, [other_x, other_y])| {
            let apart = libm::hypot(other_x - x, other_y - y);
            let between = other_x * other_x + other_y * other_y - x * x - y * y;
            between / (2.0 * apart)
        });
        let expected = planes.fold(f64::INFINITY, f64::min);
        let found = f64::from(raster.row(row)[column as usize]);
        // Both are computed in f64 from exact vectors, and the result is rounded to f32.
        assert!(
            (found - expected).abs() <= 1e-7 * expected + 1e-12,
            "{at:?}: {found} for {expected}"
        );
    }
    Ok(())
}
