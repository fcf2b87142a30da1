//! Decoders for NumPy arrays and raw heights.
//!
//! Reference: NumPy Developers, "A Simple File Format for NumPy Arrays" (`numpy.lib.format`), versions 1 to 3. A file
//! has a magic string, the version, the length of the header, and the header as a Python dictionary. Little-endian
//! arrays of integers and floating-point numbers in C order are supported; the error for other arrays names the
//! feature.

use crate::{ImageError, ImageErrorKind, Limits};
use dapple_raster::Raster;

/// Name of the format in errors.
const NPY: &str = "NumPy";
/// Magic string of NumPy files.
const MAGIC: &[u8] = b"\x93NUMPY";
/// Maximum number of channels of an image.
const CHANNELS_MAX: usize = 4;

/// Function that decodes the bytes of an array element to `f32`.
type Number = fn(&[u8]) -> f32;

/// Decodes a NumPy array with the shape (height, width) or (height, width, channels), with at most four channels.
/// Returns one raster per channel. Values are exact, except that `f64` is rounded to `f32`.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes lack the magic string, [`ImageErrorKind::Damaged`] if their number
/// does not match the shape, [`ImageErrorKind::Unsupported`] for other shapes, orders and types,
/// [`ImageErrorKind::TooManyPixels`] or [`ImageErrorKind::Empty`] if the size is above the limit or zero.
///
/// # Examples
///
/// ```
/// use dapple_image::{Content, Encoding, Limits, RowWriter, decode_npy};
/// use dapple_raster::Raster;
/// use std::io::Cursor;
///
/// let heights = Raster::from_vec([2, 1], vec![0.25, -3.0])?;
/// let sink = Cursor::new(Vec::new());
/// let mut writer = RowWriter::new(sink, heights.size(), Content::Gray, Encoding::Npy)?;
/// writer.write_gray(heights.view())?;
/// let bytes = writer.finish()?.into_inner();
/// assert_eq!(decode_npy(&bytes, &Limits::default())?, [heights]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn decode_npy(bytes: &[u8], limits: &Limits) -> Result<Vec<Raster<f32>>, ImageError> {
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or_else(|| ImageError::new(ImageErrorKind::UnknownFormat))?;
    let too_short = || ImageError::damaged(NPY, "it ends within its header");
    let (header, data) = match *rest {
        [1, _, low, high, ref rest @ ..] => {
            rest.split_at_checked(u16::from_le_bytes([low, high]).into())
        }
        [2 | 3, _, a, b, c, d, ref rest @ ..] => {
            rest.split_at_checked(u32::from_le_bytes([a, b, c, d]) as usize)
        }
        _ => None,
    }
    .ok_or_else(too_short)?;
    let header = String::from_utf8_lossy(header);
    let value = |key| {
        value_of(&header, key)
            .ok_or_else(|| ImageError::damaged(NPY, format!("its header has no {key}")))
    };
    if value("fortran_order")? != "False" {
        let feature = "a NumPy array in Fortran order";
        return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
    }
    let (length, number) = number_of(value("descr")?)?;
    let ([height, width], n_channels) = shape_of(value("shape")?)?;
    limits.check_pixels([width, height])?;
    let n_numbers = (width * height).saturating_mul(n_channels as u64);
    let expected = n_numbers.saturating_mul(length as u64);
    limits.check_bytes(n_numbers.saturating_mul(4))?;
    if data.len() as u64 != expected {
        let why = format!(
            "it has {} bytes of numbers, and its shape needs {expected}",
            data.len()
        );
        return Err(ImageError::damaged(NPY, why));
    }
    let numbers: Vec<f32> = data.chunks_exact(length).map(number).collect();
    // A side has at most as many pixels as the limit for the image, and the raster rejects sides above `u32`.
    let size = [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let channel = |channel| {
        let numbers = numbers.iter().skip(channel).step_by(n_channels).copied();
        Raster::from_vec(size, numbers.collect())
    };
    let channels: Result<_, _> = (0..n_channels).map(channel).collect();
    channels.map_err(|error| ImageError::damaged(NPY, error))
}

/// Decodes raw heights: 16-bit codes, little endian, top row first. The size is not part of the file.
///
/// # Errors
///
/// [`ImageErrorKind::Damaged`] if the number of bytes does not match the size, [`ImageErrorKind::TooManyPixels`] or
/// [`ImageErrorKind::Empty`] if the size is above the limit or zero.
pub fn decode_r16(
    bytes: &[u8],
    size: [u32; 2],
    limits: &Limits,
) -> Result<Raster<u16>, ImageError> {
    limits.check_pixels(size.map(u64::from))?;
    let expected = 2 * u64::from(size[0]) * u64::from(size[1]);
    if bytes.len() as u64 != expected {
        let why = format!(
            "it has {} bytes, and {} × {} heights have {expected}",
            bytes.len(),
            size[0],
            size[1]
        );
        return Err(ImageError::damaged("raw", why));
    }
    let code = |bytes: &[u8]| u16::from_le_bytes([bytes[0], bytes[1]]);
    Raster::from_vec(size, bytes.chunks_exact(2).map(code).collect())
        .map_err(|error| ImageError::damaged("raw", error))
}

/// Returns the text of the value for `key` in the header of a NumPy file, a Python dictionary with three keys.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let at = ['\'', '"']
        .iter()
        .find_map(|quote| header.find(&format!("{quote}{key}{quote}")))?;
    let (_, value) = header[at..].split_once(':')?;
    let value = value.trim_start();
    let end = match value.chars().next()? {
        '(' => value.find(')')? + 1,
        quote @ ('\'' | '"') => value[1..].find(quote)? + 2,
        _ => value.find([',', '}'])?,
    };
    Some(value[..end].trim())
}

/// Returns the size in bytes of an array element of type `descr`, and the function that decodes it.
fn number_of(descr: &str) -> Result<(usize, Number), ImageError> {
    let feature = match descr.trim_matches(['\'', '"']) {
        "<f4" => return Ok((4, |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
        "<f8" => {
            return Ok((8, |b| {
                f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]) as f32
            }));
        }
        "|u1" => return Ok((1, |b| b[0].into())),
        "<u2" => return Ok((2, |b| u16::from_le_bytes([b[0], b[1]]).into())),
        descr if descr.starts_with('>') => "a NumPy array in big endian",
        _ => "a NumPy array of other numbers than f4, f8, u1 and u2",
    };
    Err(ImageError::new(ImageErrorKind::Unsupported { feature }))
}

/// Parses a shape into height and width, and the number of channels.
fn shape_of(shape: &str) -> Result<([u64; 2], usize), ImageError> {
    let sides = shape.trim_matches(['(', ')']).split(',').map(str::trim);
    let sides = sides.filter(|side| !side.is_empty()).map(str::parse);
    let sides: Result<Vec<u64>, _> = sides.collect();
    match sides.map_err(|_| ImageError::damaged(NPY, format!("{shape} is no shape")))?[..] {
        [height, width] => Ok(([height, width], 1)),
        [height, width, channels] if (1..=CHANNELS_MAX as u64).contains(&channels) => {
            Ok(([height, width], channels as usize))
        }
        _ => {
            let feature = "a NumPy array that is not (height, width) or (height, width, 1 to 4)";
            Err(ImageError::new(ImageErrorKind::Unsupported { feature }))
        }
    }
}
