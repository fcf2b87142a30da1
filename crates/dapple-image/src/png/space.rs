//! Reads the color space that a PNG file declares. `cICP` takes precedence over `iCCP`, then `sRGB`, then `gAMA` and
//! `cHRM`.

use super::GAMMA_OF_SRGB;
use crate::color_space::{BT709, ColorSpace, Curve, D65, Primaries, Source};
use crate::icc;
use png::{CodingIndependentCodePoints, Info, SourceChromaticities};

/// White point of cinema projectors (SMPTE RP 431-2).
const DCI: [f64; 2] = [0.314, 0.351];

/// White point of the illuminant C.
const C: [f64; 2] = [0.310, 0.316];

/// White point of the illuminant E.
const E: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];

/// Returns the color space that a file's chunks declare.
pub(super) fn of(info: &Info<'_>) -> ColorSpace {
    if let Some(points) = &info.coding_independent_code_points {
        return of_code_points(points);
    }
    if let Some(profile) = &info.icc_profile {
        return icc::color_space(profile);
    }
    if info.srgb.is_some() {
        return ColorSpace::srgb(Source::Srgb);
    }
    let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
    let curve = match gamma {
        // sRGB files have this gamma, with varying rounding; use the sRGB curve instead of a power.
        None => Curve::Srgb,
        Some(gamma) if gamma.abs_diff(GAMMA_OF_SRGB) <= 1 => Curve::Srgb,
        Some(gamma) => Curve::Power(100_000.0 / f64::from(gamma)),
    };
    match (&info.chrm_chunk, gamma) {
        (None, None) => ColorSpace::default(),
        (None, Some(_)) if curve == Curve::Srgb => ColorSpace::srgb(Source::Srgb),
        (None, Some(_)) => ColorSpace::from_primaries(Source::Gamma, BT709, curve),
        (Some(points), _) => ColorSpace::from_primaries(Source::Gamma, primaries(points), curve),
    }
}

fn primaries(points: &SourceChromaticities) -> Primaries {
    let of = |point: png::ScaledFloat| f64::from(point.into_scaled()) / 100_000.0;
    let point = |(x, y): (png::ScaledFloat, png::ScaledFloat)| [of(x), of(y)];
    [points.red, points.green, points.blue, points.white].map(point)
}

/// Returns the color space for code points from ITU-T H.273, tables 2 and 3.
fn of_code_points(points: &CodingIndependentCodePoints) -> ColorSpace {
    let unknown = |name| ColorSpace::unknown(Source::Cicp, name);
    if points.matrix_coefficients != 0 || !points.is_video_full_range_image {
        return unknown("cICP of a narrow range or with a matrix");
    }
    let primaries = match points.color_primaries {
        1 | 2 => BT709,
        4 => [[0.67, 0.33], [0.21, 0.71], [0.14, 0.08], C],
        5 => [[0.64, 0.33], [0.29, 0.6], [0.15, 0.06], D65],
        6 | 7 => [[0.63, 0.34], [0.31, 0.595], [0.155, 0.07], D65],
        8 => [[0.681, 0.319], [0.243, 0.692], [0.145, 0.049], C],
        9 => [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], D65],
        10 => [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], E],
        11 => [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], DCI],
        12 => [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], D65],
        22 => [[0.63, 0.34], [0.295, 0.605], [0.155, 0.077], D65],
        _ => return unknown("cICP with unknown primaries"),
    };
    let curve = match points.transfer_function {
        1 | 6 | 14 | 15 => Curve::Bt709,
        4 => Curve::Power(2.2),
        5 => Curve::Power(2.8),
        8 => Curve::Power(1.0),
        2 | 13 => Curve::Srgb,
        16 => return unknown("cICP with the transfer function PQ (SMPTE ST 2084)"),
        18 => return unknown("cICP with the transfer function HLG (ARIB STD-B67)"),
        _ => return unknown("cICP with an unknown transfer function"),
    };
    ColorSpace::from_primaries(Source::Cicp, primaries, curve)
}
