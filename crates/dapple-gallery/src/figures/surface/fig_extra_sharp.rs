//! A texture at such a close distance that the exemplar's pixels are large: with mixed colors of sites, as in the
//! paper; sampled from the exemplar at the sub-pixel sources of the sites, at the sharpness of the exemplar; and
//! sampled from a version of the exemplar that is eight times larger.
//!
//! The exemplar shows scales; the ball has 12,000 points.

use super::exemplar::EXEMPLARS;
use super::stage::{View, lit};
use super::textured::Job;
use crate::figure::source;
use crate::{Figure, Panel};
use anyhow::Context;
use dapple_models::{polygonize_n, solid};
use dapple_synth::{Coherence, Direction, Edges, HierarchyOptions, Sources};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("points", "12,000"),
        ("exemplar", "scales, 128²; 1024²"),
        ("sources", "pixel; sub-pixel; sub-pixel"),
    ],
    source: source!(),
    render,
};

/// Side of the exemplar in pixels, and scale factor of its larger version.
const SIDE: u32 = 128;
const FACTOR: u32 = 8;

const VIEW: View = View {
    eye: DVec3::new(0.0, 0.8, 3.5),
    target: DVec3::new(0.0, 0.15, 0.0),
    fov: 0.4,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let scales = EXEMPLARS.iter().find(|exemplar| exemplar.name == "scales");
    let draw = scales.context("no scales")?.draw;
    let ball = solid::Ball {
        center: DVec3::ZERO,
        radius: 1.0,
    };
    let mesh = polygonize_n(&ball, 0.2, 2000)?;
    let job = Job {
        mesh,
        image: draw(SIDE)?,
        edges: Edges::Cut,
        directions: vec![Direction {
            at: DVec3::Z,
            vector: DVec3::NEG_Y,
        }],
        sites: HierarchyOptions {
            n_sites: 12_000,
            ..HierarchyOptions::default()
        },
        coherence: Coherence::Auto,
        sources: Sources::SubPixel,
        sizes: None,
        detail: None,
        map_side: (4 * size).max(512),
        mask: None,
        guides: Vec::new(),
    };
    let panels = [
        (
            "colors of sites, mixed",
            Job {
                sources: Sources::Pixel,
                ..job.clone()
            },
        ),
        ("read from the exemplar", job.clone()),
        (
            "read from a larger one",
            Job {
                detail: Some(draw(SIDE * FACTOR)?),
                ..job
            },
        ),
    ];
    let panel = |(label, job): (&str, Job)| {
        let textured = job.run()?;
        let mesh = textured.synthesizer.surface().mesh();
        let picture = lit(mesh, &VIEW, [size; 2], |surface| textured.color(surface))?;
        Ok(Panel::color(label, picture))
    };
    panels.into_iter().map(panel).collect()
}
