//! Parsed TOML or JSON text.
//!
//! Recipes are deserialized from it, so that the deserializers of their many types are compiled once and not once per
//! format.

use super::refusal::{Part, Refusal};
use core::fmt;
use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use serde::ser::{Serialize, Serializer};
use std::collections::BTreeSet;

/// A parsed value. The keys of a table are unique.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Content {
    Null,
    Flag(bool),
    Signed(i64),
    Unsigned(u64),
    Number(f64),
    Text(String),
    List(Vec<Self>),
    Table(Vec<(String, Self)>),
}

impl<'de> Deserialize<'de> for Content {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ContentVisitor)
    }
}

/// Writes the value, without the empty entries of tables, which TOML does not have.
impl Serialize for Content {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Null => serializer.serialize_unit(),
            Self::Flag(flag) => serializer.serialize_bool(*flag),
            Self::Signed(number) => serializer.serialize_i64(*number),
            Self::Unsigned(number) => serializer.serialize_u64(*number),
            Self::Number(number) => serializer.serialize_f64(*number),
            Self::Text(text) => serializer.serialize_str(text),
            Self::List(list) => serializer.collect_seq(list),
            Self::Table(table) => {
                let entries = table.iter().filter(|(_, value)| *value != Self::Null);
                serializer.collect_map(entries.map(|(key, value)| (key, value)))
            }
        }
    }
}

struct ContentVisitor;

impl<'de> Visitor<'de> for ContentVisitor {
    type Value = Content;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Content, E> {
        Ok(Content::Null)
    }

    fn visit_bool<E>(self, flag: bool) -> Result<Content, E> {
        Ok(Content::Flag(flag))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Content, E> {
        Ok(Content::Signed(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Content, E> {
        Ok(Content::Unsigned(number))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Content, E> {
        Ok(Content::Number(number))
    }

    fn visit_str<E>(self, text: &str) -> Result<Content, E> {
        Ok(Content::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Content, A::Error> {
        let mut list = Vec::new();
        while let Some(value) = values.next_element()? {
            list.push(value);
        }
        Ok(Content::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Content, A::Error> {
        let (mut table, mut keys) = (Vec::new(), BTreeSet::new());
        while let Some(key) = entries.next_key::<String>()? {
            if !keys.insert(key.clone()) {
                let message = format_args!("the key `{key}` is there twice");
                return Err(A::Error::custom(message));
            }
            table.push((key, entries.next_value()?));
        }
        Ok(Content::Table(table))
    }
}

impl Content {
    /// Returns the value of a key; `None` if the value is not a table or lacks the key.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        let Self::Table(table) = self else {
            return None;
        };
        let (_, value) = table.iter().find(|(known, _)| known == key)?;
        Some(value)
    }

    /// Returns the value as a number, if it is one.
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Signed(number) => Some(*number as f64),
            Self::Unsigned(number) => Some(*number as f64),
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// Returns the value at a path; `None` if a key or an index of the path is missing.
    pub(super) fn at(&self, path: &[Part]) -> Option<&Self> {
        path.iter()
            .try_fold(self, |value, part| match (value, part) {
                (value, Part::Key(key)) => value.get(key),
                (Self::List(list), Part::Index(index)) => list.get(*index),
                _ => None,
            })
    }

    /// Replaces the value at a path. If the last key of the path is missing, it is added; if any other part is missing,
    /// nothing changes.
    pub(super) fn put(&mut self, path: &[Part], new: Self) {
        match (self, path) {
            (value, []) => *value = new,
            (Self::Table(table), [Part::Key(key), rest @ ..]) => {
                match table.iter_mut().find(|(known, _)| known == key) {
                    Some((_, value)) => value.put(rest, new),
                    None if rest.is_empty() => table.push((key.clone(), new)),
                    None => {}
                }
            }
            (Self::List(list), [Part::Index(index), rest @ ..]) => {
                if let Some(value) = list.get_mut(*index) {
                    value.put(rest, new);
                }
            }
            _ => {}
        }
    }

    /// Returns the value as serde names it in errors.
    fn unexpected(&self) -> Unexpected<'_> {
        match self {
            Self::Null => Unexpected::Unit,
            Self::Flag(flag) => Unexpected::Bool(*flag),
            Self::Signed(number) => Unexpected::Signed(*number),
            Self::Unsigned(number) => Unexpected::Unsigned(*number),
            Self::Number(number) => Unexpected::Float(*number),
            Self::Text(text) => Unexpected::Str(text),
            Self::List(_) => Unexpected::Seq,
            Self::Table(_) => Unexpected::Map,
        }
    }
}

impl<'de> Deserializer<'de> for &'de Content {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self {
            Content::Null => visitor.visit_unit(),
            Content::Flag(flag) => visitor.visit_bool(*flag),
            Content::Signed(number) => visitor.visit_i64(*number),
            Content::Unsigned(number) => visitor.visit_u64(*number),
            Content::Number(number) => visitor.visit_f64(*number),
            Content::Text(text) => visitor.visit_borrowed_str(text),
            Content::List(list) => {
                let mut elements = Elements { list, next: 0 };
                let value = visitor.visit_seq(&mut elements)?;
                match elements.next {
                    count if count < list.len() => Err(Refusal::custom(format_args!(
                        "found a list of {} values, expected {count}",
                        list.len()
                    ))),
                    _ => Ok(value),
                }
            }
            Content::Table(table) => visitor.visit_map(Entries { table, next: 0 }),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self {
            Content::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        match self {
            Content::Text(word) => visitor.visit_enum(Word(word)),
            Content::Table(table) => match &table[..] {
                [(name, value)] => visitor.visit_enum(Variant { name, value }),
                _ => Err(Refusal::custom(format_args!(
                    "there are {} entries in the table, but exactly one is needed",
                    table.len()
                ))),
            },
            _ => Err(Refusal::invalid_type(
                self.unexpected(),
                &"a word or a table",
            )),
        }
    }

    /// Deserializes a struct from a table. Lists are refused, so that types need no deserializer for them.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        match self {
            Content::Table(table) => visitor.visit_map(Entries { table, next: 0 }),
            other => Err(Refusal::invalid_type(other.unexpected(), &"a table")),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map identifier ignored_any
    }
}

/// The remaining elements of a list.
struct Elements<'de> {
    list: &'de [Content],
    next: usize,
}

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = Refusal;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Refusal> {
        let index = self.next;
        let Some(value) = self.list.get(index) else {
            return Ok(None);
        };
        self.next += 1;
        let value = seed.deserialize(value);
        value
            .map(Some)
            .map_err(|refusal| refusal.inside(Part::Index(index)))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.list.len() - self.next)
    }
}

/// The remaining entries of a table.
struct Entries<'de> {
    table: &'de [(String, Content)],
    next: usize,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Refusal;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Refusal> {
        let Some((name, _)) = self.table.get(self.next) else {
            return Ok(None);
        };
        let key: StrDeserializer<'_, Refusal> = name.as_str().into_deserializer();
        let key = seed.deserialize(key);
        key.map(Some).map_err(|refusal| refusal.of_key(name))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Refusal> {
        let (name, value) = &self.table[self.next];
        self.next += 1;
        let value = seed.deserialize(value);
        value.map_err(|refusal| refusal.inside(Part::Key(name.clone())))
    }
}

/// A unit variant of an enum, which is written as a word.
struct Word<'de>(&'de str);

impl<'de> EnumAccess<'de> for Word<'de> {
    type Error = Refusal;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Refusal> {
        let word: StrDeserializer<'_, Refusal> = self.0.into_deserializer();
        Ok((seed.deserialize(word)?, self))
    }
}

impl<'de> VariantAccess<'de> for Word<'de> {
    type Error = Refusal;

    fn unit_variant(self) -> Result<(), Refusal> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, _: T) -> Result<T::Value, Refusal> {
        Err(Refusal::custom(format_args!(
            "`{0}` is written with a value: a table with the one key `{0}`",
            self.0
        )))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Refusal> {
        Err(Refusal::custom(format_args!(
            "`{0}` is written with a list: a table with the one key `{0}`",
            self.0
        )))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        names: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Refusal> {
        Err(Refusal::custom(format_args!(
            "`{0}` is written with options: a table with the one key `{0}`, whose value is a table of {1}",
            self.0,
            names.join(", ")
        )))
    }
}

/// A variant of an enum with content, which is written as a table with one entry.
struct Variant<'de> {
    name: &'de str,
    value: &'de Content,
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = Refusal;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Refusal> {
        let name: StrDeserializer<'_, Refusal> = self.name.into_deserializer();
        let variant = seed.deserialize(name);
        let variant = variant.map_err(|refusal| refusal.of_key(self.name))?;
        Ok((variant, self))
    }
}

impl Variant<'_> {
    /// Adds the name of the variant to the path of an error in its content.
    fn refusal(&self, refusal: Refusal) -> Refusal {
        refusal.inside(Part::Key(self.name.to_owned()))
    }
}

impl<'de> VariantAccess<'de> for Variant<'de> {
    type Error = Refusal;

    fn unit_variant(self) -> Result<(), Refusal> {
        match self.value {
            Content::Null => Ok(()),
            Content::Table(table) if table.is_empty() => Ok(()),
            other => {
                let refusal = Refusal::invalid_type(other.unexpected(), &"an empty table");
                Err(self.refusal(refusal))
            }
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Refusal> {
        let value = seed.deserialize(self.value);
        value.map_err(|refusal| self.refusal(refusal))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Refusal> {
        let value = self.value.deserialize_any(visitor);
        value.map_err(|refusal| self.refusal(refusal))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        let value = self.value.deserialize_struct("", names, visitor);
        value.map_err(|refusal| self.refusal(refusal))
    }
}
