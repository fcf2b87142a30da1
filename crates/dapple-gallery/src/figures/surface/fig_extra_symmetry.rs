//! Fields with one, two and four directions: bricks, which look the same upside down, and a checker, which looks the
//! same on its side, with fewer tears where the field may rotate by half or a quarter turn around a point.
//!
//! No directions are given: a field with one direction runs down the model, and the others are the smoothest fields.

use super::exemplar::EXEMPLARS;
use super::stage::{lit, views};
use super::textured::{Job, Textured};
use crate::figure::source;
use crate::{Figure, Panel};
use anyhow::Context;
use dapple_models::bunny;
use dapple_synth::{Coherence, Edges, HierarchyOptions, Sources, Symmetry};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("exemplars", "96² and 64², which repeat"),
        ("points", "65,536"),
        ("views", "from the front and from behind"),
    ],
    source: source!(),
    render,
};

/// Panels, each with a label, an exemplar, its side in pixels, and the symmetry of the field.
const PANELS: [(&str, &str, u32, Symmetry); 4] = [
    ("bricks, one direction", "color bricks", 96, Symmetry::One),
    ("bricks, two", "color bricks", 96, Symmetry::Two),
    (
        "checker, one direction",
        "wiggly checker",
        64,
        Symmetry::One,
    ),
    ("checker, four", "wiggly checker", 64, Symmetry::Four),
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let mut panels = Vec::new();
    for (label, exemplar, side, symmetry) in PANELS {
        let textured = textured(size, exemplar, side, symmetry)?;
        let mesh = textured.synthesizer.surface().mesh();
        let [front, _, behind, _] = views(mesh);
        for (label, view) in [(label, front), ("from behind", behind)] {
            let picture = lit(mesh, &view, [size; 2], |surface| textured.color(surface))?;
            panels.push(Panel::color(label, picture));
        }
    }
    Ok(panels)
}

/// Synthesizes a texture on the model along a field with the given symmetry.
fn textured(size: u32, exemplar: &str, side: u32, symmetry: Symmetry) -> anyhow::Result<Textured> {
    let exemplar = EXEMPLARS.iter().find(|found| found.name == exemplar);
    let job = Job {
        mesh: bunny((14_000 * size / 512).clamp(2000, 14_000) as usize)?,
        image: (exemplar.context("no such exemplar")?.draw)(side)?,
        edges: Edges::Wrap,
        directions: Vec::new(),
        sites: HierarchyOptions {
            n_sites: (size * size / 4).clamp(4096, 65_536) as usize,
            ..HierarchyOptions::default()
        },
        coherence: Coherence::Auto,
        sources: Sources::SubPixel,
        sizes: None,
        detail: None,
        map_side: (2 * size).clamp(512, 1024),
        mask: None,
        guides: Vec::new(),
    };
    job.run_symmetric(symmetry)
}
