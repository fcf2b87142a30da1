//! PLY encoder.

use crate::MeshIoError;
use crate::split::with_vertex_normals;
use crate::text::shortest;
use dapple_color::LinearRgba;
use dapple_mesh::Model;
use glam::DVec3;
use std::fmt::Write as _;

/// An encoder of numbers as bytes or text.
struct Out {
    bytes: Vec<u8>,
    /// Current line of a text file; `None` for a binary file.
    line: Option<String>,
    /// Whether positions, normals and texture coordinates, in this order, are written as `double`.
    wide: [bool; 3],
}

/// Encodes the model as a little-endian binary PLY file.
///
/// Positions, normals and texture coordinates are each written as `float` if that is lossless for all of them, else as
/// `double`. They read back bit for bit, except for the conversion 1 - v. Colors are 8-bit sRGB, with `alpha` if any
/// color has one. Where corners have different normals, additional vertices follow, since PLY has normals only for
/// vertices. A model without faces becomes a point cloud, oriented if it has normals. The material is omitted.
///
/// # Errors
///
/// Same as [`Model::check`].
pub fn write(model: &Model) -> Result<Vec<u8>, MeshIoError> {
    encode(model, None)
}

/// Encodes the model as a text PLY file; see [`write()`].
///
/// # Errors
///
/// Same as [`Model::check`].
pub fn write_text(model: &Model) -> Result<Vec<u8>, MeshIoError> {
    encode(model, Some(String::new()))
}

fn encode(model: &Model, line: Option<String>) -> Result<Vec<u8>, MeshIoError> {
    model.check()?;
    let model = &*with_vertex_normals(model)?;
    let positions = model.mesh.positions();
    let wide_vectors = |vectors: &[DVec3]| {
        vectors
            .iter()
            .any(|vector| vector.to_array().into_iter().any(wide))
    };
    let uvs = model.uvs.as_deref().unwrap_or_default();
    let wide = [
        wide_vectors(positions),
        wide_vectors(model.normals.as_deref().unwrap_or_default()),
        uvs.iter()
            .flatten()
            .any(|uv| wide(uv.x) || wide(1.0 - uv.y)),
    ];
    let colors = model.colors.as_deref();
    let alpha = colors.is_some_and(|colors| colors.iter().any(|color| color.alpha != 1.0));
    let bytes = header(model, line.is_some(), wide, alpha).into_bytes();
    let mut out = Out { bytes, line, wide };
    for (i, position) in positions.iter().enumerate() {
        out.vector(0, position.to_array());
        if let Some(normals) = &model.normals {
            out.vector(1, normals[i].to_array());
        }
        if let Some(colors) = colors {
            out.color(colors[i], alpha);
        }
        out.end_line();
    }
    for (i, face) in model.mesh.faces().iter().enumerate() {
        out.byte(3);
        for vertex in face {
            out.whole(vertex.0);
        }
        if let Some(uvs) = uvs.get(i) {
            out.byte(6);
            for uv in uvs {
                // The v axis of PLY points up.
                out.vector(2, [uv.x, 1.0 - uv.y]);
            }
        }
        out.end_line();
    }
    Ok(out.bytes)
}

/// Returns whether rounding to `f32` changes a number.
fn wide(part: f64) -> bool {
    f64::from(part as f32).to_bits() != part.to_bits()
}

fn header(model: &Model, text: bool, wide: [bool; 3], alpha: bool) -> String {
    let real = wide.map(|wide| if wide { "double" } else { "float" });
    let encoding = if text {
        "ascii"
    } else {
        "binary_little_endian"
    };
    let n_vertices = model.mesh.positions().len();
    let mut header = format!("ply\nformat {encoding} 1.0\nelement vertex {n_vertices}\n");
    let mut properties = |kind: &str, names: &[&str]| {
        for name in names {
            let _ = writeln!(header, "property {kind} {name}");
        }
    };
    properties(real[0], &["x", "y", "z"]);
    if model.normals.is_some() {
        properties(real[1], &["nx", "ny", "nz"]);
    }
    if model.colors.is_some() {
        properties("uchar", &["red", "green", "blue"]);
    }
    if alpha {
        properties("uchar", &["alpha"]);
    }
    let n_faces = model.mesh.faces().len();
    if n_faces > 0 {
        let _ = writeln!(
            header,
            "element face {n_faces}\nproperty list uchar int vertex_indices"
        );
        if model.uvs.is_some() {
            let _ = writeln!(header, "property list uchar {} texcoord", real[2]);
        }
    }
    header.push_str("end_header\n");
    header
}

impl Out {
    fn vector<const N: usize>(&mut self, column: usize, parts: [f64; N]) {
        for part in parts {
            if let Some(line) = &mut self.line {
                shortest(line, part);
                line.push(' ');
            } else if self.wide[column] {
                self.bytes.extend(part.to_le_bytes());
            } else {
                self.bytes.extend((part as f32).to_le_bytes());
            }
        }
    }

    fn color(&mut self, color: LinearRgba, alpha: bool) {
        let codes: [u8; 4] = color.to_srgb();
        for &code in &codes[..if alpha { 4 } else { 3 }] {
            self.byte(code);
        }
    }

    fn byte(&mut self, byte: u8) {
        match &mut self.line {
            Some(line) => {
                let _ = write!(line, "{byte} ");
            }
            None => self.bytes.push(byte),
        }
    }

    fn whole(&mut self, number: u32) {
        match &mut self.line {
            Some(line) => {
                let _ = write!(line, "{number} ");
            }
            None => self.bytes.extend(number.to_le_bytes()),
        }
    }

    fn end_line(&mut self) {
        if let Some(line) = &mut self.line {
            self.bytes.extend(line.trim_end().as_bytes());
            self.bytes.push(b'\n');
            line.clear();
        }
    }
}
