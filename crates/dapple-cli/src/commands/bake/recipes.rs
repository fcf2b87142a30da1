//! Expands patterns such as `rocks/*.toml`, for shells that do not expand them and for built-in recipes.

use crate::error::{Hint, usage};
use anyhow::{Context as _, Result};
use dapple::recipe::Recipe;
use glob::{Pattern, glob};
use std::path::Path;

/// Replaces each pattern by the files that it matches, or, if it matches no file, by the built-in recipes that it
/// matches. Other names are unchanged.
///
/// # Errors
///
/// If a pattern is invalid or matches nothing.
pub(super) fn expanded(names: &[String]) -> Result<Vec<String>> {
    let mut all = Vec::new();
    for name in names {
        if !name.contains(['*', '?', '[']) || Path::new(name).exists() {
            all.push(name.clone());
            continue;
        }
        let pattern = Pattern::new(name)
            .context(format!("{name} is not a pattern"))
            .wrong_value()?;
        let n_before = all.len();
        for path in glob(name)? {
            let path = path?;
            if path.is_file() {
                all.push(path.to_string_lossy().into_owned());
            }
        }
        if all.len() == n_before {
            let builtin = Recipe::builtin_names().filter(|name| pattern.matches(name));
            all.extend(builtin.map(str::to_owned));
        }
        if all.len() == n_before {
            let message = format!("no file and no built-in recipe matches {name}");
            return Err(usage(message).hint("`dapple recipe --list` names the built-in recipes"));
        }
    }
    Ok(all)
}
