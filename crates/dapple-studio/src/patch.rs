//! Small changes of a recipe as small changes of its text: comments, order and the way numbers are written stay.

mod nodes;
mod place;
mod splice;

use crate::StudioError;
use crate::data::json_of_table;
use place::Place;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
pub(crate) use splice::spliced;
use toml_edit::DocumentMut;

/// A part of a path: a key of a table, or an index of a list.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Part {
    /// The index of an element, from 0.
    Index(usize),
    /// The name of an entry.
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

/// A small change of a recipe. Paths are keys and indices as in JSON, such as `["nodes", "tint", "ramp", "colors", 2]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "op", rename_all = "snake_case", deny_unknown_fields)]
pub enum Op {
    /// Gives a value to what the path leads to. Tables on the way that are not there are made.
    Set {
        /// The way to it from the root.
        path: Vec<Part>,
        /// The value.
        value: Json,
    },
    /// Takes an entry or an element away.
    Remove {
        /// The way to it from the root.
        path: Vec<Part>,
    },
    /// Puts an element into a list, which is made if it is not there.
    Insert {
        /// The list.
        path: Vec<Part>,
        /// The index of the new element.
        index: usize,
        /// The element.
        value: Json,
    },
    /// Adds a node after all others.
    AddNode {
        /// Its name.
        name: String,
        /// Its kind, one of [`KINDS`](dapple::recipe::KINDS).
        kind: String,
        /// Its options.
        value: Json,
    },
    /// Takes a node away.
    RemoveNode {
        /// Its name.
        name: String,
    },
    /// Gives a node another name. Inputs that name it follow; what draws by the old name still does, this node too.
    RenameNode {
        /// Its name.
        name: String,
        /// The new name.
        to: String,
    },
    /// Adds a copy of a node, which draws by the name of the first where it has a seed.
    DuplicateNode {
        /// Its name.
        name: String,
        /// The name of the copy.
        to: String,
    },
    /// Gives a node an input.
    Connect {
        /// The node.
        node: String,
        /// The way to the input within the node, from its kind on, such as `["mix", "by"]`.
        input: Vec<Part>,
        /// A name of a node, a color or a number.
        from: Json,
    },
    /// Makes a PUPs texture one of points that are in the text, with the same picture.
    MakePoints {
        /// The node.
        node: String,
        /// The options of the texture of points, which a [`Session`](crate::Session) fills in.
        #[serde(skip)]
        points: Option<Json>,
    },
}

/// The text after some changes, one after the other.
///
/// # Errors
///
/// If the text is no TOML, or a change does not fit it; then nothing is changed.
pub fn apply(text: &str, ops: &[Op]) -> Result<String, StudioError> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        StudioError::new(format!("the text is no TOML yet: {}", error.message()))
    })?;
    for op in ops {
        apply_one(&mut document, op)?;
    }
    let new = document.to_string();
    // What is written is read again, so that no change can break the text.
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
        Op::RemoveNode { name } => root.remove(&["nodes".into(), Part::Key(name.clone())]),
        Op::RenameNode { name, to } => nodes::rename(document, name, to),
        Op::DuplicateNode { name, to } => nodes::duplicate(document, name, to),
        Op::Connect { node, input, from } => nodes::connect(document, node, input, from),
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
