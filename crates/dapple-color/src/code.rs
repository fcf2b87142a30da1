//! Integer codes for values in a file, by linear quantization or by exact tables of the sRGB curve.
//!
//! Data (heights, masks, normals) is quantized with `round(value · max)`. Color goes through the sRGB transfer
//! function of IEC 61966-2-1; both directions are in [`crate::srgb`].

use crate::srgb;

/// An integer that encodes a value from 0 to 1 in a file: `u8` or `u16`.
///
/// # Examples
///
/// ```
/// use dapple_color::Code;
///
/// assert_eq!(u8::from_unit(0.5), 128);
/// assert_eq!(u16::from_unit(0.5), 32768);
/// assert_eq!(u8::srgb_from_linear(0.5), 188);
/// ```
pub trait Code: Copy + Send + Sync + sealed::Sealed + 'static {
    /// Maximum code, which encodes the value 1.
    const MAX: u16;

    /// Returns the code nearest to a value: `round(value · max)`, where halves round up.
    ///
    /// Values below 0 become 0, values above 1 become the maximum code, and NaN becomes 0.
    #[must_use]
    fn from_unit(value: f32) -> Self;

    /// Returns the value of a code, from 0 to 1: `code / max`, correctly rounded.
    #[must_use]
    fn to_unit(self) -> f32;

    /// Encodes a linear value with the sRGB curve: the exact curve times the maximum code, rounded to nearest.
    ///
    /// The result equals exact arithmetic for every `f32`. Values below 0 become 0, values above 1 become the maximum
    /// code, and NaN becomes 0.
    #[must_use]
    fn srgb_from_linear(linear: f32) -> Self;

    /// Decodes a code with the sRGB curve to a linear value from 0 to 1: the `f32` nearest to the exact value.
    #[must_use]
    fn linear_from_srgb(self) -> f32;
}

impl Code for u8 {
    const MAX: u16 = 255;

    #[inline]
    fn from_unit(value: f32) -> Self {
        // The product and the sum are exact in `f64`. The cast truncates, saturates, and maps NaN to 0.
        (f64::from(value) * 255.0 + 0.5) as Self
    }

    #[inline]
    fn to_unit(self) -> f32 {
        f32::from(self) / 255.0
    }

    #[inline]
    fn srgb_from_linear(linear: f32) -> Self {
        // The table for 8 bits contains no code above 255.
        srgb::curve_u8().encode(linear) as Self
    }

    #[inline]
    fn linear_from_srgb(self) -> f32 {
        srgb::curve_u8().decode(self.into())
    }
}

impl Code for u16 {
    const MAX: Self = 65535;

    #[inline]
    fn from_unit(value: f32) -> Self {
        (f64::from(value) * 65535.0 + 0.5) as Self
    }

    #[inline]
    fn to_unit(self) -> f32 {
        f32::from(self) / 65535.0
    }

    #[inline]
    fn srgb_from_linear(linear: f32) -> Self {
        srgb::curve_u16().encode(linear)
    }

    #[inline]
    fn linear_from_srgb(self) -> f32 {
        srgb::curve_u16().decode(self)
    }
}

mod sealed {
    /// Restricts [`super::Code`] to the two bit depths that files use.
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
}
