//! What a field is: how it was made, as data, and the function that this gives.
//!
//! A field is made from its description and nothing else, so that it can be sent to another process as that.

use crate::error::{Error, Result};
use crate::generators::{CellsMade, GradientMade, WaveletMade};
use crate::pups::{PupsMade, TextureMade};
use crate::recipe::NodeMade;
use crate::shared::Shared;
use dapple::raster::glam::DVec2;
use dapple::raster::{
    Field, FieldExt, Fractal, FractalShape, PairOperation, RasterError, RasterViewMut, Window,
};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// A function of the plane, or of more axes.
#[derive(Clone)]
pub(crate) enum Function {
    /// Of the plane.
    Plane(Arc<dyn Field>),
    /// Of three or four axes.
    Space(Arc<dyn Volume>),
}

/// A function of three or four axes.
pub(crate) trait Volume: Send + Sync {
    /// The distances after which it repeats along each axis.
    fn period(&self) -> Vec<Option<f64>>;

    /// The value at a position.
    fn sample(&self, position: &[f64]) -> f32;

    /// The plane along the first two axes at the further coordinates.
    fn slice(&self, rest: &[f64]) -> Arc<dyn Field>;

    /// The values at the pixels of several planes, which lie one after the other.
    fn render(
        &self,
        window: &Window,
        planes: &[Vec<f64>],
        values: &mut [f32],
    ) -> core::result::Result<(), RasterError> {
        for (plane, values) in planes.iter().zip(values.chunks_mut(window.n_pixels())) {
            let view = RasterViewMut::new(values, window.size[0] as usize, window.size)?;
            self.slice(plane).render(window, view)?;
        }
        Ok(())
    }
}

/// How a field was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Made {
    /// A number everywhere.
    Constant(f32),
    /// Worley's cells.
    Worley(CellsMade),
    /// Perlin's gradient noise.
    GradientNoise(GradientMade),
    /// Wavelet noise.
    WaveletNoise(Shared<WaveletMade>),
    /// Values of control points.
    Pups(Shared<PupsMade>),
    /// A texture of control points, by its name.
    Texture(Shared<TextureMade>),
    /// A node of a recipe.
    Node(Shared<NodeMade>),
    /// A plane through a function of more axes.
    Slice { field: Box<Made>, rest: Vec<f64> },
    /// At positions times a frequency.
    Frequency {
        field: Box<Made>,
        frequency: [f64; 2],
    },
    /// At positions plus an offset.
    Offset { field: Box<Made>, offset: [f64; 2] },
    /// At positions turned by an angle.
    Rotate { field: Box<Made>, angle: f64 },
    /// At positions that two fields move.
    Warp {
        field: Box<Made>,
        x: Box<Made>,
        y: Box<Made>,
        amount: f64,
    },
    /// With one range of values mapped to another.
    Remap {
        field: Box<Made>,
        from: [f32; 2],
        to: [f32; 2],
    },
    /// With two bounds.
    Clamp { field: Box<Made>, bounds: [f32; 2] },
    /// The absolute values.
    Absolute(Box<Made>),
    /// Two fields, value by value.
    Pair {
        first: Box<Made>,
        second: Box<Made>,
        operation: PairOperation,
    },
    /// Between two fields, by a third.
    Mix {
        from: Box<Made>,
        to: Box<Made>,
        by: Box<Made>,
    },
    /// Sums at several scales.
    Fractal {
        field: Box<Made>,
        octaves: u32,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    },
}

impl Made {
    /// The function that this describes.
    pub(crate) fn build(&self) -> Result<Function> {
        let field: Arc<dyn Field> = match self {
            Self::Constant(number) => Arc::new(*number),
            Self::Worley(made) => return made.build(),
            Self::GradientNoise(made) => return made.build(),
            Self::WaveletNoise(made) => return made.get(),
            Self::Pups(made) => made.get()?.numbers()?,
            Self::Texture(made) => made.get()?.numbers()?,
            Self::Node(made) => return made.get(),
            Self::Slice { field, rest } => match field.build()? {
                Function::Space(volume) if volume.period().len() == rest.len() + 2 => {
                    volume.slice(rest)
                }
                _ => {
                    return Err(Error::new(
                        "axes",
                        format!(
                            "a slice at {} further coordinates is of a field with as many axes more than two",
                            rest.len()
                        ),
                    ));
                }
            },
            Self::Frequency { field, frequency } => {
                Arc::new(field.plane()?.frequency_xy((*frequency).into()))
            }
            Self::Offset { field, offset } => Arc::new(field.plane()?.offset((*offset).into())),
            Self::Rotate { field, angle } => Arc::new(field.plane()?.rotate(*angle)),
            Self::Warp {
                field,
                x,
                y,
                amount,
            } => Arc::new(field.plane()?.warp(x.plane()?, y.plane()?, *amount)),
            Self::Remap { field, from, to } => Arc::new(field.plane()?.remap(*from, *to)?),
            Self::Clamp { field, bounds } => Arc::new(clamped(field.plane()?, *bounds)?),
            Self::Absolute(field) => Arc::new(field.plane()?.map(f32::abs)),
            Self::Pair {
                first,
                second,
                operation,
            } => Arc::new(first.plane()?.with(second.plane()?, *operation)),
            Self::Mix { from, to, by } => Arc::new(from.plane()?.mix(to.plane()?, by.plane()?)),
            Self::Fractal {
                field,
                octaves,
                gain,
                lacunarity,
                shape,
            } => {
                let octave = field.plane()?;
                let octaves = core::iter::repeat_n(octave, *octaves as usize);
                Arc::new(Fractal::new(octaves, *gain, *lacunarity, *shape)?)
            }
        };
        Ok(Function::Plane(field))
    }

    /// The description as text.
    pub(crate) fn description(&self) -> Result<String> {
        serde_json::to_string(self).map_err(|error| Error::new("description", error.to_string()))
    }

    /// The beginning of the description, for people.
    pub(crate) fn summary(&self) -> Result<String> {
        /// The most letters that are of use.
        const MOST: usize = 500;
        let description = self.description()?;
        Ok(match description.char_indices().nth(MOST) {
            None => description,
            Some((end, _)) => format!("{}…", &description[..end]),
        })
    }

    /// What stands for the description: the same in all processes, and another one for each description.
    pub(crate) fn token(&self) -> Result<String> {
        let hash = Sha256::digest(self.description()?);
        Ok(hash.iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// The function of the plane that this describes.
    fn plane(&self) -> Result<Arc<dyn Field>> {
        match self.build()? {
            Function::Plane(field) => Ok(field),
            Function::Space(_) => Err(Error::new(
                "axes",
                "fields of three and four axes are composed by their slices: take `slice(…)` first",
            )),
        }
    }
}

/// A field whose values stay between two bounds.
fn clamped(field: Arc<dyn Field>, [low, high]: [f32; 2]) -> Result<impl Field> {
    if low > high || low.is_nan() || high.is_nan() {
        return Err(Error::new(
            "range",
            format!("the bounds are {low} and {high}, but the first must not be above the second"),
        ));
    }
    Ok(field.map(move |value: f32| {
        if value.is_nan() {
            value
        } else {
            value.clamp(low, high)
        }
    }))
}

/// A position of as many axes, from its numbers.
pub(crate) fn position(numbers: &[f64]) -> DVec2 {
    DVec2::from_slice(numbers)
}
