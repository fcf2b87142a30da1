//! Maps compared with direct interpolation, and errors for columns of a wrong length.

use super::*;
use crate::shapes::{pixel_per_site, row, sphere, synthesizer};
use crate::{Atlas, SynthErrorKind};
use dapple_hash::{Seed, hash1, unit_f32};
use glam::DVec3;

const N: usize = 600;

fn case() -> (Synthesizer, Atlas) {
    let sphere = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    let atlas = Atlas::uniform(sphere.surface(), 200).unwrap();
    (sphere, atlas)
}

fn random() -> Vec<f32> {
    let value = |site| unit_f32(hash1(Seed(1), [site], 0) as u32);
    (0..N as i64).map(value).collect()
}

#[test]
fn values_are_those_of_plain_interpolation() {
    let (sphere, atlas) = case();
    let map = bake_values(&sphere, &pixel_per_site(N), &row(&random()), &atlas).unwrap();
    for row in (0..200).step_by(7) {
        for column in (0..200).step_by(5) {
            let Some(point) = atlas.point(sphere.surface(), [column, row]) else {
                continue;
            };
            let at = sphere.surface().position(point);
            let normal = sphere.surface().face_normal(point.face);
            let plain = sphere.hierarchy().interpolate(0, &random(), at, normal);
            let plain = plain.unwrap().unwrap();
            let value = map.row(row)[column as usize];
            // Tolerance: positions in the map are rounded to `f32`.
            assert!((value - plain).abs() < 1e-4, "{value} beside {plain}");
        }
    }
}

#[test]
fn colors_are_mixed_in_their_codes_and_stay_what_they_are_where_all_are_alike() {
    let (sphere, atlas) = case();
    let color = LinearRgb::from_srgb([12_u8, 200, 255]);
    let map = bake_colors(&sphere, &pixel_per_site(N), &row(&[color; N]), &atlas).unwrap();
    let codes = |color: &LinearRgb| color.to_srgb::<u8>();
    assert!(
        map.pixels()
            .iter()
            .all(|color| codes(color) == [12, 200, 255]),
        "alike"
    );
    let grays: Vec<f32> = random();
    let colors: Vec<LinearRgb> = grays
        .iter()
        .map(|&gray| LinearRgb::from_srgb([u16::from_unit(gray); 3]))
        .collect();
    let map = bake_colors(&sphere, &pixel_per_site(N), &row(&colors), &atlas).unwrap();
    let values = bake_values(&sphere, &pixel_per_site(N), &row(&grays), &atlas).unwrap();
    for (color, value) in map.pixels().iter().zip(values.pixels()) {
        let [code, _, _] = color.to_srgb::<u16>();
        // Tolerance: codes are rounded before and after.
        assert!(
            (code.to_unit() - value).abs() < 2.0 / 65535.0,
            "{code} for {value}"
        );
    }
}

#[test]
fn what_is_transparent_lends_no_color_to_its_edge() {
    let (sphere, atlas) = case();
    let red = LinearRgb::from_srgb([240_u8, 20, 10]);
    let pixel = |value: f32| match value > 0.5 {
        true => LinearRgba::opaque(red),
        false => LinearRgba {
            color: LinearRgb::new(0.0, 1.0, 0.0),
            alpha: 0.0,
        },
    };
    let pixels: Vec<_> = random().into_iter().map(pixel).collect();
    let alphas: Vec<_> = pixels.iter().map(|pixel| pixel.alpha).collect();
    let texture = pixel_per_site(N);
    let map = bake_colors_alpha(&sphere, &texture, &row(&pixels), &atlas).unwrap();
    let alone = bake_values(&sphere, &texture, &row(&alphas), &atlas).unwrap();
    let mut n_mixed = 0;
    for (pixel, &alpha) in map.pixels().iter().zip(alone.pixels()) {
        assert_eq!(pixel.alpha, alpha);
        n_mixed += usize::from(alpha > 0.1 && alpha < 0.9);
        if alpha > 0.01 {
            assert_eq!(pixel.color.to_srgb::<u8>(), red.to_srgb::<u8>(), "{alpha}");
        }
    }
    assert!(n_mixed > 1000, "{n_mixed} texels");

    // Opaque colors equal the colors baked without alpha, up to a rounding of codes.
    let colors: Vec<_> = random().into_iter().map(LinearRgb::gray).collect();
    let opaque: Vec<_> = colors.iter().copied().map(LinearRgba::opaque).collect();
    let with = bake_colors_alpha(&sphere, &texture, &row(&opaque), &atlas).unwrap();
    let without = bake_colors(&sphere, &texture, &row(&colors), &atlas).unwrap();
    for (with, without) in with.pixels().iter().zip(without.pixels()) {
        let [with, without] = [with.color, *without].map(|color| color.to_srgb::<u16>()[0]);
        assert!(with.abs_diff(without) <= 1, "{with} and {without}");
    }
    for bad in [f32::NAN, f32::INFINITY] {
        let mut pixels = pixels.clone();
        pixels[5].alpha = bad;
        let error = bake_colors_alpha(&sphere, &texture, &row(&pixels), &atlas).unwrap_err();
        let is_alpha = matches!(error.kind(), SynthErrorKind::Range { what: "alpha", .. });
        assert!(is_alpha, "{error}");
    }
}

#[test]
fn texels_without_a_face_have_the_mean_of_all_sites() {
    let (sphere, atlas) = case();
    let map = bake_values(&sphere, &pixel_per_site(N), &row(&random()), &atlas).unwrap();
    assert_eq!(atlas.face([199, 199]), None, "beyond the tiles");
    let mean = random().iter().map(|&value| f64::from(value)).sum::<f64>() / N as f64;
    assert_eq!(map.row(199)[199], mean as f32);
}

#[test]
fn bad_columns_are_refused() {
    let (sphere, atlas) = case();
    for count in [1, N - 1, N + 1] {
        let texture = pixel_per_site(count);
        let errors = [
            bake_values(&sphere, &texture, &row(&vec![0.0; count]), &atlas).unwrap_err(),
            bake_colors(
                &sphere,
                &texture,
                &row(&vec![LinearRgb::BLACK; count]),
                &atlas,
            )
            .unwrap_err(),
        ];
        for error in errors {
            let SynthErrorKind::Count { count: got, .. } = *error.kind() else {
                panic!("{error}")
            };
            assert_eq!(got, count, "{error}");
        }
    }
    for bad in [f32::NAN, f32::INFINITY] {
        let mut values = random();
        values[N - 1] = bad;
        let mut colors = vec![LinearRgb::BLACK; N];
        colors[3] = LinearRgb::new(0.0, bad, 0.0);
        for error in [
            bake_values(&sphere, &pixel_per_site(N), &row(&values), &atlas).unwrap_err(),
            bake_colors(&sphere, &pixel_per_site(N), &row(&colors), &atlas).unwrap_err(),
        ] {
            assert!(
                matches!(error.kind(), SynthErrorKind::Range { .. }),
                "{error}"
            );
        }
    }
}

#[test]
fn value_stability_bake_values() {
    let (sphere, atlas) = case();
    let map = bake_values(&sphere, &pixel_per_site(N), &row(&random()), &atlas).unwrap();
    let texels = [[10, 20], [100, 50], [150, 177]].map(|[x, y]: [u32; 2]| map.row(y)[x as usize]);
    assert_eq!(
        texels.map(f32::to_bits),
        [1_057_106_225, 1_058_519_786, 1_049_384_452]
    );
}

#[cfg(feature = "rayon")]
#[test]
fn colors_have_the_same_bits_on_any_number_of_threads() {
    let (sphere, atlas) = case();
    let colors: Vec<LinearRgb> = random().into_iter().map(LinearRgb::gray).collect();
    let [one, two, seven] = crate::shapes::on_threads(|| {
        bake_colors(&sphere, &pixel_per_site(N), &row(&colors), &atlas).unwrap()
    });
    assert_eq!(one, two, "2 threads");
    assert_eq!(one, seven, "7 threads");
}
