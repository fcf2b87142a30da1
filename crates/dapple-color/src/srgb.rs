//! The sRGB transfer function in both directions, exact for 8 and 16 bits.
//!
//! Reference: IEC 61966-2-1:1999. Its curve decodes a code value `v` from 0 to 1 to the linear value `v / 12.92` up
//! to 0.04045 and to `((v + 0.055) / 1.055)^2.4` above. It encodes a linear value `x` as `12.92 x` up to 0.0031308
//! and as `1.055 x^(1/2.4) - 0.055` above. The two limits of the standard do not match exactly, but no threshold
//! between two 8- or 16-bit codes is in the gap, so both directions agree on every threshold.
//!
//! A table per bit depth, created at first use, contains the linear value of every code and, for every code, the
//! smallest `f32` that encodes to it. Encoding guesses a code and then steps until the value is between two
//! thresholds. The guess affects only the speed; the thresholds alone decide the result. The powers come from `libm`
//! in `f64`, so the tables are the same on every platform. The tests prove every entry with integers of arbitrary
//! size, where the curve is `x^5 = y^12`.

use std::sync::LazyLock;

/// Number of mantissa bits that select a segment of the guess table.
const GUESS_BITS: u32 = 8;

/// Number of remaining mantissa bits, which give the position within a segment.
const FRACTION_BITS: u32 = 23 - GUESS_BITS;

/// The sRGB curve for codes up to a maximum.
#[derive(Debug)]
pub(crate) struct Curve {
    /// Linear value of each code.
    linear: Vec<f32>,
    /// Thresholds: `borders[k]` is the smallest number whose code is above `k`. The last element is infinity.
    borders: Vec<f32>,
    /// Segment bits (exponent and upper mantissa) of the first threshold.
    first_part: u32,
    /// Unrounded code at the start of each segment, and at the end of the last one.
    guesses: Vec<f32>,
}

/// Returns the curve for 8 bits.
#[inline]
pub(crate) fn curve_u8() -> &'static Curve {
    static CURVE: LazyLock<Curve> = LazyLock::new(|| Curve::new(255));
    &CURVE
}

/// Returns the curve for 16 bits.
#[inline]
pub(crate) fn curve_u16() -> &'static Curve {
    static CURVE: LazyLock<Curve> = LazyLock::new(|| Curve::new(65535));
    &CURVE
}

impl Curve {
    fn new(max: u16) -> Self {
        let scale = f64::from(max);
        let linear = (0..=max)
            .map(|code| linear_from_srgb(f64::from(code) / scale) as f32)
            .collect();
        let mut borders: Vec<f32> = (0..max)
            .map(|code| round_up(linear_from_srgb((f64::from(code) + 0.5) / scale)))
            .collect();
        let first_part = borders[0].to_bits() >> FRACTION_BITS;
        let last_part = 1.0_f32.to_bits() >> FRACTION_BITS;
        let guesses = (first_part..=last_part)
            .map(|part| f64::from(f32::from_bits(part << FRACTION_BITS)))
            .map(|value| (srgb_from_linear(value) * scale) as f32)
            .collect();
        borders.push(f32::INFINITY);
        Self {
            linear,
            borders,
            first_part,
            guesses,
        }
    }

    /// Returns the linear value of a code. Codes above the maximum are clamped.
    #[inline]
    pub(crate) fn decode(&self, code: u16) -> f32 {
        self.linear[usize::from(code).min(self.linear.len() - 1)]
    }

    /// Returns the code of a linear value.
    #[inline]
    pub(crate) fn encode(&self, linear: f32) -> u16 {
        if linear.is_nan() || linear < self.borders[0] {
            return 0;
        }
        if linear >= 1.0 {
            return (self.linear.len() - 1) as u16;
        }
        // Correct the guess by the thresholds.
        let mut code = self.guess(linear);
        while linear >= self.borders[code] {
            code += 1;
        }
        while linear < self.borders[code - 1] {
            code -= 1;
        }
        code as u16
    }

    /// Returns the approximate code of a linear value between the first threshold and 1, interpolated linearly in the
    /// guess table.
    ///
    /// The code is at least 1 and at most the maximum.
    #[inline]
    fn guess(&self, linear: f32) -> usize {
        let bits = linear.to_bits();
        let part = ((bits >> FRACTION_BITS) - self.first_part) as usize;
        let fraction = (bits & ((1 << FRACTION_BITS) - 1)) as f32 / (1 << FRACTION_BITS) as f32;
        let [start, end] = [self.guesses[part], self.guesses[part + 1]];
        let code = (start + (end - start) * fraction + 0.5) as usize;
        code.clamp(1, self.linear.len() - 1)
    }
}

/// Returns two tables for the shaders of `dapple-wgsl`, for 16-bit codes: the smallest linear value whose code is
/// larger, and the linear value of each code.
#[doc(hidden)]
#[must_use]
pub fn srgb_shader_words() -> [Vec<u32>; 2] {
    let curve = curve_u16();
    [&curve.borders, &curve.linear].map(|table| table.iter().map(|x| x.to_bits()).collect())
}

/// Decodes a code value to a linear value with the standard's curve, both from 0 to 1. It extends beyond 1.
pub(crate) fn linear_from_srgb(value: f64) -> f64 {
    if value <= 0.040_45 {
        value / 12.92
    } else {
        libm::pow((value + 0.055) / 1.055, 2.4)
    }
}

/// Encodes a linear value as a code value with the standard's curve, both from 0 to 1. It extends beyond 1.
pub(crate) fn srgb_from_linear(value: f64) -> f64 {
    if value <= 0.003_130_8 {
        value * 12.92
    } else {
        1.055 * libm::pow(value, 1.0 / 2.4) - 0.055
    }
}

/// Returns the smallest `f32` that is at least a positive number.
fn round_up(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) < value {
        nearest.next_up()
    } else {
        nearest
    }
}

#[cfg(test)]
mod tests;
