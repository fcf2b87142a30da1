//! Tests of `dapple bake --gpu` as a program: its files equal those of a bake on the CPU, and its errors.

#![expect(
    clippy::disallowed_methods,
    reason = "tests look at the files that the command writes"
)]

#[cfg(feature = "studio")]
mod pages;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Names of maps that together read all nodes of a material.
const MAPS: &str =
    "height,normal,ao,curvature,albedo,roughness,metallic,orm,emission,opacity,specular,clearcoat";

/// A recipe with nodes on the GPU, nodes on the CPU below and above them, and global nodes.
const ALL_STEPS: &str = r##"
dapple = 1
extent = [4.0, 3.0]
[nodes]
cells.worley = { frequency = 2.0, value = "f2_minus_f1" }
hills.noise = { basis = "gradient", frequency = 3.0 }
bumps.worley = { frequency = 2.0, value = "f4" }
sum.add = ["cells", "bumps"]
soft.blur = { input = "sum", radius = 0.2 }
even.equalize = { input = "hills" }
height.mix = { from = "soft", to = "even", by = "cells" }
color.ramp = { input = "height", colors = ["#204060", "#f0e0d0"], space = "linear" }
[material]
height = "height"
albedo = "color"
roughness = "cells"
"##;

/// Returns the command `dapple bake` in `folder`, with `words` as its arguments.
fn bake(folder: &Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dapple"));
    command
        .arg("bake")
        .args(words.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::null());
    command
}

fn run(mut command: Command) -> Output {
    command.output().expect("the command runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns the bytes of all maps in a directory and its subdirectories, by path. Sidecars are left out, because they
/// contain the directory's name.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            let inner = files(&entry.path());
            all.extend(
                inner
                    .into_iter()
                    .map(|(path, bytes)| (format!("{name}/{path}"), bytes)),
            );
        } else if !name.ends_with(".json") {
            all.insert(name, fs::read(entry.path()).expect("a file"));
        }
    }
    all
}

/// Runs a bake with `--gpu`. Returns `None` if there is no GPU adapter, unless `DAPPLE_NO_SKIP=1` is set.
#[expect(
    clippy::print_stdout,
    reason = "the output of a test says that it was skipped"
)]
fn on_gpu(folder: &Path, words: &str) -> Option<Output> {
    let output = run(bake(folder, &format!("{words} --gpu")));
    let message = stderr(&output);
    if !message.contains("no graphics adapter") {
        return Some(output);
    }
    let may_skip = std::env::var_os("DAPPLE_NO_SKIP").is_none_or(|value| value != "1");
    assert!(
        may_skip,
        "{message}; DAPPLE_NO_SKIP=1 lets nothing be skipped"
    );
    println!("skipped: {message}");
    None
}

/// Bakes on the CPU and on the GPU, and checks that all files have equal bytes.
fn compare(words: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("steps.toml"), ALL_STEPS).expect("a file");
    let Some(output) = on_gpu(folder.path(), &format!("{words} -o gpu/")) else {
        return;
    };
    assert!(output.status.success(), "{words}: {}", stderr(&output));
    let output = run(bake(folder.path(), &format!("{words} -o cpu/")));
    assert!(output.status.success(), "{words}: {}", stderr(&output));
    let [made, expected] = ["gpu", "cpu"].map(|name| files(&folder.path().join(name)));
    assert!(!expected.is_empty(), "{words}");
    let names: Vec<_> = made.keys().collect();
    assert_eq!(names, expected.keys().collect::<Vec<_>>(), "{words}");
    for (name, bytes) in &expected {
        assert!(made[name] == *bytes, "{words}: {name} differs");
    }
}

// lavapipe takes seconds to compile the shaders of a recipe, so these are few and small.

#[test]
fn bakes_have_the_bytes_of_the_cpu() {
    for recipe in ["giraffe", "marble"] {
        compare(&format!("{recipe} --size 48 --maps {MAPS}"));
    }
    compare(&format!("steps.toml --size 40x30 --maps {MAPS}"));
}

#[test]
fn bakes_with_other_options_have_the_bytes_of_the_cpu() {
    compare("steps.toml --size 40x30 --node height --samples corners --format r16");
    compare(
        "marble --size 64 --banded --region 5,7,40,33 --supersample 2 --maps height,albedo --seed 5",
    );
    compare("marble --size 64 --shard 1,0,32+4 --maps height");
    // The nodes move.
    compare("sea-water --size 32 --frames 2 --maps height,albedo");
}

#[test]
fn a_missing_adapter_is_an_error_with_a_hint() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = bake(folder.path(), "marble --size 16 -o out/ --gpu");
    // Vulkan's loader reads no list of drivers but these.
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(variable, folder.path().join("none.json"));
    }
    let output = run(command);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.starts_with("error: there is no graphics adapter"),
        "{message}"
    );
    assert!(message.contains("bake it without --gpu"), "{message}");
    assert!(files(folder.path()).is_empty(), "nothing is written");
}
