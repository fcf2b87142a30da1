//! A topic that section 8 leaves to future work: the texture of one model, lifted and placed onto another model
//! without the exemplar that it was synthesized from. Neighborhoods are compared with the neighborhoods of the first
//! model.
//!
//! Rows of scales run down the rounded animal, and along the tubes of three blended tori. A stain on the animal is
//! covered with scales from the rest of it.

use super::exemplar::cut_out;
use super::stage::{View, lit};
use super::subject::{SUBJECTS, TORI};
use super::textured::{Job, Textured};
use crate::figure::source;
use crate::{Figure, Panel};
use anyhow::Context;
use dapple_synth::mesh::rotation;
use dapple_synth::{Coherence, Edges, HierarchyOptions, Sources};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("first model", "bunny; scales, 64²; 40,000 points"),
        ("second model", "tori; 40,000 points; coherence 0"),
    ],
    source: source!(),
    render,
};

/// Number of points on each model for a figure of 512 pixels, and the minimum number.
const SITES: f64 = 40_000.0;
const SITES_MIN: usize = 2000;
/// Position of the stain's center.
const STAIN: DVec3 = DVec3::new(0.32, -0.3, 0.28);
/// Number of triangles of each model.
const TRIANGLES: usize = 6000;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let bunny = SUBJECTS.iter().find(|subject| subject.name == "bunny");
    let bunny = bunny.context("no bunny")?;
    let side = (f64::from(size) / 512.0).min(1.0);
    let sites = HierarchyOptions {
        n_sites: ((SITES * side * side) as usize).max(SITES_MIN),
        ..HierarchyOptions::default()
    };
    let job = Job {
        mesh: (bunny.model)(TRIANGLES)?,
        image: cut_out("scales", 64)?,
        edges: Edges::Cut,
        directions: bunny.directions(),
        sites: sites.clone(),
        coherence: Coherence::Auto,
        sources: Sources::SubPixel,
        sizes: None,
        detail: None,
        map_side: (2 * size).max(512),
        mask: None,
        guides: Vec::new(),
    };
    let first = job.run()?;
    let second = first.lifted((TORI.model)(TRIANGLES)?, &TORI.directions(), &sites)?;
    let mut panels = vec![Panel::color("grown", picture(&first, &bunny.view, size)?)];
    for (turn, label) in [
        (0.0, "lifted"),
        (90.0, "from the left"),
        (180.0, "from behind"),
        (270.0, "from the right"),
    ] {
        let turn = rotation(DVec3::Y, f64::to_radians(turn));
        let view = View {
            eye: turn * (TORI.view.eye - TORI.view.target) + TORI.view.target,
            ..TORI.view
        };
        panels.push(Panel::color(label, picture(&second, &view, size)?));
    }
    let stained = first.stained(|at| at.distance(STAIN) < 0.22)?;
    for (textured, label) in stained.iter().zip(["stained", "repaired"]) {
        panels.push(Panel::color(label, picture(textured, &bunny.view, size)?));
    }
    Ok(panels)
}

/// Renders the textured model.
fn picture(
    textured: &Textured,
    view: &View,
    size: u32,
) -> anyhow::Result<dapple_raster::Raster<dapple_color::LinearRgb>> {
    let mesh = textured.synthesizer.surface().mesh();
    lit(mesh, view, [size; 2], |surface| textured.color(surface))
}
