//! Ambient occlusion tests: crops, rotations, resolution, fading, SIMD levels, threads, invalid input.

use super::{
    OcclusionOptions, ambient_occlusion, ambient_occlusion_cancellable, ambient_occlusion_of_part,
    occlusion_at,
};
use crate::plane::checks;
use crate::{ColorErrorKind, HeightPlane};
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use dapple_raster::glam::DVec2;
use dapple_raster::simd::for_every_level;
use dapple_raster::{Raster, Window, Wrap};
use proptest::prelude::*;

mod exact;

fn options() -> OcclusionOptions {
    OcclusionOptions::default()
}

/// Returns options for pixels of size 1 × 1 without repetition, so that lengths are in pixels.
fn in_pixels(size: [u32; 2], radius: f64) -> OcclusionOptions {
    OcclusionOptions {
        radius,
        fade: 0.0,
        plane: HeightPlane {
            extent: DVec2::new(size[0].into(), size[1].into()),
            wrap: [Wrap::Clamp; 2],
            ..HeightPlane::default()
        },
    }
}

/// Returns irregular heights, which are multiples of 1/64 below 1.
fn rubble(size: [u32; 2]) -> Raster<f32> {
    let height = |x: u32, y: u32| {
        let mixed =
            (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA6B)).wrapping_mul(0xC2B2_AE35);
        (mixed >> 26) as f32 / 64.0
    };
    Raster::from_fn(size, height).unwrap()
}

#[test]
fn a_plane_sees_the_whole_sky_up_to_sides_that_do_not_repeat() {
    for (height, plane, _) in checks::open_planes() {
        // The last radius is larger than the raster.
        for radius in [1.0, 5.0, 40.0] {
            let options = OcclusionOptions {
                radius,
                plane,
                ..OcclusionOptions::default()
            };
            let seen = ambient_occlusion(&height, &options).unwrap();
            // Arctangents have errors of 2e-7.
            let least = seen.pixels().iter().copied().fold(1.0, f32::min);
            assert!(least > 1.0 - 1e-6, "{:?}, {radius}: {least}", plane.wrap);
        }
    }
}

#[test]
fn crops_with_the_halo_have_the_same_bits() {
    let [size, first, part] = [[97, 83], [31, 40], [29, 17]];
    let height = rubble(size);
    for (extent, radius) in [
        (DVec2::new(1.0, 1.0), 0.1),
        (DVec2::new(0.97, 0.83), 0.1),
        (DVec2::new(0.7, 1.3), 0.11),
        (DVec2::new(97.0, 83.0), 0.5),
    ] {
        let whole = OcclusionOptions {
            radius,
            plane: HeightPlane {
                extent,
                ..HeightPlane::default()
            },
            ..options()
        };
        let [x, y] = whole.halo(size);
        let crop_size = [part[0] + 2 * x, part[1] + 2 * y];
        let crop = height
            .crop([first[0] - x, first[1] - y], crop_size)
            .unwrap();
        let cropped = OcclusionOptions {
            plane: HeightPlane {
                wrap: [Wrap::Clamp; 2],
                ..whole.plane
            },
            ..whole
        };
        let seen = ambient_occlusion(&height, &whole)
            .unwrap()
            .crop(first, part)
            .unwrap();
        let inside = ambient_occlusion_of_part(&crop, [x, y], size, &cropped).unwrap();
        assert_eq!(
            inside.map(|seen| seen.to_bits()),
            seen.map(|seen| seen.to_bits()),
            "{whole:?}"
        );
    }
}

#[test]
fn margins_that_leave_nothing_are_refused() {
    let height = rubble([9, 9]);
    for margin in [[5, 0], [0, 9], [u32::MAX; 2]] {
        let refused = ambient_occlusion_of_part(&height, margin, [9; 2], &options()).unwrap_err();
        assert!(
            matches!(refused.kind(), ColorErrorKind::Raster(_)),
            "{refused}"
        );
    }
}

#[test]
fn the_halo_is_the_radius_in_pixels() {
    let halo = |radius, extent| {
        OcclusionOptions {
            radius,
            plane: HeightPlane {
                extent,
                ..HeightPlane::default()
            },
            ..options()
        }
        .halo([100, 50])
    };
    assert_eq!(halo(0.1, DVec2::ONE), [10, 5], "whole pixels");
    assert_eq!(
        halo(0.1, DVec2::new(1.0, 0.1)),
        [10, 50],
        "pixels that are not square"
    );
    assert_eq!(
        halo(0.0, DVec2::ONE),
        [1, 1],
        "the tangent plane needs the neighbors"
    );
    assert_eq!(halo(f64::NAN, DVec2::ONE), [1, 1], "refused");
}

#[test]
fn a_quarter_turn_turns_the_map() {
    let height = rubble([24, 31]);
    let turned = Raster::from_fn([31, 24], |x, y| height.row(30 - x)[y as usize]).unwrap();
    let extent = DVec2::new(1.0, 1.6);
    let options = OcclusionOptions {
        radius: 0.4,
        plane: HeightPlane {
            extent,
            ..HeightPlane::default()
        },
        ..options()
    };
    let seen = ambient_occlusion(&height, &options).unwrap();
    let options = OcclusionOptions {
        plane: HeightPlane {
            extent: DVec2::new(extent.y, extent.x),
            ..options.plane
        },
        ..options
    };
    let seen_turned = ambient_occlusion(&turned, &options).unwrap();
    for y in 0..24 {
        for x in 0..31 {
            let [before, after] = [seen.row(30 - x)[y as usize], seen_turned.row(y)[x as usize]];
            // The azimuths are added in a different order.
            assert!(
                (before - after).abs() < 1e-6,
                "{before} became {after} at {x}, {y}"
            );
        }
    }
}

#[test]
fn a_fade_lets_walls_vanish_toward_the_radius() {
    let wall = Raster::from_fn([128, 1], |column, _| if column < 64 { 9.0 } else { 0.0 }).unwrap();
    let seen = |fade| {
        let options = OcclusionOptions {
            fade,
            ..in_pixels([128, 1], 40.0)
        };
        ambient_occlusion(&wall, &options).unwrap().row(0)[64..110].to_vec()
    };
    let [hard, soft] = [seen(0.0), seen(0.5)];
    // The last pixel that the wall affects is 40 pixels away and sees it at a slope of 9/40 in one azimuth.
    assert!(
        hard[39] < 0.999 && hard[40] == 1.0,
        "the wall ends all at once: {:?}",
        &hard[39..]
    );
    // Samples are 36 and 40 pixels away, and the farther one has weight 0.
    assert!(
        soft[35] < 1.0 && soft[35] > 0.999,
        "the wall fades: {:?}",
        &soft[35..]
    );
    // At 67.5 degrees the wall is at half the radius after 20 cos 67.5° = 7.6 pixels.
    assert_eq!(soft[..7], hard[..7], "nothing fades before half the radius");
    assert!(soft[1..].is_sorted(), "the wall hides ever less: {soft:?}");
}

#[test]
fn occlusion_does_not_change_with_resolution() {
    let [coarse, fine] = [64, 256].map(|side| {
        let wave = |t: f64| 16.0 * (t * (1.0 - t)) * (t * (1.0 - t));
        let hill = |at: DVec2| (wave((3.0 * at.x).fract()) * wave((2.0 * at.y).fract())) as f32;
        let height = Raster::from_window(&Window::unit([side, side]).unwrap(), hill).unwrap();
        let options = OcclusionOptions {
            radius: 0.125,
            plane: HeightPlane {
                strength: 0.3,
                ..HeightPlane::default()
            },
            ..options()
        };
        ambient_occlusion(&height, &options).unwrap()
    });
    for row in 0..64 {
        for column in 0..64 {
            // The four fine pixels around the center of the coarse one.
            let around = [(1, 1), (2, 1), (1, 2), (2, 2)];
            let mean = around.map(|(x, y)| fine.row(4 * row + y)[4 * column + x] * 0.25);
            let mean: f32 = mean.iter().sum();
            let here = coarse.row(row)[column];
            // Both search the horizon in steps of up to an eighth of the distance, but at different points.
            assert!(
                (here - mean).abs() < 0.015,
                "{here} and {mean} at {column}, {row}"
            );
        }
    }
}

#[test]
fn heights_that_are_not_finite_hide_nothing() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let height = Raster::from_fn([9, 9], |x, y| if [x, y] == [4, 4] { bad } else { 0.5 });
        let seen = ambient_occlusion(
            &height.unwrap(),
            &OcclusionOptions {
                radius: 0.5,
                ..options()
            },
        );
        assert!(
            seen.unwrap().pixels().iter().all(|&seen| seen == 1.0),
            "around {bad}"
        );
    }
}

#[test]
fn bad_options_are_refused() {
    let kind = |options: OcclusionOptions| {
        let refused = ambient_occlusion(&rubble([4, 4]), &options).unwrap_err();
        refused.kind().clone()
    };
    checks::bad_planes_are_refused(|plane| kind(plane.into()));
    checks::bad_radii_are_refused(|radius| {
        kind(OcclusionOptions {
            radius,
            ..options()
        })
    });
    for fade in [-0.1, 1.1, f64::NAN] {
        let refused = kind(OcclusionOptions { fade, ..options() });
        assert!(
            matches!(refused, ColorErrorKind::Fade { .. }),
            "{refused:?}"
        );
    }
}

#[test]
fn pixels_of_which_a_unit_has_infinitely_many_are_refused() {
    let options = OcclusionOptions {
        radius: 2.8e-309,
        ..HeightPlane {
            extent: DVec2::new(1.9e-308, 2.2e139),
            ..HeightPlane::default()
        }
        .into()
    };
    assert_eq!(options.halo([7, 5]), [1, 1]);
    let refused = ambient_occlusion(&rubble([7, 5]), &options).unwrap_err();
    assert!(
        matches!(refused.kind(), ColorErrorKind::Extent { .. }),
        "{refused}"
    );
}

#[test]
fn levels_and_threads_do_not_change_a_bit() {
    let height = rubble([67, 45]);
    let options = OcclusionOptions {
        radius: 0.4,
        ..options()
    };
    let bits = |raster: Raster<f32>| raster.map(|seen| seen.to_bits());
    let expected = bits(ambient_occlusion(&height, &options).unwrap());
    for_every_level(|level| {
        let seen =
            occlusion_at(level, &height, [0; 2], height.size(), &options, &|| false).unwrap();
        assert_eq!(bits(seen), expected, "{level:?}");
    });
    checks::threads_do_not_change_a_bit(|| bits(ambient_occlusion(&height, &options).unwrap()));
}

#[cfg(feature = "serde")]
#[test]
fn options_are_data_and_what_is_not_known_is_refused() {
    checks::options_are_data(&OcclusionOptions {
        radius: 0.25,
        ..options()
    });
}

#[test]
fn value_stability_ambient_occlusion() {
    let options = OcclusionOptions {
        radius: 0.5,
        plane: HeightPlane {
            strength: 0.2,
            ..HeightPlane::default()
        },
        ..options()
    };
    let seen = ambient_occlusion(&rubble([20, 20]), &options).unwrap();
    assert_eq!(
        seen.row(7)[..4]
            .iter()
            .map(|seen| seen.to_bits())
            .collect::<Vec<_>>(),
        [1062810830, 1060561378, 1059347992, 1050819558]
    );
}

proptest! {
    #[test]
    fn values_are_parts_of_the_sky_for_any_heights(
        heights in prop::collection::vec(any::<f32>(), 35),
        strength in any::<f64>(),
        extent in [any::<f64>(), any::<f64>()],
        (radius, fade) in (any::<f64>(), 0.0..=1.0),
    ) {
        let height = Raster::from_vec([7, 5], heights).unwrap();
        let wild = OcclusionOptions { radius, fade, plane: HeightPlane { strength, extent: extent.into(), ..HeightPlane::default() } };
        let tame = OcclusionOptions { radius: 0.5, ..options() };
        for options in [wild, tame] {
            prop_assert!(options.halo([7, 5])[0] >= 1);
            if let Ok(seen) = ambient_occlusion(&height, &options) {
                prop_assert!(seen.pixels().iter().all(|seen| (0.0..=1.0).contains(seen)), "{seen:?}");
            }
        }
    }
}

#[test]
fn occlusion_can_be_cancelled_at_every_row() {
    let height = rubble([24, 40]);
    let options = options();
    for last in [0, 1, 20, 39, 40] {
        let n_calls = AtomicU32::new(0);
        let is_cancelled = || n_calls.fetch_add(1, Relaxed) >= last;
        let seen = ambient_occlusion_cancellable(&height, &options, &is_cancelled);
        match last {
            40 => assert_eq!(seen, ambient_occlusion(&height, &options)),
            _ => assert_eq!(
                seen.unwrap_err().kind(),
                &ColorErrorKind::Cancelled,
                "{last}"
            ),
        }
    }
}
