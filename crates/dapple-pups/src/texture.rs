//! Values at the control points, interpolated (equation 3).

use crate::bins::Bins;
use crate::pups::LEAST_TOTAL;
use crate::render::render;
use crate::sink::Sink;
use crate::splat::LANES;
use crate::{Pups, PupsError};
use dapple_raster::{Field, Raster, RasterError, RasterViewMut, Window};
use fearless_simd::prelude::*;
use glam::DVec2;
use std::sync::OnceLock;

/// A scalar texture: at every position the mean of the control points' values, weighted after equation 3.
///
/// Its values lie between the smallest and the largest value of a control point, but for the rounding of single
/// precision. With an axis scale of at most 1 it has, at a control point, that point's value. At a position that is
/// not finite it is NaN.
///
/// # Examples
///
/// ```
/// use dapple_pups::{Pups, points::{Domain, white_noise}, hash::Seed};
/// use dapple_raster::{Field, Window};
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
    pub(crate) pups: Pups,
    values: Values<1>,
}

/// A texture of vectors, such as colors: [`Texture`] for `N` numbers at once.
#[derive(Clone, Debug)]
pub struct VectorTexture<const N: usize> {
    pups: Pups,
    values: Values<N>,
}

impl Texture {
    pub(crate) fn new(pups: Pups, values: Vec<f32>) -> Result<Self, PupsError> {
        let values = values.into_iter().map(|value| [value]).collect();
        let values = Values::new(&pups, values)?;
        Ok(Self { pups, values })
    }

    /// The net that the values belong to.
    #[must_use]
    pub fn pups(&self) -> &Pups {
        &self.pups
    }

    /// The values of the control points.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        self.values.by_point.as_flattened()
    }
}

impl Field for Texture {
    #[inline]
    fn sample(&self, position: DVec2) -> f32 {
        let [value] = self.values.sample(&self.pups, position);
        value
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let sink = Mean {
            values: &self.values.by_point,
        };
        render(&self.pups.net, window, &sink, out.rows_mut().collect());
        Ok(())
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.pups.domain().period()
    }
}

impl<const N: usize> VectorTexture<N> {
    pub(crate) fn new(pups: Pups, values: Vec<[f32; N]>) -> Result<Self, PupsError> {
        let values = Values::new(&pups, values)?;
        Ok(Self { pups, values })
    }

    /// The net that the values belong to.
    #[must_use]
    pub fn pups(&self) -> &Pups {
        &self.pups
    }

    /// The values of the control points.
    #[must_use]
    pub fn values(&self) -> &[[f32; N]] {
        &self.values.by_point
    }

    /// The vector at a position.
    #[must_use]
    pub fn sample(&self, position: DVec2) -> [f32; N] {
        self.values.sample(&self.pups, position)
    }

    /// The vectors at the pixel centers of a window, into memory of its size.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if `out` has another size than the window.
    pub fn render(
        &self,
        window: &Window,
        mut out: RasterViewMut<'_, [f32; N]>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let sink = Mean {
            values: &self.values.by_point,
        };
        let rows = out.rows_mut().map(<[_]>::as_flattened_mut).collect();
        render(&self.pups.net, window, &sink, rows);
        Ok(())
    }

    /// The vectors at the pixel centers of a window, as a new raster.
    ///
    /// # Errors
    ///
    /// [`Empty`](dapple_raster::RasterErrorKind::Empty) or [`TooLarge`](dapple_raster::RasterErrorKind::TooLarge) if
    /// the window has a bad size.
    pub fn to_raster(&self, window: &Window) -> Result<Raster<[f32; N]>, RasterError> {
        let mut raster = Raster::filled(window.size, [0.0; N])?;
        self.render(window, raster.view_mut())?;
        Ok(raster)
    }
}

/// The values of the control points.
#[derive(Clone, Debug)]
struct Values<const N: usize> {
    by_point: Vec<[f32; N]>,
    /// The values in the order of the records of the [`Bins`]; made when the first position is asked for.
    by_record: OnceLock<Vec<[f32; N]>>,
}

impl<const N: usize> Values<N> {
    /// Refuses columns of another length, and numbers that are not finite.
    fn new(pups: &Pups, by_point: Vec<[f32; N]>) -> Result<Self, PupsError> {
        const { assert!(N > 0, "a value has at least one number") };
        PupsError::check_count("values", by_point.len(), pups.n_points())?;
        let mut numbers = by_point.as_flattened().iter();
        if let Some(&number) = numbers.find(|number| !number.is_finite()) {
            let name = "value of a control point";
            PupsError::check(false, name, f64::from(number), "finite")?;
        }
        Ok(Self {
            by_point,
            by_record: OnceLock::new(),
        })
    }

    #[inline]
    fn by_record(&self, bins: &Bins) -> &[[f32; N]] {
        self.by_record.get_or_init(|| {
            let points = bins.points.iter();
            points.map(|&point| self.by_point[point as usize]).collect()
        })
    }

    /// The weighted mean at one position, summed as [`Mean`] does.
    #[inline]
    fn sample(&self, pups: &Pups, position: DVec2) -> [f32; N] {
        let Some(position) = pups.local(position) else {
            return [f32::NAN; N];
        };
        let values = self.by_record(pups.net.bins());
        let add = |(total, mut sums): (f32, [f32; N]), record: usize, weight: f32| {
            for (sum, value) in sums.iter_mut().zip(values[record]) {
                *sum += weight * value;
            }
            (total + weight, sums)
        };
        let (total, sums) = pups.net.fold_weights(position, (0.0, [0.0; N]), add);
        if total < LEAST_TOTAL {
            return self.by_point[pups.net.nearest(position) as usize];
        }
        sums.map(|sum| sum / total)
    }
}

/// Sums up weights, and weights times the `N` numbers of each value.
pub(crate) struct Mean<'a, const N: usize> {
    pub(crate) values: &'a [[f32; N]],
}

impl<const N: usize> Sink for Mean<'_, N> {
    type Value = f32;

    const PLANES: usize = N + 1;
    const PER_PIXEL: usize = N;

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
        let value = &self.values[point as usize];
        for row in 0..ROWS {
            add(simd, sums, row * Self::PLANES * LANES + lane, weights[row]);
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
        let totals = &sums[..LANES];
        if N == 1 && values.len() == LANES {
            divide(simd, &sums[LANES..2 * LANES], totals, values);
        } else {
            for (pixel, vector) in values.chunks_exact_mut(N).enumerate() {
                for (channel, value) in vector.iter_mut().enumerate() {
                    *value = sums[(channel + 1) * LANES + pixel] / totals[pixel];
                }
            }
        }
        if is_any_below(simd, totals, LEAST_TOTAL) {
            for (pixel, vector) in values.chunks_exact_mut(N).enumerate() {
                if totals[pixel] < LEAST_TOTAL {
                    vector.copy_from_slice(&self.values[nearest(pixel) as usize]);
                }
            }
        }
    }

    fn undefined(&self) -> f32 {
        f32::NAN
    }
}

/// Adds a register to numbers, from `at` on.
#[inline(always)]
fn add<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, sums: &mut [f32], at: usize, summand: V) {
    let sums = &mut sums[at..at + V::LEN];
    (V::from_slice(simd, sums) + summand).store_slice(sums);
}

/// Divides number by number.
#[inline(always)]
fn divide<S: Simd>(simd: S, sums: &[f32], totals: &[f32], quotients: &mut [f32]) {
    let n = S::f32s::LEN;
    for at in (0..LANES).step_by(n) {
        let sum = S::f32s::from_slice(simd, &sums[at..at + n]);
        let total = S::f32s::from_slice(simd, &totals[at..at + n]);
        (sum / total).store_slice(&mut quotients[at..at + n]);
    }
}

/// Whether one of the numbers is below a limit.
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
