//! Crossfades: the usual baselines.
//!
//! [`Feather::HalfShift`] is the method of GIMP's filter "Tile Seamless" and similar tools: the image is mixed with
//! itself rolled by half of its size, whose borders are continuous where its middle is not, and each is visible where
//! it is continuous. Here it is done along one axis after the other, and not once along the diagonal, so that it works
//! for a single axis. [`Feather::Margin`] mixes the two ends of the image over each other, as many small tools do, and
//! loses the margin.
//!
//! Weights rise linearly, as in those tools, and the half shift mixes plainly, which costs contrast: these are baselines.
//! Widths are in pixels.
//!
//! Reference: our own, after these tools.

use crate::axis::each_axis;
use crate::overlap::{check_margin, overlap};
use crate::{Crossfade, TileError, TileErrorKind};
use dapple_raster::Raster;

/// A crossfade between an image and itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
pub enum Feather {
    /// A crossfade with the image rolled by half of its size, all the way to the middle; the size stays. A side has at
    /// least 4 pixels.
    #[default]
    HalfShift,
    /// A crossfade of the two ends over a margin, in pixels, by which the tile is smaller.
    Margin {
        /// The width of the crossfade, in pixels, from 1 to half of the side.
        margin: u32,
        /// The weights of the mix. By default the variance is kept.
        #[cfg_attr(feature = "serde", serde(default))]
        crossfade: Crossfade,
    },
}

/// The shortest side that has two pixels on both sides of its middle.
const LEAST_SIDE: u32 = 4;

/// The tiles of all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    feather: &Feather,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    match *feather {
        Feather::HalfShift => each_axis(planes, axes, |planes, _| {
            planes.iter().map(half_shift).collect()
        }),
        Feather::Margin { margin, crossfade } => {
            check_margin(planes, margin, axes)?;
            each_axis(planes, axes, |planes, _| {
                let height = planes.first().map_or(1, Raster::height);
                let share = |column: u32| (f64::from(column) + 0.5) / f64::from(margin);
                let weights = Raster::from_fn([margin, height], |column, _| share(column))?;
                overlap(planes, &weights, crossfade)
            })
        }
    }
}

/// Mixes every row with itself, rolled by half of its length.
fn half_shift(plane: &Raster<f32>) -> Result<Raster<f32>, TileError> {
    let length = plane.width();
    if length < LEAST_SIDE {
        let least = LEAST_SIDE;
        return Err(TileError::new(TileErrorKind::TooSmall { length, least }));
    }
    let weights: Vec<f32> = (0..length).map(|column| tent(column, length)).collect();
    let half = length as usize / 2;
    let weights = &weights;
    Ok(Raster::from_rows(plane.size(), |row| {
        let row = plane.row(row);
        let rolled = row[half..].iter().chain(&row[..half]);
        let pixels = row.iter().zip(rolled).zip(weights);
        pixels.map(|((own, rolled), weight)| match *weight {
            0.0 => *rolled,
            1.0 => *own,
            weight => weight * own + (1.0 - weight) * rolled,
        })
    })?)
}

/// The weight of the image itself: 0 in the first and last pixel, 1 in both pixels where the rolled image has its ends.
fn tent(column: u32, length: u32) -> f32 {
    let left = length - length / 2;
    if column < left {
        column as f32 / (left - 1) as f32
    } else {
        (length - 1 - column) as f32 / (length - 1 - left) as f32
    }
}

#[cfg(test)]
mod tests;
