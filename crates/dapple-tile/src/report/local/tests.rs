//! Tests of the softest band against values computed by hand and a naive search.

use super::lowest_detail;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::{Raster, Wrap};

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];

/// Returns white noise from -½ to ½, scaled by `gain` in each column.
fn noise(size: [u32; 2], gain: impl Fn(u32) -> f32) -> Raster<f32> {
    let pixel = |x, y| unit_f32(hash2(Seed(3), [i64::from(x), i64::from(y)], 0) as u32) - 0.5;
    Raster::from_fn(size, |x, y| gain(x) * pixel(x, y)).unwrap()
}

/// Evaluates the definition for every band by brute force.
fn naive(image: &Raster<f32>, wrap: [Wrap; 2]) -> f64 {
    let [width, height] = image.size().map(i64::from);
    let at = |x, y| f64::from(*image.at(x, y, wrap));
    let detail = |x: i64, y: i64| {
        let mut mean = 0.0;
        for (dy, v) in [(-1, 0.25), (0, 0.5), (1, 0.25)] {
            for (dx, u) in [(-1, 0.25), (0, 0.5), (1, 0.25)] {
                mean += u * v * at(x + dx, y + dy);
            }
        }
        (at(x, y) - mean) * (at(x, y) - mean)
    };
    let mean_over = |columns: Vec<i64>, rows: Vec<i64>| {
        let n = (columns.len() * rows.len()) as f64;
        let pixels = rows
            .iter()
            .flat_map(|&y| columns.iter().map(move |&x| [x, y]));
        pixels.map(|[x, y]| detail(x, y)).sum::<f64>() / n
    };
    let bands = |n: i64, wrap: Wrap| -> Vec<Vec<i64>> {
        let firsts = if wrap == Wrap::Repeat { n } else { n - 7 };
        (0..firsts)
            .map(|first| (first..first + 8).map(|at| at % n).collect())
            .collect()
    };
    let (columns, rows): (Vec<i64>, Vec<i64>) = ((0..width).collect(), (0..height).collect());
    let upright = bands(width, wrap[0])
        .into_iter()
        .map(|band| mean_over(band, rows.clone()));
    let level = bands(height, wrap[1])
        .into_iter()
        .map(|band| mean_over(columns.clone(), band));
    let lowest = upright.chain(level).fold(f64::INFINITY, f64::min);
    (lowest / mean_over(columns.clone(), rows.clone())).sqrt()
}

#[test]
fn lowest_detail_equals_its_definition() {
    for wrap in [REPEAT, [Wrap::Mirror; 2], [Wrap::Mirror, Wrap::Repeat]] {
        for size in [[20, 13], [8, 30]] {
            let image = noise(size, |x| 1.0 + x as f32);
            let [found, expected] = [lowest_detail(&image, wrap), naive(&image, wrap)];
            // Sums of a few hundred squares in another order.
            assert!(
                (found - expected).abs() < 1e-12,
                "{found} is not {expected}"
            );
        }
    }
}

#[test]
fn lowest_detail_finds_a_soft_band() {
    let even = lowest_detail(&noise([64, 64], |_| 1.0), REPEAT);
    assert!((0.85..1.0).contains(&even), "{even}");
    // Twelve columns across the wrap have a third of the contrast; a band of 8 columns is inside of them.
    let soft = |x: u32| if (6..58).contains(&x) { 1.0 } else { 1.0 / 3.0 };
    let found = lowest_detail(&noise([64, 64], soft), REPEAT);
    // The whole has √((52 + 12/9) / 64) = 0.91 of the full contrast.
    assert!((found - 0.33 / 0.91).abs() < 0.04, "{found}");
}

#[test]
fn lowest_detail_of_flat_and_tiny_images_is_one() {
    for size in [[1, 1], [2, 2], [1, 7], [300, 1], [16, 16]] {
        let flat = Raster::filled(size, 0.1).unwrap();
        assert_eq!(lowest_detail(&flat, REPEAT), 1.0, "{size:?}");
    }
    let checker = Raster::from_fn([5, 3], |x, y| ((x + y) % 2) as f32).unwrap();
    let of_checker = lowest_detail(&checker, [Wrap::Mirror; 2]);
    // Bands are as wide as the image.
    assert!((of_checker - 1.0).abs() < 1e-12, "{of_checker}");
}

#[test]
fn lowest_detail_of_half_an_image_is_zero() {
    let half = lowest_detail(&noise([64, 64], |x| if x < 32 { 1.0 } else { 0.0 }), REPEAT);
    assert_eq!(half, 0.0);
}

#[test]
fn value_stability_lowest_detail() {
    let bits = lowest_detail(&noise([30, 20], |x| 1.0 + x as f32), REPEAT).to_bits();
    assert_eq!(bits, 4598988708584277915);
}
