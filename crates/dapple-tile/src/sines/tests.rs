//! Tests of the projector onto sines against a dense one.

use super::*;
use crate::fourier::LANES;
use core::f64::consts::PI;
use proptest::prelude::*;

fn project(image: &Raster<f32>, axes: [Axis; 2]) -> Raster<f32> {
    let coarse = coarse(image, axes, &|| false).expect("the sizes fit");
    refine(&coarse, axes, &|| false).expect("the sizes fit")
}

fn axis(fine: u32, coarse: u32, repeats: bool, phase: Phase) -> Axis {
    Axis {
        fine,
        coarse,
        repeats,
        phase,
    }
}

/// Iterates over lines of a few dozen pixels, halved one to three times, that repeat or are mirrored.
fn axes() -> impl Iterator<Item = Axis> {
    let repeating = [
        (2, 1),
        (4, 2),
        (4, 1),
        (6, 3),
        (12, 6),
        (12, 3),
        (24, 12),
        (24, 3),
        (32, 4),
    ];
    let phases = [Phase::Centered, Phase::CookDeRose];
    let repeating = repeating
        .into_iter()
        .flat_map(move |(fine, coarse)| phases.map(|phase| axis(fine, coarse, true, phase)));
    let mirrored = [(2, 1), (3, 2), (5, 3), (12, 6), (13, 7), (24, 3)];
    let mirrored = mirrored.map(|(fine, coarse)| axis(fine, coarse, false, Phase::Centered));
    repeating.chain(mirrored)
}

/// Returns an orthonormal basis of the functions of a coarse line.
fn basis(axis: &Axis) -> Vec<Vec<f64>> {
    let [n, m] = [axis.fine as usize, axis.coarse as usize];
    let line = |function: &dyn Fn(f64) -> f64| {
        let line: Vec<_> = (0..n).map(|x| function(x as f64)).collect();
        let norm = line.iter().map(|value| value * value).sum::<f64>().sqrt();
        line.iter().map(|value| value / norm).collect::<Vec<_>>()
    };
    if !axis.repeats {
        let cosine = |k: usize| move |x: f64| libm::cos(PI * k as f64 * (x + 0.5) / n as f64);
        return (0..m).map(|k| line(&cosine(k))).collect();
    }
    let mut basis = vec![line(&|_| 1.0)];
    for k in (1..m).take_while(|k| 2 * k < m) {
        let angle = move |x: f64| TAU * k as f64 * x / n as f64;
        basis.push(line(&|x| libm::cos(angle(x))));
        basis.push(line(&|x| libm::sin(angle(x))));
    }
    if m % 2 == 0 {
        let first = first_sample(axis);
        basis.push(line(&|x| libm::cos(PI * m as f64 * (x - first) / n as f64)));
    }
    basis
}

/// Returns the position of the first coarse sample, in pixels.
fn first_sample(axis: &Axis) -> f64 {
    let middle = 0.5 * (f64::from(axis.fine) / f64::from(axis.coarse) - 1.0);
    if axis.phase == Phase::CookDeRose {
        -middle
    } else {
        middle
    }
}

/// Iterates over lines that are zero except for one pixel.
fn unit_lines(length: usize) -> impl Iterator<Item = Vec<Element>> {
    (0..length).map(move |at| {
        let mut line = vec![[0.0; BAND]; length];
        // One real and one imaginary part, so that both are tested.
        line[at][3] = 1.0;
        line[at][LANES + 1] = -2.0;
        line
    })
}

#[test]
fn projection_equals_the_dense_projector() {
    for axis in axes() {
        let sampling = Sampling::new(&axis);
        let basis = basis(&axis);
        assert_eq!(
            basis.len(),
            axis.coarse as usize,
            "as many functions as samples"
        );
        for (at, unit) in unit_lines(axis.fine as usize).enumerate() {
            let projected = sampling.refine(sampling.coarse(unit));
            for (x, element) in projected.iter().enumerate() {
                let wanted: f64 = basis.iter().map(|line| line[at] * line[x]).sum();
                let error = (element[3] - wanted)
                    .abs()
                    .max((element[LANES + 1] + 2.0 * wanted).abs());
                // Four transforms of values of about 1.
                assert!(error < 1e-14, "{axis:?} from {at} to {x}: {error}");
            }
        }
    }
}

#[test]
fn halving_a_doubled_line_gives_it_back() {
    for axis in axes() {
        let sampling = Sampling::new(&axis);
        for unit in unit_lines(axis.coarse as usize) {
            let back = sampling.coarse(sampling.refine(unit.clone()));
            for (back, unit) in back.as_flattened().iter().zip(unit.as_flattened()) {
                // Rounding of transforms of values of about 1.
                assert!(
                    (back - unit).abs() < 1e-14,
                    "{axis:?}: {back} is not {unit}"
                );
            }
        }
    }
}

#[test]
fn coarse_samples_lie_where_the_phase_says() {
    // A wave slow enough for every axis, evaluated at the pixels and at the positions of the samples.
    for phase in [Phase::Centered, Phase::CookDeRose] {
        for (fine, coarse) in [(24, 12), (24, 6), (40, 5)] {
            let axis = axis(fine, coarse, true, phase);
            let wave = |x: f64| libm::cos(TAU * x / f64::from(fine) + 0.3);
            let line = (0..fine).map(|x| [wave(x.into()); BAND]).collect();
            let samples = Sampling::new(&axis).coarse(line);
            for (j, sample) in samples.iter().enumerate() {
                let place = first_sample(&axis) + j as f64 * f64::from(fine / coarse);
                // Rounding of two transforms.
                assert!(
                    (sample[0] - wave(place)).abs() < 1e-14,
                    "{axis:?}, sample {j}"
                );
            }
        }
    }
}

proptest! {
    #[test]
    fn refine_after_coarse_changes_nothing_the_second_time(
        width in 1_u32..12, height in 1_u32..30, repeats: bool, seed in 0_u32..100,
    ) {
        let fine = [4 * width, 2 * height];
        let image = Raster::from_fn(fine, |column, row| {
            let mixed = (column + 3 * seed + 1) * (7 * row + column + 5);
            (mixed % 61) as f32 / 61.0
        }).expect("the size is small and not empty");
        let axes = [axis(fine[0], width, true, Phase::CookDeRose), axis(fine[1], height, repeats, Phase::Centered)];
        let once = project(&image, axes);
        let twice = project(&once, axes);
        for (once, twice) in once.pixels().iter().zip(twice.pixels()) {
            // Four intermediate planes of values of about 1 are rounded to `f32`.
            prop_assert!((once - twice).abs() < 1e-6, "{} became {}", once, twice);
        }
    }
}
