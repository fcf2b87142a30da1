//! Describes the content and the defects of a mesh.

use super::Findings;
use crate::input;
use anyhow::Result;
use dapple::mesh::{AlphaMode, MeshReport, Model, Surface};
use dapple::points::glam::DVec3;
use serde_json::{Value, json};
use std::path::Path;

/// Returns the description of a mesh's content and defects.
///
/// # Errors
///
/// If the mesh cannot be read.
pub(super) fn findings(path: &Path) -> Result<Findings> {
    let model = input::model(path)?;
    let report = model.mesh.report();
    let surface = Surface::new(model.mesh.clone());
    let counts = counts(&report);
    let mut text = format!("{}:", path.display());
    for (what, count) in counts.iter().filter(|(_, count)| *count > 0) {
        text += &format!("\n  {count:>9} {what}");
    }
    if let Some([least, most]) = bounds(&model) {
        text += &format!("\n  from {least:.4} to {most:.4}");
    }
    if report.back_to_back_faces > 0 {
        text += "\n  dapple synth gives both sides of such faces one texture, in a material with two sides";
    }
    let columns = columns(&model);
    if !columns.is_empty() {
        text += &format!("\n  with {}", columns.join(", "));
    }
    for what in &model.left_out {
        text += &format!("\n  without {what}");
    }
    let squares = model.unit_squares();
    if let Some(what) = input::unit_squares(&model) {
        text += &format!("\n  without {what}");
    }
    let area = surface.as_ref().ok().map(Surface::area);
    text += &match &surface {
        Ok(surface) => format!("\n  an area of {:.6}; ready for a texture", surface.area()),
        Err(error) if Surface::new(model.mesh.repair().0).is_ok() => {
            format!("\n  not ready for a texture as it is: {error}; dapple synth repairs it")
        }
        Err(error) => format!("\n  not fit for a texture: {error}"),
    };
    let counts = counts
        .iter()
        .map(|(what, count)| ((*what).to_owned(), json!(count)));
    let json = json!({
        "file": path.display().to_string(), "kind": "mesh", "counts": Value::Object(counts.collect()),
        "bounds": bounds(&model).map(|ends| ends.map(|end| end.to_array())), "columns": columns,
        "left_out": model.left_out, "unit_squares": squares, "area": area, "is_surface": surface.is_ok(),
    });
    Ok(Findings {
        text: text + "\n",
        json,
        is_good: surface.is_ok(),
    })
}

/// Returns the counts in a mesh report, each with its label.
fn counts(report: &MeshReport) -> [(&'static str, usize); 12] {
    [
        ("vertices", report.vertices),
        ("faces", report.faces),
        ("pieces", report.components),
        ("edges at a border", report.boundary_edges),
        ("edges of three or more faces", report.non_manifold_edges),
        (
            "vertices with several fans of faces",
            report.non_manifold_vertices,
        ),
        (
            "edges whose faces wind in different ways",
            report.winding_edges,
        ),
        ("faces without an area", report.degenerate_faces),
        ("duplicate faces", report.duplicate_faces),
        ("faces back to back with another", report.back_to_back_faces),
        (
            "vertices at the place of another",
            report.duplicate_vertices,
        ),
        ("vertices without a face", report.unused_vertices),
    ]
}

/// Returns the corners of the bounding box with the smallest and the largest coordinates; `None` without vertices.
fn bounds(model: &Model) -> Option<[DVec3; 2]> {
    let positions = model.mesh.positions();
    let (&first, rest) = positions.split_first()?;
    let grow = |[least, most]: [DVec3; 2], at: &DVec3| [least.min(*at), most.max(*at)];
    Some(rest.iter().fold([first; 2], grow))
}

/// Returns the names of a model's vertex attributes and textures, except positions.
fn columns(model: &Model) -> Vec<&'static str> {
    let material = &model.material;
    let all = [
        ("colors", model.colors.is_some()),
        ("texture coordinates", model.uvs.is_some()),
        (
            "normals",
            model.normals.is_some() || model.corner_normals.is_some(),
        ),
        ("two sides", material.double_sided),
        ("a texture of colors", material.base_color.is_some()),
        ("a texture for each unit square", !model.tiles.is_empty()),
        ("alpha that cuts", material.alpha == AlphaMode::Mask),
        ("alpha that blends", material.alpha == AlphaMode::Blend),
        ("a texture of normals", material.normal.is_some()),
        (
            "a texture of roughness",
            material.metallic_roughness.is_some(),
        ),
        ("a texture of occlusion", material.occlusion.is_some()),
    ];
    let there = all.into_iter().filter(|(_, is_there)| *is_there);
    there.map(|(what, _)| what).collect()
}
