//! Finds out whether the page was built, and lists its files. Of a file that also exists compressed, only the
//! compressed version is listed.

#![expect(
    clippy::disallowed_methods,
    reason = "the files of the page are found before there is a program"
)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let dist = root.join("dist");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", dist.display());
    let mut files = Vec::new();
    list(&dist, "", &mut files);
    files.sort();
    let is_compressed = |name: &str| {
        files
            .iter()
            .any(|(other, _)| *other == format!("{name}.gz"))
    };
    let embedded: Vec<_> = files
        .iter()
        .filter(|(name, _)| !is_compressed(name))
        .collect();
    let mut code = String::from("&[\n");
    for (name, path) in embedded {
        println!("cargo::rerun-if-changed={}", path.display());
        writeln!(
            code,
            "({name:?}, include_bytes!({:?})),",
            path.display().to_string()
        )
        .unwrap_or_default();
    }
    code.push(']');
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    fs::write(out.join("page.rs"), code)
        .unwrap_or_else(|error| panic!("the list of files cannot be written: {error}"));
}

/// Lists the files of a folder, each with its path in the page's addresses. Hidden files are left out.
fn list(folder: &Path, prefix: &str, files: &mut Vec<(String, PathBuf)>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if name.starts_with('.') {
            continue;
        }
        if entry.path().is_dir() {
            list(&entry.path(), &format!("{name}/"), files);
        } else {
            files.push((name, entry.path()));
        }
    }
}
