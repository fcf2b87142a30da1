//! Reads a photograph's Exif orientation, and rotates or mirrors the image so that it is upright.
//!
//! Reference: "Exchangeable image file format for digital still cameras: Exif Version 2.32", CIPA DC-008, 2019, tag
//! 274 of the first directory of its TIFF data. Malformed data counts as upright.

use super::exif::Tiff;
use crate::ImageError;
use dapple_raster::Raster;

/// Tag of the orientation.
const TAG: u16 = 274;

/// Exif orientation of the stored rows and columns: 1 (upright) to 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Orientation(u16);

impl Default for Orientation {
    fn default() -> Self {
        Self(1)
    }
}

impl Orientation {
    /// Reads the orientation from bytes that start with the TIFF header.
    pub(super) fn from_exif(exif: &[u8]) -> Self {
        match find(exif) {
            Some(number @ 1..=8) => Self(number),
            _ => Self::default(),
        }
    }

    /// Returns the upright image. `size` is the width and height of the stored image.
    pub(super) fn raster<T: Copy>(
        self,
        size: [u32; 2],
        pixels: &[T],
    ) -> Result<Raster<T>, ImageError> {
        let damaged = |error| ImageError::damaged("JPEG", error);
        let stored = Raster::from_vec(size, pixels.to_vec()).map_err(damaged)?;
        if self == Self::default() {
            return Ok(stored);
        }
        let [last_column, last_row] = size.map(|side| side - 1);
        let is_turned = self.0 >= 5;
        let upright = if is_turned { [size[1], size[0]] } else { size };
        Raster::from_fn(upright, |x, y| {
            let [mut column, mut row] = if is_turned { [y, x] } else { [x, y] };
            if matches!(self.0, 2 | 3 | 7 | 8) {
                column = last_column - column;
            }
            if matches!(self.0, 3 | 4 | 6 | 7) {
                row = last_row - row;
            }
            stored.row(row)[column as usize]
        })
        .map_err(damaged)
    }
}

/// Returns the value of the orientation entry, if there is one.
fn find(exif: &[u8]) -> Option<u16> {
    let tiff = Tiff::new(exif)?;
    tiff.short(tiff.entry(tiff.first()?, TAG)?)
}
