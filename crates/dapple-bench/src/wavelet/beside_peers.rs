//! Ours beside a Fourier transform, and wavelet noise beside Perlin noise.

use super::{SIDE, confirm_equal, down_and_up, white_noise};
use crate::harness::{Bench, Done, Side};
use crate::peers::fourier::FourierProjection;
use crate::peers::noise;
use crate::row::{Case, Must, Unit};
use crate::sets::{SEED, positions};
use anyhow::{Result, ensure};
use dapple_wavelet::WaveletNoise;
use glam::DVec2;

const FOURIER: Case = Case {
    group: "wavelet",
    case: "down and up, 2048×2048",
    peer: "rustfft, the same projection",
    unit: Unit::NsPerPixel,
    must: Must::Faster(1.0),
    note: "the peer leaves the raster projected, and no half-size raster",
};

const NOISE: Case = Case {
    group: "wavelet",
    case: "wavelet noise, 2-D, one position",
    peer: "noise-functions Perlin, one octave",
    unit: Unit::NsPerPosition,
    must: Must::CostAtMost(3.0),
    note: "positions anywhere in a tile of 128×128 cells, in random order",
};

/// How many positions are asked for in one run.
const N_POSITIONS: usize = 1 << 16;

/// Cells along each axis of the noise tile.
const N_CELLS: u32 = 128;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if bench.wants(&FOURIER) {
        let raster = white_noise(SIDE)?;
        let theirs = Side::new(
            FourierProjection::new(SIDE as usize),
            |fourier: &mut FourierProjection| fourier.run(raster.pixels()),
        );
        bench.beside(
            &FOURIER,
            31,
            down_and_up(&raster)?,
            theirs,
            |ours, theirs| {
                // A transform of 2048 values in f32 loses some 1e-6.
                confirm_equal(ours.fine.pixels(), &theirs.fine, 1e-5)?;
                Ok(Done::both(raster.pixels().len()))
            },
        )?;
    }
    if bench.wants(&NOISE) {
        one_position(bench)?;
    }
    Ok(())
}

fn one_position(bench: &mut Bench) -> Result<()> {
    let tile = WaveletNoise::<2>::new(N_CELLS, SEED)?;
    let at: Vec<DVec2> = positions(N_POSITIONS)
        .into_iter()
        .map(|at| at * f64::from(N_CELLS))
        .collect();
    let their_at: Vec<[f32; 2]> = at.iter().map(|at| at.as_vec2().to_array()).collect();
    let ours = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        for (value, &at) in values.iter_mut().zip(&at) {
            *value = tile.sample(at);
        }
    });
    let theirs = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        noise::noise_functions_perlin(&their_at, values);
    });
    bench.beside(&NOISE, 101, ours, theirs, |ours, theirs| {
        for values in [ours, theirs] {
            let spread = values.iter().map(|value| value * value).sum::<f32>();
            ensure!(
                spread > 0.01 * N_POSITIONS as f32,
                "the noise is flat: {spread}"
            );
        }
        Ok(Done::both(N_POSITIONS))
    })
}
