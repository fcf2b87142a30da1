//! Named parameters of a recipe. A parameter that no option refers to is an error, so it is removed with its last option.

use crate::data::json_of_table;
use serde_json::Value as Json;
use std::collections::BTreeSet;
use toml_edit::{DocumentMut, Item};

/// The key of the table of parameters.
pub(super) const KEY: &str = "parameters";

/// Returns the names of the parameters that options refer to, written as `"$name"`.
pub(super) fn used(document: &DocumentMut) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    collect(&json_of_table(document), &mut names);
    names
}

fn collect(value: &Json, names: &mut BTreeSet<String>) {
    match value {
        Json::String(text) => names.extend(text.strip_prefix('$').map(str::to_owned)),
        Json::Array(list) => list.iter().for_each(|value| collect(value, names)),
        Json::Object(entries) => entries.values().for_each(|value| collect(value, names)),
        _ => {}
    }
}

/// Removes the parameters that were used `before` an edit and are not used after it.
pub(super) fn remove_unused(document: &mut DocumentMut, before: &BTreeSet<String>) {
    let after = used(document);
    let named = document.get_mut(KEY).and_then(Item::as_table_like_mut);
    let Some(named) = named else { return };
    let mut is_less = false;
    for name in before.difference(&after) {
        is_less |= named.remove(name).is_some();
    }
    if is_less && named.is_empty() {
        document.remove(KEY);
    }
}
