//! Noises with cells: four layers of cells of increasing density, summed.

use super::picture_of_labels;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CellularNoiseOptions, Spacing, cellular_noise, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "10",
    parameters: &[
        ("layers", "4"),
        (
            "minimum distance",
            "0.4 · 2^−i (first), 0.2 · 2^−i (second)",
        ),
        ("amplitude", "2^−i"),
        ("points per cell", "1 (first), 3 or 4 (second)"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let single = CellularNoiseOptions::default();
    let grouped = CellularNoiseOptions {
        spacing: Spacing::from(0.2),
        points_per_cell: [3, 4],
        ..CellularNoiseOptions::default()
    };
    let noise = |options, seed| cellular_noise(options, seed);
    Ok(vec![
        picture_of_labels("first", &noise(&single, Seed(10))?.normalized(), size)?,
        picture_of_labels("second", &noise(&grouped, Seed(100))?.normalized(), size)?,
    ])
}
