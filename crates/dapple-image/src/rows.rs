//! Row-by-row writing of images of any size, from the top down.

#[cfg(feature = "png")]
use crate::Depth;
use crate::content::Pixel;
#[cfg(feature = "exr")]
use crate::exr::TileStream;
#[cfg(feature = "png")]
use crate::png::{PngStream, Samples};
use crate::raw::RawStream;
use crate::{Content, Encoding, ImageError, ImageErrorKind};
use core::fmt;
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_raster::RasterView;
use std::io::{Seek, Write};

/// Writes an image row by row, from the top down, so that the whole image is never in memory.
///
/// Rows are passed in bands of any height; the division into bands does not change the bytes of the file. Buffer
/// memory:
///
/// - PNG: two MiB per thread, or a few rows if these are larger. The file equals the output of
///   [`encode_png`](crate::encode_png).
/// - OpenEXR, in tiles of 64 × 64 pixels: 64 rows of 4 bytes per pixel and plane.
/// - NumPy arrays and raw heights: one row.
///
/// PNG and OpenEXR are compressed on all cores if the feature `rayon` is enabled.
///
/// The sink should be empty, and buffered if it is a file. Its content is complete only after [`finish`](Self::finish).
///
/// # Examples
///
/// ```
/// use dapple_image::{Content, Depth, Encoding, Limits, RowWriter, decode_image};
/// use dapple_raster::Raster;
/// use std::io::Cursor;
///
/// let sink = Cursor::new(Vec::new());
/// let mut writer = RowWriter::new(sink, [200, 100], Content::Gray, Encoding::Png(Depth::Sixteen))?;
/// for band in 0..10 {
///     let rows = Raster::filled([200, 10], band as f32 / 9.0)?;
///     writer.write_gray(rows.view())?;
/// }
/// let bytes = writer.finish()?.into_inner();
/// assert_eq!(decode_image(&bytes, &Limits::default())?.size(), [200, 100]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RowWriter<W: Write + Seek> {
    sink: W,
    rows: Rows,
}

/// Destination that a file is written to.
pub(crate) trait Sink: Write + Seek {}

impl<W: Write + Seek> Sink for W {}

/// An image that is being written. It does not depend on the sink's type, so that the formats are compiled in this
/// crate and not in every crate that writes images.
struct Rows {
    content: Content,
    size: [u32; 2],
    /// Number of rows written so far.
    rows: u32,
    /// Whether writing a row failed; the file can then never be completed.
    is_broken: bool,
    file: File,
}

/// The file that is being written, by encoding.
enum File {
    #[cfg(feature = "png")]
    Eight(Box<PngStream>),
    #[cfg(feature = "png")]
    Sixteen(Box<PngStream>),
    #[cfg(feature = "exr")]
    Exr(Box<TileStream>),
    Npy(RawStream),
    R16(RawStream),
}

/// Several rows, by content type.
enum Band<'a> {
    Gray(RasterView<'a, f32>),
    Color(RasterView<'a, LinearRgb>),
    ColorAlpha(RasterView<'a, LinearRgba>),
    Normal(RasterView<'a, Normal>),
    Packed(RasterView<'a, [f32; 3]>),
    PackedFour(RasterView<'a, [f32; 4]>),
}

impl<W: Write + Seek> RowWriter<W> {
    /// Starts an image with `size` columns and rows in `sink`, and writes the header.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Empty`] if the image has no pixel, [`ImageErrorKind::TooLarge`] if a side is longer than
    /// `2^31 - 1` pixels in PNG or `2^30 - 2` in OpenEXR, [`ImageErrorKind::TooManyBytes`] if a row of PNG takes more than 2^30
    /// bytes, [`ImageErrorKind::Unsupported`] if there are too many tiles for OpenEXR, [`ImageErrorKind::Channels`] if
    /// the content of raw heights is not gray, [`ImageErrorKind::Io`] if the sink fails.
    pub fn new(
        mut sink: W,
        size: [u32; 2],
        content: Content,
        encoding: Encoding,
    ) -> Result<Self, ImageError> {
        let rows = Rows::new(&mut sink, size, content, encoding)?;
        Ok(Self { sink, rows })
    }

    /// Writes the next rows of an image of [`Content::Gray`].
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::RowWidth`] if the rows are not as wide as the image, [`ImageErrorKind::TooManyRows`] if
    /// there are more rows than remain in the image, [`ImageErrorKind::Channels`] if the image has a different
    /// content. After one of these errors, no row has been written and writing may continue. [`ImageErrorKind::Io`]
    /// if the sink fails, now or in an earlier call.
    pub fn write_gray(&mut self, rows: RasterView<'_, f32>) -> Result<(), ImageError> {
        self.rows.write(&mut self.sink, Band::Gray(rows))
    }

    /// Writes the next rows of an image of [`Content::Color`].
    ///
    /// # Errors
    ///
    /// Same as [`write_gray`](Self::write_gray).
    pub fn write_color(&mut self, rows: RasterView<'_, LinearRgb>) -> Result<(), ImageError> {
        self.rows.write(&mut self.sink, Band::Color(rows))
    }

    /// Writes the next rows of an image of [`Content::ColorAlpha`].
    ///
    /// # Errors
    ///
    /// Same as [`write_gray`](Self::write_gray).
    pub fn write_color_alpha(
        &mut self,
        rows: RasterView<'_, LinearRgba>,
    ) -> Result<(), ImageError> {
        self.rows.write(&mut self.sink, Band::ColorAlpha(rows))
    }

    /// Writes the next rows of an image of [`Content::Normal`].
    ///
    /// # Errors
    ///
    /// Same as [`write_gray`](Self::write_gray).
    pub fn write_normals(&mut self, rows: RasterView<'_, Normal>) -> Result<(), ImageError> {
        self.rows.write(&mut self.sink, Band::Normal(rows))
    }

    /// Writes the next rows of an image of [`Content::Packed`].
    ///
    /// # Errors
    ///
    /// Same as [`write_gray`](Self::write_gray).
    pub fn write_packed(&mut self, rows: RasterView<'_, [f32; 3]>) -> Result<(), ImageError> {
        self.rows.write(&mut self.sink, Band::Packed(rows))
    }

    /// Writes the next rows of an image of [`Content::PackedFour`].
    ///
    /// # Errors
    ///
    /// Same as [`write_gray`](Self::write_gray).
    pub fn write_packed_four(&mut self, rows: RasterView<'_, [f32; 4]>) -> Result<(), ImageError> {
        self.rows.write(&mut self.sink, Band::PackedFour(rows))
    }

    /// Completes the file and returns the sink.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingRows`] if rows are missing, [`ImageErrorKind::Io`] if the sink fails, now or in an
    /// earlier call.
    pub fn finish(mut self) -> Result<W, ImageError> {
        self.rows.finish(&mut self.sink)?;
        Ok(self.sink)
    }
}

impl Rows {
    fn new(
        sink: &mut dyn Sink,
        size: [u32; 2],
        content: Content,
        encoding: Encoding,
    ) -> Result<Self, ImageError> {
        let file = match content {
            Content::Gray => File::new::<f32>(sink, size, encoding),
            Content::Color => File::new::<LinearRgb>(sink, size, encoding),
            Content::ColorAlpha => File::new::<LinearRgba>(sink, size, encoding),
            Content::Normal => File::new::<Normal>(sink, size, encoding),
            Content::Packed => File::new::<[f32; 3]>(sink, size, encoding),
            Content::PackedFour => File::new::<[f32; 4]>(sink, size, encoding),
        }?;
        Ok(Self {
            content,
            size,
            rows: 0,
            is_broken: false,
            file,
        })
    }

    fn write(&mut self, sink: &mut dyn Sink, band: Band<'_>) -> Result<(), ImageError> {
        match band {
            Band::Gray(rows) => self.write_rows(sink, rows),
            Band::Color(rows) => self.write_rows(sink, rows),
            Band::ColorAlpha(rows) => self.write_rows(sink, rows),
            Band::Normal(rows) => self.write_rows(sink, rows),
            Band::Packed(rows) => self.write_rows(sink, rows),
            Band::PackedFour(rows) => self.write_rows(sink, rows),
        }
    }

    fn write_rows<T: Pixel>(
        &mut self,
        sink: &mut dyn Sink,
        rows: RasterView<'_, T>,
    ) -> Result<(), ImageError> {
        self.check_whole()?;
        let [_, height] = rows.size();
        self.check_rows::<T>(rows.size())?;
        // Remains set after an early return.
        self.is_broken = true;
        match &mut self.file {
            #[cfg(feature = "png")]
            File::Eight(stream) => stream.write_rows(sink, rows, T::eight)?,
            #[cfg(feature = "png")]
            File::Sixteen(stream) => stream.write_rows(sink, rows, T::sixteen)?,
            #[cfg(feature = "exr")]
            File::Exr(stream) => stream.write_rows(sink, rows, T::part)?,
            File::Npy(stream) => stream.write_numbers(sink, rows)?,
            File::R16(stream) => stream.write_codes(sink, rows)?,
        }
        self.is_broken = false;
        self.rows += height;
        Ok(())
    }

    fn finish(self, sink: &mut dyn Sink) -> Result<(), ImageError> {
        self.check_whole()?;
        let [rows, needed] = [self.rows, self.size[1]];
        if rows < needed {
            return Err(ImageError::new(ImageErrorKind::MissingRows {
                rows,
                needed,
            }));
        }
        match self.file {
            #[cfg(feature = "png")]
            File::Eight(stream) | File::Sixteen(stream) => stream.finish(sink),
            #[cfg(feature = "exr")]
            File::Exr(stream) => stream.finish(sink),
            File::Npy(_) | File::R16(_) => sink
                .flush()
                .map_err(|error| ImageError::new(ImageErrorKind::Io).because(error)),
        }
    }

    fn check_whole(&self) -> Result<(), ImageError> {
        if self.is_broken {
            let message = "an earlier row was not written, so that the file cannot be completed";
            return Err(ImageError::new(ImageErrorKind::Io).because(message));
        }
        Ok(())
    }

    fn check_rows<T: Pixel>(&self, [width, height]: [u32; 2]) -> Result<(), ImageError> {
        let rows = u64::from(self.rows) + u64::from(height);
        let kind = if T::CONTENT != self.content {
            ImageErrorKind::Channels {
                found: T::CONTENT.name(),
                needed: self.content.name(),
            }
        } else if width != self.size[0] {
            let needed = self.size[0];
            ImageErrorKind::RowWidth { width, needed }
        } else if rows > u64::from(self.size[1]) {
            let needed = self.size[1];
            ImageErrorKind::TooManyRows { rows, needed }
        } else {
            return Ok(());
        };
        Err(ImageError::new(kind))
    }
}

impl File {
    fn new<T: Pixel>(
        sink: &mut dyn Sink,
        size: [u32; 2],
        encoding: Encoding,
    ) -> Result<Self, ImageError> {
        Ok(match encoding {
            #[cfg(feature = "png")]
            Encoding::Png(Depth::Eight) => {
                let samples = Samples::of::<T::Eight>();
                let transfer = T::CONTENT.transfer();
                Self::Eight(PngStream::new(sink, size, samples, transfer)?.into())
            }
            #[cfg(feature = "png")]
            Encoding::Png(Depth::Sixteen) => {
                let samples = Samples::of::<T::Sixteen>();
                let transfer = T::CONTENT.transfer();
                Self::Sixteen(PngStream::new(sink, size, samples, transfer)?.into())
            }
            #[cfg(feature = "exr")]
            Encoding::Exr => Self::Exr(TileStream::new(sink, size, T::CONTENT.planes())?.into()),
            Encoding::Npy => {
                let n_channels = T::CONTENT.planes().len();
                Self::Npy(RawStream::npy(sink, size, n_channels)?)
            }
            Encoding::R16 if T::CONTENT == Content::Gray => Self::R16(RawStream::r16(size)?),
            Encoding::R16 => {
                return Err(ImageError::new(ImageErrorKind::Channels {
                    found: T::CONTENT.name(),
                    needed: Content::Gray.name(),
                }));
            }
        })
    }
}

impl<W: Write + Seek> fmt::Debug for RowWriter<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The codecs do not implement `Debug`.
        f.debug_struct("RowWriter")
            .field("content", &self.rows.content)
            .field("size", &self.rows.size)
            .field("rows", &self.rows.rows)
            .finish_non_exhaustive()
    }
}
