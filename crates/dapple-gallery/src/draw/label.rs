//! Colors and shades for labels.

use dapple_color::LinearRgb;
use dapple_graph::Graph;
use dapple_points::PointIdx;

/// A color for a label: neighboring labels get colors far apart, and a label has the same color everywhere.
#[must_use]
pub fn label_color(label: u32) -> LinearRgb {
    // Hues that are a golden section of the circle apart stay far apart, however many there are.
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

/// A shade of gray for a label, from 0.25 to 1.
#[must_use]
pub fn label_gray(label: u32) -> f32 {
    let spread = fraction(f64::from(label) * 0.618_033_988_749_895);
    0.25 + 0.75 * spread as f32
}

/// A shade of gray, from 0.25 to 1, for each point of a graph, so that neighbors are easy to tell apart.
///
/// Each point takes the one of eight shades that differs most from those of its neighbors that have one already.
#[must_use]
pub fn graph_grays(graph: &Graph) -> Vec<f32> {
    let mut shades: Vec<f32> = Vec::new();
    for point in (0..graph.n_points() as u32).map(PointIdx) {
        let axes = graph.axes(point).iter();
        let taken: Vec<f32> = axes
            .filter_map(|axis| shades.get(axis.to.index()).copied())
            .collect();
        let contrast = |shade: f32| {
            let gaps = taken.iter().map(|other| (other - shade).abs());
            gaps.fold(f32::INFINITY, f32::min)
        };
        let candidates = (0..8).map(|turn| label_gray(point.0 * 8 + turn));
        let best = candidates.max_by(|a, b| contrast(*a).total_cmp(&contrast(*b)));
        shades.push(best.unwrap_or_default());
    }
    shades
}

fn fraction(value: f64) -> f64 {
    value - value.floor()
}

#[cfg(test)]
mod tests {
    use super::{graph_grays, label_color, label_gray};
    use dapple_graph::delaunay;
    use dapple_points::{Domain, PointIdx, hash::Seed, poisson_disk};

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
    fn neighbors_in_a_graph_differ_visibly() {
        let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(1)).unwrap();
        let graph = delaunay(&points).unwrap();
        let grays = graph_grays(&graph);
        for point in (0..graph.n_points() as u32).map(PointIdx) {
            for axis in graph.axes(point) {
                let gap = (grays[point.index()] - grays[axis.to.index()]).abs();
                assert!(gap > 0.01, "{point:?} and {:?} differ by {gap}", axis.to);
            }
        }
    }
}
