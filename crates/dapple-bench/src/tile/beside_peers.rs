//! A map from a tile compared with fractal Perlin noise of another crate.

use super::{FEATURES, MAP, confirm, splat, tile};
use crate::harness::{Bench, Done, Side};
use crate::peers::noise;
use crate::row::Case;
use anyhow::{Result, ensure};

const PERLIN: Case = Case {
    peer: "noise-functions Perlin, five octaves, per pixel",
    ..FEATURES
};

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&PERLIN) {
        return Ok(());
    }
    let tile = tile()?;
    let n_pixels = MAP as usize * MAP as usize;
    let theirs = Side::new(vec![0.0; n_pixels], |values: &mut Vec<f32>| {
        noise::noise_functions_fbm(MAP as usize, 5, 32.0, values);
    });
    bench.beside(&PERLIN, 5, splat(&tile)?, theirs, |ours, theirs| {
        confirm(&tile, ours)?;
        let squares: f32 = theirs.iter().step_by(97).map(|value| value * value).sum();
        ensure!(
            squares > 0.01 * (n_pixels / 97) as f32,
            "the noise of the peer is flat"
        );
        Ok(Done::both(n_pixels))
    })
}
