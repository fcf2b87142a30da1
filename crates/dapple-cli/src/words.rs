//! Parses words on the command line. They are case-insensitive, and `-` and `_` are equivalent.

use clap::builder::{PossibleValue, PossibleValuesParser, Str, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};
use dapple::raster::Named;
use dapple::recipe::similar_words;
use std::ffi::OsStr;

/// Normalizes a word to the spelling of map and field names, in lower case with `_`.
pub(crate) fn with_underscores(word: &str) -> String {
    word.trim().to_lowercase().replace('-', "_")
}

/// Normalizes a word to the spelling of option and recipe names, in lower case with `-`.
pub(crate) fn with_dashes(word: &str) -> String {
    word.trim().to_lowercase().replace('_', "-")
}

/// Returns the error message for an unknown word of the given kind. It suggests the most similar name, or else lists
/// all names, followed by `more`.
pub(crate) fn unknown(kind: &str, word: &str, names: &[&str], more: &str) -> String {
    slip(kind, word, names.iter().copied()).unwrap_or_else(|| {
        format!(
            "unknown {kind} {word:?}: there are {}{more}",
            names.join(", ")
        )
    })
}

/// Returns the error message for a misspelled name, with a suggestion; `None` if no name is similar to the word.
pub(crate) fn slip<'a>(
    kind: &str,
    word: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let written = with_underscores(word);
    let near = similar_words(&written, names).into_iter().next()?;
    (near != written).then(|| format!("unknown {kind} {word:?}: did you mean {near}?"))
}

/// A clap parser of values by their names. The help of the option lists the names.
#[derive(Clone, Debug)]
pub(crate) struct NamedValueParser<T>(Vec<(PossibleValue, T)>);

impl<T: Named> NamedValueParser<T> {
    /// Creates a parser of all values of a type. The help of each value is the first sentence of its documentation.
    pub(crate) fn all() -> Self {
        Self::some(T::ALL)
    }

    /// Creates a parser of some values of a type.
    pub(crate) fn some(values: &[T]) -> Self {
        let named = |&value: &T| {
            let aliases = value.aliases().iter().map(|alias| with_dashes(alias));
            let name = PossibleValue::new(with_dashes(value.name())).aliases(aliases);
            match first_sentence(value.documentation()) {
                help if help.is_empty() => (name, value),
                help => (name.help(help), value),
            }
        };
        Self(values.iter().map(named).collect())
    }

    /// Returns a parser that converts the parsed values with `change`.
    pub(crate) fn map<U>(self, change: fn(T) -> U) -> NamedValueParser<U> {
        let changed = |(name, value)| (name, change(value));
        NamedValueParser(self.0.into_iter().map(changed).collect())
    }
}

impl<T> NamedValueParser<T> {
    /// Creates a parser of `values`, which are pairs of a name and a value without help text.
    pub(crate) fn of(values: impl IntoIterator<Item = (impl Into<Str>, T)>) -> Self {
        let values = values.into_iter();
        Self(
            values
                .map(|(name, value)| (PossibleValue::new(name), value))
                .collect(),
        )
    }

    /// Creates a parser without values. [`or`](Self::or) adds values to it.
    pub(crate) fn none() -> Self {
        Self(Vec::new())
    }

    /// Adds one more value.
    pub(crate) fn or(mut self, name: &'static str, help: &'static str, value: T) -> Self {
        self.0.push((PossibleValue::new(name).help(help), value));
        self
    }
}

impl<T: Clone + Send + Sync + 'static> TypedValueParser for NamedValueParser<T> {
    type Value = T;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, text: &OsStr) -> Result<T, Error> {
        let word = with_dashes(&text.to_string_lossy());
        if let Some((_, value)) = self.0.iter().find(|(name, _)| name.matches(&word, true)) {
            return Ok(value.clone());
        }
        let names = self.0.iter().map(|(name, _)| name.clone());
        let refused = PossibleValuesParser::new(names).parse_ref(command, arg, text);
        Err(refused
            .err()
            .unwrap_or_else(|| Error::new(ErrorKind::InvalidValue)))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.0.iter().map(|(name, _)| name.clone())))
    }
}

/// Returns the first sentence of a documentation text in Markdown, without backticks and without its period.
pub(crate) fn first_sentence(documentation: &str) -> String {
    let words: Vec<_> = documentation.split_whitespace().collect();
    let text = words.join(" ");
    let sentence = text
        .split_once(". ")
        .map_or(text.as_str(), |(first, _)| first);
    sentence.trim_end_matches('.').replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::{first_sentence, unknown};

    #[test]
    fn an_unknown_word_is_answered_with_the_nearest_or_with_all() {
        let names = ["height", "normal"];
        let message = |word: &str| unknown("map", word, &names, ", or all");
        assert_eq!(
            message("Hight"),
            "unknown map \"Hight\": did you mean height?"
        );
        assert_eq!(
            message("xyz"),
            "unknown map \"xyz\": there are height, normal, or all"
        );
    }

    #[test]
    fn the_help_of_a_value_is_one_sentence() {
        let help = first_sentence(" The mean, over\n `n` pixels. It is slow.\n");
        assert_eq!(help, "The mean, over n pixels");
        assert_eq!(first_sentence(" Tents.\n"), "Tents");
    }
}
