//! Reads and writes recipes as TOML and JSON. Errors have the line and the nearest valid word.

use crate::{Node, Place, PupsNode, Recipe, RecipeError, RecipeErrorKind, SCHEMA};
use content::Content;
use dapple_raster::text::decode;
use erased_serde::Serialize;
use parameters::Fault;
use refusal::Part;
use serde::Deserialize as _;
use serde_json::Value;

mod content;
mod parameters;
mod refusal;
mod set;

#[cfg(feature = "schema")]
pub(crate) use parameters::ALIASES;
pub use parameters::{Parameter, Parameters};

/// Maximum size of the text of a recipe, in bytes: 4 MiB.
pub const MAX_TEXT: usize = 1 << 22;

impl Recipe {
    /// Reads a recipe from TOML text.
    ///
    /// Named [parameters](Self::parameters) are replaced by their values before nodes are read.
    ///
    /// The names and inputs of nodes are checked later, by [`Plan::new`](crate::Plan::new).
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if the text is not valid TOML, or contains a key or value that recipes do not
    /// have, with the line and the nearest valid word; [`Schema`](RecipeErrorKind::Schema) if the schema version
    /// differs from [`SCHEMA`]; [`Count`](RecipeErrorKind::Count) if the text has more than [`MAX_TEXT`]
    /// bytes; [`UnknownParameter`](RecipeErrorKind::UnknownParameter),
    /// [`UnusedParameter`](RecipeErrorKind::UnusedParameter) or [`Parameter`](RecipeErrorKind::Parameter) if an option
    /// refers to a parameter that there is not, a parameter is not used, or its value does not fit an option.
    pub fn from_toml(text: &str) -> Result<Self, RecipeError> {
        let text = decoded(text)?;
        let content: Content = toml::from_str(text).map_err(|error| {
            let byte = error.span().map(|span| span.start);
            text_error(error.message()).at(byte.map(|byte| place_of(text, byte)))
        })?;
        Self::from_content(content, false).map_err(|Fault { error, refusal }| {
            let byte = refusal.byte_in_toml(text);
            error.at(byte.map(|byte| place_of(text, byte)))
        })
    }

    /// Reads a recipe from JSON text.
    ///
    /// # Errors
    ///
    /// Same as [`from_toml`](Self::from_toml).
    pub fn from_json(text: &str) -> Result<Self, RecipeError> {
        let text = decoded(text)?;
        let content: Content = serde_json::from_str(text).map_err(|error| {
            let (line, column) = (error.line(), error.column());
            let full = error.to_string();
            // Remove the position from the message of the parser, since the error has it separately.
            let message = full.split(" at line ").next().unwrap_or(&full);
            text_error(message).at((line > 0).then_some(Place { line, column }))
        })?;
        Self::from_content(content, false)
            .map_err(|Fault { error, refusal }| error.at(refusal.place_in_json(text)))
    }

    /// Creates a recipe from parsed text. Unused parameters are dropped if `drops_unused`; otherwise, they are an
    /// error.
    fn from_content(mut content: Content, drops_unused: bool) -> Result<Self, Fault> {
        check_version(&content)
            .map_err(|error| Fault::of(error, &[Part::Key("dapple".to_owned())]))?;
        let mut parameters = Parameters::substitute(&mut content)?;
        if drops_unused {
            parameters.drop_unused();
        }
        parameters.check_used()?;
        let mut recipe = Self::deserialize(&content).map_err(|refusal| {
            let error = text_error(&refusal.message);
            parameters.blame(refusal, error)
        })?;
        if !parameters.is_empty() {
            let written = recipe
                .without_parameters()
                .map_err(|error| Fault::of(error, &[]))?;
            parameters.record(&written);
        }
        recipe.parameters = parameters;
        Ok(recipe)
    }

    /// Serializes the recipe, with references to parameters replaced by values.
    fn without_parameters(&self) -> Result<Content, RecipeError> {
        let text = serde_json::to_string(data(self));
        let content = text.and_then(|text| serde_json::from_str(&text));
        content.map_err(|error| text_error(&error.to_string()))
    }

    /// Serializes the recipe, with its parameters.
    fn to_content(&self) -> Result<Content, RecipeError> {
        let mut content = self.without_parameters()?;
        self.parameters.restore(&mut content);
        Ok(content)
    }

    /// Writes the recipe as TOML.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if it contains a value that cannot be written as data, such as a function.
    pub fn to_toml(&self) -> Result<String, RecipeError> {
        let text = match self.parameters.is_empty() {
            true => toml::to_string_pretty(data(self)),
            false => toml::to_string_pretty(&self.to_content()?),
        };
        text.map_err(|error| text_error(&error.to_string()))
    }

    /// Writes the recipe as JSON.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if it contains a value that cannot be written as data, such as a function.
    pub fn to_json(&self) -> Result<String, RecipeError> {
        let text = match self.parameters.is_empty() {
            true => serde_json::to_string_pretty(data(self)),
            false => serde_json::to_string_pretty(&self.to_content()?),
        };
        text.map_err(|error| text_error(&error.to_string()))
    }
}

/// Erases the type of a value for serialization, so that the serializers of the many types of recipes are compiled once
/// and not once per format.
fn data(value: &impl Serialize) -> &dyn Serialize {
    value
}

/// Returns whether a node can be serialized. Nodes with functions cannot.
pub(crate) fn is_data(node: &Node) -> bool {
    serde_json::to_string_pretty(data(node)).is_ok()
}

/// Returns the text without its byte order mark. Fails if the text has more than [`MAX_TEXT`] bytes.
fn decoded(text: &str) -> Result<&str, RecipeError> {
    if text.len() > MAX_TEXT {
        return Err(RecipeError::new(RecipeErrorKind::Count {
            what: "bytes",
            count: text.len(),
            needed: "at most 4 MiB",
        }));
    }
    decode(text.as_bytes()).map_err(|error| text_error(&error.to_string()))
}

impl PupsNode {
    /// Converts the texture to a JSON value.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if it contains a value that cannot be written as data, such as a function.
    pub fn to_json(&self) -> Result<Value, RecipeError> {
        serde_json::to_value(data(self)).map_err(|error| text_error(&error.to_string()))
    }

    /// Converts a JSON value to a texture.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if there are keys or values that no texture has.
    pub fn from_json(value: &Value) -> Result<Self, RecipeError> {
        let content =
            Content::deserialize(value).map_err(|error| text_error(&error.to_string()))?;
        Self::deserialize(&content).map_err(|refusal| text_error(&refusal.message))
    }
}

/// Reads options from a JSON value, in the form in which recipes write them.
///
/// # Errors
///
/// [`Text`](RecipeErrorKind::Text) if there are keys or values that the options do not have. The error has the nearest
/// valid word.
///
/// # Examples
///
/// ```
/// use dapple_recipe::read_options;
/// use dapple_worley::Scatter;
/// use serde_json::json;
///
/// let scatter: Scatter = read_options(&json!({ "poisson": { "density": 2 } }))?;
/// assert!(matches!(scatter, Scatter::Poisson { .. }));
/// let error = read_options::<Scatter>(&json!({ "poison": { "density": 2 } })).unwrap_err();
/// assert_eq!(error.nearest(), Some("poisson"));
/// # Ok::<(), dapple_recipe::RecipeError>(())
/// ```
pub fn read_options<T: serde::de::DeserializeOwned>(value: &Value) -> Result<T, RecipeError> {
    let content = Content::deserialize(value).map_err(|error| text_error(&error.to_string()))?;
    T::deserialize(&content).map_err(|refusal| text_error(&refusal.message))
}

/// Returns an error if the recipe's schema version is not [`SCHEMA`]. This check comes first, because a wrong version
/// causes other errors.
fn check_version(content: &Content) -> Result<(), RecipeError> {
    let version = match content.get("dapple") {
        Some(Content::Signed(version)) => u32::try_from(*version),
        Some(Content::Unsigned(version)) => u32::try_from(*version),
        _ => return Ok(()),
    };
    match version {
        Ok(version) if version != SCHEMA => {
            Err(RecipeError::new(RecipeErrorKind::Schema { version }))
        }
        _ => Ok(()),
    }
}

/// Converts a parser's message to an error, with the nearest of the words that the parser expected.
fn text_error(message: &str) -> RecipeError {
    let message = plain(&message.lines().collect::<Vec<_>>().join(" "));
    let error = RecipeError::new(RecipeErrorKind::Text {
        message: message.clone(),
    });
    // Parsers write ``unknown field `densty`, expected one of `density`, `seed` ``.
    let mut words = message.split('`').skip(1).step_by(2);
    match words.next() {
        Some(written) if message.starts_with("unknown ") => error.meant(written, words),
        _ => error,
    }
}

/// Rewrites a parser's message with the words of TOML and JSON, without the names of Rust types and of serde.
fn plain(message: &str) -> String {
    if let Some(name) = message.strip_prefix("missing field ") {
        return format!("{name} is missing");
    }
    let Some((found, expected)) = message.rsplit_once(", expected ") else {
        return message.to_owned();
    };
    let wrong = ["invalid type: ", "invalid value: "].map(|prefix| found.strip_prefix(prefix));
    let found = match wrong.into_iter().flatten().next() {
        Some("map") => "found a table".to_owned(),
        Some("sequence") => "found a list".to_owned(),
        Some("unit value" | "null" | "Option value") => "found nothing".to_owned(),
        Some(other) => {
            let (kind, value) = other.split_once(' ').unwrap_or((other, ""));
            match kind {
                "integer" => format!("found the number {value}"),
                "string" => format!("found the text {value}"),
                "boolean" => format!("found {value}"),
                "floating" => format!("found the number {}", value.trim_start_matches("point ")),
                _ => format!("found {other}"),
            }
        }
        None => found.to_owned(),
    };
    let expected = match expected.split(' ').next() {
        Some("struct" | "map") => "a table",
        Some("enum" | "internally" | "adjacently") => "a word or a table",
        Some("tuple") => "a list",
        Some("f32" | "f64") => "a number",
        Some("u8" | "u16" | "u32" | "u64" | "usize") => "a whole number that is not negative",
        Some("i8" | "i16" | "i32" | "i64" | "isize") => "a whole number",
        _ => expected,
    };
    format!("{found}, expected {expected}")
}

/// Converts a byte offset to a line and a column.
fn place_of(text: &str, byte: usize) -> Place {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Place {
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
    }
}
