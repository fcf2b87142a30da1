//! STL, the 3D printing format, which stores triangles without attributes.
//!
//! Reference: 3D Systems, *Stereolithography Interface Specification* (1989), as Marshall Burns describes it in *Automated
//! Fabrication* (1993), section 6.5.
//!
//! Binary and text files are read; all solids of a text file become one mesh. STL has no shared vertices, so corners
//! at the same position are merged into one vertex. Face normals are ignored, since positions determine them. Face
//! attributes, which some programs use for colors, are listed in [`Model::left_out`]. Files are written as binary, or
//! as text if `f32` would move the vertices of a mesh far from the origin.

use super::{MaterialPlace, MeshFormat, Writer, alone};
use crate::line::{Line, lines};
use crate::single::{narrow, origin};
use crate::text::shortest;
use crate::{MeshIoError, MeshIoErrorKind};
use dapple_mesh::{Mesh, Model};
use glam::DVec3;
use std::collections::BTreeMap;

const FORMAT: &str = "STL";

/// Entry for STL in the table of formats.
pub(super) const STL: MeshFormat = MeshFormat {
    name: FORMAT,
    endings: &["stl"],
    read: |bytes, _| read(bytes),
    writer: Some(Writer {
        ending: "stl",
        material: MaterialPlace::Nowhere,
        has_colors: false,
        files: |model, stem| Ok(alone(stem, "stl", write(model)?)),
        replace_images: None,
    }),
};

/// Number of bytes before the first face of a binary file; they hold a text and the number of faces.
const HEAD: usize = 84;
/// Number of bytes per face of a binary file: a normal, three positions, and two bytes of attributes.
const FACE: usize = 50;

/// Faces read so far. Corners at the same position share a vertex.
#[derive(Default)]
struct Draft {
    positions: Vec<DVec3>,
    /// Vertex at each position, keyed by the bits of its coordinates.
    vertices: BTreeMap<[u64; 3], u32>,
    faces: Vec<[u32; 3]>,
}

/// Reads an STL file.
///
/// # Errors
///
/// [`MeshIoErrorKind::File`] if the bytes are not an STL file, with the line number in a text, or any error from
/// [`Mesh::new`].
///
/// # Examples
///
/// ```
/// let text = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
/// let model = dapple_mesh_io::stl::read(text)?;
/// assert_eq!(model.mesh.faces().len(), 1);
/// # Ok::<(), dapple_mesh_io::MeshIoError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Model, MeshIoError> {
    match binary(bytes) {
        Some(faces) => read_binary(faces),
        None => read_text(bytes),
    }
}

/// Encodes the mesh as a binary STL file, with values rounded to `f32`. If that would move a vertex by more than
/// 2^-20 of the extent, because the mesh is far from the origin, the file is text, with the shortest digits that read
/// back as the same `f64`. Colors, texture coordinates and the material are omitted.
///
/// # Errors
///
/// Same as [`Model::check`], plus [`MeshIoErrorKind::Size`] if the file would have 2^32 bytes or more.
pub fn write(model: &Model) -> Result<Vec<u8>, MeshIoError> {
    model.check()?;
    let n_faces = model.mesh.faces().len();
    let bytes = HEAD + FACE * n_faces;
    if u32::try_from(bytes).is_err() {
        let format = FORMAT;
        return Err(MeshIoError::new(MeshIoErrorKind::Size { format, bytes }));
    }
    if origin(model.mesh.positions()).is_some() {
        return Ok(text(&model.mesh).into_bytes());
    }
    let mut file = Vec::with_capacity(bytes);
    // A binary file must not start with `solid`, which marks text.
    file.extend(b"dapple");
    file.resize(HEAD - 4, b' ');
    file.extend((n_faces as u32).to_le_bytes());
    for corners in corners(&model.mesh) {
        let normal = normal(corners).as_vec3().to_array();
        let corners = corners.map(|corner| corner.to_array().map(narrow));
        let numbers = [normal].into_iter().chain(corners).flatten();
        file.extend(numbers.flat_map(f32::to_le_bytes));
        file.extend([0, 0]);
    }
    Ok(file)
}

/// Returns the faces of a binary file; `None` if it is text. Binary files may start with the keyword of text, so the
/// length is checked first.
fn binary(bytes: &[u8]) -> Option<&[u8]> {
    let count = bytes.get(HEAD - 4..HEAD)?.try_into().ok()?;
    let count = u32::from_le_bytes(count) as usize;
    let rest = &bytes[HEAD..];
    let length = count.checked_mul(FACE)?;
    let is_text = bytes.trim_ascii_start().starts_with(b"solid") && rest.len() != length;
    rest.get(..length).filter(|_| !is_text)
}

fn read_binary(faces: &[u8]) -> Result<Model, MeshIoError> {
    let mut draft = Draft::default();
    let mut has_attributes = false;
    for face in faces.as_chunks::<FACE>().0 {
        let (numbers, attributes) = face.as_chunks::<4>();
        let mut parts = [0.0; 12];
        for (part, number) in parts.iter_mut().zip(numbers) {
            *part = f64::from(f32::from_le_bytes(*number));
        }
        let [_, corners @ ..]: [DVec3; 4] =
            [0, 3, 6, 9].map(|at| DVec3::from_slice(&parts[at..at + 3]));
        draft.add(corners)?;
        has_attributes |= attributes != [0, 0];
    }
    let mut model = draft.into_model()?;
    if has_attributes {
        model.left_out.push("attributes of faces".to_owned());
    }
    Ok(model)
}

fn read_text(bytes: &[u8]) -> Result<Model, MeshIoError> {
    let mut draft = Draft::default();
    let (mut corners, mut is_solid) = (Vec::new(), false);
    for line in lines(FORMAT, bytes)? {
        let keyword = line.keyword()?.to_ascii_lowercase();
        match keyword.as_slice() {
            b"solid" => is_solid = true,
            _ if !is_solid => return Err(line.error("the first word is not `solid`")),
            b"vertex" => corners.push(line.position(1)?),
            b"endloop" => draft.add(three(&line, &corners)?)?,
            b"outer" => corners.clear(),
            b"facet" | b"endfacet" | b"endsolid" => {}
            _ => return Err(line.error("this is nothing that a text of STL says")),
        }
    }
    if !is_solid {
        let why = "it is neither text nor as long as its number of faces says";
        return Err(MeshIoError::file(FORMAT, why));
    }
    draft.into_model()
}

fn three(line: &Line<'_>, corners: &[DVec3]) -> Result<[DVec3; 3], MeshIoError> {
    let why = || {
        line.error(format!(
            "a face has {} corners, but must have 3",
            corners.len()
        ))
    };
    corners.try_into().map_err(|_| why())
}

/// Returns the corners of each face.
fn corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> {
    let positions = mesh.positions();
    let faces = mesh.faces().iter();
    faces.map(|face| face.map(|vertex| positions[vertex.index()]))
}

/// Returns the normal of a face; zero if it has no area.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

fn text(mesh: &Mesh) -> String {
    let mut text = "solid dapple\n".to_owned();
    for corners in corners(mesh) {
        add(
            &mut text,
            "facet normal",
            normal(corners).as_vec3().as_dvec3(),
        );
        text.push_str("outer loop\n");
        for corner in corners {
            add(&mut text, "vertex", corner);
        }
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid dapple\n"
}

/// Appends a line with `keyword` and a vector.
fn add(text: &mut String, keyword: &str, vector: DVec3) {
    text.push_str(keyword);
    for part in vector.to_array() {
        text.push(' ');
        shortest(text, part);
    }
    text.push('\n');
}

impl Draft {
    fn add(&mut self, corners: [DVec3; 3]) -> Result<(), MeshIoError> {
        let mut face = [0; 3];
        for (vertex, corner) in face.iter_mut().zip(corners) {
            // Adding zero makes both zeros the same position.
            let bits = (corner + DVec3::ZERO).to_array().map(f64::to_bits);
            let next = u32::try_from(self.positions.len());
            let next =
                next.map_err(|_| MeshIoError::file(FORMAT, "there are too many vertices"))?;
            *vertex = *self.vertices.entry(bits).or_insert(next);
            if *vertex == next {
                self.positions.push(corner);
            }
        }
        self.faces.push(face);
        Ok(())
    }

    fn into_model(self) -> Result<Model, MeshIoError> {
        Ok(Model::from(Mesh::new(self.positions, &self.faces)?))
    }
}

#[cfg(test)]
mod tests;
