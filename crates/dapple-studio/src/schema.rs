//! Queries the schema of recipes for the paths of inputs and seeds, and for the kinds of nodes.

use crate::Part;
use dapple::recipe::{KINDS, NEW_NODES, NODE_TAGS, Recipe};
use serde::Serialize;
use serde_json::Value as Json;
use std::sync::OnceLock;

/// The role of a value in a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// An input: a number, a color or the name of a node.
    Input,
    /// A seed, or a name that a random stream is derived from.
    Seed,
}

/// An input or a seed of a recipe, with its path and its value: the default if the recipe does not set it.
#[derive(Clone, Debug)]
pub(crate) struct Found<'a> {
    pub(crate) path: Vec<Part>,
    pub(crate) role: Role,
    pub(crate) value: Option<&'a Json>,
    pub(crate) is_written: bool,
    /// Whether the recipe is invalid without the value. Elements of arrays are required.
    pub(crate) is_required: bool,
}

/// A kind of node, for a menu.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Kind {
    name: &'static str,
    /// The group of the kind, such as `color`.
    group: &'static str,
    /// Words of other programs for it, separated by commas.
    tags: &'static str,
    /// The options of a new node of this kind.
    value: Json,
}

/// Returns the schema of recipes.
pub(crate) fn schema() -> &'static Json {
    static SCHEMA: OnceLock<Json> = OnceLock::new();
    SCHEMA.get_or_init(Recipe::schema)
}

/// Returns the inputs and seeds of a recipe, including those left at their defaults.
pub(crate) fn roles(recipe: &Json) -> Vec<Found<'_>> {
    let mut walk = Walk::default();
    walk.value(schema(), recipe);
    walk.found
}

#[derive(Default)]
struct Walk<'a> {
    path: Vec<Part>,
    /// Whether the enclosing table or array requires the current value.
    is_required: bool,
    found: Vec<Found<'a>>,
}

impl<'a> Walk<'a> {
    /// Visits a value and everything in it, together with its schema.
    fn value(&mut self, schema: &'a Json, value: &'a Json) {
        if let Some(role) = role(schema) {
            let is_used = |found: &Found<'_>| found.path == self.path;
            if !self.found.iter().rev().take(8).any(is_used) {
                self.note(role, Some(value), true);
            }
            return;
        }
        let schema = resolved(schema);
        // Follow a schema that is only a reference.
        if schema.get("$ref").is_some() {
            return self.value(schema, value);
        }
        // Walk all variants of a union.
        for branch in branches(schema) {
            self.value(branch, value);
        }
        match value {
            Json::Object(entries) => {
                let properties = schema.get("properties");
                let others = schema.get("additionalProperties");
                for (key, value) in entries {
                    if let Some(inner) = properties.and_then(|all| all.get(key)).or(others) {
                        let is_required = requirements(schema).any(|required| required == key);
                        self.within(Part::Key(key.clone()), is_required, |walk| {
                            walk.value(inner, value);
                        });
                    }
                }
                // Only a variant whose required keys are present can have missing properties.
                let is_this = requirements(schema).all(|key| entries.contains_key(key));
                if is_this {
                    self.missing(schema, entries);
                }
            }
            Json::Array(list) => {
                if let Some(inner) = schema.get("items") {
                    for (index, value) in list.iter().enumerate() {
                        self.within(Part::Index(index), true, |walk| walk.value(inner, value));
                    }
                }
            }
            _ => {}
        }
    }

    /// Records the optional inputs and seeds that a table leaves at their defaults.
    fn missing(&mut self, schema: &'a Json, entries: &serde_json::Map<String, Json>) {
        let Some(Json::Object(properties)) = schema.get("properties") else {
            return;
        };
        for (key, inner) in properties {
            let is_old = inner.get("deprecated").is_some();
            if let Some(role) = optional_role(inner)
                && !is_old
                && !entries.contains_key(key)
            {
                let default = inner.get("default").filter(|value| !value.is_null());
                self.within(Part::Key(key.clone()), false, |walk| {
                    walk.note(role, default, false);
                });
            }
        }
    }

    fn note(&mut self, role: Role, value: Option<&'a Json>, is_written: bool) {
        let path = self.path.clone();
        self.found.push(Found {
            path,
            role,
            value,
            is_written,
            is_required: self.is_required,
        });
    }

    fn within(&mut self, part: Part, is_required: bool, visit: impl FnOnce(&mut Self)) {
        self.path.push(part);
        let outer = core::mem::replace(&mut self.is_required, is_required);
        visit(self);
        self.is_required = outer;
        self.path.pop();
    }
}

/// Returns the role of a value whose schema is a reference to a type; `None` for other schemas.
fn role(schema: &Json) -> Option<Role> {
    match schema.get("$ref")?.as_str()? {
        "#/$defs/Input" => Some(Role::Input),
        "#/$defs/NodeSeed" => Some(Role::Seed),
        _ => None,
    }
}

/// Returns the role of a value whose schema also allows null; `None` for other schemas.
fn optional_role(schema: &Json) -> Option<Role> {
    role(schema).or_else(|| schema.get("anyOf")?.as_array()?.iter().find_map(role))
}

fn resolved(schema_or_reference: &Json) -> &Json {
    let name = schema_or_reference.get("$ref").and_then(Json::as_str);
    let definition = name.and_then(|name| schema().pointer(name.strip_prefix('#')?));
    definition.unwrap_or(schema_or_reference)
}

fn branches(schema: &Json) -> impl Iterator<Item = &Json> {
    let all = ["anyOf", "oneOf", "allOf"].into_iter();
    all.filter_map(|key| schema.get(key)?.as_array()).flatten()
}

fn requirements(schema: &Json) -> impl Iterator<Item = &str> {
    let all = schema.get("required").and_then(Json::as_array);
    all.into_iter().flatten().filter_map(Json::as_str)
}

/// Returns all kinds of nodes, in the order of [`KINDS`](dapple::recipe::KINDS).
pub(crate) fn kinds() -> Vec<Kind> {
    let kind = |((name, (group, example)), tags)| Kind {
        name,
        group,
        tags,
        value: serde_json::from_str(example).unwrap_or_default(),
    };
    let all = KINDS.into_iter().zip(NEW_NODES).zip(NODE_TAGS);
    all.map(kind).collect()
}

#[cfg(test)]
mod tests {
    use super::{Role, kinds, roles};
    use crate::data::json_of_table;
    use dapple::recipe::{Images, Input, Plan, Recipe};
    use serde_json::json;
    use toml_edit::DocumentMut;

    #[test]
    fn inputs_of_the_builtin_recipes_are_those_of_their_nodes() {
        for name in Recipe::builtin_names() {
            let text = Recipe::builtin_text(name).unwrap();
            let data = json_of_table(&text.parse::<DocumentMut>().unwrap());
            let found = roles(&data);
            for (name, node) in &Recipe::from_toml(text).unwrap().nodes {
                let of_node = found.iter().filter(|found| {
                    found.role == Role::Input
                        && found.path[0] == "nodes".into()
                        && found.path[1] == name.as_str().into()
                });
                let mut found: Vec<_> = of_node.filter_map(|found| found.value?.as_str()).collect();
                let inputs = node.inputs();
                let names = inputs.iter().filter_map(|input| match input {
                    Input::Node(name) => Some(name.clone()),
                    _ => None,
                });
                let mut names: Vec<_> = names.collect();
                found.retain(|text| !text.starts_with('#'));
                found.sort_unstable();
                names.sort();
                assert_eq!(found, names, "{name}");
            }
        }
    }

    #[test]
    fn every_kind_begins_with_a_node_that_can_be_read() {
        for kind in kinds() {
            let recipe = json!({
                "dapple": 1, "extent": [4, 4], "material": {}, "nodes": { "a": { kind.name: kind.value } },
            });
            let recipe = Recipe::from_json(&recipe.to_string());
            let recipe = recipe.unwrap_or_else(|error| panic!("{}: {error}", kind.name));
            if !["image", "synth"].contains(&kind.name) {
                Plan::new(&recipe, &Images::new(), 0.0)
                    .unwrap_or_else(|error| panic!("{}: {error}", kind.name));
            }
        }
    }
}
