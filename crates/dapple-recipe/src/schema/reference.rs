//! Renders the schema of recipes as a reference of all options, in Markdown.

use crate::nodes::{KINDS, NODE_TAGS};
use core::fmt::Write as _;
use serde_json::{Map, Value};

const HEAD: &str = "\
# Options of recipes

Every option of a recipe, with its form, range and default. This page is generated from the types that recipes are read
into, by `dapple recipe --reference`; `dapple recipe --schema` writes the same as JSON Schema, for editors. The
[README](../README.md) describes what nodes are for.
";

/// Renders the reference of a schema of recipes.
pub(super) fn reference(schema: &Value) -> String {
    let reference = Reference {
        types: &schema["$defs"],
    };
    let mut page = HEAD.to_owned();
    page += "\n## The recipe\n";
    reference.options(&mut page, schema);
    page += "\n## The material\n";
    reference.options(&mut page, &schema["$defs"]["Material"]);
    reference.kinds(&mut page, "Nodes", "Node");
    reference.kinds(&mut page, "Textures of `pups`", "PupsNode");
    reference.types(&mut page);
    page
}

/// Writes the sections of the reference. Looks up the types of the schema by name.
struct Reference<'a> {
    types: &'a Value,
}

impl Reference<'_> {
    /// Appends a section for each variant of an enum. A variant is written as a table with one entry.
    fn kinds(&self, page: &mut String, title: &str, name: &str) {
        let _ = write!(page, "\n## {title}\n");
        for kind in list(&self.types[name]["oneOf"]) {
            let Some((name, inner)) = object(&kind["properties"]).next() else {
                continue;
            };
            let _ = write!(page, "\n### `{name}`\n\n{}\n", text(kind));
            let tags = KINDS.into_iter().zip(NODE_TAGS);
            for (_, tags) in tags.filter(|(kind, tags)| *kind == name && !tags.is_empty()) {
                let _ = write!(page, "\nIn other programs: {tags}.\n");
            }
            let table = self.followed(inner);
            if table["properties"].is_object() {
                self.options(page, table);
            } else {
                let _ = write!(page, "\nForm: {}.\n", self.form(inner));
            }
        }
    }

    /// Appends a table of a type's options.
    fn options(&self, page: &mut String, table: &Value) {
        page.push_str("\n| option | meaning | form | default |\n|---|---|---|---|\n");
        for (name, option) in self.written(table) {
            let needed = list(&table["required"]).any(|needed| needed == name);
            let default = match &option["default"] {
                _ if needed => "required".to_owned(),
                Value::Null => String::new(),
                default => format!("`{}`", in_toml(default)),
            };
            let (about, form) = (text(option), self.form(option));
            let _ = writeln!(page, "| `{name}` | {about} | {form} | {default} |");
        }
    }

    /// Appends the sections of the types in [`FORMS`], which options of several nodes use.
    fn types(&self, page: &mut String) {
        page.push_str("\n## Forms\n");
        for name in FORMS {
            let form = &self.types[name];
            let _ = write!(page, "\n### {name}\n\n{}\n", text(form));
            if form["properties"].is_object() {
                self.options(page, form);
            } else {
                let _ = write!(page, "\nForm: {}.\n", self.form(form));
            }
        }
    }

    /// Returns the type that a schema refers to, through all references; the schema itself if it is not a reference.
    fn followed<'b>(&'b self, schema: &'b Value) -> &'b Value {
        name_of(schema).map_or(schema, |name| self.followed(&self.types[name]))
    }

    /// Returns the options of a table by name, without deprecated ones.
    fn written<'b>(&'b self, table: &'b Value) -> impl Iterator<Item = (&'b str, &'b Value)> {
        let all = object(&table["properties"]);
        all.filter(|(_, option)| {
            option["deprecated"] != true && self.followed(option)["deprecated"] != true
        })
    }

    /// Returns the description of a value's syntax.
    fn form(&self, schema: &Value) -> String {
        if let Some(name) = name_of(schema) {
            if let Some((_, link)) = SECTIONS.iter().find(|(section, _)| *section == name) {
                return (*link).to_owned();
            }
            return match FORMS.contains(&name) {
                true => format!("[{name}](#{})", name.to_lowercase()),
                false => self.form(&self.types[name]),
            };
        }
        let any = list(&schema["anyOf"]).chain(list(&schema["oneOf"]));
        let any: Vec<_> = any.filter(|any| any["type"] != "null").collect();
        if !any.is_empty() {
            let forms: Vec<_> = any.into_iter().map(|any| self.form(any)).collect();
            return forms.join(", or ");
        }
        if !schema["const"].is_null() {
            return format!("`{}`", in_toml(&schema["const"]));
        }
        let words: Vec<_> = list(&schema["enum"])
            .map(|word| format!("`{word}`"))
            .collect();
        if !words.is_empty() {
            return words.join(", ");
        }
        self.form_of_type(schema)
    }

    /// Returns the description of a value's syntax, by its JSON type.
    fn form_of_type(&self, schema: &Value) -> String {
        let range = range(schema);
        match kind(schema) {
            "number" => format!("number{range}"),
            "integer" => format!("whole number{range}"),
            "boolean" => "`true` or `false`".to_owned(),
            "string" => match schema["pattern"].as_str() {
                Some(pattern) if pattern.starts_with("^#") => "color".to_owned(),
                Some("^[^#]") => "name".to_owned(),
                _ => "text".to_owned(),
            },
            "array" => match schema["minItems"].as_u64() {
                Some(n) => format!("list of {n}: {}", self.form(&schema["items"])),
                None => format!("list: {}", self.form(&schema["items"])),
            },
            _ if schema["additionalProperties"].is_object() => {
                format!(
                    "table of names, each with a {}",
                    self.form(&schema["additionalProperties"])
                )
            }
            _ => self.form_of_table(schema),
        }
    }

    /// Returns the description of a table's syntax: its options.
    fn form_of_table(&self, schema: &Value) -> String {
        let inner = self.written(schema);
        let inner = inner.map(|(name, inner)| format!("{name} = {}", self.form(inner)));
        let inner: Vec<_> = inner.collect();
        match inner.is_empty() {
            true => "table".to_owned(),
            false => format!("{{ {} }}", inner.join(", ")),
        }
    }
}

/// The types that the reference describes in the section "Forms".
const FORMS: [&str; 7] = [
    "Input",
    "NodeSeed",
    "Spacing",
    "Variable",
    "Ramp",
    "NetOptions",
    "AxialWeight",
];

/// Types with a section before "Forms", each with the link to that section.
const SECTIONS: [(&str, &str); 3] = [
    ("Material", "[the material](#the-material)"),
    ("Node", "[node](#nodes)"),
    (
        "PupsNode",
        "one of the [textures of `pups`](#textures-of-pups)",
    ),
];

/// Returns the name of the type that a schema refers to.
fn name_of(schema: &Value) -> Option<&str> {
    schema["$ref"].as_str()?.strip_prefix("#/$defs/")
}

/// Returns the JSON type of a value. An option that may be left out has the types `null` and another one; this returns
/// the other.
fn kind(schema: &Value) -> &str {
    let kinds = list(&schema["type"]).filter_map(Value::as_str);
    let beside_null = kinds.into_iter().find(|&kind| kind != "null");
    beside_null.or(schema["type"].as_str()).unwrap_or("table")
}

/// Returns the range of a number, as text that follows its type.
fn range(schema: &Value) -> String {
    let part = |key: &str, word: &str| {
        let number = schema[key].as_f64()?;
        // Leave out the maximum of an integer type, which is not a meaningful limit.
        (number < 4e9).then(|| format!(" {word} {}", in_toml(&schema[key])))
    };
    let least = part("minimum", "from").or_else(|| part("exclusiveMinimum", "above"));
    let most = part("maximum", "to").or_else(|| part("exclusiveMaximum", "below"));
    least.unwrap_or_default() + &most.unwrap_or_default()
}

/// Returns the description of a schema, escaped for a Markdown table.
fn text(schema: &Value) -> String {
    let text = schema["description"].as_str().unwrap_or_default();
    text.replace('|', "\\|")
}

/// Formats a default value in TOML syntax.
fn in_toml(value: &Value) -> String {
    match value {
        Value::Array(all) => {
            let all: Vec<_> = all.iter().map(in_toml).collect();
            format!("[{}]", all.join(", "))
        }
        Value::Object(all) if all.is_empty() => "{}".to_owned(),
        Value::Object(all) => {
            // Leave out the domain of a texture, which recipes must not set.
            let all = all.iter().filter(|(name, _)| *name != "domain");
            let all = all.map(|(name, value)| format!("{name} = {}", in_toml(value)));
            format!("{{ {} }}", all.collect::<Vec<_>>().join(", "))
        }
        Value::Number(number) => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            let is_long = number.abs() >= 1e5;
            if is_long {
                format!("{number:e}")
            } else {
                number.to_string()
            }
        }
        value => value.to_string(),
    }
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn object(value: &Value) -> impl Iterator<Item = (&str, &Value)> {
    let entries = value.as_object().into_iter().flat_map(Map::iter);
    entries.map(|(name, value)| (name.as_str(), value))
}
