//! Wavelet noise, in two and three dimensions.

use super::{array, unknown_axes};
use crate::error::{Error, Result};
use crate::field::Field;
use crate::function::{Function, Made};
use crate::grid::per_axis;
use crate::seed::SeedArgument;
use crate::shared::{Build, Shared};
use crate::watch::Stop;
use dapple::hash::Seed;
use dapple::wavelet::{WaveletNoise2, WaveletNoise3};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Description of wavelet noise as data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WaveletMade {
    seed: Seed,
    period: Vec<u32>,
    weights: Vec<f32>,
}

impl Build for WaveletMade {
    type Built = Function;

    fn build(&self) -> Result<Function> {
        let stop = Stop::current();
        let is_over = || stop.is_set();
        match self.period.len() {
            2 => {
                let size = array(&self.period)?;
                let noise = WaveletNoise2::of_size_cancellable(size, self.seed, &is_over)?;
                Ok(Function::Plane(Arc::new(
                    noise.with_weights(&self.weights)?,
                )))
            }
            3 => {
                let size = array(&self.period)?;
                let noise = WaveletNoise3::of_size_cancellable(size, self.seed, &is_over)?;
                Ok(Function::Space(Arc::new(
                    noise.with_weights(&self.weights)?,
                )))
            }
            dims => Err(unknown_axes(dims, "2 or 3")),
        }
    }
}

/// Creates wavelet noise: frequency bands that neither alias nor blur, after Cook and DeRose (2005).
///
/// Positions are in cells. The mean is 0; the variance is about the sum of the squared weights.
///
/// Parameters
/// ----------
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
/// dims : int, default 2
///     Number of axes: 2 or 3.
/// period : int or tuple of int, default 64
///     The period in cells, an even number of at least 4: one number, or one for each axis, x first. The tile is
///     stored in memory, with 4 bytes per cell.
/// weights : sequence of float, default [1.0]
///     The weights of 1 to 16 bands, coarsest first; each band has twice the frequency of the previous one.
///
/// Returns
/// -------
/// Field
///     The field.
///
/// Raises
/// ------
/// DappleError
///     If `dims` is not 2 or 3, or the period is not even or out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> bands = dp.wavelet_noise(seed=1, period=64, weights=[1.0, 0.5])
/// >>> bands.render((128, 128), extent=64).dtype
/// dtype('float32')
#[pyfunction]
#[pyo3(signature = (*, seed = SeedArgument::default(), dims = 2, period = None, weights = vec![1.0]),
    text_signature = "(*, seed=0, dims=2, period=64, weights=[1.0])")]
pub(crate) fn wavelet_noise(
    seed: SeedArgument,
    dims: usize,
    period: Option<&Bound<'_, PyAny>>,
    weights: Vec<f32>,
) -> Result<Field> {
    if !(2..=3).contains(&dims) {
        return Err(unknown_axes(dims, "2 or 3"));
    }
    let period = match period {
        None => vec![64; dims],
        Some(period) => per_axis(period, dims).ok_or_else(|| {
            let message = format!(
                "the period is {period:?}, but it must be a whole number of cells, or {dims} numbers, x first"
            );
            Error::new("period", message)
        })?,
    };
    Field::new(Made::WaveletNoise(Shared::new(WaveletMade {
        seed: seed.0,
        period,
        weights,
    })))
}
