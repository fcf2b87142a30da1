//! A recipe as a program, or as text.

use crate::message::CodeKind;
use crate::{Document, StudioError};
use dapple::recipe::Recipe;

/// What is to be written.
pub(crate) struct Code<'a> {
    pub(crate) kind: CodeKind,
    pub(crate) size: Option<[u32; 2]>,
    pub(crate) maps: Option<&'a [String]>,
    /// The name of the file, or nothing.
    pub(crate) name: &'a str,
}

impl Code<'_> {
    /// The text.
    pub(crate) fn text(&self, document: &Document, recipe: &Recipe) -> Result<String, StudioError> {
        Ok(match self.kind {
            CodeKind::Toml => document.text().to_owned(),
            CodeKind::Json => recipe.to_json()? + "\n",
            CodeKind::Rust => recipe.to_rust()?,
            CodeKind::Python => self.python(document),
            CodeKind::Command => self.command(document, recipe),
        })
    }

    fn size(&self) -> [u32; 2] {
        self.size.unwrap_or([1024; 2])
    }

    fn maps(&self) -> Vec<&str> {
        match self.maps {
            Some(maps) => maps.iter().map(String::as_str).collect(),
            None => vec!["height", "normal", "albedo"],
        }
    }

    /// A Python program.
    fn python(&self, document: &Document) -> String {
        let text = document
            .text()
            .replace('\\', "\\\\")
            .replace("'''", "\\'\\'\\'");
        let maps: Vec<_> = self.maps().iter().map(|map| format!("{map:?}")).collect();
        let [width, height] = self.size();
        format!(
            "import dapple_textures as dt\n\nrecipe = dt.Recipe.from_toml('''\n{text}''')\n\
             maps = recipe.bake({width}, {height}, maps=[{}])\n",
            maps.join(", ")
        )
    }

    /// A command line for a shell.
    fn command(&self, document: &Document, recipe: &Recipe) -> String {
        let builtin = Recipe::builtin_names()
            .find(|name| Recipe::builtin_text(name).is_ok_and(|text| text == document.text()));
        let own = format!(
            "{}.toml",
            if recipe.name.is_empty() {
                "recipe"
            } else {
                &recipe.name
            }
        );
        let name = match (builtin, self.name) {
            (Some(name), "") => name.to_owned(),
            (_, "") => own,
            (_, file) => file.to_owned(),
        };
        let [width, height] = self.size();
        let maps = self.maps().join(",");
        let folder = if recipe.name.is_empty() {
            "out"
        } else {
            &recipe.name
        };
        let folder = quoted(&format!("{folder}/"));
        format!(
            "dapple bake {} --size {width}x{height} --maps {maps} -o {folder}\n",
            quoted(&name)
        )
    }
}

/// A word for a shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    if !word.is_empty() && !word.starts_with('-') && word.chars().all(is_plain) {
        return word.to_owned();
    }
    let word = if word.starts_with('-') {
        format!("./{word}")
    } else {
        word.to_owned()
    };
    format!("'{}'", word.replace('\'', r"'\''"))
}
