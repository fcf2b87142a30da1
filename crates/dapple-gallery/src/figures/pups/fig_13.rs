//! A reference image (a) used to assign points to groups in images with different point densities (b, c, d).
//!
//! The image is gray only near the edges of the flower, so the assignment is random only there.

use super::flower::flower;
use super::{picture_of_labels, square};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{ReferenceImage, ReferenceOptions, Spacing, hash::Seed, reference_texture};

pub(super) const FIGURE: Figure = Figure {
    number: "13a–d",
    parameters: &[("minimum distance", "0.1 (b), 0.05 (c), 0.025 (d)")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let image = ReferenceImage::new(flower(&square(256)?)?)?;
    let mut panels = vec![Panel::gray(
        "a, the reference image",
        flower(&square(size)?)?,
    )];
    for (label, distance) in [("b", 0.1), ("c", 0.05), ("d", 0.025)] {
        let options = ReferenceOptions {
            spacing: Spacing::from(distance),
            ..ReferenceOptions::default()
        };
        let texture = reference_texture(&image, &options, Seed(13))?;
        panels.push(picture_of_labels(label, &texture, size)?);
    }
    Ok(panels)
}
