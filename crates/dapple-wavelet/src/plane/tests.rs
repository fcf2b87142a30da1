//! Tests of filters for rasters against filters for lines.

use super::*;
use crate::WaveletErrorKind;
use crate::ends::shortest;
use crate::oracle::{all_filters, distance, noise};
use proptest::prelude::*;

const PERIODIC: [Border; 2] = [Border::Periodic; 2];

fn noise_raster(size: [u32; 2]) -> Raster<f32> {
    let values = noise(size[0] as usize * size[1] as usize);
    Raster::from_vec(size, values.iter().map(|&value| value as f32).collect()).expect("a good size")
}

/// Applies `change` to each row (axis 0) or column (axis 1), and rounds to `f32`.
fn along(raster: &Raster<f32>, axis: usize, change: impl Fn(&[f64]) -> Vec<f64>) -> Raster<f32> {
    let [width, height] = raster.size();
    let pixel = |line: u32, i: u32| {
        let [x, y] = if axis == 0 { [i, line] } else { [line, i] };
        f64::from(raster.row(y)[x as usize])
    };
    let (lines, len) = if axis == 0 {
        (height, width)
    } else {
        (width, height)
    };
    let changed: Vec<Vec<f64>> = (0..lines)
        .map(|line| change(&(0..len).map(|i| pixel(line, i)).collect::<Vec<_>>()))
        .collect();
    let new_len = changed[0].len() as u32;
    let size = if axis == 0 {
        [new_len, height]
    } else {
        [width, new_len]
    };
    Raster::from_fn(size, |x, y| {
        let [line, i] = if axis == 0 { [y, x] } else { [x, y] };
        changed[line as usize][i as usize] as f32
    })
    .expect("a good size")
}

#[test]
fn down_and_up_equal_lines_bit_for_bit() {
    for filter in all_filters() {
        let least = shortest(filter, Border::Mirror) as u32;
        for (size, borders) in [
            ([26, 34], PERIODIC),
            ([2, 4], PERIODIC),
            ([19, 37], [Border::Mirror; 2]),
            ([least, 3], [Border::Mirror; 2]),
            ([16, 9], [Border::Periodic, Border::Mirror]),
        ] {
            let fine = noise_raster(size);
            let halve = |axis: usize| {
                move |line: &[f64]| filter.down_line(line, borders[axis]).expect("a good line")
            };
            let needed = along(&along(&fine, 0, halve(0)), 1, halve(1));
            let coarse = filter.down(&fine, borders).expect("a good raster");
            assert_eq!(coarse, needed, "down, {filter:?}, {size:?}, {borders:?}");

            let double = |axis: usize| {
                move |line: &[f64]| {
                    let len = size[axis] as usize;
                    filter
                        .up_line(line, len, borders[axis])
                        .expect("a good line")
                }
            };
            let needed = along(&along(&coarse, 1, double(1)), 0, double(0));
            let again = filter.up(&coarse, size, borders).expect("a good raster");
            assert_eq!(again, needed, "up, {filter:?}, {size:?}, {borders:?}");
        }
    }
}

#[test]
fn every_simd_level_gives_the_same_bits() {
    // Complete and incomplete groups of lines, square blocks of values and remainders
    for size in [[38, 46], [16, 24], [6, 4]] {
        let fine = noise_raster(size);
        for filter in all_filters() {
            let [width, height] = size.map(|side| side as usize);
            let halving = [width, height].map(|len| {
                LineFilter::halving(filter, len, Border::Periodic).expect("an even length")
            });
            let coarse = filter.down(&fine, PERIODIC).expect("a good raster");
            let doubling = [0, 1].map(|axis| {
                let doubling = filter.doubling(coarse.size()[axis], size[axis], Border::Periodic);
                doubling.expect("an even length")
            });
            let again = filter.up(&coarse, size, PERIODIC).expect("a good raster");
            simd::for_every_level(|level| {
                let mut halved = vec![f32::NAN; coarse.pixels().len()];
                let filters = [&halving[0], &halving[1]];
                let mut memory = FilterMemory::default();
                let made = memory.filter(level, &fine, filters, &mut halved, &|| false);
                made.expect("nobody cancels");
                assert_eq!(halved, coarse.pixels(), "down, {filter:?}, {level:?}");
                let mut doubled = vec![f32::NAN; fine.pixels().len()];
                let [along_rows, along_columns] = &doubling;
                let coarse = coarse.pixels();
                let made = along_columns.plane(level, along_rows, coarse, &mut doubled, &|| false);
                made.expect("nobody cancels");
                assert_eq!(doubled, again.pixels(), "up, {filter:?}, {level:?}");
            });
        }
    }
}

#[test]
fn memory_that_was_used_before_changes_nothing() {
    let filter = SplineFilter::default();
    let mut memory = FilterMemory::default();
    for size in [[40, 24], [12, 70], [40, 24]] {
        let fine = noise_raster(size);
        let mut coarse = Raster::filled(size.map(|side| side / 2), f32::NAN).expect("a good size");
        filter
            .down_into(&fine, PERIODIC, &mut coarse, &mut memory)
            .expect("a good raster");
        let needed = filter.down(&fine, PERIODIC).expect("a good raster");
        assert_eq!(coarse, needed, "down, {size:?}");
        let mut again = Raster::filled(size, f32::NAN).expect("a good size");
        filter
            .up_into(&coarse, PERIODIC, &mut again)
            .expect("a good raster");
        let needed = filter.up(&coarse, size, PERIODIC).expect("a good raster");
        assert_eq!(again, needed, "up, {size:?}");

        let mut wrong = Raster::filled([5, 5], 0.0).expect("a good size");
        let error = filter.down_into(&fine, PERIODIC, &mut wrong, &mut memory);
        let error = error.expect_err("the size is wrong");
        assert!(
            matches!(error.kind(), WaveletErrorKind::Raster(_)),
            "{error}"
        );
        let error = filter.up_into(&coarse, PERIODIC, &mut wrong);
        let error = error.expect_err("the size is odd");
        assert!(
            matches!(error.kind(), WaveletErrorKind::NotDivisible { .. }),
            "{error}"
        );
    }
}

#[test]
fn down_is_the_same_on_any_number_of_threads() {
    // Wide enough for more than one batch of lines, and for incomplete groups
    let fine = noise_raster([70, 301]);
    let borders = [Border::Mirror; 2];
    let filter = SplineFilter::default();
    let work = || {
        let coarse = filter.down(&fine, borders).expect("a good raster");
        (
            filter
                .up(&coarse, fine.size(), borders)
                .expect("a good raster"),
            coarse,
        )
    };
    let needed = on_threads(1, work);
    for threads in [2, 7] {
        assert!(on_threads(threads, work) == needed, "{threads} threads");
    }
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("a few threads").install(work)
}

#[test]
fn rasters_stay_near_lines_without_roundings() {
    let fine = noise_raster([64, 48]);
    for filter in all_filters() {
        let projected = filter.project(&fine, 2, PERIODIC).expect("a good raster");
        let projected: Vec<f64> = projected
            .pixels()
            .iter()
            .map(|&value| value.into())
            .collect();
        let gap = distance(&projected, &projected_in_f64(filter, &fine, 2));
        assert!(gap < 1e-6, "{filter:?}: {gap}");
    }
}

/// Projects rows and then columns, without rounding to `f32`.
fn projected_in_f64(filter: SplineFilter, fine: &Raster<f32>, levels: u32) -> Vec<f64> {
    let project = |line: &[f64]| {
        let line = filter.project_line(line, levels, Border::Periodic);
        line.expect("a good line")
    };
    let [width, height] = fine.size();
    let row = |y| {
        fine.row(y)
            .iter()
            .map(|&value| value.into())
            .collect::<Vec<f64>>()
    };
    let rows: Vec<Vec<f64>> = (0..height).map(|y| project(&row(y))).collect();
    let column = |x: usize| rows.iter().map(|row| row[x]).collect::<Vec<f64>>();
    let columns: Vec<Vec<f64>> = (0..width as usize).map(|x| project(&column(x))).collect();
    (0..height as usize)
        .flat_map(|y| columns.iter().map(move |column| column[y]))
        .collect()
}

#[test]
fn project_changes_nothing_twice_and_keeps_constants() {
    for filter in all_filters() {
        let project =
            |raster: &Raster<f32>| filter.project(raster, 2, PERIODIC).expect("a good raster");
        let once = project(&noise_raster([32, 16]));
        let gap = greatest_gap(&project(&once), &once);
        // Tolerance: eight roundings to f32 of values up to 2.
        assert!(gap < 2e-6, "{filter:?}: {gap}");
        let flat = Raster::filled([16, 8], 0.7_f32).expect("a good size");
        assert!(greatest_gap(&project(&flat), &flat) < 1e-6, "{filter:?}");
    }
}

fn greatest_gap(a: &Raster<f32>, b: &Raster<f32>) -> f32 {
    a.pixels()
        .iter()
        .zip(b.pixels())
        .fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

#[test]
fn project_of_no_levels_is_the_raster() {
    let raster = noise_raster([5, 3]);
    let projected = SplineFilter::default().project(&raster, 0, PERIODIC);
    assert_eq!(projected, Ok(raster), "zero levels");
}

#[test]
fn axes_commute() {
    let fine = noise_raster([24, 24]);
    let flip = |raster: &Raster<f32>| {
        let [width, height] = raster.size();
        Raster::from_fn([height, width], |x, y| raster.row(x)[y as usize]).expect("a good size")
    };
    for filter in all_filters() {
        let borders = [Border::Periodic, Border::Mirror];
        let straight = filter.project(&fine, 1, borders).expect("a good raster");
        let flipped = filter
            .project(&flip(&fine), 1, [borders[1], borders[0]])
            .expect("a good raster");
        let gap = greatest_gap(&straight, &flip(&flipped));
        // Tolerance: four roundings to f32 of values up to 2.
        assert!(gap < 1e-6, "{filter:?}: {gap}");
    }
}

#[test]
fn residual_of_white_noise_has_the_variance_of_the_note() {
    let fine = noise_raster([512, 512]);
    let kept = SplineFilter::default()
        .project(&fine, 1, PERIODIC)
        .expect("a good raster");
    let power =
        |values: &mut dyn Iterator<Item = f32>| values.map(|v| f64::from(v * v)).sum::<f64>();
    let lost = power(
        &mut fine
            .pixels()
            .iter()
            .zip(kept.pixels())
            .map(|(fine, kept)| fine - kept),
    );
    let ratio = lost / power(&mut fine.pixels().iter().copied());
    // 2^18 values estimate a variance to about 0.2 %.
    assert!((ratio / 0.752_821_340_2 - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn bad_rasters_are_refused() {
    let filter = SplineFilter::default();
    let mirrored = [Border::Mirror; 2];
    let kind = |result: Result<Raster<f32>, WaveletError>| {
        result.expect_err("a bad raster").kind().clone()
    };
    let short = |length| WaveletErrorKind::TooShort { length, least: 2 };
    for size in [[1, 1], [1, 8], [8, 1]] {
        for borders in [PERIODIC, mirrored] {
            assert_eq!(
                kind(filter.down(&noise_raster(size), borders)),
                short(1),
                "{size:?}"
            );
        }
    }
    let odd = WaveletErrorKind::NotDivisible {
        length: 7,
        levels: 1,
    };
    assert_eq!(
        kind(filter.down(&noise_raster([8, 7]), PERIODIC)),
        odd,
        "odd"
    );
    let levels = WaveletErrorKind::NotDivisible {
        length: 12,
        levels: 3,
    };
    assert_eq!(
        kind(filter.project(&noise_raster([16, 12]), 3, PERIODIC)),
        levels,
        "three levels"
    );
    assert_eq!(
        kind(filter.project(&noise_raster([9, 3]), 3, mirrored)),
        short(1),
        "three levels, mirrored"
    );
    let many = kind(filter.project(&noise_raster([8, 8]), u32::MAX, PERIODIC));
    assert!(matches!(many, WaveletErrorKind::Range { .. }), "{many:?}");
    let length = WaveletErrorKind::Length {
        length: 4,
        needed: 5,
    };
    assert_eq!(
        kind(filter.up(&noise_raster([4, 4]), [8, 10], PERIODIC)),
        length,
        "ten of four"
    );
    assert_eq!(
        kind(filter.up(&noise_raster([4, 4]), [0, 8], PERIODIC)),
        short(0),
        "nothing of four"
    );
    let mut raster = noise_raster([4, 4]);
    raster.pixels_mut()[9] = f32::NAN;
    raster.pixels_mut()[12] = f32::INFINITY;
    for result in [
        filter.down(&raster, PERIODIC),
        filter.up(&raster, [8, 8], PERIODIC),
        filter.project(&raster, 0, PERIODIC),
    ] {
        let kind = kind(result);
        assert!(
            matches!(kind, WaveletErrorKind::NotFinite { index: 9, .. }),
            "{kind:?}"
        );
    }
}

#[test]
fn huge_values_stay_finite_up_to_their_bound_only() {
    for filter in all_filters() {
        let taps: Vec<f64> = (0..64)
            .map(|k| {
                let mut line = [0.0; 64];
                line[k] = 1.0;
                filter
                    .down_line(&line, Border::Periodic)
                    .expect("a good line")[0]
            })
            .collect();
        // Pixels with the maximum response: each has the sign of its tap.
        let worst = |size: f32| {
            let pixel =
                |x: u32, y: u32| size.copysign((taps[x as usize] * taps[y as usize]) as f32);
            Raster::from_fn([64, 64], pixel).expect("a good size")
        };
        let below = filter
            .down(&worst(f32::MAX / 15.0), PERIODIC)
            .expect("a good raster");
        assert!(
            below.pixels().iter().all(|value| value.is_finite()),
            "{filter:?}"
        );
        let most = worst(f32::MAX);
        let is_finite = filter.degree == crate::Degree::Constant;
        let coarse = filter.down(&most, PERIODIC).expect("finite values");
        assert_eq!(coarse.pixels()[0].is_finite(), is_finite, "{filter:?}");
        let projected = filter.project(&most, 1, PERIODIC);
        match projected {
            Ok(projected) => assert!(is_finite && projected == most, "{filter:?}"),
            Err(error) => {
                let kind = error.kind();
                let says_so = matches!(kind, WaveletErrorKind::NotFinite { .. });
                assert!(says_so && !is_finite, "{filter:?}: {error}");
            }
        }
    }
}

#[test]
fn value_stability_down_and_up() {
    let fine = noise_raster([12, 10]);
    let filter = SplineFilter::default();
    let coarse = filter.down(&fine, PERIODIC).expect("a good raster");
    let again = filter
        .up(&coarse, fine.size(), PERIODIC)
        .expect("a good raster");
    let bits = [
        coarse.row(2)[3],
        coarse.row(4)[5],
        again.row(0)[0],
        again.row(7)[9],
    ]
    .map(f32::to_bits);
    assert_eq!(
        bits,
        [0x3f16_f29b, 0xbee0_8be8, 0xbe8c_8e65, 0xbeb8_47e0],
        "{bits:#x?}"
    );
}

proptest! {
    #[test]
    fn rasters_of_any_size_are_filtered_or_refused(
        size in [1..40_u32, 1..40_u32],
        mirrored in [any::<bool>(), any::<bool>()],
        levels in 0..7_u32,
        which in 0..16_usize,
    ) {
        let borders = mirrored.map(|mirrored| if mirrored { Border::Mirror } else { Border::Periodic });
        let filter = all_filters()[which];
        let raster = noise_raster(size);
        match filter.project(&raster, levels, borders) {
            Ok(projected) => prop_assert_eq!(projected.size(), size),
            Err(error) => {
                let is_known = matches!(
                    error.kind(),
                    WaveletErrorKind::NotDivisible { .. } | WaveletErrorKind::TooShort { .. }
                );
                prop_assert!(is_known, "{}", error);
            }
        }
    }
}
