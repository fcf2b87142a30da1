//! The door that everything with a value at every position shares.

use crate::{Raster, RasterError, RasterViewMut, Window};
use glam::DVec2;

/// A scalar function of the plane that can also fill a window.
///
/// The two doors give the same bits: `render` and `sample_many` equal `sample` at every position. An implementation
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

#[cfg(test)]
mod tests {
    use super::Field;
    use crate::{Raster, RasterErrorKind, Window};
    use glam::DVec2;

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
