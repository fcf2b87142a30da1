//! Rasters against lines.

use super::*;
use crate::oracle::{all_filters, noise};

const PERIODIC: [Border; 2] = [Border::Periodic; 2];

fn noise_raster(size: [u32; 2]) -> Raster<f32> {
    let values = noise(size[0] as usize * size[1] as usize);
    Raster::from_vec(size, values.iter().map(|&value| value as f32).collect()).expect("a good size")
}

/// Halves or doubles rows, or columns, line by line, and rounds to `f32`.
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
        for (size, borders) in [
            ([26, 34], PERIODIC),
            ([2, 4], PERIODIC),
            ([19, 37], [Border::Mirror; 2]),
            ([2, 3], [Border::Mirror; 2]),
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
