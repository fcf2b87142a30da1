//! The JSON Schema of recipes, for completion in editors.
//!
//! The schema is generated from the types that recipes are deserialized into, so that the names and types of options,
//! their ranges and their defaults agree with the parser. The descriptions are the doc comments of these types.

mod reference;

use crate::nodes::{ColorOf, Frequency, ImageAlpha, NodeSeed, WorleyValue};
use crate::plan::FREQUENCY;
use crate::text::ALIASES;
use crate::{Input, Recipe};
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;

impl Recipe {
    /// Returns the JSON Schema of recipes, draft 2020-12.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_recipe::Recipe;
    ///
    /// let schema = Recipe::schema();
    /// assert_eq!(schema["$defs"]["Power"]["properties"]["exponent"]["exclusiveMinimum"], 0.0);
    /// ```
    #[must_use]
    pub fn schema() -> Value {
        let mut schema = SchemaGenerator::default().into_root_schema_for::<Self>();
        plain(&mut schema);
        let mut schema = schema.to_value();
        // Parameters are substituted before recipes are read, so the type of recipes does not describe them.
        schema["properties"]["parameters"] = parameters();
        schema
    }

    /// Returns the [schema](Self::schema) of the texts of recipes, for editors: an option is its value, or a reference to a
    /// [parameter](Self::parameters).
    #[must_use]
    pub fn text_schema() -> Value {
        let mut schema = Self::schema();
        for option in ["seed", "extent", "wrap"] {
            allow_reference(&mut schema["properties"][option]);
        }
        allow_references(&mut schema["$defs"]);
        schema["$defs"]["Reference"] = json!({
            "description": "Reference to a parameter, such as `\"$jitter\"`.",
            "type": "string",
            "pattern": "^\\$",
        });
        schema
    }

    /// Returns a reference of all options of recipes, in Markdown.
    #[must_use]
    pub fn reference() -> String {
        reference::reference(&Self::schema())
    }
}

/// Allows references to parameters as values of all options and elements of lists in a schema.
fn allow_references(schema: &mut Value) {
    match schema {
        Value::Object(entries) => {
            for (key, inner) in entries {
                allow_references(inner);
                match (key.as_str(), inner) {
                    ("properties", Value::Object(options)) => {
                        options.values_mut().for_each(allow_reference);
                    }
                    ("items", element) => allow_reference(element),
                    _ => {}
                }
            }
        }
        Value::Array(all) => all.iter_mut().for_each(allow_references),
        _ => {}
    }
}

/// Allows a reference to a parameter as the value of an option. The description and the default stay at the option.
fn allow_reference(option: &mut Value) {
    let mut outer = json!({});
    for key in ["description", "default", "deprecated"] {
        if let Some(about) = option.as_object_mut().and_then(|option| option.remove(key)) {
            outer[key] = about;
        }
    }
    outer["anyOf"] = json!([option.take(), { "$ref": "#/$defs/Reference" }]);
    *option = outer;
}

/// Returns the schema of named parameters.
fn parameters() -> Value {
    let value = json!({ "type": ["number", "string", "boolean", "array"] });
    let mut plain = value.clone();
    plain["description"] = json!("Number, text, truth value, or list of these.");
    let number = json!({ "type": "number" });
    json!({
        "description": "Named values that options share: an option has the value of a parameter if it is written as `\"$name\"`. A table adds a range and a description.",
        "type": "object",
        "additionalProperties": { "anyOf": [plain, {
            "type": "object",
            "properties": {
                "value": value,
                "range": { "type": "array", "items": number, "minItems": 2, "maxItems": 2 },
                "doc": { "type": "string" },
            },
            "required": ["value"],
            "additionalProperties": false,
        }] },
    })
}

/// Removes rustdoc markup from descriptions and adds option aliases, in all subschemas.
fn plain(schema: &mut Schema) {
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = without_links(text);
    }
    if let Some(Value::Object(options)) = schema.get_mut("properties") {
        for (name, alias) in ALIASES {
            if let Some(option) = options.get(name).cloned() {
                options.insert(alias.to_owned(), deprecated(option, name));
            }
        }
    }
    transform_subschemas(&mut (plain as fn(&mut Schema)), schema);
}

/// Converts an option's schema to that of its alias, marked as deprecated in favor of `name`.
fn deprecated(mut option: Value, name: &str) -> Value {
    if let Value::Object(option) = &mut option {
        option.remove("default");
        option.insert(
            "description".to_owned(),
            json!(format!("Alias of `{name}`.")),
        );
        option.insert("deprecated".to_owned(), json!(true));
    }
    option
}

/// Returns the first paragraph of a description, with each intra-doc link replaced by its name in code style.
fn without_links(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or(text).replace('\n', " ");
    let mut plain = String::new();
    let mut rest = paragraph.as_str();
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((name, after)) = link.split_once("`]") else {
            break;
        };
        plain.push_str(before);
        plain.push('`');
        plain.push_str(name);
        plain.push('`');
        let target = after
            .strip_prefix('(')
            .and_then(|target| target.split_once(')'));
        rest = target.map_or(after, |(_, after)| after);
    }
    plain + rest
}

/// Implements `JsonSchema` for types that can be written in more than one form.
macro_rules! schemas {
    ($($type:ident => $schema:expr;)*) => {
        $(impl JsonSchema for $type {
            fn schema_name() -> Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                $schema
            }
        })*
    };
}

/// A regular expression for hexadecimal sRGB colors.
const HEX: &str = "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$";

schemas! {
    Input => json_schema!({
        "description": "Number, color in sRGB such as `\"#c08040\"`, or the name of a node.",
        "anyOf": [
            { "type": "number" },
            { "type": "string", "pattern": HEX },
            { "type": "string", "pattern": "^[^#]" },
        ],
    });
    ColorOf => json_schema!({
        "description": "Color in sRGB, such as `\"#c08040\"`.",
        "type": "string",
        "pattern": HEX,
    });
    ImageAlpha => json_schema!({
        "description": "`\"drop\"`, or `\"over:#rrggbb\"`.",
        "type": "string",
        "pattern": "^(drop|over:#([0-9a-fA-F]{3}|[0-9a-fA-F]{6}))$",
    });
    NodeSeed => json_schema!({
        "description": "Seed, or the name of a node whose random numbers are used.",
        "anyOf": [{ "type": "string" }, { "type": "integer", "minimum": 0 }],
    });
    WorleyValue => json_schema!({
        "description": "Name of a value, or the four coefficients of F1 to F4.",
        "anyOf": [
            { "enum": Self::names() },
            { "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 },
        ],
    });
    Frequency => {
        let mut number = json_schema!({ "type": "number" });
        FREQUENCY.clone().transform(&mut number);
        json_schema!({
            "description": "Frequency per unit of the plane: one number, or one for each axis.",
            "anyOf": [
                number,
                { "type": "array", "items": number, "minItems": 2, "maxItems": 2 },
            ],
        })
    };
}
