//! Tests the section "How to add" of CONTRIBUTING.md: each row must name the few files that a new item of its kind
//! changes.

#![expect(clippy::disallowed_methods, reason = "sources are files")]

use crate::readme::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const CONTRIBUTING: &str = include_str!("../../CONTRIBUTING.md");

/// An existing item of a kind, whose files are counted.
struct Example {
    /// Start of the row in the section that describes the kind.
    row: &'static str,
    /// Words that stand for the item in code. Files that contain any of them are counted.
    words: &'static [&'static str],
    /// Text that replaces `NAME` in the row's file names.
    file: &'static str,
    /// Maximum number of files.
    most: usize,
}

const EXAMPLES: [Example; 7] = [
    Example {
        row: "a metric",
        words: &["Metric::Chebyshev", "Self::Chebyshev", "\"chebyshev\""],
        file: "",
        most: 2,
    },
    Example {
        row: "a texture of control points",
        words: &["ColorNoise", "color_noise"],
        file: "color_noise",
        most: 3,
    },
    Example {
        row: "a tiling method",
        words: &["Method::SoftCut", "struct SoftCut", "mod soft_cut"],
        file: "soft_cut",
        most: 3,
    },
    Example {
        row: "an image format",
        words: &["tga::", "Format::Tga", "Self::Tga", "mod tga;"],
        file: "tga",
        most: 3,
    },
    Example {
        row: "a mesh format",
        words: &["off::OFF", "mod off;", "const OFF:"],
        file: "off",
        most: 3,
    },
    Example {
        row: "a node of recipes",
        words: &["Wave(Wave)", "struct Wave {", "for Wave {", "mod wave;"],
        file: "wave",
        most: 2,
    },
    Example {
        row: "an option of all fields",
        words: &["match args.range {", "args.range.is_some()"],
        file: "",
        most: 1,
    },
];

#[test]
fn one_of_a_kind_stands_in_few_files_and_the_section_names_them() {
    let (_, section) = CONTRIBUTING
        .split_once("## How to add")
        .expect("there is the section");
    for example in &EXAMPLES {
        let row = section
            .lines()
            .find(|line| line.starts_with(&format!("| {} |", example.row)))
            .unwrap_or_else(|| panic!("no row for {}", example.row));
        let files = files_with(example.words);
        assert!(
            (1..=example.most).contains(&files.len()),
            "{} stands in {files:?}",
            example.row
        );
        for file in &files {
            let named = match example.file {
                "" => file.clone(),
                name => file.replace(&format!("/{name}.rs"), "/NAME.rs"),
            };
            assert!(
                row.contains(&format!("`{named}`")),
                "{}: {named}",
                example.row
            );
        }
    }
}

/// Returns the files of published crates whose code, without tests, contains one of the words.
fn files_with(words: &[&str]) -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    let unpublished = ["dapple-bench", "dapple-gallery", "dapple-models"];
    for entry in fs::read_dir(root().join("crates")).expect("the crates are there") {
        let folder = entry.expect("the folder can be read").path();
        if !unpublished.iter().any(|name| folder.ends_with(name)) {
            add_files(&folder.join("src"), words, &mut files);
        }
    }
    files
}

fn add_files(folder: &Path, words: &[&str], files: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the folder can be read").path();
        let is_test = ["tests", "tests.rs"]
            .iter()
            .any(|name| path.ends_with(name));
        if path.is_dir() && !is_test {
            add_files(&path, words, files);
        } else if path.extension().is_some_and(|ending| ending == "rs") && !is_test {
            let text = fs::read_to_string(&path).expect("the source can be read");
            let code = text
                .split("#[cfg(test)]\nmod tests {")
                .next()
                .unwrap_or_default();
            let mut lines = code
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            if lines.any(|line| words.iter().any(|word| line.contains(word))) {
                let name = path.strip_prefix(root()).expect("it is in the workspace");
                files.insert(name.to_string_lossy().replace('\\', "/"));
            }
        }
    }
}
