//! Builds the flags of textures of control points from the schemas of all textures.

use super::{KINDS, Kind};
use crate::node::{Flag, NodeFlags, NodeOption, followed, schema, variants};
use serde_json::Value;

/// Options without a flag. The command sets them in other ways, such as from `--frames`.
const WITHOUT_FLAG: [&str; 9] = [
    "alpha", "cells", "domain", "file", "motion", "net", "options", "points", "wrap",
];

/// Options with the same meaning in several textures, which share a flag. Pairs of the flag and the options' names.
const SHARED: [(&str, &[&str]); 2] = [
    ("octaves", &["octaves", "layers", "iterations"]),
    ("spacings", &["distances"]),
];

/// Help text of the option `spacing`. The command takes a distance, not a density or a count.
const SPACING: &str =
    "Minimum distance of control points in units of the plane [default: the texture's]";

/// Marker for the flags that come from the options of all textures of the recipe node `pups`.
#[derive(Clone, Debug)]
pub(super) struct PupsFlags;

impl NodeFlags for PupsFlags {
    const KIND: &'static str = "pups";
    const FLAGS: &'static [Flag] = &[];

    fn options() -> Vec<NodeOption> {
        let mut options: Vec<(NodeOption, Vec<String>)> = Vec::new();
        for kind in KINDS {
            for (name, schema) in tables(kind).into_iter().flat_map(entries) {
                let flag = SHARED.iter().find(|(_, names)| names.contains(&name));
                let entry = match flag {
                    Some((flag, _)) => Flag::new("", flag),
                    None => Flag::none(""),
                };
                // Defaults differ between textures.
                let mut option = NodeOption::plain(name, schema, entry.without_default());
                if name == "spacing" {
                    SPACING.clone_into(&mut option.help);
                }
                if WITHOUT_FLAG.contains(&name)
                    || schema["deprecated"] == true
                    || !option.is_simple()
                {
                    continue;
                }
                match options
                    .iter_mut()
                    .find(|(known, _)| known.flag == option.flag)
                {
                    Some((known, kinds)) => {
                        known.widen(&option);
                        kinds.push(kind.name());
                    }
                    None => options.push((option, vec![kind.name()])),
                }
            }
        }
        options.into_iter().map(described).collect()
    }
}

/// Adds the names of the textures that have the option to its help text, unless most of them have it.
fn described((mut option, kinds): (NodeOption, Vec<String>)) -> NodeOption {
    if 2 * kinds.len() < KINDS.len() {
        let help = option.help.trim_end_matches('.');
        option.help = format!("{help}; for {}", kinds.join(", "));
    }
    option
}

/// Returns the names of all options that share a flag with `name`; only `name` if it does not share its flag.
pub(super) fn names_of(name: &str) -> Vec<&str> {
    let shared = SHARED.iter().find(|(_, names)| names.contains(&name));
    shared.map_or_else(|| vec![name], |(_, names)| names.to_vec())
}

/// Returns the schemas of a texture's options: its own table and the tables nested in it.
fn tables(kind: Kind) -> Vec<&'static Value> {
    let mut textures = variants(&schema()["$defs"]["PupsNode"]);
    let texture = textures.find_map(|texture| texture["properties"].get(kind.in_recipes()));
    let texture = followed(texture.unwrap_or(&Value::Null));
    let inside = |table: &'static Value, name: &str| followed(&table["properties"][name]);
    let options = inside(texture, "options");
    vec![
        texture,
        options,
        inside(texture, "net"),
        inside(options, "net"),
    ]
}

/// Returns the options in a table's schema, as pairs of name and schema.
fn entries(table: &'static Value) -> impl Iterator<Item = (&'static str, &'static Value)> {
    let entries = table["properties"].as_object().into_iter().flatten();
    entries.map(|(name, schema)| (name.as_str(), schema))
}
