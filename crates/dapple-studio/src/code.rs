//! Converts a recipe to a program or to recipe text.

use crate::message::CodeKind;
use crate::{Document, StudioError};
use dapple::recipe::{Images, Recipe, ShaderOptions};

/// Options for converting a recipe to a program or to text.
pub(crate) struct Code<'a> {
    pub(crate) kind: CodeKind,
    pub(crate) size: Option<[u32; 2]>,
    pub(crate) maps: Option<&'a [String]>,
    /// The name of the recipe's file, or empty.
    pub(crate) name: &'a str,
}

impl Code<'_> {
    /// Returns the source of the program, or the recipe text.
    pub(crate) fn text(
        &self,
        document: &Document,
        recipe: &Recipe,
        images: &Images,
    ) -> Result<String, StudioError> {
        Ok(match self.kind {
            CodeKind::Toml => document.text().to_owned(),
            CodeKind::Json => recipe.to_json()? + "\n",
            CodeKind::Rust => recipe.to_rust()?,
            CodeKind::Python => self.python(document),
            CodeKind::Command => self.command(document, recipe),
            CodeKind::Wgsl => wgsl(recipe, images)?,
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

    /// Returns a Python program that bakes the recipe.
    fn python(&self, document: &Document) -> String {
        let text = document
            .text()
            .replace('\\', "\\\\")
            .replace("'''", "\\'\\'\\'");
        let maps: Vec<_> = self.maps().iter().map(|map| format!("{map:?}")).collect();
        let [width, height] = self.size();
        let size = if width == height {
            width.to_string()
        } else {
            // Array shapes list rows first.
            format!("({height}, {width})")
        };
        format!(
            "import dapple_textures as dp\n\nrecipe = dp.Recipe.from_toml('''\\\n{text}''')\n\
             maps = recipe.plan().bake({size}, [{}])\n",
            maps.join(", ")
        )
    }

    /// Returns a shell command that bakes the recipe.
    fn command(&self, document: &Document, recipe: &Recipe) -> String {
        // Name the recipe by its file, by its built-in name if the text is unchanged, or by a file to be saved.
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

/// Returns the material as a WGSL function. Comments list the textures that it reads.
fn wgsl(recipe: &Recipe, images: &Images) -> Result<String, StudioError> {
    let shader = recipe.to_wgsl(images, &ShaderOptions { textures: true })?;
    let mut text = String::new();
    if !shader.textures.is_empty() {
        let nodes: Vec<_> = shader
            .textures
            .iter()
            .map(|node| format!("{node:?}"))
            .collect();
        text += &format!("// Bake these nodes to textures: {}\n", nodes.join(", "));
    }
    if !shader.data.is_empty() {
        text +=
            "// `dapple recipe RECIPE --wgsl --textures -o FILE` also writes the texture `data`.\n";
    }
    Ok(text + &shader.wgsl)
}

/// Quotes a word for a shell.
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

#[cfg(test)]
mod tests {
    use super::Code;
    use crate::Document;
    use crate::message::CodeKind;
    use dapple::recipe::{Images, Recipe, ShaderOptions};

    fn code(kind: CodeKind, text: &str, name: &str) -> String {
        let document = Document::new(text);
        let maps = ["height".to_owned(), "ao".to_owned()];
        let (size, maps) = (Some([64, 32]), Some(&maps[..]));
        let code = Code {
            kind,
            size,
            maps,
            name,
        };
        let recipe = document.recipe().unwrap();
        code.text(&document, recipe, &Images::new()).unwrap()
    }

    #[test]
    fn a_command_bakes_the_recipe_into_a_folder() {
        let flagstone = Recipe::builtin_text("flagstone").unwrap();
        let options = "--size 64x32 --maps height,ao -o";
        for (text, name, command) in [
            (
                flagstone,
                "",
                format!("dapple bake flagstone {options} flagstone/\n"),
            ),
            (
                flagstone,
                "mine.toml",
                format!("dapple bake mine.toml {options} flagstone/\n"),
            ),
            (
                "dapple = 1\n[material]\n",
                "",
                format!("dapple bake recipe.toml {options} out/\n"),
            ),
            (
                "dapple = 1\nname = \"it's; rm\"\n[material]\n",
                "-a b.toml",
                format!("dapple bake './-a b.toml' {options} 'it'\\''s; rm/'\n"),
            ),
        ] {
            assert_eq!(code(CodeKind::Command, text, name), command);
        }
    }

    #[test]
    fn a_shader_names_what_it_reads_from_textures() {
        let text = "dapple = 1\n[nodes]\nbumps.worley = { value = \"f4\" }\ncells.worley = {}\nswell.wavelet = {}\n\
                    sum.add = [\"bumps\", \"cells\", \"swell\"]\n[material]\nheight = \"sum\"\n";
        let wgsl = code(CodeKind::Wgsl, text, "");
        let options = ShaderOptions { textures: true };
        let recipe = Recipe::from_toml(text).unwrap();
        let shader = recipe.to_wgsl(&Images::new(), &options).unwrap();
        let comments = wgsl.strip_suffix(&shader.wgsl).unwrap();
        assert_eq!(
            comments,
            "// Bake these nodes to textures: \"bumps\"\n\
             // `dapple recipe RECIPE --wgsl --textures -o FILE` also writes the texture `data`.\n"
        );
        let local = "dapple = 1\n[nodes.cells.worley]\n[material]\nheight = \"cells\"\n";
        assert!(!code(CodeKind::Wgsl, local, "").contains("// Bake these"));
    }

    #[test]
    fn a_python_program_holds_the_text_whatever_is_in_it() {
        let text = "dapple = 1\nabout = '''a \\ b'''\n[material]\n";
        let python = code(CodeKind::Python, text, "");
        let held =
            "from_toml('''\\\ndapple = 1\nabout = \\'\\'\\'a \\\\ b\\'\\'\\'\n[material]\n''')";
        assert!(python.contains(held), "{python}");
        assert!(
            python.ends_with("recipe.plan().bake((32, 64), [\"height\", \"ao\"])\n"),
            "{python}"
        );
        assert_eq!(code(CodeKind::Toml, text, ""), text);
    }
}
