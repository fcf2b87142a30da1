//! Pixels of each content, with their codes and the door that writes them.

use dapple_color::{Code, LinearRgb, LinearRgba, Normal};
use dapple_image::{Content, ImageError, PngPixel, RowWriter};
use dapple_raster::RasterView;
use std::io::Cursor;

/// A type of pixels that can be written.
pub(crate) trait Pixel: Clone {
    /// The content of images with such pixels.
    const CONTENT: Content;
    /// The pixel in codes of 8 bits.
    type Eight: PngPixel;
    /// The pixel in codes of 16 bits.
    type Sixteen: PngPixel;

    fn eight(&self) -> Self::Eight;

    fn sixteen(&self) -> Self::Sixteen;

    fn write(
        writer: &mut RowWriter<Cursor<Vec<u8>>>,
        rows: RasterView<'_, Self>,
    ) -> Result<(), ImageError>;
}

macro_rules! pixels {
    ($($pixel:ty: $content:ident, $write:ident, $eight:ty, $sixteen:ty, $code:expr;)*) => {$(
        impl Pixel for $pixel {
            const CONTENT: Content = Content::$content;
            type Eight = $eight;
            type Sixteen = $sixteen;

            fn eight(&self) -> $eight {
                let code: fn(&Self) -> $eight = $code;
                code(self)
            }

            fn sixteen(&self) -> $sixteen {
                let code: fn(&Self) -> $sixteen = $code;
                code(self)
            }

            fn write(
                writer: &mut RowWriter<Cursor<Vec<u8>>>,
                rows: RasterView<'_, Self>,
            ) -> Result<(), ImageError> {
                writer.$write(rows)
            }
        }
    )*};
}

pixels! {
    f32: Gray, write_gray, u8, u16, |&value| Code::from_unit(value);
    LinearRgb: Color, write_color, [u8; 3], [u16; 3], |color| color.to_srgb();
    LinearRgba: ColorAlpha, write_color_alpha, [u8; 4], [u16; 4], |color| color.to_srgb();
    Normal: Normal, write_normals, [u8; 3], [u16; 3], |normal| normal.to_codes();
    [f32; 4]: PackedFour, write_packed_four, [u8; 4], [u16; 4], |four| four.map(Code::from_unit);
}
