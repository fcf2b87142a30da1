//! Perlin's gradient noise, in two to four dimensions.

use super::{array, periods, unknown_axes};
use crate::data;
use crate::error::Result;
use crate::field::Field;
use crate::function::{Function, Made};
use crate::seed::SeedArgument;
use dapple::hash::Seed;
use dapple::noise::{GradientNoise, GradientNoise2, GradientNoise3, GradientNoise4};
use dapple::raster::FractalShape;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The description of gradient noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct GradientMade {
    seed: Seed,
    dims: usize,
    period: Vec<Option<u32>>,
    octaves: Option<OctavesMade>,
}

/// The options of a fractal sum, in which each octave has a separate seed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct OctavesMade {
    count: u32,
    gain: f64,
    lacunarity: f64,
    shape: FractalShape,
}

impl GradientMade {
    pub(crate) fn build(&self) -> Result<Function> {
        match self.dims {
            2 => Ok(Function::Plane(self.field(GradientNoise2::new(self.seed))?)),
            3 => Ok(Function::Space(self.field(GradientNoise3::new(self.seed))?)),
            4 => Ok(Function::Time(self.field(GradientNoise4::new(self.seed))?)),
            dims => Err(unknown_axes(dims, "2, 3 or 4")),
        }
    }

    fn field<const N: usize>(
        &self,
        noise: GradientNoise<N>,
    ) -> Result<Arc<dyn dapple::raster::Field<N>>> {
        let noise = noise.with_period(array(&self.period)?)?;
        Ok(match self.octaves {
            None => Arc::new(noise),
            Some(OctavesMade {
                count,
                gain,
                lacunarity,
                shape,
            }) => Arc::new(noise.fractal(count, gain, lacunarity, shape)?),
        })
    }
}

/// Perlin's gradient noise: smooth bumps of one size, after "Improving Noise" (2002), with a seed and exact periods.
///
/// Positions are in cells. The mean is 0; values are from -1 to 1 in the plane, and at most 1.04 and 1.54 from 0 in three
/// and four dimensions. Without octaves, the standard deviation is 0.31, 0.27 and 0.29. At positions whose coordinates are
/// all whole numbers the value is 0: sample between them, for instance half a cell aside.
///
/// Octaves are summed and not divided by the sum w of their heights, 1 + gain + gain**2 + … (1.94 for 5 octaves and a gain of
/// 0.5): with a gain from 0 to 1, values are from -w to w for the shape "sum", and from 0 to w for "ridged" and "billow".
///
/// Parameters
/// ----------
/// seed : int, default 0
///     From 0 to 2**64 - 1.
/// dims : int, default 2
///     2, 3 or 4 axes.
/// period : int or tuple of int or None, default None
///     The number of cells after which it repeats exactly: one number, or one for each axis, x first; None for an axis
///     along which it does not.
/// octaves : int or None, default None
///     The number of octaves that are summed (fBm), each with its own seed; 1 to 32.
/// gain : float, default 0.5
///     The ratio of the heights of an octave and the one before, -1 to 1.
/// lacunarity : float, default 2.0
///     The ratio of the frequencies of an octave and the one before, 1 to 16; whole if there is a period.
/// shape : {"sum", "ridged", "billow"}, default "sum"
///     "sum", "ridged" or "billow" (turbulence).
///
/// Returns
/// -------
/// Field
///     The field.
///
/// Raises
/// ------
/// DappleError
///     If `dims` is not 2, 3 or 4, the period does not fit it, or a number is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> hills = dp.gradient_noise(seed=1, period=4, octaves=5)
/// >>> hills.render((64, 64), extent=4).shape
/// (64, 64)
#[pyfunction]
#[pyo3(signature = (*, seed = SeedArgument::default(), dims = 2, period = None, octaves = None, gain = 0.5, lacunarity = 2.0, shape = "sum"),
    text_signature = "(*, seed=0, dims=2, period=None, octaves=None, gain=0.5, lacunarity=2.0, shape='sum')")]
pub(crate) fn gradient_noise(
    seed: SeedArgument,
    dims: usize,
    period: Option<&Bound<'_, PyAny>>,
    octaves: Option<u32>,
    gain: f64,
    lacunarity: f64,
    shape: &str,
) -> Result<Field> {
    if !(2..=4).contains(&dims) {
        return Err(unknown_axes(dims, "2, 3 or 4"));
    }
    let shape = data::named("shape", shape)?;
    Field::new(Made::GradientNoise(GradientMade {
        seed: seed.0,
        dims,
        period: periods(period, dims)?,
        octaves: octaves.map(|count| OctavesMade {
            count,
            gain,
            lacunarity,
            shape,
        }),
    }))
}
