//! Two “cow texture” examples: Poisson disc distribution of control points with random assignment of binary labels.
//!
//! In the first two, a position gets the label whose control points have the larger sum of weights. This is where the
//! texture with the labels 0 and 1 as values is above ½, and its patches have round corners. The third uses the labels
//! of the first by the literal rule of the paper, where the strongest point alone decides: its patches are nearly
//! polygons and meet in points.

use super::{SIDE, fine_square, picture_of_labels};
use crate::draw::shrink;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CowOptions, LabelTexture, cow, hash::Seed};
use dapple_raster::Field;

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
        summed("first", &first, size)?,
        summed("second", &second, size)?,
        picture_of_labels("first, by the strongest point alone", &first, size)?,
    ])
}

/// Draws, at each position, the label with the larger sum of weights.
fn summed(label: &str, cow: &LabelTexture, size: u32) -> anyhow::Result<Panel> {
    let white = cow.labels().iter().map(|&label| label as f32).collect();
    let share = cow.pups().texture(white)?.to_raster(&fine_square(size)?)?;
    let labels = share.map(|&share| if share > 0.5 { 1.0 } else { 0.0 });
    Ok(Panel::gray(label, shrink(&labels, SIDE)?).repeating())
}
