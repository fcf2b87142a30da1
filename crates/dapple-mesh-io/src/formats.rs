//! Table of mesh file formats. Reading and writing by path, error messages and help texts are derived from it.
//!
//! A format is a module of this folder with a [`MeshFormat`]. A new format needs that module and two lines here.

#[cfg(feature = "gltf")]
pub mod gltf;
pub mod obj;
pub mod off;
pub mod ply;
pub mod stl;

use crate::MeshIoError;
use dapple_mesh::{EncodedImage, Model};
use std::path::Path;

/// All formats, in the order of error messages and help texts.
pub static FORMATS: &[MeshFormat] = &[
    obj::OBJ,
    ply::PLY,
    #[cfg(feature = "gltf")]
    gltf::GLTF,
    off::OFF,
    stl::STL,
];

/// A mesh file format.
#[derive(Clone, Copy, Debug)]
pub struct MeshFormat {
    name: &'static str,
    /// File extensions without the dot, in lower case.
    endings: &'static [&'static str],
    read: fn(&[u8], &mut FileResolver<'_>) -> Result<Model, MeshIoError>,
    writer: Option<Writer>,
}

/// How a format is written.
#[derive(Clone, Copy, Debug)]
struct Writer {
    /// Extension of written files, one of the extensions of the format.
    ending: &'static str,
    material: MaterialPlace,
    /// Whether vertex colors are written.
    has_colors: bool,
    /// Encodes the files of a model with a given stem. The main file is the last one.
    files: fn(&Model, &str) -> Result<Vec<NamedFile>, MeshIoError>,
    /// Encodes an existing file again with some images replaced; `None` if the format cannot contain images.
    replace_images: Option<ReplaceImages>,
}

/// Function that replaces images. It takes the bytes of a file, a resolver, and pairs of an image and its
/// replacement.
type ReplaceImages = fn(
    &[u8],
    &mut FileResolver<'_>,
    &[(EncodedImage, EncodedImage)],
) -> Result<Vec<u8>, MeshIoError>;

/// Where a format writes a model's material and its textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialPlace {
    /// The material is omitted; [vertex colors](MeshFormat::has_colors) may be written.
    Nowhere,
    /// The material is part of the mesh file.
    Inside,
    /// The material is in separate files in the same folder.
    Beside,
}

/// Function that returns the content of a referenced file, given the name that the referring file uses; `None` if
/// there is no such file.
///
/// Readers of multi-file formats take it as an argument. The name is passed as in the file, with slashes and without
/// percent-encoding. It may be a path to anywhere, so a caller that opens files must check it first.
pub type FileResolver<'a> = dyn FnMut(&str) -> Option<Vec<u8>> + 'a;

/// A file to write: its name and content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFile {
    /// File name, without a folder.
    pub name: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
}

impl MeshFormat {
    /// Returns the format for the extension of a path, ignoring case.
    #[must_use]
    pub fn of_path(path: impl AsRef<Path>) -> Option<&'static Self> {
        let ending = ending(path.as_ref());
        let mut formats = FORMATS.iter();
        formats.find(|format| format.endings.contains(&ending.as_str()))
    }

    /// Returns the name of the format, such as `glTF`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the extensions of readable files, without the dot and in lower case.
    #[must_use]
    pub fn endings(&self) -> &'static [&'static str] {
        self.endings
    }

    /// Returns the extension of written files; `None` if the format is read-only.
    #[must_use]
    pub fn written_ending(&self) -> Option<&'static str> {
        self.writer.map(|writer| writer.ending)
    }

    /// Returns where the format writes the material and its textures.
    #[must_use]
    pub fn material_place(&self) -> MaterialPlace {
        self.writer
            .map_or(MaterialPlace::Nowhere, |writer| writer.material)
    }

    /// Returns whether vertex colors are written.
    #[must_use]
    pub fn has_colors(&self) -> bool {
        self.writer.is_some_and(|writer| writer.has_colors)
    }

    /// Reads a model from the bytes of a file. `resolve` returns the content of files that it refers to.
    ///
    /// # Errors
    ///
    /// Any error from the `read` function in the format's module.
    pub fn read(&self, bytes: &[u8], resolve: &mut FileResolver<'_>) -> Result<Model, MeshIoError> {
        (self.read)(bytes, resolve)
    }

    /// Encodes a file of this format again, with the first image of each pair replaced by the second. Nothing else
    /// changes. Returns a single file whose extension is [`written_ending`](Self::written_ending), or `None` if the
    /// format cannot contain images.
    ///
    /// # Errors
    ///
    /// Any error from the `replace_images` function in the format's module.
    pub fn replace_images(
        &self,
        bytes: &[u8],
        resolve: &mut FileResolver<'_>,
        replaced: &[(EncodedImage, EncodedImage)],
    ) -> Result<Option<Vec<u8>>, MeshIoError> {
        let replace = self.writer.and_then(|writer| writer.replace_images);
        replace
            .map(|replace| replace(bytes, resolve, replaced))
            .transpose()
    }

    /// Encodes the files of a model, named after `stem`. The main file is the last one; files that it refers to come
    /// first.
    ///
    /// # Errors
    ///
    /// [`MeshIoErrorKind::Format`](crate::MeshIoErrorKind::Format) if the format is read-only; or any error from the
    /// `write` function in the format's module.
    pub fn write(&self, model: &Model, stem: &str) -> Result<Vec<NamedFile>, MeshIoError> {
        let Some(writer) = self.writer else {
            return Err(crate::files::unwritable(self.endings[0].to_owned()));
        };
        (writer.files)(model, stem)
    }
}

/// Returns the extensions of all readable files, in the order of [`FORMATS`].
pub fn readable_endings() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().flat_map(|format| format.endings).copied()
}

/// Returns the extensions of all writable files, in the order of [`FORMATS`].
pub fn writable_endings() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().filter_map(MeshFormat::written_ending)
}

/// Returns the extension of a path in lower case, without the dot; empty if there is none.
pub(crate) fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    ending.to_ascii_lowercase()
}

/// Returns the only file of a format that writes a single file.
fn alone(stem: &str, ending: &str, bytes: Vec<u8>) -> Vec<NamedFile> {
    let name = format!("{stem}.{ending}");
    vec![NamedFile { name, bytes }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_formats_share_an_ending_and_what_is_written_can_be_read() {
        let mut endings: Vec<_> = readable_endings().collect();
        for format in FORMATS {
            for ending in format.endings() {
                let path = format!("a.b.{}", ending.to_uppercase());
                let found = MeshFormat::of_path(path).expect("its own ending");
                assert_eq!(found.name(), format.name());
            }
            let written = format.written_ending();
            let is_read = written.is_none_or(|ending| format.endings().contains(&ending));
            assert!(is_read, "{} cannot read what it writes", format.name());
        }
        endings.sort_unstable();
        let n_endings = endings.len();
        endings.dedup();
        assert_eq!(endings.len(), n_endings, "an ending has two formats");
    }

    #[test]
    fn a_format_without_a_writer_refuses_to_write() {
        let error = off::OFF
            .write(&Model::default(), "a")
            .expect_err("only read");
        let written: Vec<_> = writable_endings().collect();
        assert_eq!(
            error.to_string(),
            format!(
                "no mesh format is named `off`; there are {} to write",
                written.join(", ")
            )
        );
    }
}
