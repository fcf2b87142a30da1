//! Converts values between TOML and JSON.

use crate::StudioError;
use serde_json::{Map, Number, Value as Json};
use toml_edit::{Array, InlineTable, Item, Table, Value};

/// Converts a TOML item to JSON. Dates become strings.
pub(crate) fn json_of_item(item: &Item) -> Json {
    match item {
        Item::None => Json::Null,
        Item::Value(value) => json_of_value(value),
        Item::Table(table) => json_of_table(table),
        Item::ArrayOfTables(tables) => tables.iter().map(json_of_table).collect(),
    }
}

/// Converts a TOML table to JSON.
pub(crate) fn json_of_table(table: &Table) -> Json {
    let entries = table
        .iter()
        .map(|(key, item)| (key.to_owned(), json_of_item(item)));
    Json::Object(entries.collect())
}

/// Converts a TOML value to JSON.
pub(crate) fn json_of_value(value: &Value) -> Json {
    match value {
        Value::String(text) => text.value().as_str().into(),
        Value::Integer(number) => (*number.value()).into(),
        Value::Float(number) => Number::from_f64(*number.value()).map_or(Json::Null, Json::Number),
        Value::Boolean(flag) => (*flag.value()).into(),
        Value::Datetime(date) => date.value().to_string().into(),
        Value::Array(list) => list.iter().map(json_of_value).collect(),
        Value::InlineTable(table) => {
            let entries = table
                .iter()
                .map(|(key, value)| (key.to_owned(), json_of_value(value)));
            Json::Object(entries.collect())
        }
    }
}

/// Converts a JSON value to TOML.
pub(crate) fn value_of(json: &Json) -> Result<Value, StudioError> {
    Ok(match json {
        Json::Null => return Err(StudioError::new("nothing (null) is no value of a recipe")),
        Json::Bool(flag) => (*flag).into(),
        Json::String(text) => text.as_str().into(),
        Json::Number(number) => value_of_number(number)?,
        Json::Array(list) => {
            let values = list.iter().map(value_of);
            Value::Array(values.collect::<Result<Array, _>>()?)
        }
        Json::Object(entries) => Value::InlineTable(inline_table_of(entries)?),
    })
}

fn inline_table_of(entries: &Map<String, Json>) -> Result<InlineTable, StudioError> {
    let mut table = InlineTable::new();
    for (key, value) in entries {
        table.insert(key, value_of(value)?);
    }
    Ok(table)
}

/// Converts a JSON object to a TOML table with a line per entry. Nested objects become inline tables.
pub(crate) fn table_of(entries: &Map<String, Json>) -> Result<Table, StudioError> {
    let mut table = Table::new();
    for (key, value) in entries {
        table.insert(key, Item::Value(value_of(value)?));
    }
    Ok(table)
}

fn value_of_number(number: &Number) -> Result<Value, StudioError> {
    if let Some(whole) = number.as_i64() {
        return Ok(whole.into());
    }
    if number.is_u64() {
        return Err(StudioError::new(format!(
            "{number} is too large for TOML, whose whole numbers end at 2^63 - 1"
        )));
    }
    number
        .as_f64()
        .map(Value::from)
        .ok_or_else(|| StudioError::new("the number is not finite"))
}

/// Assigns JSON to a TOML value. The formatting of unchanged elements and entries is preserved.
pub(crate) fn rewrite(old: &mut Value, json: &Json) -> Result<(), StudioError> {
    if json_of_value(old) == *json {
        return Ok(());
    }
    match (&mut *old, json) {
        (Value::Array(list), Json::Array(new)) => return rewrite_list(list, new),
        (Value::InlineTable(table), Json::Object(new)) => {
            table.retain(|key, _| new.contains_key(key));
            for (key, json) in new {
                match table.get_mut(key) {
                    Some(value) => rewrite(value, json)?,
                    None => drop(table.insert(key, value_of(json)?)),
                }
            }
            return Ok(());
        }
        _ => {}
    }
    let mut new = value_of(json)?;
    // A number written with a decimal point keeps it, so that 2.0 does not become 2.
    if let (Value::Float(_), Json::Number(number)) = (&*old, json)
        && let Some(number) = number.as_f64()
    {
        if json_of_value(old).as_f64() == Some(number) {
            return Ok(());
        }
        new = number.into();
    }
    *new.decor_mut() = old.decor().clone();
    *old = new;
    Ok(())
}

fn rewrite_list(list: &mut Array, new: &[Json]) -> Result<(), StudioError> {
    while list.len() > new.len() {
        remove_element(list, list.len() - 1);
    }
    for (value, json) in list.iter_mut().zip(new) {
        rewrite(value, json)?;
    }
    for json in &new[list.len()..] {
        let value = value_of(json)?;
        insert_element(list, list.len(), value);
    }
    Ok(())
}

/// Inserts a value into an array, formatted like its neighbors.
pub(crate) fn insert_element(list: &mut Array, index: usize, mut value: Value) {
    if !is_in_lines(list) {
        list.insert(index, value);
        respace(list);
        return;
    }
    let neighbor = list
        .get(index)
        .or_else(|| list.get(index.saturating_sub(1)));
    let prefix = neighbor.and_then(|neighbor| neighbor.decor().prefix()?.as_str());
    // Copy the neighbor's indentation without its comments.
    let indent = prefix
        .and_then(|prefix| prefix.rsplit_once('\n'))
        .map_or("", |(_, indent)| indent);
    value.decor_mut().set_prefix(format!("\n{indent}"));
    value.decor_mut().set_suffix("");
    list.insert_formatted(index, value);
}

/// Removes an element of an array.
pub(crate) fn remove_element(list: &mut Array, index: usize) {
    list.remove(index);
    if !is_in_lines(list) {
        respace(list);
    }
}

/// Returns whether the elements of an array are on separate lines. An array with comments counts as well.
fn is_in_lines(list: &Array) -> bool {
    let is_broken = |text: Option<&str>| text.is_some_and(|text| text.contains('\n'));
    is_broken(list.trailing().as_str())
        || list.iter().any(|value| {
            let decor = value.decor();
            is_broken(decor.prefix().and_then(|text| text.as_str()))
                || is_broken(decor.suffix().and_then(|text| text.as_str()))
        })
}

/// Separates the elements of a single-line array with one space each.
fn respace(list: &mut Array) {
    for (index, value) in list.iter_mut().enumerate() {
        value
            .decor_mut()
            .set_prefix(if index == 0 { "" } else { " " });
        value.decor_mut().set_suffix("");
    }
}
