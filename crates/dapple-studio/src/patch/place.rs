//! Navigates and edits a TOML document.

use super::{Part, parameters};
use crate::StudioError;
use crate::data::{insert_element, json_of_item, remove_element, rewrite, table_of, value_of};
use serde_json::{Map, Value as Json};
use toml_edit::{ArrayOfTables, InlineTable, Item, Table, Value};

/// A table, an array of tables or a value in a document.
pub(super) enum Place<'a> {
    Table(&'a mut Table),
    Tables(&'a mut ArrayOfTables),
    Value(&'a mut Value),
}

/// Maximum depth of tables with their own headers, such as `[nodes.NAME.KIND]` and `[material]`.
const DEEPEST_HEADER: usize = 3;

impl<'a> Place<'a> {
    fn of_item(item: &'a mut Item) -> Result<Self, StudioError> {
        match item {
            Item::Table(table) => Ok(Self::Table(table)),
            Item::ArrayOfTables(tables) => Ok(Self::Tables(tables)),
            Item::Value(value) => Ok(Self::Value(value)),
            Item::None => Err(StudioError::new("there is nothing at this place")),
        }
    }

    /// Sets the value at a path. Missing tables are created.
    pub(super) fn set(self, path: &[Part], value: &Json) -> Result<(), StudioError> {
        let (last, way) = path.split_last().ok_or_else(empty)?;
        self.made(way)?.put(last, value, path.len())
    }

    /// Removes the entry or element at a path.
    pub(super) fn remove(self, path: &[Part]) -> Result<(), StudioError> {
        let (last, way) = path.split_last().ok_or_else(empty)?;
        let missing = || nothing_at(last);
        match (self.found(way)?, last) {
            (Self::Table(table), Part::Key(key)) => {
                table.remove(key).ok_or_else(missing)?;
                show(table);
                Ok(())
            }
            (Self::Value(Value::InlineTable(table)), Part::Key(key)) => {
                table.remove(key).ok_or_else(missing)?;
                tidy(table);
                Ok(())
            }
            (Self::Value(Value::Array(list)), &Part::Index(index)) if index < list.len() => {
                remove_element(list, index);
                Ok(())
            }
            (Self::Tables(tables), &Part::Index(index)) if index < tables.len() => {
                tables.remove(index);
                Ok(())
            }
            _ => Err(missing()),
        }
    }

    /// Inserts an element into the array at a path. The array is created if it is missing.
    pub(super) fn insert(
        self,
        path: &[Part],
        index: usize,
        value: &Json,
    ) -> Result<(), StudioError> {
        let (last, way) = path.split_last().ok_or_else(empty)?;
        let parent = self.made(way)?;
        if parent.lacks(last) {
            return parent.put(last, &Json::Array(vec![value.clone()]), path.len());
        }
        let too_far = || StudioError::new(format!("the list has no place {index}"));
        match parent.step(last)? {
            Self::Value(Value::Array(list)) if index <= list.len() => {
                insert_element(list, index, value_of(value)?);
                Ok(())
            }
            Self::Tables(tables) if index <= tables.len() => {
                let Json::Object(entries) = value else {
                    return Err(StudioError::new("the elements of this list are tables"));
                };
                insert_table(tables, index, table_of(entries)?);
                Ok(())
            }
            Self::Value(Value::Array(_)) | Self::Tables(_) => Err(too_far()),
            _ => Err(StudioError::new("this is no list")),
        }
    }

    /// Navigates to the value at `path`.
    fn found(self, path: &[Part]) -> Result<Self, StudioError> {
        path.iter().try_fold(self, Self::step)
    }

    /// Navigates to the value at `path`. Missing tables are created.
    fn made(self, path: &[Part]) -> Result<Self, StudioError> {
        let mut place = self;
        for (depth, part) in path.iter().enumerate() {
            if place.lacks(part) {
                place = place.with_table(part, depth + 1)?;
            } else {
                place = place.step(part)?;
            }
        }
        Ok(place)
    }

    /// Returns whether this is a table without the entry.
    fn lacks(&self, part: &Part) -> bool {
        match (self, part) {
            (Self::Table(table), Part::Key(key)) => !table.contains_key(key),
            (Self::Value(Value::InlineTable(table)), Part::Key(key)) => !table.contains_key(key),
            _ => false,
        }
    }

    /// Creates an empty table as an entry of this table: with a header down to [`DEEPEST_HEADER`], inline below.
    fn with_table(self, part: &Part, depth: usize) -> Result<Self, StudioError> {
        match (self, part) {
            (Self::Table(table), Part::Key(key)) => {
                check_key(key)?;
                let is_dotted = table.is_dotted();
                let has_header = depth <= DEEPEST_HEADER && !is_dotted;
                let item = if has_header {
                    let mut new = Table::new();
                    new.set_implicit(key == "nodes" || depth == 2);
                    if depth == 1 && key == parameters::KEY {
                        // Write the parameters before all other tables.
                        new.set_position(Some(0));
                        new.decor_mut().set_prefix("\n");
                    }
                    Item::Table(new)
                } else {
                    Item::Value(InlineTable::new().into())
                };
                Self::of_item(table.entry(key).or_insert(item))
            }
            (Self::Value(Value::InlineTable(table)), Part::Key(key)) => {
                check_key(key)?;
                let value = table.entry(key).or_insert(InlineTable::new().into());
                Ok(Self::Value(value))
            }
            _ => Err(nothing_at(part)),
        }
    }

    fn step(self, part: &Part) -> Result<Self, StudioError> {
        let missing = || nothing_at(part);
        match (self, part) {
            (Self::Table(table), Part::Key(key)) => {
                Self::of_item(table.get_mut(key).ok_or_else(missing)?)
            }
            (Self::Tables(tables), &Part::Index(index)) => {
                tables.get_mut(index).map(Self::Table).ok_or_else(missing)
            }
            (Self::Value(Value::InlineTable(table)), Part::Key(key)) => {
                table.get_mut(key).map(Self::Value).ok_or_else(missing)
            }
            (Self::Value(Value::Array(list)), &Part::Index(index)) => {
                list.get_mut(index).map(Self::Value).ok_or_else(missing)
            }
            _ => Err(missing()),
        }
    }

    /// Sets an entry of this table, or an element of this array.
    fn put(self, part: &Part, json: &Json, depth: usize) -> Result<(), StudioError> {
        match (self, part) {
            (Self::Table(table), Part::Key(key)) => put_into_table(table, key, json, depth),
            (Self::Value(Value::InlineTable(table)), Part::Key(key)) => {
                match table.get_mut(key) {
                    Some(value) => rewrite(value, json)?,
                    None => {
                        check_key(key)?;
                        table.insert(key, value_of(json)?);
                        tidy(table);
                    }
                }
                Ok(())
            }
            (Self::Value(Value::Array(list)), &Part::Index(index)) => {
                let value = list.get_mut(index).ok_or_else(|| nothing_at(part))?;
                rewrite(value, json)
            }
            (Self::Tables(tables), &Part::Index(index)) => {
                let table = tables.get_mut(index).ok_or_else(|| nothing_at(part))?;
                match json {
                    Json::Object(entries) => rewrite_table(table, entries, depth),
                    _ => Err(StudioError::new("the elements of this list are tables")),
                }
            }
            _ => Err(nothing_at(part)),
        }
    }
}

fn put_into_table(
    table: &mut Table,
    key: &str,
    json: &Json,
    depth: usize,
) -> Result<(), StudioError> {
    if json.is_null() {
        return Err(StudioError::new(
            "nothing (null) is no value of a recipe; remove it instead",
        ));
    }
    let is_dotted = table.is_dotted();
    match (table.get_mut(key), json) {
        (Some(Item::Value(value)), _) => rewrite(value, json),
        (Some(Item::Table(old)), Json::Object(entries)) => rewrite_table(old, entries, depth),
        (Some(item), _) if json_of_item(item) == *json => Ok(()),
        (Some(item), _) => {
            *item = Item::Value(value_of(json)?);
            Ok(())
        }
        (None, Json::Object(entries)) if depth < DEEPEST_HEADER && !is_dotted => {
            check_key(key)?;
            let mut new = Table::new();
            new.set_implicit(entries.values().all(Json::is_object) && !entries.is_empty());
            table.insert(key, Item::Table(new));
            match table.get_mut(key) {
                Some(Item::Table(new)) => rewrite_table(new, entries, depth),
                _ => Ok(()),
            }
        }
        (None, Json::Object(entries)) if depth == DEEPEST_HEADER && !is_dotted => {
            check_key(key)?;
            table.insert(key, Item::Table(table_of(entries)?));
            Ok(())
        }
        (None, _) => {
            check_key(key)?;
            table.insert(key, Item::Value(value_of(json)?));
            Ok(())
        }
    }
}

/// Sets a table to a JSON object.
fn rewrite_table(
    table: &mut Table,
    entries: &Map<String, Json>,
    depth: usize,
) -> Result<(), StudioError> {
    // Remove entries that the object lacks, then write the others.
    let gone = table.iter().map(|(key, _)| key.to_owned());
    let gone: Vec<_> = gone.filter(|key| !entries.contains_key(key)).collect();
    for key in gone {
        table.remove(&key);
    }
    for (key, json) in entries {
        put_into_table(table, key, json, depth + 1)?;
    }
    show(table);
    Ok(())
}

/// Gives an empty table a header, without which the table would not be written.
fn show(table: &mut Table) {
    if table.is_empty() {
        table.set_implicit(false);
        table.set_dotted(false);
    }
}

/// Inserts a table into an array of tables.
fn insert_table(tables: &mut ArrayOfTables, index: usize, table: Table) {
    let mut all: Vec<Table> = tables.iter().cloned().collect();
    tables.clear();
    all.insert(index, table);
    for table in all {
        tables.push(table);
    }
}

/// Reformats a single-line inline table after an entry was added or removed.
fn tidy(table: &mut InlineTable) {
    let is_in_lines = table.to_string().contains('\n');
    if !is_in_lines {
        table.fmt();
    }
}

/// Rejects keys that would need quotation marks. Recipes have no such keys.
fn check_key(key: &str) -> Result<(), StudioError> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if key.is_empty() || key.len() > 200 || !key.chars().all(is_plain) {
        let message = "a name is made of letters, digits, `_` and `-`";
        return Err(StudioError::new(message));
    }
    Ok(())
}

fn empty() -> StudioError {
    StudioError::new("the path is empty")
}

fn nothing_at(part: &Part) -> StudioError {
    StudioError::new(match part {
        Part::Key(key) => format!("there is no `{key}` at this place"),
        Part::Index(index) => format!("there is no element {index} at this place"),
    })
}
