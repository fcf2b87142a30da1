//! The basis functions as gray gradients: F1 at the upper left, F2 and F3 at the upper right and lower left, and F2 −
//! F1 at the lower right.
//!
//! All four are slices through the same scatter of feature points in space.

use super::slice;
use crate::draw::sheet;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_worley::{Combination, Worley3, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "1",
    parameters: &[
        ("cells across each", "4"),
        ("density", "3 points per cell"),
        ("gray", "the measured range of each function"),
    ],
    source: source!(),
    render,
};

const BASES: [Combination; 4] = [
    Combination::F1,
    Combination::F2,
    Combination::F3,
    Combination::F2_MINUS_F1,
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let worley = Worley3::new(Seed(1996));
    let bases = sheet([size; 2], [2, 2], size / 64, 1.0, |number, size| {
        slice(worley.combine(BASES[number as usize]), 4.0, size)
    })?;
    Ok(vec![Panel::gray("", bases)])
}
