//! Occlusion compared with a simple oracle and with known view factors.

use super::{in_pixels, options, rubble};
use crate::plane::checks;
use crate::{HeightPlane, OcclusionOptions, ambient_occlusion};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Window, Wrap};

#[test]
fn occlusion_is_that_of_the_oracle() {
    let [repeat, clamp, mirror] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];
    for (strength, extent, wrap, radius, fade) in [
        (0.25, DVec2::ONE, [repeat, clamp], 0.3, 0.5),
        (-0.05, DVec2::new(2.0, 0.5), [mirror, repeat], 0.2, 0.0),
        (2.0, DVec2::new(0.7, 3.0), [clamp, mirror], 1.0, 1.0),
    ] {
        let options = OcclusionOptions {
            radius,
            fade,
            plane: HeightPlane {
                strength,
                extent,
                wrap,
            },
        };
        assert_is_oracle(&rubble([37, 22]), &options);
    }
    // The radius exceeds the raster, and steps are longer than a pixel.
    for wrap in [[repeat; 2], [clamp, repeat], [mirror, clamp]] {
        let options = OcclusionOptions {
            radius: 3.0,
            plane: HeightPlane {
                wrap,
                ..HeightPlane::default()
            },
            ..options()
        };
        assert_is_oracle(&rubble([9, 11]), &options);
    }
}

#[test]
fn a_flat_field_sees_the_whole_sky_exactly() {
    for height in [0.0, 0.7, -1e30, f32::MAX] {
        for radius in [0.0, 0.01, 0.5, 40.0] {
            let flat = Raster::filled([19, 13], height).unwrap();
            let seen = ambient_occlusion(
                &flat,
                &OcclusionOptions {
                    radius,
                    ..options()
                },
            )
            .unwrap();
            assert!(
                seen.pixels().iter().all(|&seen| seen == 1.0),
                "{height}, {radius}"
            );
        }
    }
}

#[test]
fn a_tilted_plane_hides_nothing_of_its_sky() {
    for slope in [
        DVec2::new(0.5, -0.25),
        DVec2::new(-3.0, 1.0),
        DVec2::new(50.0, 80.0),
    ] {
        let window = Window::new(DVec2::ZERO, DVec2::new(1.0, 0.5), [64, 64]).unwrap();
        let plane = Raster::from_window(&window, |at| slope.dot(at) as f32).unwrap();
        let options = OcclusionOptions {
            radius: 0.15,
            plane: HeightPlane {
                wrap: [Wrap::Clamp; 2],
                ..HeightPlane::for_window(&window, [Wrap::Repeat; 2])
            },
            ..OcclusionOptions::default()
        };
        let seen = ambient_occlusion(&plane, &options).unwrap();
        // Heights up to 90 have rounding errors up to 4e-6 over the 8e-3 to the next pixel: slopes of 94 have errors
        // up to 5e-4, smaller slopes less.
        for &seen in seen.pixels() {
            assert!(seen > 1.0 - 1e-5, "{seen} with the slope {slope}");
        }
    }
}

#[test]
fn the_walls_of_a_groove_see_the_squared_sine_of_half_its_angle() {
    // One line of pixels, repeated across: the groove is infinitely long.
    let length = 2049;
    for (half_angle, name) in [(60.0_f64, "wide"), (45.0, "right"), (30.0, "narrow")] {
        let half_angle = half_angle.to_radians();
        let slope = 1.0 / libm::tan(half_angle);
        let expected = libm::sin(half_angle) * libm::sin(half_angle);
        for size in [[length, 1], [1, length]] {
            let groove = Raster::from_fn(size, |column, row| {
                (f64::from((column + row).abs_diff(length / 2)) * slope) as f32
            });
            let seen = ambient_occlusion(&groove.unwrap(), &in_pixels(size, 1000.0)).unwrap();
            let bottom = length as usize / 2;
            for beside in [1, 2, 5] {
                let error = f64::from(seen.pixels()[bottom + beside]) - expected;
                // The horizon is lower by twice the distance to the bottom over the radius, 0.002 per pixel, and a
                // fraction of that is lost. The 16 azimuths cause the rest of the error.
                assert!(
                    error.abs() < 1e-4 + 8e-4 * beside as f64,
                    "{error} at {beside} beside the bottom of a {name} groove of {size:?}"
                );
            }
        }
    }
}

#[test]
fn the_inside_of_a_bowl_sees_half_of_the_sky() {
    let (radius, size) = (150.0, [401, 401]);
    let bowl = Raster::from_fn(size, |column, row| {
        let from_middle = DVec2::new(f64::from(column) - 200.0, f64::from(row) - 200.0);
        (radius
            - (radius * radius - from_middle.length_squared())
                .max(0.0)
                .sqrt()) as f32
    });
    let seen = ambient_occlusion(&bowl.unwrap(), &in_pixels(size, 300.0)).unwrap();
    let mut mean = 0.0;
    for row in 95..=305 {
        for &seen in &seen.row(row)[95..=305] {
            // The rim is sharp, and the first sample past it is too far by up to an eighth of its distance: the
            // horizon is too low by up to a ninth, which is 0.05 at the bottom.
            assert!((-0.01..0.05).contains(&(seen - 0.5)), "{seen} in row {row}");
            mean += f64::from(seen) / (211.0 * 211.0);
        }
    }
    // On average a sample is too far by a sixteenth of its distance.
    assert!((mean - 0.5).abs() < 0.025, "the mean is {mean}");
}

/// Computes the fraction of the sky that a pixel sees in `f64`, following every ray separately.
fn oracle(height: &Raster<f32>, options: &OcclusionOptions, at: [i64; 2]) -> f64 {
    let HeightPlane {
        strength,
        extent,
        wrap,
    } = options.plane;
    let pixel = extent / DVec2::new(height.width().into(), height.height().into());
    let z = |x: i64, y: i64| strength * checks::continued(height, [x, y], wrap);
    let here = z(at[0], at[1]);
    let slope = DVec2::new(
        (z(at[0] + 1, at[1]) - z(at[0] - 1, at[1])) / (2.0 * pixel.x),
        (z(at[0], at[1] + 1) - z(at[0], at[1] - 1)) / (2.0 * pixel.y),
    );
    // Integral over the arc from the zenith down to a slope, without the factor n_z/2.
    let arc = |tangent: f64, slope: f64| {
        let angle = core::f64::consts::FRAC_PI_2 - libm::atan(slope);
        let [sine, cosine] = [libm::sin(angle), libm::cos(angle)];
        sine * sine - tangent * (angle - sine * cosine)
    };
    let [mut seen, mut whole] = [0.0; 2];
    for azimuth in 0..16 {
        let angle = core::f64::consts::PI * f64::from(azimuth) / 8.0;
        let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
        let crossed = (direction / pixel).abs().max_element();
        let tangent = slope.dot(direction);
        let mut horizon = tangent;
        let [mut step, last] = [0.0, (options.radius * crossed + 1e-6).floor()];
        while step < last {
            step = last.min(step + (step / 8.0).floor().max(1.0));
            let offset = direction * (step / crossed) / pixel;
            // Linear interpolation between four pixels; one of the fractions is zero within a millionth.
            let [x, y] = [offset.x, offset.y].map(|offset| (offset + 1e-7).floor());
            let [u, v] = [offset.x - x, offset.y - y];
            let corner = |dx: i64, dy: i64| z(at[0] + x as i64 + dx, at[1] + y as i64 + dy);
            let above = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * u;
            let below = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * u;
            let height = above + (below - above) * v;
            let part = step / crossed / options.radius;
            let weight = ((1.0 - part).max(0.0) / options.fade.max(1e-9)).min(1.0);
            horizon =
                horizon.max(tangent + ((height - here) / (step / crossed) - tangent) * weight);
        }
        seen += arc(tangent, horizon);
        whole += arc(tangent, tangent);
    }
    seen / whole
}

fn assert_is_oracle(height: &Raster<f32>, options: &OcclusionOptions) {
    let seen = ambient_occlusion(height, options).unwrap();
    for row in 0..height.height() {
        for column in 0..height.width() {
            let ours = f64::from(seen.row(row)[column as usize]);
            let expected = oracle(height, options, [column.into(), row.into()]);
            // Slopes have relative rounding errors of 2e-7 and their arctangents errors of 2e-7. Positions on rays are
            // off by up to 5e-7 pixels, over which these heights rise by less than 1e-6 of a pixel's width.
            let error = (ours - expected).abs();
            assert!(
                error < 3e-6,
                "{ours} for {expected} at {column}, {row} with {options:?}"
            );
        }
    }
}
