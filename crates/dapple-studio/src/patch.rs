//! Applies small edits to a recipe as small edits to its text. Comments, order and number formats are preserved.

mod nodes;
mod parameters;
mod place;
mod splice;

use crate::StudioError;
use crate::data::json_of_table;
use place::Place;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
pub(crate) use splice::spliced;
use toml_edit::DocumentMut;

/// A component of a path: a key of a table or an index of an array.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Part {
    /// An index, starting at 0.
    Index(usize),
    /// A key.
    Key(String),
}

impl From<&str> for Part {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for Part {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

/// A small edit to a recipe. Paths are keys and indices as in JSON, such as `["nodes", "tint", "ramp", "colors", 2]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "op", rename_all = "snake_case", deny_unknown_fields)]
pub enum Op {
    /// Sets the value at a path. Missing tables on the path are created.
    Set {
        /// The path from the root.
        path: Vec<Part>,
        /// The new value.
        value: Json,
    },
    /// Removes an entry or an element.
    Remove {
        /// The path from the root.
        path: Vec<Part>,
    },
    /// Inserts an element into an array, which is created if missing.
    Insert {
        /// The path of the array.
        path: Vec<Part>,
        /// The index of the new element.
        index: usize,
        /// The new element.
        value: Json,
    },
    /// Adds a node after all other nodes.
    AddNode {
        /// The name of the node.
        name: String,
        /// The kind of the node, one of [`KINDS`](dapple::recipe::KINDS).
        kind: String,
        /// The options of the node.
        value: Json,
    },
    /// Removes a node. Inputs that refer to it get their defaults.
    RemoveNode {
        /// The name of the node.
        name: String,
    },
    /// Renames a node and the inputs that refer to it. Random streams derived from the old name are preserved,
    /// including the node's own.
    RenameNode {
        /// Current name of the node.
        name: String,
        /// New name of the node.
        to: String,
    },
    /// Adds a copy of a node. If the node has a seed, the copy uses the random stream of the original.
    DuplicateNode {
        /// The name of the original.
        name: String,
        /// The name of the copy.
        to: String,
    },
    /// Connects an input of a node.
    Connect {
        /// Name of the node.
        node: String,
        /// The path of the input within the node, starting at its kind, such as `["mix", "by"]`.
        input: Vec<Part>,
        /// The name of a node, a color or a number.
        from: Json,
    },
    /// Removes the link of an input. The input gets its default.
    Disconnect {
        /// The path of the input from the root, such as `["nodes", "sum", "add", 0]`.
        path: Vec<Part>,
    },
    /// Converts a PUPs texture to one whose control points are part of the text. The image stays the same.
    MakePoints {
        /// Name of the node.
        node: String,
        /// The options of the converted texture, filled in by a [`Session`](crate::Session).
        #[serde(skip)]
        points: Option<Json>,
    },
}

/// Applies edits to a text, in order, and returns the new text. Parameters that no option refers to any more are removed.
///
/// # Errors
///
/// If the text is not valid TOML or an edit does not fit it. In both cases the text is unchanged.
pub fn apply(text: &str, ops: &[Op]) -> Result<String, StudioError> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        StudioError::new(format!("the text is no TOML yet: {}", error.message()))
    })?;
    let used = parameters::used(&document);
    for op in ops {
        apply_one(&mut document, op)?;
    }
    parameters::remove_unused(&mut document, &used);
    let new = document.to_string();
    // Parse the result again, so that no edit can break the text.
    let read: DocumentMut = new.parse().map_err(|_| not_here())?;
    if json_of_table(&read) != json_of_table(&document) {
        return Err(not_here());
    }
    Ok(new)
}

fn not_here() -> StudioError {
    StudioError::new("this cannot be changed without breaking the text; change the text itself")
}

fn apply_one(document: &mut DocumentMut, op: &Op) -> Result<(), StudioError> {
    let root = Place::Table(document.as_table_mut());
    match op {
        Op::Set { path, value } => root.set(path, value),
        Op::Remove { path } => root.remove(path),
        Op::Insert { path, index, value } => root.insert(path, *index, value),
        Op::AddNode { name, kind, value } => nodes::add(document, name, kind, value),
        Op::RemoveNode { name } => nodes::remove(document, name),
        Op::RenameNode { name, to } => nodes::rename(document, name, to),
        Op::DuplicateNode { name, to } => nodes::duplicate(document, name, to),
        Op::Connect { node, input, from } => nodes::connect(document, node, input, from),
        Op::Disconnect { path } => nodes::disconnect(document, path),
        Op::MakePoints { node, points } => {
            let missing = || StudioError::new("the points of the texture are not known");
            let points = points
                .as_ref()
                .and_then(Json::as_object)
                .ok_or_else(missing)?;
            nodes::make_points(document, node, points)
        }
    }
}

#[cfg(test)]
mod tests;
