//! The sRGB transfer function in both directions, exact for 8 and 16 bits.
//!
//! Reference: IEC 61966-2-1:1999. By its curve a code value `v` from 0 to 1 is the linear value `v / 12.92` up to 0.04045
//! and `((v + 0.055) / 1.055)^2.4` above; the way back is `12.92 x` up to 0.0031308 and `1.055 x^(1/2.4) - 0.055`
//! above. The standard's two limits do not meet exactly, but no border between two codes of 8 or 16 bits lies in the
//! gap, so that both directions agree on every border.
//!
//! A table per depth, made at first use, holds the linear value of every code and, for every code, the smallest `f32`
//! that belongs to it. Encoding guesses the code and then walks until the value lies between two borders: the guess
//! costs or saves time, and the borders alone decide. The powers come from `libm` in `f64`, so that the tables are the
//! same on every platform; that each entry is the right one is proved in the tests with whole numbers of any length,
//! where the curve is `x^5 = y^12`.

use std::sync::LazyLock;

/// The number of mantissa bits that select a part of the guessing table.
const GUESS_BITS: u32 = 8;

/// The number of mantissa bits that do not select a part.
const FRACTION_BITS: u32 = 23 - GUESS_BITS;

/// The curve for codes up to a maximum.
#[derive(Debug)]
pub(crate) struct Curve {
    /// The linear value of each code.
    linear: Vec<f32>,
    /// `borders[k]` is the smallest number with a code above `k`; the last element is infinity.
    borders: Vec<f32>,
    /// The selecting bits of the first border.
    first_part: u32,
    /// The unrounded code at the start of each part, and at the end of the last.
    guesses: Vec<f32>,
}

/// The curve for 8 bits.
#[inline]
pub(crate) fn curve_u8() -> &'static Curve {
    static CURVE: LazyLock<Curve> = LazyLock::new(|| Curve::new(255));
    &CURVE
}

/// The curve for 16 bits.
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

    /// The linear value of a code; a code above the maximum counts as the maximum.
    #[inline]
    pub(crate) fn decode(&self, code: u16) -> f32 {
        self.linear[usize::from(code).min(self.linear.len() - 1)]
    }

    /// The code of a linear value.
    #[inline]
    pub(crate) fn encode(&self, linear: f32) -> u16 {
        if linear.is_nan() || linear < self.borders[0] {
            return 0;
        }
        if linear >= 1.0 {
            return (self.linear.len() - 1) as u16;
        }
        let mut code = self.guess(linear);
        while linear >= self.borders[code] {
            code += 1;
        }
        while linear < self.borders[code - 1] {
            code -= 1;
        }
        code as u16
    }

    /// An approximate code of a number between the first border and 1: linear within each part.
    ///
    /// At least 1, since the guess at the first border is, and at most the maximum.
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

/// The standard's curve from a code value to a linear one, both from 0 to 1; it extends beyond 1.
pub(crate) fn linear_from_srgb(value: f64) -> f64 {
    if value <= 0.040_45 {
        value / 12.92
    } else {
        libm::pow((value + 0.055) / 1.055, 2.4)
    }
}

/// The standard's curve from a linear value to a code value, both from 0 to 1; it extends beyond 1.
pub(crate) fn srgb_from_linear(value: f64) -> f64 {
    if value <= 0.003_130_8 {
        value * 12.92
    } else {
        1.055 * libm::pow(value, 1.0 / 2.4) - 0.055
    }
}

/// The smallest `f32` that is not below a positive number.
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
