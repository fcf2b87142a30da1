//! Errors from reading and writing images.

use core::fmt;
use std::error::Error;
use std::path::{Path, PathBuf};

/// An error from reading or writing an image.
///
/// Match on [`kind`](Self::kind); the message is for people. [`source`](Error::source) returns the underlying file
/// system or codec error, if any.
#[derive(Debug)]
pub struct ImageError {
    kind: ImageErrorKind,
    path: Option<PathBuf>,
    source: Option<Box<dyn Error + Send + Sync>>,
}

dapple_raster::error_kind! {
    /// The kind of failure.
    ImageErrorKind {
        /// A file could not be read or written. The error's source is the operating system's error.
        Io => "the file cannot be read or written";
        /// The first bytes are not the signature of a supported format, or not of the expected format.
        UnknownFormat => "the bytes are of no format that is known here";
        /// The bytes violate their format, or end too soon.
        Damaged {
            /// Name of the format that the signature belongs to.
            format: &'static str,
        } => "the {format} data is damaged";
        /// The file uses a format feature that this crate cannot read.
        Unsupported {
            /// The name of the feature.
            feature: &'static str,
        } => "{feature} is not supported";
        /// The data window and the display window of an OpenEXR file do not overlap, so no pixel would be visible.
        Windows {
            /// First column and row, width and height of the data window.
            data: [i64; 4],
            /// The display window, in the same form.
            display: [i64; 4],
        } => "the data window ({} × {} pixels at {}, {}) and the display window ({} × {} pixels at {}, {}) have no pixel in common", data[2], data[3], data[0], data[1], display[2], display[3], display[0], display[1];
        /// The image has no pixel.
        Empty {
            /// Width and height in pixels.
            size: [u64; 2],
        } => "an image of {} × {} pixels is empty", size[0], size[1];
        /// The image has more pixels than the limit.
        TooManyPixels {
            /// Width and height in pixels.
            size: [u64; 2],
            /// Maximum number of pixels.
            limit: u64,
        } => "an image of {} × {} pixels is larger than the limit of {limit} pixels", size[0], size[1];
        /// The image takes more memory than the limit, in bytes.
        TooManyBytes {
            /// Number of bytes, or a lower bound if it is not known exactly.
            bytes: u64,
            /// Maximum number of bytes.
            limit: u64,
        } => "the image takes {bytes} bytes or more, but the limit is {limit}";
        /// The image has a side that is too long for the format.
        TooLarge {
            /// The name of the format.
            format: &'static str,
            /// Width and height in pixels.
            size: [u32; 2],
            /// Maximum length of a side, in pixels.
            limit: u32,
        } => "an image of {} × {} pixels does not fit into {format}: the limit is {limit} a side", size[0], size[1];
        /// The requested part extends beyond the image.
        Outside {
            /// First column and row of the requested part.
            first: [u32; 2],
            /// Width and height of the requested part.
            size: [u32; 2],
            /// Width and height of the image.
            image: [u32; 2],
        } => "a part of {} × {} pixels at {},{} reaches out of the image of {} × {}", size[0], size[1], first[0], first[1], image[0], image[1];
        /// The rows to write are not as wide as the image.
        RowWidth {
            /// The width of the rows, in pixels.
            width: u32,
            /// The width of the image.
            needed: u32,
        } => "the rows have {width} pixels, but the image has {needed} columns";
        /// More rows were passed to a writer than the image has.
        TooManyRows {
            /// Total number of rows passed, including those beyond the image.
            rows: u64,
            /// The number of rows of the image.
            needed: u32,
        } => "there are {rows} rows to write, but the image has {needed}";
        /// The file was finished before all of its rows were written.
        MissingRows {
            /// The number of rows written.
            rows: u32,
            /// The number of rows of the image.
            needed: u32,
        } => "only {rows} rows of {needed} are written";
        /// The image does not have the requested channels.
        Channels {
            /// Description of the image's channels.
            found: &'static str,
            /// Description of the requested channels.
            needed: &'static str,
        } => "the image is {found}, but {needed} is needed";
        /// The file has no plane with this name.
        MissingPlane {
            /// The name of the plane.
            name: String,
        } => "there is no plane named {name:?}";
        /// The file declares a color space that cannot be converted.
        ColorSpace {
            /// The declaration.
            found: &'static str,
        } => "the colors are declared by {found}, which cannot be converted";
        /// The file has no layer with this name.
        MissingLayer {
            /// The name of the layer.
            name: String,
            /// The names of all layers of the file.
            layers: Vec<String>,
        } => "there is no layer named {name:?}; the layers are {}", layers.join(", ");
        /// The image's format has no layers.
        NoLayers {
            /// The name of the format.
            format: &'static str,
        } => "{format} has no layers";
        /// No layer of the file is marked as its main image, or several layers are.
        AmbiguousLayer {
            /// The names of all layers of the file.
            layers: Vec<String>,
        } => "it is not clear which layer is the picture; the layers are {}", layers.join(", ");
        /// A plane name is empty, not ASCII, too long, or used twice.
        PlaneName {
            /// The first invalid name.
            name: String,
        } => "the plane name {name:?} is empty, longer than 255 bytes, or used twice";
        /// Two planes of one image have different sizes.
        SizeMismatch {
            /// The size of the plane, in pixels.
            size: [u32; 2],
            /// The size of the preceding planes.
            needed: [u32; 2],
        } => "the plane has {} × {} pixels, but the planes before it have {} × {}", size[0], size[1], needed[0], needed[1];
    }
}

impl ImageError {
    pub(crate) fn new(kind: ImageErrorKind) -> Self {
        Self {
            kind,
            path: None,
            source: None,
        }
    }

    /// Creates the error for bytes that violate the rules of `format`, with `source` as the reason.
    pub(crate) fn damaged(
        format: &'static str,
        source: impl Into<Box<dyn Error + Send + Sync>>,
    ) -> Self {
        Self::new(ImageErrorKind::Damaged { format }).because(source)
    }

    /// Attaches a file or codec error as the source.
    pub(crate) fn because(mut self, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        self.source = Some(source.into());
        self
    }

    /// Attaches the file's path.
    pub(crate) fn at(mut self, path: &Path) -> Self {
        self.path = Some(path.to_owned());
        self
    }

    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> &ImageErrorKind {
        &self.kind
    }

    /// Returns the path of the file that was read or written, if there was one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }
}

/// Runs a codec. In programs that unwind on panic (the default), a panic of the codec becomes
/// [`ImageErrorKind::Damaged`].
#[cfg(any(feature = "exr", feature = "jpeg", feature = "tiff", feature = "webp"))]
pub(crate) fn guarded<T>(
    format: crate::Format,
    decode: impl FnOnce() -> Result<T, ImageError>,
) -> Result<T, ImageError> {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    // A panic leaves no inconsistent data behind: nothing mutable outlives the call.
    catch_unwind(AssertUnwindSafe(decode))
        .unwrap_or_else(|_| Err(ImageError::damaged(format.name(), "the codec gave up")))
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(path) = &self.path {
            write!(f, "{}: ", path.display())?;
        }
        write!(f, "{}", self.kind)?;
        match &self.source {
            Some(source) => write!(f, ": {source}"),
            None => Ok(()),
        }
    }
}

impl Error for ImageError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.source.as_deref().map(|source| source as _)
    }
}
