//! Pixel types for each content, their codes, and the function that writes them.

use dapple_color::{Code, LinearRgb, LinearRgba, Normal};
use dapple_image::{Content, ImageError, PngPixel, RowWriter};
use dapple_raster::RasterView;
use std::io::Cursor;

/// A pixel type that can be written.
pub(crate) trait Pixel: Clone {
    /// Content type of images with this pixel type.
    const CONTENT: Content;
    /// The pixel type encoded with 8 bits per channel.
    type Eight: PngPixel;
    /// The pixel type encoded with 16 bits per channel.
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
