//! Converts errors in a recipe to diagnostics with positions in its text.

use crate::Document;
use core::ops::Range;
use dapple::recipe::{Place, RecipeError, RecipeErrorKind};
use serde::Serialize;
use toml_edit::{Item, TableLike, Value};

/// An error in a recipe with its range in the text. Positions are UTF-16 code units.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// Start of the range.
    pub from: usize,
    /// End of the range, exclusive.
    pub to: usize,
    /// The node that contains the error, if any.
    pub node: Option<String>,
    /// The error message.
    pub message: String,
    /// The valid word most similar to the written one, if one is similar enough.
    pub nearest: Option<String>,
    /// How to fix the error, if known.
    pub hint: Option<String>,
}

/// Creates the diagnostic for source text that is not a valid recipe.
pub(crate) fn of_text(document: &Document, error: &RecipeError) -> Diagnostic {
    let text = document.text();
    let bytes = match error.place() {
        Some(place) => {
            let start = byte_of(text, place);
            start..word_end(text, start)
        }
        None => 0..text.find('\n').unwrap_or(text.len()),
    };
    let node = document.table().and_then(|root| {
        let nodes = root.get("nodes")?.as_table_like()?;
        let at = document.span(bytes.clone())[0];
        let mut names = nodes.iter().map(|(name, _)| name);
        names.find(|name| {
            let span = document.node_span(name);
            span.is_some_and(|[from, to]| (from..=to).contains(&at))
        })
    });
    diagnostic(document, bytes, node.map(str::to_owned), error)
}

/// Creates the diagnostic for a valid recipe that a plan or a bake refuses.
pub(crate) fn of_error(document: &Document, error: &RecipeError) -> Diagnostic {
    if error.place().is_some() {
        return of_text(document, error);
    }
    let bytes = place(document, error).unwrap_or(0..0);
    let node = error.node().map(str::to_owned);
    diagnostic(document, bytes, node, error)
}

fn diagnostic(
    document: &Document,
    bytes: Range<usize>,
    node: Option<String>,
    error: &RecipeError,
) -> Diagnostic {
    let [from, to] = document.span(bytes);
    let hint = match error.kind() {
        RecipeErrorKind::NoImage { .. } => Some("images lie in the folder of the recipe"),
        RecipeErrorKind::Global { .. } => Some("it has values in a bake of the whole tile alone"),
        _ => None,
    };
    Diagnostic {
        from,
        to,
        node,
        message: error.kind().to_string(),
        nearest: error.nearest().map(str::to_owned),
        hint: hint.map(str::to_owned),
    }
}

/// Converts a line and a column to a byte offset.
fn byte_of(text: &str, place: Place) -> usize {
    let mut lines = text.split_inclusive('\n');
    let before: usize = lines.by_ref().take(place.line - 1).map(str::len).sum();
    let line = lines.next().unwrap_or_default();
    let column = line.char_indices().nth(place.column.saturating_sub(1));
    before + column.map_or(line.trim_end().len(), |(byte, _)| byte)
}

/// Returns the end of the word, string or array at the byte `start`, as a byte offset. The range has at least one
/// character, except at the end of the text.
fn word_end(text: &str, start: usize) -> usize {
    let rest = &text[start..];
    let Some(first) = rest.chars().next() else {
        return start;
    };
    let line = &rest[..rest.find('\n').unwrap_or(rest.len())];
    let length = match first {
        '"' | '\'' => line[1..].find(first).map_or(line.len(), |end| end + 2),
        _ => line
            .find(|c: char| c.is_whitespace() || ",]}=#".contains(c))
            .unwrap_or(line.len()),
    };
    start + length.max(first.len_utf8())
}

/// Returns the byte range that a plan's error refers to: the value named by the error, or else the name of the node.
fn place(document: &Document, error: &RecipeError) -> Option<Range<usize>> {
    let root = document.table()?;
    let nodes = root.get("nodes").and_then(Item::as_table_like);
    // Find the node of the error, or else the recipe's own entry.
    let node = error.node();
    let of_node = node.and_then(|name| nodes?.get_key_value(name));
    let of_node = of_node.or_else(|| match error.kind() {
        RecipeErrorKind::Cycle { names } => nodes?.get_key_value(names.first()?),
        RecipeErrorKind::Name { name } => nodes?.get_key_value(name),
        _ => None,
    });
    let (key, item) = match of_node {
        Some((key, item)) => (Some(key), item),
        None if node == Some("material") => {
            let (key, item) = root.get_key_value("material")?;
            (Some(key), item)
        }
        None => (None, document_item(root, error)?),
    };
    // Find the value that the error names.
    let found = match error.kind() {
        RecipeErrorKind::UnknownNode { name } | RecipeErrorKind::NoImage { file: name } => {
            text_in(item, name)
        }
        RecipeErrorKind::NotANumber { input } => text_in(item, input.trim_matches('`')),
        RecipeErrorKind::Cycle { names } => names.get(1).and_then(|name| text_in(item, name)),
        RecipeErrorKind::Range { what, range, .. } => {
            // The expression that gives the number is in parentheses: `(extent times frequency)`.
            let origin = range.split_once('(').map_or("", |(_, origin)| origin);
            words_in(item, what).or_else(|| words_in(item, origin))
        }
        RecipeErrorKind::Count { what, .. } => words_in(item, what),
        kind => {
            let message = kind.to_string();
            let quoted: Vec<_> = message.split('`').skip(1).step_by(2).collect();
            words_in(item, &quoted.join(" "))
        }
    };
    found.or_else(|| key?.span()).or_else(|| item.span())
}

/// Returns the top-level entry that an error without a node refers to.
fn document_item<'a>(root: &'a toml_edit::Table, error: &RecipeError) -> Option<&'a Item> {
    match error.kind() {
        RecipeErrorKind::Range { what, .. } => root.get(what),
        RecipeErrorKind::Schema { .. } => root.get("dapple"),
        _ => None,
    }
}

/// Returns the byte range of the string `text` in an item.
fn text_in(item: &Item, text: &str) -> Option<Range<usize>> {
    values(item)
        .into_iter()
        .find(|(_, value)| value.as_str() == Some(text))
        .and_then(|(_, value)| value.span())
}

/// Returns the byte range of a value whose key occurs in `sentence`, such as `octaves` in "number of octaves". The
/// longest key wins.
fn words_in(item: &Item, sentence: &str) -> Option<Range<usize>> {
    let words: Vec<_> = sentence
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .collect();
    let is_named = |key: &str| {
        let parts: Vec<_> = key.split('_').collect();
        words.contains(&key) || words.windows(parts.len()).any(|run| run == parts)
    };
    let named = values(item).into_iter().filter(|(key, _)| is_named(key));
    named
        .max_by_key(|(key, _)| key.len())
        .and_then(|(_, value)| value.span())
}

/// Returns all values in an item, except tables, with their keys. An element of an array has the key of the array.
fn values(item: &Item) -> Vec<(String, &Value)> {
    fn of_value<'a>(key: &str, value: &'a Value, all: &mut Vec<(String, &'a Value)>) {
        match value {
            Value::InlineTable(table) => of_table(table, all),
            Value::Array(list) => {
                all.push((key.to_owned(), value));
                list.iter().for_each(|value| of_value(key, value, all));
            }
            _ => all.push((key.to_owned(), value)),
        }
    }
    fn of_item<'a>(key: &str, item: &'a Item, all: &mut Vec<(String, &'a Value)>) {
        match item {
            Item::Value(value) => of_value(key, value, all),
            Item::Table(table) => of_table(table, all),
            Item::ArrayOfTables(tables) => tables.iter().for_each(|table| of_table(table, all)),
            Item::None => {}
        }
    }
    fn of_table<'a>(table: &'a dyn TableLike, all: &mut Vec<(String, &'a Value)>) {
        table.iter().for_each(|(key, item)| of_item(key, item, all));
    }
    let mut all = Vec::new();
    of_item("", item, &mut all);
    all
}
