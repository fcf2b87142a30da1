//! Encoder for OBJ, MTL, and the textures in the same folder.

use crate::NamedFile;
use crate::text::shortest;
use crate::{MeshIoError, MeshIoErrorKind};
use dapple_color::{Code, LinearRgb, LinearRgba};
use dapple_mesh::{EncodedImage, Material, Model};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Encodes the model as an OBJ file without its material.
///
/// Positions, normals and texture coordinates have the shortest digits that read back as the same `f64`. Colors are
/// clamped to 0 to 1, with 16 bits per channel and without alpha.
///
/// # Errors
///
/// Same as [`Model::check`].
pub fn write(model: &Model) -> Result<Vec<u8>, MeshIoError> {
    Ok(text(model, None)?.into_bytes())
}

/// Encodes the model as an OBJ file `stem.obj`, which comes last in the result. A material adds `stem.mtl` and the
/// textures `stem_base_color.png` and `stem_normal.png`, or `.jpg`.
///
/// The metallic-roughness texture is omitted, since MTL has separate textures for metalness and roughness. Textures
/// of unit squares ([`Model::tiles`]) are named `stem_base_color.1001.png` and so on, and the material refers to them
/// with `<UDIM>`.
///
/// # Errors
///
/// Same as [`Model::check`], plus [`MeshIoErrorKind::Name`] if the stem is empty, or contains white space, a slash, a
/// backslash or `#`, which names in an OBJ file cannot contain.
pub fn write_files(model: &Model, stem: &str) -> Result<Vec<NamedFile>, MeshIoError> {
    let odd = |c: char| c.is_whitespace() || c.is_control() || matches!(c, '/' | '\\' | '#');
    if stem.is_empty() || stem.contains(odd) {
        let name = stem.to_owned();
        return Err(MeshIoError::new(MeshIoErrorKind::Name { name }));
    }
    let mut files = Vec::new();
    let library = (model.material != Material::default()).then(|| format!("{stem}.mtl"));
    if let Some(name) = &library {
        let mtl = material(model, stem, &mut files);
        files.push(file(name.clone(), mtl.as_bytes()));
    }
    let obj = text(model, library.as_deref())?;
    files.push(file(format!("{stem}.obj"), obj.as_bytes()));
    Ok(files)
}

fn file(name: String, bytes: &[u8]) -> NamedFile {
    let bytes = bytes.to_vec();
    NamedFile { name, bytes }
}

/// Returns the text of the MTL file. Adds the textures to `files`.
fn material(model: &Model, stem: &str, files: &mut Vec<NamedFile>) -> String {
    let LinearRgba { color, alpha } = model.material.base_color_factor;
    let mut text = format!(
        "newmtl surface\nKd {} {} {}\nd {alpha}\n",
        color.r, color.g, color.b
    );
    let mut map = |key: &str, part: &str, image: fn(&Material) -> &Option<EncodedImage>| {
        let mut write = |material: &Material, tile: &str| {
            let image = image(material).as_ref()?;
            let ending = image.format().extension();
            files.push(file(format!("{stem}_{part}{tile}.{ending}"), image.bytes()));
            Some(ending)
        };
        let tiles = model.tiles.iter();
        let endings = tiles.filter_map(|tile| write(&tile.material, &format!(".{}", tile.number)));
        let name = match endings.collect::<Vec<_>>().first() {
            Some(ending) => format!("{stem}_{part}.<UDIM>.{ending}"),
            None => match write(&model.material, "") {
                Some(ending) => format!("{stem}_{part}.{ending}"),
                None => return,
            },
        };
        let _ = writeln!(text, "{key} {name}");
    };
    map("map_Kd", "base_color", |material| &material.base_color);
    map("norm", "normal", |material| &material.normal);
    text
}

/// Returns the text of the OBJ file. Writing to a string cannot fail.
fn text(model: &Model, library: Option<&str>) -> Result<String, MeshIoError> {
    model.check()?;
    let mut text = String::new();
    if let Some(library) = library {
        let _ = writeln!(text, "mtllib {library}\nusemtl surface");
    }
    for (i, &position) in model.mesh.positions().iter().enumerate() {
        text.push('v');
        numbers(&mut text, position);
        if let Some(colors) = &model.colors {
            numbers(&mut text, coded(colors[i].color));
        }
        text.push('\n');
    }
    let uv_faces = uvs(model, &mut text);
    let normal_faces = normals(model, &mut text);
    for (i, face) in model.mesh.faces().iter().enumerate() {
        text.push('f');
        for (corner, vertex) in face.iter().enumerate() {
            let v = vertex.index() + 1;
            let _ = match (uv_faces.get(i), normal_faces.get(i)) {
                (None, None) => write!(text, " {v}"),
                (None, Some(normals)) => write!(text, " {v}//{}", normals[corner]),
                (Some(uvs), None) => write!(text, " {v}/{}", uvs[corner]),
                (Some(uvs), Some(normals)) => {
                    write!(text, " {v}/{}/{}", uvs[corner], normals[corner])
                }
            };
        }
        text.push('\n');
    }
    Ok(text)
}

fn numbers(text: &mut String, vector: DVec3) {
    for part in vector.to_array() {
        text.push(' ');
        shortest(text, part);
    }
}

/// Returns a color's sRGB codes as fractions from 0 to 1, rounded to 1e-6, which preserves all 16-bit codes.
fn coded(color: LinearRgb) -> DVec3 {
    let unit = |code: u16| (f64::from(code.to_unit()) * 1e6).round() / 1e6;
    DVec3::from_array(color.to_srgb::<u16>().map(unit))
}

/// Writes the normals, and returns the index of each corner's normal, starting at 1. Vertex normals are written in
/// order; equal corner normals are written once.
fn normals(model: &Model, text: &mut String) -> Vec<[usize; 3]> {
    let mut line = |normal: DVec3| {
        text.push_str("vn");
        numbers(text, normal);
        text.push('\n');
    };
    if let Some(corners) = &model.corner_normals {
        let mut known = BTreeMap::new();
        let mut number = |normal: DVec3| {
            let next = known.len() + 1;
            *known
                .entry(normal.to_array().map(f64::to_bits))
                .or_insert_with(|| {
                    line(normal);
                    next
                })
        };
        return corners.iter().map(|face| face.map(&mut number)).collect();
    }
    let Some(normals) = &model.normals else {
        return Vec::new();
    };
    normals.iter().copied().for_each(line);
    let faces = model.mesh.faces().iter();
    faces
        .map(|face| face.map(|vertex| vertex.index() + 1))
        .collect()
}

/// Writes each distinct texture coordinate once, and returns the index for each corner, starting at 1.
fn uvs(model: &Model, text: &mut String) -> Vec<[usize; 3]> {
    let mut known = BTreeMap::new();
    let mut number = |uv: DVec2| {
        let next = known.len() + 1;
        *known
            .entry(uv.to_array().map(f64::to_bits))
            .or_insert_with(|| {
                text.push_str("vt ");
                shortest(text, uv.x);
                text.push(' ');
                // The v axis of OBJ points up.
                shortest(text, 1.0 - uv.y);
                text.push('\n');
                next
            })
    };
    let faces = model.uvs.iter().flatten();
    faces.map(|face| face.map(&mut number)).collect()
}
