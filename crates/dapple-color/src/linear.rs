//! Colors in linear light.

use crate::Code;
use core::ops::{Add, Mul, Sub};

/// A color in linear light with the primaries and the white point of sRGB.
///
/// Each component is 0 for no light and 1 for a screen's maximum. Intermediate results may be below 0, above 1, or
/// NaN. Colors can be added and scaled, so a `Raster<LinearRgb>` can be interpolated between its pixels.
///
/// # Examples
///
/// ```
/// use dapple_color::LinearRgb;
///
/// let middle = (LinearRgb::BLACK + LinearRgb::WHITE) * 0.5;
/// assert_eq!(middle.to_srgb::<u8>(), [188, 188, 188]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinearRgb {
    /// Red component, linear.
    pub r: f32,
    /// Green component, linear.
    pub g: f32,
    /// Blue component, linear.
    pub b: f32,
}

/// A color in linear light with straight (not premultiplied) alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinearRgba {
    /// Color of the covered part of the pixel.
    pub color: LinearRgb,
    /// Coverage, from 0 (none) to 1 (full). It is linear in files too.
    pub alpha: f32,
}

impl LinearRgb {
    /// Black: no light.
    pub const BLACK: Self = Self::gray(0.0);
    /// White: a screen's maximum.
    pub const WHITE: Self = Self::gray(1.0);

    /// Creates a color from its linear components.
    #[must_use]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// Creates a gray with the given linear value.
    #[must_use]
    pub const fn gray(value: f32) -> Self {
        Self::new(value, value, value)
    }

    /// Decodes sRGB codes, red first.
    #[must_use]
    pub fn from_srgb<C: Code>(codes: [C; 3]) -> Self {
        codes.map(C::linear_from_srgb).into()
    }

    /// Returns the nearest sRGB codes, red first. Components below 0 or above 1 are clamped, NaN becomes 0.
    #[must_use]
    pub fn to_srgb<C: Code>(self) -> [C; 3] {
        self.to_array().map(C::srgb_from_linear)
    }

    /// Returns red, green and blue.
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Returns the relative luminance: the Y of CIE XYZ with ITU-R BT.709 primaries, linear, 1 for white.
    ///
    /// The formula is `0.2126 r + 0.7152 g + 0.0722 b`, as in BT.709-6 item 3.2.
    #[must_use]
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// Interpolates linearly between this color (at `part` = 0) and `other` (at `part` = 1). Values of `part` outside
    /// this range extrapolate.
    #[must_use]
    pub fn lerp(self, other: Self, part: f32) -> Self {
        // In this form both end values are exact.
        self * (1.0 - part) + other * part
    }
}

impl LinearRgba {
    /// Creates a color with full coverage.
    #[must_use]
    pub const fn opaque(color: LinearRgb) -> Self {
        Self { color, alpha: 1.0 }
    }

    /// Decodes codes: red, green and blue with the sRGB curve, then linear alpha.
    #[must_use]
    pub fn from_srgb<C: Code>([r, g, b, alpha]: [C; 4]) -> Self {
        Self {
            color: LinearRgb::from_srgb([r, g, b]),
            alpha: alpha.to_unit(),
        }
    }

    /// Returns the nearest codes: red, green and blue with the sRGB curve, then linear alpha.
    #[must_use]
    pub fn to_srgb<C: Code>(self) -> [C; 4] {
        let [r, g, b] = self.color.to_srgb();
        [r, g, b, C::from_unit(self.alpha)]
    }

    /// Composites this color over an opaque one.
    #[must_use]
    pub fn over(self, background: LinearRgb) -> LinearRgb {
        background.lerp(self.color, self.alpha)
    }
}

impl From<[f32; 3]> for LinearRgb {
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self { r, g, b }
    }
}

impl From<LinearRgb> for [f32; 3] {
    fn from(color: LinearRgb) -> Self {
        color.to_array()
    }
}

impl Add for LinearRgb {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.r + other.r, self.g + other.g, self.b + other.b)
    }
}

impl Sub for LinearRgb {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.r - other.r, self.g - other.g, self.b - other.b)
    }
}

impl Mul<f32> for LinearRgb {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f32) -> Self {
        Self::new(self.r * factor, self.g * factor, self.b * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::{LinearRgb, LinearRgba};

    #[test]
    fn lerp_is_exact_at_both_ends() {
        let [a, b] = [
            LinearRgb::new(0.1, 0.7, 1e6),
            LinearRgb::new(0.3, 1e-9, 0.2),
        ];
        assert_eq!([a.lerp(b, 0.0), a.lerp(b, 1.0)], [a, b], "the ends");
    }

    #[test]
    fn codes_survive_the_way_through_linear_light() {
        let codes = [0_u16, 12_345, 65_535, 40_000];
        let [r, g, b, _] = codes;
        assert_eq!(
            LinearRgb::from_srgb([r, g, b]).to_srgb::<u16>(),
            [r, g, b],
            "color"
        );
        assert_eq!(
            LinearRgba::from_srgb(codes).to_srgb::<u16>(),
            codes,
            "with alpha"
        );
    }

    #[test]
    fn the_luminance_of_white_is_one() {
        // The three factors sum to 1 in decimal. In `f32` one rounding error of 6e-8 may remain.
        let luminance = LinearRgb::WHITE.luminance();
        assert!((luminance - 1.0).abs() < 1e-6, "{luminance}");
    }

    #[test]
    fn alpha_mixes_with_the_background() {
        let half = LinearRgba {
            color: LinearRgb::WHITE,
            alpha: 0.5,
        };
        assert_eq!(half.over(LinearRgb::BLACK), LinearRgb::gray(0.5), "half");
    }
}
