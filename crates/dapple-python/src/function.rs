//! Descriptions of fields as data, and the functions that they define.
//!
//! A field is made from its description alone, so that the description can be sent to another process.

use crate::composed::{Composed, Part};
use crate::error::{Error, Result};
use crate::generators::{CellsMade, GradientMade, WaveletMade};
use crate::grid::CELLS;
use crate::pups::{PupsMade, TextureMade};
use crate::recipe::NodeMade;
use crate::shared::{Build, Shared};
use dapple::raster::glam::DVec2;
use dapple::raster::{
    Constant, Field, FieldExt, Fractal, FractalShape, PairOperation, RasterError, RasterViewMut,
    Window,
};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// A function of the plane, or of more axes.
#[derive(Clone)]
pub(crate) enum Function {
    /// A function of the plane.
    Plane(Arc<dyn Field>),
    /// A function of three or four axes.
    Space(Arc<dyn Volume>),
}

/// A function of three or four axes.
pub(crate) trait Volume: Send + Sync {
    /// The distances after which it repeats along each axis.
    fn period(&self) -> Vec<Option<f64>>;

    /// The value at a position.
    fn sample(&self, position: &[f64]) -> f32;

    /// The values at positions, whose coordinates lie one after the other.
    fn sample_many(&self, positions: &[f64], values: &mut [f32]) {
        let n_axes = self.period().len();
        for (value, position) in values.iter_mut().zip(positions.chunks_exact(n_axes)) {
            *value = self.sample(position);
        }
    }

    /// The plane along the first two axes at fixed further coordinates.
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

impl Function {
    /// The number of axes.
    pub(crate) fn n_axes(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(volume) => volume.period().len(),
        }
    }
}

/// The description of a field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Made {
    /// A constant number.
    Constant(f32),
    /// Worley's cells.
    Worley(CellsMade),
    /// Perlin's gradient noise.
    GradientNoise(GradientMade),
    /// Wavelet noise, as for the function `wavelet_noise`.
    WaveletNoise(Shared<WaveletMade>),
    /// The field of values at control points.
    Pups(Shared<PupsMade>),
    /// A texture of control points, by name.
    Texture(Shared<TextureMade>),
    /// A node of a recipe.
    Node(Shared<NodeMade>),
    /// A plane through a function of more axes.
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
    /// A field at positions that two other fields displace.
    Warp {
        field: Shared<Made>,
        x: Shared<Made>,
        y: Shared<Made>,
        amount: f64,
        /// The displacements along the axes after the first two.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        further: Vec<Shared<Made>>,
    },
    /// A field with one range of values mapped to another.
    Remap {
        field: Shared<Made>,
        from: [f32; 2],
        to: [f32; 2],
    },
    /// A field clamped between two bounds.
    Clamp {
        field: Shared<Made>,
        bounds: [f32; 2],
    },
    /// The absolute values of a field.
    Absolute(Shared<Made>),
    /// Two fields combined value by value.
    Pair {
        first: Shared<Made>,
        second: Shared<Made>,
        operation: PairOperation,
    },
    /// The interpolation between two fields by a third.
    Mix {
        from: Shared<Made>,
        to: Shared<Made>,
        by: Shared<Made>,
    },
    /// A sum of a field at several scales.
    Fractal {
        field: Shared<Made>,
        octaves: u32,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    },
}

/// A Python function, and its arguments.
pub(crate) type Reduced = (Py<PyAny>, (String,));

/// A function, and the size of its composition.
#[derive(Clone)]
pub(crate) struct Built {
    pub(crate) function: Function,
    /// The longest chain of operations in it.
    depth: usize,
    /// The number of operations and of elementary fields, as often as they are evaluated.
    n_parts: usize,
}

/// The deepest composition: its description nests two levels for each operation, and JSON readers stop at 127.
const DEEPEST: usize = 60;

/// The largest number of parts of a composition.
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
    /// Makes the function, if it is one of the plane.
    pub(crate) fn plane(&self) -> Result<Arc<dyn Field>> {
        match self.get()?.function {
            Function::Plane(field) => Ok(field),
            Function::Space(_) => Err(Error::new(
                "axes",
                "a field of the plane is needed: of one with three or four axes, take `slice(…)` first",
            )),
        }
    }
}

impl Made {
    /// The fields of which it is composed.
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

    /// The width and height that a picture shows where the field has no period: some cells of noise, and otherwise 1.
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

    /// Checks that all numbers are finite, since descriptions cannot hold others.
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

    /// Makes the function of this description.
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
                return match field.get()?.function {
                    Function::Space(volume) if volume.period().len() == rest.len() + 2 => {
                        Ok(Function::Plane(volume.slice(rest)))
                    }
                    _ => Err(Error::new(
                        "axes",
                        format!(
                            "a slice at {} further coordinates is of a field with as many axes more than two",
                            rest.len()
                        ),
                    )),
                };
            }
            _ => {}
        }
        let parts = self.parts().into_iter();
        let parts: Vec<Function> = parts
            .map(|part| Ok(part.get()?.function))
            .collect::<Result<_>>()?;
        let n_axes = parts.iter().map(Function::n_axes).max().unwrap_or(2);
        // A field of the plane is the same in every plane of space.
        if parts
            .iter()
            .any(|part| ![2, n_axes].contains(&part.n_axes()))
        {
            return Err(Error::new(
                "axes",
                "fields of three and of four axes are not combined: take a `slice(…)`, or fields of the same number of axes",
            ));
        }
        if let Self::Warp { further, .. } = self
            && further.len() + 2 > n_axes
        {
            let axis = if further.len() == 1 { "z" } else { "w" };
            let message = format!(
                "positions of {n_axes} axes are not displaced along {axis}, which they lack"
            );
            return Err(Error::new("axes", message));
        }
        let composed = Composed::new(self.clone(), parts, n_axes);
        let plane = composed.plane(&vec![0.0; n_axes - 2])?;
        Ok(match n_axes {
            2 => Function::Plane(plane),
            _ => Function::Space(Arc::new(composed)),
        })
    }

    /// Composes fields of a plane along two axes, of which `first` is the first. `part` returns a part by its index, at
    /// further coordinates that are changed by a function of their index and value.
    pub(crate) fn of_planes(&self, part: Part<'_>, first: usize) -> Result<Arc<dyn Field>> {
        let same = |index| part(index, &|_, at| at);
        // Along axes that the field does not have, nothing changes.
        let along = |numbers: &[f64], default: f64| -> DVec2 {
            [0, 1]
                .map(|axis| numbers.get(first + axis).copied().unwrap_or(default))
                .into()
        };
        Ok(match self {
            Self::Frequency { frequency, .. } => {
                let inner = part(0, &|axis, at| at * frequency[axis + 2]);
                Arc::new(inner.frequency_xy(along(frequency, 1.0)))
            }
            Self::Offset { offset, .. } => {
                let inner = part(0, &|axis, at| at + offset[axis + 2]);
                Arc::new(inner.offset(along(offset, 0.0)))
            }
            // It turns about the axes after the first two.
            Self::Rotate { angle, .. } if first == 0 => Arc::new(same(0).rotate(*angle)),
            Self::Warp {
                amount, further, ..
            } => {
                // Displacements out of the plane are left to `Composed`; here they shape the period alone.
                let inner = (3..3 + further.len()).fold(same(0), |inner, index| {
                    Arc::new(inner.warp(same(index), same(index), 0.0))
                });
                Arc::new(inner.warp(same(1), same(2), *amount))
            }
            Self::Remap { from, to, .. } => Arc::new(same(0).remap(*from, *to)?),
            Self::Clamp { bounds, .. } => Arc::new(clamped(same(0), *bounds)?),
            Self::Absolute(_) => Arc::new(same(0).map(f32::abs)),
            Self::Pair { operation, .. } => Arc::new(same(0).with(same(1), *operation)),
            Self::Mix { .. } => Arc::new(same(0).mix(same(1), same(2))),
            Self::Fractal {
                octaves,
                gain,
                lacunarity,
                shape,
                ..
            } => {
                let octaves =
                    scales(*octaves, *lacunarity).map(|scale| part(0, &|_, at| at * scale));
                Arc::new(Fractal::new(octaves, *gain, *lacunarity, *shape)?)
            }
            _ => same(0),
        })
    }

    /// The description as text.
    pub(crate) fn description(&self) -> Result<String> {
        serde_json::to_string(self).map_err(|error| Error::new("description", error.to_string()))
    }

    /// The beginning of the description, for people.
    pub(crate) fn summary(&self) -> Result<String> {
        /// The largest number of useful letters.
        const MOST: usize = 500;
        let description = self.description()?;
        Ok(match description.char_indices().nth(MOST) {
            None => description,
            Some((end, _)) => format!("{}…", &description[..end]),
        })
    }

    /// The hash of the description, for Python's dictionaries.
    pub(crate) fn hash(&self) -> Result<u64> {
        let mut hasher = DefaultHasher::new();
        self.description()?.hash(&mut hasher);
        Ok(hasher.finish())
    }

    /// The function and the arguments by which Python makes the field again in another process.
    pub(crate) fn reduced(&self, py: Python<'_>) -> Result<Reduced> {
        let module = py.import("dapple_textures._native")?;
        let make = module.getattr("_field_from_description")?;
        Ok((make.unbind(), (self.description()?,)))
    }

    /// A token of the description: the same in all processes, and different for different descriptions.
    pub(crate) fn token(&self) -> Result<String> {
        Ok(hex(&Sha256::digest(self.description()?)))
    }
}

/// Bytes in hexadecimal.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
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

/// A position of two axes, from its numbers.
pub(crate) fn position(numbers: &[f64]) -> DVec2 {
    DVec2::from_slice(numbers)
}

/// The frequencies of the octaves of a sum, relative to the first.
pub(crate) fn scales(octaves: u32, lacunarity: f64) -> impl Iterator<Item = f64> {
    let scales = core::iter::successors(Some(1.0), move |scale| Some(scale * lacunarity));
    scales.take(octaves as usize)
}
