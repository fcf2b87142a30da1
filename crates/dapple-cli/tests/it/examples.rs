//! Tests that the examples of the help run.

#![cfg(unix)]

use crate::support::{Folder, assert_done, stdout};
use std::fs;

const SUBCOMMANDS: [&str; 22] = [
    "bake",
    "watch",
    "studio",
    "shards",
    "join",
    "recipe",
    "worley",
    "pups",
    "noise",
    "wavelet",
    "wgsl",
    "tile",
    "photo",
    "copies",
    "blend",
    "blend-map",
    "synth",
    "points",
    "info",
    "completions",
    "man",
    "licenses",
];

/// Returns the commands in a help text. A backslash at the end of a line joins it with the next one.
fn examples(help: &str) -> Vec<String> {
    let help = help.replace("\\\n", " ");
    let lines = help.lines().map(str::trim);
    lines
        .filter(|line| line.starts_with("dapple ") && !line.starts_with("dapple help"))
        .map(str::to_owned)
        .collect()
}

/// Returns the help of a subcommand, wide enough for every example to be one line.
fn help(folder: &Folder, subcommand: &[&str]) -> String {
    let arguments = [subcommand, &["--help"]].concat();
    let output = folder.run(&arguments);
    assert_done(&output, "help");
    stdout(&output)
}

/// Returns an example with smaller maps and fewer sites, frames and variants, so that it runs faster.
fn quick(example: &str) -> String {
    let fewer = [
        ("--sites 4000", "--sites 400"),
        ("--frames 24", "--frames 2"),
        ("--flipbook 6x4", "--flipbook 2x1"),
        ("--seed 1-20", "--seed 1-2"),
    ];
    let example = (fewer.into_iter()).fold(example.to_owned(), |example, (many, few)| {
        example.replace(many, few)
    });
    if example.starts_with("dapple bake ") && !example.contains("--size") {
        return example + " --size 128";
    }
    example.replace("--size 2048", "--size 256")
}

/// Runs each example of a help text in a separate folder: the first unchanged, the others made faster by [`quick`].
fn run_examples(subcommand: &[&str]) {
    let name = subcommand.first().copied().unwrap_or("dapple");
    let folder = Folder::new(&format!("help-{name}"));
    let examples = examples(&help(&folder, subcommand));
    assert!(!examples.is_empty(), "{name} has examples");
    for (index, example) in examples.iter().enumerate() {
        let folder = Folder::with_inputs(&format!("example-{name}-{index}"));
        // The output of one example may be the input of another.
        let output = example.split_once(" -o ").map_or("", |(_, rest)| rest);
        let output = output.split_whitespace().next().unwrap_or("none");
        let _ = fs::remove_file(folder.path(output));
        let example = if index == 0 {
            example.clone()
        } else {
            quick(example)
        };
        assert_done(&folder.shell(&example), &example);
    }
}

#[test]
fn examples_of_the_help_run() {
    run_examples(&[]);
}

#[test]
fn examples_of_bake_and_recipe_run() {
    run_examples(&["bake"]);
    run_examples(&["recipe"]);
}

#[test]
fn examples_of_shards_and_join_run() {
    run_examples(&["shards"]);
    run_examples(&["join"]);
}

#[test]
fn examples_of_fields_run() {
    run_examples(&["worley"]);
    run_examples(&["pups"]);
    run_examples(&["noise"]);
    run_examples(&["wavelet"]);
}

#[test]
fn examples_of_wgsl_run() {
    run_examples(&["wgsl"]);
}

#[test]
fn examples_of_tile_run() {
    run_examples(&["tile"]);
    run_examples(&["photo"]);
}

#[test]
fn examples_of_copies_run() {
    run_examples(&["copies"]);
}

#[test]
fn examples_of_blend_run() {
    run_examples(&["blend"]);
    run_examples(&["blend-map"]);
}

#[test]
fn examples_of_synth_run() {
    run_examples(&["synth"]);
}

#[test]
fn examples_of_points_run() {
    run_examples(&["points"]);
}

#[test]
fn examples_of_info_completions_and_man_run() {
    run_examples(&["info"]);
    run_examples(&["completions"]);
    run_examples(&["man"]);
}

#[test]
fn licenses_name_every_crate_and_its_terms() {
    run_examples(&["licenses"]);
    let folder = Folder::new("licenses");
    let output = folder.run(&["licenses"]);
    assert_done(&output, "licenses");
    let text = stdout(&output);
    // Crates under several kinds of terms, and on several systems.
    for part in [
        "\nserde 1.",
        "\nlebe 0.",
        "\nwindows-sys 0.",
        "Permission is hereby granted, free of charge",
        "Redistributions in binary form must reproduce",
    ] {
        assert!(text.contains(part), "{part}");
    }
}

#[test]
fn every_subcommand_is_in_the_help_and_has_a_page() {
    let folder = Folder::new("all");
    let text = help(&folder, &[]);
    let listed = text.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed = listed.take_while(|line| !line.is_empty());
    // Continued lines are indented further.
    let listed = listed.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = listed.filter_map(|line| line.split_whitespace().next());
    let names: Vec<_> = names.filter(|name| *name != "help").collect();
    assert_eq!(names, SUBCOMMANDS, "the tests know them all");
    assert_done(&folder.run(&["man", "-o", "pages/"]), "man");
    for name in names {
        let page = fs::read_to_string(folder.path(&format!("pages/dapple-{name}.1"))).unwrap();
        assert!(page.contains("Exit codes"), "{name}");
        assert!(
            page.contains("dapple\\-") || page.contains("dapple "),
            "{name}"
        );
    }
}

#[test]
fn every_shell_gets_completions() {
    let folder = Folder::new("shells");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = folder.run(&["completions", shell]);
        assert_done(&output, shell);
        assert!(stdout(&output).contains("blend-map"), "{shell}");
    }
}
