//! The partition of unity over a control net, with its weights and labels.

use crate::net::{GraphKind, Net};
use crate::render::render;
use crate::sink::Sink;
use crate::splat::LANES;
use crate::{PupsError, PupsOptions, Texture, VectorTexture};
use dapple_graph::{Graph, IsCancelled, delaunay_cancellable};
use dapple_points::{Domain, PointIdx, PointSet};
use dapple_raster::{Raster, RasterError, RasterViewMut, Window};
use fearless_simd::prelude::*;
use glam::DVec2;
use std::sync::Arc;

/// Control points with their axes, which give every control point a weight at every position.
///
/// Cheap to clone: clones share the net. [`texture`](Self::texture) interpolates values given at the control points.
///
#[cfg_attr(doc, doc = include_str!("../docs/pups.md"))]
///
/// # Examples
///
/// ```
/// use dapple_pups::{Pups, points::{Domain, white_noise}, hash::Seed, glam::DVec2};
///
/// let points = white_noise(Domain::paper_torus(), 50, Seed(1))?;
/// let pups = Pups::delaunay(&points)?;
/// let total: f32 = pups.weights(DVec2::new(0.3, -0.2)).iter().map(|(_, weight)| weight).sum();
/// assert!((total - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pups {
    pub(crate) net: Arc<Net>,
    points: Arc<PointSet>,
}

impl Pups {
    /// Builds the net of the Delaunay triangulation of `points`, with default options, as in the paper.
    ///
    /// # Errors
    ///
    /// Same as [`delaunay_with`](Self::delaunay_with).
    pub fn delaunay(points: &PointSet) -> Result<Self, PupsError> {
        Self::delaunay_with(points, PupsOptions::default())
    }

    /// Builds the net of the Delaunay triangulation of `points` with the given options.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new), and [`Graph`](crate::PupsErrorKind::Graph) if the triangulation fails.
    pub fn delaunay_with(points: &PointSet, options: PupsOptions) -> Result<Self, PupsError> {
        Self::delaunay_cancellable(points, options, &|| false)
    }

    /// Builds the same net as [`delaunay_with`](Self::delaunay_with), unless `is_cancelled` returns true.
    ///
    /// # Errors
    ///
    /// Same as [`delaunay_with`](Self::delaunay_with), and [`Cancelled`](crate::PupsErrorKind::Cancelled).
    pub fn delaunay_cancellable(
        points: &PointSet,
        options: PupsOptions,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, PupsError> {
        let graph = delaunay_cancellable(points, is_cancelled).map_err(PupsError::of_part)?;
        Self::of_delaunay(points, &graph, options, is_cancelled)
    }

    /// Builds the net of `graph`, which must be the Delaunay triangulation of `points`.
    pub(crate) fn of_delaunay(
        points: &PointSet,
        graph: &Graph,
        options: PupsOptions,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, PupsError> {
        let net = Net::new(points, graph, GraphKind::Delaunay, options, is_cancelled)?;
        Ok(Self {
            net: Arc::new(net),
            points: Arc::new(points.clone()),
        })
    }

    /// Builds the net of any graph over `points`.
    ///
    /// If the graph contains the Delaunay triangulation, the support of a control point is its Voronoi cell scaled by
    /// `2 · axis_scale`. With another graph, it is the polygon bounded by the point's own axes, which still contains
    /// that cell, so every position has a weight. Where two neighboring axes of a point are 180° or more apart, its
    /// Delaunay axes are added, which closes the support if possible. On the hull of points on axes that do not wrap,
    /// supports are unbounded, and the texture is defined on the whole plane.
    ///
    /// # Errors
    ///
    /// [`NoPoints`](crate::PupsErrorKind::NoPoints) without points, [`Count`](crate::PupsErrorKind::Count) if the graph
    /// has another number of points, [`ShortAxis`](crate::PupsErrorKind::ShortAxis) if points are closer than 1e-9 of
    /// the domain's larger side, [`Range`](crate::PupsErrorKind::Range) if the domain is smaller than 1e-18 or larger
    /// than 1e18. If the options are invalid, same as [`PupsOptions::check`].
    pub fn new(points: &PointSet, graph: &Graph, options: PupsOptions) -> Result<Self, PupsError> {
        Self::new_cancellable(points, graph, options, &|| false)
    }

    /// Builds the same net as [`new`](Self::new), unless `is_cancelled` returns true.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new), and [`Cancelled`](crate::PupsErrorKind::Cancelled).
    pub fn new_cancellable(
        points: &PointSet,
        graph: &Graph,
        options: PupsOptions,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, PupsError> {
        let net = Net::new(points, graph, GraphKind::Any, options, is_cancelled)?;
        Ok(Self {
            net: Arc::new(net),
            points: Arc::new(points.clone()),
        })
    }

    /// Returns the number of control points.
    #[must_use]
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// Returns the control points.
    #[must_use]
    pub fn points(&self) -> &PointSet {
        &self.points
    }

    /// Returns the domain of the control points, which determines the texture's period.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.net.domain
    }

    /// Returns the net's options.
    #[must_use]
    pub fn options(&self) -> &PupsOptions {
        &self.net.options
    }

    /// Builds a scalar texture from `values`, one for each control point.
    ///
    /// # Errors
    ///
    /// [`Count`](crate::PupsErrorKind::Count) if the number of values is not the number of control points,
    /// [`Range`](crate::PupsErrorKind::Range) if a value is not finite.
    pub fn texture(&self, values: Vec<f32>) -> Result<Texture, PupsError> {
        Texture::new(self.clone(), values)
    }

    /// Builds a texture of vectors, such as colors, from `values`, one vector for each control point.
    ///
    /// # Errors
    ///
    /// Same as [`texture`](Self::texture).
    pub fn vector_texture<const N: usize>(
        &self,
        values: Vec<[f32; N]>,
    ) -> Result<VectorTexture<N>, PupsError> {
        VectorTexture::new(self.clone(), values)
    }

    /// Returns a control point's weight at `position`, by equation 2, or by equation 4 with orientations. It is 1 at
    /// the control point and 0 outside of its support.
    ///
    /// If the position is in the supports of several periodic images of the control point, the largest weight counts.
    /// The weight is NaN at a position that is not finite, and 0 if the index has no control point.
    #[must_use]
    pub fn weight(&self, point: PointIdx, position: impl Into<[f64; 2]>) -> f32 {
        self.weight_at(point, position.into())
    }

    fn weight_at(&self, point: PointIdx, position: [f64; 2]) -> f32 {
        let Some(position) = self.local(position.into()) else {
            return f32::NAN;
        };
        let points = &self.net.bins().points;
        // Of all periodic images of this control point, the largest weight counts.
        let larger = |largest: f32, record: usize, weight: f32| {
            if points[record] == point.0 {
                largest.max(weight)
            } else {
                largest
            }
        };
        self.net.fold_weights(position, 0.0, larger)
    }

    /// Returns the control points that have a nonzero weight at `position`, with their weights, which sum to 1.
    ///
    /// They are ordered by index. On a small torus a control point may occur several times, once for each periodic
    /// image. The list is empty at a position that is not finite.
    #[must_use]
    pub fn weights(&self, position: impl Into<[f64; 2]>) -> Vec<(PointIdx, f32)> {
        self.weights_at(position.into())
    }

    fn weights_at(&self, position: [f64; 2]) -> Vec<(PointIdx, f32)> {
        let Some(position) = self.local(position.into()) else {
            return Vec::new();
        };
        // Collect the nonzero weights in the order of summation, and add them up.
        let mut weights = Vec::new();
        let points = &self.net.bins().points;
        let total = self
            .net
            .fold_weights(position, 0.0, |total, record, weight| {
                if weight > 0.0 {
                    weights.push((PointIdx(points[record]), weight));
                }
                total + weight
            });
        // If all weights underflow, the nearest control point alone determines the texture.
        if total < LEAST_TOTAL {
            return vec![(PointIdx(self.net.nearest(position)), 1.0)];
        }
        // Normalize the weights, as in equation 3.
        weights.iter_mut().for_each(|(_, weight)| *weight /= total);
        weights
    }

    /// Returns the control point with the largest weight at `position`, which determines the label there. If several
    /// weights are equal, the first point is returned.
    ///
    /// Returns `None` at a position that is not finite.
    #[must_use]
    pub fn strongest(&self, position: impl Into<[f64; 2]>) -> Option<PointIdx> {
        self.strongest_at(position.into())
    }

    fn strongest_at(&self, position: [f64; 2]) -> Option<PointIdx> {
        let position = self.local(position.into())?;
        let points = &self.net.bins().points;
        // Only a larger weight replaces the best one, so the first of equal weights wins.
        let stronger = |best: (f32, Option<u32>), record: usize, weight: f32| {
            if weight > best.0 {
                (weight, Some(points[record]))
            } else {
                best
            }
        };
        let best = self.net.fold_weights(position, (0.0, None), stronger);
        // Without a positive weight, all of them have underflowed. Use the nearest control point.
        let point = best.1.unwrap_or_else(|| self.net.nearest(position));
        Some(PointIdx(point))
    }

    /// Renders the control point with the largest weight at every pixel center of a window; see
    /// [`strongest`](Self::strongest). The result is `PointIdx(u32::MAX)` where a position is not finite.
    ///
    /// # Errors
    ///
    /// [`SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if the size of `out` differs from the window's.
    pub fn render_strongest(
        &self,
        window: &Window,
        mut out: RasterViewMut<'_, PointIdx>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let mut rows: Vec<_> = out.rows_mut().collect();
        render(&self.net, window, &Strongest, &mut rows);
        Ok(())
    }

    /// Renders the label at every pixel center of a window. `labels` has one label for each control point.
    ///
    /// # Errors
    ///
    /// [`Count`](crate::PupsErrorKind::Count) if the number of labels is not the number of control points,
    /// [`Raster`](crate::PupsErrorKind::Raster) if the window has an invalid size or positions that are not finite.
    pub fn label_raster<L: Copy>(
        &self,
        window: &Window,
        labels: &[L],
    ) -> Result<Raster<L>, PupsError> {
        PupsError::check_count("labels", labels.len(), self.n_points())?;
        let mut strongest = Raster::filled(window.size, PointIdx(u32::MAX))?;
        self.render_strongest(window, strongest.view_mut())?;
        // A position that is not finite has no control point.
        if let Some(at) = strongest
            .pixels()
            .iter()
            .position(|point| point.index() >= labels.len())
        {
            let width = window.size[0] as usize;
            let position = window.position((at % width) as u32, (at / width) as u32);
            PupsError::check(
                false,
                "position of a pixel",
                position[0] + position[1],
                "finite",
            )?;
        }
        Ok(strongest.map(|point| labels[point.index()]))
    }

    /// Moves a position into the range of evaluated positions (see [`Net::local`]). Returns `None` if it is not
    /// finite.
    #[inline]
    pub(crate) fn local(&self, position: DVec2) -> Option<DVec2> {
        // Most positions are inside of the domain and need no wrapping.
        if self.net.domain.contains(position) {
            return Some(position);
        }
        let local = DVec2::new(self.net.local(0, position.x), self.net.local(1, position.y));
        local.is_finite().then_some(local)
    }
}

/// Minimum sum of weights for which values are interpolated. With orientations near full strength, the sum may
/// underflow in single precision. Below this limit, the value of the nearest control point is used.
pub(crate) const LEAST_TOTAL: f32 = 1e-30;

/// Sink that tracks, for each pixel, the largest weight and its control point, whose index is stored as the bits of an
/// `f32`.
struct Strongest;

impl Sink for Strongest {
    type Value = PointIdx;

    const PLANES: usize = 2;

    fn per_pixel(&self) -> usize {
        1
    }

    #[expect(
        clippy::needless_range_loop,
        reason = "registers pass through plain loops only"
    )]
    #[inline(always)]
    fn add<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
        &self,
        simd: S,
        point: u32,
        weights: &[V; N],
        sums: &mut [f32],
        lane: usize,
    ) {
        // Pass the point's index as the bits of a float. `select` moves bits and does not compute with them.
        let point = V::splat(simd, f32::from_bits(point));
        for row in 0..N {
            // A row has two planes: the largest weights so far, and the points that have them.
            let at = row * Self::PLANES * LANES + lane;
            let best_weight = V::from_slice(simd, &sums[at..at + V::LEN]);
            // In lanes with a larger weight, replace the weight and the point.
            let stronger = weights[row].simd_gt(best_weight);
            let weight = stronger.select(weights[row], best_weight);
            weight.store_slice(&mut sums[at..at + V::LEN]);
            let best = &mut sums[at + LANES..at + LANES + V::LEN];
            let best_point = V::from_slice(simd, best);
            stronger.select(point, best_point).store_slice(best);
        }
    }

    #[inline(always)]
    fn resolve<S: Simd>(
        &self,
        _: S,
        sums: &[f32],
        values: &mut [PointIdx],
        nearest: impl Fn(usize) -> u32,
    ) {
        // Split the row into its planes of weights and points.
        let (weights, points) = sums.split_at(LANES);
        for (pixel, (value, (&weight, &point))) in values
            .iter_mut()
            .zip(weights.iter().zip(points))
            .enumerate()
        {
            // Where all weights underflow, use the nearest control point.
            *value = PointIdx(if weight > 0.0 {
                point.to_bits()
            } else {
                nearest(pixel)
            });
        }
    }

    fn leave_undefined(&self, values: &mut [PointIdx]) {
        values.fill(PointIdx(u32::MAX));
    }
}
