//! The wavelet group: halving and doubling rasters, and wavelet noise.
//!
//! A raster of white noise is halved and doubled again with the paper's filters: quadratic, centered, periodic.
//! Confirmed: the results of both methods are equal, up to the rounding of `f32` and the taps that the other method
//! omits.

mod alone;
#[cfg(feature = "peers")]
mod beside_peers;
mod straight;

use crate::harness::{Bench, Side};
use crate::sets::SEED;
use anyhow::{Result, ensure};
use dapple_hash::{hash2, unit_f32};
use dapple_raster::Raster;
use dapple_wavelet::{Border, FilterMemory, SplineFilter};

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    alone::run(bench)?;
    #[cfg(feature = "peers")]
    beside_peers::run(bench)?;
    Ok(())
}

/// Width and height in pixels of the raster for comparisons with other methods.
const SIDE: u32 = 2048;

/// Periodic borders along both axes.
const PERIODIC: [Border; 2] = [Border::Periodic; 2];

/// Generates white noise in [0, 1).
fn white_noise(side: u32) -> Result<Raster<f32>> {
    let seed = SEED.child("bench wavelet", 0);
    Ok(Raster::from_fn([side; 2], |column, row| {
        unit_f32(hash2(seed, [column.into(), row.into()], 0) as u32)
    })?)
}

/// State of our side: inputs and buffers. All of them are allocated before the timed section, as on the other side.
pub(crate) struct Halved {
    coarse: Raster<f32>,
    memory: FilterMemory,
    /// Result of the last run.
    fine: Raster<f32>,
}

/// Returns our side: it halves a raster, and doubles it again.
fn down_and_up(raster: &Raster<f32>) -> Result<Side<'_, Halved>> {
    let filter = SplineFilter::default();
    let halved = Halved {
        coarse: Raster::filled(raster.size().map(|side| side / 2), 0.0)?,
        memory: FilterMemory::default(),
        fine: Raster::filled(raster.size(), 0.0)?,
    };
    Ok(Side::new(halved, move |halved| {
        let Halved {
            coarse,
            memory,
            fine,
        } = halved;
        filter
            .down_into(raster, PERIODIC, coarse, memory)
            .and_then(|()| filter.up_into(coarse, PERIODIC, fine))
            .expect("the sides are even and the noise is finite");
    }))
}

/// Fails if two rasters differ by more than `most` at any pixel.
fn confirm_equal(ours: &[f32], theirs: &[f32], most: f32) -> Result<()> {
    ensure!(ours.len() == theirs.len(), "the sizes differ");
    let off = ours
        .iter()
        .zip(theirs)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    ensure!(off <= most, "the two ways differ by {off}");
    ensure!(
        ours.iter().any(|value| *value != ours[0]),
        "the picture is flat"
    );
    Ok(())
}
