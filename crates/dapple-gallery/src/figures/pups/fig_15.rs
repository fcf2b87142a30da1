//! Progressive textures: cows whose control points stand closer to the right.
//!
//! The points lie on a cylinder: the texture repeats from top to bottom, but not from left to right.

use super::{cylinder, picture_of_labels};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{CowOptions, Spacing, cow, hash::Seed};
use dapple_raster::{Ramp, Varying};
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "15",
    parameters: &[
        ("minimum distance", "0.2 to 0.02, in equal ratios"),
        ("labels", "random, black or white"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let distance = Varying::GeometricRamp(Ramp {
        from: DVec2::NEG_X,
        to: DVec2::X,
        start: 0.2,
        end: 0.02,
    });
    let options = CowOptions {
        domain: cylinder(),
        spacing: Spacing::Distance(distance),
        ..CowOptions::default()
    };
    Ok(vec![
        picture_of_labels("first", &cow(&options, Seed(15))?, size)?,
        picture_of_labels("second", &cow(&options, Seed(155))?, size)?,
    ])
}
