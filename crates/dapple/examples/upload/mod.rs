//! Computes the bytes of a texture with its mip levels, for any graphics API.
//!
//! * Color has 8 bits per channel, encoded with the sRGB curve; the GPU decodes it to linear light when it samples.
//!   Data, such as normals, is linear in the file and on the GPU, so its format must not be sRGB.
//! * Rows start at multiples of 256 bytes, as copies from a buffer to a texture require.
//! * A level has half of the columns and rows of the previous one; its pixels are means in linear light.
//! * Row 0 is the top: v = 0 in wgpu, Vulkan, Direct3D, Metal and glTF.

use dapple::color::{LinearRgb, Normal, TexturePixel, TextureRaster as _};
use dapple::raster::{Raster, RasterError};

/// Alignment of rows, in bytes.
const ROW_ALIGNMENT: usize = 256;

/// A texture in the layout of a graphics API.
pub(crate) struct Upload {
    pub(crate) format: Format,
    /// Mip levels, largest first.
    pub(crate) levels: Vec<Level>,
}

/// Format of a four-byte pixel, named as in WebGPU.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Format {
    Rgba8UnormSrgb,
    Rgba8Unorm,
}

/// A mip level.
pub(crate) struct Level {
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
    /// Number of bytes from the start of one row to the start of the next; a multiple of 256.
    pub(crate) bytes_per_row: usize,
    pub(crate) bytes: Vec<u8>,
}

impl Upload {
    /// Creates a texture of colors without alpha.
    pub(crate) fn color(colors: &Raster<LinearRgb>) -> Result<Self, RasterError> {
        Self::new(Format::Rgba8UnormSrgb, colors, Raster::to_rgba8_srgb)
    }

    /// Creates a texture of normals. Shaders normalize them again after sampling.
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
    /// Pads the rows of a level to the alignment.
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

    /// Returns the rows without their padding.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[u8]> {
        let width = 4 * self.size[0] as usize;
        self.bytes
            .chunks_exact(self.bytes_per_row)
            .map(move |row| &row[..width])
    }
}
