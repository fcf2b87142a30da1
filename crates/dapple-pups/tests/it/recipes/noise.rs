//! Tests of noise, octaves, folding and turbulence.

use super::common::paper_window;
use dapple_hash::Seed;
use dapple_pups::*;
use dapple_pups::{PupsErrorKind, points::Domain};
use dapple_raster::{Field, FieldExt as _, Ramp, Varying};
use glam::DVec2;

#[test]
fn octaves_sum_after_equation_5() {
    let sum = octaves(&OctavesOptions::default(), Seed(1)).unwrap();
    assert_eq!(sum.amplitudes(), [1.0, 0.5, 0.25, 0.125]);
    assert_eq!(sum.maximum(), 1.875);
    for position in [DVec2::ZERO, DVec2::new(0.3, -0.9), DVec2::new(1e3, 5.5)] {
        let [a, b, c, d] = [0, 1, 2, 3].map(|octave| sum.layers()[octave].sample(position));
        let expected = a + b / 2.0 + c / 4.0 + d / 8.0;
        assert_eq!(sum.sample(position), expected, "at {position}");
        let shown = sum.clone().normalized().sample(position);
        // Each amplitude and each sum is rounded once.
        assert!(
            (shown - expected / 1.875).abs() < 1e-6,
            "{shown} is shown at {position}"
        );
    }
}

#[test]
fn octaves_have_four_times_the_points_each() {
    let sum = octaves(&OctavesOptions::default(), Seed(1)).unwrap();
    for (octave, needed) in sum.layers().iter().zip([279.0, 1115.0, 4461.0, 17843.0]) {
        let n_points = octave.texture().pups().n_points() as f64;
        // A maximal set has 0.697 · area / r² points; its spread is far below 5 %.
        assert!(
            (n_points / needed - 1.0).abs() < 0.05,
            "{n_points} points for {needed}"
        );
    }
}

#[test]
fn rescaled_octaves_are_the_tile_at_twice_the_position() {
    let options = OctavesOptions {
        source: OctaveSource::Rescaled,
        ..OctavesOptions::default()
    };
    let sum = octaves(&options, Seed(1)).unwrap();
    let position = DVec2::new(0.171, -0.333);
    let tile = sum.layers()[0].texture();
    assert_eq!(
        sum.layers()[2].sample(position),
        tile.sample(position * 4.0)
    );
    assert_eq!(sum.layers()[3].scale(), 8.0);
}

#[test]
fn folding_keeps_values_between_0_and_1() {
    let plain = octaves(&OctavesOptions::default(), Seed(1)).unwrap();
    let folded = turbulence(&OctavesOptions::default(), Seed(1)).unwrap();
    let window = paper_window(128);
    for (plain, folded) in plain.layers().iter().zip(folded.layers()) {
        let [plain, folded] = [plain, folded].map(|octave| octave.to_raster(&window).unwrap());
        for (&plain, &folded) in plain.pixels().iter().zip(folded.pixels()) {
            assert_eq!(folded, 2.0 * (plain - 0.5).abs(), "from {plain}");
            assert!((0.0..=1.0).contains(&folded), "{folded} is out of range");
        }
        let statistics = folded.statistics();
        assert!(
            statistics.min < 0.01 && statistics.max > 0.7,
            "{statistics:?}"
        );
    }
    let sum = folded.to_raster(&window).unwrap().statistics();
    assert!(sum.min >= 0.0 && sum.max <= 1.875, "{sum:?}");
}

#[test]
fn noise_grows_finer_where_its_points_are_denser() {
    let options = NoiseOptions {
        domain: Domain {
            wrap: [false, true],
            ..Domain::paper_torus()
        },
        spacing: Spacing::Distance(Varying::GeometricRamp(Ramp {
            from: DVec2::NEG_X,
            to: DVec2::X,
            start: 0.3,
            end: 0.03,
        })),
        ..NoiseOptions::default()
    };
    let texture = noise(&options, Seed(1)).unwrap();
    let raster = texture.to_raster(&paper_window(256)).unwrap();
    // The mean slope along columns, in the four quarters from left to right.
    let slopes = [0, 1, 2, 3].map(|quarter| {
        let columns = quarter * 64..(quarter + 1) * 64;
        let mut sum = 0.0;
        for row in 1..256 {
            for column in columns.clone() {
                sum += (raster.row(row)[column] - raster.row(row - 1)[column]).abs();
            }
        }
        sum
    });
    assert!(slopes.is_sorted_by(|a, b| a < b), "slopes {slopes:?}");
}

#[test]
fn octaves_out_of_range_are_refused() {
    let plain = OctavesOptions::default;
    let rescaled = OctaveSource::Rescaled;
    for options in [
        OctavesOptions {
            octaves: 0,
            ..plain()
        },
        OctavesOptions {
            octaves: 17,
            ..plain()
        },
        OctavesOptions {
            gain: 0.0,
            ..plain()
        },
        OctavesOptions {
            gain: f64::NAN,
            ..plain()
        },
        OctavesOptions {
            lacunarity: 1.0,
            ..plain()
        },
        OctavesOptions {
            lacunarity: 3.0,
            source: rescaled,
            ..plain()
        },
    ] {
        let error = octaves(&options, Seed(1)).unwrap_err();
        assert!(
            matches!(error.kind(), PupsErrorKind::Range { .. }),
            "{error}"
        );
    }
    let domain = Domain {
        wrap: [true, false],
        ..Domain::paper_torus()
    };
    let options = OctavesOptions {
        domain,
        source: rescaled,
        ..plain()
    };
    let error = octaves(&options, Seed(1)).unwrap_err();
    assert!(
        matches!(error.kind(), PupsErrorKind::NotWrapped { axis: 1 }),
        "{error}"
    );
    for distance in [0.0, -1.0, f64::NAN, 1.5] {
        let spacing = Spacing::from(distance);
        let error = noise(
            &NoiseOptions {
                spacing,
                ..NoiseOptions::default()
            },
            Seed(1),
        )
        .unwrap_err();
        assert!(matches!(error.kind(), PupsErrorKind::Points(_)), "{error}");
    }
}
