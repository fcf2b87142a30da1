//! Converts options from Python objects (dictionaries, lists, strings, numbers, NumPy arrays) to JSON data.

use crate::error::{Error, Result};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyMapping, PySequence, PyString};
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};

/// Maximum nesting depth of data.
const DEEPEST: usize = 100;

/// Reads options in the same form as recipes use. `what` names the options in error messages.
pub(crate) fn options<T: DeserializeOwned>(what: &str, data: &Bound<'_, PyAny>) -> Result<T> {
    read(what, value(data)?)
}

/// Reads options in the same form as recipes use; returns `default` if `data` is `None`.
pub(crate) fn options_or<T: DeserializeOwned>(
    what: &str,
    data: Option<&Bound<'_, PyAny>>,
    default: T,
) -> Result<T> {
    data.map_or(Ok(default), |data| options(what, data))
}

/// Converts data to options of type `T`.
pub(crate) fn read<T: DeserializeOwned>(what: &str, data: Value) -> Result<T> {
    dapple::recipe::read_options(&data).map_err(|error| {
        let message = format!("{what}: {}", in_our_words(&error.kind().to_string()));
        Error::new("options", message).with_near(error.nearest().map(str::to_owned))
    })
}

/// Rewrites a parser's message about an unknown name, without the words of Rust.
fn in_our_words(message: &str) -> String {
    let parts = ["unknown variant ", "unknown field "].into_iter();
    let Some(rest) = parts.filter_map(|start| message.strip_prefix(start)).next() else {
        return message.to_owned();
    };
    rest.replacen(", expected one of ", " is not one of ", 1)
        .replacen(", expected ", " is not ", 1)
}

/// Converts Python data to JSON text, with each entry on a separate line, in the order of the dictionaries.
pub(crate) fn text(data: &Bound<'_, PyAny>) -> Result<String> {
    let mut text = String::new();
    write(data, 0, &mut text)?;
    Ok(text)
}

fn write(data: &Bound<'_, PyAny>, depth: usize, text: &mut String) -> Result<()> {
    check_depth(depth)?;
    let (ends, entries) = if let Some(pairs) = pairs(data)? {
        (
            "{}",
            pairs
                .into_iter()
                .map(|(key, data)| (Some(key), data))
                .collect(),
        )
    } else if data.cast::<PySequence>().is_ok() && data.cast::<PyString>().is_err() {
        let items = data.try_iter()?.map(|item| Ok((None, item?)));
        ("[]", items.collect::<Result<Vec<_>>>()?)
    } else {
        text.push_str(&nested(data, depth)?.to_string());
        return Ok(());
    };
    text.push_str(&ends[..1]);
    for (index, (key, data)) in entries.iter().enumerate() {
        text.push_str(if index > 0 { ",\n" } else { "\n" });
        if let Some(key) = key {
            text.push_str(&format!("{}: ", Value::from(key.as_str())));
        }
        write(data, depth + 1, text)?;
    }
    if !entries.is_empty() {
        text.push('\n');
    }
    text.push_str(&ends[1..]);
    Ok(())
}

/// Entries of a dictionary, as pairs of key and value.
type Entries<'py> = Vec<(String, Bound<'py, PyAny>)>;

/// Returns the entries of a dictionary; `None` for other data.
fn pairs<'py>(data: &Bound<'py, PyAny>) -> Result<Option<Entries<'py>>> {
    let pairs: Vec<(Bound<'py, PyAny>, _)> = if let Ok(mapping) = data.cast::<PyDict>() {
        mapping.iter().collect()
    } else if let Ok(mapping) = data.cast::<PyMapping>() {
        mapping.items()?.extract()?
    } else {
        return Ok(None);
    };
    let named = pairs.into_iter().map(|(key, data)| {
        let key = key.cast::<PyString>().map_err(PyErr::from)?;
        Ok((key.to_str()?.to_owned(), data))
    });
    Ok(Some(named.collect::<Result<_>>()?))
}

fn check_depth(depth: usize) -> Result<()> {
    if depth > DEEPEST {
        let message = format!("data is nested more than {DEEPEST} times");
        return Err(Error::new("options", message));
    }
    Ok(())
}

/// Converts Python data to a JSON value.
pub(crate) fn value(data: &Bound<'_, PyAny>) -> Result<Value> {
    nested(data, 0)
}

fn nested(data: &Bound<'_, PyAny>, depth: usize) -> Result<Value> {
    check_depth(depth)?;
    if data.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(flag) = data.cast::<PyBool>() {
        return Ok(Value::Bool(flag.is_true()));
    }
    if let Ok(text) = data.cast::<PyString>() {
        return Ok(Value::String(text.to_str()?.to_owned()));
    }
    if let Some(pairs) = pairs(data)? {
        let entries = pairs
            .into_iter()
            .map(|(key, data)| Ok((key, nested(&data, depth + 1)?)));
        return Ok(Value::Object(entries.collect::<Result<Map<_, _>>>()?));
    }
    if let Ok(sequence) = data.cast::<PySequence>() {
        return list(sequence.as_any(), depth);
    }
    number(data, depth)
}

fn list(data: &Bound<'_, PyAny>, depth: usize) -> Result<Value> {
    let items = data.try_iter()?.map(|item| nested(&item?, depth + 1));
    Ok(Value::Array(items.collect::<Result<_>>()?))
}

/// Converts Python and NumPy numbers and NumPy arrays to JSON. `depth` is the current nesting depth.
fn number(data: &Bound<'_, PyAny>, depth: usize) -> Result<Value> {
    if data.hasattr("tolist")? {
        return nested(&data.call_method0("tolist")?, depth + 1);
    }
    if data.is_instance_of::<PyInt>()
        || (data.hasattr("__index__")? && !data.is_instance_of::<PyFloat>())
    {
        let number = data.extract::<u64>().map(Number::from);
        return Ok(Value::Number(
            number.or_else(|_| data.extract::<i64>().map(Number::from))?,
        ));
    }
    if data.hasattr("__float__")? {
        let number: f64 = data.extract()?;
        return Number::from_f64(number)
            .map(Value::Number)
            .ok_or_else(|| Error::new("options", format!("the number {number} is not finite")));
    }
    let message = format!(
        "{} is no data: use dictionaries, lists, words and numbers",
        data.get_type()
    );
    Err(PyTypeError::new_err(message).into())
}

/// Returns the value of the enum `T` called `name`. `what` is the option's name in error messages.
pub(crate) fn named<T: dapple::raster::Named>(what: &str, name: &str) -> Result<T> {
    T::from_name(name).ok_or_else(|| unknown_name(what, name, T::NAMES))
}

/// Returns the error for an unknown name, with the known names and a suggestion.
pub(crate) fn unknown_name(what: &str, name: &str, known: &[&str]) -> Error {
    let message = format!(
        "the {what} is `{name}`, but it must be one of {}",
        known.join(", ")
    );
    let near = dapple::recipe::similar_words(name, known.iter().copied());
    Error::new("name", message).with_near(near.first().map(|near| (*near).to_owned()))
}
