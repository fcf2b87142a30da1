//! Radiance HDR decoder: pixels of three 8-bit mantissas with a shared exponent, raw or run-length encoded.
//!
//! References: Greg Ward, "Real Pixels", Graphics Gems II, 1991; "The RADIANCE Picture File Format", in the reference
//! manual of Radiance, <https://www.radiance-online.org>. A value is `mantissa · 2^(exponent - 136)`, as most programs
//! read it; Radiance itself adds half a step to the mantissa. Every value is an exact `f32`.
//!
//! Colors are linear, with the primaries that the header declares, or ITU-R BT.709. Pixels of XYZ are converted.
//! `EXPOSURE` is ignored: values are not divided by it.

use crate::exr::{ExrImage, ExrPlane};
use crate::orientation::Orientation;
use crate::{Format, ImageError, ImageErrorKind, Limits};

/// Chromaticities of the three stimuli X, Y and Z, and of white with equal parts of each.
const XYZ: [[f32; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]];

/// Lengths of scan lines that may be encoded channel by channel.
const BY_CHANNEL: core::ops::RangeInclusive<usize> = 8..=32_767;

/// Returns whether a file begins like a Radiance HDR file.
pub(crate) fn has_signature(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#?RADIANCE") || bytes.starts_with(b"#?RGBE")
}

/// Header of a file.
struct Header {
    /// Pixels per scan line, and number of scan lines.
    size: [u32; 2],
    orientation: Orientation,
    chromaticities: Option<[[f32; 2]; 4]>,
}

/// Decodes a file with a Radiance HDR signature.
pub(crate) fn decode(bytes: &[u8], limits: &Limits) -> Result<ExrImage, ImageError> {
    let mut data = bytes;
    let Header {
        size,
        orientation,
        chromaticities,
    } = header(&mut data)?;
    limits.check_pixels(size.map(u64::from))?;
    // A pixel is four bytes, then three values of four bytes, then three upright values.
    limits.check_bytes(28 * u64::from(size[0]) * u64::from(size[1]))?;
    let mut samples = Vec::new();
    let mut line = Vec::new();
    for _ in 0..size[1] {
        scan_line(&mut data, size[0] as usize, &mut line)?;
        samples.extend(line.iter().flat_map(|&pixel| values(pixel)));
    }
    Ok(ExrImage {
        planes: ExrPlane::from_samples(orientation.stored(size, Format::Hdr), 3, &samples)?,
        views: Vec::new(),
        chromaticities,
    })
}

/// Reads the header: lines of text, an empty line, and the line of the resolution.
fn header(data: &mut &[u8]) -> Result<Header, ImageError> {
    let mut chromaticities = None;
    loop {
        let line = text_line(data)?;
        if line.is_empty() {
            break;
        }
        if let Some(name) = line.strip_prefix("FORMAT=") {
            match name.trim() {
                "32-bit_rle_rgbe" => {}
                "32-bit_rle_xyze" => chromaticities = Some(XYZ),
                _ => {
                    let feature = "Radiance HDR with pixels other than RGBE and XYZE";
                    return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
                }
            }
        } else if let Some(numbers) = line.strip_prefix("PRIMARIES=") {
            let numbers = numbers.split_ascii_whitespace().map(str::parse);
            let numbers: Result<Vec<f32>, _> = numbers.collect();
            let [rx, ry, gx, gy, bx, by, wx, wy] = *numbers.unwrap_or_default() else {
                return Err(damaged("PRIMARIES are not eight numbers"));
            };
            chromaticities = Some([[rx, ry], [gx, gy], [bx, by], [wx, wy]]);
        }
    }
    let line = text_line(data)?;
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    // The first axis numbers the scan lines, the second one the pixels of each.
    let (orientation, n_lines, length) = match *words {
        ["-Y", lines, "+X", length] => (1, lines, length),
        ["-Y", lines, "-X", length] => (2, lines, length),
        ["+Y", lines, "-X", length] => (3, lines, length),
        ["+Y", lines, "+X", length] => (4, lines, length),
        ["+X", lines, "-Y", length] => (5, lines, length),
        ["-X", lines, "-Y", length] => (6, lines, length),
        ["-X", lines, "+Y", length] => (7, lines, length),
        ["+X", lines, "+Y", length] => (8, lines, length),
        _ => return Err(damaged("the resolution is missing")),
    };
    let (Ok(length), Ok(n_lines)) = (length.parse(), n_lines.parse()) else {
        return Err(damaged("the resolution is not two whole numbers"));
    };
    Ok(Header {
        size: [length, n_lines],
        orientation: Orientation::new(orientation),
        chromaticities,
    })
}

/// Takes a line of text from the data, without its line feed. Bytes that are not UTF-8 become replacement characters.
fn text_line(data: &mut &[u8]) -> Result<String, ImageError> {
    let end = data.iter().position(|&byte| byte == b'\n');
    let end = end.ok_or_else(|| damaged("the header ends too soon"))?;
    let line = String::from_utf8_lossy(&data[..end]);
    let line = line.trim_end_matches('\r').to_owned();
    *data = &data[end + 1..];
    Ok(line)
}

/// Reads the pixels of a scan line: red, green, blue and exponent.
fn scan_line(data: &mut &[u8], length: usize, line: &mut Vec<[u8; 4]>) -> Result<(), ImageError> {
    line.clear();
    if let [2, 2, high, low, ..] = **data
        && high < 128
        && BY_CHANNEL.contains(&length)
    {
        if usize::from(u16::from_be_bytes([high, low])) != length {
            return Err(damaged("a scan line is not as long as the image is wide"));
        }
        *data = &data[4..];
        line.resize(length, [0; 4]);
        return (0..4).try_for_each(|channel| by_channel(data, channel, line));
    }
    // Older files: a pixel with three mantissas of 1 repeats the pixel before it. Repetitions that follow each other
    // are the digits of one count, the lowest first.
    let mut shift = 0;
    while line.len() < length {
        let pixel = *take(data, 4)?.first_chunk::<4>().unwrap_or(&[0; 4]);
        let [1, 1, 1, count] = pixel else {
            line.push(pixel);
            shift = 0;
            continue;
        };
        let last = line.last().copied();
        let last = last.ok_or_else(|| damaged("a scan line begins with a repetition"))?;
        let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX);
        if shift > 24 || count > length - line.len() {
            return Err(damaged("a repetition reaches beyond its scan line"));
        }
        line.resize(line.len() + count, last);
        shift += 8;
    }
    Ok(())
}

/// Reads one channel of a scan line that is encoded channel by channel.
fn by_channel(data: &mut &[u8], channel: usize, line: &mut [[u8; 4]]) -> Result<(), ImageError> {
    let mut at = 0;
    while at < line.len() {
        let count = usize::from(take(data, 1)?[0]);
        let is_run = count > 128;
        let count = if is_run { count - 128 } else { count };
        let bytes = take(data, if is_run { 1 } else { count })?;
        let Some(pixels) = line
            .get_mut(at..at + count)
            .filter(|pixels| !pixels.is_empty())
        else {
            return Err(damaged(
                "a run of pixels is empty or reaches beyond its scan line",
            ));
        };
        for (pixel, &byte) in pixels.iter_mut().zip(bytes.iter().cycle()) {
            pixel[channel] = byte;
        }
        at += count;
    }
    Ok(())
}

/// Takes a number of bytes from the data.
fn take<'a>(data: &mut &'a [u8], length: usize) -> Result<&'a [u8], ImageError> {
    let parts = data.split_at_checked(length);
    let (taken, rest) = parts.ok_or_else(|| damaged("the pixels end too soon"))?;
    *data = rest;
    Ok(taken)
}

/// Returns the three values of a pixel.
fn values([r, g, b, exponent]: [u8; 4]) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    // The bits of the power of two in `f64`, whose exponent has a bias of 1023.
    let scale = f64::from_bits((u64::from(exponent) + 1023 - 136) << 52);
    [r, g, b].map(|mantissa| (f64::from(mantissa) * scale) as f32)
}

fn damaged(reason: &'static str) -> ImageError {
    ImageError::damaged(Format::Hdr.name(), reason)
}
