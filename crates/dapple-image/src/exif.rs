//! Parser for Exif data: a TIFF file without pixels, whose directories contain numbered entries.
//!
//! Reference: "Exchangeable image file format for digital still cameras: Exif Version 2.32", CIPA DC-008, 2019.
//! Damaged data is treated as missing.

use crate::color_space::{ADOBE_GAMMA, ADOBE_RGB, ColorSpace, Curve, Source};
use crate::orientation::Orientation;

/// Length of a directory entry, in bytes.
const ENTRY: usize = 12;

/// Tag of the orientation.
const ORIENTATION: u16 = 274;

/// Tag of the offset of the Exif directory.
const EXIF: u16 = 0x8769;

/// Tag of the color space: 1 is sRGB, 65535 is uncalibrated, and some cameras write 2 for Adobe RGB.
const COLOR_SPACE: u16 = 0xa001;

/// Tag of the offset of the interoperability directory. Its first entry names a rule: `R03` is Adobe RGB ("Design rule
/// for Camera File system", DCF 2.0).
const INTEROPERABILITY: u16 = 0xa005;

/// Returns the color space that a photograph's Exif data declares.
pub(crate) fn color_space(exif: &[u8]) -> ColorSpace {
    let is_adobe = || {
        let tiff = Tiff::new(exif)?;
        let directory = tiff.place(tiff.first()?, EXIF)?;
        let space = tiff.short(tiff.entry(directory, COLOR_SPACE)?)?;
        let rule = || {
            let rules = tiff.place(directory, INTEROPERABILITY)?;
            let entry = tiff.entry(rules, 1)?;
            exif.get(entry..entry + 3)
        };
        Some((
            space,
            space == 2 || space == u16::MAX && rule() == Some(b"R03"),
        ))
    };
    match is_adobe() {
        Some((_, true)) => {
            ColorSpace::from_primaries(Source::Exif, ADOBE_RGB, Curve::Power(ADOBE_GAMMA))
        }
        Some((1, false)) => ColorSpace::srgb(Source::Exif),
        _ => ColorSpace::default(),
    }
}

/// Returns the orientation of a photograph. `exif` starts with the TIFF header.
pub(crate) fn orientation(exif: &[u8]) -> Orientation {
    let find = || {
        let tiff = Tiff::new(exif)?;
        tiff.short(tiff.entry(tiff.first()?, ORIENTATION)?)
    };
    Orientation::new(find().unwrap_or_default())
}

/// Exif bytes, starting at the TIFF header.
struct Tiff<'a> {
    bytes: &'a [u8],
    is_little: bool,
}

impl<'a> Tiff<'a> {
    fn new(bytes: &'a [u8]) -> Option<Self> {
        let is_little = match bytes.get(..2)? {
            b"II" => true,
            b"MM" => false,
            _ => return None,
        };
        Some(Self { bytes, is_little })
    }

    /// Returns the 16-bit integer at offset `at`.
    fn short(&self, at: usize) -> Option<u16> {
        let bytes = self.bytes.get(at..)?.first_chunk::<2>()?;
        Some(if self.is_little {
            u16::from_le_bytes(*bytes)
        } else {
            u16::from_be_bytes(*bytes)
        })
    }

    fn long(&self, at: usize) -> Option<usize> {
        let [first, second] = [self.short(at)?, self.short(at.checked_add(2)?)?].map(usize::from);
        Some(if self.is_little {
            first | second << 16
        } else {
            first << 16 | second
        })
    }

    /// Returns the offset of the first directory.
    fn first(&self) -> Option<usize> {
        self.long(4)
    }

    /// Returns the offset of the directory that an entry of `directory` points to.
    fn place(&self, directory: usize, tag: u16) -> Option<usize> {
        self.long(self.entry(directory, tag)?)
    }

    /// Returns the offset of an entry's value. Values of at most four bytes are stored in the entry itself.
    fn entry(&self, directory: usize, tag: u16) -> Option<usize> {
        let n_entries = self.short(directory)?;
        let entries = (0..usize::from(n_entries)).map(|entry| directory + 2 + ENTRY * entry);
        // The value follows the tag, type and count.
        entries
            .take_while(|&at| at < self.bytes.len())
            .find(|&at| self.short(at) == Some(tag))
            .map(|at| at + 8)
    }
}
