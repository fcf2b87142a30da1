//! Fields that transform the position before sampling another field.

use super::common_period;
use super::values::by_bands;
use crate::{Field, FieldParts, RasterError, RasterViewMut, Window};

/// A field with scaled positions; see [`FieldExt::frequency`](super::FieldExt::frequency).
#[derive(Clone, Copy, Debug)]
pub struct Scaled<F, const N: usize = 2> {
    pub(super) field: F,
    pub(super) frequency: [f64; N],
}

/// A field with translated positions; see [`FieldExt::offset`](super::FieldExt::offset).
#[derive(Clone, Copy, Debug)]
pub struct Translated<F, const N: usize = 2> {
    pub(super) field: F,
    pub(super) offset: [f64; N],
}

/// A field rotated about the origin; see [`FieldExt::rotate`](super::FieldExt::rotate).
#[derive(Clone, Copy, Debug)]
pub struct Rotated<F> {
    pub(super) field: F,
    /// Cosine and sine of the angle.
    pub(super) direction: [f64; 2],
}

/// A field with displaced positions; see [`FieldExt::warp`](super::FieldExt::warp).
#[derive(Clone, Copy, Debug)]
pub struct Warped<F, D> {
    pub(super) field: F,
    pub(super) by: D,
    pub(super) amount: f64,
}

/// Displacement fields, one per axis: an array of fields of one type, or a tuple of different types.
pub trait Displacement<const N: usize = 2>: Send + Sync {
    /// Returns the displacement field along `axis`, which must be below `N`.
    fn along(&self, axis: usize) -> &dyn Field<N>;
}

impl<const N: usize, F: Field<N>> Displacement<N> for [F; N] {
    fn along(&self, axis: usize) -> &dyn Field<N> {
        &self[axis]
    }
}

macro_rules! displacement {
    ($n:literal: $($field:ident $index:tt),*) => {
        impl<$($field: Field<$n>),*> Displacement<$n> for ($($field),*) {
            fn along(&self, axis: usize) -> &dyn Field<$n> {
                let along: [&dyn Field<$n>; $n] = [$(&self.$index),*];
                along[axis]
            }
        }
    };
}

displacement!(2: X 0, Y 1);
displacement!(3: X 0, Y 1, Z 2);
displacement!(4: X 0, Y 1, Z 2, W 3);

/// Renders a window by sampling the field at each pixel's position, on all cores if the feature `rayon` is enabled.
fn render_rows<const N: usize>(
    field: &impl Field<N>,
    window: &Window<N>,
    out: RasterViewMut<'_, f32>,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    by_bands(window, out, |part, mut band, _| {
        let mut positions = Vec::with_capacity(part.size[0] as usize);
        for (row, values) in (0..).zip(band.rows_mut()) {
            positions.clear();
            positions.extend((0..part.size[0]).map(|column| part.position(column, row)));
            field.values(&positions, values)?;
        }
        Ok(())
    })
}

impl<F, const N: usize> Scaled<F, N> {
    pub(super) fn moved(&self, mut position: [f64; N]) -> [f64; N] {
        for (at, frequency) in position.iter_mut().zip(self.frequency) {
            *at *= frequency;
        }
        position
    }
}

impl<F: Field<N>, const N: usize> Field<N> for Scaled<F, N> {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Scaled(&self.field, self.frequency)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.field.value(self.moved(position))
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        let scaled: Vec<_> = positions.iter().map(|&at| self.moved(at)).collect();
        self.field.values(&scaled, values)
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        match window.scaled(self.frequency) {
            Some(scaled) => self.field.render(&scaled, out),
            None => render_rows(self, window, out),
        }
    }

    fn period(&self) -> [Option<f64>; N] {
        let mut period = self.field.period();
        for (period, frequency) in period.iter_mut().zip(self.frequency) {
            let shorter = period.map(|period| period / frequency.abs());
            *period = match shorter {
                Some(shorter) if !shorter.is_finite() => Some(0.0),
                shorter => shorter,
            };
        }
        period
    }
}

impl<F, const N: usize> Translated<F, N> {
    pub(super) fn moved(&self, mut position: [f64; N]) -> [f64; N] {
        for (at, offset) in position.iter_mut().zip(self.offset) {
            *at += offset;
        }
        position
    }
}

impl<F: Field<N>, const N: usize> Field<N> for Translated<F, N> {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Translated(&self.field, self.offset)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.field.value(self.moved(position))
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        let moved: Vec<_> = positions.iter().map(|&at| self.moved(at)).collect();
        self.field.values(&moved, values)
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        render_rows(self, window, out)
    }

    fn period(&self) -> [Option<f64>; N] {
        self.field.period()
    }
}

impl<F> Rotated<F> {
    pub(super) fn moved<const N: usize>(&self, mut position: [f64; N]) -> [f64; N] {
        let ([cos, sin], [x, y]) = (self.direction, [position[0], position[1]]);
        position[0] = x * cos + y * sin;
        position[1] = y * cos - x * sin;
        position
    }
}

impl<F: Field<N>, const N: usize> Field<N> for Rotated<F> {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Rotated(&self.field, self.direction)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.field.value(self.moved(position))
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        let turned: Vec<_> = positions.iter().map(|&at| self.moved(at)).collect();
        self.field.values(&turned, values)
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        render_rows(self, window, out)
    }

    fn period(&self) -> [Option<f64>; N] {
        let mut period = self.field.period();
        period[..2].fill(None);
        period
    }
}

impl<F, D> Warped<F, D> {
    /// Displaces positions along `axis` by `amount` times the values of the displacement field.
    fn displace<const N: usize>(&self, positions: &mut [[f64; N]], axis: usize, by: &[f32]) {
        for (position, &by) in positions.iter_mut().zip(by) {
            position[axis] += self.amount * f64::from(by);
        }
    }
}

impl<F: Field<N>, D: Displacement<N>, const N: usize> Field<N> for Warped<F, D> {
    fn parts(&self) -> FieldParts<'_, N> {
        let by = core::array::from_fn(|axis| self.by.along(axis));
        FieldParts::Warped(&self.field, by, self.amount)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        let mut moved = position;
        for (axis, at) in moved.iter_mut().enumerate() {
            *at += self.amount * f64::from(self.by.along(axis).value(position));
        }
        self.field.value(moved)
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        let mut moved = positions.to_vec();
        for axis in 0..N {
            self.by.along(axis).values(positions, values)?;
            self.displace(&mut moved, axis, values);
        }
        self.field.values(&moved, values)
    }

    fn render(&self, window: &Window<N>, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        by_bands(window, out, |part, mut band, memory| {
            let [width, height] = part.size;
            let rows =
                (0..height).map(|row| (0..width).map(move |column| part.position(column, row)));
            let mut moved: Vec<_> = rows.flatten().collect();
            for axis in 0..N {
                self.by.along(axis).render(part, memory.reborrow())?;
                let rows = moved.chunks_mut(width as usize).zip(memory.rows_mut());
                for (positions, by) in rows {
                    self.displace(positions, axis, by);
                }
            }
            for (positions, values) in moved.chunks(width as usize).zip(band.rows_mut()) {
                self.field.values(positions, values)?;
            }
            Ok(())
        })
    }

    fn period(&self) -> [Option<f64>; N] {
        let along = (0..N).map(|axis| self.by.along(axis).period());
        along.fold(self.field.period(), common_period)
    }
}
