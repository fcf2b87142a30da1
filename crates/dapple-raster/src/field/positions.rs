//! Fields that sample another field at transformed positions.

use super::common_period;
use super::values::by_bands;
use crate::{Field, RasterError, RasterViewMut, Window};
use glam::DVec2;

/// A field at the position times a factor: see [`FieldExt::frequency`](super::FieldExt::frequency).
#[derive(Clone, Copy, Debug)]
pub struct Frequency<F> {
    pub(super) field: F,
    pub(super) frequency: DVec2,
}

/// A field at the position plus an offset: see [`FieldExt::offset`](super::FieldExt::offset).
#[derive(Clone, Copy, Debug)]
pub struct Offset<F> {
    pub(super) field: F,
    pub(super) offset: DVec2,
}

/// A field turned about the origin: see [`FieldExt::rotate`](super::FieldExt::rotate).
#[derive(Clone, Copy, Debug)]
pub struct Rotated<F> {
    pub(super) field: F,
    /// The cosine and the sine of the angle.
    pub(super) direction: DVec2,
}

/// A field at positions that two others displace: see [`FieldExt::warp`](super::FieldExt::warp).
#[derive(Clone, Copy, Debug)]
pub struct Warped<F, X, Y> {
    pub(super) field: F,
    pub(super) x: X,
    pub(super) y: Y,
    pub(super) amount: f64,
}

/// Fills a window from its positions, on all cores where the feature `rayon` is on.
fn render_rows(
    field: &impl Field,
    window: &Window,
    out: RasterViewMut<'_, f32>,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    by_bands(window, out, |part, mut band, _| {
        let mut positions = Vec::with_capacity(part.size[0] as usize);
        for (row, values) in (0..).zip(band.rows_mut()) {
            positions.clear();
            positions.extend((0..part.size[0]).map(|column| part.position(column, row)));
            field.sample_many(&positions, values)?;
        }
        Ok(())
    })
}

impl<F: Field> Field for Frequency<F> {
    fn sample(&self, position: DVec2) -> f32 {
        self.field.sample(position * self.frequency)
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        let scaled: Vec<_> = positions.iter().map(|&at| at * self.frequency).collect();
        self.field.sample_many(&scaled, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        match window.scaled(self.frequency) {
            Some(scaled) => self.field.render(&scaled, out),
            None => render_rows(self, window, out),
        }
    }

    fn period(&self) -> [Option<f64>; 2] {
        let [x, y] = self.field.period();
        let shorter = |period: Option<f64>, factor: f64| match period? / factor.abs() {
            period if period.is_finite() => Some(period),
            _ => Some(0.0),
        };
        [shorter(x, self.frequency.x), shorter(y, self.frequency.y)]
    }
}

impl<F: Field> Field for Offset<F> {
    fn sample(&self, position: DVec2) -> f32 {
        self.field.sample(position + self.offset)
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        let moved: Vec<_> = positions.iter().map(|&at| at + self.offset).collect();
        self.field.sample_many(&moved, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        render_rows(self, window, out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.field.period()
    }
}

impl<F> Rotated<F> {
    fn turn(&self, DVec2 { x, y }: DVec2) -> DVec2 {
        let [cos, sin] = self.direction.to_array();
        DVec2::new(x * cos + y * sin, y * cos - x * sin)
    }
}

impl<F: Field> Field for Rotated<F> {
    fn sample(&self, position: DVec2) -> f32 {
        self.field.sample(self.turn(position))
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        let turned: Vec<_> = positions.iter().map(|&at| self.turn(at)).collect();
        self.field.sample_many(&turned, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        render_rows(self, window, out)
    }
}

impl<F: Field, X: Field, Y: Field> Field for Warped<F, X, Y> {
    fn sample(&self, position: DVec2) -> f32 {
        let by = [self.x.sample(position), self.y.sample(position)];
        self.field.sample(displaced(position, by, self.amount))
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        let mut x = vec![0.0; positions.len()];
        self.x.sample_many(positions, &mut x)?;
        self.y.sample_many(positions, values)?;
        let moved: Vec<_> = (positions.iter().zip(&x).zip(&*values))
            .map(|((&position, &x), &y)| displaced(position, [x, y], self.amount))
            .collect();
        self.field.sample_many(&moved, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        by_bands(window, out, |part, mut band, memory| {
            self.x.render(part, memory.reborrow())?;
            self.y.render(part, band.reborrow())?;
            let mut moved = Vec::with_capacity(part.size[0] as usize);
            for ((row, values), x) in (0..).zip(band.rows_mut()).zip(memory.rows_mut()) {
                moved.clear();
                moved.extend((0..).zip(&*x).zip(&*values).map(|((column, &dx), &dy)| {
                    displaced(part.position(column, row), [dx, dy], self.amount)
                }));
                self.field.sample_many(&moved, values)?;
            }
            Ok(())
        })
    }

    fn period(&self) -> [Option<f64>; 2] {
        common_period(
            self.field.period(),
            common_period(self.x.period(), self.y.period()),
        )
    }
}

fn displaced(position: DVec2, by: [f32; 2], amount: f64) -> DVec2 {
    position + amount * DVec2::from(by.map(f64::from))
}
