//! Decoder of OpenEXR: all flat parts, scan lines or tiles, 16- and 32-bit samples, and the largest of several
//! resolutions.
//!
//! A plane has the pixels of the display window, as the "Technical Introduction to OpenEXR" defines. Pixels of the
//! data window outside it are cropped, and pixels without data are 0.
//!
//! Deep data and subsampled channels are errors. The sizes of all parts are checked against the limits before memory
//! for the pixels is allocated. The codec has assertions that damaged bytes can reach; where a program unwinds on panic
//! (the default), they are caught here and become [`ImageErrorKind::Damaged`].

use super::{ExrImage, ExrPlane, layers};
use crate::error::guarded;
use crate::{Format, ImageError, ImageErrorKind, Limits};
use dapple_raster::Raster;
use exr::block::BlockIndex;
use exr::block::chunk::TileCoordinates;
use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::image::{AnyChannels, FlatSamples, Layer};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::{ChannelList, IntegerBounds, SampleType, Text};
use exr::meta::header::Header;
use exr::prelude::f16;
use std::io::Cursor;
use std::ops::Range;

/// Decodes the bytes of an OpenEXR file.
///
/// 16-bit floating-point samples convert to `f32` exactly; 32-bit integers convert to the nearest `f32`.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes lack the OpenEXR signature, [`ImageErrorKind::Damaged`] if they
/// violate the format's rules or end too soon, [`ImageErrorKind::Unsupported`] for deep data and subsampled channels,
/// [`ImageErrorKind::Windows`] if the data and display windows have no pixel in common,
/// [`ImageErrorKind::TooManyPixels`] or [`ImageErrorKind::TooManyBytes`] beyond a limit.
pub fn decode_exr(bytes: &[u8], limits: &Limits) -> Result<ExrImage, ImageError> {
    Format::Exr.check(bytes)?;
    guarded(Format::Exr, || decode(bytes, limits))
}

/// Decodes a region of the image in an OpenEXR file: `size` pixels starting at column and row `first` of the display
/// window. Only blocks that intersect this region are decompressed, and only the region counts against the limits.
///
/// # Errors
///
/// Same as [`decode_exr`], plus [`ImageErrorKind::Outside`] if the region extends beyond the image.
pub fn decode_exr_region(
    bytes: &[u8],
    first: [u32; 2],
    size: [u32; 2],
    limits: &Limits,
) -> Result<ExrImage, ImageError> {
    Format::Exr.check(bytes)?;
    guarded(Format::Exr, || decode_region(bytes, first, size, limits))
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
    let mut parts = image.layer_data;
    if let [layer] = parts.as_mut_slice() {
        // The name of a single part is not needed.
        layer.attributes.layer_name = None;
    }
    let display = image.attributes.display_window;
    let mut planes = Vec::new();
    for layer in parts {
        push_planes(layer, display, &mut planes)?;
    }
    Ok(with_planes(&meta.headers, planes))
}

fn decode_region(
    bytes: &[u8],
    first: [u32; 2],
    size: [u32; 2],
    limits: &Limits,
) -> Result<ExrImage, ImageError> {
    let reader = exr::block::read(Cursor::new(bytes), true).map_err(refusal)?;
    let headers = reader.headers().to_vec();
    let Some(display) = headers
        .first()
        .map(|of| of.shared_attributes.display_window)
    else {
        return Err(ImageError::damaged("OpenEXR", "it has no part"));
    };
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let image = [side(display.size.0), side(display.size.1)];
    if (0..2).any(|axis| u64::from(first[axis]) + u64::from(size[axis]) > image[axis].into()) {
        return Err(ImageError::new(ImageErrorKind::Outside {
            first,
            size,
            image,
        }));
    }
    limits.check_pixels(size.map(u64::from))?;
    let n_pixels = u64::from(size[0]) * u64::from(size[1]);
    let (mut parts, mut n_bytes) = (Vec::new(), 0_u64);
    // Check each part, and allocate its planes.
    for header in &headers {
        check_features(header)?;
        check_windows(
            header.data_window(),
            header.shared_attributes.display_window,
        )?;
        let n_channels = header.channels.list.len() as u64;
        n_bytes = n_bytes.saturating_add(n_pixels.saturating_mul(4 * n_channels));
        // Blocks are decompressed as a whole.
        limits.check_bytes(n_bytes.saturating_add(header.max_block_byte_size() as u64))?;
        let data = header.data_window().position;
        let corner =
            |at: u32, display: i32, data: i32| i64::from(at) + i64::from(display) - i64::from(data);
        parts.push(Part {
            first: [
                corner(first[0], display.position.0, data.0),
                corner(first[1], display.position.1, data.1),
            ],
            size,
            planes: vec![vec![0.0; n_pixels as usize]; header.channels.list.len()],
        });
    }
    // Decompress the blocks of the full resolution that intersect the region.
    let is_met = |_: &MetaData, tile: TileCoordinates, block: BlockIndex| {
        let corners = [block.pixel_position, block.pixel_size].map(|Vec2(x, y)| [x, y]);
        let is_whole = tile.level_index == Vec2(0, 0);
        is_whole && (0..2).all(|axis| !parts[block.layer].span(corners, axis).is_empty())
    };
    let blocks = reader.filter_chunks(true, is_met).map_err(refusal)?;
    let mut blocks = blocks.sequential_decompressor(true);
    while let Some(block) = blocks.decompress_next_block() {
        let block = block.map_err(refusal)?;
        let channels = &headers[block.index.layer].channels;
        for line in block.lines(channels) {
            parts[block.index.layer].put(line, channels)?;
        }
    }
    // Name the planes.
    let is_single = headers.len() == 1;
    let mut planes = Vec::new();
    for (header, part) in headers.iter().zip(parts) {
        let name_of_part = header.own_attributes.layer_name.as_ref();
        let name_of_part = name_of_part.filter(|_| !is_single);
        for (channel, values) in header.channels.list.iter().zip(part.planes) {
            let name = plane_name(name_of_part, &channel.name);
            let values = Raster::from_vec(size, values);
            let values = values.map_err(|error| ImageError::damaged("OpenEXR", error))?;
            planes.push(ExrPlane { name, values });
        }
    }
    Ok(with_planes(&headers, planes))
}

/// Pixels of a region that come from one part of a file.
struct Part {
    /// First column and row of the region, relative to the data window.
    first: [i64; 2],
    size: [u32; 2],
    /// Values of each channel; 0 where the file has no data.
    planes: Vec<Vec<f32>>,
}

impl Part {
    /// Returns the range of columns or rows of a block that are inside the region, relative to the data window.
    fn span(&self, [position, size]: [[usize; 2]; 2], axis: usize) -> Range<i64> {
        let (first, end) = (position[axis] as i64, (position[axis] + size[axis]) as i64);
        let last = self.first[axis] + i64::from(self.size[axis]);
        first.max(self.first[axis])..end.min(last)
    }

    /// Copies the samples of a scan line that are inside the region.
    fn put(&mut self, line: LineRef<'_>, channels: &ChannelList) -> Result<(), ImageError> {
        let at = line.location;
        let corners = [[at.position.0, at.position.1], [at.sample_count, 1]];
        let [columns, rows] = [0, 1].map(|axis| self.span(corners, axis));
        if columns.is_empty() || rows.is_empty() {
            return Ok(());
        }
        let skipped = (columns.start - at.position.0 as i64) as usize;
        let count = (columns.end - columns.start) as usize;
        let row = (rows.start - self.first[1]) as usize * self.size[0] as usize;
        let first = row + (columns.start - self.first[0]) as usize;
        let target = &mut self.planes[at.channel][first..first + count];
        match channels.list[at.channel].sample_type {
            SampleType::F32 => copy(target, line.read_samples::<f32>().skip(skipped), |value| {
                value
            }),
            SampleType::F16 => copy(target, line.read_samples().skip(skipped), f16::to_f32),
            SampleType::U32 => copy(target, line.read_samples().skip(skipped), |value: u32| {
                value as f32
            }),
        }
    }
}

/// Converts the samples of a scan line, and copies them to `target`.
fn copy<T>(
    target: &mut [f32],
    samples: impl Iterator<Item = exr::error::Result<T>>,
    value: impl Fn(T) -> f32,
) -> Result<(), ImageError> {
    for (target, sample) in target.iter_mut().zip(samples) {
        *target = value(sample.map_err(refusal)?);
    }
    Ok(())
}

/// Creates an image from planes, with the views and chromaticities of the headers.
fn with_planes(headers: &[Header], planes: Vec<ExrPlane>) -> ExrImage {
    let text = |text: &Text| text.to_string();
    let attributes = headers.iter().map(|header| &header.own_attributes);
    let listed = attributes
        .clone()
        .filter_map(|of| of.multi_view_names.as_ref());
    let of_parts = attributes.filter_map(|of| of.view_name.as_ref());
    let views = layers::views(listed.flatten().map(text), of_parts.map(text));
    let shared = headers.first().map(|header| &header.shared_attributes);
    let chromaticities = shared.and_then(|of| of.chromaticities).map(|of| {
        let points = [of.red, of.green, of.blue, of.white];
        points.map(|Vec2(x, y)| [x, y])
    });
    ExrImage {
        planes,
        views,
        chromaticities,
    }
}

/// Rejects deep data and subsampled channels.
fn check_features(header: &Header) -> Result<(), ImageError> {
    let unsupported = |feature| Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
    if header.deep {
        return unsupported("deep data");
    }
    let mut channels = header.channels.list.iter();
    if channels.any(|channel| channel.sampling.0 != 1 || channel.sampling.1 != 1) {
        return unsupported("an OpenEXR image with subsampled channels");
    }
    Ok(())
}

/// Rejects unsupported features and sizes above the limits, based on the headers alone.
fn check_headers(headers: &[Header], limits: &Limits) -> Result<(), ImageError> {
    let mut bytes = 0_u64;
    for header in headers {
        check_features(header)?;
        let list = &header.channels.list;
        let size = [header.layer_size.0 as u64, header.layer_size.1 as u64];
        limits.check_pixels(size)?;
        let display = header.shared_attributes.display_window;
        let shown = [display.size.0 as u64, display.size.1 as u64];
        limits.check_pixels(shown)?;
        check_windows(header.data_window(), display)?;
        let [pixels, shown] = [size, shown].map(|size| size[0].saturating_mul(size[1]));
        let pixels = pixels.max(shown);
        bytes = bytes.saturating_add(pixels.saturating_mul(4 * list.len() as u64));
        limits.check_bytes(bytes)?;
    }
    Ok(())
}

/// Checks that the data window and the display window overlap.
fn check_windows(data: IntegerBounds, display: IntegerBounds) -> Result<(), ImageError> {
    let corners = |window: IntegerBounds| {
        let Vec2(x, y) = window.position;
        let Vec2(width, height) = window.size;
        [i64::from(x), i64::from(y), width as i64, height as i64]
    };
    let (data, display) = (corners(data), corners(display));
    let is_apart = |axis: usize| {
        data[axis] + data[axis + 2] <= display[axis]
            || display[axis] + display[axis + 2] <= data[axis]
    };
    if is_apart(0) || is_apart(1) {
        return Err(ImageError::new(ImageErrorKind::Windows { data, display }));
    }
    Ok(())
}

/// Crops or pads the values of the data window to the display window. Pixels without data are 0.
fn shown(
    values: Vec<f32>,
    data: IntegerBounds,
    display: IntegerBounds,
) -> Result<Raster<f32>, ImageError> {
    // Sides in the format are at most 2^31. A side that did not fit would be reported by the raster below.
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let damaged = |error| ImageError::damaged("OpenEXR", error);
    let size = [side(display.size.0), side(display.size.1)];
    if data == display {
        return Raster::from_vec(size, values).map_err(damaged);
    }
    // Offset of the display window in the data, and the columns and rows of the intersection.
    let first = display.position - data.position;
    let [columns, rows] = [
        (first.0, display.size.0, data.size.0),
        (first.1, display.size.1, data.size.1),
    ]
    .map(|(first, shown, stored)| {
        let begin = first.min(0).unsigned_abs() as usize;
        let end = (stored as i64 - i64::from(first)).clamp(0, shown as i64) as usize;
        begin..end.max(begin)
    });
    let at = |first: i32, place: usize| (i64::from(first) + place as i64) as usize;
    let mut pixels = vec![0.0; display.size.0 * display.size.1];
    for row in rows {
        let line = at(first.1, row) * data.size.0;
        let from = line + at(first.0, columns.start)..line + at(first.0, columns.end);
        let to = row * display.size.0;
        pixels[to + columns.start..to + columns.end].copy_from_slice(&values[from]);
    }
    Raster::from_vec(size, pixels).map_err(damaged)
}

fn push_planes(
    layer: Layer<AnyChannels<FlatSamples>>,
    display: IntegerBounds,
    planes: &mut Vec<ExrPlane>,
) -> Result<(), ImageError> {
    let data = IntegerBounds::new(layer.attributes.layer_position, layer.size);
    let part = layer.attributes.layer_name;
    for channel in layer.channel_data.list {
        let name = plane_name(part.as_ref(), &channel.name);
        let values = match channel.sample_data {
            FlatSamples::F32(values) => values,
            FlatSamples::F16(values) => values.into_iter().map(|value| value.to_f32()).collect(),
            FlatSamples::U32(values) => values.into_iter().map(|value| value as f32).collect(),
        };
        let values = shown(values, data, display)?;
        planes.push(ExrPlane { name, values });
    }
    Ok(())
}

/// Returns the name of a plane: the channel, prefixed with the part if there are several parts.
fn plane_name(part: Option<&Text>, channel: &Text) -> String {
    match part {
        Some(part) => format!("{part}.{channel}"),
        None => channel.to_string(),
    }
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
