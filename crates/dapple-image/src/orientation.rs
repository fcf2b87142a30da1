//! Orientation of stored rows and columns, and the rotation or reflection that makes an image upright.
//!
//! Reference: "Exchangeable image file format for digital still cameras: Exif Version 2.32", CIPA DC-008, 2019, tag
//! 274. TIFF has the same tag; TGA and Radiance HDR declare the order of their rows and columns.

use crate::{Format, ImageError};
use dapple_raster::Raster;

/// Orientation of the stored rows and columns, numbered as in Exif: 1 (upright) to 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Orientation(u16);

impl Orientation {
    /// Creates an orientation from its number; unknown numbers count as upright.
    pub(crate) fn new(number: u16) -> Self {
        Self(if (1..=8).contains(&number) { number } else { 1 })
    }

    /// Describes the stored pixels of an image.
    pub(crate) fn stored(self, size: [u32; 2], format: Format) -> Stored {
        Stored {
            orientation: self,
            size,
            format,
        }
    }
}

/// Layout of the pixels of an image as stored in its file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored {
    orientation: Orientation,
    /// Width and height before rotation, in pixels.
    size: [u32; 2],
    format: Format,
}

impl Stored {
    /// Returns the upright image.
    pub(crate) fn upright<T: Copy>(&self, pixels: &[T]) -> Result<Raster<T>, ImageError> {
        let number = self.orientation.0;
        let damaged = |error| ImageError::damaged(self.format.name(), error);
        let stored = Raster::from_vec(self.size, pixels.to_vec()).map_err(damaged)?;
        if number == 1 {
            return Ok(stored);
        }
        let [width, height] = self.size;
        let is_turned = number >= 5;
        let upright = if is_turned {
            [height, width]
        } else {
            self.size
        };
        Raster::from_fn(upright, |x, y| {
            let [mut column, mut row] = if is_turned { [y, x] } else { [x, y] };
            if matches!(number, 2 | 3 | 7 | 8) {
                column = width - 1 - column;
            }
            if matches!(number, 3 | 4 | 6 | 7) {
                row = height - 1 - row;
            }
            stored.row(row)[column as usize]
        })
        .map_err(damaged)
    }
}
