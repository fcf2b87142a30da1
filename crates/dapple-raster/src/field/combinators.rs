//! The trait [`FieldExt`], for sampling with any library's vectors and for composing fields.

use super::{
    Extruded, Linear, Mapped, Mixed, Pair, PairOperation, Rotated, Scaled, Slice, Translated,
    Warped,
};
use crate::{Displacement, Field, Gradient, IntoField, RasterError};

/// Methods for sampling and composing, available on all fields.
///
/// A position is an array of `N` coordinates, or any type that converts to one, such as vectors from any glam
/// version.
///
/// Compositions transform positions or change values; [`Fractal`](crate::Fractal) sums copies at several scales.
/// Compositions satisfy the requirements of [`Field`]: all methods give the same bits, and the period is derived from
/// the parts' periods. They work in the plane and in space.
///
/// # Examples
///
/// ```
/// use dapple_raster::{FieldExt, field_fn, glam::DVec2};
///
/// let waves = field_fn(|[x, _y]| (x - x.floor()) as f32);
/// let field = (&waves).frequency(8.0).remap([0.0, 1.0], [-1.0, 1.0])?.add(waves);
/// assert_eq!(field.sample([0.0625, 0.0]), 0.0625);
/// assert_eq!(field.sample(DVec2::new(0.0625, 0.0)), 0.0625);
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
pub trait FieldExt<const N: usize = 2>: Field<N> + Sized {
    /// Returns the value at a position.
    fn sample(&self, position: impl Into<[f64; N]>) -> f32 {
        self.value(position.into())
    }

    /// Computes the values at many positions; both slices must have the same length. This is faster than single calls
    /// for most fields. If the positions are arrays, [`Field::values`] avoids copying them.
    ///
    /// # Errors
    ///
    /// [`Length`](crate::RasterErrorKind::Length) if the lengths differ.
    fn sample_many<P: Copy + Into<[f64; N]>>(
        &self,
        positions: &[P],
        values: &mut [f32],
    ) -> Result<(), RasterError> {
        let positions: Vec<[f64; N]> = positions.iter().map(|&at| at.into()).collect();
        self.values(&positions, values)
    }

    /// Returns the value at a position, equal to [`sample`](Self::sample), and its derivative along each axis, for
    /// fields with a [`Gradient`].
    #[doc(alias("derivative", "analytic derivatives"))]
    fn sample_with_gradient(&self, position: impl Into<[f64; N]>) -> (f32, [f32; N])
    where
        Self: Gradient<N>,
    {
        self.value_and_gradient(position.into())
    }

    /// Restricts the field to the plane along the first two axes, at fixed coordinates along the others: `[z]` in
    /// space, `[z, w]` in four dimensions, for example `[depth, time]`. A wrong number of coordinates is a
    /// compile-time error.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::{Field, FieldExt, Window, field_fn};
    ///
    /// let solid = field_fn(|[x, y, z]| (x * y + z) as f32);
    /// let plane = solid.slice([0.5]).to_raster(&Window::unit([2, 2])?)?;
    /// assert_eq!(plane.row(1)[1], 1.0625);
    /// # Ok::<(), dapple_raster::RasterError>(())
    /// ```
    fn slice<const REST: usize>(self, rest: [f64; REST]) -> Slice<Self, N> {
        const {
            assert!(
                REST + 2 == N,
                "a plane has a coordinate for each axis past the second"
            );
        }
        let mut whole = [0.0; N];
        whole[2..].copy_from_slice(&rest);
        Slice {
            field: self,
            rest: whole,
        }
    }

    /// Extends this 2-D field to more dimensions; it is constant along the added axes.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::{FieldExt, field_fn};
    ///
    /// let ground = field_fn(|[x, _y]| x as f32);
    /// let above = field_fn(|[_x, _y, z]| z as f32).sub(ground.extrude());
    /// assert_eq!(above.sample([2.0, 7.0, 5.0]), 3.0);
    /// ```
    fn extrude(self) -> Extruded<Self>
    where
        Self: Field,
    {
        Extruded { field: self }
    }

    /// Scales positions by `frequency` along each axis, which gives `frequency` times as many features along that
    /// axis.
    ///
    /// For the same factor along all axes, use [`frequency`](Self::frequency).
    fn frequency_per_axis(self, frequency: impl Into<[f64; N]>) -> Scaled<Self, N> {
        Scaled {
            field: self,
            frequency: frequency.into(),
        }
    }

    /// Scales positions by `frequency`, which gives `frequency` times as many features along all axes.
    fn frequency(self, frequency: f64) -> Scaled<Self, N> {
        self.frequency_per_axis([frequency; N])
    }

    /// Adds `offset` to positions; features move by `-offset`.
    fn offset(self, offset: impl Into<[f64; N]>) -> Translated<Self, N> {
        Translated {
            field: self,
            offset: offset.into(),
        }
    }

    /// Rotates the field about the origin by `angle` in radians, from the x axis toward the y axis. This is clockwise
    /// in an image, where y points down. In space, the axis of rotation is the line where x and y are 0. The result
    /// has no period along x and y.
    fn rotate(self, angle: f64) -> Rotated<Self> {
        let (sin, cos) = libm::sincos(angle);
        Rotated {
            field: self,
            direction: [cos, sin],
        }
    }

    /// Warps the domain: displaces positions by `amount` times the values of other fields, one field per axis. With
    /// an amount of 1, a position moves by the field's value, in position units.
    ///
    /// `by` is an array of fields, or a tuple of fields of different types.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::{Constant, FieldExt, field_fn};
    ///
    /// let stripes = field_fn(|[x, _y]| x.rem_euclid(1.0) as f32);
    /// let waves = field_fn(|[_x, y]| (y * y) as f32);
    /// let bent = stripes.warp((waves, Constant(0.0)), 0.5);
    /// assert_eq!(bent.sample([0.25, 1.0]), 0.75);
    /// ```
    #[doc(alias = "domain warping")]
    fn warp<D: Displacement<N>>(self, by: D, amount: f64) -> Warped<Self, D> {
        Warped {
            field: self,
            by,
            amount,
        }
    }

    /// Applies a function to the field's values.
    fn map<M: Fn(f32) -> f32 + Send + Sync>(self, function: M) -> Mapped<Self, M> {
        Mapped {
            field: self,
            function,
        }
    }

    /// Maps values linearly from the range `from` to the range `to`, without clamping.
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

    /// Returns the sum of two fields.
    fn add<B: IntoField<N>>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Add)
    }

    /// Returns the difference of two fields.
    fn sub<B: IntoField<N>>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Subtract)
    }

    /// Returns the product of two fields.
    fn mul<B: IntoField<N>>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Multiply)
    }

    /// Returns the minimum of two fields.
    fn min<B: IntoField<N>>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Minimum)
    }

    /// Returns the maximum of two fields.
    fn max<B: IntoField<N>>(self, other: B) -> Pair<Self, B::Field> {
        self.with(other, PairOperation::Maximum)
    }

    /// Combines two fields value by value with `operation`.
    fn with<B: IntoField<N>>(self, other: B, operation: PairOperation) -> Pair<Self, B::Field> {
        Pair {
            first: self,
            second: other.into_field(),
            operation,
        }
    }

    /// Interpolates linearly between two fields. The result is this field where `by` is 0 or less, and `to` where
    /// `by` is 1 or more.
    fn mix<B: IntoField<N>, T: IntoField<N>>(
        self,
        to: B,
        by: T,
    ) -> Mixed<Self, B::Field, T::Field> {
        Mixed {
            from: self,
            to: to.into_field(),
            by: by.into_field(),
        }
    }
}

impl<const N: usize, F: Field<N>> FieldExt<N> for F {}

#[cfg(test)]
mod tests;
