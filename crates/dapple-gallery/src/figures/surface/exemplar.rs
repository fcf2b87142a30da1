//! The exemplars: the images from which textures are synthesized, all drawn by procedures.
//!
//! The images of the paper are not available; these have the same character and the same size. Features scale with the
//! size. At 16 pixels all exemplars except the text are still distinguishable.

use super::{bricks, checker, hooks, letter, puzzle, scales, stripes, suckers, text};
use anyhow::Context;
use dapple_color::LinearRgb;
use dapple_raster::Raster;

/// An exemplar: an image to synthesize from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exemplar {
    /// Name of the image's content.
    pub(crate) name: &'static str,
    /// Width and height of the image in its figure, in pixels.
    pub(crate) side: u32,
    /// Whether opposite sides fit together.
    pub(crate) edges: Edges,
    /// Draws the image, with `size` pixels along each side.
    pub(crate) draw: fn(size: u32) -> anyhow::Result<Raster<LinearRgb>>,
}

/// Behavior of an exemplar at its edges, when two copies lie next to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edges {
    /// The image repeats exactly.
    Repeating,
    /// Opposite sides do not fit.
    Cropped,
}

/// The exemplars, the six of figure 5 first, in the order of table 1.
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

/// Returns a square crop of an exemplar that is drawn a quarter larger, so that the crop does not repeat.
pub(super) fn cut_out(name: &str, side: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let exemplar = EXEMPLARS.iter().find(|exemplar| exemplar.name == name);
    let whole = (exemplar.context("no such exemplar")?.draw)(side * 5 / 4)?;
    Ok(whole.crop([0; 2], [side; 2])?)
}

#[cfg(test)]
mod regularity;
#[cfg(test)]
mod tests;
