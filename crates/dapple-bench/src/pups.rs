//! The pups group: rasters and single positions of a scalar texture on the unit torus.
//!
//! An image has 1000×1000 pixels of the unit square, in preallocated memory. Setup (points, graph, net; the
//! triangulation of the peer) is not timed, except in the row of the whole chain. Confirmed: every pixel of a peer has
//! a value, and ours equals the naive evaluation of the paper's formulas up to the rounding of `f32`. The naive
//! evaluation is itself a peer. It runs on some rows of the image, since a whole image would take seconds.

mod alone;
#[cfg(feature = "peers")]
mod beside_spade;

use crate::harness::Bench;
use crate::naive::Naive;
use crate::sets;
use anyhow::{Result, ensure};
use dapple_graph::{Graph, delaunay};
use dapple_points::PointSet;
use dapple_pups::{Pups, PupsOptions, Texture};
use dapple_raster::{Raster, Window};

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    beside_spade::run(bench)?;
    alone::run(bench)
}

/// Width and height of the images in pixels.
const SIDE: u32 = 1000;

/// A texture with about the requested number of control points, and the point set and graph that it is built from.
struct Scene {
    points: PointSet,
    graph: Graph,
    values: Vec<f32>,
    texture: Texture,
}

impl Scene {
    /// Creates about `n_points` maximal Poisson-disk points with values on the unit torus.
    fn new(n_points: u32) -> Result<Self> {
        let points = sets::poisson_disk(n_points)?;
        let graph = delaunay(&points)?;
        let values = sets::values(points.len());
        let texture =
            Pups::new(&points, &graph, PupsOptions::default())?.texture(values.clone())?;
        Ok(Self {
            points,
            graph,
            values,
            texture,
        })
    }

    /// Builds the naive evaluation of the same texture.
    fn naive(&self) -> Naive {
        let mut naive = Naive::default();
        for ((point, center), &value) in self.points.iter().zip(&self.values) {
            let axes = self
                .graph
                .axes(point)
                .iter()
                .map(|axis| axis.vector.to_array());
            naive.push(center.to_array(), value, axes);
        }
        naive
    }

    /// Checks some rows of an image of the unit square against the naive evaluation.
    fn confirm(&self, image: &Raster<f32>) -> Result<()> {
        let naive = self.naive();
        let [width, height] = image.size();
        let mut expected = vec![0.0; width as usize];
        for row in [0, height / 3, height - 1] {
            naive.row((f64::from(row) + 0.5) / f64::from(height), &mut expected);
            self.confirm_values(image.row(row), &expected)?;
        }
        Ok(())
    }

    /// Checks that values equal the naive evaluation up to [`tolerance`](Self::tolerance).
    fn confirm_values(&self, found: &[f32], expected: &[f32]) -> Result<()> {
        let tolerance = self.tolerance();
        for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
            // Written so that a NaN difference fails, too.
            let near = (found - expected).abs() <= tolerance;
            ensure!(
                near,
                "value {index} is {found}, and {expected} by the formulas, up to {tolerance}"
            );
        }
        Ok(())
    }

    /// Returns the maximum difference between two `f32` evaluations of the same formulas.
    ///
    /// About 25 products and sums of numbers up to 1 lose up to 6e-8 each, partly canceling: 5e-7. The naive
    /// evaluation rounds offsets in the unit torus by up to 1.2e-7. That changes the weight of each of about four
    /// supports by at most the steepest slope of equation 1, which is 1.5 over an axis no shorter than the radius.
    fn tolerance(&self) -> f32 {
        let radius = sets::radius_of(self.points.len() as u32) as f32;
        5e-7 + 4.0 * 1.2e-7 * 1.5 / radius
    }
}

/// Returns the window of a `side`×`side` image of the unit square.
fn window(side: u32) -> Result<Window> {
    Ok(Window::unit([side, side])?)
}

/// Returns a black `side`×`side` image.
fn image(side: u32) -> Result<Raster<f32>> {
    Ok(Raster::filled([side, side], 0.0)?)
}
