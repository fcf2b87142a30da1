//! A control point whose weight is drawn, for the figures about equations 1, 2 and 4.

use dapple_graph::{Graph, delaunay};
use dapple_points::{Domain, PointIdx, PointSet, poisson_disk};
use dapple_pups::{Pups, PupsError, PupsOptions, hash::Seed};
use dapple_raster::{RasterError, Window};
use glam::DVec2;

/// A point set, the index of the point nearest to its center, and the axes of that point.
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

    /// Returns a square window around the point, large enough for its axes.
    pub(super) fn window(&self, size: u32) -> Result<Window, RasterError> {
        let center = self.points.position(self.center);
        let axes = self.graph.axes(self.center).iter();
        let longest = axes.map(|axis| axis.vector.length()).fold(0.0, f64::max);
        let half = DVec2::splat(1.1 * longest);
        Window::new(center - half, 2.0 * half, [size; 2])
    }

    /// Builds the partition-of-unity parametrics of all points, whose weights are drawn.
    pub(super) fn pups(&self, options: PupsOptions) -> Result<Pups, PupsError> {
        Pups::new(&self.points, &self.graph, options)
    }
}
