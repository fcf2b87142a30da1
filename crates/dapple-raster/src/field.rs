//! The trait [`Field`]: anything that has a value at every position of the plane.

mod combinators;
mod fractal;
mod period;
mod positions;
mod values;

pub use combinators::FieldExt;
pub use fractal::{Fractal, FractalShape};
pub use period::common_period;
pub use positions::{Frequency, Offset, Rotated, Warped};
pub use values::{Change, Linear, Mapped, Mixed, Pair, PairOperation};

use crate::{Raster, RasterError, RasterErrorKind, RasterViewMut, Window};
use core::fmt;
use glam::DVec2;
use std::sync::Arc;

/// A scalar function of the plane that can also fill a window.
///
/// References, boxes and `Arc`s of fields are fields, and so are a [`Constant`] and closures in [`field_fn`]. Fields are
/// composed with the methods of [`FieldExt`], which take numbers, too.
///
/// All methods give the same bits: `render` and `sample_many` equal `sample` at every position. An implementation
/// overrides them when it is faster on many positions at once. At a position that is not finite the value is NaN.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Field, Window, glam::DVec2};
///
/// /// The distance from the origin.
/// struct Cone;
///
/// impl Field for Cone {
///     fn sample(&self, position: DVec2) -> f32 {
///         position.length() as f32
///     }
/// }
///
/// let raster = Cone.to_raster(&Window::unit([8, 8])?)?;
/// assert_eq!(raster.row(3)[5], Cone.sample(DVec2::new(0.6875, 0.4375)));
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
pub trait Field: Send + Sync {
    /// The value at a position.
    fn sample(&self, position: DVec2) -> f32;

    /// The values at many positions, into memory of the same length.
    ///
    /// # Errors
    ///
    /// [`Length`](crate::RasterErrorKind::Length) if the lengths differ.
    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        for (value, &position) in values.iter_mut().zip(positions) {
            *value = self.sample(position);
        }
        Ok(())
    }

    /// The values at the pixel centers of a window, into memory of its size.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](crate::RasterErrorKind::SizeMismatch) if `out` has another size than the window.
    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        for (row, values) in (0..).zip(out.rows_mut()) {
            let y = window.row_y(row);
            for (column, value) in (0..).zip(values) {
                *value = self.sample(DVec2::new(window.column_x(column), y));
            }
        }
        Ok(())
    }

    /// The distances after which the field repeats along x and y: `None` along an axis where it does not repeat or the
    /// period is unknown, 0 along an axis where the field is constant.
    fn period(&self) -> [Option<f64>; 2] {
        [None; 2]
    }

    /// One period of the field from the origin, as a raster of `size` pixels that tiles exactly. Along an axis where
    /// the field is constant, the raster covers a length of 1.
    ///
    /// # Errors
    ///
    /// [`NoPeriod`](RasterErrorKind::NoPeriod) if the field does not repeat along both axes, otherwise those of
    /// [`Window::new`].
    fn tile_raster(&self, size: [u32; 2]) -> Result<Raster<f32>, RasterError> {
        let extent = match self.period() {
            [Some(x), Some(y)] => DVec2::new(x, y).map(|side| if side == 0.0 { 1.0 } else { side }),
            _ => return Err(RasterError::new(RasterErrorKind::NoPeriod)),
        };
        self.to_raster(&Window::new(DVec2::ZERO, extent, size)?)
    }

    /// The values at the pixel centers of a window, as a new raster.
    ///
    /// # Errors
    ///
    /// [`Empty`](crate::RasterErrorKind::Empty) or [`TooLarge`](crate::RasterErrorKind::TooLarge) if the window has a bad
    /// size.
    fn to_raster(&self, window: &Window) -> Result<Raster<f32>, RasterError> {
        let mut raster = Raster::filled(window.size, 0.0)?;
        self.render(window, raster.view_mut())?;
        Ok(raster)
    }
}

macro_rules! forward_field {
    ($($holder:ty),*) => {$(
        impl<F: Field + ?Sized> Field for $holder {
            fn sample(&self, position: DVec2) -> f32 {
                (**self).sample(position)
            }

            fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
                (**self).sample_many(positions, values)
            }

            fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
                (**self).render(window, out)
            }

            fn period(&self) -> [Option<f64>; 2] {
                (**self).period()
            }
        }
    )*};
}

forward_field!(&F, Box<F>, Arc<F>);

/// The field that has one value everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f32);

impl Field for Constant {
    fn sample(&self, _position: DVec2) -> f32 {
        self.0
    }

    fn period(&self) -> [Option<f64>; 2] {
        [Some(0.0); 2]
    }
}

/// What can stand for a field in an argument: a field, or a number, which is a [`Constant`] then.
///
/// Numbers are not fields themselves: with [`FieldExt`] in scope, `value.max(0.0)` would be ambiguous for an `f32`.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Field, FieldExt, field_fn, glam::DVec2};
///
/// let slope = field_fn(|position| position.x as f32);
/// assert_eq!(slope.add(2.0).sample(DVec2::new(0.25, 7.0)), 2.25);
/// assert_eq!([1.0_f32, 3.0].map(|value| value.max(2.0)), [2.0, 3.0]);
/// ```
pub trait IntoField {
    /// The field.
    type Field: Field;

    /// This as a field.
    fn into_field(self) -> Self::Field;
}

impl<F: Field> IntoField for F {
    type Field = F;

    fn into_field(self) -> F {
        self
    }
}

impl IntoField for f32 {
    type Field = Constant;

    fn into_field(self) -> Constant {
        Constant(self)
    }
}

/// A field from a function of the position.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Field, field_fn, glam::DVec2};
///
/// let slope = field_fn(|position| position.x as f32);
/// assert_eq!(slope.sample(DVec2::new(0.25, 7.0)), 0.25);
/// ```
pub const fn field_fn<F: Fn(DVec2) -> f32 + Send + Sync>(function: F) -> FieldFn<F> {
    FieldFn(function)
}

/// The field that [`field_fn`] makes.
#[derive(Clone, Copy)]
pub struct FieldFn<F>(F);

impl<F: Fn(DVec2) -> f32 + Send + Sync> Field for FieldFn<F> {
    fn sample(&self, position: DVec2) -> f32 {
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
    use super::Field;
    use crate::{Raster, RasterErrorKind, Window};
    use glam::DVec2;
    use std::sync::Arc;

    struct Slope;

    impl Field for Slope {
        fn sample(&self, position: DVec2) -> f32 {
            (position.x + 2.0 * position.y) as f32
        }
    }

    #[test]
    fn a_field_is_object_safe_and_its_doors_agree() {
        let field: &dyn Field = &Slope;
        let window = Window::unit([5, 3]).unwrap();
        let raster = field.to_raster(&window).unwrap();
        let positions: Vec<DVec2> = (0..15).map(|at| window.position(at % 5, at / 5)).collect();
        let mut values = vec![0.0; 15];
        field.sample_many(&positions, &mut values).unwrap();
        assert_eq!(raster.pixels(), values);
        assert_eq!(values[7], field.sample(positions[7]));
    }

    #[test]
    fn holders_of_a_field_give_its_values_and_its_period() {
        struct Stripes;

        impl Field for Stripes {
            fn sample(&self, position: DVec2) -> f32 {
                (position.x - position.x.floor()) as f32
            }

            fn period(&self) -> [Option<f64>; 2] {
                [Some(1.0), Some(0.0)]
            }
        }

        let boxed: Box<dyn Field> = Box::new(Stripes);
        let shared: Arc<dyn Field> = Arc::new(Stripes);
        let position = DVec2::new(2.25, 9.0);
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
        let error = Slope.sample_many(&[DVec2::ZERO], &mut []).unwrap_err();
        assert!(matches!(
            error.kind(),
            RasterErrorKind::Length {
                length: 0,
                needed: 1
            }
        ));
    }
}
