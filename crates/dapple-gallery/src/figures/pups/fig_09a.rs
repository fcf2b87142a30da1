//! Cells made of one point per cell, with random orientations.

use super::picture_of_labels;
use crate::draw::label_gray;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CellsOptions, Spacing, cells, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "9a",
    parameters: &[
        ("minimum distance", "0.2"),
        ("orientations", "random"),
        ("ε", "0.5"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let options = CellsOptions {
        spacing: Spacing::from(0.2),
        ..CellsOptions::default()
    };
    let texture = cells(&options, Seed(9))?;
    let shades = (0..).take(texture.values().len()).map(label_gray);
    let texture = texture.with_values(shades.collect())?;
    Ok(vec![picture_of_labels("", &texture, size)?])
}
