//! OFF: the Object File Format of Geomview, as text.
//!
//! Reference: the Geomview manual, `http://www.geomview.org/docs/html/OFF.html`.
//!
//! All three-dimensional headers are supported: `OFF` with the optional prefixes `ST`, `C` and `N`, in this order, for
//! texture coordinates, colors and normals of the vertices. A missing header means `OFF`. The counts may follow the
//! header on its line, even without a space. Colors are three or four numbers, from 0 to 255 if the vertex has only
//! integers, else from 0 to 1. Face colors are omitted and listed in [`Model::left_out`]. A vertex is on one line; a
//! face may span several lines. The four-dimensional, n-dimensional and binary variants give errors.

use super::MeshFormat;
use crate::MeshIoError;
use crate::colors::{self, Coding};
use crate::line::{Line, lines};
use crate::polygon::Polygons;
use crate::text::{no_vertex, parse};
use dapple_color::LinearRgba;
use dapple_mesh::{Mesh, Model};
use glam::{DVec2, DVec3};

const FORMAT: &str = "OFF";

/// Entry for OFF in the table of formats.
pub(super) const OFF: MeshFormat = MeshFormat {
    name: FORMAT,
    endings: &["off"],
    read: |bytes, _| read(bytes),
    writer: None,
};

/// Vertex attributes that the header declares.
#[derive(Clone, Copy, Default)]
struct Header {
    texture: bool,
    color: bool,
    normal: bool,
}

/// Positions and attributes of the vertices.
#[derive(Default)]
struct Vertices {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    colors: Vec<LinearRgba>,
    uvs: Vec<DVec2>,
}

/// Reads an OFF file.
///
/// # Errors
///
/// [`MeshIoErrorKind::File`](crate::MeshIoErrorKind::File) with the line number if the bytes are not an OFF file, or
/// any error from [`Mesh::new`] and [`Model::check`].
///
/// # Examples
///
/// ```
/// let text = b"OFF\n3 1 0 # counts\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
/// let model = dapple_mesh_io::off::read(text)?;
/// assert_eq!(model.mesh.faces().len(), 1);
/// # Ok::<(), dapple_mesh_io::MeshIoError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Model, MeshIoError> {
    let mut lines = lines(FORMAT, bytes)?;
    let Some(mut line) = lines.next() else {
        return Err(MeshIoError::file(FORMAT, "it is empty"));
    };
    let header = take_header(&mut line)?;
    let counts = if line.words.is_empty() {
        lines.next()
    } else {
        Some(line)
    };
    let [n_vertices, n_faces] = counts_of(counts.as_ref())?;
    let mut vertices = Vertices::default();
    for _ in 0..n_vertices {
        let line = lines.next().ok_or_else(|| ended("vertices", n_vertices))?;
        vertices.add(header, &line)?;
    }
    let (mut faces, mut corners, mut polygons) = (Vec::new(), Vec::new(), Polygons::default());
    let mut has_colors = false;
    for _ in 0..n_faces {
        let mut line = lines.next().ok_or_else(|| ended("faces", n_faces))?;
        // A polygon may span several lines, and its color is on the last of them.
        let count = polygon_count(&line)?;
        while line.words.len() <= count {
            let more = lines.next();
            line.extend(more.ok_or_else(|| line.error("a face has fewer corners than it says"))?);
        }
        has_colors |= line.words.len() > count + 1;
        corners.clear();
        for word in &line.words[1..=count] {
            corners.push(corner(&line, word, n_vertices)?);
        }
        polygons.push(&corners, &mut faces);
    }
    let ears = polygons.ears(&faces, &vertices.positions, |vertex| vertex);
    ears.apply(&mut faces);
    let mut model = vertices.into_model(header, &faces)?;
    model.left_out.extend(ears.left_out());
    if has_colors {
        model.left_out.push("colors of faces".to_owned());
    }
    Ok(model)
}

/// Removes the header from its line and parses it.
fn take_header(line: &mut Line<'_>) -> Result<Header, MeshIoError> {
    let word = line.words[0];
    if parse::<f64>(word).is_some() {
        return Ok(Header::default());
    }
    let (rest, texture) = strip(word, b"ST");
    let (rest, color) = strip(rest, b"C");
    let (rest, normal) = strip(rest, b"N");
    let (rest, off) = strip(rest, b"OFF");
    let count = rest.is_empty() || parse::<u64>(rest).is_some();
    let binary = line.words.get(1) == Some(&b"BINARY".as_slice());
    if !off || !count || binary {
        return Err(line.error("the header is not [ST][C][N]OFF"));
    }
    if rest.is_empty() {
        line.words.remove(0);
    } else {
        line.words[0] = rest;
    }
    Ok(Header {
        texture,
        color,
        normal,
    })
}

fn strip<'a>(word: &'a [u8], prefix: &[u8]) -> (&'a [u8], bool) {
    word.strip_prefix(prefix)
        .map_or((word, false), |rest| (rest, true))
}

/// Parses the numbers of vertices and faces from a line. The number of edges that follows is ignored.
fn counts_of(line: Option<&Line<'_>>) -> Result<[u64; 2], MeshIoError> {
    let line = line.ok_or_else(|| MeshIoError::file(FORMAT, "there are no counts"))?;
    let count = |at: usize| line.words.get(at).copied().and_then(parse::<u64>);
    match (count(0), count(1)) {
        (Some(vertices), Some(faces)) => Ok([vertices, faces]),
        _ => Err(line.error("the numbers of vertices and faces are needed")),
    }
}

fn ended(what: &str, count: u64) -> MeshIoError {
    MeshIoError::file(
        FORMAT,
        format!("it ends before the last of its {count} {what}"),
    )
}

/// Returns the number of corners of the polygon that starts on a line.
fn polygon_count(line: &Line<'_>) -> Result<usize, MeshIoError> {
    parse(line.words[0]).ok_or_else(|| line.error("the number of corners of a face is needed"))
}

/// Parses a corner into a zero-based vertex index.
fn corner(line: &Line<'_>, word: &[u8], n_vertices: u64) -> Result<u32, MeshIoError> {
    let corner: u32 =
        parse(word).ok_or_else(|| line.error("a corner is not the number of a vertex"))?;
    if u64::from(corner) < n_vertices {
        return Ok(corner);
    }
    Err(line.error(format!("{}, counted from 0", no_vertex(corner, n_vertices))))
}

impl Vertices {
    /// Adds the vertex that a line describes: position, normal, color, texture coordinates.
    fn add(&mut self, header: Header, line: &Line<'_>) -> Result<(), MeshIoError> {
        self.positions.push(line.position(0)?);
        let mut at = 3;
        if header.normal {
            self.normals.push(line.position(at)?);
            at += 3;
        }
        if header.color {
            // Three or four color components, then optional texture coordinates
            let end = line.words.len()
                - if header.texture {
                    2.min(line.words.len())
                } else {
                    0
                };
            let count = end.saturating_sub(at).min(4);
            self.colors.push(color(line, at, count)?);
            at += count;
        }
        if header.texture {
            // The v axis of OFF points up.
            let v = 1.0 - line.part(at + 1)?;
            self.uvs.push(DVec2::new(line.part(at)?, v));
        }
        Ok(())
    }

    fn into_model(self, header: Header, faces: &[[u32; 3]]) -> Result<Model, MeshIoError> {
        let mut model = Model::from(Mesh::new(self.positions, faces)?);
        model.normals = header.normal.then_some(self.normals);
        model.colors = header.color.then_some(self.colors);
        model.uvs = header.texture.then(|| {
            let uv = |&vertex: &u32| self.uvs[vertex as usize];
            faces.iter().map(|face| face.each_ref().map(uv)).collect()
        });
        model.check()?;
        Ok(model)
    }
}

/// Parses a color of three or four components, starting at word `at`.
fn color(line: &Line<'_>, at: usize, count: usize) -> Result<LinearRgba, MeshIoError> {
    let whole = line
        .words
        .iter()
        .skip(at)
        .take(count)
        .all(|word| parse::<i64>(word).is_some());
    let (coding, full) = if whole {
        (Coding::Byte, 255.0)
    } else {
        (Coding::Unit, 1.0)
    };
    let mut parts = [0.0, 0.0, 0.0, full];
    for (i, part) in parts.iter_mut().enumerate().take(count.max(3)) {
        *part = line.number(at + i)?;
    }
    Ok(colors::decode(parts, [coding; 4]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MeshIoErrorKind;
    use dapple_color::LinearRgb;
    use dapple_mesh::VertexIdx;

    fn why(text: &str) -> String {
        match read(text.as_bytes()).expect_err("it is refused").kind() {
            MeshIoErrorKind::File { format: "OFF", why } => why.clone(),
            kind => panic!("{kind:?}"),
        }
    }

    #[test]
    fn headers_comments_and_quads_are_read() {
        let body =
            "4 2 0 # counts\r\n\r\n0 0 0\n1 0 0\n1 1 0 # far\n0 1 .5\n4 0 1 2 3 255 0 0\n2 0 1\n";
        for header in ["OFF\n", "# first\r\nOFF # header\r\n", "OFF ", "OFF", ""] {
            let model = read(format!("{header}{body}").as_bytes()).expect("it is valid");
            let faces = [[0, 1, 2], [0, 2, 3]].map(|face| face.map(VertexIdx));
            assert_eq!(model.mesh.faces(), faces, "{header}");
            assert_eq!(
                model.mesh.positions()[3],
                DVec3::new(0.0, 1.0, 0.5),
                "{header}"
            );
        }
    }

    #[test]
    fn columns_of_vertices_are_read() {
        let text = "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 188 128 0 0.25\n1 0 0 0 1 0 1.0 0 0.5 0 1 1\n0 1 0 1 0 0 0 0 0 .5 .5\n3 0 1 2\n";
        let model = read(text.as_bytes()).expect("it is valid");
        assert_eq!(model.normals, Some(vec![DVec3::Z, DVec3::Y, DVec3::X]));
        let colors = model.colors.expect("it has colors");
        assert_eq!(
            colors[0],
            LinearRgba::from_srgb([255, 0, 188, 128u8]),
            "whole numbers"
        );
        assert_eq!(
            colors[1].color,
            LinearRgb::from_srgb([65535, 0, 32768u16]),
            "fractions"
        );
        assert_eq!(
            (colors[1].alpha, colors[2].alpha),
            (0.0, 1.0),
            "alpha and none"
        );
        let uvs = [
            DVec2::new(0.0, 0.75),
            DVec2::new(1.0, 0.0),
            DVec2::new(0.5, 0.5),
        ];
        assert_eq!(model.uvs, Some(vec![uvs]));
    }

    #[test]
    fn faces_go_on_over_several_lines() {
        let text =
            "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1\n# between\n2\n 3 255 0 0\n3\n0 2 3\n";
        let model = read(text.as_bytes()).expect("it is valid");
        let faces = [[0, 1, 2], [0, 2, 3], [0, 2, 3]];
        assert_eq!(model.mesh.faces(), faces.map(|face| face.map(VertexIdx)));
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert_eq!(why("\n# nothing\n"), "it is empty");
        for header in ["4OFF", "nOFF", "OFF BINARY", "COF", "ply"] {
            assert_eq!(
                why(&format!("{header}\n0 0 0\n")),
                "line 1: the header is not [ST][C][N]OFF"
            );
        }
        assert_eq!(why("OFF\n"), "there are no counts");
        assert_eq!(
            why("OFF\n3\n"),
            "line 2: the numbers of vertices and faces are needed"
        );
        assert_eq!(
            why("OFF\n4000000000 0 0\n"),
            "it ends before the last of its 4000000000 vertices"
        );
        assert_eq!(
            why("OFF\n1 9 0\n0 0 0\n"),
            "it ends before the last of its 9 faces"
        );
        assert_eq!(
            why("OFF\n1 1 0\n0 0 0\n3 0 0\n"),
            "line 4: a face has fewer corners than it says"
        );
        assert_eq!(
            why("OFF\n1 1 0\n0 0 0\nthree 0 0 0\n"),
            "line 4: the number of corners of a face is needed"
        );
        assert_eq!(
            why("OFF\n1 1 0\n0 0 0\n3 0 0 -1\n"),
            "line 4: a corner is not the number of a vertex"
        );
        assert_eq!(
            why("OFF\n1 1 0\n0 0 0\n\n3 0 1 0\n"),
            "line 5: a corner of a face is vertex 1, but there are 1, counted from 0"
        );
        assert_eq!(
            why("OFF\n2 0 0\n0 0 0\n0 1e31 0\n"),
            "line 4: a number is 1e31, but it must be between -1e30 and 1e30"
        );
        assert_eq!(
            why("COFF\n1 0 0\n0 0 0\n"),
            "line 3: a number is needed in place 4"
        );
    }
}
