//! The nodes of a recipe and the inputs of each.

use crate::schema::{Found, Role, roles};
use crate::{Document, Part};
use dapple::recipe::Plan;
use serde::Serialize;
use serde_json::{Map, Value as Json};

/// The nodes of a recipe, in the order of the text.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Graph {
    nodes: Vec<GraphNode>,
    /// The material's inputs, by name.
    material: Map<String, Json>,
    /// The names of the nodes in topological order: every node follows its inputs. Without a plan, they are in the
    /// order of the text.
    order: Vec<String>,
}

/// A node of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct GraphNode {
    name: String,
    kind: String,
    /// Whether the node produces colors rather than numbers.
    is_color: bool,
    /// Whether the node needs the whole tile.
    is_global: bool,
    /// The range of the node in the text, in UTF-16 code units.
    span: Option<[usize; 2]>,
    inputs: Vec<GraphInput>,
}

/// An input of a node.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct GraphInput {
    label: String,
    /// The path of the input within the node, starting at its kind.
    path: Vec<Part>,
    /// The node connected to the input, if any.
    node: Option<String>,
    /// The value as written, or the default.
    value: Json,
}

impl Graph {
    /// Builds the graph of a document. Without a plan, `is_color` and `is_global` are false and `order` is the order of
    /// the text.
    #[must_use]
    pub fn new(document: &Document, plan: Option<&Plan>) -> Option<Self> {
        let data = document.data()?;
        let found = roles(&data);
        let node = |(name, node): (&String, &Json)| {
            let (kind, _) = node.as_object()?.iter().next()?;
            let is_here = |found: &&Found<'_>| {
                found.role == Role::Input
                    && found
                        .path
                        .starts_with(&["nodes".into(), name.as_str().into()])
            };
            let inputs = found.iter().filter(is_here).map(|found| input(found, 2));
            Some(GraphNode {
                name: name.clone(),
                kind: kind.clone(),
                is_color: plan.is_some_and(|plan| plan.is_color(name)),
                is_global: plan.is_some_and(|plan| plan.is_global(name)),
                span: document.node_span(name),
                inputs: inputs.collect(),
            })
        };
        // List the nodes in the order of the text.
        let names = document.keys("nodes");
        let all = data.get("nodes").and_then(Json::as_object);
        let nodes = names
            .iter()
            .filter_map(|name| node(all?.get_key_value(name)?));
        let nodes: Vec<_> = nodes.collect();
        // List the inputs of the material.
        let of_material = |found: &&Found<'_>| {
            found.role == Role::Input && found.path.first() == Some(&"material".into())
        };
        let material = found.iter().filter(of_material).map(|found| {
            let input = input(found, 1);
            (
                input.label.clone(),
                serde_json::json!({ "node": input.node, "value": input.value }),
            )
        });
        Some(Self {
            material: material.collect(),
            order: match plan {
                Some(plan) => plan.node_names().map(str::to_owned).collect(),
                None => names,
            },
            nodes,
        })
    }

    /// Returns the names of the nodes, in the order of the text.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.nodes.iter().map(|node| node.name.as_str())
    }
}

/// Converts an input of the recipe to an input of its node. The first `skipped` components of its path are removed.
fn input(found: &Found<'_>, skipped: usize) -> GraphInput {
    let path = found.path[skipped..].to_vec();
    // A text can also be a color, or refer to a parameter.
    let is_node = |text: &&str| !text.starts_with(['#', '$']);
    GraphInput {
        label: label(&path),
        path,
        node: found
            .value
            .and_then(Json::as_str)
            .filter(is_node)
            .map(str::to_owned),
        value: found.value.cloned().unwrap_or(Json::Null),
    }
}

/// Returns a short label for an input: its key, followed by its indices in nested arrays, which start at 1.
fn label(path: &[Part]) -> String {
    let parts = if path.len() > 1 { &path[1..] } else { path };
    let words = parts.iter().map(|part| match part {
        Part::Index(index) => (index + 1).to_string(),
        Part::Key(key) => key.clone(),
    });
    words.collect::<Vec<_>>().join(" ")
}
