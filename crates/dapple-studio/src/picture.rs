//! Images for pages, with 8 bits each of red, green, blue and alpha.

use dapple::color::{Code as _, LinearRgb, Normal};
use dapple::raster::{Raster, parallel};
use dapple::recipe::{self, MapKind, MapRows};

/// The content of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Shown {
    /// A map of the material.
    Map(MapKind),
    /// The node of the view.
    Node,
    /// A lit preview.
    Preview,
    /// The thumbnail of the node with this index.
    Thumbnail(u16),
    /// The thumbnail of the built-in recipe with this index.
    Builtin(u16),
    /// The thumbnail of the recipe in the folder with this index.
    File(u16),
    /// The thumbnail with this index in the strip that was requested last.
    Strip(u16),
}

impl Shown {
    /// Returns the code that stands for this content in messages.
    #[must_use]
    pub fn code(self) -> u16 {
        match self {
            Self::Map(kind) => MapKind::ALL
                .iter()
                .position(|other| *other == kind)
                .unwrap_or(0) as u16,
            Self::Node => 100,
            Self::Preview => 101,
            // Codes of node thumbnails end below 1000, where codes of recipes begin.
            Self::Thumbnail(index) => 200 + index.min(799),
            Self::Builtin(index) => 1000 + index.min(999),
            Self::File(index) => 2000 + index.min(999),
            Self::Strip(index) => 3000 + index.min(999),
        }
    }
}

/// A part of an image, with 4 bytes per pixel: red, green, blue and alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The generation, which counts the rendered states of recipe and view.
    pub generation: u32,
    /// The content of the image.
    pub shown: Shown,
    /// The first column and row of the part.
    pub first: [u32; 2],
    /// Columns and rows of the part.
    pub size: [u32; 2],
    /// Factor by which the image is smaller than the requested size.
    pub scale: u16,
    /// Whether the image is a draft that will be followed by a larger image.
    pub is_draft: bool,
    /// Whether this is the last part.
    pub is_last: bool,
    /// The pixels, row by row, starting at the top.
    pub pixels: Vec<u8>,
}

/// Version of the header.
const VERSION: u32 = 1;
/// Length of the header in bytes.
const HEADER: usize = 32;

impl Picture {
    /// Creates an image in one part, in the requested size, with generation 0.
    pub(crate) fn whole(shown: Shown, size: [u32; 2], pixels: Vec<u8>) -> Self {
        Self {
            generation: 0,
            shown,
            first: [0; 2],
            size,
            scale: 1,
            is_draft: false,
            is_last: true,
            pixels,
        }
    }

    /// Encodes the image as a message: a header of 32 bytes, followed by the pixels. Numbers are little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = self.header(0, self.pixels.len());
        bytes.extend(&self.pixels);
        bytes
    }

    /// Encodes the image as a message with one byte per pixel for gray maps and three bytes otherwise. Alpha is
    /// omitted, since it is always 255.
    #[cfg(feature = "server")]
    pub(crate) fn to_short_bytes(&self) -> Vec<u8> {
        let n_pixels = self.pixels.len() / 4;
        let pixels = self.pixels.as_chunks::<4>().0.iter();
        if self.is_gray() {
            let mut bytes = self.header(2, n_pixels);
            bytes.extend(pixels.map(|&[gray, ..]| gray));
            return bytes;
        }
        let mut bytes = self.header(1, 3 * n_pixels);
        bytes.resize(HEADER + 3 * n_pixels, 0);
        let places = bytes[HEADER..].as_chunks_mut::<3>().0.iter_mut();
        for (place, &[red, green, blue, _]) in places.zip(pixels) {
            *place = [red, green, blue];
        }
        bytes
    }

    /// Returns whether all pixels are gray, which holds for maps of numbers.
    #[cfg(feature = "server")]
    fn is_gray(&self) -> bool {
        matches!(
            self.shown,
            Shown::Map(
                MapKind::Height
                    | MapKind::Occlusion
                    | MapKind::Curvature
                    | MapKind::Roughness
                    | MapKind::Metallic
                    | MapKind::Opacity
                    | MapKind::Specular
                    | MapKind::Clearcoat
            )
        )
    }

    /// Returns the header, with capacity for the pixels of this format.
    ///
    /// Byte offsets: 0 version, 4 generation, 8 content code, 10 format (0 with alpha, 1 without, 2 gray), 12 first
    /// column, 16 first row, 20 columns, 24 rows, 28 scale, 30 flags (1 draft, 2 last part).
    fn header(&self, format: u16, n_bytes: usize) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + n_bytes);
        let flags = u16::from(self.is_draft) | u16::from(self.is_last) << 1;
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.generation.to_le_bytes());
        bytes.extend(self.shown.code().to_le_bytes());
        bytes.extend(format.to_le_bytes());
        for number in self.first.into_iter().chain(self.size) {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(self.scale.to_le_bytes());
        bytes.extend(flags.to_le_bytes());
        bytes
    }
}

/// Converts rows of a map to pixels, with the same values as an 8-bit PNG file.
#[must_use]
pub fn rgba(rows: &MapRows) -> Vec<u8> {
    match rows {
        MapRows::Gray(raster) => pixels(raster, |&value| [u8::from_unit(value); 3]),
        MapRows::Color(raster) => of_colors(raster),
        MapRows::Normal(raster) => pixels(raster, |normal: &Normal| normal.to_codes()),
        MapRows::Packed(raster) => pixels(raster, |parts| parts.map(u8::from_unit)),
    }
}

/// Converts colors to sRGB pixels.
pub(crate) fn of_colors(raster: &Raster<LinearRgb>) -> Vec<u8> {
    pixels(raster, |color| color.to_srgb())
}

/// Converts numbers to gray pixels. `min` is black and `max` is white.
fn of_numbers(raster: &Raster<f32>, [min, max]: [f32; 2]) -> Vec<u8> {
    let width = if max > min { max - min } else { 1.0 };
    pixels(raster, |&value| [u8::from_unit((value - min) / width); 3])
}

/// Converts the values of a node to pixels. For numbers, also returns the values that black and white stand for.
pub(crate) fn of_values(values: &recipe::Picture) -> (Vec<u8>, Option<[f32; 2]>) {
    match values {
        recipe::Picture::Colors(colors) => (of_colors(colors), None),
        recipe::Picture::Numbers(numbers) => {
            let range = range_of(numbers);
            (of_numbers(numbers, range), Some(range))
        }
    }
}

/// Returns the values that black and white stand for. They are 0 and 1 if all numbers are in this range, and are equal
/// or span at least a quarter of it. Otherwise, they are the minimum and maximum of the finite numbers.
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

/// Number of pixels per parallel task.
const CHUNK: usize = 1 << 12;

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

#[cfg(all(test, feature = "server"))]
mod tests {
    use super::{HEADER, MapKind, Picture, Shown};

    #[test]
    fn short_messages_have_all_bytes_that_differ() {
        let picture = |shown, pixels: &[u8]| Picture::whole(shown, [2, 1], pixels.to_vec());
        let cases = [
            (
                picture(Shown::Map(MapKind::Height), &[7, 7, 7, 255, 9, 9, 9, 255]),
                2,
                &[7, 9][..],
            ),
            (
                picture(Shown::Map(MapKind::Normal), &[1, 2, 3, 255, 4, 5, 6, 255]),
                1,
                &[1, 2, 3, 4, 5, 6],
            ),
            (
                picture(Shown::Node, &[8, 8, 8, 255, 4, 5, 6, 255]),
                1,
                &[8, 8, 8, 4, 5, 6],
            ),
        ];
        for (picture, format, pixels) in cases {
            let (long, short) = (picture.to_bytes(), picture.to_short_bytes());
            assert_eq!(&short[HEADER..], pixels);
            assert_eq!([short[10], short[11]], [format, 0]);
            assert_eq!(
                (&short[..10], &short[12..HEADER]),
                (&long[..10], &long[12..HEADER])
            );
        }
    }
}
