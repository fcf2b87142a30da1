//! Tests of the README's statements about the workspace.
#![expect(clippy::disallowed_methods, reason = "the workspace is made of files")]

use dapple_gallery::papers;
use std::fs;
use std::path::{Path, PathBuf};

const README: &str = include_str!("../../README.md");

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn readme_names_the_command_that_ci_tests_with() {
    let ci = fs::read_to_string(root().join(".ci/run")).expect(".ci/run is there");
    for command in ["cargo test --workspace", "cargo xtask gallery"] {
        assert!(
            README.lines().any(|line| line == command),
            "the README lacks `{command}`"
        );
    }
    assert!(
        ci.lines().any(|line| line == "cargo test --workspace"),
        ".ci/run does not test as the README says"
    );
}

#[test]
fn readme_lists_every_library_crate() {
    for entry in fs::read_dir(root().join("crates")).expect("the crates are there") {
        let name = entry
            .expect("the folder can be read")
            .file_name()
            .to_string_lossy()
            .into_owned();
        assert!(
            README.contains(&format!("[`{name}`](crates/{name})")),
            "the README does not list `{name}`"
        );
    }
}

#[test]
fn readme_links_lead_to_files() {
    let links = README
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next());
    for link in links.filter(|link| !link.starts_with("http")) {
        assert!(
            root().join(link).exists(),
            "the README links to {link}, which is not there"
        );
    }
}

#[test]
fn papers_of_the_gallery_have_figures_under_their_own_key() {
    for paper in papers() {
        for figure in paper.figures {
            let name = figure.name();
            assert!(
                name.starts_with(&format!("{}-fig-", paper.key)),
                "{name} is in the list of `{}`",
                paper.key
            );
        }
    }
}
