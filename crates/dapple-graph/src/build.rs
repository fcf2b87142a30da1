//! Builds a graph from the neighbors that each point chooses.

use crate::lattice::Lattice;
use crate::{Axis, Graph, GraphError, GraphErrorKind};
use dapple_points::PointIdx;
use glam::DVec2;

/// Whether the edges that a point chooses lead in one direction or in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum EdgeDirection {
    /// Directed graph: each point has only the axes that it chose.
    #[default]
    Directed,
    /// Undirected graph: each chosen axis also gives its target the opposite axis.
    Symmetric,
}

/// A chosen axis: index of the target point, and the vector from the choosing point to the target's image, in lattice
/// steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Choice {
    pub(crate) to: u32,
    pub(crate) steps: DVec2,
}

/// Builds the graph from the chosen axes. `rows` has the axes of each site, in any order within a row.
pub(crate) fn graph_of(
    lattice: Lattice,
    sites: Vec<DVec2>,
    mut rows: Vec<Vec<Choice>>,
    direction: EdgeDirection,
) -> Result<Graph, GraphError> {
    if direction == EdgeDirection::Symmetric {
        for from in 0..rows.len() {
            for index in 0..rows[from].len() {
                let Choice { to, steps } = rows[from][index];
                let back = Choice {
                    to: from as u32,
                    steps: -steps,
                };
                let row = &mut rows[to as usize];
                if !row.contains(&back) {
                    row.push(back);
                }
            }
        }
    }
    let n_axes: usize = rows.iter().map(Vec::len).sum();
    if u32::try_from(n_axes).is_err() {
        return Err(GraphError::new(GraphErrorKind::TooManyAxes { n_axes }));
    }
    let mut offsets = Vec::with_capacity(rows.len() + 1);
    offsets.push(0);
    let mut axes = Vec::with_capacity(n_axes);
    for row in rows {
        let start = axes.len();
        axes.extend(row.into_iter().map(|choice| Axis {
            to: PointIdx(choice.to),
            vector: lattice.vector(choice.steps),
        }));
        axes[start..].sort_unstable_by(Axis::order);
        offsets.push(axes.len() as u32);
    }
    let mut graph = Graph {
        lattice,
        sites,
        offsets,
        axes,
        symmetric: true,
        delaunay: false,
    };
    graph.symmetric = direction == EdgeDirection::Symmetric || graph.every_axis_has_its_opposite();
    Ok(graph)
}
