//! Tests that fading axes remove the jumps in textures whose points move.

use super::sets::values;
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet, poisson_disk};
use dapple_pups::{Pups, PupsOptions};
use dapple_raster::{Field, FieldExt as _, Raster, Window};
use glam::DVec2;

/// Renders the texture after one point has moved a fraction `part` of a path, on which it passes several other points.
fn texture(points: &PointSet, part: f64, options: PupsOptions) -> Raster<f32> {
    let mut positions = points.positions().to_vec();
    positions[7] += DVec2::new(0.9, 0.37) * part;
    let points = PointSet::new(*points.domain(), positions).unwrap();
    let pups = Pups::delaunay_with(&points, options).unwrap();
    let texture = pups.texture(values(points.len())).unwrap();
    let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [96, 96]).unwrap();
    texture.to_raster(&window).unwrap()
}

/// Returns the maximum change of a pixel in one of `n_steps` steps along the path.
fn largest_change(n_steps: u32, options: &PupsOptions) -> f32 {
    let points = poisson_disk(Domain::paper_torus(), 0.25, Seed(21)).unwrap();
    let at = |step: u32| {
        texture(
            &points,
            f64::from(step) / f64::from(n_steps),
            options.clone(),
        )
    };
    let mut largest = 0.0_f32;
    let mut before = at(0);
    for step in 1..=n_steps {
        let after = at(step);
        for (before, after) in before.pixels().iter().zip(after.pixels()) {
            largest = largest.max((before - after).abs());
        }
        before = after;
    }
    largest
}

#[test]
fn a_pixel_changes_in_proportion_to_the_step_of_a_point() {
    let still = PupsOptions::default();
    let fading = PupsOptions {
        fade: 0.25,
        ..still.clone()
    };
    let [coarse, fine] = [250, 1000].map(|n_steps| largest_change(n_steps, &fading));
    assert!(
        coarse < 0.06 && fine < 0.3 * coarse,
        "fading: {coarse} in a step, {fine} in a quarter of it"
    );
    let [coarse, fine] = [250, 1000].map(|n_steps| largest_change(n_steps, &still));
    assert!(
        fine > 0.1 && fine > 0.7 * coarse,
        "not fading: {coarse} in a step, {fine} in a quarter of it"
    );
}

#[test]
fn fading_changes_a_still_texture_little() {
    let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(22)).unwrap();
    let picture = |fade| {
        let options = PupsOptions {
            fade,
            ..PupsOptions::default()
        };
        texture(&points, 0.0, options)
    };
    let (still, fading) = (picture(0.0), picture(0.25));
    let off = still.pixels().iter().zip(fading.pixels());
    let mean = off.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / (96.0 * 96.0);
    // Values are spread evenly from 0 to 1.
    assert!(mean > 1e-4 && mean < 0.02, "the mean change is {mean}");
}

#[test]
fn control_points_are_interpolated_while_axes_fade() {
    let points = poisson_disk(Domain::paper_torus(), 0.05, Seed(23)).unwrap();
    let fading = PupsOptions {
        fade: 0.25,
        ..PupsOptions::default()
    };
    let pups = Pups::delaunay_with(&points, fading).unwrap();
    let texture = pups.texture(values(points.len())).unwrap();
    for (&position, value) in points.positions().iter().zip(texture.values()) {
        // The end of an axis is 1e-7 of it away, for rounding, where a weight falls steeply if its border is short; but a
        // border is short between two axes, whose weights have all but fallen there.
        let off = (texture.sample(position) - value).abs();
        assert!(off < 2e-5, "{value} is off by {off} at {position}");
    }
}
