//! Curvature tests: surfaces of known curvature, resolution, crops, threads, invalid input.

use super::{CurvatureOptions, curvature, curvature_of_part, curvature_to_gray};
use crate::HeightPlane;
use crate::plane::checks;
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Window, Wrap};
use proptest::prelude::*;

fn options() -> CurvatureOptions {
    CurvatureOptions::default()
}

/// Renders a function over the unit square as heights, and computes their curvature with the given radius.
fn curvature_of(side: u32, radius: f64, height: impl Fn(DVec2) -> f64 + Sync) -> Raster<f32> {
    let height = Raster::from_window(&Window::unit([side, side]).unwrap(), |at| height(at) as f32);
    let options = CurvatureOptions {
        radius,
        plane: HeightPlane {
            wrap: [Wrap::Clamp; 2],
            ..HeightPlane::default()
        },
    };
    curvature(&height.unwrap(), &options).unwrap()
}

/// Returns the height field of a ball of radius 0.4 over the center of the unit square.
fn ball(at: DVec2) -> f64 {
    (0.16 - (at - 0.5).length_squared()).max(0.0).sqrt()
}

fn hills(size: [u32; 2]) -> Raster<f32> {
    let wave = |t: f64| 16.0 * (t * (1.0 - t)) * (t * (1.0 - t));
    let hill = |at: DVec2| (0.3 * wave((2.0 * at.x).fract()) * wave(at.y)) as f32;
    Raster::from_window(&Window::unit(size).unwrap(), hill).unwrap()
}

#[test]
fn flat_and_tilted_planes_have_none() {
    for radius in [0.0, 0.02, 0.1] {
        let flat = curvature_of(64, radius, |_| 0.7);
        assert!(
            flat.pixels().iter().all(|&bent| bent == 0.0),
            "flat, {radius}"
        );
        let tilted = curvature_of(64, radius, |at| 3.0 * at.x - 0.5 * at.y);
        for row in 8..56 {
            for &bent in &tilted.row(row)[8..56] {
                // Heights up to 3 have rounding errors up to 1.2e-7; four of them are divided by the square of a
                // pixel.
                assert!(bent.abs() < 2e-3, "{bent} with the radius {radius}");
            }
        }
    }
}

#[test]
fn a_ball_has_one_over_its_radius_at_every_place() {
    let bent = curvature_of(512, 1.0 / 128.0, ball);
    let mut n_checked = 0;
    for row in 0..512 {
        for column in 0..512 {
            let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) / 512.0;
            if (at - 0.5).length() > 0.3 {
                continue;
            }
            n_checked += 1;
            let error = bent.row(row)[column as usize] - 2.5;
            // Differences over δ have an error of δ²/12 times the fourth derivative, which is at most 1400 within 0.3
            // of the center and enters with a factor below a third: 0.0024. Rounded heights add four times 1.5e-8 over
            // δ².
            assert!(error.abs() < 0.01, "{error} at {at}");
        }
    }
    assert!(n_checked > 70_000, "only {n_checked} pixels were looked at");
}

#[test]
fn curvature_is_half_the_trace_of_the_shape_operator() {
    // Differences of a quadratic surface are exact for any span.
    let [xx, xy, yy, x, y] = [1.5, -0.75, 0.5, -1.0, 0.25];
    let height = |at: DVec2| {
        0.5 * xx * at.x * at.x + xy * at.x * at.y + 0.5 * yy * at.y * at.y + x * at.x + y * at.y
    };
    let bent = curvature_of(64, 0.1, height);
    for row in 6..58 {
        for column in 6..58 {
            let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) / 64.0;
            let slope = DVec2::new(xx * at.x + xy * at.y + x, xy * at.x + yy * at.y + y);
            // First fundamental form E, F, G, and second fundamental form L, M, N with the upward normal.
            let [e, f, g] = [
                1.0 + slope.x * slope.x,
                slope.x * slope.y,
                1.0 + slope.y * slope.y,
            ];
            let [l, m, n] = [xx, xy, yy].map(|part| part / (e * g - f * f).sqrt());
            let expected = -0.5 * (e * n - 2.0 * f * m + g * l) / (e * g - f * f);
            let error = f64::from(bent.row(row)[column as usize]) - expected;
            // Heights up to 1 have rounding errors up to 3e-8; four of them are divided by the square of 6 pixels,
            // 0.009.
            assert!(error.abs() < 3e-5, "{error} at {at}");
        }
    }
}

#[test]
fn bowls_are_negative_and_strength_turns_the_sign() {
    let middle = |bent: Raster<f32>| bent.row(64)[64];
    let bowl = middle(curvature_of(128, 0.01, |at| -ball(at)));
    assert!((bowl + 2.5).abs() < 0.01, "a bowl has {bowl}");
    let ball = Raster::from_window(&Window::unit([128, 128]).unwrap(), |at| ball(at) as f32);
    let dent = CurvatureOptions {
        radius: 0.01,
        plane: HeightPlane {
            strength: -1.0,
            ..HeightPlane::default()
        },
    };
    assert_eq!(
        middle(curvature(&ball.unwrap(), &dent).unwrap()),
        bowl,
        "a ball turned into a dent"
    );
}

#[test]
fn a_groove_is_flat_on_its_walls_and_hollow_at_the_bottom() {
    let radius = 1.0 / 32.0;
    let bent = curvature_of(256, radius, |at| (at.x - 127.5 / 256.0).abs());
    for (column, &bent) in bent.row(100).iter().enumerate() {
        // Pixels whose distance from the border is below the radius read past the edge.
        match column.abs_diff(127) {
            0 => assert_eq!(
                bent, -32.0,
                "half of the change of slope, 2, over the radius"
            ),
            1..8 => assert!(bent < -1.0, "{bent} near the bottom, at {column}"),
            8..=119 => assert_eq!(bent, 0.0, "on the wall, at {column}"),
            _ => {}
        }
    }
}

#[test]
fn curvature_does_not_change_with_resolution() {
    let [coarse, fine] = [256, 1024].map(|side| {
        let options = CurvatureOptions {
            radius: 1.0 / 64.0,
            ..options()
        };
        curvature(&hills([side, side]), &options).unwrap()
    });
    for row in 0..256 {
        for column in 0..256 {
            // The four fine pixels around the center of the coarse one.
            let around = [(1, 1), (2, 1), (1, 2), (2, 2)];
            let mean = around.map(|(x, y)| fine.row(4 * row + y)[4 * column + x] * 0.25);
            let mean: f32 = mean.iter().sum();
            let here = coarse.row(row)[column];
            // The four pixels are 1/2048 from the center, over which curvatures of up to 20 change slightly.
            assert!(
                (here - mean).abs() < 0.02,
                "{here} and {mean} at {column}, {row}"
            );
        }
    }
}

#[test]
fn pixels_need_not_be_square() {
    // A ball in a window twice as wide as high, with equal numbers of columns and rows.
    let window = Window::new(DVec2::new(0.2, 0.35), DVec2::new(0.6, 0.3), [256, 256]).unwrap();
    let ball = Raster::from_window(&window, |at| ball(at) as f32).unwrap();
    let options = CurvatureOptions {
        radius: 0.01,
        ..HeightPlane::for_window(&window, [Wrap::Repeat; 2]).into()
    };
    assert_eq!(
        options.halo([256, 256]),
        [4, 9],
        "0.01 in columns and rows, rounded"
    );
    let bent = curvature(&ball, &options).unwrap();
    for row in 60..196 {
        for &bent in &bent.row(row)[60..196] {
            assert!((bent - 2.5).abs() < 0.01, "{bent}: see the ball above");
        }
    }
}

#[test]
fn crops_with_the_halo_have_the_same_bits() {
    let [size, first, part] = [[97, 83], [31, 40], [29, 17]];
    let height = hills(size);
    for (extent, radius) in [
        (DVec2::ONE, 0.0),
        (DVec2::new(0.97, 0.83), 0.1),
        (DVec2::new(97.0, 83.0), 2.5),
    ] {
        let whole = CurvatureOptions {
            radius,
            plane: HeightPlane {
                extent,
                ..HeightPlane::default()
            },
        };
        let [x, y] = whole.halo(size);
        let crop_size = [part[0] + 2 * x, part[1] + 2 * y];
        let crop = height
            .crop([first[0] - x, first[1] - y], crop_size)
            .unwrap();
        let cropped = CurvatureOptions {
            plane: HeightPlane {
                wrap: [Wrap::Clamp; 2],
                ..whole.plane
            },
            ..whole
        };
        let bent = curvature(&height, &whole)
            .unwrap()
            .crop(first, part)
            .unwrap();
        let inside = curvature_of_part(&crop, size, &cropped)
            .unwrap()
            .crop([x, y], part)
            .unwrap();
        assert_eq!(
            inside.map(|bent| bent.to_bits()),
            bent.map(|bent| bent.to_bits()),
            "{whole:?}"
        );
    }
}

#[test]
fn a_plane_is_flat_up_to_sides_that_do_not_repeat() {
    for (height, plane, _) in checks::open_planes() {
        // The last radius is larger than the raster.
        for radius in [1.0, 5.0, 40.0] {
            let bent = curvature(&height, &CurvatureOptions { plane, radius }).unwrap();
            let is_flat = bent.pixels().iter().all(|&bent| bent == 0.0);
            assert!(is_flat, "{:?}, {radius}: {bent:?}", plane.wrap);
        }
    }
}

#[test]
fn grays_are_half_where_it_is_flat() {
    assert_eq!(curvature_to_gray(0.0, 0.1), 0.5, "flat");
    assert_eq!(
        curvature_to_gray(5.0, 0.1),
        0.75,
        "a hill of twice the radius"
    );
    assert_eq!(curvature_to_gray(10.0, 0.1), 1.0, "a hill of the radius");
    assert_eq!(curvature_to_gray(-1e30, 1e30), 0.0, "a sharp groove");
    assert_eq!(curvature_to_gray(f32::NAN, 0.1), 0.5, "not a number");
}

#[test]
fn heights_that_are_not_finite_are_flat() {
    for bad in [f32::NAN, f32::INFINITY] {
        let height = Raster::from_fn([9, 9], |x, y| if [x, y] == [4, 4] { bad } else { 0.5 });
        let bent = curvature(&height.unwrap(), &options()).unwrap();
        assert!(
            bent.pixels().iter().all(|&bent| bent == 0.0),
            "around {bad}"
        );
    }
}

#[test]
fn bad_options_are_refused() {
    let kind = |options: CurvatureOptions| {
        let refused = curvature(&hills([4, 4]), &options).unwrap_err();
        refused.kind().clone()
    };
    checks::bad_planes_are_refused(|plane| kind(plane.into()));
    checks::bad_radii_are_refused(|radius| {
        kind(CurvatureOptions {
            radius,
            ..options()
        })
    });
}

#[test]
fn threads_do_not_change_a_bit() {
    let height = hills([67, 45]);
    checks::threads_do_not_change_a_bit(|| {
        let bent = curvature(&height, &options()).unwrap();
        bent.map(|bent| bent.to_bits())
    });
}

#[cfg(feature = "serde")]
#[test]
fn options_are_data_and_what_is_not_known_is_refused() {
    checks::options_are_data(&CurvatureOptions {
        radius: 0.25,
        ..options()
    });
}

#[test]
fn value_stability_curvature() {
    let options = CurvatureOptions {
        radius: 0.1,
        ..options()
    };
    let bent = curvature(&hills([20, 20]), &options).unwrap();
    assert_eq!(
        bent.row(7)[..4]
            .iter()
            .map(|bent| bent.to_bits())
            .collect::<Vec<_>>(),
        [3237708306, 3213421499, 1067230213, 1079674293]
    );
}

proptest! {
    #[test]
    fn values_are_finite_for_any_heights(
        heights in prop::collection::vec(any::<f32>(), 35),
        strength in any::<f64>(),
        extent in [any::<f64>(), any::<f64>()],
        radius in any::<f64>(),
    ) {
        let height = Raster::from_vec([7, 5], heights).unwrap();
        let wild = CurvatureOptions { radius, plane: HeightPlane { strength, extent: extent.into(), ..HeightPlane::default() } };
        for options in [wild, options()] {
            prop_assert!(options.halo([7, 5])[0] >= 1);
            if let Ok(bent) = curvature(&height, &options) {
                prop_assert!(bent.pixels().iter().all(|bent| bent.is_finite()), "{bent:?}");
            }
        }
    }
}
