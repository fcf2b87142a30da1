//! Pixel types of PNG files.

/// A pixel of 8 or 16 bits per channel: gray, gray with alpha, RGB, or RGB with alpha.
///
/// It is implemented for `u8` and `u16` and for arrays of two, three and four of them. Alpha comes last and is not
/// multiplied into the color.
pub trait PngPixel: Copy + Sync + sealed::Sealed {
    /// Number of samples per pixel: 1 to 4.
    #[doc(hidden)]
    const CHANNELS: usize;

    /// Bits per sample: 8 or 16.
    #[doc(hidden)]
    const BITS: u32;

    /// Writes the samples in the byte order of the file; `bytes` is exactly as long as the samples.
    #[doc(hidden)]
    fn write_bytes(self, bytes: &mut [u8]);

    /// Reads a pixel from the bytes of its samples.
    #[doc(hidden)]
    fn from_bytes(bytes: &[u8]) -> Self;
}

macro_rules! png_pixel {
    ($($channels:literal),*) => {$(
        impl PngPixel for [u8; $channels] {
            const CHANNELS: usize = $channels;
            const BITS: u32 = u8::BITS;

            #[inline(always)]
            fn write_bytes(self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self);
            }

            fn from_bytes(bytes: &[u8]) -> Self {
                core::array::from_fn(|channel| bytes[channel])
            }
        }

        impl PngPixel for [u16; $channels] {
            const CHANNELS: usize = $channels;
            const BITS: u32 = u16::BITS;

            #[inline(always)]
            fn write_bytes(self, bytes: &mut [u8]) {
                for (sample, bytes) in self.into_iter().zip(bytes.chunks_exact_mut(2)) {
                    bytes.copy_from_slice(&sample.to_be_bytes());
                }
            }

            fn from_bytes(bytes: &[u8]) -> Self {
                core::array::from_fn(|channel| {
                    u16::from_be_bytes([bytes[2 * channel], bytes[2 * channel + 1]])
                })
            }
        }

        impl sealed::Sealed for [u8; $channels] {}
        impl sealed::Sealed for [u16; $channels] {}
    )*};
}

png_pixel!(2, 3, 4);

impl PngPixel for u8 {
    const CHANNELS: usize = 1;
    const BITS: u32 = Self::BITS;

    #[inline(always)]
    fn write_bytes(self, bytes: &mut [u8]) {
        bytes[0] = self;
    }

    fn from_bytes(bytes: &[u8]) -> Self {
        bytes[0]
    }
}

impl PngPixel for u16 {
    const CHANNELS: usize = 1;
    const BITS: u32 = Self::BITS;

    #[inline(always)]
    fn write_bytes(self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.to_be_bytes());
    }

    fn from_bytes(bytes: &[u8]) -> Self {
        Self::from_be_bytes([bytes[0], bytes[1]])
    }
}

mod sealed {
    /// Restricts [`super::PngPixel`] to the pixel types that PNG supports.
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
}
