//! Parts of an image that are synthesized again, while their surroundings stay unchanged: a stain on scales; and the
//! seam of bricks whose courses do not meet, next to plain copies of the image, which are shifted so that the seam is
//! in the middle.
//!
//! The tile is as large as the part of the image that repeats best, and only a strip along its seam is synthesized.

use super::exemplar::cut_out;
use crate::draw::enlarged;
use crate::figure::source;
use crate::{Figure, Panel};
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_raster::{Raster, Wrap};
use dapple_synth::{Edges, Exemplar, Options, PlaneTexture, tile_plane};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("images", "192², scales and bricks"),
        ("stain", "30 pixels wide"),
        ("strip along the seam", "36 pixels wide"),
    ],
    source: source!(),
    render,
};

/// Width and height of the images in pixels.
const SIDE: u32 = 192;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let scales = cut_out("scales", SIDE)?;
    let radius = f64::from(SIDE) * 5.0 / 64.0;
    let in_stain = |x: u32, y: u32| {
        let middle = [0.56, 0.45].map(|part| part * f64::from(SIDE));
        let [x, y] = [f64::from(x) - middle[0], f64::from(y) - middle[1]];
        x * x + y * y < radius * radius
    };
    let stain = Raster::from_fn([SIDE; 2], in_stain)?;
    let ink = LinearRgb::new(0.02, 0.02, 0.03);
    let stained = scales.zip_map(
        &stain,
        |&color, &is_stain| if is_stain { ink } else { color },
    )?;

    let exemplar = Exemplar::new(&stained, Edges::Cut)?;
    let exemplar = exemplar.with_mask(&stain.map(|is_stain| !is_stain))?;
    let options = Options::default();
    let keep_on = |_| ControlFlow::Continue(());
    let identity = PlaneTexture::identity(&exemplar)?;
    let repaired = identity.repair(&exemplar, &stain, &options, keep_on)?;

    let bricks = cut_out("color bricks", SIDE)?;
    let exemplar = Exemplar::new(&bricks, Edges::Cut)?;
    let tile = tile_plane(&exemplar, [true; 2], SIDE * 3 / 16, &options, keep_on)?;
    Ok(vec![
        Panel::color("scales with a stain", enlarged(&stained, size)?),
        Panel::color(
            "the stain made again",
            enlarged(&repaired.transfer(&stained)?, size)?,
        ),
        Panel::color("copies of the image", copies(&bricks, size)?),
        Panel::color(
            "copies of its tile",
            copies(&tile.transfer(&bricks)?, size)?,
        ),
    ])
}

/// Returns copies of a tile in an image of one and a half times [`SIDE`], with a seam in the middle.
fn copies(tile: &Raster<LinearRgb>, size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let side = i64::from(SIDE) * 3 / 2;
    let picture = Raster::from_fn([side as u32; 2], |x, y| {
        let [x, y] = [x, y].map(|at| i64::from(at) - side / 2);
        *tile.at(x, y, [Wrap::Repeat; 2])
    })?;
    Ok(enlarged(&picture, size)?)
}
