//! F1 and F2 − F1 with four distance metrics. Figure 3 uses the Manhattan metric.

use super::N_POSITIONS;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_raster::{Field, Window};
use dapple_worley::{Combination, Metric, Worley2, hash::Seed};
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("cells across each", "4"),
        ("gray", "the measured range of each function"),
    ],
    source: source!(),
    render,
};

const METRICS: [(&str, Metric); 4] = [
    ("Euclidean", Metric::Euclidean),
    ("Manhattan", Metric::Manhattan),
    ("Chebyshev", Metric::Chebyshev),
    ("Minkowski, p = 4", Metric::Minkowski(4.0)),
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let window = Window::new(DVec2::ZERO, DVec2::splat(4.0), [size; 2])?;
    let mut panels = Vec::new();
    for (name, combination) in [
        ("F1", Combination::F1),
        ("F2 − F1", Combination::F2_MINUS_F1),
    ] {
        for (metric_name, metric) in METRICS {
            let worley = Worley2::new(Seed(3)).with_metric(metric)?;
            let texture = worley.combine(combination);
            let range = texture.measure_range(Seed(1), N_POSITIONS)?;
            let raster = texture.with_range(range)?.to_raster(&window)?;
            panels.push(Panel::gray(format!("{name}, {metric_name}"), raster));
        }
    }
    Ok(panels)
}
