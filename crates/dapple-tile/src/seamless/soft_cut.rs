//! Makes a tile by a soft cut along the path of least difference, in a margin that overlaps the opposite side.
//!
//! The last columns overlap the first ones, and the tile changes from one to the other where they are most similar, as
//! in Alexei A. Efros and William T. Freeman, "Image Quilting for Texture Synthesis and Transfer", SIGGRAPH 2001,
//! <https://doi.org/10.1145/383259.383296>. Then rows are processed in the same way, on the result, which already
//! repeats along x.
//!
//! * The difference is the sum of squares over all planes. Each plane is divided by its own variance, so a height in
//!   meters counts as much as a color. All planes are cut along the same path.
//! * The cut is soft. Across it, weights rise along a smooth ramp within the margin. They sum to 1 by default: the two
//!   sides are similar along the cut, so a linear mix loses little contrast. Variance-preserving weights
//!   ([`Crossfade`]) leave dark and bright lines where both sides are far from the mean.
//! * The cut for y runs across columns that repeat, so it has to be closed: it ends where it began. The cut for x need
//!   not be, since the cut for y passes where its two ends meet.
//!
//! Widths are in pixels.

use crate::axis::{Axis, each_axis};
use crate::cut::{add_differences, inset, weight};
use crate::cut_path::{closed_path, open_path};
use crate::error::check;
use crate::overlap::{check_margin, ends, overlap};
use crate::{Crossfade, IsCancelled, TileError};
use dapple_raster::Raster;

/// Options for a soft cut. The tile is smaller than the image by the margin, along each axis that repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SoftCut {
    /// Width of the overlap of the two sides, in pixels, from 1 to half of the side.
    ///
    /// The default is an eighth of the shorter side, at least 32 pixels, and at most a quarter of the shorter side.
    pub margin: Option<u32>,
    /// Half-width of the ramp across the cut, in pixels, from 0 (a hard cut) to half of the margin.
    ///
    /// The default is a sixteenth of the margin, at least 4 pixels, and at most half of the margin.
    pub half_width: Option<f32>,
    /// Weights of the blend along the cut.
    ///
    /// The default is linear.
    pub crossfade: Crossfade,
}

impl Default for SoftCut {
    fn default() -> Self {
        Self {
            margin: None,
            half_width: None,
            crossfade: Crossfade::Linear,
        }
    }
}

impl SoftCut {
    /// Returns the width of the overlap for an image of `size` pixels. The default grows with the image, so that the
    /// cut can go around features of any resolution.
    #[must_use]
    pub fn margin_of(&self, size: [u32; 2]) -> u32 {
        let shorter = size[0].min(size[1]);
        self.margin
            .unwrap_or((shorter / 8).max(32).min((shorter / 4).max(1)))
    }

    /// Returns the half-width of the ramp for an overlap of `margin` pixels.
    #[must_use]
    pub fn half_width_of(&self, margin: u32) -> f32 {
        let margin = margin as f32;
        self.half_width
            .unwrap_or((margin / 16.0).max(4.0).min(margin / 2.0))
    }
}

/// The widths of a cut, in pixels.
#[derive(Clone, Copy, Debug)]
struct Widths {
    margin: u32,
    half_width: f64,
}

/// Makes tiles from all planes, with the same cut.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    cut: &SoftCut,
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let margin = cut.margin_of(planes.first().map_or([1; 2], Raster::size));
    check_margin(planes, margin, axes)?;
    let widths = Widths {
        margin,
        half_width: cut.half_width_of(margin).into(),
    };
    TileError::check(
        (0.0..=f64::from(margin) / 2.0).contains(&widths.half_width),
        "half width of the cut",
        widths.half_width,
        "from 0 to half of the margin",
    )?;
    each_axis(planes, axes, is_cancelled, |planes, axis| {
        // Find the path on which the two ends of the rows are most similar.
        let differences = differences(planes, widths, is_cancelled)?;
        // If columns repeat, so must the cut across them.
        let path = match axis {
            Axis::Y if axes[0] => closed_path(&differences, is_cancelled),
            Axis::X | Axis::Y => open_path(&differences, is_cancelled),
        }?;
        let weights = weights(&path, widths)?;
        overlap(planes, &weights, cut.crossfade, is_cancelled)
    })
}

/// Returns the difference of the two ends of the planes, in the columns that the cut may pass through.
fn differences(
    planes: &[Raster<f32>],
    cut: Widths,
    is_cancelled: &IsCancelled,
) -> Result<Raster<f64>, TileError> {
    let height = planes.first().map_or(1, Raster::height);
    let inset = inset(cut.half_width);
    let width = cut.margin - 2 * inset;
    let mut sum = Raster::filled([width, height], 0.0)?;
    for plane in planes {
        check(is_cancelled)?;
        let deviation = plane.statistics().deviation;
        // A plane with a single value has no differences.
        let scale = if deviation > 0.0 {
            1.0 / deviation
        } else {
            0.0
        };
        let [first, last] = ends(plane, cut.margin)?;
        add_differences([&first, &last], inset as usize, scale, &mut sum);
    }
    Ok(sum)
}

/// Returns the weights of the first columns: 0 to the left of the cut, 1 to the right, ½ on it.
fn weights(path: &[u32], widths: Widths) -> Result<Raster<f64>, TileError> {
    let Widths { margin, half_width } = widths;
    let inset = inset(half_width);
    Ok(Raster::from_fn(
        [margin, path.len() as u32],
        |column, row| {
            // The path is counted from the first column that the cut may pass through.
            let cut = path[row as usize] + inset;
            weight(f64::from(column) - f64::from(cut), half_width)
        },
    )?)
}

#[cfg(test)]
mod tests;
