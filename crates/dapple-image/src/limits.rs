//! How large an image may be before it is refused.

use crate::{ImageError, ImageErrorKind};

/// How large an image may be before reading refuses it.
///
/// A few kilobytes of PNG can ask for terabytes of pixels; the limits are checked against what the file says of its size,
/// before memory for the pixels is taken.
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
    /// The most pixels. By default 2^28, which is 16384 × 16384.
    pub pixels: u64,
    /// The most bytes: of the file, and again of its pixels in memory. By default 2^32, which is 4 GiB.
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
    /// Refuses an image without pixels or with too many.
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

    /// Refuses an image that takes too much memory.
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

/// Refuses to write an image without pixels, or with a side that a format has no room for.
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
