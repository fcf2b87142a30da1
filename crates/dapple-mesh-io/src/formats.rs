//! The table of formats, one line for each: source of reading and writing by path, errors and help texts.
//!
//! A format is a file of this folder with a [`MeshFormat`]; adding one takes that file and two lines here.

#[cfg(feature = "gltf")]
pub mod gltf;
pub mod obj;
pub mod off;
pub mod ply;
pub mod stl;

use crate::MeshIoError;
use dapple_mesh::{EncodedImage, Model};
use std::path::Path;

/// All formats, in the order in which texts list them.
pub static FORMATS: &[MeshFormat] = &[
    obj::OBJ,
    ply::PLY,
    #[cfg(feature = "gltf")]
    gltf::GLTF,
    off::OFF,
    stl::STL,
];

/// A format of mesh files.
#[derive(Clone, Copy, Debug)]
pub struct MeshFormat {
    name: &'static str,
    /// The endings without the dot, in lower case.
    endings: &'static [&'static str],
    read: fn(&[u8], &mut FileResolver<'_>) -> Result<Model, MeshIoError>,
    writer: Option<Writer>,
}

/// The writer of a format.
#[derive(Clone, Copy, Debug)]
struct Writer {
    /// The ending of written files, one of the endings of the format.
    ending: &'static str,
    material: MaterialPlace,
    /// Whether colors of vertices are written.
    has_colors: bool,
    /// Encodes the files, the main one last.
    files: fn(&Model, &str) -> Result<Vec<NamedFile>, MeshIoError>,
    /// Encodes the file that was read, with other images in place of some.
    replace_images: Option<ReplaceImages>,
}

/// A function that takes a file, the files beside it, and pairs of an image and its replacement.
type ReplaceImages = fn(
    &[u8],
    &mut FileResolver<'_>,
    &[(EncodedImage, EncodedImage)],
) -> Result<Vec<u8>, MeshIoError>;

/// The place where a writer puts the material of a model, with its textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialPlace {
    /// The material is left out; [colors of vertices](MeshFormat::has_colors) may be written.
    Nowhere,
    /// The material is in the file of the mesh.
    Inside,
    /// The material is in separate files beside the mesh.
    Beside,
}

/// A function that returns the content of another file by the name that a file has for it; `None` if there is no such
/// file.
///
/// It is an argument of readers of formats with several files. A name is as in the file, with slashes and without
/// percent codes. It may be a path to anywhere, so a caller that opens files has to check it first.
pub type FileResolver<'a> = dyn FnMut(&str) -> Option<Vec<u8>> + 'a;

/// The name and the content of a file that is to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFile {
    /// The name, without a folder.
    pub name: String,
    /// The content.
    pub bytes: Vec<u8>,
}

impl MeshFormat {
    /// The format with the ending of a path, in lower or upper case.
    #[must_use]
    pub fn of_path(path: impl AsRef<Path>) -> Option<&'static Self> {
        let ending = ending(path.as_ref());
        let mut formats = FORMATS.iter();
        formats.find(|format| format.endings.contains(&ending.as_str()))
    }

    /// The name of the format, such as `glTF`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The endings of the names of files that are read, without the dot and in lower case.
    #[must_use]
    pub fn endings(&self) -> &'static [&'static str] {
        self.endings
    }

    /// The ending of the names of files that are written; `None` if the format is only read.
    #[must_use]
    pub fn written_ending(&self) -> Option<&'static str> {
        self.writer.map(|writer| writer.ending)
    }

    /// The place of the material, with its textures, in a written model.
    #[must_use]
    pub fn material_place(&self) -> MaterialPlace {
        self.writer
            .map_or(MaterialPlace::Nowhere, |writer| writer.material)
    }

    /// Whether the colors of vertices are in a written model.
    #[must_use]
    pub fn has_colors(&self) -> bool {
        self.writer.is_some_and(|writer| writer.has_colors)
    }

    /// Reads a file from its bytes, and files to which it refers through `beside`.
    ///
    /// # Errors
    ///
    /// The errors of the function `read` of the module of the format.
    pub fn read(&self, bytes: &[u8], resolve: &mut FileResolver<'_>) -> Result<Model, MeshIoError> {
        (self.read)(bytes, resolve)
    }

    /// Encodes a file of this format with the second image of each pair in place of the first, and nothing else changed,
    /// as one file with [`written_ending`](Self::written_ending); `None` if the format holds no images.
    ///
    /// # Errors
    ///
    /// The errors of the function `replace_images` of the module of the format.
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

    /// Encodes the files of a model, named after `stem`. The main one is the last; files to which it refers come before
    /// it.
    ///
    /// # Errors
    ///
    /// [`MeshIoErrorKind::Format`](crate::MeshIoErrorKind::Format) if the format is only read; and the errors of the
    /// function `write` of the module of the format.
    pub fn write(&self, model: &Model, stem: &str) -> Result<Vec<NamedFile>, MeshIoError> {
        let Some(writer) = self.writer else {
            return Err(crate::files::unwritable(self.endings[0].to_owned()));
        };
        (writer.files)(model, stem)
    }
}

/// The endings of all files that can be read, in the order of [`FORMATS`].
pub fn readable_endings() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().flat_map(|format| format.endings).copied()
}

/// The endings of all files that can be written, in the order of [`FORMATS`].
pub fn writable_endings() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().filter_map(MeshFormat::written_ending)
}

/// The ending of a path in lower case, without the dot; empty if there is none.
pub(crate) fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    ending.to_ascii_lowercase()
}

/// The only file of a format that needs no other files.
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
