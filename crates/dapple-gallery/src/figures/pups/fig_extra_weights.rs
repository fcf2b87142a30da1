//! Axial weights instead of the cubic: the quintic, whose curvature is also continuous, and one that oscillates, for
//! finer features between the same control points.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{AxialWeight, NetOptions, NoiseOptions, Spacing, hash::Seed, noise};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("minimum distance", "0.2"),
        ("oscillating weight", "3 dips of depth 0.9"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let oscillating = AxialWeight::Oscillating {
        dips: 3,
        depth: 0.9,
    };
    let mut panels = Vec::new();
    for (label, weight) in [
        ("cubic", AxialWeight::Cubic),
        ("quintic", AxialWeight::Quintic),
        ("oscillating", oscillating),
    ] {
        let options = NoiseOptions {
            spacing: Spacing::from(0.2),
            net: NetOptions {
                weight,
                ..NetOptions::default()
            },
            ..NoiseOptions::default()
        };
        panels.push(picture(label, &noise(&options, Seed(4))?, size)?);
    }
    Ok(panels)
}
