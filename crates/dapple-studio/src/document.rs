//! A recipe together with its TOML text.

use crate::data::json_of_table;
use crate::diagnose::{Diagnostic, of_error, of_text};
use crate::utf16::Positions;
use core::ops::Range;
use dapple::recipe::{Recipe, RecipeError};
use serde_json::Value as Json;
use toml_edit::{Item, Table};

/// The text of a recipe, with the parsed recipe or the parse error.
#[derive(Clone, Debug)]
pub struct Document {
    text: String,
    positions: Positions,
    toml: Option<toml_edit::Document<String>>,
    recipe: Result<Recipe, RecipeError>,
}

impl Document {
    /// Creates a document from a text, which need not be a valid recipe.
    pub fn new(text: impl Into<String>) -> Self {
        let text = text.into();
        let toml = if text.len() > dapple::recipe::MAX_TEXT {
            None
        } else {
            toml_edit::Document::parse(text.clone()).ok()
        };
        Self {
            positions: Positions::new(&text),
            toml,
            recipe: Recipe::from_toml(&text),
            text,
        }
    }

    /// Returns the text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the parsed recipe.
    ///
    /// # Errors
    ///
    /// If the text is not a valid recipe.
    pub fn recipe(&self) -> Result<&Recipe, &RecipeError> {
        self.recipe.as_ref()
    }

    /// Returns the data of the text as written, if the text is valid TOML.
    #[must_use]
    pub fn data(&self) -> Option<Json> {
        self.table().map(json_of_table)
    }

    /// Returns the keys of a table of the text, such as `nodes`, in the order of the text.
    #[must_use]
    pub fn keys(&self, table: &str) -> Vec<String> {
        let table = self.table().and_then(|root| root.get(table));
        let entries = table
            .and_then(Item::as_table_like)
            .map(|table| table.iter());
        let keys = entries.into_iter().flatten();
        keys.map(|(key, _)| key.to_owned()).collect()
    }

    /// Returns the errors in the text. The list is empty if the text is a valid recipe.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        self.recipe()
            .err()
            .map(|error| of_text(self, error))
            .into_iter()
            .collect()
    }

    /// Converts an error of a plan or a bake to a diagnostic with its position in the text.
    #[must_use]
    pub fn diagnostic(&self, error: &RecipeError) -> Diagnostic {
        of_error(self, error)
    }

    /// Returns the range of a node in the text, in UTF-16 code units. It extends from the first line of the node's
    /// header or key to its last value.
    #[must_use]
    pub fn node_span(&self, name: &str) -> Option<[usize; 2]> {
        let (key, item) = self
            .table()?
            .get("nodes")?
            .as_table_like()?
            .get_key_value(name)?;
        let mut span = key.span()?;
        widen(&mut span, item);
        let line = self.text[..span.start].rfind('\n').map_or(0, |end| end + 1);
        Some(self.span(line..span.end))
    }

    pub(crate) fn table(&self) -> Option<&Table> {
        self.toml.as_ref().map(toml_edit::Document::as_table)
    }

    pub(crate) fn span(&self, bytes: Range<usize>) -> [usize; 2] {
        self.positions.span(&self.text, bytes)
    }
}

/// Extends a byte range to include an item and everything in it.
pub(crate) fn widen(span: &mut Range<usize>, item: &Item) {
    let mut include = |other: Option<Range<usize>>| {
        if let Some(other) = other {
            *span = span.start.min(other.start)..span.end.max(other.end);
        }
    };
    match item {
        Item::Value(value) => include(value.span()),
        Item::Table(table) => {
            for (key, inner) in table {
                if let Some((key, _)) = table.get_key_value(key) {
                    let key = key.span();
                    if let Some(other) = key {
                        *span = span.start.min(other.start)..span.end.max(other.end);
                    }
                }
                widen(span, inner);
            }
        }
        Item::ArrayOfTables(tables) => {
            for table in tables {
                widen(span, &Item::Table(table.clone()));
            }
        }
        Item::None => {}
    }
}
