//! Textures in the plane along directions, with features of different sizes: scales around a center, woven hooks that
//! grow to the right, and scales that do both.
//!
//! Directions and sizes are images of the texture's size. The texture is synthesized on sites, whose neighborhoods
//! rotate and scale with them, and its pixels sample the exemplar between its pixels.

use super::exemplar::EXEMPLARS;
use crate::draw::enlarged;
use crate::figure::source;
use crate::{Figure, Panel};
use anyhow::Context;
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_synth::{Edges, Exemplar, Options, PlaneScales, bake_colors, synthesize_plane_along};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("exemplars", "64²; the hooks repeat"),
        ("textures", "256²"),
        ("sizes", "1; from 1 to 2.5; from 0.4 to 2.5"),
    ],
    source: source!(),
    render,
};

/// Width and height of the exemplars and the textures, in pixels.
const SIDE: u32 = 64;
const LARGE: u32 = 256;
/// Maximum scale of an exemplar pixel, in pixels of the texture.
const LARGEST: f64 = 2.5;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let from_middle =
        |x: u32, y: u32| [x, y].map(|at| (f64::from(at) + 0.5) / f64::from(LARGE) - 0.5);
    // Angle of the direction away from the center, measured from down toward the right.
    let outward = Raster::from_fn([LARGE; 2], |x, y| {
        let [x, y] = from_middle(x, y);
        libm::atan2(x, y) as f32
    })?;
    let straight = Raster::filled([LARGE; 2], 0.0)?;
    let rightward = Raster::from_fn([LARGE; 2], |x, y| {
        let [x, _] = from_middle(x, y);
        (1.0 + (LARGEST - 1.0) * (x + 0.5)) as f32
    })?;
    let rightward = PlaneScales::Plane(&rightward);
    let [one, of_rays] = [[1.0; 2], [0.4, LARGEST as f32]].map(PlaneScales::Conformal);
    let mut panels = Vec::new();
    let [scales, hooks] = [("scales", Edges::Cut), ("woven hooks", Edges::Wrap)];
    for (label, exemplar, directions, sizes) in [
        ("outward", scales, &outward, one),
        ("growing to the right", hooks, &straight, rightward),
        ("growing outward, as rays spread", scales, &outward, of_rays),
    ] {
        let texture = grown(exemplar, directions, sizes)?;
        panels.push(Panel::color(label, enlarged(&texture, size)?));
    }
    Ok(panels)
}

/// Synthesizes a texture along directions from an exemplar, given by its name and its edges.
fn grown(
    exemplar: (&str, Edges),
    directions: &Raster<f32>,
    scales: PlaneScales<'_>,
) -> anyhow::Result<Raster<LinearRgb>> {
    let (name, edges) = exemplar;
    let exemplar = EXEMPLARS.iter().find(|found| found.name == name);
    let image = (exemplar.context("no such exemplar")?.draw)(SIDE)?;
    let exemplar = Exemplar::new(&image, edges)?;
    let options = Options::default();
    let go_on = |_| ControlFlow::Continue(());
    let along = synthesize_plane_along(&exemplar, directions, scales, &options, go_on)?;
    Ok(bake_colors(
        &along.synthesizer,
        &along.texture,
        &image,
        &along.atlas,
    )?)
}
