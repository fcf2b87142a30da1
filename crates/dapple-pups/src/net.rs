//! The control net: control points with their axes, made ready for evaluation.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013, section 2.
//!
//! An axis `v` of a control point `c`, scaled by `s`, projects a position `x` to `p = (x − c)·v / (s |v|²)`. With
//! `a = v / (s |v|²)` and `d = (x − c)` rounded to single precision, what the evaluation needs is `u = 1 − p`, computed
//! as `(1 − a_y d_y) − a_x d_x`: that grouping is the frame rule of this crate, and every path keeps it.
//!
//! On a wrapped axis a control point acts through its periodic images as well. Each image whose support reaches into
//! the domain is an [`Instance`]; positions are brought into the domain first, so that a texture repeats exactly.

use crate::bins::Bins;
use crate::support::{fading, has_gap, padded_box};
use crate::{PupsError, PupsErrorKind, PupsOptions};
use dapple_graph::{Graph, IsCancelled, delaunay_cancellable};
use dapple_points::{Domain, PointIdx, PointSet};
use fearless_simd::{f32x8, prelude::*};
use glam::DVec2;
use std::sync::OnceLock;

/// The number of points that are added to a net before it is asked again whether it is still wanted.
const POINTS: u32 = 1 << 13;

/// How many axes are evaluated together.
pub(crate) const BLOCK: usize = 8;

/// On an axis that does not wrap, positions further out than this many domain sizes are evaluated at this distance,
/// where the texture has long become constant along every ray that single precision can tell.
const FAR: f64 = 1_048_576.0;

/// No support reaches further than this many periods.
const IMAGES_LIMIT: f64 = 64.0;

/// Eight axes side by side; unused ones are zero, which projects every position to 0 and so weighs 1.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct AxisBlock {
    pub(crate) x: [f32; BLOCK],
    pub(crate) y: [f32; BLOCK],
}

impl AxisBlock {
    /// The slots that hold an axis, as bits.
    #[inline(always)]
    pub(crate) fn slots<S: Simd>(&self, simd: S) -> u32 {
        let (x, y) = (
            f32x8::from_slice(simd, &self.x),
            f32x8::from_slice(simd, &self.y),
        );
        let is_used = (x.abs() + y.abs()).simd_gt(f32x8::splat(simd, 0.0));
        // Eight lanes, eight bits.
        is_used.to_bitmask() as u32
    }
}

/// Exponents of the axial weights of a block: below 1 for axes that fade, which a block has first or not at all.
pub(crate) type Exponents = [f32; BLOCK];

/// A control point, or one of its periodic images; one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Instance {
    /// Where it is.
    pub(crate) center: DVec2,
    /// The smallest box around its support; infinite where the support is.
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
    /// The control point.
    pub(crate) point: u32,
    /// Its axes: the first block, and how many.
    first_block: u32,
    n_blocks: u32,
}

/// The graph that a net is made of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum GraphKind {
    /// It is the Delaunay graph of the points, so there are no axes that could close a support.
    Delaunay,
    /// It may be any graph.
    Any,
}

/// Everything that the weights depend on.
#[derive(Debug)]
pub(crate) struct Net {
    pub(crate) domain: Domain,
    pub(crate) options: PupsOptions,
    /// Control points and their images, in the order in which weights are summed: by point, then by image.
    pub(crate) instances: Vec<Instance>,
    /// The axes of all points, point by point: first those that do not fade, then, in blocks of their own, those that do.
    blocks: Vec<AxisBlock>,
    /// The exponents of the axial weights of each block; empty where no axis fades.
    exponents: Vec<Exponents>,
    /// ε times the orientation in the plane, for each point; empty without orientations.
    pub(crate) shifts: Vec<[f32; 2]>,
    /// For single positions; made when the first is asked for.
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
        let mut closing = None;
        let mut axes = Vec::new();
        for (point, center) in points.iter() {
            if point.0.is_multiple_of(POINTS) {
                PupsError::check_wanted(is_cancelled)?;
            }
            axes.clear();
            axes.extend(graph.axes(point).iter().map(|axis| axis.vector));
            if kind == GraphKind::Any && has_gap(&axes) {
                close_gap(point, &mut axes, points, &mut closing, is_cancelled)?;
            }
            net.push(point, center, &axes)?;
        }
        Ok(net)
    }

    /// The net of `n_points` points, to which they are to be added in their order.
    pub(crate) fn empty(
        domain: Domain,
        options: PupsOptions,
        n_points: usize,
    ) -> Result<Self, PupsError> {
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

    /// Adds the next point, given the vectors of its axes in their order.
    pub(crate) fn push(
        &mut self,
        point: PointIdx,
        center: DVec2,
        axes: &[DVec2],
    ) -> Result<(), PupsError> {
        let first_block = self.blocks.len();
        self.push_axes(point, axes)?;
        self.push_instances(point, center, axes, first_block);
        Ok(())
    }

    /// Which control points can have a weight where.
    #[inline]
    pub(crate) fn bins(&self) -> &Bins {
        self.bins.get_or_init(|| Bins::new(self))
    }

    /// The axes of a control point.
    #[inline(always)]
    pub(crate) fn blocks(&self, instance: &Instance) -> &[AxisBlock] {
        &self.blocks[instance.first_block as usize..][..instance.n_blocks as usize]
    }

    /// The exponents of the blocks of a control point; none where no axis of the net fades.
    #[inline(always)]
    pub(crate) fn exponents(&self, instance: &Instance) -> &[Exponents] {
        if self.exponents.is_empty() {
            return &[];
        }
        &self.exponents[instance.first_block as usize..][..instance.n_blocks as usize]
    }

    /// A coordinate along `axis` as the evaluation takes it: in the domain where it wraps, and not too far out where it
    /// does not. What is not finite stays so.
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

    /// Adds the axes of the next point, scaled.
    fn push_axes(&mut self, point: PointIdx, axes: &[DVec2]) -> Result<(), PupsError> {
        if self.options.fade == 0.0 {
            return self.push_blocks(point, axes);
        }
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
        self.exponents.resize(self.blocks.len(), [1.0; BLOCK]);
        if !fading.is_empty() {
            self.push_blocks(point, &fading)?;
        }
        let exponents: Vec<f32> = of(true).map(|(_, &exponent)| exponent).collect();
        for chunk in exponents.chunks(BLOCK) {
            let mut block = [1.0; BLOCK];
            block[..chunk.len()].copy_from_slice(chunk);
            self.exponents.push(block);
        }
        Ok(())
    }

    /// Adds blocks of axes of the next point, scaled; one without axes if there are none.
    fn push_blocks(&mut self, point: PointIdx, axes: &[DVec2]) -> Result<(), PupsError> {
        // With this limit, no product of an axis and a position leaves the range of single precision.
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
                let scaled = *axis / (length_sq * self.options.axis_scale);
                block.x[slot] = scaled.x as f32;
                block.y[slot] = scaled.y as f32;
            }
            self.blocks.push(block);
        }
        if axes.is_empty() {
            // A point by itself rules everywhere; its block weighs 1.
            self.blocks.push(AxisBlock::default());
        }
        Ok(())
    }

    /// Adds the images of the next point whose supports reach into the domain.
    fn push_instances(
        &mut self,
        point: PointIdx,
        center: DVec2,
        axes: &[DVec2],
        first_block: usize,
    ) {
        // A graph whose axes do not fit into 2^32 blocks does not fit into memory.
        let n_blocks = (self.blocks.len() - first_block) as u32;
        let first_block = first_block as u32;
        let (min, max) = padded_box(axes, self.options.axis_scale);
        let [columns, rows] =
            [0, 1].map(|axis| self.image_range(axis, center[axis], min[axis], max[axis]));
        for row in rows {
            for column in columns.clone() {
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

    /// The periods by which a support can be moved and still reach into the domain.
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
        // A support with an axis to the point's own image is at most two axis scales wide, in periods.
        let first = ((origin - center - max) / size).ceil().max(-IMAGES_LIMIT);
        let last = ((origin + size - center - min) / size)
            .floor()
            .min(IMAGES_LIMIT);
        first as i64..=last as i64
    }
}

/// Adds the Delaunay axes of a point whose own axes leave its support open.
///
/// On the hull of points that do not wrap, the Delaunay axes leave it open too; there it stays so, and the point rules
/// as far as the plane goes.
fn close_gap(
    point: PointIdx,
    axes: &mut Vec<DVec2>,
    points: &PointSet,
    closing: &mut Option<Graph>,
    is_cancelled: &IsCancelled,
) -> Result<(), PupsError> {
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
