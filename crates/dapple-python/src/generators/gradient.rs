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

/// Description of gradient noise as data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct GradientMade {
    seed: Seed,
    dims: usize,
    period: Vec<Option<u32>>,
    octaves: Option<OctavesMade>,
}

/// Options of a fractal sum in which each octave has a separate seed.
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

/// Creates Perlin's gradient noise: smooth bumps of similar size, after "Improving Noise" (2002), with a seed and
/// exact periods.
///
/// Positions are in cells. The mean is 0. Values are from -1 to 1 in the plane, and their magnitude is at most 1.04
/// and 1.54 in three and four dimensions. Without octaves, the standard deviation is 0.31, 0.27 and 0.29. The value
/// is 0 wherever all coordinates are integers, so sample between these positions, for instance with an offset of half
/// a cell.
///
/// Octaves are summed without dividing by w = 1 + gain + gain**2 + …, the sum of their amplitudes (1.94 for 5 octaves
/// and a gain of 0.5). With a gain from 0 to 1, values are from -w to w for the shape "sum", and from 0 to w for
/// "ridged" and "billow".
///
/// Parameters
/// ----------
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
/// dims : int, default 2
///     Number of axes: 2, 3 or 4.
/// period : int or tuple of int or None, default None
///     The period in cells, after which the field repeats exactly: one number, or one for each axis, x first; None
///     for an axis without a period.
/// octaves : int or None, default None
///     The number of octaves to sum (fBm), each with its own seed; 1 to 32.
/// gain : float, default 0.5
///     The ratio of an octave's amplitude to the previous one's, from -1 to 1.
/// lacunarity : float, default 2.0
///     The ratio of an octave's frequency to the previous one's, from 1 to 16; an integer if there is a period.
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
///     If `dims` is not 2, 3 or 4, the period does not match it, or a number is out of range.
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
