//! Crossfades, which serve as common baselines.
//!
//! [`Feather::HalfShift`] is the method of GIMP's filter "Tile Seamless" and similar tools. The image is blended with
//! itself rolled by half of its size. The rolled image is continuous at the borders, the original in the middle, and
//! each is visible where it is continuous. Here this is done along one axis after the other instead of once along the
//! diagonal, so it works for a single axis. [`Feather::Margin`] blends the two ends of the image, as many small tools
//! do, and loses the margin.
//!
//! As in those tools, weights rise linearly, and the half shift uses a plain average, which costs contrast. Widths are
//! in pixels.
//!
//! Reference: our own, modeled on these tools.

use crate::axis::each_axis;
use crate::error::rows_cancellable;
use crate::overlap::{check_margin, overlap};
use crate::{Crossfade, IsCancelled, TileError, TileErrorKind};
use dapple_raster::Raster;

/// A crossfade between an image and itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Feather {
    /// A crossfade with the image rolled by half of its size, up to the middle. The size does not change. A side must
    /// be at least 4 pixels long.
    #[default]
    HalfShift,
    /// A crossfade of the two ends over a margin. The tile is smaller than the image by the margin.
    Margin {
        /// Width of the crossfade, in pixels, from 1 to half of the side.
        margin: u32,
        /// Weights of the crossfade.
        ///
        /// The default is variance-preserving.
        #[cfg_attr(feature = "serde", serde(default))]
        crossfade: Crossfade,
    },
}

/// Minimum side length, which leaves two pixels on either side of the middle.
const LEAST_SIDE: u32 = 4;

/// Makes tiles from all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    feather: &Feather,
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    match *feather {
        Feather::HalfShift => each_axis(planes, axes, is_cancelled, |planes, _| {
            let shifted = planes.iter().map(|plane| half_shift(plane, is_cancelled));
            shifted.collect()
        }),
        Feather::Margin { margin, crossfade } => {
            check_margin(planes, margin, axes)?;
            each_axis(planes, axes, is_cancelled, |planes, _| {
                let height = planes.first().map_or(1, Raster::height);
                // Weights rise linearly over the margin. They are sampled at the pixels' centers.
                let share = |column: u32| (f64::from(column) + 0.5) / f64::from(margin);
                let weights = Raster::from_fn([margin, height], |column, _| share(column))?;
                overlap(planes, &weights, crossfade, is_cancelled)
            })
        }
    }
}

/// Blends every row with itself rolled by half of the row's length.
fn half_shift(plane: &Raster<f32>, is_cancelled: &IsCancelled) -> Result<Raster<f32>, TileError> {
    let length = plane.width();
    if length < LEAST_SIDE {
        let least = LEAST_SIDE;
        return Err(TileError::new(TileErrorKind::TooSmall { length, least }));
    }
    let weights: Vec<f32> = (0..length).map(|column| tent(column, length)).collect();
    let half = length as usize / 2;
    let weights = &weights;
    rows_cancellable(plane.size(), is_cancelled, |row| {
        let row = plane.row(row);
        // Blend the row with itself, rolled by half. Weights of 0 and 1 give exact copies.
        let rolled = row[half..].iter().chain(&row[..half]);
        let pixels = row.iter().zip(rolled).zip(weights);
        pixels.map(|((own, rolled), weight)| match *weight {
            0.0 => *rolled,
            1.0 => *own,
            weight => weight * own + (1.0 - weight) * rolled,
        })
    })
}

/// Returns the weight of the original image: 0 at the first and last pixel, 1 at both pixels where the rolled image has
/// its ends.
fn tent(column: u32, length: u32) -> f32 {
    // The ends of the rolled image are at the pixels `left - 1` and `left`.
    let left = length - length / 2;
    if column < left {
        column as f32 / (left - 1) as f32
    } else {
        (length - 1 - column) as f32 / (length - 1 - left) as f32
    }
}

#[cfg(test)]
mod tests;
