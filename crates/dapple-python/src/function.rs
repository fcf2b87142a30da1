//! Descriptions of fields as data, and the functions that they define.
//!
//! A field is built from its description alone, so that the description can be sent to another process.

use crate::error::{Error, Result};
use crate::generators::{CellsMade, GradientMade, WaveletMade};
use crate::grid::CELLS;
use crate::pups::{PupsMade, TextureMade};
use crate::recipe::NodeMade;
use crate::shared::{Build, Shared};
use dapple::raster::{Constant, Field, FieldExt, Fractal, FractalShape, PairOperation};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// A function of positions with two, three or four coordinates.
#[derive(Clone)]
pub(crate) enum Function {
    /// A function of positions in the plane.
    Plane(Arc<dyn Field>),
    /// A function of positions in space.
    Space(Arc<dyn Field<3>>),
    /// A function of positions in space and time.
    Time(Arc<dyn Field<4>>),
}

impl Function {
    /// Returns the number of axes.
    pub(crate) fn n_axes(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
            Self::Time(_) => 4,
        }
    }

    /// Returns the period along each axis; `None` for an axis without a period.
    pub(crate) fn period(&self) -> Vec<Option<f64>> {
        match self {
            Self::Plane(field) => field.period().to_vec(),
            Self::Space(field) => field.period().to_vec(),
            Self::Time(field) => field.period().to_vec(),
        }
    }

    /// Writes the values at `positions`, given as interleaved coordinates.
    pub(crate) fn values(&self, positions: &[f64], values: &mut [f32]) -> Result<()> {
        match self {
            Self::Plane(field) => field.values(positions.as_chunks().0, values)?,
            Self::Space(field) => field.values(positions.as_chunks().0, values)?,
            Self::Time(field) => field.values(positions.as_chunks().0, values)?,
        }
        Ok(())
    }

    /// Returns the slice along the first two axes. `rest` has the fixed coordinates along the other axes.
    fn slice(self, rest: &[f64]) -> Result<Arc<dyn Field>> {
        match (self, rest) {
            (Self::Space(field), &[z]) => Ok(Arc::new(field.slice([z]))),
            (Self::Time(field), &[z, w]) => Ok(Arc::new(field.slice([z, w]))),
            _ => Err(Error::new(
                "axes",
                format!(
                    "a slice at {} further coordinates is of a field with as many axes more than two",
                    rest.len()
                ),
            )),
        }
    }
}

/// The description of a field as data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Made {
    /// A constant number.
    Constant(f32),
    /// Worley's cells.
    Worley(CellsMade),
    /// Perlin's gradient noise.
    GradientNoise(GradientMade),
    /// Wavelet noise, as built by the Python function `wavelet_noise`.
    WaveletNoise(Shared<WaveletMade>),
    /// The field of values at control points.
    Pups(Shared<PupsMade>),
    /// A texture of the PUPs paper, by name.
    Texture(Shared<TextureMade>),
    /// A node of a recipe.
    Node(Shared<NodeMade>),
    /// A slice along the first two axes through a function of three or four axes.
    Slice { field: Shared<Made>, rest: Vec<f64> },
    /// A field at positions times a frequency.
    Frequency {
        field: Shared<Made>,
        frequency: Vec<f64>,
    },
    /// A field at positions plus an offset.
    Offset {
        field: Shared<Made>,
        offset: Vec<f64>,
    },
    /// A field at positions rotated by an angle.
    Rotate { field: Shared<Made>, angle: f64 },
    /// A field at positions that are displaced by other fields.
    Warp {
        field: Shared<Made>,
        x: Shared<Made>,
        y: Shared<Made>,
        amount: f64,
        /// The displacement fields along the axes after the first two.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        further: Vec<Shared<Made>>,
    },
    /// A field whose values are mapped linearly from one range to another.
    Remap {
        field: Shared<Made>,
        from: [f32; 2],
        to: [f32; 2],
    },
    /// A field clamped to a range.
    Clamp {
        field: Shared<Made>,
        bounds: [f32; 2],
    },
    /// The absolute values of a field.
    Absolute(Shared<Made>),
    /// Two fields combined value by value, such as their sum.
    Pair {
        first: Shared<Made>,
        second: Shared<Made>,
        operation: PairOperation,
    },
    /// Interpolation between two fields, weighted by a third.
    Mix {
        from: Shared<Made>,
        to: Shared<Made>,
        by: Shared<Made>,
    },
    /// A sum of octaves of a field.
    Fractal {
        field: Shared<Made>,
        octaves: u32,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    },
}

/// The return value of Python's `__reduce__`: a function and its arguments.
pub(crate) type Reduced = (Py<PyAny>, (String,));

/// A function, with the depth and the number of operations of its composition.
#[derive(Clone)]
pub(crate) struct Built {
    pub(crate) function: Function,
    /// Maximum number of nested operations.
    depth: usize,
    /// Number of operations and elementary fields. One that is evaluated several times counts several times.
    n_parts: usize,
}

/// Maximum depth of a composition. Its description nests two levels per operation, and JSON parsers stop at 127.
const DEEPEST: usize = 60;

/// Maximum number of operations and elementary fields in a composition.
const MOST_PARTS: usize = 1 << 16;

impl Build for Made {
    type Built = Built;

    fn build(&self) -> Result<Built> {
        self.check_numbers()?;
        let (mut depth, mut n_parts) = (0, 1_usize);
        for part in self.parts() {
            let part = part.get()?;
            depth = depth.max(part.depth + 1);
            n_parts = n_parts.saturating_add(part.n_parts);
        }
        if depth > DEEPEST {
            let message = format!(
                "the field is composed of operations on operations more than {DEEPEST} times: add many fields in pairs, \
                 (a + b) + (c + d), or take `fbm`"
            );
            return Err(Error::new("depth", message));
        }
        if n_parts > MOST_PARTS {
            let message = format!("the field is composed of more than {MOST_PARTS} parts");
            return Err(Error::new("too_large", message));
        }
        Ok(Built {
            function: self.function()?,
            depth,
            n_parts,
        })
    }
}

impl Shared<Made> {
    /// Builds the function; an error unless it has two axes.
    pub(crate) fn plane(&self) -> Result<Arc<dyn Field>> {
        match self.get()?.function {
            Function::Plane(field) => Ok(field),
            _ => Err(Error::new(
                "axes",
                "a field of the plane is needed: of one with three or four axes, take `slice(…)` first",
            )),
        }
    }
}

impl Made {
    /// Returns the operands of the operation.
    fn parts(&self) -> Vec<&Shared<Self>> {
        match self {
            Self::Constant(_)
            | Self::Worley(_)
            | Self::GradientNoise(_)
            | Self::WaveletNoise(_)
            | Self::Pups(_)
            | Self::Texture(_)
            | Self::Node(_) => Vec::new(),
            Self::Slice { field, .. }
            | Self::Frequency { field, .. }
            | Self::Offset { field, .. }
            | Self::Rotate { field, .. }
            | Self::Remap { field, .. }
            | Self::Clamp { field, .. }
            | Self::Absolute(field)
            | Self::Fractal { field, .. } => vec![field],
            Self::Pair { first, second, .. } => vec![first, second],
            Self::Warp {
                field,
                x,
                y,
                further,
                ..
            } => [field, x, y].into_iter().chain(further).collect(),
            Self::Mix { from, to, by } => vec![from, to, by],
        }
    }

    /// Returns the default width and height of a rendered image, for axes without a period: 8 cells for noise,
    /// otherwise 1.
    pub(crate) fn shown(&self) -> [f64; 2] {
        match self {
            Self::Worley(_) | Self::GradientNoise(_) => [CELLS; 2],
            Self::Frequency { field, frequency } => {
                let inner = field.made().shown();
                [0, 1].map(|axis| match frequency[axis].abs() {
                    frequency if frequency > 0.0 => inner[axis] / frequency,
                    _ => inner[axis],
                })
            }
            _ => self.parts().into_iter().fold([1.0; 2], |shown, part| {
                let part = part.made().shown();
                [shown[0].max(part[0]), shown[1].max(part[1])]
            }),
        }
    }

    /// Checks that all numbers are finite, since JSON cannot represent others.
    fn check_numbers(&self) -> Result<()> {
        let numbers = match self {
            Self::Constant(number) => vec![f64::from(*number)],
            Self::Slice { rest, .. } => rest.clone(),
            Self::Frequency { frequency: at, .. } | Self::Offset { offset: at, .. } => at.to_vec(),
            Self::Rotate { angle: number, .. } | Self::Warp { amount: number, .. } => vec![*number],
            Self::Remap { from, to, .. } => {
                [*from, *to].concat().into_iter().map(f64::from).collect()
            }
            Self::Clamp { bounds, .. } => bounds.iter().copied().map(f64::from).collect(),
            Self::Fractal {
                gain, lacunarity, ..
            } => vec![*gain, *lacunarity],
            Self::Worley(_)
            | Self::GradientNoise(_)
            | Self::WaveletNoise(_)
            | Self::Pups(_)
            | Self::Texture(_)
            | Self::Node(_)
            | Self::Absolute(_)
            | Self::Pair { .. }
            | Self::Mix { .. } => Vec::new(),
        };
        let Some(number) = numbers.iter().find(|number| !number.is_finite()) else {
            return Ok(());
        };
        let message = match self {
            Self::Clamp { .. } => format!(
                "a bound is {number}, but it must be finite: `minimum` and `maximum` have one bound"
            ),
            _ => format!("the number {number} is not finite, as the numbers of fields must be"),
        };
        Err(Error::new("not_finite", message))
    }

    /// Builds the function of this description.
    fn function(&self) -> Result<Function> {
        match self {
            Self::Constant(number) => return Ok(Function::Plane(Arc::new(Constant(*number)))),
            Self::Worley(made) => return made.build(),
            Self::GradientNoise(made) => return made.build(),
            Self::WaveletNoise(made) => return made.get(),
            Self::Pups(made) => return Ok(Function::Plane(made.get()?.numbers()?)),
            Self::Texture(made) => return Ok(Function::Plane(made.get()?.numbers()?)),
            Self::Node(made) => return made.get(),
            Self::Slice { field, rest } => {
                return Ok(Function::Plane(field.get()?.function.slice(rest)?));
            }
            _ => {}
        }
        let parts = self.parts().into_iter();
        let parts: Vec<Function> = parts
            .map(|part| Ok(part.get()?.function))
            .collect::<Result<_>>()?;
        let n_axes = parts.iter().map(Function::n_axes).max().unwrap_or(2);
        if let Self::Warp { further, .. } = self
            && further.len() + 2 > n_axes
        {
            let axis = if further.len() == 1 { "z" } else { "w" };
            let message = format!(
                "positions of {n_axes} axes are not displaced along {axis}, which they lack"
            );
            return Err(Error::new("axes", message));
        }
        let uneven = || {
            Error::new(
                "axes",
                "fields of three and of four axes are not combined: take a `slice(…)`, or fields of the same number of axes",
            )
        };
        // Extrude 2-D fields to the number of axes of the other fields.
        let parts = parts.into_iter();
        Ok(match n_axes {
            2 => Function::Plane(self.composed(parts.map(|part| match part {
                Function::Plane(field) => Ok(field),
                _ => Err(uneven()),
            }))?),
            3 => Function::Space(self.composed(parts.map(|part| match part {
                Function::Plane(field) => Ok(Arc::new(field.extrude()) as Arc<dyn Field<3>>),
                Function::Space(field) => Ok(field),
                Function::Time(_) => Err(uneven()),
            }))?),
            _ => Function::Time(self.composed(parts.map(|part| match part {
                Function::Plane(field) => Ok(Arc::new(field.extrude()) as Arc<dyn Field<4>>),
                Function::Space(_) => Err(uneven()),
                Function::Time(field) => Ok(field),
            }))?),
        })
    }

    /// Applies the operation to operands with `N` axes.
    fn composed<const N: usize>(
        &self,
        parts: impl Iterator<Item = Result<Arc<dyn Field<N>>>>,
    ) -> Result<Arc<dyn Field<N>>> {
        let parts: Vec<_> = parts.collect::<Result<_>>()?;
        let part = |index: usize| Arc::clone(&parts[index]);
        // Fill up to `N` numbers, so that coordinates along the other axes are unchanged.
        let along = |numbers: &[f64], default: f64| -> [f64; N] {
            core::array::from_fn(|axis| numbers.get(axis).copied().unwrap_or(default))
        };
        Ok(match self {
            Self::Frequency { frequency, .. } => {
                Arc::new(part(0).frequency_per_axis(along(frequency, 1.0)))
            }
            Self::Offset { offset, .. } => Arc::new(part(0).offset(along(offset, 0.0))),
            Self::Rotate { angle, .. } => Arc::new(part(0).rotate(*angle)),
            Self::Warp { amount, .. } => {
                let by: [Arc<dyn Field<N>>; N] = core::array::from_fn(|axis| {
                    let along = parts.get(axis + 1).cloned();
                    along.unwrap_or_else(|| Arc::new(Constant(0.0)))
                });
                Arc::new(part(0).warp(by, *amount))
            }
            Self::Remap { from, to, .. } => Arc::new(part(0).remap(*from, *to)?),
            Self::Clamp { bounds, .. } => Arc::new(part(0).map(clamp(*bounds)?)),
            Self::Absolute(_) => Arc::new(part(0).map(f32::abs)),
            Self::Pair { operation, .. } => Arc::new(part(0).with(part(1), *operation)),
            Self::Mix { .. } => Arc::new(part(0).mix(part(1), part(2))),
            Self::Fractal {
                octaves,
                gain,
                lacunarity,
                shape,
                ..
            } => {
                let octaves = core::iter::repeat_n(part(0), *octaves as usize);
                Arc::new(Fractal::new(octaves, *gain, *lacunarity, *shape)?)
            }
            _ => part(0),
        })
    }

    /// Returns the description as JSON text.
    pub(crate) fn description(&self) -> Result<String> {
        serde_json::to_string(self).map_err(|error| Error::new("description", error.to_string()))
    }

    /// Returns the beginning of the description, for display.
    pub(crate) fn summary(&self) -> Result<String> {
        /// Maximum number of displayed characters.
        const MOST: usize = 500;
        let description = self.description()?;
        Ok(match description.char_indices().nth(MOST) {
            None => description,
            Some((end, _)) => format!("{}…", &description[..end]),
        })
    }

    /// Returns the hash of the description, for Python dictionaries.
    pub(crate) fn hash(&self) -> Result<u64> {
        let mut hasher = DefaultHasher::new();
        self.description()?.hash(&mut hasher);
        Ok(hasher.finish())
    }

    /// Returns the function and the arguments with which Python rebuilds the field in another process.
    pub(crate) fn reduced(&self, py: Python<'_>) -> Result<Reduced> {
        let module = py.import("dapple_textures._native")?;
        let make = module.getattr("_field_from_description")?;
        Ok((make.unbind(), (self.description()?,)))
    }

    /// Returns a hash of the description for Dask. It is equal in all processes, and differs for different
    /// descriptions.
    pub(crate) fn token(&self) -> Result<String> {
        Ok(hex(&Sha256::digest(self.description()?)))
    }
}

/// Formats bytes in hexadecimal.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns a function that clamps values to a range; NaN is unchanged. Fails if the range is empty.
fn clamp([low, high]: [f32; 2]) -> Result<impl Fn(f32) -> f32 + Send + Sync> {
    if low > high || low.is_nan() || high.is_nan() {
        return Err(Error::new(
            "range",
            format!("the bounds are {low} and {high}, but the first must not be above the second"),
        ));
    }
    Ok(move |value: f32| {
        if value.is_nan() {
            value
        } else {
            value.clamp(low, high)
        }
    })
}
