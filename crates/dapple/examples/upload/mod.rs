//! The bytes of a texture with its mip levels, for any graphics API.
//!
//! * Color has 8 bits per channel under the sRGB curve; the GPU makes it linear when it samples. Data, such as normals, is
//!   linear in the file and on the GPU, so its format must not say sRGB.
//! * Rows begin at multiples of 256 bytes, as copies from a buffer to a texture want them.
//! * A level is the mean of 2 × 2 pixels of the one before, taken in linear light. Sides that are powers of two are halved
//!   down to one pixel, and a picture that repeats then repeats on every level.
//! * Row 0 is the top: v = 0 in wgpu, Vulkan, Direct3D, Metal and glTF.

use dapple::color::{LinearRgb, Normal};
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
        let mean = |four: [LinearRgb; 4]| (four[0] + four[1] + four[2] + four[3]) * 0.25;
        Self::new(Format::Rgba8UnormSrgb, colors, mean, |color| {
            color.to_srgb::<u8>()
        })
    }

    /// The texture of normals. Shaders normalize them again after sampling.
    pub(crate) fn normal(normals: &Raster<Normal>) -> Result<Self, RasterError> {
        let mean = |four: [Normal; 4]| {
            let mean = |part: fn(&Normal) -> f32| four.iter().map(part).sum::<f32>() * 0.25;
            Normal {
                x: mean(|n| n.x),
                y: mean(|n| n.y),
                z: mean(|n| n.z),
            }
        };
        Self::new(Format::Rgba8Unorm, normals, mean, |normal| {
            normal.to_codes::<u8>()
        })
    }

    fn new<T: Clone>(
        format: Format,
        picture: &Raster<T>,
        mean: impl Fn([T; 4]) -> T,
        codes: impl Fn(&T) -> [u8; 3],
    ) -> Result<Self, RasterError> {
        let mut levels = vec![level(picture, &codes)];
        let mut picture = picture.clone();
        while picture.size() != [1, 1] {
            picture = halved(&picture, &mean)?;
            levels.push(level(&picture, &codes));
        }
        Ok(Self { format, levels })
    }
}

impl Level {
    /// The rows without their padding.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[u8]> {
        let width = 4 * self.size[0] as usize;
        self.bytes
            .chunks_exact(self.bytes_per_row)
            .map(move |row| &row[..width])
    }
}

/// The picture at half the size, rounded down, but at least a pixel.
fn halved<T: Clone>(
    picture: &Raster<T>,
    mean: impl Fn([T; 4]) -> T,
) -> Result<Raster<T>, RasterError> {
    let [width, height] = picture.size();
    Raster::from_fn([width, height].map(|side| (side / 2).max(1)), |x, y| {
        let [left, right] = [2 * x, 2 * x + 1].map(|x| x.min(width - 1) as usize);
        let [top, bottom] = [2 * y, 2 * y + 1].map(|y| picture.row(y.min(height - 1)));
        mean([&top[left], &top[right], &bottom[left], &bottom[right]].map(T::clone))
    })
}

fn level<T>(picture: &Raster<T>, codes: impl Fn(&T) -> [u8; 3]) -> Level {
    let bytes_per_row = (4 * picture.width() as usize).next_multiple_of(ROW_ALIGNMENT);
    let mut bytes = Vec::with_capacity(bytes_per_row * picture.height() as usize);
    for row in picture.view().rows() {
        let end = bytes.len() + bytes_per_row;
        for pixel in row {
            let [r, g, b] = codes(pixel);
            bytes.extend([r, g, b, u8::MAX]);
        }
        bytes.resize(end, 0);
    }
    Level {
        size: picture.size(),
        bytes_per_row,
        bytes,
    }
}
