//! Maps as images: the content of their files, and their rows.

use super::{MapKind, MapRows};
use dapple_image::{Content, ImageError, RowWriter};
use std::io::{Seek, Write};

impl MapKind {
    /// The content of an image of the map, which decides how its numbers are coded.
    #[must_use]
    pub fn content(self) -> Content {
        match self {
            Self::Normal => Content::Normal,
            Self::Albedo => Content::Color,
            Self::Orm => Content::Packed,
            Self::Height | Self::Occlusion | Self::Curvature | Self::Roughness | Self::Metallic => {
                Content::Gray
            }
        }
    }
}

impl MapRows {
    /// Writes the rows as the next ones of an image with the content of their map.
    ///
    /// # Errors
    ///
    /// The errors of [`RowWriter`].
    pub fn write<W: Write + Seek>(&self, writer: &mut RowWriter<W>) -> Result<(), ImageError> {
        match self {
            Self::Gray(rows) => writer.write_gray(rows.view()),
            Self::Color(rows) => writer.write_color(rows.view()),
            Self::Normal(rows) => writer.write_normals(rows.view()),
            Self::Packed(rows) => writer.write_packed(rows.view()),
        }
    }
}
