//! Changes of single values of a recipe by their path, as on a command line.

use super::{data, read_options, text_error};
use crate::{Recipe, RecipeError, RecipeErrorKind};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Values of a recipe that are not nodes.
const TOP: [&str; 6] = ["name", "about", "seed", "extent", "wrap", "material"];

impl Recipe {
    /// Replaces one value: an option of a node, such as `stones.from`, or a value of the recipe, such as `seed` or
    /// `material.relief`.
    ///
    /// `value` is written as in TOML: a number, `true`, a list such as `[0, 0.3]`, or a table such as
    /// `{ jittered = { jitter = 0.8 } }`. Words need no quotes. A node named like a value of the recipe comes first.
    ///
    /// Only the form is checked, as in [`from_toml`](Self::from_toml); a plan checks ranges.
    ///
    /// # Errors
    ///
    /// The recipe stays as it was, with the error [`UnknownNode`](RecipeErrorKind::UnknownNode) if there is neither such
    /// a node nor such a value, or [`Text`](RecipeErrorKind::Text) for options and values that recipes do not have. Both
    /// have the nearest valid word.
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
        let mut recipe =
            serde_json::to_value(data(self)).map_err(|error| text_error(&error.to_string()))?;
        let (first, options) = path.split_once('.').unwrap_or((path, ""));
        let (target, path) = if self.nodes.contains_key(first) && !options.is_empty() {
            // A node is a table of one key, its kind.
            let kinds = recipe["nodes"][first].as_object_mut();
            (kinds.and_then(|kinds| kinds.values_mut().next()), options)
        } else if TOP.contains(&first) {
            (Some(&mut recipe), path)
        } else if self.nodes.contains_key(first) {
            let message =
                format!("`{first}` is a node: name one of its options, as in `{first}.seed`");
            return Err(RecipeError::new(RecipeErrorKind::Text { message }));
        } else {
            let names = self.nodes.keys().map(String::as_str).chain(TOP);
            let name = first.to_owned();
            return Err(RecipeError::new(RecipeErrorKind::UnknownNode { name }).meant(first, names));
        };
        let mut target = target.ok_or_else(|| text_error("this node has no options"))?;
        for part in path.split('.') {
            if !target.is_object() {
                *target = Value::Object(Map::new());
            }
            target = &mut target[part];
        }
        *target = parsed(value);
        *self = read_options(&recipe)?;
        Ok(())
    }
}

/// A value of TOML, or the text itself if it is none.
fn parsed(text: &str) -> Value {
    let table = toml::from_str::<BTreeMap<String, Value>>(&format!("value = {text}"));
    match table.ok().and_then(|mut table| match table.len() {
        1 => table.remove("value"),
        _ => None,
    }) {
        // Numbers that are not finite have no form in JSON.
        None | Some(Value::Null) => Value::String(text.to_owned()),
        Some(value) => value,
    }
}
