//! Named parameters: values that several options share, written in an option as `"$name"`.
//!
//! They are substituted in the parsed text, before nodes are read from it. A recipe records which options refer to a
//! parameter, so that these references are restored when it is written.

use super::content::Content;
use super::refusal::{Part, Refusal};
use crate::{RecipeError, RecipeErrorKind};
use indexmap::IndexMap;
use serde::de::Error as _;

/// The key of the table of parameters.
pub(super) const KEY: &str = "parameters";

/// Top-level keys of a recipe whose values are plain text, in which parameters are not substituted.
const TEXTS: [&str; 5] = ["dapple", "name", "about", "tags", KEY];

/// The named parameters of a recipe, in the order of its text.
///
/// # Examples
///
/// ```
/// use dapple_recipe::Recipe;
///
/// let mut recipe = Recipe::from_toml(
///     r#"
///     dapple = 1
///     [parameters]
///     size = { value = 8, range = [1, 64], doc = "Cells per unit." }
///     [nodes.cells.worley]
///     frequency = "$size"
///     [material]
///     height = "cells"
///     "#,
/// )?;
/// let size = recipe.parameters.get("size").expect("there is one");
/// assert_eq!((size.value().as_i64(), size.doc()), (Some(8), "Cells per unit."));
/// recipe.set("size", "16")?;
/// assert!(recipe.to_toml()?.contains("frequency = \"$size\""));
/// # Ok::<(), dapple_recipe::RecipeError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameters {
    named: IndexMap<String, Parameter>,
    uses: Vec<Use>,
}

/// A value that several options of a recipe share.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    value: Content,
    range: Option<[f64; 2]>,
    doc: String,
    /// Whether the parameter is written as a table with the key `value`, not as a bare value.
    is_table: bool,
}

/// An option whose value is a parameter.
#[derive(Clone, Debug, PartialEq)]
struct Use {
    /// The path of the option, outermost part first.
    path: Vec<Part>,
    name: String,
    /// The option's serialized value when it was read, to detect changes; `None` if serialization omits the option.
    written: Option<Content>,
}

/// An error in the parameters of a recipe. `refusal` has the path of the erroneous value.
pub(super) struct Fault {
    pub(super) error: RecipeError,
    pub(super) refusal: Refusal,
}

impl Fault {
    fn new(kind: RecipeErrorKind, path: &[Part]) -> Self {
        Self::of(RecipeError::new(kind), path)
    }

    /// Creates a fault from an error and the path of the erroneous value.
    pub(super) fn of(error: RecipeError, path: &[Part]) -> Self {
        let parts = path.iter().rev().cloned();
        let refusal = parts.fold(Refusal::custom(""), Refusal::inside);
        Self { error, refusal }
    }
}

impl Parameter {
    /// Returns the value: a number, a string, a boolean, or a list of these.
    #[must_use]
    pub fn value(&self) -> serde_json::Value {
        serde_json::to_value(&self.value).unwrap_or_default()
    }

    /// Returns the minimum and maximum allowed number, if the recipe sets a range.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        self.range
    }

    /// Returns the description; empty if the recipe has none.
    #[must_use]
    pub fn doc(&self) -> &str {
        &self.doc
    }

    /// Reads a parameter from its value, or from a table with `value`, `range` and `doc`.
    fn read(content: &Content) -> Result<Self, String> {
        let Content::Table(table) = content else {
            return Self::of_value(content.clone(), false);
        };
        let mut parameter = match content.get("value") {
            Some(value) => Self::of_value(value.clone(), true)?,
            None => return Err("`value` is missing".to_owned()),
        };
        for (key, value) in table {
            match (key.as_str(), value) {
                ("value", _) => {}
                ("doc", Content::Text(text)) => parameter.doc.clone_from(text),
                ("range", Content::List(list)) => {
                    let [Some(min), Some(max)] = [0, 1].map(|at| list.get(at)?.number()) else {
                        return Err("`range` is a list of two numbers".to_owned());
                    };
                    if list.len() != 2 || min > max {
                        return Err(
                            "`range` is a list of two numbers, the smaller first".to_owned()
                        );
                    }
                    parameter.range = Some([min, max]);
                }
                _ => {
                    return Err(format!(
                        "unknown field or value of `{key}`, expected `value`, `range`, a list, and `doc`, a text"
                    ));
                }
            }
        }
        parameter.check_range()?;
        Ok(parameter)
    }

    fn of_value(value: Content, is_table: bool) -> Result<Self, String> {
        let is_plain = |value: &Content| match value {
            Content::Text(text) => !text.starts_with('$'),
            Content::Flag(_) | Content::Signed(_) | Content::Unsigned(_) | Content::Number(_) => {
                true
            }
            _ => false,
        };
        let holds = match &value {
            Content::List(list) => list.iter().all(is_plain),
            value => is_plain(value),
        };
        if !holds {
            return Err(
                "the value is a number, a text, true, false or a list of these, without `$`"
                    .to_owned(),
            );
        }
        Ok(Self {
            value,
            range: None,
            doc: String::new(),
            is_table,
        })
    }

    /// Checks that the value is a number in the range, if there is a range.
    fn check_range(&self) -> Result<(), String> {
        let Some([min, max]) = self.range else {
            return Ok(());
        };
        match self.value.number() {
            Some(number) if (min..=max).contains(&number) => Ok(()),
            Some(number) => Err(format!(
                "the value is {number}, but it must be from {min} to {max}"
            )),
            None => Err("only numbers have a range".to_owned()),
        }
    }

    /// Returns the parameter in the form in which it was written in the recipe.
    fn written(&self) -> Content {
        if !self.is_table {
            return self.value.clone();
        }
        let mut table = vec![("value".to_owned(), self.value.clone())];
        if let Some(range) = self.range {
            let range = range.map(Content::Number).to_vec();
            table.push(("range".to_owned(), Content::List(range)));
        }
        if !self.doc.is_empty() {
            table.push(("doc".to_owned(), Content::Text(self.doc.clone())));
        }
        Content::Table(table)
    }
}

impl Parameters {
    /// Returns whether the recipe has no parameters.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.named.is_empty()
    }

    /// Returns the parameter called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Parameter> {
        self.named.get(name)
    }

    /// Returns all parameters with their names, in the order of the text.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Parameter)> {
        self.named
            .iter()
            .map(|(name, parameter)| (name.as_str(), parameter))
    }

    /// Removes the parameters from a parsed recipe, and replaces all references to them with their values.
    pub(super) fn substitute(content: &mut Content) -> Result<Self, Fault> {
        let mut parameters = Self::default();
        let Content::Table(table) = content else {
            return Ok(parameters);
        };
        if let Some(at) = table.iter().position(|(key, _)| key == KEY) {
            let (key, named) = table.remove(at);
            parameters.named = read_all(&named, &[Part::Key(key)])?;
        }
        for (key, value) in table {
            if !TEXTS.contains(&key.as_str()) {
                parameters.replace(value, &mut vec![Part::Key(key.clone())])?;
            }
        }
        Ok(parameters)
    }

    /// Replaces the references in a value, whose path is `path`.
    fn replace(&mut self, value: &mut Content, path: &mut Vec<Part>) -> Result<(), Fault> {
        match value {
            Content::Text(text) => {
                let Some(name) = text.strip_prefix('$').map(str::to_owned) else {
                    return Ok(());
                };
                let Some(parameter) = self.named.get(&name) else {
                    return Err(self.unknown(&name, path));
                };
                *value = parameter.value.clone();
                self.uses.push(Use {
                    path: path.clone(),
                    name,
                    written: None,
                });
                Ok(())
            }
            Content::List(list) => list.iter_mut().enumerate().try_for_each(|(index, value)| {
                self.replace_inside(value, path, Part::Index(index))
            }),
            Content::Table(table) => table.iter_mut().try_for_each(|(key, value)| {
                self.replace_inside(value, path, Part::Key(key.clone()))
            }),
            _ => Ok(()),
        }
    }

    fn replace_inside(
        &mut self,
        value: &mut Content,
        path: &mut Vec<Part>,
        part: Part,
    ) -> Result<(), Fault> {
        path.push(part);
        self.replace(value, path)?;
        path.pop();
        Ok(())
    }

    /// Returns the error for a reference to an undefined parameter.
    fn unknown(&self, name: &str, path: &[Part]) -> Fault {
        let fault = Fault::new(
            RecipeErrorKind::UnknownParameter {
                name: name.to_owned(),
                option: written_path(path),
            },
            path,
        );
        let names = self.named.keys().map(String::as_str);
        Fault {
            error: fault.error.meant(name, names),
            ..fault
        }
    }

    /// Returns an error if a parameter is not used.
    pub(super) fn check_used(&self) -> Result<(), Fault> {
        let unused = self.named.keys().find(|name| !self.is_used(name));
        let Some(name) = unused else { return Ok(()) };
        let kind = RecipeErrorKind::UnusedParameter { name: name.clone() };
        Err(Fault::new(
            kind,
            &[Part::Key(KEY.to_owned()), Part::Key(name.clone())],
        ))
    }

    fn is_used(&self, name: &str) -> bool {
        self.uses.iter().any(|used| used.name == name)
    }

    /// Removes the parameters that are not used.
    pub(super) fn drop_unused(&mut self) {
        let uses = &self.uses;
        self.named
            .retain(|name, _| uses.iter().any(|used| used.name == *name));
    }

    /// Returns the fault for a value that was refused. If the value comes from a parameter, the error names the
    /// parameter and the option.
    pub(super) fn blame(&self, refusal: Refusal, error: RecipeError) -> Fault {
        let path = refusal.path();
        let Some(used) = self.uses.iter().find(|used| path.starts_with(&used.path)) else {
            return Fault { error, refusal };
        };
        let kind = RecipeErrorKind::Parameter {
            name: used.name.clone(),
            option: written_path(&used.path),
            message: error.to_string(),
        };
        Fault::new(kind, &used.path)
    }

    /// Records the serialized values of all options that refer to parameters. `written` is the whole recipe.
    pub(super) fn record(&mut self, written: &Content) {
        for used in &mut self.uses {
            let last = used.path.last_mut();
            // Aliases of options are written under the name of the option.
            if let Some(Part::Key(key)) = last
                && let Some((name, _)) = ALIASES.iter().find(|(_, alias)| alias == key)
            {
                *key = (*name).to_owned();
            }
            used.written = written.at(&used.path).cloned();
        }
    }

    /// Puts the references and the table of parameters back into a serialized recipe. An option that has changed since
    /// it was read is written as a plain value.
    pub(super) fn restore(&self, written: &mut Content) {
        let mut named: Vec<_> = Vec::new();
        for used in &self.uses {
            if written.at(&used.path) == used.written.as_ref() {
                written.put(&used.path, Content::Text(format!("${}", used.name)));
                named.push(&used.name);
            }
        }
        let table: Vec<_> = self
            .named
            .iter()
            .filter(|(name, _)| named.contains(name))
            .collect();
        let table = table
            .into_iter()
            .map(|(name, parameter)| (name.clone(), parameter.written()));
        let table: Vec<_> = table.collect();
        if let (Content::Table(recipe), false) = (written, table.is_empty()) {
            let at = recipe.iter().position(|(key, _)| key == "nodes");
            recipe.insert(
                at.unwrap_or(recipe.len()),
                (KEY.to_owned(), Content::Table(table)),
            );
        }
    }
}

/// Aliases of options, as pairs of option and alias.
pub(crate) const ALIASES: [(&str, &str); 3] = [
    ("gain", "persistence"),
    ("albedo", "basecolor"),
    ("albedo", "base_color"),
];

/// Reads the table of parameters, whose path is `path`.
fn read_all(named: &Content, path: &[Part]) -> Result<IndexMap<String, Parameter>, Fault> {
    let fault = |message: String, more: &[Part]| {
        let path = [path, more].concat();
        Fault::new(RecipeErrorKind::Text { message }, &path)
    };
    let Content::Table(table) = named else {
        return Err(fault(
            "`parameters` is a table of values by name".to_owned(),
            &[],
        ));
    };
    let mut all = IndexMap::new();
    for (name, content) in table {
        let at = [Part::Key(name.clone())];
        if !crate::plan::is_name(name) {
            let kind = RecipeErrorKind::Name { name: name.clone() };
            return Err(Fault::new(kind, &[path, &at].concat()));
        }
        let parameter = Parameter::read(content);
        let parameter = parameter
            .map_err(|message| fault(format!("the parameter `{name}`: {message}"), &at))?;
        all.insert(name.clone(), parameter);
    }
    Ok(all)
}

/// Formats a path, such as `nodes.cells.worley.frequency`.
fn written_path(path: &[Part]) -> String {
    let part = |part: &Part| match part {
        Part::Key(key) => key.clone(),
        Part::Index(index) => index.to_string(),
    };
    path.iter().map(part).collect::<Vec<_>>().join(".")
}
