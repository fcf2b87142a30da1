//! Space giraffe patterns.
//!
//! Around the center of each spot are 10 to 20 pairs of points, the inner one in the spot and the outer one in the
//! background. In the first two, their radii vary smoothly with the angle, and spots are whole and never merge. In the
//! third, each radius is independently random, by the literal rule of the paper.

use super::picture_of_labels;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{SpaceGiraffeOptions, Spots, hash::Seed, space_giraffe};

pub(super) const FIGURE: Figure = Figure {
    number: "12",
    parameters: &[
        ("minimum distance of centers", "0.2"),
        ("pairs of points around a center", "10 to 20"),
        ("recipe", "giraffe"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let literal = SpaceGiraffeOptions {
        spots: Spots::Literal,
        ..SpaceGiraffeOptions::default()
    };
    let mut panels = Vec::new();
    for (label, options, seed) in [
        ("first", SpaceGiraffeOptions::default(), Seed(12)),
        ("second", SpaceGiraffeOptions::default(), Seed(122)),
        ("first, each radius on its own", literal, Seed(12)),
    ] {
        panels.push(picture_of_labels(
            label,
            &space_giraffe(&options, seed)?,
            size,
        )?);
    }
    Ok(panels)
}
