//! Writing of a PNG file row by row in constant memory.
//!
//! The codec writes into a buffer that cannot fail, which is copied to the file after every row. Otherwise the codec
//! would own the file; and in this way no error of the file can reach the codec.
//!
//! The compression levels were chosen by measurements on maps of 2048 × 2048 pixels: a fractal height, its normals, and
//! colors from it. With 16 bits the lower half of a sample is nearly noise, and level 1 makes files no larger than
//! level 6 does (6.65 and 6.73 MB of 8.4 for the height, 24.13 and 24.15 of 25.2 for the normals, 19.14 and 19.19 of
//! 25.2 for the colors) in a fifth to a seventh of the time. With 8 bits level 3 takes a fifth of the time of level 6,
//! for files that are at most 5 % larger, where level 1 would make them up to a third larger. The fastest mode of the
//! codec has a fixed code for small numbers, and cannot make normals smaller at all.

use super::{GAMMA_OF_SRGB, PngPixel, Transfer};
use crate::limits::check_side;
use crate::{ImageError, ImageErrorKind};
use dapple_raster::RasterView;
use png::{BitDepth, ColorType, DeflateCompression, EncodingError, StreamWriter};
use std::io::{self, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The longest side of the format, in pixels.
const SIDE_LIMIT: u32 = i32::MAX as u32;

/// The longest row that can be written, in bytes; the codec allocates three of them at the beginning.
const ROW_LIMIT: u64 = 1 << 30;

/// The number of bytes of compressed data in a chunk of the file.
const CHUNK_LENGTH: usize = 1 << 16;

/// A PNG file that is being written into a sink. It does not own the sink, so that the codec is compiled once for all.
pub(crate) struct PngStream {
    codec: StreamWriter<'static, Pipe>,
    pipe: Pipe,
    /// The samples of a row.
    samples: Vec<u8>,
}

/// The kind of samples of a file, by the kind of its pixels.
#[derive(Clone, Copy)]
pub(crate) struct Samples {
    /// The number of samples of a pixel: 1 to 4.
    channels: usize,
    /// The bits of a sample: 8 or 16.
    bits: u32,
}

/// A buffer between the codec and the file, shared by both.
#[derive(Clone, Default)]
struct Pipe(Arc<Mutex<Vec<u8>>>);

impl Samples {
    /// The samples of pixels of type `P`.
    pub(crate) fn of<P: PngPixel>() -> Self {
        Self {
            channels: P::CHANNELS,
            bits: P::BITS,
        }
    }
}

impl PngStream {
    /// Begins a file of pixels of one kind; the header is written at once.
    pub(crate) fn new(
        sink: &mut dyn Write,
        size: [u32; 2],
        samples: Samples,
        transfer: Transfer,
    ) -> Result<Self, ImageError> {
        let length = check_size(size, samples)?;
        let pipe = Pipe::default();
        let stream = Self {
            codec: codec(pipe.clone(), size, samples, transfer).map_err(failure)?,
            pipe,
            samples: vec![0; length],
        };
        stream.pass_on(sink)?;
        Ok(stream)
    }

    /// Writes whole rows of the width of the file, no more than are missing.
    pub(crate) fn write_rows<T, P: PngPixel>(
        &mut self,
        sink: &mut dyn Write,
        rows: RasterView<'_, T>,
        code: impl Fn(&T) -> P,
    ) -> Result<(), ImageError> {
        for row in rows.rows() {
            for (value, bytes) in row
                .iter()
                .zip(self.samples.chunks_exact_mut(size_of::<P>()))
            {
                code(value).write_bytes(bytes);
            }
            self.write_row(sink)?;
        }
        Ok(())
    }

    /// Ends the file, after all of its rows.
    pub(crate) fn finish(self, sink: &mut dyn Write) -> Result<(), ImageError> {
        let Self { codec, pipe, .. } = self;
        codec.finish().map_err(failure)?;
        sink.write_all(&pipe.bytes()).map_err(failure)?;
        sink.flush().map_err(failure)
    }

    /// Writes the row whose samples are at hand.
    fn write_row(&mut self, sink: &mut dyn Write) -> Result<(), ImageError> {
        self.codec.write_all(&self.samples).map_err(failure)?;
        self.pass_on(sink)
    }

    fn pass_on(&self, sink: &mut dyn Write) -> Result<(), ImageError> {
        let mut bytes = self.pipe.bytes();
        sink.write_all(&bytes).map_err(failure)?;
        bytes.clear();
        Ok(())
    }
}

impl Pipe {
    fn bytes(&self) -> MutexGuard<'_, Vec<u8>> {
        // No thread panics while it holds the lock, and the bytes would be in order all the same.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for Pipe {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The number of bytes of a row, for a size that can be written.
fn check_size(size: [u32; 2], samples: Samples) -> Result<usize, ImageError> {
    check_side(size, SIDE_LIMIT, "PNG")?;
    let pixel = samples.channels as u64 * u64::from(samples.bits / 8);
    let bytes = u64::from(size[0]) * pixel;
    if bytes > ROW_LIMIT || usize::try_from(bytes * u64::from(size[1])).is_err() {
        let limit = ROW_LIMIT;
        return Err(ImageError::new(ImageErrorKind::TooManyBytes {
            bytes,
            limit,
        }));
    }
    Ok(bytes as usize)
}

fn codec(
    pipe: Pipe,
    [width, height]: [u32; 2],
    samples: Samples,
    transfer: Transfer,
) -> Result<StreamWriter<'static, Pipe>, EncodingError> {
    let color = match samples.channels {
        1 => ColorType::Grayscale,
        2 => ColorType::GrayscaleAlpha,
        3 => ColorType::Rgb,
        _ => ColorType::Rgba,
    };
    let (depth, level) = match samples.bits {
        u8::BITS => (BitDepth::Eight, 3),
        _ => (BitDepth::Sixteen, 1),
    };
    let mut encoder = png::Encoder::new(pipe, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_deflate_compression(DeflateCompression::Level(level));
    if transfer == Transfer::Srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_source_gamma(png::ScaledFloat::from_scaled(GAMMA_OF_SRGB));
    }
    encoder
        .write_header()?
        .into_stream_writer_with_size(CHUNK_LENGTH)
}

fn failure(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> ImageError {
    ImageError::new(ImageErrorKind::Io).because(error)
}
