//! Axial weights instead of the cubic: weights that oscillate between two control points, for finer features from the
//! same points. The quintic, whose curvature is also continuous, looks almost like the cubic.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{AxialWeight, NetOptions, NoiseOptions, Spacing, hash::Seed, noise};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[("minimum distance", "0.2"), ("depth of the dips", "0.9")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let oscillating = |dips| AxialWeight::Oscillating { dips, depth: 0.9 };
    let mut panels = Vec::new();
    for (label, weight) in [
        ("cubic", AxialWeight::Cubic),
        ("one dip", oscillating(1)),
        ("three dips", oscillating(3)),
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
