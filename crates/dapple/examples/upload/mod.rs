//! The bytes of a texture with its mip levels, for any graphics API.
//!
//! * Color has 8 bits per channel under the sRGB curve; the GPU makes it linear when it samples. Data, such as normals, is
//!   linear in the file and on the GPU, so its format must not say sRGB.
//! * Rows begin at multiples of 256 bytes, as copies from a buffer to a texture want them.
//! * A level has half of the columns and rows of the one before; its pixels are means in linear light.
//! * Row 0 is the top: v = 0 in wgpu, Vulkan, Direct3D, Metal and glTF.

use dapple::color::{LinearRgb, Normal, TexturePixel, TextureRaster as _};
use dapple::raster::{Raster, RasterError};

/// The alignment of rows, in bytes.
const ROW_ALIGNMENT: usize = 256;

/// A texture in the form of a graphics API.
pub(crate) struct Upload {
    pub(crate) format: Format,
    /// The mip levels, the largest first.
    pub(crate) levels: Vec<Level>,
}

/// The format of a pixel in four bytes, with the name of WebGPU.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Format {
    Rgba8UnormSrgb,
    Rgba8Unorm,
}

/// A mip level.
pub(crate) struct Level {
    /// The numbers of columns and rows.
    pub(crate) size: [u32; 2],
    /// The number of bytes from the start of a row to that of the next; a multiple of 256.
    pub(crate) bytes_per_row: usize,
    pub(crate) bytes: Vec<u8>,
}

impl Upload {
    /// The texture of colors, without alpha.
    pub(crate) fn color(colors: &Raster<LinearRgb>) -> Result<Self, RasterError> {
        Self::new(Format::Rgba8UnormSrgb, colors, Raster::to_rgba8_srgb)
    }

    /// The texture of normals. Shaders normalize them again after sampling.
    pub(crate) fn normal(normals: &Raster<Normal>) -> Result<Self, RasterError> {
        Self::new(Format::Rgba8Unorm, normals, Raster::to_rgba8)
    }

    fn new<T: TexturePixel>(
        format: Format,
        image: &Raster<T>,
        bytes: fn(&Raster<T>) -> Vec<u8>,
    ) -> Result<Self, RasterError> {
        let levels = image.mip_levels()?;
        let levels = levels
            .iter()
            .map(|level| Level::new(level.size(), &bytes(level)));
        Ok(Self {
            format,
            levels: levels.collect(),
        })
    }
}

impl Level {
    /// Pads rows to the alignment.
    fn new(size: [u32; 2], pixels: &[u8]) -> Self {
        let width = 4 * size[0] as usize;
        let bytes_per_row = width.next_multiple_of(ROW_ALIGNMENT);
        let mut bytes = Vec::with_capacity(bytes_per_row * size[1] as usize);
        for row in pixels.chunks_exact(width) {
            bytes.extend(row);
            bytes.resize(bytes.len() + bytes_per_row - width, 0);
        }
        Self {
            size,
            bytes_per_row,
            bytes,
        }
    }

    /// The rows without their padding.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[u8]> {
        let width = 4 * self.size[0] as usize;
        self.bytes
            .chunks_exact(self.bytes_per_row)
            .map(move |row| &row[..width])
    }
}
