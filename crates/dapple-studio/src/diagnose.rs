//! Mistakes of a recipe, with their places in its text.

use crate::Document;
use core::ops::Range;
use dapple::recipe::{Place, RecipeError, RecipeErrorKind};
use serde::Serialize;
use toml_edit::{Item, TableLike, Value};

/// A mistake of a recipe, with its place in the text. Positions are UTF-16 code units.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// The first position of the mistake.
    pub from: usize,
    /// The position after its last.
    pub to: usize,
    /// The node, if it is in one.
    pub node: Option<String>,
    /// A sentence that names the mistake.
    pub message: String,
    /// The valid word that is nearest to what is written, if one is near.
    pub nearest: Option<String>,
    /// A way to mend it, if one is known.
    pub hint: Option<String>,
}

/// The mistake of a text that is no recipe.
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

/// The mistake of a recipe that was read, but is refused by a plan or a bake.
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

/// The byte of a line and a column.
fn byte_of(text: &str, place: Place) -> usize {
    let mut lines = text.split_inclusive('\n');
    let before: usize = lines.by_ref().take(place.line - 1).map(str::len).sum();
    let line = lines.next().unwrap_or_default();
    let column = line.char_indices().nth(place.column.saturating_sub(1));
    before + column.map_or(line.trim_end().len(), |(byte, _)| byte)
}

/// The end of the word, the text or the list that begins at a byte; at least one character, if there is one.
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

/// Where a plan was refused: the value that the error speaks of, or else the name of the node.
fn place(document: &Document, error: &RecipeError) -> Option<Range<usize>> {
    let root = document.table()?;
    let nodes = root.get("nodes").and_then(Item::as_table_like);
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
    let found = match error.kind() {
        RecipeErrorKind::UnknownNode { name } | RecipeErrorKind::NoImage { file: name } => {
            text_in(item, name)
        }
        RecipeErrorKind::NotANumber { input } => text_in(item, input.trim_matches('`')),
        RecipeErrorKind::Cycle { names } => names.get(1).and_then(|name| text_in(item, name)),
        RecipeErrorKind::Range { what, range, .. } => {
            // What the number follows from is in brackets: `(extent times frequency)`.
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

/// The entry of the recipe itself that an error without a node speaks of.
fn document_item<'a>(root: &'a toml_edit::Table, error: &RecipeError) -> Option<&'a Item> {
    match error.kind() {
        RecipeErrorKind::Range { what, .. } => root.get(what),
        RecipeErrorKind::Schema { .. } => root.get("dapple"),
        _ => None,
    }
}

/// Where a text is written in an item.
fn text_in(item: &Item, text: &str) -> Option<Range<usize>> {
    values(item)
        .into_iter()
        .find(|(_, value)| value.as_str() == Some(text))
        .and_then(|(_, value)| value.span())
}

/// The value whose key is the longest of those in a sentence: `octaves` of "number of octaves".
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

/// All values in an item that are no tables, with the keys that they have. Elements of lists have that of the list.
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
