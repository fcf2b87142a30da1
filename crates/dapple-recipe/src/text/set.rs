//! Changes single values of a recipe by their path, as on a command line.

use super::content::Content;
use super::parameters::KEY;
use super::text_error;
use crate::{Recipe, RecipeError, RecipeErrorKind};
use serde::Deserialize as _;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Top-level keys of a recipe that `set` accepts.
const TOP: [&str; 6] = ["name", "about", "seed", "extent", "wrap", "material"];

impl Recipe {
    /// Replaces one value: a parameter, such as `jitter`, an option of a node, such as `stones.from`, or a value of the
    /// recipe, such as `seed` or `material.relief`.
    ///
    /// `value` is written as in TOML: a number, `true`, a list such as `[0, 0.3]`, or a table such as `{ jittered = {
    /// jitter = 0.8 } }`. Words need no quotes. If a node and a value of the recipe have the same name, a path with a
    /// dot refers to the node. A parameter with the name of a value of the recipe is set as `parameters.NAME`. If the new
    /// value replaces the last reference to a parameter, the parameter is removed.
    ///
    /// The types of values are checked, as in [`from_toml`](Self::from_toml); ranges are checked later, by a plan.
    ///
    /// # Errors
    ///
    /// [`UnknownNode`](RecipeErrorKind::UnknownNode) if neither a node nor a value has this name, or
    /// [`Text`](RecipeErrorKind::Text) for options and values that recipes do not have. Both have the nearest valid
    /// word. On an error, the recipe stays unchanged.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_recipe::Recipe;
    ///
    /// let mut recipe = Recipe::builtin("flagstone")?;
    /// recipe.set("seed", "12")?;
    /// recipe.set("material.relief", "0.5")?;
    /// assert_eq!(recipe.material.relief, 0.5);
    /// let error = recipe.set("material.releif", "0.5").unwrap_err();
    /// assert_eq!(error.nearest(), Some("relief"));
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    pub fn set(&mut self, path: &str, value: &str) -> Result<(), RecipeError> {
        let written = serde_json::to_value(self.to_content()?);
        let mut recipe = written.map_err(|error| text_error(&error.to_string()))?;
        let (first, options) = path.split_once('.').unwrap_or((path, ""));
        let (target, path) = if self.nodes.contains_key(first) && !options.is_empty() {
            // A node is a table with one key, its kind. The path continues in the options of this kind.
            let kinds = recipe["nodes"][first].as_object_mut();
            (kinds.and_then(|kinds| kinds.values_mut().next()), options)
        } else if let Some(name) = self.parameter(path)? {
            let parameter = &mut recipe[KEY][name];
            // A parameter keeps its range and description.
            match parameter.is_object() {
                true => (Some(parameter), "value"),
                false => (Some(&mut recipe[KEY]), name),
            }
        } else if TOP.contains(&first) {
            (Some(&mut recipe), path)
        } else if self.nodes.contains_key(first) {
            let message =
                format!("`{first}` is a node: name one of its options, as in `{first}.seed`");
            return Err(RecipeError::new(RecipeErrorKind::Text { message }));
        } else {
            let parameters = self.parameters.iter().map(|(name, _)| name);
            let names = self.nodes.keys().map(String::as_str).chain(TOP);
            let names = names.chain(parameters);
            let name = first.to_owned();
            return Err(RecipeError::new(RecipeErrorKind::UnknownNode { name }).meant(first, names));
        };
        // Walk to the value, adding tables where they are missing.
        let mut target = target.ok_or_else(|| text_error("this node has no options"))?;
        for part in path.split('.') {
            if !target.is_object() {
                *target = Value::Object(Map::new());
            }
            target = &mut target[part];
        }
        // Replace the value, and read the whole recipe from the result.
        *target = parsed(value);
        let content =
            Content::deserialize(recipe).map_err(|error| text_error(&error.to_string()))?;
        *self = Self::from_content(content, true).map_err(|fault| fault.error)?;
        Ok(())
    }
}

impl Recipe {
    /// Returns the name of the parameter that `path` refers to, as `NAME` or `parameters.NAME`; `None` if it does not
    /// refer to a parameter.
    fn parameter<'a>(&self, path: &'a str) -> Result<Option<&'a str>, RecipeError> {
        let named = path
            .strip_prefix(KEY)
            .and_then(|rest| rest.strip_prefix('.'));
        let Some(name) = named else {
            let is_parameter = self.parameters.get(path).is_some() && !TOP.contains(&path);
            return Ok(is_parameter.then_some(path));
        };
        if self.parameters.get(name).is_some() {
            return Ok(Some(name));
        }
        let kind = RecipeErrorKind::UnknownParameter {
            name: name.to_owned(),
            option: path.to_owned(),
        };
        let names = self.parameters.iter().map(|(name, _)| name);
        Err(RecipeError::new(kind).meant(name, names))
    }
}

/// Parses a TOML value; other text becomes a string.
fn parsed(text: &str) -> Value {
    let table = toml::from_str::<BTreeMap<String, Value>>(&format!("value = {text}"));
    match table.ok().and_then(|mut table| match table.len() {
        1 => table.remove("value"),
        _ => None,
    }) {
        // Infinity and NaN, which JSON cannot represent, become strings, too.
        None | Some(Value::Null) => Value::String(text.to_owned()),
        Some(value) => value,
    }
}
