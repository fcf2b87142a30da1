//! Renders the rows of images for the documentation of `dapple-graph`.

use super::picture::{BANNER, GRAYS, LARGE, banner_of, shaded};
use super::{Documented, Strip};
use crate::Panel;
use crate::draw::Canvas;
use dapple_graph::{EdgeDirection, Graph, delaunay, gabriel, k_nearest, yao};
use dapple_points::{Domain, PointSet, hash::Seed, poisson_disk};
use dapple_raster::Window;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-graph",
    strips: &[DELAUNAY, GABRIEL, YAO, K_NEAREST],
    banner: || {
        let points = points()?;
        banner_of(&[
            edges("", &points, &delaunay(&points)?, BANNER)?,
            edges("", &points, &gabriel(&points)?, BANNER)?,
            edges(
                "",
                &points,
                &yao(&points, 6, EdgeDirection::Directed)?,
                BANNER,
            )?,
            edges(
                "",
                &points,
                &k_nearest(&points, 2, EdgeDirection::Directed)?,
                BANNER,
            )?,
        ])
    },
};

const DELAUNAY: Strip = Strip {
    name: "delaunay",
    caption: "The same points",
    render: || {
        let torus = points()?;
        let plane = PointSet::new(
            Domain {
                wrap: [false; 2],
                ..*torus.domain()
            },
            torus.positions().to_vec(),
        )?;
        Ok(vec![
            edges("on a torus", &torus, &delaunay(&torus)?, LARGE)?,
            edges("in the plane", &plane, &delaunay(&plane)?, LARGE)?,
        ])
    },
};

const GABRIEL: Strip = Strip {
    name: "gabriel",
    caption: "",
    render: || {
        let points = points()?;
        let graph = gabriel(&points)?;
        Ok(vec![edges("on a torus", &points, &graph, LARGE)?])
    },
};

const YAO: Strip = Strip {
    name: "yao",
    caption: "On a torus",
    render: || {
        let points = points()?;
        [("4 cones", 4), ("8 cones", 8)]
            .into_iter()
            .map(|(label, cones)| {
                let graph = yao(&points, cones, EdgeDirection::Directed)?;
                edges(label, &points, &graph, LARGE)
            })
            .collect()
    },
};

const K_NEAREST: Strip = Strip {
    name: "k-nearest",
    caption: "On a torus",
    render: || {
        let points = points()?;
        [("1 neighbor", 1), ("4 neighbors", 4)]
            .into_iter()
            .map(|(label, k)| {
                let graph = k_nearest(&points, k, EdgeDirection::Directed)?;
                edges(label, &points, &graph, LARGE)
            })
            .collect()
    },
};

fn points() -> anyhow::Result<PointSet> {
    Ok(poisson_disk(Domain::paper_torus(), 0.26, Seed(3))?)
}

/// Draws the edges and points of a graph within its square domain.
fn edges(label: &str, points: &PointSet, graph: &Graph, side: u32) -> anyhow::Result<Panel> {
    let domain = points.domain();
    let window = Window::new(domain.origin, domain.size, [side; 2])?;
    let mut canvas = Canvas::new(&window, 1.0)?;
    canvas.graph(points, graph, 1.0, 0.4);
    canvas.points(points, 2.2, 0.0);
    Ok(shaded(label, &canvas.into_raster(), GRAYS))
}
