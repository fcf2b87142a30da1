//! Image content types, and how their values are encoded as samples in a file.
//!
//! Only this module converts values to codes and planes. The writers of whole images and of rows share it.

use crate::PngPixel;
#[cfg(feature = "png")]
use crate::Transfer;
use dapple_color::{Code, LinearRgb, LinearRgba, Normal};

/// The quantity that the pixels of an image hold, which determines how they are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Content {
    /// Data such as heights and masks. PNG: gray from 0 to 1, `round(value · max)`, linear, without a color chunk.
    /// OpenEXR: the plane `Y`, with any values.
    Gray,
    /// Color in linear light. PNG: RGB encoded with the sRGB curve, with an `sRGB` chunk. OpenEXR: the planes `R`, `G`
    /// and `B`, linear.
    Color,
    /// Color with alpha. PNG: RGBA, colors encoded with the sRGB curve, alpha linear. OpenEXR: the planes `R`, `G`, `B`
    /// and `A`, linear, with alpha multiplied into the colors.
    ColorAlpha,
    /// Unit vectors. PNG: RGB of `round((component + 1) / 2 · max)`, linear, without a color chunk. OpenEXR:
    /// `(component + 1) / 2`, unrounded, in the planes `R`, `G` and `B`, as programs expect of a normal map.
    Normal,
    /// Three values that are not a color, such as occlusion, roughness and metallic. PNG: RGB from 0 to 1, linear,
    /// without a color chunk. OpenEXR: the planes `R`, `G` and `B`, with any values.
    Packed,
    /// Four values that are not a color and whose fourth value is not coverage, such as metallic, occlusion, a mask and
    /// smoothness. PNG: RGBA from 0 to 1, linear, without a color chunk. OpenEXR: the planes `R`, `G`, `B` and `A`,
    /// with any values.
    PackedFour,
}

/// Bits per channel of a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Depth {
    /// 8 bits, 256 codes.
    #[default]
    Eight,
    /// 16 bits, 65536 codes, for heights and other data that is processed further.
    Sixteen,
}

/// Format of a file and its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Encoding {
    /// PNG with 8 or 16 bits.
    #[cfg(feature = "png")]
    Png(Depth),
    /// OpenEXR with 32-bit floating point, in tiles.
    #[cfg(feature = "exr")]
    Exr,
    /// A NumPy array (`.npy`, format 1.0) of little-endian `f32` in C order. Its shape is (height, width) for gray,
    /// (height, width, 3) for three channels, and (height, width, 4) with alpha or a fourth value. The values are not
    /// encoded: colors are linear, alpha is not multiplied into them, and the components of normals are from -1 to 1.
    Npy,
    /// Raw heights (`.r16` or `.raw`): `round(value · 65535)` in two bytes, little endian, top row first, without a
    /// header. Only for [`Content::Gray`].
    R16,
}

impl Content {
    /// Returns the name used in error messages.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Gray => "gray",
            Self::Color => "RGB",
            Self::ColorAlpha => "RGB with alpha",
            Self::Normal => "a normal map",
            Self::Packed => "packed maps",
            Self::PackedFour => "four packed maps",
        }
    }

    #[cfg(feature = "png")]
    pub(crate) const fn transfer(self) -> Transfer {
        match self {
            Self::Color | Self::ColorAlpha => Transfer::Srgb,
            Self::Gray | Self::Normal | Self::Packed | Self::PackedFour => Transfer::Data,
        }
    }

    /// Returns the names of the planes of an OpenEXR file, sorted as the format requires.
    pub(crate) const fn planes(self) -> &'static [&'static str] {
        match self {
            Self::Gray => &["Y"],
            Self::Color | Self::Normal | Self::Packed => &["B", "G", "R"],
            Self::ColorAlpha | Self::PackedFour => &["A", "B", "G", "R"],
        }
    }
}

/// A pixel type that can be written.
#[cfg_attr(
    not(feature = "png"),
    expect(dead_code, reason = "codes are what PNG files hold")
)]
pub(crate) trait Pixel: Sync {
    /// Content type of images with this pixel type.
    const CONTENT: Content;
    /// The pixel type encoded with 8 bits per channel.
    type Eight: PngPixel;
    /// The pixel type encoded with 16 bits per channel.
    type Sixteen: PngPixel;
    /// Array of a pixel's values in a NumPy file.
    type Numbers: AsRef<[f32]>;

    fn eight(&self) -> Self::Eight;

    fn sixteen(&self) -> Self::Sixteen;

    /// Returns the pixel's sample in a plane, given the index of the plane in [`Content::planes`].
    fn part(&self, plane: usize) -> f32;

    /// Returns the pixel's values without encoding.
    fn numbers(&self) -> Self::Numbers;
}

impl Pixel for f32 {
    const CONTENT: Content = Content::Gray;
    type Eight = u8;
    type Sixteen = u16;
    type Numbers = [Self; 1];

    #[inline(always)]
    fn eight(&self) -> u8 {
        u8::from_unit(*self)
    }

    #[inline(always)]
    fn sixteen(&self) -> u16 {
        u16::from_unit(*self)
    }

    #[inline(always)]
    fn part(&self, _plane: usize) -> f32 {
        *self
    }

    #[inline(always)]
    fn numbers(&self) -> [Self; 1] {
        [*self]
    }
}

impl Pixel for LinearRgb {
    const CONTENT: Content = Content::Color;
    type Eight = [u8; 3];
    type Sixteen = [u16; 3];
    type Numbers = [f32; 3];

    #[inline(always)]
    fn eight(&self) -> [u8; 3] {
        self.to_srgb()
    }

    #[inline(always)]
    fn sixteen(&self) -> [u16; 3] {
        self.to_srgb()
    }

    #[inline(always)]
    fn part(&self, plane: usize) -> f32 {
        [self.b, self.g, self.r][plane]
    }

    #[inline(always)]
    fn numbers(&self) -> [f32; 3] {
        self.to_array()
    }
}

/// Packed maps, three or four.
impl<const N: usize> Pixel for [f32; N]
where
    [u8; N]: PngPixel,
    [u16; N]: PngPixel,
{
    const CONTENT: Content = match N {
        3 => Content::Packed,
        _ => Content::PackedFour,
    };
    type Eight = [u8; N];
    type Sixteen = [u16; N];
    type Numbers = Self;

    #[inline(always)]
    fn eight(&self) -> [u8; N] {
        self.map(u8::from_unit)
    }

    #[inline(always)]
    fn sixteen(&self) -> [u16; N] {
        self.map(u16::from_unit)
    }

    #[inline(always)]
    fn part(&self, plane: usize) -> f32 {
        self[N - 1 - plane]
    }

    #[inline(always)]
    fn numbers(&self) -> Self {
        *self
    }
}

impl Pixel for LinearRgba {
    const CONTENT: Content = Content::ColorAlpha;
    type Eight = [u8; 4];
    type Sixteen = [u16; 4];
    type Numbers = [f32; 4];

    #[inline(always)]
    fn eight(&self) -> [u8; 4] {
        self.to_srgb()
    }

    #[inline(always)]
    fn sixteen(&self) -> [u16; 4] {
        self.to_srgb()
    }

    #[inline(always)]
    fn part(&self, plane: usize) -> f32 {
        let LinearRgb { r, g, b } = self.color * self.alpha;
        [self.alpha, b, g, r][plane]
    }

    #[inline(always)]
    fn numbers(&self) -> [f32; 4] {
        let LinearRgb { r, g, b } = self.color;
        [r, g, b, self.alpha]
    }
}

impl Pixel for Normal {
    const CONTENT: Content = Content::Normal;
    type Eight = [u8; 3];
    type Sixteen = [u16; 3];
    type Numbers = [f32; 3];

    #[inline(always)]
    fn eight(&self) -> [u8; 3] {
        self.to_codes()
    }

    #[inline(always)]
    fn sixteen(&self) -> [u16; 3] {
        self.to_codes()
    }

    #[inline(always)]
    fn part(&self, plane: usize) -> f32 {
        [self.z, self.y, self.x][plane] * 0.5 + 0.5
    }

    #[inline(always)]
    fn numbers(&self) -> [f32; 3] {
        self.to_array()
    }
}
