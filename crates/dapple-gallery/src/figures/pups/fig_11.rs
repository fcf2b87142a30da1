//! Two “cow texture” examples: Poisson disc distribution of control points with random assignment of binary labels.

use super::picture_of_labels;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CowOptions, cow, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "11",
    parameters: &[
        ("minimum distance", "0.1"),
        ("labels", "random, black or white"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let texture = |seed| cow(&CowOptions::default(), seed);
    Ok(vec![
        picture_of_labels("first", &texture(Seed(11))?, size)?,
        picture_of_labels("second", &texture(Seed(111))?, size)?,
    ])
}
