//! Tests gradients against differences of the oracle, and their continuity.

use super::oracle;
use super::sets::{cases, positions, values};
use dapple_graph::delaunay;
use dapple_hash::Seed;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{Orientation, Pups, PupsOptions};
use dapple_raster::Window;
use glam::{DVec2, DVec3};

#[test]
fn gradients_are_the_differences_of_the_equations() {
    for case in cases()
        .into_iter()
        .filter(|case| case.options.axis_scale >= 1.0)
    {
        let texture = case.texture();
        let step = 1e-6;
        for position in positions(case.points.domain(), 60) {
            let along = |direction: DVec2| {
                let [there, back] =
                    [step, -step].map(|step| oracle::texture(&case, position + direction * step));
                (there - back) / (2.0 * step)
            };
            let expected = DVec2::new(along(DVec2::X), along(DVec2::Y));
            let off = (texture.gradient(position) - expected).length();
            // The value in the formula is in single precision, and axes are rounded to it: some 1e-6 of a slope that
            // reaches the inverse of the distance between points. The oracle's second differences add 1e-5.
            let tolerance = 3e-4 * (1.0 + expected.length());
            assert!(
                off < tolerance,
                "{}: {} is not {expected} at {position}",
                case.name,
                texture.gradient(position)
            );
        }
    }
}

#[test]
fn gradients_vanish_at_control_points_up_to_axis_scale_1() {
    for case in cases().into_iter().filter(|case| {
        case.is_delaunay
            && case.options.axis_scale <= 1.0
            && case.options.orientation.is_none()
            && case.options.fade == 0.0
    }) {
        let texture = case.texture();
        for (point, position) in case.points.iter() {
            let gradient = texture.gradient(position);
            assert!(
                gradient.length() < 1e-4,
                "{}: {gradient} at point {point:?}",
                case.name
            );
        }
    }
}

/// Returns the maximum change of the gradient over a distance `step`, along a line across many supports.
fn largest_jump(strength: f64, step: f64) -> f64 {
    let points = poisson_disk(Domain::paper_torus(), 0.3, Seed(1)).unwrap();
    let vectors = (0..points.len()).map(|index| {
        if index % 2 == 0 {
            DVec3::X
        } else {
            DVec3::new(-0.6, 0.8, 0.0)
        }
    });
    let orientation =
        (strength > 0.0).then(|| Orientation::new(vectors.collect()).with_strength(strength));
    let options = PupsOptions {
        orientation,
        ..PupsOptions::default()
    };
    let pups = Pups::new(&points, &delaunay(&points).unwrap(), options).unwrap();
    let texture = pups.texture(values(points.len())).unwrap();
    let line =
        |index: i32| DVec2::new(-1.0, 0.137) + DVec2::new(0.9, 0.4) * (f64::from(index) * step);
    let count = (1.0 / step) as i32;
    let jumps = (0..count)
        .map(|index| (texture.gradient(line(index + 1)) - texture.gradient(line(index))).length());
    jumps.fold(0.0, f64::max)
}

#[test]
fn the_gradient_is_continuous_below_half_strength() {
    for strength in [0.0, 0.3] {
        let (coarse, fine) = (largest_jump(strength, 1e-3), largest_jump(strength, 1e-4));
        // A continuous gradient changes less over smaller steps; a kink does not.
        assert!(
            fine < coarse * 0.5,
            "strength {strength}: {coarse} became {fine} over a tenth of the step"
        );
    }
}

#[test]
fn gradient_rasters_hold_the_gradients() {
    let points = poisson_disk(Domain::paper_torus(), 0.4, Seed(2)).unwrap();
    let texture = Pups::delaunay(&points)
        .unwrap()
        .texture(values(points.len()))
        .unwrap();
    let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [9, 7]).unwrap();
    let raster = texture.gradient_raster(&window).unwrap();
    assert_eq!(
        raster.row(3)[5],
        texture.gradient(window.position(5, 3)).as_vec2().to_array()
    );
}
