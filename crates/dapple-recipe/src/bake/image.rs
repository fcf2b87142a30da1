//! Writes maps to image files.

use super::{MapKind, MapRows};
use dapple_image::{Content, ImageError, RowWriter};
use std::io::{Seek, Write};

impl MapKind {
    /// Returns the content type of the map's image file, which determines how its values are encoded.
    #[must_use]
    pub fn content(self) -> Content {
        match self {
            Self::Normal => Content::Normal,
            Self::Albedo | Self::Emission => Content::Color,
            Self::Orm => Content::Packed,
            Self::Height
            | Self::Occlusion
            | Self::Curvature
            | Self::Roughness
            | Self::Metallic
            | Self::Opacity
            | Self::Specular
            | Self::Clearcoat => Content::Gray,
        }
    }
}

impl MapRows {
    /// Writes the rows as the next rows of an image. The writer must be created for the [`content`](MapKind::content)
    /// of their map.
    ///
    /// # Errors
    ///
    /// If [`RowWriter`] fails to write.
    pub fn write<W: Write + Seek>(&self, writer: &mut RowWriter<W>) -> Result<(), ImageError> {
        match self {
            Self::Gray(rows) => writer.write_gray(rows.view()),
            Self::Color(rows) => writer.write_color(rows.view()),
            Self::Normal(rows) => writer.write_normals(rows.view()),
            Self::Packed(rows) => writer.write_packed(rows.view()),
        }
    }
}
