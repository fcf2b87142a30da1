//! Points assigned to groups according to their location: the probability of white rises from left to right.

use super::{cylinder, picture_of_labels};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CowOptions, Spacing, cow, hash::Seed};
use dapple_raster::{Ramp, Varying};
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "17",
    parameters: &[
        ("minimum distance", "0.05"),
        ("probability of white", "0 on the left to 1 on the right"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let options = CowOptions {
        domain: cylinder(),
        spacing: Spacing::from(0.05),
        probability: Varying::Ramp(Ramp {
            from: DVec2::NEG_X,
            to: DVec2::X,
            start: 0.0,
            end: 1.0,
        }),
        ..CowOptions::default()
    };
    Ok(vec![picture_of_labels(
        "",
        &cow(&options, Seed(17))?,
        size,
    )?])
}
