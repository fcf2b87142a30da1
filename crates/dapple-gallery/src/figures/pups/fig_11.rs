//! Two “cow texture” examples: Poisson disc distribution of control points with random assignment of binary labels.
//!
//! In the first two, a position gets the label whose control points have the larger sum of weights. This is where the
//! texture with the labels 0 and 1 as values is above ½, and its patches have round corners. The third uses the labels
//! of the first by the literal rule of the paper, where the strongest point alone decides: its patches are nearly
//! polygons and meet in points.

use super::{picture_of_labels, summed};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CowOptions, cow, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "11",
    parameters: &[
        ("minimum distance", "0.1"),
        ("labels", "random, black or white"),
        ("recipe", "cow"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let [first, second] = [11, 111].map(|seed| cow(&CowOptions::default(), Seed(seed)));
    let (first, second) = (first?, second?);
    Ok(vec![
        summed("first", &first, size)?.repeating(),
        summed("second", &second, size)?.repeating(),
        picture_of_labels("first, by the strongest point alone", &first, size)?,
    ])
}
