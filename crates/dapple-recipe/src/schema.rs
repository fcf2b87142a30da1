//! The JSON Schema of recipes, for completion in editors.
//!
//! The schema is generated from the types that recipes are deserialized into, so that the names and types of options,
//! their ranges and their defaults agree with the parser. The descriptions are the doc comments of these types.

mod reference;

use crate::nodes::{ColorOf, Frequency, ImageAlpha, NodeSeed, WorleyValue};
use crate::plan::FREQUENCY;
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
        schema.to_value()
    }

    /// Returns a reference of all options of recipes, in Markdown.
    #[must_use]
    pub fn reference() -> String {
        reference::reference(&Self::schema())
    }
}

/// Aliases that the parser accepts for options, as pairs of option and alias.
const ALIASES: [(&str, &str); 3] = [
    ("gain", "persistence"),
    ("albedo", "basecolor"),
    ("albedo", "base_color"),
];

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
