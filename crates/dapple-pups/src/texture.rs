//! Textures that interpolate values of control points (equation 3).

use crate::bins::Bins;
use crate::pups::LEAST_TOTAL;
use crate::render::render;
use crate::sink::Sink;
use crate::splat::LANES;
use crate::{Pups, PupsError};
use dapple_raster::{Field, FieldParts, Raster, RasterError, RasterViewMut, Window};
use fearless_simd::prelude::*;
use glam::DVec2;
use std::sync::OnceLock;

/// A scalar texture: at every position, the weighted mean of the control points' values (equation 3).
///
/// Values are between the smallest and the largest value of a control point, up to rounding in single precision. With
/// an axis scale of at most 1, the value at a control point is that point's value. It is NaN at a position that is not
/// finite.
///
/// # Examples
///
/// ```
/// use dapple_pups::{Pups, points::{Domain, white_noise}, hash::Seed};
/// use dapple_raster::prelude::*;
///
/// let points = white_noise(Domain::paper_torus(), 50, Seed(1))?;
/// let values = (0..50).map(|index| index as f32 / 49.0).collect();
/// let texture = Pups::delaunay(&points)?.texture(values)?;
/// let window = Window::new(points.domain().origin, points.domain().size, [64, 64])?;
/// let raster = texture.to_raster(&window)?;
/// assert_eq!(raster.row(7)[9], texture.sample(window.position(9, 7)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Texture {
    values: Values,
}

/// A texture of vectors, such as colors: a [`Texture`] with `N` components.
#[derive(Clone, Debug)]
pub struct VectorTexture<const N: usize> {
    values: Values,
}

impl Texture {
    pub(crate) fn new(pups: Pups, values: Vec<f32>) -> Result<Self, PupsError> {
        let values = Values::new(pups, 1, values)?;
        Ok(Self { values })
    }

    /// Returns the net of the control points.
    #[must_use]
    pub fn pups(&self) -> &Pups {
        &self.values.pups
    }

    /// Returns the value of each control point.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values.by_point
    }
}

impl Field for Texture {
    fn parts(&self) -> FieldParts<'_> {
        FieldParts::Generator(self)
    }

    #[inline]
    fn value(&self, position: [f64; 2]) -> f32 {
        let mut value = [0.0];
        self.values.sample(position.into(), &mut value);
        value[0]
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let mut rows: Vec<_> = out.rows_mut().collect();
        self.values.render(window, &mut rows);
        Ok(())
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.pups().domain().period()
    }
}

impl<const N: usize> VectorTexture<N> {
    pub(crate) fn new(pups: Pups, values: Vec<[f32; N]>) -> Result<Self, PupsError> {
        const { assert!(N > 0, "a vector has at least one number") };
        let values = Values::new(pups, N, values.into_flattened())?;
        Ok(Self { values })
    }

    /// Returns the net of the control points.
    #[must_use]
    pub fn pups(&self) -> &Pups {
        &self.values.pups
    }

    /// Returns the vector, such as a color, of each control point.
    #[must_use]
    pub fn values(&self) -> &[[f32; N]] {
        self.values.by_point.as_chunks().0
    }

    /// Returns the interpolated vector at `position`.
    #[must_use]
    pub fn sample(&self, position: impl Into<[f64; 2]>) -> [f32; N] {
        let mut vector = [0.0; N];
        self.values.sample(position.into().into(), &mut vector);
        vector
    }

    /// Renders the vectors at the pixel centers of a window into `out`.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of `out` differs from the window's.
    pub fn render(
        &self,
        window: &Window,
        mut out: RasterViewMut<'_, [f32; N]>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let rows = out.rows_mut().map(<[_]>::as_flattened_mut);
        self.values.render(window, &mut rows.collect::<Vec<_>>());
        Ok(())
    }

    /// Renders the vectors at the pixel centers of a window to a new raster.
    ///
    /// # Errors
    ///
    /// [`Empty`](dapple_raster::RasterErrorKind::Empty) or [`TooLarge`](dapple_raster::RasterErrorKind::TooLarge) if
    /// the size of the window is invalid.
    pub fn to_raster(&self, window: &Window) -> Result<Raster<[f32; N]>, RasterError> {
        let mut raster = Raster::filled(window.size, [0.0; N])?;
        self.render(window, raster.view_mut())?;
        Ok(raster)
    }
}

/// The values of the control points of a net, with `width` components each.
///
/// The width is a field, not a type parameter, so that the code is compiled in this crate only, not in every crate
/// that uses vectors.
#[derive(Clone, Debug)]
struct Values {
    pups: Pups,
    width: usize,
    by_point: Vec<f32>,
    /// Values in the order of the [`Bins`]' records instead of the points, computed on first use.
    by_record: OnceLock<Vec<f32>>,
}

impl Values {
    /// Checks that every control point has a value, and that all components are finite.
    fn new(pups: Pups, width: usize, by_point: Vec<f32>) -> Result<Self, PupsError> {
        PupsError::check_count("values", by_point.len() / width, pups.n_points())?;
        if let Some(&number) = by_point.iter().find(|number| !number.is_finite()) {
            let name = "value of a control point";
            PupsError::check(false, name, f64::from(number), "finite")?;
        }
        Ok(Self {
            pups,
            width,
            by_point,
            by_record: OnceLock::new(),
        })
    }

    #[inline]
    fn by_record(&self, bins: &Bins) -> &[f32] {
        self.by_record.get_or_init(|| {
            let points = bins.points.iter();
            let values = points.map(|&point| self.of_point(point));
            values.collect::<Vec<_>>().concat()
        })
    }

    fn of_point(&self, point: u32) -> &[f32] {
        &self.by_point[point as usize * self.width..][..self.width]
    }

    /// Computes the weighted mean at one position, summed in the same order as in [`Mean`].
    fn sample(&self, position: DVec2, mean: &mut [f32]) {
        let Some(position) = self.pups.local(position) else {
            mean.fill(f32::NAN);
            return;
        };
        let net = &self.pups.net;
        let values = self.by_record(net.bins());
        // Sum the weights, and the values times the weights. A single component is summed in a register.
        let total = match &mut *mean {
            [mean] => {
                let add = |(total, sum): (f32, f32), record: usize, weight: f32| {
                    (total + weight, sum + weight * values[record])
                };
                let (total, sum) = net.fold_weights(position, (0.0, 0.0), add);
                *mean = sum;
                total
            }
            sums => net.fold_weights(position, 0.0, |total, record, weight| {
                for (sum, value) in sums.iter_mut().zip(&values[record * self.width..]) {
                    *sum += weight * value;
                }
                total + weight
            }),
        };
        // If the weights underflow, use the nearest control point.
        if total < LEAST_TOTAL {
            mean.copy_from_slice(self.of_point(net.nearest(position)));
        } else {
            // Equation 3: Σ T_i W_i / Σ W_i.
            mean.iter_mut().for_each(|sum| *sum /= total);
        }
    }

    /// Renders the weighted means at the pixel centers of a window, up to three components at a time.
    fn render(&self, window: &Window, rows: &mut [&mut [f32]]) {
        let mut first = 0;
        while first < self.width {
            // Three components share the weights of one pass over the control points.
            let (values, width) = (&self.by_point, self.width);
            first += if width - first >= 3 {
                let mean = Mean::<3>::new(values, width, first);
                render(&self.pups.net, window, &mean, rows);
                3
            } else {
                let mean = Mean::<1>::new(values, width, first);
                render(&self.pups.net, window, &mean, rows);
                1
            };
        }
    }
}

/// Sink that sums the weights, and the products of the weights and `N` components of the values.
pub(crate) struct Mean<'a, const N: usize> {
    /// Components of all control points' values, interleaved.
    values: &'a [f32],
    /// Number of components of a value in `values`.
    width: usize,
    /// Index of the first of the `N` components that this sink sums.
    first: usize,
}

impl<'a, const N: usize> Mean<'a, N> {
    pub(crate) fn new(values: &'a [f32], width: usize, first: usize) -> Self {
        Self {
            values,
            width,
            first,
        }
    }

    /// Returns the `N` components of a control point's value.
    #[inline(always)]
    fn of_point(&self, point: u32) -> &[f32] {
        &self.values[point as usize * self.width + self.first..][..N]
    }
}

impl<const N: usize> Sink for Mean<'_, N> {
    type Value = f32;

    const PLANES: usize = N + 1;

    fn per_pixel(&self) -> usize {
        self.width
    }

    #[expect(
        clippy::needless_range_loop,
        reason = "registers pass through plain loops only"
    )]
    #[inline(always)]
    fn add<S: Simd, V: SimdFloat<S, Element = f32>, const ROWS: usize>(
        &self,
        simd: S,
        point: u32,
        weights: &[V; ROWS],
        sums: &mut [f32],
        lane: usize,
    ) {
        let value = self.of_point(point);
        for row in 0..ROWS {
            // The first plane sums the weights.
            add(simd, sums, row * Self::PLANES * LANES + lane, weights[row]);
            // The other planes sum the products of weights and components.
            for channel in 0..N {
                let at = (row * Self::PLANES + channel + 1) * LANES + lane;
                add(simd, sums, at, weights[row] * value[channel]);
            }
        }
    }

    #[inline(always)]
    fn resolve<S: Simd>(
        &self,
        simd: S,
        sums: &[f32],
        values: &mut [f32],
        nearest: impl Fn(usize) -> u32,
    ) {
        // Divide the sums by the total weights.
        let totals = &sums[..LANES];
        if N == 1 && self.width == 1 && values.len() == LANES {
            divide(simd, &sums[LANES..2 * LANES], totals, values);
        } else {
            for (pixel, vector) in values.chunks_exact_mut(self.width).enumerate() {
                let vector = &mut vector[self.first..self.first + N];
                for (channel, value) in vector.iter_mut().enumerate() {
                    *value = sums[(channel + 1) * LANES + pixel] / totals[pixel];
                }
            }
        }
        // If the weights of a pixel underflow, use the nearest control point.
        if is_any_below(simd, totals, LEAST_TOTAL) {
            for (pixel, vector) in values.chunks_exact_mut(self.width).enumerate() {
                if totals[pixel] < LEAST_TOTAL {
                    let value = self.of_point(nearest(pixel));
                    vector[self.first..self.first + N].copy_from_slice(value);
                }
            }
        }
    }

    fn leave_undefined(&self, values: &mut [f32]) {
        values.fill(f32::NAN);
    }
}

/// Adds a register to the elements of `sums` starting at index `at`.
#[inline(always)]
fn add<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, sums: &mut [f32], at: usize, summand: V) {
    let sums = &mut sums[at..at + V::LEN];
    (V::from_slice(simd, sums) + summand).store_slice(sums);
}

/// Divides sums by totals, element by element.
#[inline(always)]
fn divide<S: Simd>(simd: S, sums: &[f32], totals: &[f32], quotients: &mut [f32]) {
    let n = S::f32s::LEN;
    for at in (0..LANES).step_by(n) {
        let sum = S::f32s::from_slice(simd, &sums[at..at + n]);
        let total = S::f32s::from_slice(simd, &totals[at..at + n]);
        (sum / total).store_slice(&mut quotients[at..at + n]);
    }
}

/// Returns whether any number is below a limit.
#[inline(always)]
fn is_any_below<S: Simd>(simd: S, numbers: &[f32], limit: f32) -> bool {
    let limit = S::f32s::splat(simd, limit);
    let mut any = false;
    for at in (0..LANES).step_by(S::f32s::LEN) {
        let numbers = S::f32s::from_slice(simd, &numbers[at..at + S::f32s::LEN]);
        any |= numbers.simd_lt(limit).any_true();
    }
    any
}
