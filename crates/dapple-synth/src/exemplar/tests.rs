//! Exemplars and pyramids compared with naive implementations.

use super::{Edges, Exemplar};
use crate::{SynthError, SynthErrorKind};
use dapple_color::LinearRgb;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::{Raster, Wrap};
use proptest::prelude::*;

/// Noise with `channels` planes.
fn noise(size: [u32; 2], channels: u64, edges: Edges) -> Exemplar {
    let planes: Vec<Raster<f32>> = (0..channels)
        .map(|channel| {
            let value = |x: u32, y: u32| {
                unit_f32((hash2(Seed(channel), [x.into(), y.into()], 0) >> 32) as u32)
            };
            Raster::from_fn(size, value).unwrap()
        })
        .collect();
    let planes: Vec<_> = planes.iter().map(|plane| (plane, 1.0)).collect();
    Exemplar::from_planes(&planes, edges).unwrap()
}

/// One pixel of the coarser level from 25 pixels of the finer level, computed in `f64`.
fn naive(finer: &Exemplar, [column, row]: [u32; 2], channel: usize) -> f64 {
    let weights = [1.0, 4.0, 6.0, 4.0, 1.0];
    let wrap = match finer.edges {
        Edges::Cut => Wrap::Mirror,
        Edges::Wrap => Wrap::Repeat,
    };
    let mut sum = 0.0;
    for (j, weight_y) in (-2..).zip(weights) {
        for (i, weight_x) in (-2..).zip(weights) {
            let x = wrap.index(i64::from(2 * column) + i, finer.size[0]);
            let y = wrap.index(i64::from(2 * row) + j, finer.size[1]);
            let pixel = (y * finer.size[0] + x) as usize;
            sum +=
                weight_x * weight_y * f64::from(finer.pixels[pixel * finer.n_channels + channel]);
        }
    }
    sum / 256.0
}

fn kind(result: Result<impl core::fmt::Debug, SynthError>) -> SynthErrorKind {
    result.unwrap_err().kind().clone()
}

#[test]
fn levels_equal_the_naive_mean_of_25_pixels() {
    for size in [[8, 8], [7, 5], [1, 1], [2, 2], [1, 9], [12, 3]] {
        for edges in [Edges::Cut, Edges::Wrap] {
            let pyramid = noise(size, 2, edges).pyramid(4).unwrap();
            for pair in pyramid.levels().windows(2) {
                let [finer, coarser] = pair else {
                    unreachable!()
                };
                assert_eq!(
                    coarser.size,
                    finer.size.map(|side| side.div_ceil(2)),
                    "size"
                );
                for row in 0..coarser.size[1] {
                    for column in 0..coarser.size[0] {
                        for channel in 0..2 {
                            let pixel = (row * coarser.size[0] + column) as usize;
                            let value = f64::from(coarser.pixels[pixel * 2 + channel]);
                            let expected = naive(finer, [column, row], channel);
                            // Tolerance: ten roundings of f32 for values up to 1.
                            assert!(
                                (value - expected).abs() < 1e-6,
                                "{size:?} {value} {expected}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_spot_becomes_the_weights_of_the_kernel() {
    // Sixteen columns with a spot in column 8, which contributes to columns 3, 4 and 5 of the coarser level.
    let plane = Raster::from_fn([16, 1], |x, _| if x == 8 { 16.0 } else { 0.0 }).unwrap();
    let pyramid = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap)
        .unwrap()
        .pyramid(2)
        .unwrap();
    assert_eq!(
        pyramid.levels()[1].pixels,
        [0.0, 0.0, 0.0, 1.0, 6.0, 1.0, 0.0, 0.0],
        "spot"
    );
}

#[test]
fn a_constant_stays_to_the_last_bit() {
    let plane = Raster::filled([13, 6], 0.7).unwrap();
    for edges in [Edges::Cut, Edges::Wrap] {
        let pyramid = Exemplar::from_planes(&[(&plane, 1.0)], edges)
            .unwrap()
            .pyramid(6)
            .unwrap();
        let values = pyramid.levels().iter().flat_map(|level| &level.pixels);
        // Tolerance: five products with weights that sum to one are rounded a few times.
        assert!(
            values.into_iter().all(|value| (value - 0.7).abs() < 1e-6),
            "constant"
        );
    }
}

#[test]
fn a_wrapping_exemplar_commutes_with_even_shifts() {
    let exemplar = noise([16, 8], 1, Edges::Wrap);
    let shifted: Vec<f32> = (0..16 * 8)
        .map(|pixel| exemplar.pixels[(pixel / 16 + 2) % 8 * 16 + (pixel % 16 + 4) % 16])
        .collect();
    let shifted = Exemplar {
        pixels: shifted,
        ..exemplar.clone()
    };
    let [level, moved] =
        [exemplar, shifted].map(|exemplar| exemplar.pyramid(2).unwrap().levels[1].clone());
    for pixel in 0..8 * 4 {
        let from = (pixel / 8 + 1) % 4 * 8 + (pixel % 8 + 2) % 8;
        assert_eq!(moved.pixels[pixel], level.pixels[from], "pixel {pixel}");
    }
}

#[test]
fn wrapping_ends_after_the_first_odd_side() {
    let edges = |size| -> Vec<Edges> {
        let pyramid = noise(size, 1, Edges::Wrap).pyramid(4).unwrap();
        pyramid.levels().iter().map(Exemplar::edges).collect()
    };
    assert_eq!(edges([16, 8]), [Edges::Wrap; 4], "powers of two");
    assert_eq!(
        edges([16, 10]),
        [Edges::Wrap, Edges::Wrap, Edges::Cut, Edges::Cut],
        "5 rows"
    );
}

#[test]
fn colors_are_matched_in_their_codes() {
    let codes = [[0_u8, 51, 255], [1, 2, 102]];
    let image = Raster::from_vec([2, 1], codes.map(LinearRgb::from_srgb).to_vec()).unwrap();
    let exemplar = Exemplar::new(&image, Edges::Cut).unwrap();
    let expected: Vec<f32> = codes
        .as_flattened()
        .iter()
        .map(|&code| f32::from(code) / 255.0)
        .collect();
    assert_eq!(exemplar.pixels(), expected, "codes over 255");
    assert_eq!(
        [exemplar.n_channels(), exemplar.size()[0] as usize],
        [3, 2],
        "shape"
    );
}

#[test]
fn planes_are_scaled_with_the_roots_of_their_weights() {
    let [a, b] = [0.5_f32, 0.25].map(|value| Raster::filled([1, 2], value).unwrap());
    let exemplar = Exemplar::from_planes(&[(&a, 4.0), (&b, 1.0)], Edges::Cut).unwrap();
    assert_eq!(
        exemplar.pixels(),
        [1.0, 0.25, 1.0, 0.25],
        "planes side by side"
    );
}

#[test]
fn bad_exemplars_are_refused() {
    let good = Raster::filled([3, 2], 0.5_f32).unwrap();
    let other = Raster::filled([2, 3], 0.5_f32).unwrap();
    let mut bad = good.clone();
    bad.pixels_mut()[4] = f32::INFINITY;
    assert!(
        matches!(
            kind(Exemplar::from_planes(&[], Edges::Cut)),
            SynthErrorKind::Count { count: 0, .. }
        ),
        "none"
    );
    let sizes = Exemplar::from_planes(&[(&good, 1.0), (&other, 1.0)], Edges::Cut);
    assert!(matches!(kind(sizes), SynthErrorKind::Raster(_)), "sizes");
    for weight in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let weights = Exemplar::from_planes(&[(&good, weight)], Edges::Cut);
        assert!(
            matches!(kind(weights), SynthErrorKind::Range { .. }),
            "weight {weight}"
        );
    }
    let expected = SynthErrorKind::NotFinite {
        column: 1,
        row: 1,
        value: f32::INFINITY,
    };
    assert_eq!(
        kind(Exemplar::from_planes(&[(&bad, 1.0)], Edges::Cut)),
        expected,
        "infinite"
    );
    let mut image = Raster::filled([2, 2], LinearRgb::WHITE).unwrap();
    image.pixels_mut()[1].g = f32::NAN;
    let refused = kind(Exemplar::new(&image, Edges::Cut));
    assert!(
        matches!(
            refused,
            SynthErrorKind::NotFinite {
                column: 1,
                row: 0,
                ..
            }
        ),
        "NaN"
    );
}

#[test]
fn value_stability_pyramid() {
    let pyramid = noise([6, 5], 1, Edges::Cut).pyramid(3).unwrap();
    let bits: Vec<u32> = pyramid.levels()[2]
        .pixels
        .iter()
        .map(|value| value.to_bits())
        .collect();
    assert_eq!(
        bits,
        [1053878080, 1053281776, 1057083031, 1055844992],
        "the coarsest level"
    );
}

proptest! {
    #[test]
    fn pyramids_keep_the_range_of_any_image(width in 1_u32..20, height in 1_u32..20, n_levels in 0_usize..20) {
        let exemplar = noise([width, height], 1, if width % 2 == 0 { Edges::Wrap } else { Edges::Cut });
        match exemplar.pyramid(n_levels) {
            Ok(pyramid) => {
                prop_assert_eq!(pyramid.levels().len(), n_levels);
                for level in pyramid.levels() {
                    // Values of the noise are from 0 to 1; means may round up by an ulp.
                    prop_assert!(level.pixels.iter().all(|value| (0.0..=1.000_001).contains(value)));
                }
            }
            Err(error) => {
                prop_assert!(n_levels == 0 || n_levels > 16);
                let range = matches!(error.kind(), SynthErrorKind::Range { .. });
                prop_assert!(range);
            }
        }
    }
}

#[test]
fn masked_pixels_do_not_count_in_the_means_of_coarser_levels() {
    for (size, edges) in [
        ([20, 12], Edges::Cut),
        ([20, 12], Edges::Wrap),
        ([21, 13], Edges::Cut),
    ] {
        let whole = noise(size, 2, edges);
        let is_whole = Raster::filled(size, true).unwrap();
        let same = whole.clone().with_mask(&is_whole).unwrap();
        for (a, b) in
            (whole.pyramid(3).unwrap().levels().iter()).zip(same.pyramid(3).unwrap().levels())
        {
            assert_eq!(a.pixels, b.pixels, "all is usable");
        }
        let is_off = |x: u32, y: u32| (x, y) == (0, 5) || (9..15).contains(&x) && y > 7;
        let mask = Raster::from_fn(size, |x, y| !is_off(x, y)).unwrap();
        let pyramid = whole.with_mask(&mask).unwrap().pyramid(3).unwrap();
        let mut n_usable = 0;
        for pair in pyramid.levels().windows(2) {
            let [finer, coarser] = pair else {
                unreachable!()
            };
            // Divide the weighted sum of the usable pixels by their total weight, the mean of the mask.
            let usable = finer.usable.as_ref().unwrap();
            let mut masked = finer.clone();
            for (at, value) in masked.pixels.iter_mut().enumerate() {
                *value *= f32::from(usable[at / 2]);
            }
            let marks = Exemplar {
                n_channels: 1,
                pixels: usable.iter().map(|&usable| f32::from(usable)).collect(),
                ..finer.clone()
            };
            let wrap = finer.edges.wrap();
            for (at, &is_usable) in (0..).zip(coarser.usable.as_ref().unwrap()) {
                let place = [at % coarser.size[0], at / coarser.size[0]];
                let mut covered = (0..4).map(|child| {
                    let x = wrap.index((2 * place[0] + child % 2).into(), finer.size[0]);
                    let y = wrap.index((2 * place[1] + child / 2).into(), finer.size[1]);
                    usable[(y * finer.size[0] + x) as usize]
                });
                assert_eq!(is_usable, covered.all(|one| one), "{place:?}");
                for channel in (0..2).filter(|_| is_usable) {
                    let value = f64::from(coarser.pixels[at as usize * 2 + channel]);
                    let expected = naive(&masked, place, channel) / naive(&marks, place, 0);
                    // Tolerance: ten roundings of f32 for values up to 1, divided by a weight above a third.
                    assert!(
                        (value - expected).abs() < 3e-6,
                        "{place:?} {value} {expected}"
                    );
                    n_usable += 1;
                }
            }
        }
        assert!(n_usable > 100, "pixels beside the mask");
    }
}

#[test]
fn reduced_exemplars_are_means_of_squares() {
    let mask = Raster::from_fn([13, 9], |x, y| (x, y) != (4, 7)).unwrap();
    let exemplar = noise([13, 9], 2, Edges::Wrap).with_mask(&mask).unwrap();
    assert_eq!(exemplar.reduced(1).unwrap(), exemplar, "by 1");
    for factor in [2, 3, 9] {
        let reduced = exemplar.reduced(factor).unwrap();
        assert_eq!(reduced.size, [13 / factor, 9 / factor], "size by {factor}");
        assert_eq!(reduced.edges, Edges::Cut, "a column is left out");
        for (at, &value) in (0..).zip(&reduced.pixels) {
            let [x, y] = [at / 2 % reduced.size[0], at / 2 / reduced.size[0]];
            let (mut sum, mut usable) = (0.0, true);
            for (i, j) in (0..factor).flat_map(|j| (0..factor).map(move |i| (i, j))) {
                let pixel = (y * factor + j) * 13 + x * factor + i;
                sum += f64::from(exemplar.pixels[(pixel * 2 + at % 2) as usize]);
                usable &= mask.pixels()[pixel as usize];
            }
            assert_eq!(
                value,
                (sum / f64::from(factor * factor)) as f32,
                "{factor} {at}"
            );
            let is_usable = reduced.usable.as_ref().unwrap()[(at / 2) as usize];
            assert_eq!(is_usable, usable, "{factor} {at}");
        }
    }
    let whole = noise([8, 12], 1, Edges::Wrap).reduced(4).unwrap();
    assert_eq!(whole.edges, Edges::Wrap, "nothing is left out");
    for factor in [0, 10] {
        let refused = kind(exemplar.reduced(factor));
        let is_range = matches!(refused, SynthErrorKind::Range { what: "factor", .. });
        assert!(is_range, "{factor}");
    }
}

#[test]
fn channels_beside_others_are_those_of_planes_with_their_weights() {
    let plane = |channel: u64| {
        let value = move |x: u32, y: u32| {
            unit_f32((hash2(Seed(channel), [x.into(), y.into()], 0) >> 32) as u32)
        };
        Raster::from_fn([7, 5], value).unwrap()
    };
    let planes = [0, 1, 2].map(plane);
    let [a, b, c] = [0, 1, 2].map(|at| (&planes[at], 1.0));
    let one = |planes: &[(&Raster<f32>, f32)]| Exemplar::from_planes(planes, Edges::Wrap).unwrap();
    let mask = Raster::from_fn([7, 5], |x, _| x > 2).unwrap();
    let joined = one(&[a]).with_mask(&mask).unwrap();
    let joined = joined.with_channels(&one(&[b, c]), 0.3).unwrap();
    let expected = one(&[a, (b.0, 0.3), (c.0, 0.3)]);
    assert_eq!(joined, expected.with_mask(&mask).unwrap());

    let other = one(&[b, c]);
    for weight in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let refused = kind(one(&[a]).with_channels(&other, weight));
        assert!(matches!(refused, SynthErrorKind::Range { .. }), "{weight}");
    }
    let refused = kind(one(&[a]).with_channels(&other, 1e30));
    assert!(matches!(refused, SynthErrorKind::Range { .. }), "too large");
    let other = noise([5, 7], 1, Edges::Wrap);
    let refused = kind(one(&[a]).with_channels(&other, 1.0));
    assert!(
        matches!(refused, SynthErrorKind::Count { count: 5, .. }),
        "another size"
    );
}
