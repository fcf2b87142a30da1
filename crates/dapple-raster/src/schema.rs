//! JSON schemas of named enums and of ranges.

use crate::{Named, Range};
use core::ops::Bound;
use schemars::transform::Transform;
use schemars::{Schema, json_schema};

/// Returns the schema of a named enum: each value's name with its documentation.
#[doc(hidden)]
#[must_use]
pub fn named_schema<T: Named>() -> Schema {
    let value = |value: &T| {
        let description = value.documentation().trim();
        json_schema!({ "const": value.name(), "description": description })
    };
    json_schema!({ "oneOf": T::ALL.iter().map(value).collect::<Vec<_>>() })
}

impl Transform for Range {
    /// Adds the range to the schema of a number, or of a list of numbers.
    fn transform(&mut self, schema: &mut Schema) {
        if let Some(items) = schema
            .get_mut("items")
            .and_then(|items| items.try_into().ok())
        {
            return self.transform(items);
        }
        for (bound, included, excluded) in [
            (self.least, "minimum", "exclusiveMinimum"),
            (self.most, "maximum", "exclusiveMaximum"),
        ] {
            match bound {
                Bound::Included(number) => schema.insert(included.to_owned(), number.into()),
                Bound::Excluded(number) => schema.insert(excluded.to_owned(), number.into()),
                Bound::Unbounded => None,
            };
        }
        if let (Bound::Excluded(_), Some(_)) = (self.least, schema.get("minimum")) {
            schema.remove("minimum");
        }
    }
}
