//! Words on the command line, which are read without regard to case, and with `-` or `_`.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};
use serde::de::value::Error as WordError;
use serde::de::{DeserializeOwned, IntoDeserializer};
use std::ffi::OsStr;
use std::marker::PhantomData;

/// How alike two words are, from 0 to 1, for one to be a slip of the other.
const ALIKE: f64 = 0.6;

/// A word as the names of maps and of fields are written: in small letters, with `_`.
pub(crate) fn with_underscores(word: &str) -> String {
    word.trim().to_lowercase().replace('-', "_")
}

/// A word as options and recipes are written: in small letters, with `-`.
pub(crate) fn with_dashes(word: &str) -> String {
    word.trim().to_lowercase().replace('_', "-")
}

/// The word that was perhaps meant.
pub(crate) fn nearest<'a>(word: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let alike = |other: &str| strsim::normalized_damerau_levenshtein(word, other);
    let near = valid.into_iter().map(|other| (alike(other), other));
    let near = near.filter(|&(alike, _)| alike >= ALIKE);
    near.max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, other)| other)
}

/// Reads a value of a library by the name that it has in recipes.
#[derive(Clone, Debug)]
pub(crate) struct Word<T> {
    names: &'static [&'static str],
    of: PhantomData<fn() -> T>,
}

impl<T> Word<T> {
    /// Of these values, with `-` where recipes have `_`.
    pub(crate) fn of(names: &'static [&'static str]) -> Self {
        Self {
            names,
            of: PhantomData,
        }
    }
}

impl<T: DeserializeOwned + Clone + Send + Sync + 'static> TypedValueParser for Word<T> {
    type Value = T;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, text: &OsStr) -> Result<T, Error> {
        let word = with_dashes(&text.to_string_lossy());
        // What is none of the names is refused as it was written.
        let text = match self.names.contains(&word.as_str()) {
            true => OsStr::new(&word),
            false => text,
        };
        let names = PossibleValuesParser::new(self.names);
        let name = names.parse_ref(command, arg, text)?;
        let name = with_underscores(&name);
        let value = T::deserialize(IntoDeserializer::<WordError>::into_deserializer(
            name.as_str(),
        ));
        value.map_err(|error| Error::raw(ErrorKind::InvalidValue, error).with_cmd(command))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names.iter().map(PossibleValue::new)))
    }
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_nearest_word_is_that_of_a_slip_and_no_other() {
        let words = ["weight", "height", "normal"];
        for (typed, expected) in [
            ("weigth", Some("weight")),
            ("hight", Some("height")),
            ("normals", Some("normal")),
            ("roughness", None),
        ] {
            assert_eq!(nearest(typed, words), expected, "{typed}");
        }
    }
}
