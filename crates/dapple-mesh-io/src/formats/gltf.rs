//! glTF 2.0: reading glTF and GLB, and writing GLB.
//!
//! Reference: The Khronos Group, *glTF 2.0 Specification*, 2021 (ISO/IEC 12113:2022).
//!
//! All triangles of the default scene become one mesh, with the transforms of their nodes applied. Without a scene,
//! all nodes are used. All copies made by `EXT_mesh_gpu_instancing` are included. Triangle strips and fans become
//! triangles, and point primitives become vertices without faces; lines and animations are omitted. Skins and morph
//! targets are applied in the pose without animation. Primitives of one node with the same attributes share their
//! vertices. If only some primitives have colors or texture coordinates, the others become white and zero; normals
//! are retained only if all primitives have them. The material is the first one used by a primitive.
//!
//! Textures are copied unchanged if they are PNG or JPEG and use the same texture coordinates as the base color,
//! whose `KHR_texture_transform` is applied to the corners. Everything else in a file that a
//! [`Material`](dapple_mesh::Material) cannot represent, such as emission, is listed in
//! [`Model::left_out`].
//!
//! At a seam of the texture, a glTF file has two vertices at one position; [`Mesh::repair`](dapple_mesh::Mesh::repair)
//! merges them. Texture coordinates belong to corners and are not affected;
//! [`Repair::face_before`](dapple_mesh::Repair) maps faces to the original faces.
//!
//! The crate `gltf` is not used as the reader: it panics on files that pass its validation (a test has one), does not
//! support instancing, and reads no data URIs without an image library. Tests use it as a second reader of written
//! files.

mod accessor;
mod container;
mod document;
mod images;
mod material;
mod scene;
mod skin;
mod transform;
mod write;

#[cfg(test)]
mod tests;

pub use images::replace_images;
pub use write::write;

use super::{FileResolver, MaterialPlace, MeshFormat, Writer, alone};
use crate::{MeshIoError, MeshIoErrorKind};
use container::{Container, percent_decoded};
use dapple_mesh::Model;
use document::{Document, Head, Image};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::borrow::Cow;

const FORMAT: &str = "glTF";

/// Entry for glTF in the table of formats.
pub(super) const GLTF: MeshFormat = MeshFormat {
    name: FORMAT,
    endings: &["glb", "gltf"],
    read: read_with,
    writer: Some(Writer {
        ending: "glb",
        material: MaterialPlace::Inside,
        has_colors: true,
        files: |model, stem| Ok(alone(stem, "glb", write(model)?)),
        replace_images: Some(replace_images),
    }),
};

/// Names of extensions that a file may require. Instancing and texture transforms are supported. The others do not
/// affect the model, or only add accessor types, all of which are read.
const EXTENSIONS: [&str; 6] = [
    "EXT_mesh_gpu_instancing",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
    "KHR_lights_punctual",
];

/// A parsed document and its buffers.
struct Source<'a> {
    document: Document,
    /// Bytes of each buffer; `None` for a missing buffer, which is an error only if it is used.
    buffers: Vec<Option<Cow<'a, [u8]>>>,
}

/// Reads a GLB file, or a glTF file that refers to no other file.
///
/// # Errors
///
/// [`MeshIoErrorKind::File`] if the bytes are not a glTF file, or it requires another file;
/// [`MeshIoErrorKind::Unsupported`] if its version is not 2, or it requires an extension, or any error from
/// [`Mesh::new`](dapple_mesh::Mesh::new) and [`Model::check`].
///
/// # Examples
///
/// ```
/// use dapple_mesh::{Mesh, Model, glam::DVec3};
/// use dapple_mesh_io::gltf;
///
/// let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let bytes = gltf::write(&Model::from(mesh.clone()))?;
/// assert_eq!(gltf::read(&bytes)?.mesh, mesh);
/// # Ok::<(), dapple_mesh_io::MeshIoError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Model, MeshIoError> {
    read_with(bytes, &mut |_| None)
}

/// Reads a glTF or GLB file. `resolve` returns its buffers and textures.
///
/// # Errors
///
/// Same as [`read`]. A missing texture is not an error.
pub fn read_with(bytes: &[u8], resolve: &mut FileResolver<'_>) -> Result<Model, MeshIoError> {
    let container = Container::read(bytes)?;
    // Check the version first: other versions have other types for the same properties.
    let Head { asset } = parse(container.json)?;
    if !asset.version.starts_with("2.") {
        return Err(unsupported(format!("glTF {}", asset.version)));
    }
    let document: Document = parse(container.json)?;
    let unknown = |name: &&String| !EXTENSIONS.contains(&name.as_str());
    if let Some(name) = document.extensions_required.iter().find(unknown) {
        return Err(unsupported(format!("the glTF extension {name}")));
    }
    let buffers = container.buffers(&document, resolve);
    let source = Source { document, buffers };
    let n_bytes = bytes.len()
        + source
            .buffers
            .iter()
            .flatten()
            .map(|buffer| buffer.len())
            .sum::<usize>();
    let (mut model, material) = scene::read(&source, n_bytes)?;
    if let Some(material) = material {
        source.read_material(material, &mut model, resolve);
    }
    if !source.document.animations.is_empty() {
        model.left_out.push("the animations".to_owned());
    }
    model.check()?;
    Ok(model)
}

fn parse<T: DeserializeOwned>(json: &[u8]) -> Result<T, MeshIoError> {
    // Rare files write an integer as `1.0`.
    let with_fractions = || {
        let mut value = serde_json::from_slice(json).ok()?;
        without_fractions(&mut value);
        serde_json::from_value(value).ok()
    };
    serde_json::from_slice(json)
        .or_else(|error| with_fractions().ok_or(error))
        .map_err(|error| wrong(error.to_string()))
}

/// Converts numbers such as `1.0` to integers.
fn without_fractions(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(without_fractions),
        Value::Object(entries) => entries.values_mut().for_each(without_fractions),
        Value::Number(number) => {
            // Integers up to 2^53 are exact.
            let whole = number
                .as_f64()
                .filter(|number| (0.0..9e15).contains(number));
            if let Some(whole) = whole.filter(|number| number.fract() == 0.0) {
                *value = (whole as u64).into();
            }
        }
        _ => {}
    }
}

fn unsupported(feature: String) -> MeshIoError {
    MeshIoError::new(MeshIoErrorKind::Unsupported { feature })
}

fn wrong(why: impl Into<String>) -> MeshIoError {
    MeshIoError::file(FORMAT, why)
}

impl Source<'_> {
    /// Returns the bytes of a buffer view.
    fn view(&self, index: usize) -> Result<&[u8], MeshIoError> {
        let view = self.document.buffer_views.get(index);
        let buffer = view.and_then(|view| self.buffers.get(view.buffer));
        if let (Some(view), Some(None)) = (view, buffer) {
            return Err(self.missing(view.buffer));
        }
        let bytes = view.zip(buffer).and_then(|(view, buffer)| {
            let end = view.byte_offset.checked_add(view.byte_length)?;
            buffer.as_ref()?.get(view.byte_offset..end)
        });
        bytes.ok_or_else(|| wrong(format!("there are no bytes for buffer view {index}")))
    }

    /// Creates the error for a buffer without bytes, which states the name of its file.
    fn missing(&self, buffer: usize) -> MeshIoError {
        let uri = self.document.buffers.get(buffer);
        let uri = uri.and_then(|buffer| buffer.uri.as_deref());
        let file = match uri.filter(|uri| !uri.starts_with("data:")) {
            Some(uri) => format!(
                ": {} has to be a regular file beside it",
                percent_decoded(uri)
            ),
            None => String::new(),
        };
        wrong(format!("the bytes of buffer {buffer} are missing{file}"))
    }

    /// Returns the bytes of an image, in any format.
    fn image_bytes(&self, image: &Image, resolve: &mut FileResolver<'_>) -> Option<Vec<u8>> {
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) if uri.starts_with("data:") => container::data(uri),
            (Some(uri), _) => resolve(&percent_decoded(uri)),
            (None, view) => Some(self.view(view?).ok()?.to_vec()),
        }
    }
}
