//! Decodes vertex colors, which formats other than glTF encode as sRGB.

use dapple_color::{Code, LinearRgb, LinearRgba};

/// How a file encodes a color component. Values out of range are clamped, and NaN becomes 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    /// Integers from 0 to 255.
    Byte,
    /// Integers from 0 to 65535.
    Short,
    /// Fractions from 0 to 1, rounded to 16 bits.
    Unit,
}

/// Converts components to a linear color: decodes red, green and blue from sRGB; alpha is linear already.
pub(crate) fn decode(parts: [f64; 4], codings: [Coding; 4]) -> LinearRgba {
    let linear = |i: usize| match codings[i] {
        Coding::Byte => code::<u8>(parts[i], 255.0).linear_from_srgb(),
        Coding::Short => code::<u16>(parts[i], 65535.0).linear_from_srgb(),
        Coding::Unit => code::<u16>(parts[i], 1.0).linear_from_srgb(),
    };
    let alpha = match codings[3] {
        Coding::Byte => code::<u8>(parts[3], 255.0).to_unit(),
        Coding::Short => code::<u16>(parts[3], 65535.0).to_unit(),
        // The last `max` turns NaN into 0.
        Coding::Unit => (parts[3] as f32).clamp(0.0, 1.0).max(0.0),
    };
    LinearRgba {
        color: LinearRgb::new(linear(0), linear(1), linear(2)),
        alpha,
    }
}

fn code<C: Code>(value: f64, full: f64) -> C {
    C::from_unit((value / full) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_follow_the_curve_of_srgb_and_alpha_does_not() {
        for code in 0..=255u8 {
            let value = f64::from(code);
            let want = LinearRgba::from_srgb([code; 4]);
            assert_eq!(decode([value; 4], [Coding::Byte; 4]), want, "{code}");
        }
        for code in 0..=65535u16 {
            let value = f64::from(code);
            let want = LinearRgba::from_srgb([code; 4]);
            assert_eq!(decode([value; 4], [Coding::Short; 4]), want, "{code}");
            let unit = decode([value / 65535.0; 4], [Coding::Unit; 4]);
            assert_eq!(unit, want, "{code}");
        }
    }

    #[test]
    fn parts_out_of_range_are_clamped() {
        let color = decode([-1.0, 300.0, f64::NAN, 1e9], [Coding::Byte; 4]);
        let want = LinearRgba::opaque(LinearRgb::new(0.0, 1.0, 0.0));
        assert_eq!(color, want);
    }
}
