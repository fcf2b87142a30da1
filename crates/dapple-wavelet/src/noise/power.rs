//! Test of the power of a band inside and outside its octave, by a Fourier transform of its samples.

use super::WaveletNoise2;
use dapple_hash::Seed;
use dapple_raster::glam::DVec2;

/// Number of cells along a side of a tile.
const CELLS: usize = 32;

/// Number of samples per cell. Frequencies above its resolution have less than a thousandth of the power.
const PER_CELL: usize = 4;

const SIDE: usize = CELLS * PER_CELL;

/// Returns the complex roots of unity of order `SIDE`, by half-angle formulas without trigonometric functions.
fn roots() -> Vec<[f64; 2]> {
    // Start with a quarter turn and halve it until it is one step.
    let (mut cosine, mut sine, mut steps) = (0.0_f64, 1.0_f64, 4);
    while steps < SIDE {
        (cosine, sine) = (((1.0 + cosine) / 2.0).sqrt(), ((1.0 - cosine) / 2.0).sqrt());
        steps *= 2;
    }
    let turned = |&[x, y]: &[f64; 2]| Some([x * cosine - y * sine, x * sine + y * cosine]);
    core::iter::successors(Some([1.0, 0.0]), turned)
        .take(SIDE)
        .collect()
}

/// Returns the Fourier transform of a line.
fn transform(line: &[[f64; 2]], roots: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let at = |frequency: usize| {
        let mut sum = [0.0; 2];
        for (index, [x, y]) in line.iter().enumerate() {
            let [cosine, sine] = roots[frequency * index % SIDE];
            sum[0] += x * cosine + y * sine;
            sum[1] += y * cosine - x * sine;
        }
        sum
    };
    (0..SIDE).map(at).collect()
}

/// Returns the power for each frequency in cycles per tile, where the frequency is the larger one of both axes.
fn power(seed: u64, roots: &[[f64; 2]]) -> Vec<f64> {
    let noise = WaveletNoise2::new(CELLS as u32, Seed(seed)).unwrap();
    let sample = |x: usize, y: usize| {
        let at = DVec2::new(x as f64, y as f64) / PER_CELL as f64;
        [f64::from(noise.sample(at)), 0.0]
    };
    let rows: Vec<_> = (0..SIDE)
        .map(|y| {
            let row: Vec<_> = (0..SIDE).map(|x| sample(x, y)).collect();
            transform(&row, roots)
        })
        .collect();
    let mut power = vec![0.0; SIDE / 2 + 1];
    for x in 0..SIDE {
        let column: Vec<_> = rows.iter().map(|row| row[x]).collect();
        for (y, [re, im]) in transform(&column, roots).into_iter().enumerate() {
            let of = |at: usize| at.min(SIDE - at);
            power[of(x).max(of(y))] += re * re + im * im;
        }
    }
    power
}

#[test]
fn most_power_of_a_band_is_in_its_octave() {
    let roots = roots();
    let mut sums = vec![0.0; SIDE / 2 + 1];
    for seed in 0..16 {
        for (sum, power) in sums.iter_mut().zip(power(seed, &roots)) {
            *sum += power;
        }
    }
    let all: f64 = sums.iter().sum();
    let [quarter, half] = [CELLS / 4, CELLS / 2];
    let ends = (sums[quarter] + sums[half]) / 2.0;
    // Split the frequencies at the ends equally between both sides.
    let within = (sums[quarter + 1..half].iter().sum::<f64>() + ends) / all;
    let below = (sums[..quarter].iter().sum::<f64>() + sums[quarter] / 2.0) / all;
    let above = 1.0 - within - below;
    // About 700 frequencies of each of 16 tiles give a standard error of 0.4 %.
    assert!((within - 0.84).abs() < 0.012, "{within}");
    assert!((below - above).abs() < 0.024, "{below} and {above}");
    let far_below = sums[..CELLS / 8].iter().sum::<f64>() / all;
    assert!(far_below < 1e-4, "{far_below}");
}
