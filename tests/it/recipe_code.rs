//! Checks a Rust program generated from a recipe: the file equals the output of `Recipe::to_rust`, it compiles, and
//! it reproduces the bits of the recipe's maps.
//!
//! `DAPPLE_BLESS=1 cargo test -p dapple-tests recipe_code` rewrites the file.
#![expect(clippy::disallowed_methods, reason = "the program lies in a file")]

use dapple::recipe::{Bake, BakeOptions, Images, MapKind, Plan, Recipe};
use std::path::Path;

#[rustfmt::skip]
#[expect(dead_code, unreachable_pub, reason = "it is a program of its own")]
mod flagstone;

#[test]
fn recipe_code_is_current() {
    let code = Recipe::builtin("flagstone").unwrap().to_rust().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("it/recipe_code/flagstone.rs");
    if std::env::var_os("DAPPLE_BLESS").is_some() {
        std::fs::write(&path, &code).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == code, "{} is not current", path.display());
}

#[test]
fn recipe_code_has_the_bits_of_the_recipe() {
    let (size, maps) = ([64, 48], vec![MapKind::Height, MapKind::Albedo]);
    let baked = flagstone::bake(size, maps.clone(), &Images::new()).unwrap();
    let recipe = Recipe::builtin("flagstone").unwrap();
    let plan = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
    let options = BakeOptions {
        size,
        maps,
        ..BakeOptions::default()
    };
    let expected = Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
    assert_eq!(baked, expected, "height and albedo");
}
