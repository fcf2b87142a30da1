//! The exemplars: the images that the other figures' textures are synthesized from, with their pixels enlarged.
//!
//! They are procedural substitutes for the images of the paper.

use super::exemplar::{EXEMPLARS, Edges};
use crate::draw::enlarged;
use crate::figure::source;
use crate::{Figure, Panel};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[("sizes", "64² to 256², those of table 1")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let panel = |exemplar: &super::exemplar::Exemplar| {
        // A small figure draws the same image with fewer pixels.
        let side = exemplar.side.min(size);
        let (edges, repeats) = match exemplar.edges {
            Edges::Repeating => ("repeats", true),
            Edges::Cropped => ("does not repeat", false),
        };
        let image = enlarged(&(exemplar.draw)(side)?, size)?;
        let label = format!("{}, {}², {edges}", exemplar.name, exemplar.side);
        Ok(Panel::color(label, image).repeating_along([repeats; 2]))
    };
    EXEMPLARS.iter().map(panel).collect()
}
