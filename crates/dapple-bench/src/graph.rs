//! The graph group: our periodic Delaunay graph compared with the bounded triangulation of `spade` for the same
//! points.
//!
//! Our side starts from a point set and ends with the axes of every point in compressed rows. `spade` starts from a
//! list of positions, which it takes ownership of. The results of both are freed outside the timed section.
//! Confirmed: every point is a vertex, and each point has exactly six axes on average, as in every periodic
//! triangulation of a torus.

use crate::harness::Bench;
use anyhow::Result;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    beside_spade::run(bench)?;
    #[cfg(not(feature = "peers"))]
    let _ = bench;
    Ok(())
}

/// Rows that compare with `spade`.
#[cfg(feature = "peers")]
mod beside_spade {
    use crate::harness::{Bench, Done, Side};
    use crate::row::{Case, Goal, Unit};
    use crate::{peers, sets};
    use anyhow::{Result, ensure};
    use dapple_graph::points::{Domain, PointSet};
    use dapple_graph::{Graph, delaunay};

    const PERIODIC_700: Case = Case {
        group: "graph",
        case: "periodic Delaunay, 700 points",
        peer: "spade bulk_load, not periodic",
        unit: Unit::NsPerPoint,
        must: Goal::CostAtMost(1.4),
        note: "",
    };

    const PERIODIC_1M: Case = Case {
        case: "periodic Delaunay, 1 M points",
        must: Goal::CostAtMost(1.5),
        ..PERIODIC_700
    };

    const PLANE_40K: Case = Case {
        case: "Delaunay of points that do not wrap, 40 k points",
        peer: "spade bulk_load",
        must: Goal::CostAtMost(1.7),
        ..PERIODIC_700
    };

    const PLANE_1M: Case = Case {
        case: "Delaunay of points that do not wrap, 1 M points",
        must: Goal::CostAtMost(1.5),
        ..PLANE_40K
    };

    pub(super) fn run(bench: &mut Bench) -> Result<()> {
        row(bench, &PERIODIC_700, 700, 300)?;
        row(bench, &PERIODIC_1M, 1_000_000, 11)?;
        row(bench, &PLANE_40K, 40_000, 41)?;
        row(bench, &PLANE_1M, 1_000_000, 11)
    }

    fn row(bench: &mut Bench, case: &Case, n_points: u32, turns: u32) -> Result<()> {
        if !bench.wants(case) {
            return Ok(());
        }
        let wraps = case.case.starts_with("periodic");
        let mut points = sets::poisson_disk(n_points)?;
        if !wraps {
            let domain = Domain {
                wrap: [false; 2],
                ..*points.domain()
            };
            points = PointSet::new(domain, points.positions().to_vec())?;
        }
        let positions = peers::spade_positions(points.positions());
        let ours = Side::new(None, |out: &mut Option<Result<Graph, _>>| {
            *out = Some(delaunay(&points));
        })
        .prepared(|out| *out = None);
        let theirs = Side::new((Vec::new(), None), |(input, out)| {
            *out = Some(peers::spade_bulk_load(std::mem::take(input)));
        })
        .prepared(|(input, out)| {
            *out = None;
            input.clone_from(&positions);
        });
        bench.beside(case, turns, ours, theirs, |graph, (_, triangulation)| {
            let graph = graph
                .as_ref()
                .expect("a side ran")
                .as_ref()
                .map_err(Clone::clone)?;
            let n_vertices = triangulation.as_ref().map_or(0, peers::n_vertices);
            ensure!(
                graph.n_points() == points.len(),
                "{} points in the graph",
                graph.n_points()
            );
            ensure!(
                n_vertices == points.len(),
                "{n_vertices} vertices in the triangulation"
            );
            // Without wrapping, points on the border have fewer.
            let n_axes = 6 * points.len();
            let least = if wraps { n_axes } else { n_axes - n_axes / 100 };
            ensure!(
                (least..=n_axes).contains(&graph.n_axes()),
                "{} axes, not six for each point",
                graph.n_axes()
            );
            Ok(Done::both(points.len()))
        })
    }
}
