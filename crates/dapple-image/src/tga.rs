//! TGA decoder: gray, color and palette images of 8 bits per channel, raw or run-length encoded.
//!
//! Reference: Truevision Inc., "Truevision TGA File Format Specification", version 2.0, 1991. The format has no
//! signature at its start, so a file is recognized by a header in which every field has a value that is read here.
//! Colors are sRGB, and alpha is not multiplied into them. Alpha is read if the header counts attribute bits. The
//! extension area of version 2.0 is ignored.

use crate::orientation::Orientation;
use crate::{ColorSpace, Format, ImageError, Limits, PngImage, PngPixels, Transfer};

/// Length of the header, in bytes.
const HEADER: usize = 18;

/// Kind of pixels: the image type of the header, without the flag for run-length encoding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Palette,
    Color,
    Gray,
}

/// Header of a file.
#[derive(Clone, Copy, Debug)]
struct Header {
    kind: Kind,
    is_run_length_encoded: bool,
    /// Offset of the palette, which follows the identification field.
    palette_start: usize,
    /// Index of the first palette entry.
    first_entry: usize,
    n_entries: usize,
    /// Bits per palette entry.
    entry_bits: u8,
    size: [u32; 2],
    /// Bits per pixel.
    bits: u8,
    has_alpha: bool,
    orientation: Orientation,
}

impl Header {
    /// Parses the header; `None` if a field has a value that no readable file has.
    fn new(bytes: &[u8]) -> Option<Self> {
        let header = bytes.first_chunk::<HEADER>()?;
        let short = |at: usize| u16::from_le_bytes([header[at], header[at + 1]]);
        let [has_palette, entry_bits, bits, descriptor] =
            [header[1], header[7], header[16], header[17]];
        let n_alpha_bits = descriptor & 15;
        let kind = match header[2] {
            1 | 9 => Kind::Palette,
            2 | 10 => Kind::Color,
            3 | 11 => Kind::Gray,
            _ => return None,
        };
        let is_valid = match kind {
            Kind::Palette => {
                has_palette == 1 && matches!(entry_bits, 15 | 16 | 24 | 32) && bits == 8
            }
            Kind::Color => matches!(bits, 15 | 16 | 24 | 32),
            Kind::Gray => bits == 8 || bits == 16 && n_alpha_bits == 8,
        };
        let size = [short(12), short(14)].map(u32::from);
        // The two highest bits of the descriptor select interleaved rows, which no program writes.
        if !is_valid
            || has_palette > 1
            || n_alpha_bits > 8
            || descriptor >> 6 != 0
            || size.contains(&0)
        {
            return None;
        }
        // Rows begin at the bottom unless bit 5 is set, and at the left unless bit 4 is set.
        let orientation = Orientation::new(match descriptor >> 4 & 3 {
            0 => 4,
            1 => 3,
            2 => 1,
            _ => 2,
        });
        Some(Self {
            kind,
            is_run_length_encoded: header[2] >= 8,
            palette_start: HEADER + usize::from(header[0]),
            first_entry: short(3).into(),
            n_entries: if has_palette == 1 { short(5).into() } else { 0 },
            entry_bits,
            size,
            bits,
            has_alpha: n_alpha_bits > 0,
            orientation,
        })
    }

    /// Returns the bytes per pixel in the file.
    fn pixel_bytes(&self) -> usize {
        usize::from(self.bits).div_ceil(8)
    }

    /// Returns the number of channels of the decoded image.
    fn n_channels(&self) -> usize {
        let color_bits = match self.kind {
            Kind::Gray => return self.pixel_bytes(),
            Kind::Palette => self.entry_bits,
            Kind::Color => self.bits,
        };
        // Colors of 15 and 24 bits have no alpha.
        3 + usize::from(self.has_alpha && matches!(color_bits, 16 | 32))
    }
}

/// Returns whether a file begins with the header of an image that is read here.
pub(crate) fn has_header(bytes: &[u8]) -> bool {
    Header::new(bytes).is_some()
}

/// Decodes a file that begins with a valid header.
pub(crate) fn decode(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    let header = Header::new(bytes).ok_or_else(|| damaged("the header ends too soon"))?;
    limits.check_pixels(header.size.map(u64::from))?;
    let n_pixels = header.size[0] as usize * header.size[1] as usize;
    let n_channels = header.n_channels();
    // The stored pixels, the codes, and the upright codes are in memory at the same time.
    limits.check_bytes((n_pixels * (header.pixel_bytes() + 2 * n_channels)) as u64)?;
    let entry_bytes = usize::from(header.entry_bits).div_ceil(8);
    let pixels_start = header.palette_start + header.n_entries * entry_bytes;
    let (Some(palette), Some(data)) = (
        bytes.get(header.palette_start..pixels_start),
        bytes.get(pixels_start..),
    ) else {
        return Err(damaged("the palette ends too soon"));
    };
    let length = n_pixels * header.pixel_bytes();
    let expanded;
    let pixels = if header.is_run_length_encoded {
        expanded = expand(data, header.pixel_bytes(), length)?;
        &expanded
    } else {
        data.get(..length)
            .ok_or_else(|| damaged("the pixels end too soon"))?
    };
    let mut codes = Vec::with_capacity(n_pixels * n_channels);
    for pixel in pixels.chunks_exact(header.pixel_bytes()) {
        let (pixel, bits) = match header.kind {
            Kind::Gray => {
                codes.extend_from_slice(pixel);
                continue;
            }
            Kind::Color => (pixel, header.bits),
            Kind::Palette => {
                let entry = usize::from(pixel[0]).checked_sub(header.first_entry);
                let entry = entry.and_then(|entry| palette.chunks_exact(entry_bytes).nth(entry));
                let entry = entry.ok_or_else(|| damaged("a pixel is outside the palette"))?;
                (entry, header.entry_bits)
            }
        };
        codes.extend_from_slice(&rgba(pixel, bits)[..n_channels]);
    }
    let stored = header.orientation.stored(header.size, Format::Tga);
    Ok(PngImage {
        pixels: PngPixels::from_codes8(stored, n_channels, &codes)?,
        transfer: Transfer::Srgb,
        space: ColorSpace::default(),
    })
}

/// Expands run-length encoded pixels to `length` bytes.
fn expand(mut data: &[u8], pixel_bytes: usize, length: usize) -> Result<Vec<u8>, ImageError> {
    let short = || damaged("the pixels end too soon");
    let mut pixels = Vec::new();
    while pixels.len() < length {
        let (&packet, rest) = data.split_first().ok_or_else(short)?;
        let n_pixels = usize::from(packet & 127) + 1;
        let is_run = packet > 127;
        // A run stores its pixel once.
        let n_stored = if is_run { 1 } else { n_pixels };
        let (stored, rest) = rest
            .split_at_checked(n_stored * pixel_bytes)
            .ok_or_else(short)?;
        for _ in 0..n_pixels / n_stored {
            pixels.extend_from_slice(stored);
        }
        data = rest;
    }
    if pixels.len() > length {
        return Err(damaged("a packet of pixels reaches beyond the image"));
    }
    Ok(pixels)
}

/// Converts a pixel of 15, 16, 24 or 32 bits, stored as blue, green, red and alpha, to four codes.
fn rgba(pixel: &[u8], bits: u8) -> [u8; 4] {
    if bits <= 16 {
        let number = u32::from(u16::from_le_bytes([pixel[0], pixel[1]]));
        // Scale five bits to eight, rounded to nearest.
        let channel = |shift: u32| (((number >> shift & 31) * 255 + 15) / 31) as u8;
        return [
            channel(10),
            channel(5),
            channel(0),
            (number >> 15) as u8 * 255,
        ];
    }
    [
        pixel[2],
        pixel[1],
        pixel[0],
        pixel.get(3).copied().unwrap_or(255),
    ]
}

fn damaged(reason: &'static str) -> ImageError {
    ImageError::damaged(Format::Tga.name(), reason)
}
