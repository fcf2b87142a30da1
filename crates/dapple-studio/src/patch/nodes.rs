//! Applies edits to whole nodes.

use super::{Op, Part, Place, apply_one};
use crate::StudioError;
use crate::data::{json_of_table, table_of};
use crate::schema::{Found, Role, roles};
use dapple::recipe::{KINDS, NEW_NODES};
use serde_json::{Map, Value as Json, json};
use toml_edit::{DocumentMut, InlineTable, Item, Key, Table, Value};

/// Adds a node after all other nodes.
pub(super) fn add(
    document: &mut DocumentMut,
    name: &str,
    kind: &str,
    value: &Json,
) -> Result<(), StudioError> {
    check_new(document, name)?;
    if !KINDS.contains(&kind) {
        return Err(StudioError::new(format!(
            "there is no kind of node `{kind}`"
        )));
    }
    let path = ["nodes".into(), name.into()];
    Place::Table(document.as_table_mut()).set(&path, &json!({ kind: value }))?;
    // Separate the node from the previous one by a blank line.
    if let Some(Item::Table(node)) = document
        .get_mut("nodes")
        .and_then(|nodes| nodes.get_mut(name))
    {
        set_blank_line(node);
    }
    Ok(())
}

/// Sets a single blank line before the first header of a node.
fn set_blank_line(node: &mut Table) {
    if !node.is_implicit() {
        node.decor_mut().set_prefix("\n");
        return;
    }
    for (_, item) in node.iter_mut() {
        if let Item::Table(kind) = item {
            kind.decor_mut().set_prefix("\n");
        }
    }
}

/// Removes a node. Inputs that refer to it get their defaults.
pub(super) fn remove(document: &mut DocumentMut, name: &str) -> Result<(), StudioError> {
    let path = vec!["nodes".into(), name.into()];
    apply_one(document, &Op::Remove { path })?;
    let data = json_of_table(document);
    let is_link = |found: &Found<'_>| found.value.and_then(Json::as_str) == Some(name);
    reset(document, &data, is_link)
}

/// Removes the link of the input at a path.
pub(super) fn disconnect(document: &mut DocumentMut, path: &[Part]) -> Result<(), StudioError> {
    let data = json_of_table(document);
    reset(document, &data, |found| found.path == path)
}

/// Resets the inputs for which `is_link` returns true. An optional input loses its value. A required one gets the value
/// that it has in a new node.
fn reset(
    document: &mut DocumentMut,
    data: &Json,
    is_link: impl Fn(&Found<'_>) -> bool,
) -> Result<(), StudioError> {
    for found in roles(data) {
        if found.role != Role::Input || !found.is_written || !is_link(&found) {
            continue;
        }
        let path = found.path;
        let op = if found.is_required {
            let value = initial(&path).unwrap_or_else(|| json!(0.5));
            Op::Set { path, value }
        } else {
            Op::Remove { path }
        };
        apply_one(document, &op)?;
    }
    Ok(())
}

/// Returns the value of an input in a new node of the same kind. Additional elements of a list equal its last one.
fn initial(path: &[Part]) -> Option<Json> {
    let [_, _, Part::Key(kind), inner @ ..] = path else {
        return None;
    };
    let mut kinds = KINDS.into_iter().zip(NEW_NODES);
    let (_, (_, start)) = kinds.find(|(name, _)| name == kind)?;
    let start: Json = serde_json::from_str(start).ok()?;
    let value = inner.iter().try_fold(&start, |value, part| match part {
        Part::Key(key) => value.get(key),
        Part::Index(index) => value.get(index).or_else(|| value.as_array()?.last()),
    });
    value.cloned()
}

/// Renames a node and all inputs that refer to it. Its random stream stays derived from the old name.
pub(super) fn rename(document: &mut DocumentMut, name: &str, to: &str) -> Result<(), StudioError> {
    if name == to {
        return Ok(());
    }
    check_new(document, to)?;
    let data = json_of_table(document);
    match document.get_mut("nodes") {
        Some(Item::Table(nodes)) if nodes.contains_key(name) => rename_in_table(nodes, name, to),
        Some(Item::Value(Value::InlineTable(nodes))) if nodes.contains_key(name) => {
            let entries: Vec<_> = nodes
                .iter()
                .map(|(key, value)| (key.to_owned(), value.clone()))
                .collect();
            nodes.clear();
            for (key, value) in entries {
                nodes.insert(if key == name { to } else { &key }, value);
            }
        }
        _ => return Err(no_node(name)),
    }
    // Rename the references in inputs.
    for found in roles(&data) {
        let is_named = found.value.and_then(Json::as_str) == Some(name);
        if found.role == Role::Input && found.is_written && is_named {
            let path = moved(found.path, name, to);
            let value = to.into();
            apply_one(document, &Op::Set { path, value })?;
        }
    }
    keep_seed(document, &data, name, to)
}

/// Returns the path with the node's name replaced by `to`, if the path is in the node `name`.
fn moved(mut path: Vec<Part>, name: &str, to: &str) -> Vec<Part> {
    if let [first, node, ..] = &mut path[..]
        && *first == Part::from("nodes")
        && *node == Part::from(name)
    {
        *node = Part::from(to);
    }
    path
}

/// Writes seeds into the node `to`, the renamed or copied node, so that it draws from the same random stream as the
/// node `name` in `data`.
fn keep_seed(
    document: &mut DocumentMut,
    data: &Json,
    name: &str,
    to: &str,
) -> Result<(), StudioError> {
    for found in roles(data) {
        let is_of_node = found.path.starts_with(&["nodes".into(), name.into()]);
        if found.role != Role::Seed || !is_of_node {
            continue;
        }
        let path = moved(found.path, name, to);
        // Drop a seed that equals the new name, keep any other seed, and write the old name where there is no seed.
        match found.value {
            Some(seed) if found.is_written && seed == to => {
                apply_one(document, &Op::Remove { path })?;
            }
            _ if found.is_written => {}
            _ => {
                let value = name.into();
                apply_one(document, &Op::Set { path, value })?;
            }
        }
    }
    Ok(())
}

/// Renames an entry of a table and keeps its position.
fn rename_in_table(table: &mut Table, name: &str, to: &str) {
    let keys: Vec<_> = table.iter().map(|(key, _)| key.to_owned()).collect();
    let entries: Vec<_> = keys
        .iter()
        .filter_map(|key| table.remove_entry(key))
        .collect();
    for (key, item) in entries {
        let key = if key.get() == name {
            Key::new(to)
                .with_leaf_decor(key.leaf_decor().clone())
                .with_dotted_decor(key.dotted_decor().clone())
        } else {
            key
        };
        table.insert_formatted(&key, item);
    }
}

/// Adds a copy of a node. The copy draws from the random stream of the original.
pub(super) fn duplicate(
    document: &mut DocumentMut,
    name: &str,
    to: &str,
) -> Result<(), StudioError> {
    check_new(document, to)?;
    let data = json_of_table(document);
    let node = data
        .get("nodes")
        .and_then(|nodes| nodes.get(name))
        .and_then(Json::as_object);
    let (kind, value) = node
        .and_then(|node| node.iter().next())
        .ok_or_else(|| no_node(name))?;
    add(document, to, kind, value)?;
    keep_seed(document, &data, name, to)
}

/// Connects an input of a node.
pub(super) fn connect(
    document: &mut DocumentMut,
    node: &str,
    input: &[Part],
    from: &Json,
) -> Result<(), StudioError> {
    if !(from.is_string() || from.is_number()) {
        return Err(StudioError::new(
            "an input is a number, a color, or the name of a node",
        ));
    }
    let data = json_of_table(document);
    if data
        .get("nodes")
        .and_then(|nodes| nodes.get(node))
        .is_none()
    {
        return Err(no_node(node));
    }
    // An index just past the end of an array appends an input.
    let mut path: Vec<Part> = vec!["nodes".into(), node.into()];
    path.extend_from_slice(input);
    let root = Place::Table(document.as_table_mut());
    if let Some((Part::Index(index), list)) = path.split_last() {
        let n_inputs = data
            .pointer(&pointer(list))
            .and_then(Json::as_array)
            .map_or(0, Vec::len);
        if *index == n_inputs {
            return root.insert(list, *index, from);
        }
    }
    root.set(&path, from)
}

/// Converts a PUPs texture to one with explicit points, with one point per line.
pub(super) fn make_points(
    document: &mut DocumentMut,
    node: &str,
    options: &Map<String, Json>,
) -> Result<(), StudioError> {
    // Put each point on a separate line.
    let mut table = table_of(options)?;
    if let Some(Item::Value(Value::Array(points))) = table.get_mut("points") {
        for point in points.iter_mut() {
            point.decor_mut().set_prefix("\n    ");
        }
        points.set_trailing("\n");
        points.set_trailing_comma(true);
    }
    let pups = document
        .get_mut("nodes")
        .and_then(|nodes| nodes.get_mut(node)?.get_mut("pups"));
    let pups = pups.ok_or_else(|| no_node(node))?;
    match pups {
        Item::Table(old) if !old.is_dotted() => {
            // Keep the comments above the header.
            let header = if old.is_implicit() {
                old.iter().find_map(|(_, item)| item.as_table())
            } else {
                Some(&*old)
            };
            if let Some(header) = header {
                *table.decor_mut() = header.decor().clone();
                table.set_position(header.position());
            }
            old.clear();
            old.set_implicit(true);
            old.insert("points", Item::Table(table));
        }
        _ => {
            let mut inline = InlineTable::new();
            inline.insert("points", Value::InlineTable(table.into_inline_table()));
            *pups = Item::Value(Value::InlineTable(inline));
        }
    }
    Ok(())
}

/// Rejects invalid names of nodes and names that are in use.
fn check_new(document: &DocumentMut, name: &str) -> Result<(), StudioError> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is_plain);
    if !is_name || name.len() > 200 {
        let message = format!(
            "the name `{name}` is not made of letters, digits, `_` and `-`, beginning with a letter"
        );
        return Err(StudioError::new(message));
    }
    let nodes = document.get("nodes").and_then(Item::as_table_like);
    if nodes.is_some_and(|nodes| nodes.contains_key(name)) {
        return Err(StudioError::new(format!(
            "there is a node `{name}` already"
        )));
    }
    Ok(())
}

fn no_node(name: &str) -> StudioError {
    StudioError::new(format!("there is no node `{name}`"))
}

/// Converts a path to a JSON pointer.
pub(crate) fn pointer(path: &[Part]) -> String {
    let parts = path.iter().map(|part| match part {
        Part::Index(index) => format!("/{index}"),
        Part::Key(key) => format!("/{}", key.replace('~', "~0").replace('/', "~1")),
    });
    parts.collect()
}
