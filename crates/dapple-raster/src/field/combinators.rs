//! The trait [`FieldExt`]: methods that compose fields.

use super::{
    Fractal, FractalShape, Frequency, Linear, Mapped, Mixed, Offset, Pair, PairOperation, Rotated,
    Warped,
};
use crate::{Field, IntoField, RasterError};
use glam::DVec2;

/// Composition of fields: transformed positions, changed values, and sums at several scales.
///
/// Every field has these methods. Their results keep the promises of [`Field`], above all the same bits from all of its
/// methods, and have the period that follows from those of their parts.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Field, FieldExt, field_fn, glam::DVec2};
///
/// let waves = field_fn(|position| (position.x - position.x.floor()) as f32);
/// let field = (&waves).frequency(8.0).remap([0.0, 1.0], [-1.0, 1.0])?.add(waves);
/// assert_eq!(field.sample(DVec2::new(0.0625, 0.0)), 0.0625);
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
pub trait FieldExt: Field + Sized {
    /// This field at the position times `frequency`: so many times as many features along each axis.
    ///
    /// For one number use `DVec2::splat`, or [`frequency`](Self::frequency).
    fn frequency_xy(self, frequency: DVec2) -> Frequency<Self> {
        Frequency {
            field: self,
            frequency,
        }
    }

    /// This field at the position times `frequency`: so many times as many features along both axes.
    fn frequency(self, frequency: f64) -> Frequency<Self> {
        self.frequency_xy(DVec2::splat(frequency))
    }

    /// This field at the position plus `offset`: its features move by `-offset`.
    fn offset(self, offset: DVec2) -> Offset<Self> {
        Offset {
            field: self,
            offset,
        }
    }

    /// This field turned about the origin by an angle in radians, from x towards y: clockwise in a picture, whose rows
    /// go down. It has no period.
    fn rotate(self, angle: f64) -> Rotated<Self> {
        let (sin, cos) = libm::sincos(angle);
        Rotated {
            field: self,
            direction: DVec2::new(cos, sin),
        }
    }

    /// This field at the position plus `amount · (x, y)`, where `x` and `y` are the values of two fields there: domain
    /// warping. An amount of 1 moves a position by as many units of the plane as the values say.
    #[doc(alias = "domain warping")]
    fn warp<X: IntoField, Y: IntoField>(
        self,
        x: X,
        y: Y,
        amount: f64,
    ) -> Warped<Self, X::Field, Y::Field> {
        Warped {
            field: self,
            x: x.into_field(),
            y: y.into_field(),
            amount,
        }
    }

    /// This field's values passed through a function.
    fn map<M: Fn(f32) -> f32 + Send + Sync>(self, function: M) -> Mapped<Self, M> {
        Mapped {
            field: self,
            function,
        }
    }

    /// This field's values stretched so that `from[0]` becomes `to[0]` and `from[1]` becomes `to[1]`. Nothing is cut off.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RasterErrorKind::Range) if the length of `from` is 0 or not finite, or an end of `to` is not finite.
    fn remap(self, from: [f32; 2], to: [f32; 2]) -> Result<Mapped<Self, Linear>, RasterError> {
        let length = from[1] - from[0];
        for (what, value, holds, range) in [
            (
                "length of the range",
                length,
                length != 0.0,
                "finite and not 0",
            ),
            ("end of the new range", to[0], true, "finite"),
            ("end of the new range", to[1], true, "finite"),
        ] {
            RasterError::check_range(holds && value.is_finite(), what, value.into(), range)?;
        }
        let from = from[0];
        Ok(Mapped {
            field: self,
            function: Linear { from, length, to },
        })
    }

    /// The sum of two fields.
    fn add<B: IntoField>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Add)
    }

    /// This field less another.
    fn sub<B: IntoField>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Subtract)
    }

    /// The product of two fields.
    fn mul<B: IntoField>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Multiply)
    }

    /// The smaller of the values of two fields.
    fn min<B: IntoField>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Minimum)
    }

    /// The larger of the values of two fields.
    fn max<B: IntoField>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Maximum)
    }

    /// Two fields combined value by value with an operation.
    fn with<B: IntoField>(self, other: B, operation: PairOperation) -> Pair<Self, B::Field> {
        Pair {
            first: self,
            second: other.into_field(),
            operation,
        }
    }

    /// The linear interpolation from this field to another: this field where `by` is 0 or less, the other one where it
    /// is 1 or more.
    fn mix<B: IntoField, T: IntoField>(self, to: B, by: T) -> Mixed<Self, B::Field, T::Field> {
        Mixed {
            from: self,
            to: to.into_field(),
            by: by.into_field(),
        }
    }

    /// Fractional Brownian motion: `Σ gain^i · field(lacunarity^i · position)` for `i` below `octaves`.
    ///
    /// All octaves are this one field, and so agree at the origin; [`Fractal::new`] takes a field of its own for each. A
    /// lacunarity of 2 and a gain of ½ are usual.
    ///
    /// # Errors
    ///
    /// The errors of [`Fractal::new`].
    #[doc(alias = "fBm")]
    fn fbm(self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Fractal<Self>, RasterError>
    where
        Self: Clone,
    {
        repeat(self, octaves, gain, lacunarity, FractalShape::Sum)
    }

    /// Ridges where the values of this field, which should lie about 0, cross 0: a sum of octaves like that of
    /// [`fbm`](Self::fbm), of `1 - |value|`.
    ///
    /// # Errors
    ///
    /// The errors of [`Fractal::new`].
    fn ridged(self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Fractal<Self>, RasterError>
    where
        Self: Clone,
    {
        repeat(self, octaves, gain, lacunarity, FractalShape::Ridged)
    }

    /// Round hills with creases where the values of this field, which should lie about 0, cross 0: a sum of octaves
    /// like that of [`fbm`](Self::fbm), of `|value|`.
    ///
    /// # Errors
    ///
    /// The errors of [`Fractal::new`].
    #[doc(alias = "turbulence")]
    fn billow(self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Fractal<Self>, RasterError>
    where
        Self: Clone,
    {
        repeat(self, octaves, gain, lacunarity, FractalShape::Billow)
    }
}

impl<F: Field> FieldExt for F {}

fn repeat<F: Field + Clone>(
    field: F,
    octaves: u32,
    gain: f64,
    lacunarity: f64,
    shape: FractalShape,
) -> Result<Fractal<F>, RasterError> {
    let octaves = core::iter::repeat_n(field, octaves as usize);
    Fractal::new(octaves, gain, lacunarity, shape)
}

#[cfg(test)]
mod tests;
