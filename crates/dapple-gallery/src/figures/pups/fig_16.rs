//! A progressive space giraffe: the centers of its spots are closer together toward the right.
//!
//! As in figure 11, a position gets the label whose control points have the larger sum of weights.

use super::summed;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{ProgressionOptions, giraffe_progression, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "16",
    parameters: &[
        (
            "minimum distance of centers",
            "0.4 to 0.08, in equal ratios",
        ),
        ("pairs of points around a center", "10 to 20"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let options = ProgressionOptions {
        distances: [0.4, 0.08],
        ..ProgressionOptions::default()
    };
    let texture = giraffe_progression(&options, Seed(16))?;
    Ok(vec![
        summed("", &texture, size)?.repeating_along([false, true]),
    ])
}
