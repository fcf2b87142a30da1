//! Values at the control points, interpolated (equation 3).

use crate::pups::LEAST_TOTAL;
use crate::render::render;
use crate::sink::{Planes, Sink};
use crate::{Pups, PupsError};
use dapple_raster::{Field, Raster, RasterError, RasterViewMut, Window};
use fearless_simd::prelude::*;
use glam::DVec2;

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
    pub(crate) values: Vec<f32>,
}

/// A texture of vectors, such as colors: [`Texture`] for `N` numbers at once.
#[derive(Clone, Debug)]
pub struct VectorTexture<const N: usize> {
    pups: Pups,
    values: Vec<[f32; N]>,
}

impl Texture {
    pub(crate) fn new(pups: Pups, values: Vec<f32>) -> Result<Self, PupsError> {
        check_values(&pups, values.len(), &values)?;
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
        &self.values
    }
}

impl Field for Texture {
    #[inline]
    fn sample(&self, position: DVec2) -> f32 {
        let [value] = sample(&self.pups, self.values.as_chunks().0, position);
        value
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let sink = Mean {
            values: &self.values,
            n: 1,
        };
        render(&self.pups.net, window, &sink, out.rows_mut().collect());
        Ok(())
    }
}

impl<const N: usize> VectorTexture<N> {
    pub(crate) fn new(pups: Pups, values: Vec<[f32; N]>) -> Result<Self, PupsError> {
        check_values(&pups, values.len(), values.as_flattened())?;
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
        &self.values
    }

    /// The vector at a position.
    #[must_use]
    pub fn sample(&self, position: DVec2) -> [f32; N] {
        sample(&self.pups, &self.values, position)
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
            values: self.values.as_flattened(),
            n: N,
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

/// Refuses columns of another length, and numbers that are not finite.
fn check_values(pups: &Pups, count: usize, numbers: &[f32]) -> Result<(), PupsError> {
    PupsError::check_count("values", count, pups.n_points())?;
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(&number) => PupsError::check(
            false,
            "value of a control point",
            f64::from(number),
            "finite",
        ),
        None => Ok(()),
    }
}

/// The weighted mean at one position, summed as [`Mean`] does.
#[inline]
fn sample<const N: usize>(pups: &Pups, values: &[[f32; N]], position: DVec2) -> [f32; N] {
    let Some(position) = pups.local(position) else {
        return [f32::NAN; N];
    };
    let mut total = 0.0;
    let mut sums = [0.0; N];
    pups.net.for_each_weight(position, |instance, weight| {
        total += weight;
        for (sum, value) in sums.iter_mut().zip(values[instance.point as usize]) {
            *sum += weight * value;
        }
    });
    if total < LEAST_TOTAL {
        return values[pups.net.nearest(position).point as usize];
    }
    sums.map(|sum| sum / total)
}

/// Sums up weights, and weights times values.
pub(crate) struct Mean<'a> {
    /// The values, `n` to a control point.
    pub(crate) values: &'a [f32],
    pub(crate) n: usize,
}

impl Sink for Mean<'_> {
    type Value = f32;

    fn n_planes(&self) -> usize {
        1 + self.n
    }

    fn per_pixel(&self) -> usize {
        self.n
    }

    #[expect(
        clippy::needless_range_loop,
        reason = "registers pass through plain loops only"
    )]
    #[inline(always)]
    fn add<S: Simd, const N: usize>(
        &self,
        simd: S,
        point: u32,
        weights: &[S::f32s; N],
        planes: &mut Planes,
        at: usize,
    ) {
        planes.add(simd, 0, at, weights);
        let first = point as usize * self.n;
        for (plane, &value) in (1..).zip(&self.values[first..first + self.n]) {
            let mut products = *weights;
            for row in 0..N {
                products[row] *= value;
            }
            planes.add(simd, plane, at, &products);
        }
    }

    #[inline(always)]
    fn resolve<'a, S: Simd>(
        &self,
        simd: S,
        plane: impl Fn(usize) -> &'a [f32],
        values: &mut [f32],
        nearest: impl Fn(usize) -> u32,
    ) {
        let totals = plane(0);
        let mut least = f32::INFINITY;
        if self.n == 1 {
            least = divide(simd, plane(1), totals, values);
        } else {
            for channel in 0..self.n {
                let sums = plane(channel + 1).iter().zip(totals);
                for (value, (sum, &total)) in values[channel..].iter_mut().step_by(self.n).zip(sums)
                {
                    *value = sum / total;
                    least = least.min(total);
                }
            }
        }
        if least < LEAST_TOTAL {
            for (pixel, vector) in values.chunks_exact_mut(self.n).enumerate() {
                if totals[pixel] < LEAST_TOTAL {
                    let start = nearest(pixel) as usize * self.n;
                    vector.copy_from_slice(&self.values[start..start + self.n]);
                }
            }
        }
    }

    fn undefined(&self) -> f32 {
        f32::NAN
    }
}

/// Divides number by number, and returns the least divisor.
#[inline(always)]
fn divide<S: Simd>(simd: S, sums: &[f32], totals: &[f32], quotients: &mut [f32]) -> f32 {
    let mut least = S::f32s::splat(simd, f32::INFINITY);
    let mut sums = sums.chunks_exact(S::f32s::LEN);
    let mut totals = totals.chunks_exact(S::f32s::LEN);
    let mut quotients = quotients.chunks_exact_mut(S::f32s::LEN);
    for ((sum, total), quotient) in sums.by_ref().zip(totals.by_ref()).zip(quotients.by_ref()) {
        let total = S::f32s::from_slice(simd, total);
        least = least.min(total);
        (S::f32s::from_slice(simd, sum) / total).store_slice(quotient);
    }
    let mut least = least.reduce_min();
    let rest = sums.remainder().iter().zip(totals.remainder());
    for ((sum, &total), quotient) in rest.zip(quotients.into_remainder()) {
        least = least.min(total);
        *quotient = sum / total;
    }
    least
}
