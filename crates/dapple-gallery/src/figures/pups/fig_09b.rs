//! Cells made of a few points per cell: three or four that the graph connects.

use super::picture_of_labels;
use crate::draw::label_gray;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CellsOptions, cells, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "9b",
    parameters: &[
        ("minimum distance", "0.1"),
        ("points per cell", "3 or 4"),
        ("orientations", "random"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let texture = cells(&CellsOptions::of_three_or_four(), Seed(9))?;
    let shades = (0..).take(texture.values().len()).map(label_gray);
    let texture = texture.with_values(shades.collect())?;
    Ok(vec![picture_of_labels("", &texture, size)?])
}
