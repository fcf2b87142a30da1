//! Tests of the Rust program that is exported from a recipe.

use dapple_recipe::Recipe;

/// Returns the recipe that an exported program contains as text.
fn held(code: &str) -> Recipe {
    let (_, text) = code.split_once("const RECIPE: &str = r").unwrap();
    let marks = &text[..text.find('"').unwrap()];
    let text = text[marks.len() + 1..].trim_end();
    let text = text.strip_suffix(&format!("\"{marks};")).unwrap();
    assert!(
        !text.contains(&format!("\"{marks}")),
        "the text ends where it should"
    );
    Recipe::from_toml(text).unwrap()
}

#[test]
fn a_program_holds_the_recipe() {
    let colored = "dapple = 1\n[nodes]\na = { color = \"#123456\" }\n[material]\nheight = 0\nalbedo = \"a\"\n";
    let texts = Recipe::builtin_names().map(|name| Recipe::builtin_text(name).unwrap());
    for text in texts.chain([colored]) {
        let recipe = Recipe::from_toml(text).unwrap();
        let held = held(&recipe.to_rust().unwrap()).to_toml().unwrap();
        assert_eq!(held, recipe.to_toml().unwrap(), "{}", recipe.name);
    }
}
