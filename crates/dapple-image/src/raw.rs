//! Files of unencoded numbers (NumPy arrays and raw heights), written row by row and read as a whole.
//!
//! Reference: NumPy Developers, "A Simple File Format for NumPy Arrays" (`numpy.lib.format`), version 1.0. Raw
//! heights have no standard; the Unity and Unreal terrain importers call them RAW and r16. They are 16-bit codes,
//! little endian, top row first, without a header.

use crate::content::Pixel;
mod read;

pub use read::{decode_npy, decode_r16};

use crate::limits::check_side;
use crate::{ImageError, ImageErrorKind};
use dapple_color::Code;
use dapple_raster::RasterView;
use std::io::Write;

/// Alignment of the data in a NumPy file, in bytes.
const ALIGNMENT: usize = 64;
/// Length of the preamble: the magic string, the version 1.0, and the length of the header text.
const PREAMBLE: usize = 10;

/// A file of unencoded numbers that is written to a sink.
pub(crate) struct RawStream {
    /// Buffer for the bytes of a row.
    bytes: Vec<u8>,
}

impl RawStream {
    /// Starts a NumPy array of `f32` with the shape (height, width), or (height, width, channels) for several
    /// channels.
    pub(crate) fn npy(
        sink: &mut dyn Write,
        size: [u32; 2],
        n_channels: usize,
    ) -> Result<Self, ImageError> {
        check_side(size, u32::MAX, "a NumPy array")?;
        sink.write_all(&npy_header(size, n_channels))
            .map_err(failure)?;
        Ok(Self { bytes: Vec::new() })
    }

    /// Starts a file of heights as 16-bit codes, without a header.
    pub(crate) fn r16(size: [u32; 2]) -> Result<Self, ImageError> {
        check_side(size, u32::MAX, "raw heights")?;
        Ok(Self { bytes: Vec::new() })
    }

    /// Writes rows as `f32`.
    pub(crate) fn write_numbers<T: Pixel>(
        &mut self,
        sink: &mut dyn Write,
        rows: RasterView<'_, T>,
    ) -> Result<(), ImageError> {
        self.write_rows(sink, rows, |value, bytes| {
            for number in value.numbers().as_ref() {
                bytes.extend(number.to_le_bytes());
            }
        })
    }

    /// Writes rows as 16-bit codes.
    pub(crate) fn write_codes<T: Pixel>(
        &mut self,
        sink: &mut dyn Write,
        rows: RasterView<'_, T>,
    ) -> Result<(), ImageError> {
        self.write_rows(sink, rows, |value, bytes| {
            for &number in value.numbers().as_ref() {
                bytes.extend(u16::from_unit(number).to_le_bytes());
            }
        })
    }

    fn write_rows<T>(
        &mut self,
        sink: &mut dyn Write,
        rows: RasterView<'_, T>,
        put: impl Fn(&T, &mut Vec<u8>),
    ) -> Result<(), ImageError> {
        for row in rows.rows() {
            self.bytes.clear();
            for value in row {
                put(value, &mut self.bytes);
            }
            sink.write_all(&self.bytes).map_err(failure)?;
        }
        Ok(())
    }
}

/// Returns the header of an array in C order, padded with spaces to the alignment of the data.
fn npy_header([width, height]: [u32; 2], n_channels: usize) -> Vec<u8> {
    let shape = match n_channels {
        1 => format!("({height}, {width})"),
        _ => format!("({height}, {width}, {n_channels})"),
    };
    let mut text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (PREAMBLE + text.len() + 1).next_multiple_of(ALIGNMENT);
    text.extend(std::iter::repeat_n(' ', length - PREAMBLE - text.len() - 1));
    text.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    // The text is shorter than 128 bytes.
    header.extend((text.len() as u16).to_le_bytes());
    header.extend(text.into_bytes());
    header
}

fn failure(error: std::io::Error) -> ImageError {
    ImageError::new(ImageErrorKind::Io).because(error)
}
