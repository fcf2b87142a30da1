//! The control net: control points with their scaled axes, in a form that is fast to evaluate.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013, section 2.
//!
//! An axis `v` of a control point `c`, scaled by `s`, projects a position `x` to `p = (x − c)·v / (s |v|²)`, a
//! fraction of the axis. Let `a = v / (s |v|²)`, and let `d` be `x − c` rounded to single precision. The evaluation
//! needs `u = 1 − p`, computed as `(1 − a_y d_y) − a_x d_x`. Every code path of this crate uses this grouping, so that
//! the bits agree.
//!
//! On a wrapped axis, the periodic images of a control point have weights, too. Each image whose support intersects the
//! domain is an [`Instance`]. Positions are first wrapped into the domain, so a texture repeats exactly.

use crate::bins::Bins;
use crate::support::{fading, has_gap, padded_box};
use crate::{PupsError, PupsErrorKind, PupsOptions};
use dapple_graph::{Graph, IsCancelled, delaunay_cancellable};
use dapple_points::{Domain, PointIdx, PointSet};
use fearless_simd::{f32x8, prelude::*};
use glam::DVec2;
use std::sync::OnceLock;

/// Number of points added to a net between two checks for cancellation.
const POINTS: u32 = 1 << 13;

/// Number of axes in a block. The axes of a block are evaluated together.
pub(crate) const BLOCK: usize = 8;

/// Maximum distance of evaluated positions from the domain, in domain sizes, along an axis that does not wrap.
/// Positions farther away are clamped to it. Beyond this distance, the texture is constant in each direction, as far
/// as single precision can tell.
const FAR: f64 = 1_048_576.0;

/// Maximum extent of a support from its control point along a wrapped axis, in periods.
const IMAGES_LIMIT: f64 = 64.0;

/// Up to eight axes `a = v / (s |v|²)`, with one array per component. Unused slots are zero, which projects every
/// position to 0 and gives the weight 1.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct AxisBlock {
    pub(crate) x: [f32; BLOCK],
    pub(crate) y: [f32; BLOCK],
}

impl AxisBlock {
    /// Returns a bit mask of the slots that hold an axis.
    #[inline(always)]
    pub(crate) fn slots<S: Simd>(&self, simd: S) -> u32 {
        let (x, y) = (
            f32x8::from_slice(simd, &self.x),
            f32x8::from_slice(simd, &self.y),
        );
        let is_used = (x.abs() + y.abs()).simd_gt(f32x8::splat(simd, 0.0));
        // Eight lanes give eight bits.
        is_used.to_bitmask() as u32
    }
}

/// Exponents of the axial weights of a block. They are below 1 for fading axes, which come first in their block.
pub(crate) type Exponents = [f32; BLOCK];

/// A control point or one of its periodic images; fills one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Instance {
    /// Position of the control point or image.
    pub(crate) center: DVec2,
    /// Bounds of the support. A side is infinite where the support is unbounded.
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
    /// Index of the control point.
    pub(crate) point: u32,
    /// Index of the first block of its axes in [`Net::blocks`], and number of blocks.
    first_block: u32,
    n_blocks: u32,
}

/// The kind of graph that a net is built from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum GraphKind {
    /// The Delaunay graph of the points, which needs no additional axes.
    Delaunay,
    /// Any graph. Delaunay axes are added to points whose support is open.
    Any,
}

/// All data that the weights depend on.
#[derive(Debug)]
pub(crate) struct Net {
    pub(crate) domain: Domain,
    pub(crate) options: PupsOptions,
    /// Control points and their images in the order of summation: by point, then by image.
    pub(crate) instances: Vec<Instance>,
    /// Axes of all points, in the order of the points: first the axes that do not fade, then the fading ones, in
    /// separate blocks.
    blocks: Vec<AxisBlock>,
    /// Exponents of each block's axial weights; empty if no axis fades.
    exponents: Vec<Exponents>,
    /// Strength ε times the orientation in the plane of each point; empty without orientations.
    pub(crate) shifts: Vec<[f32; 2]>,
    /// Bins for evaluating single positions, built on first use.
    bins: OnceLock<Bins>,
}

impl Net {
    pub(crate) fn new(
        points: &PointSet,
        graph: &Graph,
        kind: GraphKind,
        options: PupsOptions,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, PupsError> {
        if points.is_empty() {
            return Err(PupsError::new(PupsErrorKind::NoPoints));
        }
        PupsError::check_count("points in the graph", graph.n_points(), points.len())?;
        let mut net = Self::empty(*points.domain(), options, points.len())?;
        // Delaunay graph of the points, triangulated when the first open support needs it.
        let mut closing = None;
        let mut axes = Vec::new();
        for (point, center) in points.iter() {
            if point.0.is_multiple_of(POINTS) {
                PupsError::check_wanted(is_cancelled)?;
            }
            axes.clear();
            axes.extend(graph.axes(point).iter().map(|axis| axis.vector));
            // Add Delaunay axes if the graph may leave the support open.
            if kind == GraphKind::Any && has_gap(&axes) {
                close_gap(point, &mut axes, points, &mut closing, is_cancelled)?;
            }
            net.push(point, center, &axes)?;
        }
        Ok(net)
    }

    /// Creates a net for `n_points` points, which must be added in order.
    fn empty(domain: Domain, options: PupsOptions, n_points: usize) -> Result<Self, PupsError> {
        options.check(n_points)?;
        let size = domain.size;
        let holds = size.min_element() >= 1e-18 && size.max_element() <= 1e18;
        PupsError::check(
            holds,
            "size of the domain",
            size.max_element(),
            "from 1e-18 to 1e18",
        )?;
        Ok(Self {
            domain,
            instances: Vec::with_capacity(n_points + n_points / 4 + 16),
            blocks: Vec::with_capacity(n_points + n_points / 16),
            exponents: Vec::new(),
            shifts: options
                .orientation
                .iter()
                .flat_map(|it| (0..n_points).map(|index| it.shift(index)))
                .collect(),
            options,
            bins: OnceLock::new(),
        })
    }

    /// Adds the next point to the net. `axes` are the vectors of its axes, in order.
    fn push(&mut self, point: PointIdx, center: DVec2, axes: &[DVec2]) -> Result<(), PupsError> {
        let first_block = self.blocks.len();
        self.push_axes(point, axes)?;
        self.push_instances(point, center, axes, first_block);
        Ok(())
    }

    /// Returns the bins, which list the candidates for each part of the domain. Builds them on first use.
    #[inline]
    pub(crate) fn bins(&self) -> &Bins {
        self.bins.get_or_init(|| Bins::new(self))
    }

    /// Returns the blocks of an instance's axes.
    #[inline(always)]
    pub(crate) fn blocks(&self, instance: &Instance) -> &[AxisBlock] {
        &self.blocks[instance.first_block as usize..][..instance.n_blocks as usize]
    }

    /// Returns the exponents of an instance's blocks; empty if no axis of the net fades.
    #[inline(always)]
    pub(crate) fn exponents(&self, instance: &Instance) -> &[Exponents] {
        if self.exponents.is_empty() {
            return &[];
        }
        &self.exponents[instance.first_block as usize..][..instance.n_blocks as usize]
    }

    /// Moves a coordinate into the range of evaluated positions: wraps it into the domain if the axis wraps, otherwise
    /// clamps it. Returns NaN if it is not finite.
    #[inline]
    pub(crate) fn local(&self, axis: usize, coordinate: f64) -> f64 {
        if !coordinate.is_finite() {
            return f64::NAN;
        }
        if self.domain.wrap[axis] {
            return self.domain.wrap_axis(axis, coordinate);
        }
        let (origin, size) = (self.domain.origin[axis], self.domain.size[axis]);
        coordinate.clamp(origin - FAR * size, origin + FAR * size)
    }

    /// Adds the scaled axes of the next point.
    fn push_axes(&mut self, point: PointIdx, axes: &[DVec2]) -> Result<(), PupsError> {
        if self.options.fade == 0.0 {
            return self.push_blocks(point, axes);
        }
        // Separate the axes that fade, and store them in their own blocks.
        let exponents = fading(axes, self.options.fade);
        let of = |is_fading: bool| {
            let all = axes.iter().zip(&exponents);
            all.filter(move |&(_, &exponent)| (exponent < 1.0) == is_fading)
        };
        let (full, fading): (Vec<DVec2>, Vec<DVec2>) = (
            of(false).map(|(&axis, _)| axis).collect(),
            of(true).map(|(&axis, _)| axis).collect(),
        );
        self.push_blocks(point, &full)?;
        // Full axes have the exponent 1.
        self.exponents.resize(self.blocks.len(), [1.0; BLOCK]);
        if !fading.is_empty() {
            self.push_blocks(point, &fading)?;
        }
        // Fill the unused slots of the last fading block with the exponent 1.
        let exponents: Vec<f32> = of(true).map(|(_, &exponent)| exponent).collect();
        for chunk in exponents.chunks(BLOCK) {
            let mut block = [1.0; BLOCK];
            block[..chunk.len()].copy_from_slice(chunk);
            self.exponents.push(block);
        }
        Ok(())
    }

    /// Adds the axes of the next point as blocks; one empty block if there are no axes.
    fn push_blocks(&mut self, point: PointIdx, axes: &[DVec2]) -> Result<(), PupsError> {
        // With this limit, products of axes and positions stay in the range of single precision.
        let limit = self.domain.size.max_element() * 1e-9;
        for chunk in axes.chunks(BLOCK) {
            let mut block = AxisBlock::default();
            for (slot, axis) in chunk.iter().enumerate() {
                let length_sq = axis.length_squared();
                if length_sq < limit * limit {
                    let length = length_sq.sqrt();
                    return Err(PupsError::new(PupsErrorKind::ShortAxis {
                        point: point.0,
                        length,
                        limit,
                    }));
                }
                // Store s⁻¹ v / |v|². Its product with an offset from the point is the projection p.
                let scaled = *axis / (length_sq * self.options.axis_scale);
                block.x[slot] = scaled.x as f32;
                block.y[slot] = scaled.y as f32;
            }
            self.blocks.push(block);
        }
        if axes.is_empty() {
            // A point without axes has the weight 1 everywhere, as an empty block gives it.
            self.blocks.push(AxisBlock::default());
        }
        Ok(())
    }

    /// Adds the periodic images of the next point whose supports intersect the domain.
    fn push_instances(
        &mut self,
        point: PointIdx,
        center: DVec2,
        axes: &[DVec2],
        first_block: usize,
    ) {
        // More than 2^32 blocks of axes do not fit into memory.
        let n_blocks = (self.blocks.len() - first_block) as u32;
        let first_block = first_block as u32;
        // Find the periodic images whose supports, with their margins, intersect the domain.
        let (min, max) = padded_box(axes, self.options.axis_scale);
        let [columns, rows] =
            [0, 1].map(|axis| self.image_range(axis, center[axis], min[axis], max[axis]));
        for row in rows {
            for column in columns.clone() {
                // Shift the point by whole periods. All images share the point's axes.
                let center = center + self.domain.size * DVec2::new(column as f64, row as f64);
                self.instances.push(Instance {
                    center,
                    min: center + min,
                    max: center + max,
                    point: point.0,
                    first_block,
                    n_blocks,
                });
            }
        }
    }

    /// Returns the periodic images of a point whose supports intersect the domain, as a range of offsets in periods
    /// along an axis.
    fn image_range(
        &self,
        axis: usize,
        center: f64,
        min: f64,
        max: f64,
    ) -> core::ops::RangeInclusive<i64> {
        if !self.domain.wrap[axis] {
            return 0..=0;
        }
        let (origin, size) = (self.domain.origin[axis], self.domain.size[axis]);
        // Solve center + k · size + [min, max] for the periods k at which it meets the domain.
        // With an axis to the point's own image, a support is at most two axis scales wide, in periods.
        let first = ((origin - center - max) / size).ceil().max(-IMAGES_LIMIT);
        let last = ((origin + size - center - min) / size)
            .floor()
            .min(IMAGES_LIMIT);
        first as i64..=last as i64
    }
}

/// Adds Delaunay axes to a point whose own axes leave its support open.
///
/// On the hull of points that do not wrap, the support remains open: the point has a weight on an unbounded part of the
/// plane.
fn close_gap(
    point: PointIdx,
    axes: &mut Vec<DVec2>,
    points: &PointSet,
    closing: &mut Option<Graph>,
    is_cancelled: &IsCancelled,
) -> Result<(), PupsError> {
    // Triangulate the points when the first support is open; later ones share the graph.
    let graph = match closing {
        Some(graph) => graph,
        None => {
            let graph = delaunay_cancellable(points, is_cancelled);
            closing.insert(graph.map_err(PupsError::of_part)?)
        }
    };
    for axis in graph.axes(point) {
        if !axes.contains(&axis.vector) {
            axes.push(axis.vector);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::{Pups, PupsOptions};
    use dapple_graph::{EdgeDirection, Graph, gabriel, k_nearest};
    use dapple_hash::Seed;
    use dapple_points::{Domain, PointIdx, white_noise};
    use glam::DVec2;

    #[test]
    fn supports_on_the_torus_are_closed_whatever_the_graph() {
        let points = white_noise(Domain::paper_torus(), 60, Seed(11)).unwrap();
        let alone: Vec<Vec<PointIdx>> = vec![Vec::new(); 60];
        let graphs = [
            k_nearest(&points, 1, EdgeDirection::Directed).unwrap(),
            k_nearest(&points, 3, EdgeDirection::Symmetric).unwrap(),
            gabriel(&points).unwrap(),
            Graph::from_adjacency(&points, &alone).unwrap(),
        ];
        for graph in graphs {
            let pups = Pups::new(&points, &graph, PupsOptions::default()).unwrap();
            let instances = pups.net.instances.iter();
            let widest = instances.map(|instance| instance.max - instance.min);
            assert!(
                widest.fold(DVec2::ZERO, DVec2::max).is_finite(),
                "a support is open"
            );
        }
    }
}
