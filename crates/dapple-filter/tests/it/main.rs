//! Tests that a filtered part equals the same pixels of the filtered raster. The tests of recipes compare each filter
//! with a naive formula.

use dapple_filter::glam::DVec2;
use dapple_filter::{
    DirectionalBlur, Part, SlopeBlur, difference_spans, dilate, disk_halo, distances, erode,
    gaussian, gaussian_halo, gradients,
};

const WHOLE: [i64; 2] = [40, 30];
const RADIUS: f64 = 0.17;

/// Returns a pseudorandom number from 0 to 1 for a pixel of an endless plane.
fn random([x, y]: [i64; 2]) -> f32 {
    let bits = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    let bits = (bits ^ bits >> 15).wrapping_mul(0xC2B2_AE3D);
    (bits >> 16) as f32 / 65_535.0
}

/// Checks that a filter gives the same bits for parts of any size and position.
fn assert_crops(name: &str, halo: [u32; 2], filter: impl Fn(&[f32], &Part) -> Vec<f32>) {
    let of = |first: [i64; 2], size: [u32; 2]| {
        let part = Part {
            size,
            halo,
            pixel: DVec2::new(0.05, 0.04),
        };
        let [width, height] = part.input_size().map(i64::from);
        let start = [0, 1].map(|axis| first[axis] - i64::from(halo[axis]));
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| [start[0] + x, start[1] + y]));
        filter(&rows.map(random).collect::<Vec<_>>(), &part)
    };
    let whole = of([0, 0], WHOLE.map(|side| side as u32));
    for (first, size) in [([0, 0], [40, 1]), ([7, 5], [13, 24]), ([39, 29], [1, 1])] {
        let part = of(first, size);
        for (index, value) in part.iter().enumerate() {
            let [x, y] = [
                index as i64 % i64::from(size[0]),
                index as i64 / i64::from(size[0]),
            ];
            let there = whole[((first[1] + y) * WHOLE[0] + first[0] + x) as usize];
            assert_eq!(
                value.to_bits(),
                there.to_bits(),
                "{name} at {first:?} + {x}, {y}"
            );
        }
    }
    assert!(
        whole.iter().any(|&value| value != whole[0]),
        "{name} varies"
    );
}

#[test]
fn parts_have_the_bits_of_the_whole() {
    let pixel = DVec2::new(0.05, 0.04);
    assert_crops("gaussian", gaussian_halo(RADIUS, pixel), |values, part| {
        gaussian(values, part, RADIUS)
    });
    for is_one_sided in [false, true] {
        let blur = DirectionalBlur::new(DVec2::new(0.6, -0.8), RADIUS, is_one_sided, pixel);
        assert_crops("directional", blur.halo(), |values, part| {
            blur.apply(values, part)
        });
    }
    let blur = SlopeBlur::new(RADIUS, pixel);
    assert_crops("slope", blur.halo(pixel), |values, part| {
        blur.apply(values, values, part)
    });
    assert_crops("dilate", disk_halo(RADIUS, pixel), |values, part| {
        dilate(values, part, RADIUS)
    });
    assert_crops("erode", disk_halo(RADIUS, pixel), |values, part| {
        erode(values, part, RADIUS)
    });
    assert_crops("distances", disk_halo(RADIUS, pixel), |values, part| {
        let mask: Vec<f32> = values.iter().map(|value| value - 0.49).collect();
        distances(&mask, part, RADIUS as f32)
    });
    assert_crops(
        "gradients",
        difference_spans(RADIUS, pixel),
        |values, part| gradients(values, part, 3.0, &|length| length as f32),
    );
}
