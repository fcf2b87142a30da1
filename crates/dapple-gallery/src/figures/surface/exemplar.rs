//! The exemplars, that is, the images from which textures are synthesized. All are drawn procedurally.
//!
//! The paper's images are not available; these have the same character and are the same size. Features scale with the
//! image size. At 16 pixels all exemplars except the text are still distinguishable.

use super::{bricks, checker, hooks, letter, puzzle, scales, stripes, suckers, text};
use anyhow::Context;
use dapple_color::LinearRgb;
use dapple_raster::Raster;

/// An exemplar image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exemplar {
    /// Name of the image's subject.
    pub(crate) name: &'static str,
    /// Width and height of the image in the figure that uses it, in pixels.
    pub(crate) side: u32,
    /// Whether the image tiles.
    pub(crate) edges: Edges,
    /// Draws the image, with `size` pixels along each side.
    pub(crate) draw: fn(size: u32) -> anyhow::Result<Raster<LinearRgb>>,
}

/// Behavior at the edges of an exemplar when two copies are placed next to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edges {
    /// The image tiles exactly.
    Repeating,
    /// Opposite sides do not match.
    Cropped,
}

/// All exemplars; the first six belong to figure 5 and are in the order of table 1.
pub(crate) const EXEMPLARS: [Exemplar; 9] = [
    Exemplar {
        name: "wiggly checker",
        side: 64,
        edges: Edges::Repeating,
        draw: checker::checker,
    },
    Exemplar {
        name: "suckers",
        side: 64,
        edges: Edges::Repeating,
        draw: suckers::suckers,
    },
    Exemplar {
        name: "scales",
        side: 128,
        edges: Edges::Cropped,
        draw: scales::scales,
    },
    Exemplar {
        name: "woven hooks",
        side: 64,
        edges: Edges::Repeating,
        draw: hooks::hooks,
    },
    Exemplar {
        name: "text",
        side: 256,
        edges: Edges::Cropped,
        draw: text::text,
    },
    Exemplar {
        name: "puzzle pieces",
        side: 64,
        edges: Edges::Repeating,
        draw: puzzle::puzzle,
    },
    Exemplar {
        name: "color bricks",
        side: 128,
        edges: Edges::Repeating,
        draw: bricks::bricks,
    },
    Exemplar {
        name: "stripes",
        side: 64,
        edges: Edges::Repeating,
        draw: stripes::stripes,
    },
    Exemplar {
        name: "letter",
        side: 64,
        edges: Edges::Repeating,
        draw: letter::letter,
    },
];

/// Returns a square crop of an exemplar that is drawn a quarter larger, so that the crop does not tile.
pub(super) fn cut_out(name: &str, side: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let exemplar = EXEMPLARS.iter().find(|exemplar| exemplar.name == name);
    let whole = (exemplar.context("no such exemplar")?.draw)(side * 5 / 4)?;
    Ok(whole.crop([0; 2], [side; 2])?)
}

#[cfg(test)]
mod regularity;
#[cfg(test)]
mod tests;
