//! Assigns colors and shades to labels.

use dapple_color::LinearRgb;
use dapple_graph::Graph;
use dapple_points::PointIdx;
use std::collections::BTreeSet;

/// Returns a fixed color for a label. Consecutive labels get very different colors.
#[must_use]
pub fn label_color(label: u32) -> LinearRgb {
    // Steps of the golden section around the color wheel keep hues apart for any number of labels.
    let hue = fraction(f64::from(label) * 0.618_033_988_749_895) as f32 * 6.0;
    let value = [0.95, 0.70, 0.85][label as usize % 3];
    let channel = |shift: f32| {
        let along = (hue + shift) % 6.0;
        let strength = ((along - 3.0).abs() - 1.0).clamp(0.0, 1.0);
        let display = value * (0.42 + 0.58 * strength);
        display * display
    };
    LinearRgb::new(channel(0.0), channel(4.0), channel(2.0))
}

/// Returns a shade of gray for a label, from 0.25 to 1.
#[must_use]
pub fn label_gray(label: u32) -> f32 {
    let spread = fraction(f64::from(label) * 0.618_033_988_749_895);
    0.25 + 0.75 * spread as f32
}

/// Returns a shade of gray, from 0.25 to 1, for each label of the points of a graph. Two labels connected by an edge
/// get different shades out of six, so that they are easy to distinguish.
///
/// Labels are consecutive numbers from 0. The next label to be shaded is always the one whose neighbors have the most
/// distinct shades. It gets the shade that differs most from theirs. (D. Brélaz, "New methods to color the vertices
/// of a graph", 1979, `doi:10.1145/359094.359101`.)
#[must_use]
pub fn graph_grays(graph: &Graph, labels: &[u32]) -> Vec<f32> {
    let neighbors = neighbors(graph, labels);
    let mut taken = vec![None; neighbors.len()];
    for _ in 0..neighbors.len() {
        let seen = |label: usize| -> BTreeSet<u32> {
            neighbors[label]
                .iter()
                .filter_map(|&other| taken[other])
                .collect()
        };
        let free = (0..neighbors.len())
            .rev()
            .filter(|&label| taken[label].is_none());
        let Some(next) = free.max_by_key(|&label| (seen(label).len(), neighbors[label].len()))
        else {
            break;
        };
        let around = seen(next);
        let contrast = |shade: u32| around.iter().map(|other| other.abs_diff(shade)).min();
        // If no neighbor has a shade, any shade is possible.
        let candidates = (0..SHADES).map(|turn| (turn + next as u32 * 5) % SHADES);
        taken[next] = candidates.max_by_key(|&shade| contrast(shade).unwrap_or(SHADES));
    }
    let step = 0.75 / (SHADES - 1) as f32;
    taken
        .iter()
        .map(|shade| 0.25 + step * shade.unwrap_or(0) as f32)
        .collect()
}

/// Number of shades for a planar graph. Four are enough for every such graph, but this method needs up to six.
const SHADES: u32 = 6;

/// Returns, for each label, the set of labels connected to it by an edge.
fn neighbors(graph: &Graph, labels: &[u32]) -> Vec<BTreeSet<usize>> {
    let n_labels = labels.iter().max().map_or(0, |&label| label as usize + 1);
    let mut neighbors = vec![BTreeSet::new(); n_labels];
    for (point, &label) in (0..).map(PointIdx).zip(labels) {
        let others = graph.axes(point).iter().map(|axis| labels[axis.to.index()]);
        neighbors[label as usize].extend(
            others
                .filter(|&other| other != label)
                .map(|other| other as usize),
        );
    }
    neighbors
}

fn fraction(value: f64) -> f64 {
    value - value.floor()
}

#[cfg(test)]
mod tests {
    use super::{graph_grays, label_color, label_gray};
    use dapple_graph::delaunay;
    use dapple_points::{Domain, PointIdx, hash::Seed, poisson_disk};
    use dapple_pups::{grouped_labels, own_labels};

    #[test]
    fn neighboring_labels_differ_visibly() {
        for label in 0..1000 {
            let [a, b] = [label, label + 1].map(label_color);
            assert!(
                (a - b).to_array().iter().any(|gap| gap.abs() > 0.1),
                "colors of {label}"
            );
            let gap = (label_gray(label) - label_gray(label + 1)).abs();
            assert!(gap > 0.2, "grays of {label}");
        }
    }

    #[test]
    fn cells_that_meet_differ_visibly() {
        let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(1)).unwrap();
        let graph = delaunay(&points).unwrap();
        let groups = grouped_labels(&graph, [3, 4], Seed(9)).unwrap();
        for labels in [own_labels(points.len()), groups] {
            let grays = graph_grays(&graph, &labels);
            let gray = |point: PointIdx| grays[labels[point.index()] as usize];
            for point in (0..graph.n_points() as u32).map(PointIdx) {
                for axis in graph.axes(point) {
                    let apart = labels[point.index()] != labels[axis.to.index()];
                    let gap = (gray(point) - gray(axis.to)).abs();
                    assert!(
                        !apart || gap > 0.14,
                        "{point:?} and {:?} differ by {gap}",
                        axis.to
                    );
                }
            }
        }
    }
}
