//! Wavelet noise, in two and three dimensions.

use super::{array, unknown_axes};
use crate::error::{Error, Result};
use crate::field::Field;
use crate::function::{Function, Made, Volume};
use crate::grid::per_axis;
use crate::seed::SeedArgument;
use crate::shared::{Build, Shared};
use dapple::hash::Seed;
use dapple::raster::glam::{DVec2, DVec3};
use dapple::raster::{RasterError, RasterViewMut, Window};
use dapple::wavelet::{WaveletNoise2, WaveletNoise3};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The description of wavelet noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WaveletMade {
    seed: Seed,
    period: Vec<u32>,
    weights: Vec<f32>,
}

impl Build for WaveletMade {
    type Built = Function;

    fn build(&self) -> Result<Function> {
        match self.period.len() {
            2 => {
                let noise = WaveletNoise2::of_size(array(&self.period)?, self.seed)?;
                Ok(Function::Plane(Arc::new(
                    noise.with_weights(&self.weights)?,
                )))
            }
            3 => {
                let noise = WaveletNoise3::of_size(array(&self.period)?, self.seed)?;
                Ok(Function::Space(Arc::new(Solid(Arc::new(
                    noise.with_weights(&self.weights)?,
                )))))
            }
            dims => Err(unknown_axes(dims, "2 or 3")),
        }
    }
}

/// Wavelet noise in three dimensions.
struct Solid(Arc<WaveletNoise3>);

/// Wavelet noise in three dimensions, restricted to a plane.
struct Section {
    noise: Arc<WaveletNoise3>,
    z: f64,
}

impl Volume for Solid {
    fn period(&self) -> Vec<Option<f64>> {
        self.0.size().map(|cells| Some(cells.into())).to_vec()
    }

    fn sample(&self, position: &[f64]) -> f32 {
        self.0.sample(DVec3::from_slice(position))
    }

    fn slice(&self, rest: &[f64]) -> Arc<dyn dapple::raster::Field> {
        Arc::new(Section {
            noise: Arc::clone(&self.0),
            z: rest[0],
        })
    }
}

impl dapple::raster::Field for Section {
    fn sample(&self, position: DVec2) -> f32 {
        self.noise.sample(position.extend(self.z))
    }

    fn render(
        &self,
        window: &Window,
        out: RasterViewMut<'_, f32>,
    ) -> core::result::Result<(), RasterError> {
        self.noise.render_slice(self.z, window, out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        let [x, y, _] = self.noise.size();
        [Some(x.into()), Some(y.into())]
    }
}

/// Wavelet noise: bands of frequencies that neither alias nor blur, after Cook and DeRose (2005).
///
/// Positions are in cells. The mean is 0; the variance is about the sum of the squares of the weights.
///
/// Parameters
/// ----------
/// seed : int, default 0
///     From 0 to 2**64 - 1.
/// dims : int, default 2
///     2 or 3 axes.
/// period : int or tuple of int, default 64
///     The number of cells after which it repeats, an even number of at least 4: one number, or one for each axis, x
///     first. The tile is kept in memory: 4 bytes for each of its cells.
/// weights : sequence of float, default [1.0]
///     The weight of each band, coarsest first; each is twice as fine as the one before. 1 to 16 of them.
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
