//! Why an image was not read or written.

use core::fmt;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Why an image was not read or written.
///
/// Match on [`kind`](Self::kind); the text is for people. Where a file or a codec refused, [`source`](Error::source)
/// holds what it said.
#[derive(Debug)]
pub struct ImageError {
    kind: ImageErrorKind,
    path: Option<PathBuf>,
    source: Option<Box<dyn Error + Send + Sync>>,
}

dapple_raster::error_kind! {
    /// The kind of failure.
    ImageErrorKind {
        /// The operating system refused to read or write; the source says why.
        Io => "the file cannot be read or written";
        /// The bytes begin like no format that is read, or not like the one that was asked for.
        UnknownFormat => "the bytes are of no format that is known here";
        /// The bytes break the rules of their format, or end too soon.
        Damaged {
            /// The format that they seemed to have.
            format: &'static str,
        } => "the {format} data is damaged";
        /// The file uses a feature of its format that is not read.
        Unsupported {
            /// The name of the feature.
            feature: &'static str,
        } => "{feature} is not supported";
        /// The image has no pixel.
        Empty {
            /// Columns and rows.
            size: [u64; 2],
        } => "an image of {} × {} pixels is empty", size[0], size[1];
        /// The image has more pixels than the limit.
        TooManyPixels {
            /// Columns and rows.
            size: [u64; 2],
            /// The limit.
            limit: u64,
        } => "an image of {} × {} pixels is larger than the limit of {limit} pixels", size[0], size[1];
        /// The image takes more memory than the limit, in bytes.
        TooManyBytes {
            /// How many it takes, as far as that is known.
            bytes: u64,
            /// The limit.
            limit: u64,
        } => "the image takes {bytes} bytes or more, but the limit is {limit}";
        /// The image has a side that the format has no room for.
        TooLarge {
            /// The format.
            format: &'static str,
            /// Columns and rows.
            size: [u32; 2],
            /// The longest side, in pixels.
            limit: u32,
        } => "an image of {} × {} pixels does not fit into {format}: the limit is {limit} a side", size[0], size[1];
        /// Rows of the wrong width were to be written.
        RowWidth {
            /// The width of the rows, in pixels.
            width: u32,
            /// The width of the image.
            needed: u32,
        } => "the rows have {width} pixels, but the image has {needed} columns";
        /// More rows were to be written than the image has.
        TooManyRows {
            /// How many there would be.
            rows: u64,
            /// How many the image has.
            needed: u32,
        } => "there are {rows} rows to write, but the image has {needed}";
        /// The image was to be finished before all of its rows were written.
        MissingRows {
            /// How many there are.
            rows: u32,
            /// How many the image has.
            needed: u32,
        } => "only {rows} rows of {needed} are written";
        /// The image has other channels than what was asked for.
        Channels {
            /// The channels of the image.
            found: &'static str,
            /// The channels that were asked for.
            needed: &'static str,
        } => "the image is {found}, but {needed} is needed";
        /// The file has no plane of this name.
        MissingPlane {
            /// The name.
            name: String,
        } => "there is no plane named {name:?}";
        /// The names of the planes to be written are empty, too long, or not different.
        PlaneName {
            /// The first name that is wrong.
            name: String,
        } => "the plane name {name:?} is empty, longer than 255 bytes, or used twice";
        /// Two planes of one image have different sizes.
        SizeMismatch {
            /// The size of the plane, in pixels.
            size: [u32; 2],
            /// The size of the planes before it.
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

    /// The bytes break the rules of `format`, as `source` says.
    pub(crate) fn damaged(
        format: &'static str,
        source: impl Into<Box<dyn Error + Send + Sync>>,
    ) -> Self {
        Self::new(ImageErrorKind::Damaged { format }).because(source)
    }

    /// Adds what a file or a codec said.
    pub(crate) fn because(mut self, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        self.source = Some(source.into());
        self
    }

    /// Adds the file that was read or written.
    pub(crate) fn at(mut self, path: &Path) -> Self {
        self.path = Some(path.to_owned());
        self
    }

    /// The kind of failure.
    #[must_use]
    pub fn kind(&self) -> &ImageErrorKind {
        &self.kind
    }

    /// The file that was read or written, if there was one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }
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
