//! PLY, the Stanford polygon file format.
//!
//! Reference: Greg Turk, *The PLY Polygon File Format* (1994), as distributed with the models of the Stanford 3D
//! Scanning Repository.
//!
//! Text files and binary files of both byte orders are read, with any scalar type for any property. The following
//! properties are used:
//!
//! - Element `vertex`: `x y z`, `nx ny nz`, `red green blue alpha` (also with the prefix `diffuse_`, or as `r g b a`),
//!   and `s t`, `u v` or `texture_u texture_v`.
//! - Element `face`: the list `vertex_indices` or `vertex_index`, and `texcoord` with two numbers per corner, which
//!   takes precedence over texture coordinates of vertices.
//! - Element `tristrips`: the list `vertex_indices`, where -1 ends a strip.
//!
//! All other elements are listed in [`Model::left_out`], and other properties are skipped. The comment `TextureFile`
//! names the base color texture, as many programs write it. Colors are encoded as sRGB: 0 to 255, for `ushort` 0 to
//! 65535, and for `float` and `double` 0 to 1. As in OBJ, the v axis of the file points up, so v becomes 1 - v.
//!
//! This reader, written for dapple, guarantees any scalar type for any property, errors with line numbers, and
//! bounded memory for any header.

mod body;
mod header;
mod write;

#[cfg(test)]
mod tests;

pub use write::{write, write_text};

use super::{FileResolver, MaterialPlace, MeshFormat, Writer, alone};
use crate::MeshIoError;
use crate::colors::{self, Coding};
use crate::polygon::{Polygons, fan, strip};
use crate::text::{content, no_vertex};
use crate::texture::{shown, texture};
use body::Body;
use dapple_color::LinearRgba;
use dapple_mesh::{Mesh, Model};
use glam::{DVec2, DVec3};
use header::{Element, Header, Kind, Scalar};

const FORMAT: &str = "PLY";

/// Entry for PLY in the table of formats.
pub(super) const PLY: MeshFormat = MeshFormat {
    name: FORMAT,
    endings: &["ply"],
    read: read_with,
    writer: Some(Writer {
        ending: "ply",
        material: MaterialPlace::Nowhere,
        has_colors: true,
        files: |model, stem| Ok(alone(stem, "ply", write(model)?)),
        replace_images: None,
    }),
};

/// Property names of each vertex attribute.
const COLUMNS: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "diffuse_red", "r"],
    &["green", "diffuse_green", "g"],
    &["blue", "diffuse_blue", "b"],
    &["alpha", "diffuse_alpha", "a"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
];
/// Property names of the corner list of a face or a strip.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

#[derive(Default)]
struct Draft {
    /// Number of vertices that the header states. It is known even if faces precede vertices.
    n_vertices: u64,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    colors: Vec<LinearRgba>,
    uvs: Vec<DVec2>,
    faces: Vec<[u32; 3]>,
    polygons: Polygons,
    face_uvs: Vec<[DVec2; 3]>,
    left_out: Vec<String>,
}

/// The vertex attribute that a property holds, and its encoding if it is a color.
struct Target {
    column: usize,
    coding: Coding,
}

/// Reads a PLY file.
///
/// # Errors
///
/// [`MeshIoErrorKind::File`](crate::MeshIoErrorKind::File) if the bytes are not a PLY file, or have fewer elements
/// than the header states, with the line number in the header and in a text body, or any error from [`Mesh::new`] and
/// [`Model::check`].
///
/// # Examples
///
/// ```
/// let text = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
/// let model = dapple_mesh_io::ply::read(text)?;
/// assert_eq!(model.mesh.positions().len(), 1);
/// # Ok::<(), dapple_mesh_io::MeshIoError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Model, MeshIoError> {
    read_with(bytes, &mut |_| None)
}

/// Reads a PLY file. `resolve` returns its texture.
///
/// # Errors
///
/// Same as [`read`]. A missing texture is not an error, and is listed in [`Model::left_out`].
pub fn read_with(bytes: &[u8], resolve: &mut FileResolver<'_>) -> Result<Model, MeshIoError> {
    let bytes = content(FORMAT, bytes)?;
    let (header, rest) = Header::read(bytes)?;
    let mut body = Body::new(header.encoding, bytes, rest);
    let vertices = header
        .elements
        .iter()
        .find(|element| element.name == "vertex");
    let mut draft = Draft {
        n_vertices: vertices.map_or(0, |element| element.count),
        ..Draft::default()
    };
    for element in &header.elements {
        body.check_room(element)?;
        match element.name.as_str() {
            "vertex" if draft.positions.is_empty() => draft.read_vertices(element, &mut body)?,
            "face" => draft.read_faces(element, &mut body)?,
            "tristrips" => draft.read_strips(element, &mut body)?,
            _ => {
                draft.skip(element);
                pass_over(element, &mut body)?;
            }
        }
    }
    let mut model = draft.into_model()?;
    if let Some(name) = header.textures.first() {
        let image = texture(name, resolve).map_err(|why| model.left_out.push(why));
        model.material.base_color = image.ok();
    }
    if header.textures.len() > 1 {
        model.left_out.push(Model::FURTHER_MATERIALS.to_owned());
    }
    Ok(model)
}

/// Skips the data of an unused element.
fn pass_over(element: &Element, body: &mut Body<'_>) -> Result<(), MeshIoError> {
    let mut list = Vec::new();
    // Without properties there is no data, regardless of the count.
    let count = if element.properties.is_empty() {
        0
    } else {
        element.count
    };
    for _ in 0..count {
        for property in &element.properties {
            body.values(property.kind, &mut list)?;
        }
    }
    Ok(())
}

impl Draft {
    /// Adds the name of an unused element to `left_out`.
    fn skip(&mut self, element: &Element) {
        if element.count > 0 && !element.properties.is_empty() {
            let name = shown(&element.name);
            self.left_out.push(format!("the element {name}"));
        }
    }

    fn read_vertices(&mut self, element: &Element, body: &mut Body<'_>) -> Result<(), MeshIoError> {
        let targets: Vec<_> = element
            .properties
            .iter()
            .map(|property| target(&property.name, property.kind))
            .collect();
        let has = |column: usize| {
            targets
                .iter()
                .flatten()
                .any(|target| target.column == column)
        };
        let [normal, color, uv] = [3..6, 6..9, 10..12].map(|mut columns| columns.all(has));
        if !(0..3).all(has) {
            let why = format!("line {}: a vertex has no x, y or z", element.line);
            return Err(MeshIoError::file(FORMAT, why));
        }
        let (mut row, mut codings) = ([0.0; COLUMNS.len()], [Coding::Unit; 4]);
        // Default alpha of a color without alpha
        row[9] = 1.0;
        for target in targets
            .iter()
            .flatten()
            .filter(|target| (6..10).contains(&target.column))
        {
            codings[target.column - 6] = target.coding;
        }
        let mut list = Vec::new();
        for _ in 0..element.count {
            for (target, property) in targets.iter().zip(&element.properties) {
                body.values(property.kind, &mut list)?;
                if let Some(target) = target {
                    let is_color = (6..10).contains(&target.column);
                    row[target.column] = if is_color {
                        list[0]
                    } else {
                        body.in_range(list[0])?
                    };
                }
            }
            let [x, y, z, nx, ny, nz, r, g, b, alpha, u, v] = row;
            self.positions.push(DVec3::new(x, y, z));
            if normal {
                self.normals.push(DVec3::new(nx, ny, nz));
            }
            if color {
                self.colors.push(colors::decode([r, g, b, alpha], codings));
            }
            if uv {
                self.uvs.push(DVec2::new(u, 1.0 - v));
            }
        }
        Ok(())
    }

    fn read_faces(&mut self, element: &Element, body: &mut Body<'_>) -> Result<(), MeshIoError> {
        let Some(corners) = element.place(&CORNERS) else {
            return pass_over(element, body);
        };
        let uvs = element.place(&["texcoord"]);
        let mut lists = vec![Vec::new(); element.properties.len()];
        let mut polygon = Vec::new();
        for _ in 0..element.count {
            for (list, property) in lists.iter_mut().zip(&element.properties) {
                body.values(property.kind, list)?;
            }
            polygon.clear();
            for &number in &lists[corners] {
                polygon.push(self.vertex(number, body)?);
            }
            self.polygons.push(&polygon, &mut self.faces);
            if let Some(uvs) = uvs {
                self.add_face_uvs(&lists[uvs], &polygon, body)?;
            }
        }
        Ok(())
    }

    fn read_strips(&mut self, element: &Element, body: &mut Body<'_>) -> Result<(), MeshIoError> {
        let Some(corners) = element.place(&CORNERS) else {
            return pass_over(element, body);
        };
        let (mut list, mut others, mut polygon) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                let list = if i == corners { &mut list } else { &mut others };
                body.values(property.kind, list)?;
            }
            for numbers in list.split(|&number| number == -1.0) {
                polygon.clear();
                for &number in numbers {
                    polygon.push(self.vertex(number, body)?);
                }
                self.faces.extend(strip(&polygon));
            }
        }
        Ok(())
    }

    fn add_face_uvs(
        &mut self,
        list: &[f64],
        polygon: &[u32],
        body: &Body<'_>,
    ) -> Result<(), MeshIoError> {
        let mut uvs = Vec::new();
        for &[u, v] in list.as_chunks().0 {
            uvs.push(DVec2::new(body.in_range(u)?, 1.0 - body.in_range(v)?));
        }
        // A face without a texture may have an empty list.
        if list.is_empty() {
            uvs.resize(polygon.len(), DVec2::ZERO);
        }
        if uvs.len() != polygon.len() {
            return Err(body.error("a face has not two texcoord for each corner"));
        }
        self.face_uvs.extend(fan(&uvs));
        Ok(())
    }

    /// Converts a number in the file to a vertex index.
    fn vertex(&self, number: f64, body: &Body<'_>) -> Result<u32, MeshIoError> {
        let vertex = number as u32;
        if f64::from(vertex) == number && u64::from(vertex) < self.n_vertices {
            return Ok(vertex);
        }
        let why = no_vertex(number, self.n_vertices);
        Err(body.error(format!("{why}, counted from 0")))
    }

    fn into_model(mut self) -> Result<Model, MeshIoError> {
        let ears = self
            .polygons
            .ears(&self.faces, &self.positions, |vertex| vertex);
        // Mismatched counts are an error of the model.
        if self.face_uvs.len() == self.faces.len() {
            ears.apply(&mut self.face_uvs);
        }
        ears.apply(&mut self.faces);
        let mut model = Model::from(Mesh::new(self.positions, &self.faces)?);
        model.normals = (!self.normals.is_empty()).then_some(self.normals);
        model.colors = (!self.colors.is_empty()).then_some(self.colors);
        if !self.face_uvs.is_empty() {
            model.uvs = Some(self.face_uvs);
        } else if !self.uvs.is_empty() && !self.faces.is_empty() {
            let face = |face: &[u32; 3]| face.map(|vertex| self.uvs[vertex as usize]);
            model.uvs = Some(self.faces.iter().map(face).collect());
        }
        model.left_out = self.left_out;
        model.left_out.extend(ears.left_out());
        model.check()?;
        Ok(model)
    }
}

/// Returns the attribute that a property called `name` holds; `None` if it is not used.
fn target(name: &str, kind: Kind) -> Option<Target> {
    let column = COLUMNS.iter().position(|names| names.contains(&name))?;
    let Kind::Scalar(scalar) = kind else {
        return None;
    };
    let coding = match scalar {
        Scalar::F32 | Scalar::F64 => Coding::Unit,
        Scalar::U16 => Coding::Short,
        _ => Coding::Byte,
    };
    Some(Target { column, coding })
}
