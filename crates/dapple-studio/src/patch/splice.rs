//! Fast path for edits that only change numbers, which are replaced in the text without serializing the document again.
//! Dragging a slider or a point causes many such edits per second.

use super::{Op, Part};
use crate::Document;
use crate::data::{json_of_value, value_of};
use core::ops::Range;
use serde_json::Value as Json;
use toml_edit::{Item, Value};

/// Applies edits to numbers that are written in the text. The result equals that of [`apply`](super::apply). Returns
/// `None` for other edits.
pub(crate) fn spliced(document: &Document, ops: &[Op]) -> Option<String> {
    let mut parts = Vec::new();
    for op in ops {
        let Op::Set { path, value } = op else {
            return None;
        };
        replace(at(document, path)?, value, &mut parts)?;
    }
    // Copy the text and replace the ranges in order.
    parts.sort_by_key(|(range, _)| range.start);
    let old = document.text();
    let mut text = String::with_capacity(old.len() + 32);
    let mut end = 0;
    for (range, number) in parts {
        // Overlapping ranges, from a number that is set twice, give `None`.
        text += old.get(end..range.start)?;
        text += number.as_deref().or_else(|| old.get(range.clone()))?;
        end = range.end;
    }
    text += old.get(end..)?;
    Some(text)
}

/// Returns the TOML value at a path.
fn at<'a>(document: &'a Document, path: &[Part]) -> Option<&'a Value> {
    let mut parts = path.iter();
    let Part::Key(first) = parts.next()? else {
        return None;
    };
    let mut item: &Item = document.table()?.get(first)?;
    for part in parts {
        item = match part {
            Part::Key(key) => item.get(key)?,
            Part::Index(index) => item.get(*index)?,
        };
    }
    item.as_value()
}

/// Collects the byte ranges of all numbers in `old`, each with its new text, or `None` if the number is unchanged.
/// Returns `None` if `new` differs from `old` in anything other than numbers.
fn replace(old: &Value, new: &Json, parts: &mut Vec<(Range<usize>, Option<String>)>) -> Option<()> {
    if let (Value::Array(list), Json::Array(new)) = (old, new) {
        let mut pairs = list.iter().zip(new);
        let is_alike = list.len() == new.len();
        return is_alike.then(|| pairs.try_for_each(|(old, new)| replace(old, new, parts)))?;
    }
    let number = match (old, new) {
        // A number written with a decimal point keeps it.
        (Value::Float(_), Json::Number(number)) => number.as_f64()?.into(),
        (Value::Integer(_), Json::Number(_)) => value_of(new).ok()?,
        _ => return None,
    };
    let is_same = json_of_value(&number) == json_of_value(old);
    parts.push((old.span()?, (!is_same).then(|| number.to_string())));
    Some(())
}
