//! OpenEXR encoder for one part with scan lines, 32-bit floating point and lossless ZIP compression.

use super::{ExrPlane, check_size};
use crate::{ImageError, ImageErrorKind, file};
use exr::compression::Compression;
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image};
use exr::meta::attribute::{LineOrder, Text};
use std::io::Cursor;
use std::path::Path;

/// Maximum length of a channel name, in bytes, in a file with long names.
const NAME_LIMIT: usize = 255;

/// Encodes planes of the same size as an OpenEXR file in memory.
///
/// The bytes depend only on the planes. The order of the planes does not matter: the format sorts them by name.
///
/// # Errors
///
/// [`ImageErrorKind::PlaneName`] if a name is empty, not ASCII, too long or used twice,
/// [`ImageErrorKind::SizeMismatch`] if the planes have different sizes, [`ImageErrorKind::Empty`] if there is no plane,
/// [`ImageErrorKind::Unsupported`] if a side is too long for the format.
///
/// # Examples
///
/// ```
/// use dapple_image::{ExrPlane, Limits, decode_exr, encode_exr};
/// use dapple_raster::Raster;
///
/// let height = Raster::from_fn([4, 2], |x, y| x as f32 - 1000.0 * y as f32)?;
/// let bytes = encode_exr(&[ExrPlane::new("height", height.clone())])?;
/// assert_eq!(decode_exr(&bytes, &Limits::default())?.plane("height")?, &height);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn encode_exr(planes: &[ExrPlane]) -> Result<Vec<u8>, ImageError> {
    let Some(first) = planes.first() else {
        let size = [0, 0];
        return Err(ImageError::new(ImageErrorKind::Empty { size }));
    };
    let size = first.values.size();
    for (at, plane) in planes.iter().enumerate() {
        check_size(plane.values.size(), size)?;
        check_name(&plane.name, &planes[..at])?;
    }
    let channels = planes.iter().map(channel).collect();
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (size[0] as usize, size[1] as usize);
    let image = Image::from_encoded_channels(size, encoding, AnyChannels::sort(channels));
    let mut bytes = Vec::new();
    let written = image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes));
    written.map_err(|error| {
        let feature = "an OpenEXR image of this size";
        ImageError::new(ImageErrorKind::Unsupported { feature }).because(error)
    })?;
    Ok(bytes)
}

/// Writes planes of the same size to an OpenEXR file.
///
/// # Errors
///
/// Same as [`encode_exr`], plus [`ImageErrorKind::Io`] if the file cannot be written; in that case, an existing file
/// is unchanged.
pub fn write_exr(path: impl AsRef<Path>, planes: &[ExrPlane]) -> Result<(), ImageError> {
    let path = path.as_ref();
    let bytes = encode_exr(planes).map_err(|error| error.at(path))?;
    file::replace(path, &bytes)
}

fn check_name(name: &str, before: &[ExrPlane]) -> Result<(), ImageError> {
    let fits =
        (1..=NAME_LIMIT).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_graphic());
    if fits && before.iter().all(|other| other.name != name) {
        return Ok(());
    }
    let name = name.to_owned();
    Err(ImageError::new(ImageErrorKind::PlaneName { name }))
}

fn channel(plane: &ExrPlane) -> AnyChannel<FlatSamples> {
    // `check_name` has verified ASCII, so no byte is lost.
    let name = Text::from_slice_unchecked(plane.name.as_bytes());
    AnyChannel::new(name, FlatSamples::F32(plane.values.pixels().to_vec()))
}
