//! Checks that the documents for newcomers list every example. Every `cargo test` compiles the examples.
#![expect(clippy::disallowed_methods, reason = "the examples are files")]

use std::fs;
use std::path::Path;

const README: &str = include_str!("../../crates/dapple/README.md");

/// Returns the names and source texts of the examples, in order.
fn examples() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/dapple/examples");
    let mut examples = Vec::new();
    for entry in fs::read_dir(folder).expect("the examples are there") {
        let path = entry.expect("the folder can be read").path();
        if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.file_stem().expect("a name").to_string_lossy();
            let text = fs::read_to_string(&path).expect("an example is text");
            examples.push((name.into_owned(), text));
        }
    }
    examples.sort();
    examples
}

#[test]
fn examples_are_numbered_from_one() {
    for (number, (name, _)) in (1..).zip(examples()) {
        assert!(
            name.starts_with(&format!("{number:02}_")),
            "{name} is the example number {number}"
        );
    }
}

#[test]
fn examples_are_listed_in_the_readme_of_the_umbrella() {
    for (name, _) in examples() {
        assert!(
            README.contains(&format!("| [`{name}`](examples/{name}.rs) |")),
            "the README of `dapple` does not list {name}"
        );
    }
}

#[test]
fn examples_say_how_to_run_them() {
    for (name, text) in examples() {
        assert!(
            text.contains(&format!("//! cargo run -p dapple --example {name}\n")),
            "{name} does not say how to run it"
        );
    }
}
