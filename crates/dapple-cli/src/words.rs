//! Words on the command line, which are read without regard to case, and with `-` or `_`.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};
use dapple::recipe::similar_words;
use serde::de::value::Error as WordError;
use serde::de::{DeserializeOwned, IntoDeserializer};
use std::ffi::OsStr;
use std::marker::PhantomData;

/// A word as the names of maps and of fields are written: in small letters, with `_`.
pub(crate) fn with_underscores(word: &str) -> String {
    word.trim().to_lowercase().replace('-', "_")
}

/// A word as options and recipes are written: in small letters, with `-`.
pub(crate) fn with_dashes(word: &str) -> String {
    word.trim().to_lowercase().replace('_', "-")
}

/// The error message for a word that is none of a kind, with the one that was perhaps meant, or all of them and `more`.
pub(crate) fn unknown(kind: &str, word: &str, names: &[&str], more: &str) -> String {
    slip(kind, word, names.iter().copied()).unwrap_or_else(|| {
        format!(
            "{word:?} is no {kind}; there are {}{more}",
            names.join(", ")
        )
    })
}

/// The error message for a word that is a slip of a name, if it is one.
pub(crate) fn slip<'a>(
    kind: &str,
    word: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let written = with_underscores(word);
    let near = similar_words(&written, names).into_iter().next()?;
    (near != written).then(|| format!("{word:?} is no {kind}; did you mean {near}?"))
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
    use super::unknown;

    #[test]
    fn an_unknown_word_is_answered_with_the_nearest_or_with_all() {
        let names = ["height", "normal"];
        let message = |word: &str| unknown("map", word, &names, ", or all");
        assert_eq!(
            message("Hight"),
            "\"Hight\" is no map; did you mean height?"
        );
        assert_eq!(
            message("xyz"),
            "\"xyz\" is no map; there are height, normal, or all"
        );
    }
}
