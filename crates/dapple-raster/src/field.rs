//! The trait [`Field`] for functions that have a value at every position in the plane or in space.

mod combinators;
mod fractal;
mod gradient;
mod parts;
mod period;
mod positions;
mod slice;
mod values;

pub use combinators::FieldExt;
pub use fractal::{Fractal, FractalShape};
pub use gradient::{DisplacementGradient, Gradient};
pub use parts::FieldParts;
pub use period::common_period;
pub use positions::{Displacement, Rotated, Scaled, Translated, Warped};
pub use slice::{Extruded, Slice};
pub use values::{Change, Linear, Mapped, Mixed, Pair, PairOperation};

use crate::{Raster, RasterError, RasterErrorKind, RasterViewMut, Window};
use core::fmt;
use std::sync::Arc;

/// A scalar function of positions with `N` coordinates. It is defined on the plane (by default), in space, or in
/// space and time, and can also render a window.
///
/// Generators implement this trait, and programs store `dyn Field`. [`FieldExt`] has the methods for callers:
/// [`sample`](FieldExt::sample) accepts any library's vectors, and other methods compose fields. References, boxes
/// and `Arc`s of fields are fields, and so are a [`Constant`] and closures wrapped by [`field_fn`].
///
/// All methods give the same bits: `render` and `values` equal `value` at every position. Implementations override
/// them to be faster on many positions. At a position that is not finite, the value is NaN.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Field, FieldExt, Window};
///
/// /// The sum of the coordinates.
/// struct Slope;
///
/// impl Field for Slope {
///     fn value(&self, [x, y]: [f64; 2]) -> f32 {
///         (x + y) as f32
///     }
/// }
///
/// let raster = Slope.to_raster(&Window::unit([8, 8])?)?;
/// assert_eq!(raster.row(3)[5], Slope.sample([0.6875, 0.4375]));
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
pub trait Field<const N: usize = 2>: Send + Sync {
    /// Returns the value at a position.
    fn value(&self, position: [f64; N]) -> f32;

    /// Computes the values at many positions; both slices must have the same length.
    ///
    /// # Errors
    ///
    /// [`Length`](crate::RasterErrorKind::Length) if the lengths differ.
    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        for (value, &position) in values.iter_mut().zip(positions) {
            *value = self.value(position);
        }
        Ok(())
    }

    /// Computes the values at a window's pixel centers; `out` must be the same size as the window.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](crate::RasterErrorKind::SizeMismatch) if `out` and the window differ in size.
    fn render(
        &self,
        window: &Window<N>,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        for (row, values) in (0..).zip(out.rows_mut()) {
            for (column, value) in (0..).zip(values) {
                *value = self.value(window.position(column, row));
            }
        }
        Ok(())
    }

    /// Renders several windows, such as the planes of a volume, each into a view of the same size. This is faster
    /// than rendering them one at a time if neighboring planes share work, as cellular noise does.
    ///
    /// # Errors
    ///
    /// [`Length`](crate::RasterErrorKind::Length) if the numbers of windows and views differ, and
    fn render_stack(
        &self,
        windows: &[Window<N>],
        outs: Vec<RasterViewMut<'_, f32>>,
    ) -> Result<(), RasterError> {
        RasterError::check_length(outs.len(), windows.len())?;
        let mut stack = windows.iter().zip(outs);
        stack.try_for_each(|(window, out)| self.render(window, out))
    }

    /// Returns the field's period along each axis. It is `None` if the field does not repeat or its period is
    /// unknown, and 0 if the field is constant along the axis.
    fn period(&self) -> [Option<f64>; N] {
        [None; N]
    }

    /// Returns how the field is composed, for programs that translate fields, such as to shaders. It is
    /// [`Unknown`](FieldParts::Unknown) unless an implementation overrides it.
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Unknown
    }

    /// Renders one period of the field, starting at the origin, as a raster of `size` pixels that tiles exactly. Only
    /// the first two axes are rendered; the other coordinates are 0. Along an axis where the field is constant, the
    /// raster covers a length of 1.
    ///
    /// # Errors
    ///
    /// [`NoPeriod`](RasterErrorKind::NoPeriod) if the field does not repeat along both axes, or any error from
    /// [`Window::new`].
    fn tile_raster(&self, size: [u32; 2]) -> Result<Raster<f32>, RasterError> {
        let mut extent = [1.0; 2];
        for (side, period) in extent.iter_mut().zip(self.period()) {
            let period = period.ok_or_else(|| RasterError::new(RasterErrorKind::NoPeriod))?;
            if period != 0.0 {
                *side = period;
            }
        }
        let window = Window::new([0.0; 2], extent, size)?;
        self.to_raster(&window.in_space([0.0; N]))
    }

    /// Renders a window into a new raster.
    ///
    /// # Errors
    ///
    /// [`Empty`](crate::RasterErrorKind::Empty) or [`TooLarge`](crate::RasterErrorKind::TooLarge) if the size of the
    /// window is invalid.
    fn to_raster(&self, window: &Window<N>) -> Result<Raster<f32>, RasterError> {
        let mut raster = Raster::filled(window.size, 0.0)?;
        self.render(window, raster.view_mut())?;
        Ok(raster)
    }
}

macro_rules! forward_field {
    ($($holder:ty),*) => {$(
        impl<const N: usize, F: Field<N> + ?Sized> Field<N> for $holder {
            fn value(&self, position: [f64; N]) -> f32 {
                (**self).value(position)
            }

            fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
                (**self).values(positions, values)
            }

            fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
                (**self).render(window, out)
            }

            fn render_stack(
                &self,
                windows: &[Window<N>],
                outs: Vec<RasterViewMut<'_, f32>>,
            ) -> Result<(), RasterError> {
                (**self).render_stack(windows, outs)
            }

            fn period(&self) -> [Option<f64>; N] {
                (**self).period()
            }

            fn parts(&self) -> FieldParts<'_, N> {
                (**self).parts()
            }
        }
    )*};
}

forward_field!(&F, Box<F>, Arc<F>);

/// A field with the same value everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f32);

impl<const N: usize> Field<N> for Constant {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Constant(self.0)
    }

    fn value(&self, _position: [f64; N]) -> f32 {
        self.0
    }

    fn period(&self) -> [Option<f64>; N] {
        [Some(0.0); N]
    }
}

/// Conversion to a field. It is implemented for fields, and for numbers, which become a [`Constant`].
///
/// Numbers are not fields themselves, because `value.max(0.0)` would be ambiguous for an `f32` with [`FieldExt`] in
/// scope.
///
/// # Examples
///
/// ```
/// use dapple_raster::{FieldExt, field_fn};
///
/// let slope = field_fn(|[x, _y]| x as f32);
/// assert_eq!(slope.add(2.0).sample([0.25, 7.0]), 2.25);
/// assert_eq!([1.0_f32, 3.0].map(|value| value.max(2.0)), [2.0, 3.0]);
/// ```
pub trait IntoField<const N: usize = 2> {
    /// Type of the resulting field.
    type Field: Field<N>;

    /// Converts `self` to a field.
    fn into_field(self) -> Self::Field;
}

impl<const N: usize, F: Field<N>> IntoField<N> for F {
    type Field = F;

    fn into_field(self) -> F {
        self
    }
}

impl<const N: usize> IntoField<N> for f32 {
    type Field = Constant;

    fn into_field(self) -> Constant {
        Constant(self)
    }
}

/// Creates a field from a function of two (plane), three (space) or four coordinates.
///
/// # Examples
///
/// ```
/// use dapple_raster::{FieldExt, field_fn};
///
/// let slope = field_fn(|[x, _y]| x as f32);
/// assert_eq!(slope.sample([0.25, 7.0]), 0.25);
/// let height = field_fn(|[_x, _y, z]| z as f32);
/// assert_eq!(height.sample([0.25, 7.0, 3.0]), 3.0);
/// ```
pub const fn field_fn<const N: usize, F: Fn([f64; N]) -> f32 + Send + Sync>(
    function: F,
) -> FieldFn<F> {
    FieldFn(function)
}

/// Field created by [`field_fn`].
#[derive(Clone, Copy)]
pub struct FieldFn<F>(F);

impl<const N: usize, F: Fn([f64; N]) -> f32 + Send + Sync> Field<N> for FieldFn<F> {
    fn value(&self, position: [f64; N]) -> f32 {
        (self.0)(position)
    }
}

impl<F> fmt::Debug for FieldFn<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FieldFn")
    }
}

#[cfg(test)]
mod tests {
    use super::{Field, FieldExt};
    use crate::{Raster, RasterErrorKind, Window};
    use std::sync::Arc;

    struct Slope;

    impl Field for Slope {
        fn value(&self, [x, y]: [f64; 2]) -> f32 {
            (x + 2.0 * y) as f32
        }
    }

    #[test]
    fn a_field_is_object_safe_and_its_methods_agree() {
        let field: &dyn Field = &Slope;
        let window = Window::unit([5, 3]).unwrap();
        let raster = field.to_raster(&window).unwrap();
        let positions: Vec<[f64; 2]> = (0..15).map(|at| window.position(at % 5, at / 5)).collect();
        let mut values = vec![0.0; 15];
        field.values(&positions, &mut values).unwrap();
        assert_eq!(raster.pixels(), values);
        assert_eq!(values[7], field.sample(positions[7]));
    }

    #[test]
    fn holders_of_a_field_give_its_values_and_its_period() {
        struct Stripes;

        impl Field for Stripes {
            fn value(&self, [x, _y]: [f64; 2]) -> f32 {
                (x - x.floor()) as f32
            }

            fn period(&self) -> [Option<f64>; 2] {
                [Some(1.0), Some(0.0)]
            }
        }

        let boxed: Box<dyn Field> = Box::new(Stripes);
        let shared: Arc<dyn Field> = Arc::new(Stripes);
        let position = [2.25, 9.0];
        for field in [&Stripes as &dyn Field, &boxed, &shared, &&Stripes] {
            assert_eq!(field.sample(position), 0.25);
            assert_eq!(field.period(), [Some(1.0), Some(0.0)]);
            let tile = field.tile_raster([4, 1]).unwrap();
            assert_eq!(tile.pixels(), [0.125, 0.375, 0.625, 0.875]);
        }
        let error = Slope.tile_raster([4, 4]).unwrap_err();
        assert_eq!(error.kind(), &RasterErrorKind::NoPeriod, "no period");
    }

    #[test]
    fn memory_of_another_size_is_refused() {
        let window = Window::unit([5, 3]).unwrap();
        let mut raster = Raster::filled([5, 4], 0.0).unwrap();
        let error = Slope.render(&window, raster.view_mut()).unwrap_err();
        assert!(matches!(
            error.kind(),
            RasterErrorKind::SizeMismatch { needed: [5, 3], .. }
        ));
        let error = Slope.sample_many(&[[0.0; 2]], &mut []).unwrap_err();
        assert!(matches!(
            error.kind(),
            RasterErrorKind::Length {
                length: 0,
                needed: 1
            }
        ));
    }
}
