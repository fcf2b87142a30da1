//! The figures of "Partition of Unity Parametrics for Texture Synthesis".

mod fig_01a;
mod fig_01b;
mod fig_02;
mod fig_03;
mod fig_04;
mod fig_05;
mod fig_06;
mod fig_07;
mod fig_08;
mod fig_09a;
mod fig_09b;
mod fig_10;
mod fig_11;
mod fig_12;
mod fig_13;
mod fig_14;
mod fig_15;
mod fig_16;
mod fig_17;
mod fig_extra_colors;
mod fig_extra_motion;
mod fig_extra_weights;
pub(crate) mod flower;
mod weight;

use crate::draw::shrink;
use crate::{Panel, Paper};
use dapple_points::Domain;
use dapple_pups::LabelTexture;
use dapple_raster::{Field, RasterError, Window};

/// The paper, with its figures in order.
pub(super) const PAPER: Paper = Paper {
    key: "pups",
    title: "Partition of Unity Parametrics for Texture Synthesis",
    reference: "Jack Caron and David Mould, Graphics Interface 2013",
    figures: &[
        fig_01a::FIGURE,
        fig_01b::FIGURE,
        fig_02::FIGURE,
        fig_03::FIGURE,
        fig_04::FIGURE,
        fig_05::FIGURE,
        fig_06::FIGURE,
        fig_07::FIGURE,
        fig_08::FIGURE,
        fig_09a::FIGURE,
        fig_09b::FIGURE,
        fig_10::FIGURE,
        fig_11::FIGURE,
        fig_12::FIGURE,
        fig_13::FIGURE,
        fig_14::FIGURE,
        fig_15::FIGURE,
        fig_16::FIGURE,
        fig_17::FIGURE,
        fig_extra_weights::FIGURE,
        fig_extra_colors::FIGURE,
        fig_extra_motion::FIGURE,
    ],
};

/// Renders a texture on the paper's square `[-1, 1]²` in shades of gray. The square is a torus, so the image tiles.
fn picture(label: impl Into<String>, texture: &dyn Field, size: u32) -> Result<Panel, RasterError> {
    Ok(Panel::gray(label, texture.to_raster(&square(size)?)?).repeating())
}

/// Renders a label texture on the paper's square in shades of gray, with its hard edges smoothed. The image tiles.
fn picture_of_labels(
    label: impl Into<String>,
    texture: &dyn Field,
    size: u32,
) -> Result<Panel, RasterError> {
    let fine = texture.to_raster(&fine_square(size)?)?;
    Ok(Panel::gray(label, shrink(&fine, SIDE)?).repeating())
}

/// Draws, at each position of the paper's square, the value 0 or 1 whose control points have the larger sum of weights.
fn summed(label: &str, texture: &LabelTexture, size: u32) -> anyhow::Result<Panel> {
    let value = |&label: &u32| texture.values()[label as usize];
    let values = texture.labels().iter().map(value).collect();
    let share = texture
        .pups()
        .texture(values)?
        .to_raster(&fine_square(size)?)?;
    let labels = share.map(|&share| if share > 0.5 { 1.0 } else { 0.0 });
    Ok(Panel::gray(label, shrink(&labels, SIDE)?))
}

/// Number of samples along each side of a pixel, used to smooth hard edges.
const SIDE: u32 = 4;

/// Returns the supersampled window of the paper's square, for an image of `size` × `size` pixels.
fn fine_square(size: u32) -> Result<Window, RasterError> {
    square(size.saturating_mul(SIDE))
}

/// Returns the window of the paper's square, with `size` × `size` pixels.
fn square(size: u32) -> Result<Window, RasterError> {
    let square = Domain::paper_torus();
    Window::new(square.origin, square.size, [size; 2])
}
