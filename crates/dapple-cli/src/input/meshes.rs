//! Reads meshes, and formats notes about the parts of a model that are not used.

use super::NAMES_MAX;
use super::files::{check_file, name};
use crate::error::Hint;
use anyhow::{Error, Result};
use dapple::mesh::Model;
use dapple::mesh_io::{MeshIoErrorKind, read_model, readable_endings};
use std::path::Path;

/// Reads a mesh.
///
/// # Errors
///
/// If the file does not exist, has another format, or is empty or damaged.
pub(crate) fn model(path: &Path) -> Result<Model> {
    check_file(path, "a mesh")?;
    read_model(path).map_err(|error| {
        let hint = match error.kind() {
            MeshIoErrorKind::Format { .. } => {
                Some(format!("a mesh is a file in {}", mesh_endings()))
            }
            MeshIoErrorKind::Unsupported { .. } => {
                Some("export it without this feature, or as .obj or .ply".to_owned())
            }
            _ => None,
        };
        let error =
            Error::new(error).context(format!("{} cannot be read as a mesh", path.display()));
        match hint {
            Some(hint) => error.hint(hint),
            None => error,
        }
    })
}

/// Returns a note that lists the parts of a model that are not used; `None` if all are used. These are parts that the
/// reader left out, and unit squares of texture coordinates that share a texture.
pub(crate) fn not_used(path: &Path, model: &Model) -> Option<String> {
    let mut parts = model.left_out.clone();
    parts.extend(unit_squares(model));
    let parts = parts.join("; ");
    (!parts.is_empty()).then(|| format!("{}: not used: {parts}", name(path)))
}

/// Returns a note on the unit squares of texture coordinates if there are several and they share one texture; otherwise
/// `None`.
pub(crate) fn unit_squares(model: &Model) -> Option<String> {
    let squares = model.unit_squares();
    if squares.len() < 2 || !model.tiles.is_empty() {
        return None;
    }
    let mut names: Vec<_> = squares.iter().take(NAMES_MAX).map(u32::to_string).collect();
    if squares.len() > names.len() {
        names.push("…".to_owned());
    }
    Some(format!(
        "that texture coordinates lie in {} unit squares ({}), since all share one texture",
        squares.len(),
        names.join(", ")
    ))
}

/// Returns the file extensions of meshes, as a list for help texts.
pub(crate) fn mesh_endings() -> String {
    let endings: Vec<_> = readable_endings()
        .map(|ending| format!(".{ending}"))
        .collect();
    endings.join(", ")
}
