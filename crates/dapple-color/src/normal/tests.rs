//! Normal map tests: directions, resolution, wrapping, codes, threads.

use super::{Normal, NormalOptions, NormalY, normal_map, normal_map_from_gradient};
use crate::plane::checks;
use crate::{Code, HeightPlane};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Window, Wrap};
use proptest::prelude::*;

/// Returns a smooth periodic height field over the unit square. It is a product of parabolas, so no sine is needed.
fn hill(position: DVec2) -> f32 {
    let bump = |t: f64| 16.0 * (t * (1.0 - t)) * (t * (1.0 - t));
    (bump(position.x) * bump(position.y)) as f32
}

fn hills(size: [u32; 2]) -> Raster<f32> {
    Raster::from_window(&Window::unit(size).unwrap(), hill).unwrap()
}

fn options() -> NormalOptions {
    NormalOptions::default()
}

#[test]
fn flat_heights_have_the_flat_codes() {
    let flat = Raster::filled([5, 3], 0.7_f32).unwrap();
    for y in [NormalY::OpenGl, NormalY::DirectX] {
        let normals = normal_map(&flat, &NormalOptions { y, ..options() }).unwrap();
        for normal in normals.pixels() {
            assert_eq!(normal.to_codes::<u8>(), [128, 128, 255], "8 bits");
            assert_eq!(normal.to_codes::<u16>(), [32768, 32768, 65535], "16 bits");
        }
    }
}

#[test]
fn slopes_lean_away_from_the_hill() {
    let [left, above] = [[24, 32], [32, 24]];
    let at = |y, [column, row]: [usize; 2]| {
        let normals = normal_map(&hills([64, 64]), &NormalOptions { y, ..options() }).unwrap();
        normals.pixels()[64 * row + column]
    };
    assert!(
        at(NormalY::OpenGl, left).x < -0.1,
        "left of the hill it leans left"
    );
    assert!(
        at(NormalY::OpenGl, above).y > 0.1,
        "above it leans up, which is plus with Y up"
    );
    assert!(
        at(NormalY::DirectX, above).y < -0.1,
        "and minus with Y down"
    );
}

#[test]
fn a_plane_has_the_normal_of_its_slope() {
    // Height 3 x - 4 y over an extent of 2 × 0.5. Away from the edges central differences are exact.
    let window = Window::new(DVec2::ZERO, DVec2::new(2.0, 0.5), [32, 16]).unwrap();
    let plane = Raster::from_window(&window, |at| (3.0 * at.x - 4.0 * at.y) as f32).unwrap();
    let options = HeightPlane {
        strength: 0.5,
        ..HeightPlane::for_window(&window, [Wrap::Repeat; 2])
    }
    .into();
    let normal = normal_map(&plane, &options).unwrap().row(7)[9];
    let length = (1.5_f64 * 1.5 + 2.0 * 2.0 + 1.0).sqrt();
    let expected = [-1.5, -2.0, 1.0].map(|part| (part / length) as f32);
    assert_eq!(normal.to_array(), expected, "(-s dh/dx, +s dh/dy, 1)");
}

#[test]
fn strength_does_not_change_with_resolution() {
    let [coarse, fine] =
        [64, 256].map(|side| normal_map(&hills([side, side]), &options()).unwrap());
    let mut worst = 0.0_f32;
    for row in 0..64_u32 {
        for column in 0..64_usize {
            // The four fine pixels around the center of the coarse one.
            let mut mean = [0.0; 3];
            for (dx, dy) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
                let normal = fine.row(4 * row + dy)[4 * column + dx].to_array();
                mean = core::array::from_fn(|part| mean[part] + 0.25 * normal[part]);
            }
            let here = coarse.row(row)[column].to_array();
            worst = (0..3).fold(worst, |worst, part| {
                worst.max((here[part] - mean[part]).abs())
            });
        }
    }
    // Central differences have an error of pixel²/6 times the third derivative, which is below 200 here: 0.008.
    assert!(worst < 0.01, "the largest difference is {worst}");
}

#[test]
fn the_normals_of_a_tile_are_those_of_the_tiling() {
    let tile = Raster::from_fn([9, 6], |x, y| ((x * 37 + y * 101) % 17) as f32).unwrap();
    let normals = normal_map(&tile, &options()).unwrap();
    let tiled = normal_map(
        &tile.tile([3, 3]).unwrap(),
        &HeightPlane {
            extent: DVec2::splat(3.0),
            wrap: [Wrap::Clamp; 2],
            ..HeightPlane::default()
        }
        .into(),
    );
    assert_eq!(
        tiled.unwrap().crop([9, 6], [9, 6]).unwrap(),
        normals,
        "the middle tile"
    );
}

#[test]
fn a_plane_keeps_its_normal_up_to_sides_that_do_not_repeat() {
    for (height, plane, slope) in checks::open_planes() {
        let options = NormalOptions::from(plane);
        let normals = normal_map(&height, &options).unwrap();
        // Heights are exact, so their differences are exact too.
        let expected = options.normal(slope);
        for (index, &normal) in normals.pixels().iter().enumerate() {
            assert_eq!(normal, expected, "{:?}, pixel {index}", plane.wrap);
        }
    }
}

#[test]
fn normals_past_a_side_are_those_of_the_oracle() {
    let height = Raster::from_fn([9, 6], |x, y| ((x * 37 + y * 101) % 17) as f32).unwrap();
    for wrap in [
        [Wrap::Clamp; 2],
        [Wrap::Mirror, Wrap::Repeat],
        [Wrap::Repeat, Wrap::Mirror],
    ] {
        let plane = HeightPlane {
            extent: DVec2::new(9.0, 6.0),
            wrap,
            ..HeightPlane::default()
        };
        let options = NormalOptions::from(plane);
        let normals = normal_map(&height, &options).unwrap();
        for (y, x) in (0..6_i64).flat_map(|y| (0..9_i64).map(move |x| (y, x))) {
            let z = |dx, dy| checks::continued(&height, [x + dx, y + dy], wrap);
            let difference = DVec2::new(z(1, 0) - z(-1, 0), z(0, 1) - z(0, -1));
            let expected = options.normal(difference / 2.0);
            assert_eq!(normals.row(y as u32)[x as usize], expected, "{x}, {y}");
        }
    }
}

#[test]
fn centered_normals_are_flat_where_their_codes_are_next_to_the_middle() {
    for x in [127_u8, 128] {
        for y in [127_u8, 128] {
            let flat = Normal::from_codes([x, y, 255]).centered();
            assert_eq!(flat, Normal::FLAT, "{x}, {y}");
            let codes = [x, y].map(|code| u16::from(code) + 32640);
            let flat = Normal::from_codes([codes[0], codes[1], 65535]).centered();
            assert_eq!(flat, Normal::FLAT, "{codes:?}");
            // An 8-bit image, stored in 16 bits.
            let wide = [x, y, 255].map(|code| 257 * u16::from(code));
            assert_eq!(
                Normal::from_codes(wide).centered(),
                Normal::FLAT,
                "{wide:?}"
            );
        }
    }
}

#[test]
fn centered_normals_keep_their_codes_elsewhere() {
    // Every code together with a middle code, and a z that gives about unit length.
    for code in 0..=255_u8 {
        let y = f64::from(code) / 127.5 - 1.0;
        let z = ((1.0 - y * y).max(0.0).sqrt() * 127.5 + 127.5).round() as u8;
        for middle in [127, 128] {
            let normal = Normal::from_codes([middle, code, z]);
            let centered = normal.centered();
            let is_middle = [127, 128].contains(&code);
            assert_eq!(centered.x, 0.0, "{code}");
            assert_eq!(centered.y == 0.0, is_middle, "{code}");
            // The vector became shorter by less than 1e-5 of its length.
            assert!((centered.z - normal.z).abs() < 2e-5, "{code}");
        }
        for other in [126, 129, 64, 200] {
            let normal = Normal::from_codes([other, code.max(129), z]);
            assert_eq!(normal.centered(), normal, "{other}, {code}");
        }
    }
    // Components between the 8-bit codes, from 16 bits or floats, stay unchanged.
    for x in [0.002, 0.0037, 0.0042, 5e-5, -0.003] {
        let z = (1.0_f32 - x * x - 0.09).sqrt();
        let normal = Normal { x, y: 0.3, z };
        assert_eq!(normal.centered(), normal, "{x}");
    }
}

#[test]
fn codes_next_to_the_middle_come_back() {
    for code in [126, 127, 128, 129_u8] {
        let normal = Normal::from_codes([code, 128, 255]);
        assert_eq!(normal.to_codes::<u8>(), [code, 128, 255]);
    }
    for code in [32766, 32767, 32768, 32769_u16] {
        let normal = Normal::from_codes([code, 32768, 65535]);
        assert_eq!(normal.to_codes::<u16>(), [code, 32768, 65535]);
    }
}

#[test]
fn wrapping_is_per_axis() {
    let ramp = Raster::from_fn([8, 8], |x, y| (x + y) as f32).unwrap();
    let normal = |wrap| {
        normal_map(
            &ramp,
            &HeightPlane {
                wrap,
                ..HeightPlane::default()
            }
            .into(),
        )
        .unwrap()
        .row(0)[0]
    };
    // Repeated, the ramp falls from 7 to 0 at the edge; continued, it rises by 1 per pixel.
    let repeated = normal([Wrap::Repeat; 2]);
    assert!(repeated.x > 0.0 && repeated.y < 0.0, "{repeated:?}");
    let mixed = normal([Wrap::Repeat, Wrap::Clamp]);
    assert!(mixed.x > 0.0 && mixed.y > 0.0, "{mixed:?}");
}

#[test]
fn exact_slopes_give_the_same_as_options_normal() {
    let slopes = Raster::from_fn([5, 4], |x, y| [x as f32 - 2.0, y as f32 * 0.5]).unwrap();
    let options = NormalOptions {
        y: NormalY::DirectX,
        plane: HeightPlane {
            strength: -3.0,
            ..HeightPlane::default()
        },
    };
    let normals = normal_map_from_gradient(&slopes, &options).unwrap();
    let oracle = slopes.map(|&[x, y]| {
        let length = (9.0 * (x * x + y * y) + 1.0).sqrt();
        [3.0 * x / length, 3.0 * y / length, 1.0 / length]
    });
    for (normal, oracle) in normals.pixels().iter().zip(oracle.pixels()) {
        for (part, oracle) in normal.to_array().into_iter().zip(oracle) {
            // The oracle rounds about four times in `f32`.
            assert!((part - oracle).abs() < 5e-7, "{part} and {oracle}");
        }
    }
}

#[test]
fn bad_planes_are_refused() {
    checks::bad_planes_are_refused(|plane| {
        let refused = normal_map(&hills([4, 4]), &plane.into()).unwrap_err();
        refused.kind().clone()
    });
}

#[test]
fn heights_that_are_not_finite_have_flat_neighbors() {
    for bad in [f32::NAN, f32::INFINITY] {
        let height = Raster::from_fn([5, 5], |x, y| if [x, y] == [2, 2] { bad } else { x as f32 });
        let normals = normal_map(&height.unwrap(), &options()).unwrap();
        assert_eq!(normals.row(2)[1], Normal::FLAT, "left of {bad}");
        assert_ne!(normals.row(2)[2], Normal::FLAT, "{bad} itself is not used");
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let height = hills([67, 45]);
    checks::threads_do_not_change_a_bit(|| {
        let normals = normal_map(&height, &options()).unwrap();
        normals.map(|normal| normal.to_array().map(f32::to_bits))
    });
}

#[test]
fn value_stability_normal_map() {
    let normal = normal_map(&hills([16, 16]), &options()).unwrap().row(3)[5];
    assert_eq!(
        normal.to_array().map(f32::to_bits),
        [3199912162, 1063036451, 1052004172]
    );
}

proptest! {
    #[test]
    fn normals_are_unit_vectors_that_point_outward(
        slope in [-1e6_f32..1e6, -1e6_f32..1e6],
        strength in -100.0_f64..100.0,
    ) {
        let normal = NormalOptions::from(HeightPlane { strength, ..HeightPlane::default() })
            .normal(DVec2::new(slope[0].into(), slope[1].into()));
        let [x, y, z] = normal.to_array().map(f64::from);
        // Each component is rounded to `f32` once, by at most 6e-8.
        prop_assert!((x * x + y * y + z * z - 1.0).abs() < 4e-7);
        prop_assert!(z > 0.0);
    }

    #[test]
    fn codes_come_back_within_half_a_step(slope in [-9.0_f64..9.0, -9.0_f64..9.0]) {
        let normal = options().normal(slope.into());
        fn error<C: Code>(normal: Normal) -> f32 {
            let back = Normal::from_codes(normal.to_codes::<C>()).to_array();
            let parts = normal.to_array().into_iter().zip(back);
            parts.fold(0.0, |worst, (part, back)| worst.max((part - back).abs()))
        }
        // Half a step is 1/max per component; normalization can double it.
        prop_assert!(error::<u8>(normal) <= 2.0 / 255.0);
        prop_assert!(error::<u16>(normal) <= 2.0 / 65535.0);
    }
}
