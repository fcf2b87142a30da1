//! Six models with their textures, each shown with the exemplar that it was synthesized from: a ray, an octopus, a
//! rounded animal, three blended tori, a zebra and an elephant.
//!
//! The numbers of points and levels and the exemplar sizes are from table 1 in a figure of 512 pixels; smaller figures
//! have fewer points and triangles. Models and exemplars are procedural substitutes for the paper's. The texture is
//! baked to a map of right triangles on the model, which has 14,000 of them.

use super::subject::SUBJECTS;
use crate::draw::enlarged;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_raster::Raster;

pub(super) const FIGURE: Figure = Figure {
    number: "5",
    parameters: &[
        ("points", "256,000 (ray: 64,000)"),
        ("levels", "3: ray, octopus, bunny; 4: tori, zebra, elephant"),
        (
            "coherence, evenness",
            "auto (2 for puzzle pieces, for all others 2 in the first pass and then 0); 1; 0 in the paper",
        ),
        ("sizes", "1; tori 0.4 to 1.2, by their directions"),
        ("texture map", "1024²"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let panel = |subject: &super::subject::Subject| {
        let (mut picture, n_points) = subject.picture(size)?;
        let (exemplar, _) = subject.image()?;
        inset(&mut picture, &enlarged(&exemplar, (size / 5).max(1))?);
        let label = format!("{}, {n_points} points", subject.name);
        Ok(Panel::color(label, picture))
    };
    SUBJECTS.iter().map(panel).collect()
}

/// Copies a small image into the upper right corner of a larger one.
fn inset(picture: &mut Raster<LinearRgb>, small: &Raster<LinearRgb>) {
    let width = picture.width() as usize;
    let first = width - small.width() as usize;
    for row in 0..small.height() {
        let target = &mut picture.pixels_mut()[row as usize * width + first..];
        target[..small.width() as usize].copy_from_slice(small.row(row));
    }
}
