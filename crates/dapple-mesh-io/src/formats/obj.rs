//! Wavefront's OBJ format, with materials in MTL files.
//!
//! Reference: Wavefront, *Advanced Visualizer Manual*, appendix B1 (Object Files) and B2 (MTL). Vertex colors follow
//! `v x y z`, as many programs write them. The v axis of OBJ points up, so v becomes 1 - v when reading and writing.
//!
//! All faces become one mesh, regardless of objects, groups and materials, so that a texture can continue across them.
//! The material is the first one used by a face. Corner normals become vertex normals if no vertex has two different
//! ones; if a corner has no normal, all normals are omitted. Corners may refer to texture coordinates and normals that
//! the file lacks; these are omitted and listed in [`Model::left_out`]. Lines, points and free-form surfaces are
//! omitted and listed as well.
//!
//! Of a material, `Kd`, `d`, `map_Kd` and `norm` are read and written. `Kd` is linear, and used only without a
//! texture, since it is rarely meaningful with one. The texture options `-s` and `-o` are applied to the texture
//! coordinates. A texture whose name contains `<UDIM>` or `<UVTILE>`, or the number of a unit square whose files all
//! exist, is one texture per unit square: see [`Model::tiles`]. A texture that is missing, or neither PNG nor JPEG, is
//! omitted and listed, as are other textures and options.
//!
//! This reader, written for dapple, guarantees all bits of `f64`, errors with line numbers, a list of omitted parts,
//! and bounded memory for any input.

mod mtl;
mod write;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tile_tests;

pub use write::{write, write_files};

use super::{FileResolver, MaterialPlace, MeshFormat, Writer};
use crate::MeshIoError;
use crate::colors::{self, Coding};
use crate::line::{Line, lines};
use crate::polygon::Polygons;
use crate::text::{content, no_vertex, parse};
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::{Mesh, Model};
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::collections::BTreeSet;

const FORMAT: &str = "OBJ";

/// Entry for OBJ in the table of formats.
pub(super) const OBJ: MeshFormat = MeshFormat {
    name: FORMAT,
    endings: &["obj"],
    read: read_with,
    writer: Some(Writer {
        ending: "obj",
        material: MaterialPlace::Beside,
        has_colors: true,
        files: write_files,
        replace_images: None,
    }),
};

/// Index that stands for a missing texture coordinate or normal of a corner.
const NONE: u32 = u32::MAX;
/// Index of a texture coordinate or normal that cannot exist, such as one above the maximum.
const MISSING: u32 = u32::MAX - 1;

/// Indices of the position, texture coordinate and normal of a corner.
type Corner = [u32; 3];

#[derive(Default)]
struct Draft {
    positions: Vec<DVec3>,
    /// Colors of the vertices, up to the last vertex that has one; later vertices are white.
    colors: Vec<LinearRgba>,
    uvs: Vec<DVec2>,
    normals: Vec<DVec3>,
    faces: Vec<[Corner; 3]>,
    polygons: Polygons,
    libraries: Vec<String>,
    /// Kinds of skipped elements, which a model cannot represent.
    skipped: BTreeSet<&'static str>,
    /// Name of the current material, and whether a face uses it.
    material: Option<(String, bool)>,
    /// Two flags: whether the current material differs from the first one that was used, and whether any face has used
    /// such a different material.
    others: [bool; 2],
}

/// Reads an OBJ file without its material.
///
/// # Errors
///
/// [`MeshIoErrorKind::File`](crate::MeshIoErrorKind::File) with the line number if the bytes are not an OBJ file, or
/// any error from [`Mesh::new`] and [`Model::check`].
///
/// # Examples
///
/// ```
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 -1\n";
/// let model = dapple_mesh_io::obj::read(text)?;
/// assert_eq!(model.mesh.faces().len(), 2);
/// # Ok::<(), dapple_mesh_io::MeshIoError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Model, MeshIoError> {
    read_with(bytes, &mut |_| None)
}

/// Reads an OBJ file. `resolve` returns its MTL files and textures.
///
/// # Errors
///
/// Same as [`read`]. In other files, only text that is neither ASCII nor UTF-8, a keyword that is not ASCII, and a
/// `Kd` outside the range of `f32` give errors.
pub fn read_with(bytes: &[u8], resolve: &mut FileResolver<'_>) -> Result<Model, MeshIoError> {
    let mut draft = Draft::default();
    let text = joined(content(FORMAT, bytes)?);
    for line in lines(FORMAT, &text)? {
        draft.add(&line)?;
    }
    if draft.positions.is_empty() && draft.faces.is_empty() {
        return Err(MeshIoError::file(
            FORMAT,
            "it has neither a vertex nor a face",
        ));
    }
    draft.check_vertices(&text)?;
    let libraries = core::mem::take(&mut draft.libraries);
    let name = draft.material.take().map(|(name, _)| name);
    let mut model = draft.into_model()?;
    mtl::add_material(&mut model, &libraries, name.as_deref(), resolve)?;
    model.check()?;
    Ok(model)
}

/// Joins lines that end with a backslash to the next one. Comments are excluded, since a backslash there is often the
/// end of a path. A joined line is padded with newlines, so that all other lines keep their numbers.
fn joined(bytes: &[u8]) -> Cow<'_, [u8]> {
    let continued = |pair: &[u8]| pair[0] == b'\\' && matches!(pair[1], b'\n' | b'\r');
    if !bytes.windows(2).any(continued) {
        return Cow::Borrowed(bytes);
    }
    let mut text = Vec::with_capacity(bytes.len());
    let mut n_joined = 0;
    for line in bytes.split_inclusive(|&byte| byte == b'\n') {
        let content = line.trim_ascii_end();
        let is_comment = n_joined == 0 && line.starts_with(b"#");
        match content.strip_suffix(b"\\") {
            // The backslash is the last byte before the newline.
            Some(start)
                if !is_comment && matches!(line[content.len()..], [b'\n'] | [b'\r', b'\n']) =>
            {
                text.extend(start);
                text.push(b' ');
                n_joined += 1;
            }
            _ => {
                text.extend(line);
                text.resize(text.len() + core::mem::take(&mut n_joined), b'\n');
            }
        }
    }
    Cow::Owned(text)
}

impl Draft {
    fn add(&mut self, line: &Line<'_>) -> Result<(), MeshIoError> {
        match line.keyword()? {
            b"v" => self.add_vertex(line)?,
            b"vt" => {
                let v = if line.words.len() > 2 {
                    line.part(2)?
                } else {
                    0.0
                };
                self.uvs.push(DVec2::new(line.part(1)?, 1.0 - v));
            }
            b"vn" => self.normals.push(line.position(1)?),
            b"f" => self.add_face(line)?,
            b"l" => _ = self.skipped.insert("lines"),
            b"p" => _ = self.skipped.insert("points"),
            b"curv" | b"curv2" | b"surf" => _ = self.skipped.insert("free-form surfaces"),
            // Some programs repeat this line for each object.
            b"mtllib" if self.libraries.last() != Some(&name(line)) => {
                self.libraries.push(name(line));
            }
            b"usemtl" => match &self.material {
                Some((first, true)) => self.others[0] = *first != name(line),
                _ => self.material = Some((name(line), false)),
            },
            _ => {}
        }
        Ok(())
    }

    fn add_vertex(&mut self, line: &Line<'_>) -> Result<(), MeshIoError> {
        // The weight in `v x y z w` is only used by free-form surfaces.
        if line.words.len() >= 7 {
            let color = line.vector(4)?;
            let parts = [color.x, color.y, color.z, 1.0];
            self.colors.resize(self.positions.len(), WHITE);
            self.colors.push(colors::decode(parts, [Coding::Unit; 4]));
        }
        self.positions.push(line.position(1)?);
        Ok(())
    }

    fn add_face(&mut self, line: &Line<'_>) -> Result<(), MeshIoError> {
        let corner = |word: &&[u8]| {
            self.corner(word)
                .ok_or_else(|| line.error("a corner is not v, v/vt, v//vn or v/vt/vn"))
        };
        let corners = line.words[1..]
            .iter()
            .map(corner)
            .collect::<Result<Vec<_>, _>>()?;
        self.polygons.push(&corners, &mut self.faces);
        if let Some((_, used)) = &mut self.material {
            *used = true;
        }
        self.others[1] |= self.others[0];
        Ok(())
    }

    /// Parses a corner into zero-based indices. Numbers in the file start at 1; negative numbers count backward from
    /// the last item.
    fn corner(&self, word: &[u8]) -> Option<Corner> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let mut corner = [NONE; 3];
        let mut parts = word.split(|&byte| byte == b'/');
        for (i, count) in counts.into_iter().enumerate() {
            match parts.next() {
                Some(b"") | None if i > 0 => {}
                part => {
                    let index = index(parse(part?)?, count);
                    corner[i] = if i == 0 {
                        index?
                    } else {
                        index.unwrap_or(MISSING)
                    };
                }
            }
        }
        parts.next().is_none().then_some(corner)
    }

    /// Fails if a face refers to a missing vertex.
    fn check_vertices(&self, text: &[u8]) -> Result<(), MeshIoError> {
        let count = self.positions.len();
        let missing = |corner: &&Corner| corner[0] as usize >= count;
        let corners = self.faces.iter().enumerate();
        let mut first =
            corners.filter_map(|(face, corners)| Some((face, corners.iter().find(missing)?)));
        let Some((face, corner)) = first.next() else {
            return Ok(());
        };
        // Vertices may follow the faces, so find the line only now.
        let mut n_faces = 0;
        for line in lines(FORMAT, text)?.filter(|line| line.words[0] == b"f") {
            n_faces += line.words.len().saturating_sub(3);
            if n_faces > face {
                return Err(line.error(no_vertex(u64::from(corner[0]) + 1, count)));
            }
        }
        Ok(())
    }

    /// Removes references to texture coordinates and normals that the file lacks. Returns the texts for
    /// [`Model::left_out`].
    fn take_away_missing(&mut self) -> Vec<String> {
        let mut left_out = Vec::new();
        for (i, count, what) in [
            (1, self.uvs.len(), "texture coordinates"),
            (2, self.normals.len(), "normals"),
        ] {
            let mut is_missing = false;
            for corner in self.faces.iter_mut().flatten() {
                if corner[i] != NONE && corner[i] as usize >= count {
                    corner[i] = NONE;
                    is_missing = true;
                }
            }
            if is_missing {
                left_out.push(format!("{what} that faces name and the file does not have"));
            }
        }
        left_out
    }

    fn into_model(mut self) -> Result<Model, MeshIoError> {
        let mut left_out = self.take_away_missing();
        left_out.extend(self.skipped.iter().map(|&what| what.to_owned()));
        if self.others[1] {
            left_out.push(Model::FURTHER_MATERIALS.to_owned());
        }
        let ears = core::mem::take(&mut self.polygons);
        let ears = ears.ears(&self.faces, &self.positions, |[vertex, ..]| vertex);
        ears.apply(&mut self.faces);
        left_out.extend(ears.left_out());
        let faces: Vec<_> = self
            .faces
            .iter()
            .map(|face| face.map(|corner| corner[0]))
            .collect();
        let uvs = self.face_uvs();
        // All vertex indices were checked before normals are assigned to vertices.
        let count = self.positions.len();
        let mesh = Mesh::new(core::mem::take(&mut self.positions), &faces)?;
        let corner_normals = self.corner_normals();
        let normals = self.vertex_normals(count, corner_normals.as_deref());
        // Corner normals are only needed at creases.
        let corner_normals = corner_normals.filter(|_| normals.is_none());
        if !self.colors.is_empty() {
            self.colors.resize(count, WHITE);
        }
        let colors = (!self.colors.is_empty()).then_some(self.colors);
        let model = Model {
            mesh,
            colors,
            uvs,
            normals,
            left_out,
            corner_normals,
            ..Model::default()
        };
        model.check()?;
        Ok(model)
    }

    /// Returns the texture coordinates of the corners, zero where missing; `None` if no corner has any.
    fn face_uvs(&self) -> Option<Vec<[DVec2; 3]>> {
        if self.faces.iter().flatten().all(|corner| corner[1] == NONE) {
            return None;
        }
        let uv = |[_, uv, _]: Corner| self.uvs.get(uv as usize).copied().unwrap_or_default();
        Some(self.faces.iter().map(|face| face.map(uv)).collect())
    }

    /// Returns the corner normals of all faces, if every corner has one.
    fn corner_normals(&self) -> Option<Vec<[DVec3; 3]>> {
        if self.faces.is_empty() {
            return None;
        }
        let normal = |&[_, _, number]: &Corner| self.normals.get(number as usize).copied();
        let of_face = |[a, b, c]: &[Corner; 3]| Some([normal(a)?, normal(b)?, normal(c)?]);
        self.faces.iter().map(of_face).collect()
    }

    /// Returns the vertex normals; `None` if a vertex has two different ones at its corners. The normals of a point
    /// cloud are in file order.
    fn vertex_normals(
        &self,
        count: usize,
        corner_normals: Option<&[[DVec3; 3]]>,
    ) -> Option<Vec<DVec3>> {
        if self.faces.is_empty() {
            let whole = count > 0 && self.normals.len() == count;
            return whole.then(|| self.normals.clone());
        }
        let mut normals = vec![None; count];
        for (face, of_corners) in self.faces.iter().zip(corner_normals?) {
            for (&[vertex, ..], &normal) in face.iter().zip(of_corners) {
                if *normals[vertex as usize].get_or_insert(normal) != normal {
                    return None;
                }
            }
        }
        Some(normals.into_iter().map(Option::unwrap_or_default).collect())
    }
}

/// Color of vertices without a color in a file where other vertices have one.
const WHITE: LinearRgba = LinearRgba::opaque(LinearRgb::WHITE);

/// Returns the rest of a line as a name, which may contain spaces.
fn name(line: &Line<'_>) -> String {
    joined_words(&line.name_words())
}

fn joined_words(words: &[&[u8]]) -> String {
    String::from_utf8_lossy(&words.join(b" ".as_slice())).into_owned()
}

fn index(number: i64, count: usize) -> Option<u32> {
    let from_zero = if number > 0 {
        number - 1
    } else {
        i64::try_from(count).ok()? + number
    };
    // Zero is not a valid number; it would become one past the last item.
    u32::try_from(from_zero)
        .ok()
        .filter(|&index| number != 0 && index != NONE)
}
