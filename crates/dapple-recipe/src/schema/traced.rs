//! Derives schemas of other crates' types by tracing their `Deserialize` implementations.
//!
//! The type is deserialized from a probe instead of data. The probe answers the first value that the type requests with
//! an error that contains the schema of this value. At a struct or an enum there are several ways to continue: the type
//! is then deserialized once for each field or variant.

use core::fmt;
use schemars::{Schema, SchemaGenerator};
use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer,
    MapAccess, SeqAccess, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use serde_json::{Map, Value, json};

/// Returns the schema of a type, without descriptions and defaults.
pub(crate) fn traced<T: DeserializeOwned>(_: &mut SchemaGenerator) -> Schema {
    let schema = explore::<T>(&mut Vec::new()).unwrap_or(Value::Bool(true));
    Schema::try_from(schema).unwrap_or_default()
}

/// The kind of value that a type requested, returned as the error of the deserialization.
#[derive(Debug)]
struct Found {
    asked: Asked,
    /// The lengths of the lists around the value, innermost first; `None` for a list of any length.
    lists: Vec<Option<usize>>,
}

/// A value that a type asks the deserializer for.
#[derive(Debug)]
enum Asked {
    Value(Value),
    Fields(&'static [&'static str]),
    Variants(&'static [&'static str]),
    /// A unit variant of an enum, which is written as a word.
    Word,
}

type Words = &'static [&'static str];

impl Found {
    fn new(asked: Asked) -> Self {
        let lists = Vec::new();
        Self { asked, lists }
    }

    fn value(value: Value) -> Self {
        Self::new(Asked::Value(value))
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self:?}")
    }
}

impl core::error::Error for Found {}

impl Error for Found {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self::value(Value::Bool(true))
    }

    fn unknown_variant(_: &str, expected: Words) -> Self {
        Self::value(json!({ "enum": expected }))
    }
}

/// Returns the schema of the value at the end of `way`, a path of field and variant indices through a type; `None` for
/// a unit variant.
fn explore<T: DeserializeOwned>(way: &mut Vec<usize>) -> Option<Value> {
    let Err(found) = T::deserialize(Probe { way }) else {
        return None;
    };
    // Continue into each field or variant.
    let mut next = |names: Words| -> Vec<(&str, Option<Value>)> {
        let mut all = Vec::new();
        for (index, &name) in names.iter().enumerate() {
            way.push(index);
            all.push((name, explore::<T>(way)));
            way.pop();
        }
        all
    };
    let mut schema = match found.asked {
        Asked::Word => return None,
        Asked::Value(value) => value,
        Asked::Fields(names) => table(next(names)),
        Asked::Variants(names) => one_of(next(names)),
    };
    // Wrap the schema in the lists around it.
    for length in found.lists {
        schema = match length {
            None => json!({ "type": "array", "items": schema }),
            Some(n) => json!({ "type": "array", "items": schema, "minItems": n, "maxItems": n }),
        };
    }
    Some(schema)
}

/// Returns the schema of a struct with these fields.
fn table(fields: Vec<(&str, Option<Value>)>) -> Value {
    let fields = fields.into_iter();
    let properties: Map<_, _> = fields
        .map(|(name, schema)| (name.to_owned(), schema.unwrap_or(Value::Bool(true))))
        .collect();
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// Returns the schema of an enum: a word for each unit variant, and a table with one entry for each other variant.
fn one_of(variants: Vec<(&str, Option<Value>)>) -> Value {
    let (words, tables): (Vec<_>, Vec<_>) = variants
        .into_iter()
        .partition(|(_, schema)| schema.is_none());
    let words: Vec<_> = words.into_iter().map(|(name, _)| name).collect();
    let words = json!({ "type": "string", "enum": words });
    if tables.is_empty() {
        return words;
    }
    let tables = tables.into_iter().map(|(name, schema)| {
        let mut table = table(vec![(name, schema)]);
        table["required"] = json!([name]);
        table
    });
    let has_words = words["enum"] != json!([]);
    let all: Vec<_> = has_words
        .then_some(words)
        .into_iter()
        .chain(tables)
        .collect();
    json!({ "oneOf": all })
}

/// A deserializer that stands in for data. At a struct or an enum, it takes the next index of its path and continues
/// into that field or variant. At the end of the path, it returns the request as an error.
#[derive(Clone, Copy)]
struct Probe<'a> {
    way: &'a [usize],
}

impl<'a> Probe<'a> {
    /// Returns the next index of the path, and a probe with the rest of the path.
    fn fork(self) -> Option<(usize, Self)> {
        let (&index, way) = self.way.split_first()?;
        Some((index, Self { way }))
    }

    /// Reads a list with one element. Notes the list if the path ends in it.
    fn list<'de, V: Visitor<'de>>(
        self,
        length: Option<usize>,
        visitor: V,
    ) -> Result<V::Value, Found> {
        let ends_inside = self.way.is_empty();
        visitor.visit_seq(self).map_err(|mut found| {
            if ends_inside {
                found.lists.push(length);
            }
            found
        })
    }

    /// Reads the field that the path selects; at the end of the path, returns the names of all fields.
    fn fields<'de, V: Visitor<'de>>(self, names: Words, visitor: V) -> Result<V::Value, Found> {
        match self.fork() {
            None => Err(Found::new(Asked::Fields(names))),
            Some((index, rest)) => visitor.visit_map(Named {
                name: names[index],
                rest,
            }),
        }
    }
}

/// Implements the methods of a probe for primitive types.
macro_rules! values {
    ($($method:ident => $schema:tt,)*) => {
        $(fn $method<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Found> {
            Err(Found::value(json!($schema)))
        })*
    };
}

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = Found;

    values! {
        deserialize_bool => { "type": "boolean" },
        deserialize_i8 => { "type": "integer" },
        deserialize_i16 => { "type": "integer" },
        deserialize_i32 => { "type": "integer" },
        deserialize_i64 => { "type": "integer" },
        deserialize_u8 => { "type": "integer", "minimum": 0, "maximum": 255 },
        deserialize_u16 => { "type": "integer", "minimum": 0, "maximum": 65535 },
        deserialize_u32 => { "type": "integer", "minimum": 0, "maximum": 4294967295_u32 },
        deserialize_u64 => { "type": "integer", "minimum": 0 },
        deserialize_f32 => { "type": "number" },
        deserialize_f64 => { "type": "number" },
        deserialize_unit => { "type": "null" },
    }

    /// Passes an unknown word to the type. Types that read words list all valid ones in their error.
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Found> {
        match visitor.visit_str::<Found>("\u{1}") {
            Err(found) => Err(found),
            Ok(_) => Err(Found::value(json!({ "type": "string" }))),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Found> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Found> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Found> {
        self.list(None, visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, n: usize, visitor: V) -> Result<V::Value, Found> {
        self.list(Some(n), visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        n: usize,
        visitor: V,
    ) -> Result<V::Value, Found> {
        self.list(Some(n), visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        names: Words,
        visitor: V,
    ) -> Result<V::Value, Found> {
        self.fields(names, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        names: Words,
        visitor: V,
    ) -> Result<V::Value, Found> {
        match self.fork() {
            None => Err(Found::new(Asked::Variants(names))),
            Some((index, rest)) => visitor.visit_enum(Named {
                name: names[index],
                rest,
            }),
        }
    }

    forward_to_deserialize_any! {
        char str string bytes byte_buf unit_struct map identifier ignored_any
    }
}

impl<'de> SeqAccess<'de> for Probe<'_> {
    type Error = Found;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Found> {
        seed.deserialize(*self).map(Some)
    }
}

/// A field or variant with its name, and the probe for its content.
struct Named<'a> {
    name: &'static str,
    rest: Probe<'a>,
}

impl<'de> MapAccess<'de> for Named<'_> {
    type Error = Found;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Found> {
        let name: StrDeserializer<'_, Found> = self.name.into_deserializer();
        seed.deserialize(name).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Found> {
        seed.deserialize(self.rest)
    }
}

impl<'de, 'a> EnumAccess<'de> for Named<'a> {
    type Error = Found;
    type Variant = Probe<'a>;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Probe<'a>), Found> {
        let name: StrDeserializer<'_, Found> = self.name.into_deserializer();
        Ok((seed.deserialize(name)?, self.rest))
    }
}

impl<'de> VariantAccess<'de> for Probe<'_> {
    type Error = Found;

    fn unit_variant(self) -> Result<(), Found> {
        Err(Found::new(Asked::Word))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Found> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, n: usize, visitor: V) -> Result<V::Value, Found> {
        self.list(Some(n), visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, names: Words, visitor: V) -> Result<V::Value, Found> {
        self.fields(names, visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::explore;
    use dapple_tile::{Feather, MatchBorders};
    use dapple_worley::{Metric, Scatter};
    use serde_json::{Value, json};

    fn traced<T: serde::de::DeserializeOwned>() -> Value {
        explore::<T>(&mut Vec::new()).expect("no word alone")
    }

    #[test]
    fn words_tables_and_numbers_of_a_type_are_found() {
        let number = json!({ "type": "number" });
        let table = |name: &str, inner: &Value| {
            json!({
                "type": "object", "properties": { name: inner },
                "additionalProperties": false, "required": [name],
            })
        };
        let words = json!({ "type": "string", "enum": Metric::NAMED.map(|(name, _)| name) });
        let expected = json!({ "oneOf": [words, table("minkowski", &number)] });
        assert_eq!(traced::<Metric>(), expected);
        let jitter = traced::<Scatter>()["oneOf"][2]["properties"]["jittered"].clone();
        assert_eq!(jitter["properties"]["jitter"], number);
        let source = &traced::<MatchBorders>()["properties"]["source"];
        assert_eq!(source["enum"], json!(["border", "middle"]));
        let lists = traced::<Vec<Option<[Feather; 2]>>>();
        assert_eq!(lists["items"]["minItems"], json!(2));
        assert!(lists["items"]["items"]["oneOf"].is_array(), "{lists}");
    }
}
