//! A recipe as the text that it is written in.

use crate::data::json_of_table;
use crate::diagnose::{Diagnostic, of_error, of_text};
use crate::utf16::Positions;
use core::ops::Range;
use dapple::recipe::{Recipe, RecipeError};
use serde_json::Value as Json;
use toml_edit::{Item, Table};

/// A recipe as text, with the recipe that is read in it or the error of reading it.
#[derive(Clone, Debug)]
pub struct Document {
    text: String,
    positions: Positions,
    toml: Option<toml_edit::Document<String>>,
    recipe: Result<Recipe, RecipeError>,
}

impl Document {
    /// The document of a text, whatever the text is.
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

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The recipe, or why there is none.
    ///
    /// # Errors
    ///
    /// The refusal of the reader of recipes.
    pub fn recipe(&self) -> Result<&Recipe, &RecipeError> {
        self.recipe.as_ref()
    }

    /// The data of the text as it is written, if it is TOML at all.
    #[must_use]
    pub fn data(&self) -> Option<Json> {
        self.table().map(json_of_table)
    }

    /// The mistakes of the text; none where it is a recipe.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        self.recipe()
            .err()
            .map(|error| of_text(self, error))
            .into_iter()
            .collect()
    }

    /// The mistake that an error of a plan or a bake speaks of, with its place in the text.
    #[must_use]
    pub fn diagnostic(&self, error: &RecipeError) -> Diagnostic {
        of_error(self, error)
    }

    /// Where a node is written, from its first header or key to its last value, in UTF-16 code units.
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

/// Makes a range wide enough for an item and all that is in it.
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
