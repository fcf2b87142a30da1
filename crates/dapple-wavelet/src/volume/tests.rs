//! Tests of filters for volumes against filters for lines.

use super::*;
use crate::Degree;
use crate::ends::shortest;
use crate::oracle::{all_filters, noise};

const PERIODIC: [Border; 3] = [Border::Periodic; 3];

fn noise_volume(size: [u32; 3]) -> Vec<f32> {
    let count = size.iter().product::<u32>() as usize;
    noise(count).iter().map(|&value| value as f32).collect()
}

/// Applies `change` to each line along an axis, and rounds to `f32`. Returns the volume and its new size.
fn along(
    volume: &[f32],
    size: [u32; 3],
    axis: usize,
    change: impl Fn(&[f64]) -> Vec<f64>,
) -> (Vec<f32>, [u32; 3]) {
    let strides = |size: [u32; 3]| [1, size[0] as usize, (size[0] * size[1]) as usize];
    let len = change(&vec![0.0; size[axis] as usize]).len();
    let mut new_size = size;
    new_size[axis] = len as u32;
    let mut changed = vec![0.0; new_size.iter().product::<u32>() as usize];
    let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
    for j in 0..size[b] as usize {
        for k in 0..size[c] as usize {
            let place =
                |size, i| strides(size)[axis] * i + strides(size)[b] * j + strides(size)[c] * k;
            let line: Vec<f64> = (0..size[axis] as usize)
                .map(|i| volume[place(size, i)].into())
                .collect();
            for (i, value) in change(&line).into_iter().enumerate() {
                changed[place(new_size, i)] = value as f32;
            }
        }
    }
    (changed, new_size)
}

#[test]
fn volumes_equal_lines_bit_for_bit() {
    let borders = [Border::Mirror, Border::Periodic, Border::Mirror];
    for filter in all_filters() {
        let least = shortest(filter, Border::Mirror) as u32;
        for size in [[9, 6, 11], [least, 2, least], [3, 20, least]] {
            let fine = noise_volume(size);
            let (mut needed, mut needed_size) = (fine.clone(), size);
            for (axis, &border) in borders.iter().enumerate() {
                let halve = |line: &[f64]| filter.down_line(line, border).expect("a good line");
                (needed, needed_size) = along(&needed, needed_size, axis, halve);
            }
            let coarse = filter
                .down_volume(&fine, size, borders)
                .expect("a good volume");
            assert_eq!(coarse, needed, "down, {filter:?}, {size:?}");
            for axis in [2, 1, 0] {
                let len = size[axis] as usize;
                let double = |line: &[f64]| {
                    filter
                        .up_line(line, len, borders[axis])
                        .expect("a good line")
                };
                (needed, needed_size) = along(&needed, needed_size, axis, double);
            }
            let again = filter
                .up_volume(&coarse, size, borders)
                .expect("a good volume");
            assert_eq!(again, needed, "up, {filter:?}, {size:?}");
        }
    }
}

#[test]
fn huge_volumes_stay_finite_up_to_their_bound_only() {
    const SIDE: usize = 16;
    for filter in all_filters() {
        let tap = |k: usize| {
            let mut line = [0.0; SIDE];
            line[k] = 1.0;
            let coarse = filter.down_line(&line, Border::Periodic);
            coarse.expect("a good line")[0]
        };
        let taps: Vec<f64> = (0..SIDE).map(tap).collect();
        // Values with the maximum response: each has the sign of its tap.
        let down = |size: f32| {
            let places = (0..SIDE.pow(3)).map(|at| [at % SIDE, at / SIDE % SIDE, at / SIDE / SIDE]);
            let taps = places.map(|place| place.map(|k| taps[k]).iter().product::<f64>());
            let volume: Vec<f32> = taps.map(|tap| size.copysign(tap as f32)).collect();
            let coarse = filter.down_volume(&volume, [SIDE as u32; 3], [Border::Periodic; 3]);
            coarse.expect("finite values")
        };
        let below = down(f32::MAX / 56.0);
        assert!(below.iter().all(|value| value.is_finite()), "{filter:?}");
        // The mean of the constant degree is computed in `f64` and does not overflow.
        let is_finite = filter.degree == Degree::Constant;
        assert_eq!(down(f32::MAX)[0].is_finite(), is_finite, "{filter:?}");
    }
}

#[test]
fn project_volume_changes_nothing_twice() {
    let size = [16, 8, 12];
    let filter = SplineFilter::default();
    let project = |volume: &[f32]| {
        filter
            .project_volume(volume, size, 2, PERIODIC)
            .expect("a good volume")
    };
    let once = project(&noise_volume(size));
    let gaps = project(&once)
        .into_iter()
        .zip(&once)
        .map(|(a, b)| (a - b).abs())
        .collect::<Vec<_>>();
    // Tolerance: twelve roundings to f32 of values below 1.
    assert!(gaps.iter().all(|&gap| gap < 1e-6), "{gaps:?}");
    let none = filter.project_volume(&once, size, 0, PERIODIC);
    assert_eq!(none, Ok(once), "zero levels");
}

#[test]
fn residual_of_white_noise_has_the_variance_of_the_note() {
    let size = [64; 3];
    let volume = noise_volume(size);
    let kept = SplineFilter::default()
        .project_volume(&volume, size, 1, PERIODIC)
        .expect("a good volume");
    let power =
        |values: &mut dyn Iterator<Item = f32>| values.map(|v| f64::from(v * v)).sum::<f64>();
    let lost = power(&mut volume.iter().zip(&kept).map(|(fine, kept)| fine - kept));
    let ratio = lost / power(&mut volume.iter().copied());
    // 2^18 values estimate a variance to about 0.2 %.
    assert!((ratio / 0.877_121_964 - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn bad_volumes_are_refused() {
    let filter = SplineFilter::default();
    let kind =
        |result: Result<Vec<f32>, WaveletError>| result.expect_err("a bad volume").kind().clone();
    let length = |length, needed| WaveletErrorKind::Length { length, needed };
    assert_eq!(
        kind(filter.down_volume(&[0.0; 7], [2; 3], PERIODIC)),
        length(7, 8),
        "seven of eight"
    );
    let huge = [u32::MAX - 1; 3];
    assert_eq!(
        kind(filter.down_volume(&[0.0; 8], huge, PERIODIC)),
        length(8, usize::MAX),
        "huge"
    );
    assert_eq!(
        kind(filter.up_volume(&[0.0; 2], [2; 3], PERIODIC)),
        length(2, 1),
        "two for one"
    );
    let odd = WaveletErrorKind::NotDivisible {
        length: 3,
        levels: 1,
    };
    assert_eq!(
        kind(filter.down_volume(&[0.0; 27], [3; 3], PERIODIC)),
        odd,
        "odd"
    );
    let short = WaveletErrorKind::TooShort {
        length: 1,
        least: 2,
    };
    let mirrored = [Border::Mirror; 3];
    assert_eq!(
        kind(filter.down_volume(&[0.0; 4], [2, 2, 1], mirrored)),
        short,
        "flat"
    );
    assert_eq!(
        kind(filter.up_volume(&[0.0; 1], [2, 2, 0], mirrored)),
        WaveletErrorKind::TooShort {
            length: 0,
            least: 2
        },
        "nothing"
    );
    let mut volume = [0.0; 8];
    volume[5] = f32::INFINITY;
    for result in [
        filter.down_volume(&volume, [2; 3], PERIODIC),
        filter.up_volume(&volume, [4; 3], PERIODIC),
        filter.project_volume(&volume, [2; 3], 0, PERIODIC),
    ] {
        let kind = kind(result);
        assert!(
            matches!(kind, WaveletErrorKind::NotFinite { index: 5, .. }),
            "{kind:?}"
        );
    }
}
