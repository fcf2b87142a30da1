//! Progressive textures: cows whose control points are closer together toward the right.
//!
//! As in figure 11, a position gets the label whose control points have the larger sum of weights. The points are on a
//! cylinder, so the texture repeats from top to bottom, but not from left to right.

use super::summed;
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
        summed("first", &texture(Seed(15))?, size)?.repeating_along([false, true]),
        summed("second", &texture(Seed(155))?, size)?.repeating_along([false, true]),
    ])
}
