//! Parser for three-component ICC profiles with a matrix and curves.
//!
//! Reference: International Color Consortium, ICC.1:2022 "Image technology colour management: architecture, profile format
//! and data structure", sections 7 (header and tags), 8.3 (matrix profiles), 10.6 (`curv`), 10.18 (`para`) and 10.31
//! (`XYZ`).

use crate::color_space::{ColorSpace, Curve, Source};

/// Length of the profile header, in bytes.
const HEADER: usize = 128;

/// Returns the color space that an ICC profile describes.
pub(crate) fn color_space(profile: &[u8]) -> ColorSpace {
    let unknown = |name| ColorSpace::unknown(Source::Icc, name);
    if profile.get(36..40) != Some(b"acsp") {
        return unknown("a damaged ICC profile");
    }
    match profile.get(16..20) {
        Some(b"RGB ") => {}
        Some(b"GRAY") => return unknown("an ICC profile of gray in an image of color"),
        _ => return unknown("an ICC profile that is not of RGB"),
    }
    let has_tables = [b"A2B0", b"A2B1", b"A2B2"]
        .iter()
        .any(|name| tag(profile, name).is_some());
    if has_tables && tag(profile, b"rXYZ").is_none() {
        return unknown("an ICC profile with lookup tables");
    }
    if profile.get(20..24) != Some(b"XYZ ") {
        return unknown("an ICC profile that is not based on XYZ");
    }
    let columns = [b"rXYZ", b"gXYZ", b"bXYZ"].map(|name| tag(profile, name).and_then(xyz));
    let curves = [b"rTRC", b"gTRC", b"bTRC"].map(|name| tag(profile, name).and_then(curve));
    match (columns, curves) {
        ([Some(r), Some(g), Some(b)], [Some(red), Some(green), Some(blue)]) => {
            ColorSpace::from_columns([r, g, b], [red, green, blue])
        }
        _ => unknown("a damaged ICC profile"),
    }
}

/// Returns the data of the tag called `name`.
fn tag<'a>(profile: &'a [u8], name: &[u8; 4]) -> Option<&'a [u8]> {
    let n_tags = whole(profile, HEADER)?;
    let table = profile.get(HEADER + 4..)?;
    let mut entries = table.chunks_exact(12).take(n_tags);
    let entry = entries.find(|entry| entry.starts_with(name))?;
    let [start, length] = [whole(entry, 4)?, whole(entry, 8)?];
    profile.get(start..start.checked_add(length)?)
}

/// Returns the three numbers of a tag of type `XYZ`.
fn xyz(data: &[u8]) -> Option<[f64; 3]> {
    let numbers = data.strip_prefix(b"XYZ ")?;
    Some([fixed(numbers, 4)?, fixed(numbers, 8)?, fixed(numbers, 12)?])
}

/// Returns the curve of a tag of type `curv` or `para`.
fn curve(data: &[u8]) -> Option<Curve> {
    if data.starts_with(b"curv") {
        let count = whole(data, 8)?;
        let values = data.get(12..12_usize.checked_add(count.checked_mul(2)?)?)?;
        let values = values.chunks_exact(2);
        let mut values = values
            .map(|two| u16::from_be_bytes([two[0], two[1]]))
            .map(f64::from);
        return Some(match count {
            0 => Curve::Power(1.0),
            1 => Curve::Power(values.next().filter(|&gamma| gamma > 0.0)? / 256.0),
            _ => Curve::Table(values.map(|value| value / 65535.0).collect()),
        });
    }
    let data = data.strip_prefix(b"para")?;
    let kind = u16::from_be_bytes([*data.get(4)?, *data.get(5)?]);
    let number = |at: usize| fixed(data, 8 + 4 * at);
    let g = number(0).filter(|&g| g > 0.0)?;
    // Each kind is a special case of the last one, with the parameters g, a, b, c, d, e and f.
    let parametric = match kind {
        0 => return Some(Curve::Power(g)),
        1 => {
            let [a, b] = [number(1)?, number(2)?];
            [g, a, b, 0.0, -b / a, 0.0, 0.0]
        }
        2 => {
            let [a, b, c] = [number(1)?, number(2)?, number(3)?];
            [g, a, b, 0.0, -b / a, c, c]
        }
        3 => [g, number(1)?, number(2)?, number(3)?, number(4)?, 0.0, 0.0],
        4 => {
            let [a, b, c] = [number(1)?, number(2)?, number(3)?];
            [g, a, b, c, number(4)?, number(5)?, number(6)?]
        }
        _ => return None,
    };
    let is_finite = parametric.iter().all(|number| number.is_finite());
    is_finite.then_some(Curve::Parametric(parametric))
}

/// Reads a big-endian unsigned 32-bit integer at offset `at`.
fn whole(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..)?.first_chunk::<4>()?;
    usize::try_from(u32::from_be_bytes(*bytes)).ok()
}

/// Reads a signed fixed-point number with 16 fractional bits at offset `at`.
fn fixed(bytes: &[u8], at: usize) -> Option<f64> {
    let bytes = bytes.get(at..)?.first_chunk::<4>()?;
    Some(f64::from(i32::from_be_bytes(*bytes)) / 65536.0)
}
