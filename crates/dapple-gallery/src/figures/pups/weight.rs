//! The weight of one control point, written out as the paper has it: equations 1, 2 and 4.
//!
//! [`dapple_pups::Pups`] computes the same, faster, and gives it divided by the sum of all weights.

use dapple_graph::{Graph, delaunay};
use dapple_points::{Domain, PointIdx, PointSet, poisson_disk};
use dapple_pups::{AxialWeight, hash::Seed};
use dapple_raster::{RasterError, Window};
use glam::{DVec2, DVec3};

/// Points with the axes of one of them, the one nearest to the middle.
pub(super) struct Star {
    pub(super) points: PointSet,
    pub(super) graph: Graph,
    pub(super) center: PointIdx,
}

impl Star {
    pub(super) fn new() -> anyhow::Result<Self> {
        let points = poisson_disk(Domain::paper_torus(), 0.35, Seed(5))?;
        let graph = delaunay(&points)?;
        let distances = points.iter().map(|(point, at)| (at.length(), point));
        let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        let (_, center) = nearest.unwrap_or_default();
        Ok(Self {
            points,
            graph,
            center,
        })
    }

    /// The square about the point that its axes fit into.
    pub(super) fn window(&self, size: u32) -> Result<Window, RasterError> {
        let center = self.points.position(self.center);
        let axes = self.graph.axes(self.center).iter();
        let longest = axes.map(|axis| axis.vector.length()).fold(0.0, f64::max);
        let half = DVec2::splat(1.1 * longest);
        Window::new(center - half, 2.0 * half, [size; 2])
    }

    /// Equation 2: the product of the axial weights, each that of the projection onto an axis.
    pub(super) fn weight(&self, position: DVec2) -> f32 {
        let offset = position - self.points.position(self.center);
        let axes = self.graph.axes(self.center).iter();
        axes.map(|axis| offset.dot(axis.vector) / axis.vector.length_squared())
            .map(|projection| AxialWeight::Cubic.at(projection as f32))
            .product()
    }

    /// Equation 4: the weight, shifted towards an orientation (of length 1) with strength ε.
    pub(super) fn shifted_weight(&self, position: DVec2, orientation: DVec3, strength: f64) -> f32 {
        let offset = position - self.points.position(self.center);
        let k = strength * offset.normalize_or_zero().dot(orientation.truncate());
        let exponent = if k >= 0.0 { 1.0 - k } else { 1.0 / (1.0 + k) };
        libm::pow(f64::from(self.weight(position)), exponent) as f32
    }
}
