//! Reading OpenEXR: all flat parts, scan lines or tiles, 16- and 32-bit numbers; of several resolutions the largest.
//!
//! Deep data and subsampled channels are errors. The sizes of all parts are checked against the limits before memory
//! for the pixels is allocated. The codec has assertions that damaged bytes can reach; where a program unwinds on panic
//! (the default), they are caught here and become [`ImageErrorKind::Damaged`].

use super::{ExrImage, ExrPlane};
use crate::image::EXR_SIGNATURE as SIGNATURE;
use crate::{ImageError, ImageErrorKind, Limits};
use dapple_raster::Raster;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::image::{AnyChannels, FlatSamples, Layer};
use exr::meta::MetaData;
use exr::meta::header::Header;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The image in the bytes of an OpenEXR file.
///
/// 16-bit numbers become the same `f32`, 32-bit whole numbers the nearest one.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes do not begin like OpenEXR, [`ImageErrorKind::Damaged`] if they break its
/// rules or end too soon, [`ImageErrorKind::Unsupported`] for deep data and subsampled channels,
/// [`ImageErrorKind::TooManyPixels`] or [`ImageErrorKind::TooManyBytes`] past a limit.
pub fn decode_exr(bytes: &[u8], limits: &Limits) -> Result<ExrImage, ImageError> {
    if !bytes.starts_with(&SIGNATURE) {
        return Err(ImageError::new(ImageErrorKind::UnknownFormat));
    }
    // No data that a panic could leave half done outlives the call.
    catch_unwind(AssertUnwindSafe(|| decode(bytes, limits)))
        .unwrap_or_else(|_| Err(ImageError::damaged("OpenEXR", "the codec gave up")))
}

fn decode(bytes: &[u8], limits: &Limits) -> Result<ExrImage, ImageError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), true).map_err(refusal)?;
    check_headers(&meta.headers, limits)?;
    let image = exr::image::read::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .pedantic()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(refusal)?;
    let mut layers = image.layer_data;
    if let [layer] = layers.as_mut_slice() {
        // A single part needs no name to be distinguished.
        layer.attributes.layer_name = None;
    }
    let mut planes = Vec::new();
    for layer in layers {
        push_planes(layer, &mut planes)?;
    }
    Ok(ExrImage { planes })
}

/// Checks for unsupported features and sizes past the limits, by the headers alone.
fn check_headers(headers: &[Header], limits: &Limits) -> Result<(), ImageError> {
    let mut bytes = 0_u64;
    for header in headers {
        let unsupported = |feature| Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
        if header.deep {
            return unsupported("deep data");
        }
        let list = &header.channels.list;
        if list
            .iter()
            .any(|channel| channel.sampling.0 != 1 || channel.sampling.1 != 1)
        {
            return unsupported("an OpenEXR image with subsampled channels");
        }
        let size = [header.layer_size.0 as u64, header.layer_size.1 as u64];
        limits.check_pixels(size)?;
        let pixels = size[0].saturating_mul(size[1]);
        bytes = bytes.saturating_add(pixels.saturating_mul(4 * list.len() as u64));
        limits.check_bytes(bytes)?;
    }
    Ok(())
}

fn push_planes(
    layer: Layer<AnyChannels<FlatSamples>>,
    planes: &mut Vec<ExrPlane>,
) -> Result<(), ImageError> {
    // The format has no side past 2^31; if one did not fit, the raster below would report the length.
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let size = [side(layer.size.0), side(layer.size.1)];
    let part = layer.attributes.layer_name.map(|name| name.to_string());
    for channel in layer.channel_data.list {
        let name = match &part {
            Some(part) => format!("{part}.{}", channel.name),
            None => channel.name.to_string(),
        };
        let values = match channel.sample_data {
            FlatSamples::F32(values) => values,
            FlatSamples::F16(values) => values.into_iter().map(|value| value.to_f32()).collect(),
            FlatSamples::U32(values) => values.into_iter().map(|value| value as f32).collect(),
        };
        let values = Raster::from_vec(size, values)
            .map_err(|error| ImageError::damaged("OpenEXR", error))?;
        planes.push(ExrPlane { name, values });
    }
    Ok(())
}

fn refusal(error: exr::error::Error) -> ImageError {
    match error {
        exr::error::Error::NotSupported(_) => {
            let feature = "a feature of this OpenEXR file";
            ImageError::new(ImageErrorKind::Unsupported { feature }).because(error)
        }
        _ => ImageError::damaged("OpenEXR", error),
    }
}
