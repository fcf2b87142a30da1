//! Tests of blend tiles: remaining steps, small tiles, and limits.

use super::*;
use crate::{Method, Seamless, TileErrorKind};
use dapple_wavelet::WaveletErrorKind;
use proptest::prelude::*;

const DEGREES: [Degree; 4] = [
    Degree::Constant,
    Degree::Linear,
    Degree::Quadratic,
    Degree::Cubic,
];

const PHASES: [Phase; 2] = [Phase::Centered, Phase::CookDeRose];

/// Returns unstructured values between 0 and 1.
fn noise(size: [u32; 2], seed: u32) -> Raster<f32> {
    Raster::from_fn(size, |column, row| {
        let mixed = (column + 977 * row + 31 * seed + 1).wrapping_mul(0x9E37_79B1);
        let noise = (mixed ^ (mixed >> 15)).wrapping_mul(0x85EB_CA6B) >> 8;
        noise as f32 / (1 << 24) as f32
    })
    .expect("the size is small and not empty")
}

fn projects() -> impl Iterator<Item = SplineProject> {
    let bases = DEGREES.map(Basis::Spline).into_iter().chain([Basis::Sines]);
    bases.flat_map(|basis| {
        PHASES.into_iter().flat_map(move |phase| {
            [Pixels::Coefficients, Pixels::Samples].map(|pixels| SplineProject {
                levels: 2,
                phase,
                basis,
                pixels,
            })
        })
    })
}

fn tile_of(image: &Raster<f32>, project: SplineProject, axes: [bool; 2]) -> Raster<f32> {
    let seamless = Seamless::new(Method::SplineProject(project)).with_axes(axes);
    seamless.apply(image).expect("the size can be halved")
}

fn largest_difference(a: &Raster<f32>, b: &Raster<f32>) -> f32 {
    assert_eq!(a.size(), b.size(), "both have the same size");
    let differences = a.pixels().iter().zip(b.pixels());
    differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn step_left_at_the_wrap_is_the_known_fraction() {
    // Fractions for each level, centered and in the phase of Cook and DeRose, to six digits, from a dense solver in
    // double precision. At 128 pixels (research's table), the other step, in the middle of the line, still has an
    // effect from the third level on.
    let at_128 = [
        [0.655_340, 0.344_660],
        [0.353_644, 0.234_797],
        [0.180_294, 0.149_519],
        [0.088_069, 0.081_137],
    ];
    let alone = [
        at_128[0],
        at_128[1],
        [0.180_479, 0.149_615],
        [0.090_722, 0.083_256],
    ];
    for (n, fractions) in [(128, at_128), (2048, alone)] {
        let step = Raster::from_fn([n, 16], |column, _| f32::from(u8::from(2 * column >= n)));
        let step = step.expect("the size is good");
        for (levels, fractions) in (1..).zip(fractions) {
            for (phase, fraction) in PHASES.into_iter().zip(fractions) {
                let project = SplineProject {
                    levels,
                    phase,
                    ..SplineProject::default()
                };
                let tile = tile_of(&step, project, [true; 2]);
                let found = tile.row(5)[n as usize - 1] - tile.row(5)[0];
                // Half of the last of six digits, and a few roundings to `f32`.
                let error = (found - fraction).abs();
                assert!(
                    error < 1.5e-6,
                    "{n} pixels, {levels} levels, {phase:?}: {found}"
                );
            }
        }
    }
}

#[test]
fn tile_of_an_impulse_has_the_known_values() {
    // Research's vector for eight coefficients, divided by 1024; all rows are equal.
    let impulse = Raster::from_fn([8, 2], |column, _| f32::from(u8::from(column == 0)));
    let tile = tile_of(
        &impulse.expect("the size is good"),
        SplineProject::default(),
        [true; 2],
    );
    for (value, wanted) in tile
        .row(1)
        .iter()
        .zip([512, 453, -13, -164, 0, 59, 13, 164])
    {
        // Rounding of the halved and of the doubled plane to f32.
        assert!(
            (value - wanted as f32 / 1024.0).abs() < 2e-7,
            "{value} is not {wanted}/1024"
        );
    }
}

#[test]
fn tiles_of_coefficients_and_of_samples_equal_their_lines_in_double_precision() {
    let n = 40_u32;
    // All rows are equal, so nothing changes along y.
    let image = Raster::from_fn([n, 8], |column, _| {
        noise([n, 1], 10).row(0)[column as usize]
    });
    let image = image.expect("the size is good");
    let line: Vec<f64> = image.row(0).iter().map(|&value| value.into()).collect();
    for project in projects() {
        let Basis::Spline(degree) = project.basis else {
            continue;
        };
        let filter = project.filter(degree);
        for border in [Border::Periodic, Border::Mirror] {
            let project_line = |line: &[f64]| filter.project_line(line, project.levels, border);
            let wanted = match project.pixels {
                Pixels::Coefficients => project_line(&line),
                Pixels::Samples => filter
                    .coefficients_line(&line, border)
                    .and_then(|line| project_line(&line))
                    .and_then(|line| filter.samples_line(&line, border)),
            };
            let tile = tile_of(&image, project, [border == Border::Periodic, true]);
            for (value, wanted) in tile.row(3).iter().zip(wanted.expect("the line is good")) {
                let error = (f64::from(*value) - wanted).abs();
                // Up to a dozen planes are rounded to f32, and prefilters enlarge that by up to 9.
                assert!(error < 5e-6, "{project:?}, {border:?}: {error}");
            }
        }
    }
}

#[test]
fn refined_coarse_tile_is_the_tile_to_the_last_bit() {
    let image = noise([24, 20], 1);
    for project in projects() {
        for axes in [[true, true], [true, false], [false, false]] {
            let coarse = project
                .coarse(&image, axes)
                .expect("the size can be halved");
            let refined = project.refine(&coarse, image.size(), axes);
            assert_eq!(
                refined.expect("the size fits"),
                tile_of(&image, project, axes),
                "{project:?}"
            );
        }
    }
}

#[test]
fn tile_of_a_tile_is_itself() {
    let image = noise([24, 20], 2);
    for project in projects() {
        for axes in [[true, true], [false, true]] {
            let once = tile_of(&image, project, axes);
            let error = largest_difference(&tile_of(&once, project, axes), &once);
            // Planes are rounded to f32 on the way, up to a dozen of them, and filters enlarge that by up to 4.
            assert!(error < 3e-6, "{project:?}, {axes:?}: {error}");
        }
    }
}

#[test]
fn constants_stay_constant() {
    let image = Raster::filled([16, 12], 0.7_f32).expect("the size is good");
    for project in projects() {
        for axes in [[true, true], [false, false]] {
            let error = largest_difference(&tile_of(&image, project, axes), &image);
            // A few roundings to f32.
            assert!(error < 1e-6, "{project:?}: {error}");
        }
    }
}

#[test]
fn zero_levels_give_the_image() {
    let image = noise([7, 5], 3);
    for project in projects() {
        let project = SplineProject {
            levels: 0,
            ..project
        };
        assert_eq!(tile_of(&image, project, [true; 2]), image, "{project:?}");
    }
}

#[test]
fn periodic_then_project_removes_the_seam_before_it_smooths() {
    let ramp = Raster::from_fn([64, 64], |column, row| (column + row) as f32);
    let ramp = ramp.expect("the size is good");
    let project = SplineProject::default();
    let smoothed = Seamless::new(Method::PeriodicThenProject(project));
    let smoothed = smoothed.apply(&ramp).expect("the size can be halved");
    let periodic = Seamless::default().apply(&ramp).expect("all is finite");
    assert_eq!(
        smoothed,
        tile_of(&periodic, project, [true; 2]),
        "one after the other"
    );
    let step = |tile: &Raster<f32>| (tile.row(9)[63] - tile.row(9)[0]).abs();
    let only_projected = step(&tile_of(&ramp, project, [true; 2]));
    assert!(step(&smoothed) < 0.05 * only_projected, "the seam is gone");
}

#[test]
fn sides_that_cannot_be_halved_are_refused_with_their_length() {
    let kind = |size, project: SplineProject, axes| {
        let seamless = Seamless::new(Method::SplineProject(project)).with_axes(axes);
        let error = seamless
            .apply(&noise(size, 4))
            .expect_err("the side cannot be halved");
        match error.kind() {
            TileErrorKind::Wavelet(error) => error.kind().clone(),
            kind => panic!("{kind:?} is of another kind"),
        }
    };
    for project in projects() {
        let odd = kind([16, 14], project, [true, true]);
        assert!(
            matches!(odd, WaveletErrorKind::NotDivisible { length: 14, .. }),
            "14 is no multiple of 4: {odd:?}"
        );
        let short = kind([16, 1], project, [true, false]);
        assert!(
            matches!(short, WaveletErrorKind::TooShort { length: 1, .. }),
            "{short:?}"
        );
    }
}

#[test]
fn small_tile_of_another_size_is_refused() {
    for project in projects() {
        let refined = project.refine(&noise([5, 4], 5), [16, 16], [true; 2]);
        let error = refined.expect_err("4 × 4 pixels are needed");
        assert!(error.to_string().contains("5 × 4"), "{error}");
        let mut bad = noise([4, 4], 6);
        bad.pixels_mut()[7] = f32::NAN;
        let error = project.refine(&bad, [16, 16], [true; 2]).expect_err("NaN");
        assert!(
            matches!(
                error.kind(),
                TileErrorKind::NotFinite {
                    column: 3,
                    row: 1,
                    ..
                }
            ),
            "{error}"
        );
    }
}

proptest! {
    #[test]
    fn any_size_and_any_level_give_a_tile_or_a_typed_error(
        width in 1_u32..20, height in 1_u32..20, levels in prop_oneof![0_u32..6, Just(32), Just(33), Just(u32::MAX)],
        axes: [bool; 2], index in 0_usize..20,
    ) {
        let project = SplineProject { levels, ..projects().nth(index).expect("there are 20") };
        let image = noise([width, height], 7);
        let fits = |side: u32, repeats: bool| levels == 0 || !repeats || side.trailing_zeros() >= levels;
        match Seamless::new(Method::SplineProject(project)).with_axes(axes).apply(&image) {
            Ok(tile) => {
                prop_assert_eq!(tile.size(), image.size());
                prop_assert!(tile.pixels().iter().all(|value| value.is_finite()), "all is finite");
                prop_assert!(fits(width, axes[0]) && fits(height, axes[1]), "a side cannot be halved so often");
            }
            Err(error) => prop_assert!(levels > 0 || width == 1 || height == 1, "{}", error),
        }
    }
}

#[test]
fn tiles_have_the_same_bits_on_any_number_of_threads() {
    let image = noise([72, 40], 8);
    for project in projects() {
        let on_threads = |n_threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n_threads)
                .build();
            let pool = pool.expect("threads can be started");
            pool.install(|| tile_of(&image, project, [true, false]))
        };
        let one = on_threads(1);
        assert_eq!(on_threads(2), one, "two threads, {project:?}");
        assert_eq!(on_threads(7), one, "seven threads, {project:?}");
    }
}

#[test]
fn value_stability_spline_project() {
    let image = noise([24, 20], 9);
    let bits = |basis, pixels| {
        let project = SplineProject {
            levels: 2,
            phase: Phase::CookDeRose,
            basis,
            pixels,
        };
        let tile = tile_of(&image, project, [true, false]);
        [tile.row(0)[0], tile.row(11)[13], tile.row(19)[23]].map(f32::to_bits)
    };
    let quadratic = Basis::Spline(Degree::Quadratic);
    let found = [
        bits(quadratic, Pixels::Coefficients),
        bits(quadratic, Pixels::Samples),
        bits(Basis::Sines, Pixels::Samples),
    ];
    let pinned = [
        [1_060_552_226, 1_057_570_983, 1_058_229_735],
        [1_060_981_094, 1_057_563_930, 1_058_625_262],
        [1_057_451_098, 1_057_329_361, 1_056_303_553],
    ];
    assert_eq!(found, pinned, "the bits have not changed");
}
