//! The composition of fields, for programs that translate fields, for example to shaders.

use super::{FractalShape, PairOperation};
use crate::Field;
use core::any::Any;
use core::fmt;

/// The composition of a field: its operation and the fields that the operation combines.
///
/// [`Field::parts`] returns it.
#[derive(Clone, Default)]
#[non_exhaustive]
pub enum FieldParts<'a, const N: usize = 2> {
    /// A field whose composition is not known, such as a function.
    #[default]
    Unknown,
    /// A generator, identified by its concrete type.
    Generator(&'a dyn Any),
    /// The same value everywhere.
    Constant(f32),
    /// A field at positions multiplied by a number for each axis.
    Scaled(&'a dyn Field<N>, [f64; N]),
    /// A field at positions plus an offset.
    Translated(&'a dyn Field<N>, [f64; N]),
    /// A field rotated about the origin by an angle, given by its cosine and sine.
    Rotated(&'a dyn Field<N>, [f64; 2]),
    /// A field at positions displaced by the values of other fields, one per axis, times an amount.
    Warped(&'a dyn Field<N>, [&'a dyn Field<N>; N], f64),
    /// `to[0] + (to[1] - to[0]) * ((value - from) / length)`
    Linear {
        /// Field whose values are mapped.
        field: &'a dyn Field<N>,
        /// Value that becomes `to[0]`.
        from: f32,
        /// Length of the range that is mapped.
        length: f32,
        /// New range.
        to: [f32; 2],
    },
    /// Two fields combined value by value.
    Pair(&'a dyn Field<N>, &'a dyn Field<N>, PairOperation),
    /// Interpolation between two fields by a third one, clamped to 0 to 1.
    Mixed([&'a dyn Field<N>; 3]),
    /// A fractal sum: octaves with their frequencies and weights.
    Fractal(Vec<(&'a dyn Field<N>, f64, f32)>, FractalShape),
}

impl<const N: usize> fmt::Debug for FieldParts<'_, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "Unknown",
            Self::Generator(_) => "Generator",
            Self::Constant(_) => "Constant",
            Self::Scaled(..) => "Scaled",
            Self::Translated(..) => "Translated",
            Self::Rotated(..) => "Rotated",
            Self::Warped(..) => "Warped",
            Self::Linear { .. } => "Linear",
            Self::Pair(..) => "Pair",
            Self::Mixed(_) => "Mixed",
            Self::Fractal(..) => "Fractal",
        })
    }
}
