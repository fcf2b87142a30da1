//! Planar slices of 3-D and 4-D fields, and extrusion of 2-D fields.

use crate::{Field, RasterError, RasterViewMut, Window};

/// A slice of a 3-D or 4-D field along the first two axes; see [`FieldExt::slice`](super::FieldExt::slice).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice<F, const N: usize> {
    pub(super) field: F,
    /// Coordinates of the slice along the other axes; the first two entries are unused.
    pub(super) rest: [f64; N],
}

impl<F, const N: usize> Slice<F, N> {
    pub(super) fn in_space(&self, [x, y]: [f64; 2]) -> [f64; N] {
        let mut position = self.rest;
        position[0] = x;
        position[1] = y;
        position
    }
}

impl<F: Field<N>, const N: usize> Field for Slice<F, N> {
    fn value(&self, position: [f64; 2]) -> f32 {
        self.field.value(self.in_space(position))
    }

    fn values(&self, positions: &[[f64; 2]], values: &mut [f32]) -> Result<(), RasterError> {
        let positions: Vec<_> = positions.iter().map(|&at| self.in_space(at)).collect();
        self.field.values(&positions, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        self.field.render(&window.in_space(self.rest), out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        let period = self.field.period();
        [period[0], period[1]]
    }
}

/// A 2-D field extended to more dimensions, constant along the added axes; see
/// [`FieldExt::extrude`](super::FieldExt::extrude).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extruded<F> {
    pub(super) field: F,
}

impl<F: Field, const N: usize> Field<N> for Extruded<F> {
    fn value(&self, position: [f64; N]) -> f32 {
        if position.iter().any(|part| !part.is_finite()) {
            return f32::NAN;
        }
        self.field.value([position[0], position[1]])
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        let flat: Vec<_> = positions.iter().map(|at| [at[0], at[1]]).collect();
        self.field.values(&flat, values)?;
        for (value, position) in values.iter_mut().zip(positions) {
            if position[2..].iter().any(|part| !part.is_finite()) {
                *value = f32::NAN;
            }
        }
        Ok(())
    }

    fn render(
        &self,
        window: &Window<N>,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        self.field.render(&window.in_plane(), out.reborrow())?;
        if (2..N).any(|axis| !window.depth(axis).is_finite()) {
            out.fill(f32::NAN);
        }
        Ok(())
    }

    fn period(&self) -> [Option<f64>; N] {
        let mut period = [Some(0.0); N];
        period[..2].copy_from_slice(&self.field.period());
        period
    }
}
