//! JSON schemas for options that have several serialized forms, and for types of other crates.

use crate::Spacing;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// Schema of a texture's domain. A material's recipe sets it from its tile.
pub(crate) struct Tile;

/// Schema of a number that may depend on the position.
pub(crate) struct Variable;

impl JsonSchema for Tile {
    fn schema_name() -> Cow<'static, str> {
        "Tile".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Set by the recipe: the domain is the tile.",
            "type": "object",
            "deprecated": true,
        })
    }
}

/// Schema of a vector in 2-D or 3-D.
pub(crate) struct Direction;

impl JsonSchema for Direction {
    fn schema_name() -> Cow<'static, str> {
        "Direction".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Vector of any length: x, y and, optionally, z.",
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 3,
        })
    }
}

/// Ramp of a number between two positions.
#[derive(JsonSchema)]
#[schemars(rename = "Ramp", deny_unknown_fields)]
#[expect(dead_code, reason = "only its schema is wanted")]
struct RampTable {
    /// Start position of the ramp, in units of the plane.
    from: [f64; 2],
    /// End position of the ramp, in units of the plane.
    to: [f64; 2],
    /// Number at the start of the ramp and before the start.
    start: f64,
    /// Number at the end of the ramp and past the end.
    end: f64,
}

/// Returns the schema of a table with one entry.
fn table(name: &str, inner: &Schema) -> Schema {
    json_schema!({
        "type": "object", "properties": { name: inner },
        "required": [name], "additionalProperties": false
    })
}

impl JsonSchema for Variable {
    fn schema_name() -> Cow<'static, str> {
        "Variable".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = json_schema!({ "type": "number" });
        let ramp = generator.subschema_for::<RampTable>();
        json_schema!({
            "description": "Number that is constant, or that changes along a line: linearly, or by equal ratios over equal \
                lengths.",
            "anyOf": [number, table("constant", &number), table("ramp", &ramp), table("geometric_ramp", &ramp)],
        })
    }
}

impl JsonSchema for Spacing {
    fn schema_name() -> Cow<'static, str> {
        "Spacing".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let variable = generator.subschema_for::<Variable>();
        let count = json_schema!({ "type": "integer", "minimum": 1 });
        json_schema!({
            "description": "The smallest distance of two points in units of the plane, points per area, or about how \
                many points there are.",
            "anyOf": [
                { "type": "number", "exclusiveMinimum": 0 },
                table("distance", &variable),
                table("density", &variable),
                table("count", &count),
            ]
        })
    }
}
