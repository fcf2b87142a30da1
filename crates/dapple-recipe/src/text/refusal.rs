//! Errors from deserializing a recipe from parsed data, and their positions in the text.

use crate::Place;
use core::fmt;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor,
};
use toml::de::{DeTable, DeValue};

/// The error of a value or key, with its path from the root of the document.
#[derive(Debug)]
pub(super) struct Refusal {
    pub(super) message: String,
    /// The path, innermost part first.
    parts: Vec<Part>,
    /// Whether the error is about the path's last key instead of its value.
    is_key: bool,
}

/// A part of a path: a key of a table or an index of a list.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Part {
    Key(String),
    Index(usize),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl core::error::Error for Refusal {}

impl Error for Refusal {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self {
            message: message.to_string(),
            parts: Vec::new(),
            is_key: false,
        }
    }
}

impl Refusal {
    /// Prepends a part to the path, as the error passes to the enclosing value.
    pub(super) fn inside(mut self, part: Part) -> Self {
        self.parts.push(part);
        self
    }

    /// Returns the path of the erroneous value, outermost part first.
    pub(super) fn path(&self) -> Vec<Part> {
        self.parts.iter().rev().cloned().collect()
    }

    /// Marks the error as being about `key` instead of its value, and prepends the key to the path.
    pub(super) fn of_key(mut self, key: &str) -> Self {
        self.is_key = true;
        self.inside(Part::Key(key.to_owned()))
    }

    /// Returns the byte offset of the erroneous key or value in TOML text.
    pub(super) fn byte_in_toml(&self, text: &str) -> Option<usize> {
        let table = DeTable::parse(text).ok()?;
        let mut span = table.span();
        let mut value = &DeValue::Table(table.into_inner());
        for (index, part) in self.parts.iter().enumerate().rev() {
            let inner = match (part, value) {
                (Part::Key(name), DeValue::Table(table)) => {
                    let mut entries = table.iter();
                    let (key, inner) = entries.find(|(key, _)| key.get_ref() == name)?;
                    if index == 0 && self.is_key {
                        return Some(key.span().start);
                    }
                    inner
                }
                (Part::Index(index), DeValue::Array(list)) => list.get(*index)?,
                _ => return None,
            };
            span = inner.span();
            value = inner.get_ref();
        }
        Some(span.start)
    }

    /// Returns the position in JSON text just after the erroneous key or value.
    pub(super) fn place_in_json(&self, text: &str) -> Option<Place> {
        // Parse again up to the erroneous value. The error that ends this pass has the position.
        let mut reader = serde_json::Deserializer::from_str(text);
        let walk = Walk {
            parts: &self.parts,
            is_key: self.is_key,
        };
        let end = walk.deserialize(&mut reader).err()?;
        (end.line() > 0).then(|| Place {
            line: end.line(),
            column: end.column(),
        })
    }
}

/// A deserializer that follows a path through JSON, and returns an error at its end, to get the position.
#[derive(Clone, Copy)]
struct Walk<'a> {
    parts: &'a [Part],
    is_key: bool,
}

impl Walk<'_> {
    /// Returns the walk with the rest of the path if the first part of the path leads to the current value; otherwise
    /// `None`.
    fn step(self, leads_there: impl FnOnce(&Part) -> bool) -> Option<Self> {
        let (next, parts) = self.parts.split_last()?;
        leads_there(next).then_some(Self { parts, ..self })
    }
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if !self.parts.is_empty() {
            return deserializer.deserialize_any(self);
        }
        IgnoredAny::deserialize(deserializer)?;
        Err(D::Error::custom("here"))
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list or a table")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<(), A::Error> {
        for index in 0.. {
            let inner = self.step(|part| matches!(part, Part::Index(wanted) if *wanted == index));
            let is_there = match inner {
                Some(walk) => values.next_element_seed(walk)?.is_some(),
                None => values.next_element::<IgnoredAny>()?.is_some(),
            };
            if !is_there {
                break;
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<(), A::Error> {
        while let Some(key) = entries.next_key::<String>()? {
            let inner = self.step(|part| matches!(part, Part::Key(wanted) if *wanted == key));
            match inner {
                Some(walk) if walk.parts.is_empty() && walk.is_key => {
                    return Err(A::Error::custom("here"));
                }
                Some(walk) => entries.next_value_seed(walk)?,
                None => {
                    entries.next_value::<IgnoredAny>()?;
                }
            }
        }
        Ok(())
    }
}
