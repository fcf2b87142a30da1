//! Limits on the size of images that are read.

use crate::{ImageError, ImageErrorKind};

/// Limits on the size of images that are read.
///
/// A few kilobytes of PNG can claim terabytes of pixels; the limits are checked against the claimed size, before memory
/// for the pixels is allocated.
///
/// # Examples
///
/// ```
/// use dapple_image::Limits;
///
/// let large = Limits { pixels: 1 << 30, bytes: 1 << 34 };
/// assert!(large.pixels > Limits::default().pixels);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Maximum number of pixels [default: 2^28, which is 16384 × 16384].
    pub pixels: u64,
    /// Maximum number of bytes, applied separately to the file and to its pixels in memory [default: 2^32, which is 4
    /// GiB].
    pub bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            pixels: 1 << 28,
            bytes: 1 << 32,
        }
    }
}

impl Limits {
    /// Checks that an image is not empty and that its pixels are within the limit.
    pub(crate) fn check_pixels(&self, size: [u64; 2]) -> Result<(), ImageError> {
        let limit = self.pixels;
        if size.contains(&0) {
            return Err(ImageError::new(ImageErrorKind::Empty { size }));
        }
        if size[0].saturating_mul(size[1]) > limit {
            return Err(ImageError::new(ImageErrorKind::TooManyPixels {
                size,
                limit,
            }));
        }
        Ok(())
    }

    /// Checks that the memory for an image is within the limit.
    pub(crate) fn check_bytes(&self, bytes: u64) -> Result<(), ImageError> {
        let limit = self.bytes;
        if bytes > limit {
            return Err(ImageError::new(ImageErrorKind::TooManyBytes {
                bytes,
                limit,
            }));
        }
        Ok(())
    }
}

/// Checks that an image to write is not empty and that its sides fit the format.
pub(crate) fn check_side(
    size: [u32; 2],
    limit: u32,
    format: &'static str,
) -> Result<(), ImageError> {
    if size.contains(&0) {
        let size = size.map(u64::from);
        return Err(ImageError::new(ImageErrorKind::Empty { size }));
    }
    if size[0].max(size[1]) > limit {
        return Err(ImageError::new(ImageErrorKind::TooLarge {
            format,
            size,
            limit,
        }));
    }
    Ok(())
}
