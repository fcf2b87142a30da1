//! Progressive textures: cows whose control points are closer together toward the right.
//!
//! The points are on a cylinder, so the texture repeats from top to bottom, but not from left to right.

use super::picture_of_labels;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{ProgressionOptions, cow_progression, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "15",
    parameters: &[
        ("minimum distance", "0.2 to 0.025, in equal ratios"),
        ("labels", "random, black or white"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let texture = |seed| cow_progression(&ProgressionOptions::default(), seed);
    Ok(vec![
        picture_of_labels("first", &texture(Seed(15))?, size)?.repeating_along([false, true]),
        picture_of_labels("second", &texture(Seed(155))?, size)?.repeating_along([false, true]),
    ])
}
