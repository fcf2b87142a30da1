//! Space giraffe patterns.
//!
//! Around the center of each spot stand 10 to 20 pairs of points, the inner one in the spot and the outer one in the
//! background. Spots never merge; with `spots: Spots::Literal`, the paper's recipe as it is, a few do.

use super::picture_of_labels;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{SpaceGiraffeOptions, hash::Seed, space_giraffe};

pub(super) const FIGURE: Figure = Figure {
    number: "12",
    parameters: &[
        ("minimum distance of centers", "0.2"),
        ("pairs of points around a center", "10 to 20"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let giraffe = |seed| space_giraffe(&SpaceGiraffeOptions::default(), seed);
    Ok(vec![
        picture_of_labels("first", &giraffe(Seed(12))?, size)?,
        picture_of_labels("second", &giraffe(Seed(122))?, size)?,
    ])
}
