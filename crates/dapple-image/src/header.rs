//! Reads the size and format of image files from their first bytes. The files may be larger than memory.
//!
//! Reference: PNG Specification, third edition (W3C, 2025), section 11.2.1; OpenEXR, "The OpenEXR File Layout".

use crate::{Format, ImageError, ImageErrorKind, Limits, file, read_image};
use std::io::Read;
use std::path::Path;

/// Length of a PNG file up to the end of its header, in bytes: the signature, the length and name of the chunk, and 13
/// bytes of content.
const PNG_HEADER: usize = 8 + 8 + 13;

/// Size and format of an image, without its pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageHeader {
    /// Name of the format, such as PNG or OpenEXR.
    pub format: &'static str,
    /// Width and height in pixels.
    pub size: [u64; 2],
    /// Bits per channel; `None` if the first bytes do not state it.
    pub bits: Option<u32>,
}

/// Reads an image file's size and format without its pixels. The file may exceed the limits for reading.
///
/// For PNG, only the header is read. Other formats are decoded with a limit of 0 pixels, so decoding stops once the
/// size is known.
///
/// # Errors
///
/// Same as [`read_image`](crate::read_image) except [`ImageErrorKind::TooManyPixels`].
pub fn read_header(path: impl AsRef<Path>) -> Result<ImageHeader, ImageError> {
    let path = path.as_ref();
    let io = |error| ImageError::new(ImageErrorKind::Io).because(error).at(path);
    let file = file::open_regular(path).map_err(io)?;
    let mut first = Vec::new();
    file.take(PNG_HEADER as u64)
        .read_to_end(&mut first)
        .map_err(io)?;
    let format = match Format::of(&first).map_err(|error| error.at(path))? {
        Format::Png => return png(&first).map_err(|error| error.at(path)),
        other => other.name(),
    };
    // With a limit of 0 pixels, decoding stops at the size.
    let limits = Limits {
        pixels: 0,
        ..Limits::default()
    };
    let Err(error) = read_image(path, &limits) else {
        return Err(ImageError::damaged(format, "it has no pixels").at(path));
    };
    match *error.kind() {
        ImageErrorKind::TooManyPixels { size, .. } => Ok(ImageHeader {
            format,
            size,
            bits: None,
        }),
        _ => Err(error),
    }
}

/// Parses the header of a PNG file.
fn png(first: &[u8]) -> Result<ImageHeader, ImageError> {
    let header = first.get(12..PNG_HEADER);
    let Some(header) = header.and_then(|header| header.strip_prefix(b"IHDR")) else {
        return Err(ImageError::damaged(
            "PNG",
            "it does not begin with a header",
        ));
    };
    let number = |digits: &[u8]| {
        let shifted = |number, &digit: &u8| number << 8 | u64::from(digit);
        digits.iter().fold(0, shifted)
    };
    let size = [number(&header[..4]), number(&header[4..8])];
    if size.contains(&0) {
        return Err(ImageError::new(ImageErrorKind::Empty { size }));
    }
    // Palette colors have 8 bits per channel.
    let bits = match header[9] {
        3 => 8,
        _ => header[8].into(),
    };
    Ok(ImageHeader {
        format: "PNG",
        size,
        bits: Some(bits),
    })
}
