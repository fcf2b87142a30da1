//! Pictures as pages show them: 8 bits of red, green, blue and alpha.

use dapple::color::{Code as _, LinearRgb, Normal};
use dapple::raster::{Raster, parallel};
use dapple::recipe::{self, MapKind, MapRows};

/// The content of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Shown {
    /// A map of the material.
    Map(MapKind),
    /// The node that was asked for.
    Node,
    /// A lit preview.
    Preview,
    /// The node of this index, small.
    Thumbnail(u16),
    /// The built-in recipe of this index.
    Builtin(u16),
    /// The recipe of the folder with this index.
    File(u16),
    /// The picture of this index in the strip that was asked for last.
    Strip(u16),
}

impl Shown {
    /// The number that stands for this content in messages.
    #[must_use]
    pub fn code(self) -> u16 {
        match self {
            Self::Map(kind) => MapKind::ALL
                .iter()
                .position(|other| *other == kind)
                .unwrap_or(0) as u16,
            Self::Node => 100,
            Self::Preview => 101,
            // The numbers of thumbnails end before those of recipes.
            Self::Thumbnail(index) => 200 + index.min(799),
            Self::Builtin(index) => 1000 + index.min(999),
            Self::File(index) => 2000 + index.min(999),
            Self::Strip(index) => 3000 + index.min(999),
        }
    }
}

/// A part of a picture, with 4 bytes for each pixel: red, green, blue and alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Counts the states of the recipe and the view that were drawn.
    pub generation: u32,
    /// The content of the picture.
    pub shown: Shown,
    /// The first column and row of the part.
    pub first: [u32; 2],
    /// Its columns and rows.
    pub size: [u32; 2],
    /// How many times smaller the picture is than was asked for.
    pub scale: u16,
    /// Whether a larger one follows.
    pub is_draft: bool,
    /// Whether it is the last part.
    pub is_last: bool,
    /// The pixels, row by row from the top.
    pub pixels: Vec<u8>,
}

/// The version of the header of pictures.
const VERSION: u32 = 1;
/// The bytes of the header.
const HEADER: usize = 32;

impl Picture {
    /// The picture as a message: a header of 32 bytes, then the pixels. Numbers are little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + self.pixels.len());
        let flags = u16::from(self.is_draft) | u16::from(self.is_last) << 1;
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.generation.to_le_bytes());
        bytes.extend(self.shown.code().to_le_bytes());
        // RGBA with 8 bits is the only format yet.
        bytes.extend(0_u16.to_le_bytes());
        for number in self.first.into_iter().chain(self.size) {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(self.scale.to_le_bytes());
        bytes.extend(flags.to_le_bytes());
        bytes.extend(&self.pixels);
        bytes
    }
}

/// The pixels of some rows of a map, with the codes that a PNG file of 8 bits has.
#[must_use]
pub fn rgba(rows: &MapRows) -> Vec<u8> {
    match rows {
        MapRows::Gray(raster) => pixels(raster, |&value| [u8::from_unit(value); 3]),
        MapRows::Color(raster) => of_colors(raster),
        MapRows::Normal(raster) => pixels(raster, |normal: &Normal| normal.to_codes()),
        MapRows::Packed(raster) => pixels(raster, |parts| parts.map(u8::from_unit)),
    }
}

/// The pixels of colors, as sRGB.
pub(crate) fn of_colors(raster: &Raster<LinearRgb>) -> Vec<u8> {
    pixels(raster, |color| color.to_srgb())
}

/// The pixels of numbers, of which a range is spread from black to white.
fn of_numbers(raster: &Raster<f32>, [min, max]: [f32; 2]) -> Vec<u8> {
    let width = if max > min { max - min } else { 1.0 };
    pixels(raster, |&value| [u8::from_unit((value - min) / width); 3])
}

/// The pixels of a node, and the numbers that are black and white in it.
pub(crate) fn of_values(values: &recipe::Picture) -> (Vec<u8>, Option<[f32; 2]>) {
    match values {
        recipe::Picture::Colors(colors) => (of_colors(colors), None),
        recipe::Picture::Numbers(numbers) => {
            let range = range_of(numbers);
            (of_numbers(numbers, range), Some(range))
        }
    }
}

/// From 0 to 1 where all numbers lie there and take up some of it, and from the smallest to the largest otherwise.
fn range_of(numbers: &Raster<f32>) -> [f32; 2] {
    let finite = numbers
        .pixels()
        .iter()
        .copied()
        .filter(|number| number.is_finite());
    let [min, max] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[min, max], number| {
        [min.min(number), max.max(number)]
    });
    if min > max || (min >= 0.0 && max <= 1.0 && max - min >= 0.25) || min == max {
        return if (0.0..=1.0).contains(&min) || min > max {
            [0.0, 1.0]
        } else {
            [min, max]
        };
    }
    [min, max]
}

/// The pixels that a thread takes at a time.
const CHUNK: usize = 1 << 15;

fn pixels<T: Sync>(raster: &Raster<T>, code: impl Fn(&T) -> [u8; 3] + Sync) -> Vec<u8> {
    let mut bytes = vec![255; 4 * raster.pixels().len()];
    let chunks = raster
        .pixels()
        .chunks(CHUNK)
        .zip(bytes.chunks_mut(4 * CHUNK));
    parallel::map_mut_at_least(1, &mut chunks.collect::<Vec<_>>(), |_, (values, bytes)| {
        for (value, pixel) in values.iter().zip(bytes.chunks_exact_mut(4)) {
            pixel[..3].copy_from_slice(&code(value));
        }
    });
    bytes
}
