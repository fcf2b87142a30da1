//! Fields that change or combine the values of other fields.

use super::common_period;
use crate::{Field, FieldParts, RasterError, RasterViewMut, Window, parallel};
use core::fmt;

/// Number of values that are computed at a time, chosen so that two bands fit a core's cache.
const BAND: usize = 1 << 17;

/// A field with a function applied to its values; see [`FieldExt::map`](super::FieldExt::map).
#[derive(Clone, Copy)]
pub struct Mapped<F, M> {
    pub(super) field: F,
    pub(super) function: M,
}

/// Function that a [`Mapped`] field applies to its values: a function of one number, or a [`Linear`] map.
pub trait Change: Send + Sync {
    /// Returns the new value.
    fn change(&self, value: f32) -> f32;

    /// Returns this function as a [`Linear`] map; `None` if it is another function.
    #[doc(hidden)]
    fn linear(&self) -> Option<&Linear> {
        None
    }
}

impl<M: Fn(f32) -> f32 + Send + Sync> Change for M {
    fn change(&self, value: f32) -> f32 {
        self(value)
    }
}

/// A linear map from one range to another; see [`FieldExt::remap`](super::FieldExt::remap).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    pub(super) from: f32,
    pub(super) length: f32,
    pub(super) to: [f32; 2],
}

impl Change for Linear {
    fn change(&self, value: f32) -> f32 {
        let [start, end] = self.to;
        start + (end - start) * ((value - self.from) / self.length)
    }

    fn linear(&self) -> Option<&Linear> {
        Some(self)
    }
}

/// Two fields combined value by value; see [`FieldExt::add`](super::FieldExt::add) and related methods.
#[derive(Clone, Copy, Debug)]
pub struct Pair<A, B> {
    pub(super) first: A,
    pub(super) second: B,
    pub(super) operation: PairOperation,
}

crate::named! {
    /// Operation that combines two values.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum PairOperation {
        /// Sum of the values.
        Add = "add",
        /// First value minus the second.
        Subtract = "subtract",
        /// Product of the values.
        Multiply = "multiply",
        /// Minimum of the values; the first value if either is NaN.
        Minimum = "minimum",
        /// Maximum of the values; the first value if either is NaN.
        Maximum = "maximum",
    }
}

/// Linear interpolation between two fields; see [`FieldExt::mix`](super::FieldExt::mix).
#[derive(Clone, Copy, Debug)]
pub struct Mixed<A, B, T> {
    pub(super) from: A,
    pub(super) to: B,
    pub(super) by: T,
}

impl PairOperation {
    /// Applies the operation to two values.
    #[must_use]
    #[inline]
    pub fn apply(self, a: f32, b: f32) -> f32 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Minimum if b < a => b,
            Self::Maximum if b > a => b,
            Self::Minimum | Self::Maximum => a,
        }
    }
}

impl<F, M> fmt::Debug for Mapped<F, M>
where
    F: fmt::Debug,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Mapped").field(&self.field).finish()
    }
}

impl<F: Field<N>, M: Change, const N: usize> Field<N> for Mapped<F, M> {
    fn parts(&self) -> FieldParts<'_, N> {
        match self.function.linear() {
            Some(&Linear { from, length, to }) => FieldParts::Linear {
                field: &self.field,
                from,
                length,
                to,
            },
            None => FieldParts::Unknown,
        }
    }

    fn value(&self, position: [f64; N]) -> f32 {
        self.function.change(self.field.value(position))
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        self.field.values(positions, values)?;
        for value in values {
            *value = self.function.change(*value);
        }
        Ok(())
    }

    fn render(
        &self,
        window: &Window<N>,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        self.field.render(window, out.reborrow())?;
        for values in out.rows_mut() {
            for value in values {
                *value = self.function.change(*value);
            }
        }
        Ok(())
    }

    fn period(&self) -> [Option<f64>; N] {
        self.field.period()
    }
}

impl<A: Field<N>, B: Field<N>, const N: usize> Field<N> for Pair<A, B> {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Pair(&self.first, &self.second, self.operation)
    }

    fn value(&self, position: [f64; N]) -> f32 {
        let (a, b) = (self.first.value(position), self.second.value(position));
        self.operation.apply(a, b)
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        self.first.values(positions, values)?;
        let mut others = vec![0.0; positions.len()];
        self.second.values(positions, &mut others)?;
        for (value, &other) in values.iter_mut().zip(&others) {
            *value = self.operation.apply(*value, other);
        }
        Ok(())
    }

    fn render(
        &self,
        window: &Window<N>,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        self.first.render(window, out.reborrow())?;
        join(&self.second, window, out, |value, other| {
            *value = self.operation.apply(*value, other);
        })
    }

    fn period(&self) -> [Option<f64>; N] {
        common_period(self.first.period(), self.second.period())
    }
}

impl<A: Field<N>, B: Field<N>, T: Field<N>, const N: usize> Field<N> for Mixed<A, B, T> {
    fn parts(&self) -> FieldParts<'_, N> {
        FieldParts::Mixed([&self.from, &self.to, &self.by])
    }

    fn value(&self, position: [f64; N]) -> f32 {
        let (from, to) = (self.from.value(position), self.to.value(position));
        from + (to - from) * unit(self.by.value(position))
    }

    fn values(&self, positions: &[[f64; N]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        let mut from = vec![0.0; positions.len()];
        let mut to = vec![0.0; positions.len()];
        self.from.values(positions, &mut from)?;
        self.to.values(positions, &mut to)?;
        self.by.values(positions, values)?;
        for ((value, from), to) in values.iter_mut().zip(from).zip(to) {
            *value = from + (to - from) * unit(*value);
        }
        Ok(())
    }

    fn render(
        &self,
        window: &Window<N>,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        let from = self.from.to_raster(window)?;
        let to = self.to.to_raster(window)?;
        self.by.render(window, out.reborrow())?;
        let (from, to) = (from.view(), to.view());
        for (values, (from, to)) in out.rows_mut().zip(from.rows().zip(to.rows())) {
            for ((value, from), to) in values.iter_mut().zip(from).zip(to) {
                *value = from + (to - from) * unit(*value);
            }
        }
        Ok(())
    }

    fn period(&self) -> [Option<f64>; N] {
        common_period(
            common_period(self.from.period(), self.to.period()),
            self.by.period(),
        )
    }
}

pub(super) fn unit(value: f32) -> f32 {
    value.clamp(0.0, 1.0)
}

/// Renders a field in bands, and calls `change` with each pixel of `out` and the rendered value at that pixel.
fn join<const N: usize>(
    field: &impl Field<N>,
    window: &Window<N>,
    out: RasterViewMut<'_, f32>,
    change: impl Fn(&mut f32, f32) + Sync,
) -> Result<(), RasterError> {
    by_bands(window, out, |part, mut band, memory| {
        field.render(part, memory.reborrow())?;
        zip_rows(&mut band, memory, &change);
        Ok(())
    })
}

/// Renders bands that fit the cache of a core, on all cores if the feature `rayon` is enabled. `fill` receives the
/// part of the window, its pixels, and a scratch buffer of the same size.
pub(super) fn by_bands<const N: usize>(
    window: &Window<N>,
    out: RasterViewMut<'_, f32>,
    fill: impl Fn(
        &Window<N>,
        RasterViewMut<'_, f32>,
        &mut RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError>
    + Sync,
) -> Result<(), RasterError> {
    let width = window.size[0] as usize;
    let height = (BAND / width).clamp(1, window.size[1] as usize) as u32;
    let mut bands: Vec<_> = out.bands(height).collect();
    let done = parallel::map_mut_at_least(1, &mut bands, |band, values| {
        let size = values.size();
        let part = window.crop([0, band as i64 * i64::from(height)], size)?;
        let mut memory = vec![0.0; width * size[1] as usize];
        let mut memory = RasterViewMut::new(&mut memory, width, size)?;
        fill(&part, values.reborrow(), &mut memory)
    });
    done.into_iter().collect()
}

/// Calls `change` for each pixel of `values`, with the pixel of `others` at the same position.
pub(super) fn zip_rows(
    values: &mut RasterViewMut<'_, f32>,
    others: &mut RasterViewMut<'_, f32>,
    change: impl Fn(&mut f32, f32),
) {
    // Use one loop per row: a flat iterator would not vectorize.
    for (values, others) in values.rows_mut().zip(others.rows_mut()) {
        for (value, &mut other) in values.iter_mut().zip(others) {
            change(value, other);
        }
    }
}
