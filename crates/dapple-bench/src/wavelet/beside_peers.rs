//! Our filters compared with a Fourier transform, and wavelet noise compared with Perlin noise.

use super::{SIDE, confirm_equal, down_and_up, white_noise};
use crate::harness::{Bench, Done, Side};
use crate::noise::{beside_perlin, confirm_spread, one_by_one};
use crate::peers::fourier::FourierProjection;
use crate::peers::noise::noise_functions_perlin_2;
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::Result;
use dapple_wavelet::WaveletNoise;

const FOURIER: Case = Case {
    group: "wavelet",
    case: "down and up, 2048×2048",
    peer: "rustfft, the same projection",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(1.0),
    note: "the peer leaves the raster projected, and no half-size raster",
};

const NOISE: Case = Case {
    group: "wavelet",
    case: "wavelet noise, 2-D, one position",
    peer: "noise-functions Perlin, one octave",
    unit: Unit::NsPerPosition,
    must: Goal::CostAtMost(3.0),
    note: "positions anywhere in a tile of 128×128 cells, in random order",
};

/// Number of cells of the noise tile along each axis.
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
                // An `f32` transform of 2048 values has an error of about 1e-6.
                confirm_equal(ours.fine.pixels(), &theirs.fine, 1e-5)?;
                Ok(Done::both(raster.pixels().len()))
            },
        )?;
    }
    let tile = WaveletNoise::<2>::new(N_CELLS, SEED)?;
    let one = one_by_one(|at: [f64; 2]| tile.sample(at));
    let perlin = noise_functions_perlin_2;
    beside_perlin(bench, &NOISE, N_CELLS, one, perlin, confirm_spread)
}
