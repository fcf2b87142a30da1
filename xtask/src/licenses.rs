//! `cargo xtask licenses`: collects the license texts of third-party crates, which are shipped with the command and the
//! wheel.
//!
//! The texts are copied from the packages in Cargo's local cache. This needs no network and no compilation, so CI can
//! compare the complete files. cargo-about finds licenses in the same files, but takes minutes to compile.

use anyhow::{Context, bail};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use xshell::{Shell, cmd};

/// The shipped packages: manifest, package name, and output file.
const SHIPPED: [(&str, &str, &str); 2] = [
    (
        "Cargo.toml",
        "dapple-cli",
        "crates/dapple-cli/THIRD-PARTY.txt",
    ),
    (
        "crates/dapple-python/Cargo.toml",
        "dapple-python",
        "crates/dapple-python/THIRD-PARTY.txt",
    ),
];

const HEAD: &str = "\
Licenses of the crates of other people in this program.
Made by `cargo xtask licenses` from the packages that Cargo.lock names; not edited by hand.
Where a crate may be used under one of several licenses, it is used under that of MIT.
";

const RULE: &str =
    "================================================================================";

/// The text of the MIT license, for packages that name it but have no license file.
const MIT: &str = "\
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated
documentation files (the \"Software\"), to deal in the Software without restriction, including without limitation the
rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit
persons to whom the Software is furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or substantial portions of the
Software.

THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE
WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR
COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR
OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
";

/// Writes the files, or compares them.
pub(crate) fn licenses(shell: &Shell, check: bool) -> anyhow::Result<()> {
    for (manifest, package, file) in SHIPPED {
        let json = cmd!(
            shell,
            "cargo metadata --format-version 1 --locked --manifest-path {manifest}"
        );
        let metadata = serde_json::from_str(&json.quiet().read()?)?;
        let shipped = shipped(shell, manifest, &metadata, package)?;
        let text = texts(shell, &shipped).with_context(|| package.to_owned())?;
        if !check {
            shell.write_file(file, text)?;
        } else if shell.read_file(file).ok().as_deref() != Some(&text) {
            bail!("{file} is not that of Cargo.lock: run `cargo xtask licenses`");
        }
    }
    Ok(())
}

/// Returns the text of the license file for these packages. It has each license text once, preceded by the names of the
/// crates that use it.
fn texts(shell: &Shell, shipped: &[&Value]) -> anyhow::Result<String> {
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in shipped {
        let of = |key: &str| package[key].as_str().unwrap_or_default();
        let line = format!(
            "{} {}  {}  {}",
            of("name"),
            of("version"),
            of("license"),
            of("repository")
        );
        let text = license(shell, package).with_context(|| line.clone())?;
        texts
            .entry(text)
            .or_default()
            .push(line.trim_end().to_owned());
    }
    let mut texts: Vec<_> = texts.into_iter().collect();
    texts.sort_by(|(_, a), (_, b)| a.cmp(b));
    let mut all = HEAD.to_owned();
    for (text, crates) in texts {
        all += &format!("\n{RULE}\n{}\n\n{text}\n", crates.join("\n"));
    }
    Ok(all)
}

/// Returns the registry packages compiled into `root` on any platform, sorted by name and version. Unlike the metadata,
/// the tree leaves out features that only other members of the workspace enable.
fn shipped<'a>(
    shell: &Shell,
    manifest: &str,
    metadata: &'a Value,
    root: &str,
) -> anyhow::Result<Vec<&'a Value>> {
    let tree = cmd!(
        shell,
        "cargo tree --locked --manifest-path {manifest} --package {root} --edges normal --target all --prefix none"
    );
    let tree = tree.quiet().read()?;
    // A line begins with a name and a version, such as `serde v1.0.0`.
    let in_tree: BTreeSet<_> = tree
        .lines()
        .filter_map(|line| line.split_once(" v"))
        .map(|(name, rest)| (name, rest.split(' ').next().unwrap_or(rest)))
        .collect();
    let key = |package: &'a Value| Some((package["name"].as_str()?, package["version"].as_str()?));
    let mut shipped: Vec<_> = metadata["packages"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(|package| !package["source"].is_null())
        .filter(|&package| key(package).is_some_and(|key| in_tree.contains(&key)))
        .collect();
    shipped.sort_by_key(|&package| key(package));
    Ok(shipped)
}

/// Returns the license text of a package.
fn license(shell: &Shell, package: &Value) -> anyhow::Result<String> {
    let terms = package["license"].as_str().unwrap_or_default();
    let folder = Path::new(package["manifest_path"].as_str().unwrap_or_default());
    let mut files = license_files(shell, folder.parent().unwrap_or(folder))?;
    // If MIT is one of several alternatives, use it. With AND, keep all texts.
    let may_choose = terms.contains("MIT") && (terms.contains(" OR ") || terms.contains('/'));
    let is_mit = |path: &PathBuf| name(path).contains("mit");
    if may_choose && !terms.contains(" AND ") && files.iter().any(is_mit) {
        files.retain(is_mit);
    }
    let mut texts = Vec::new();
    for file in files {
        texts.push(plain(&shell.read_file(file)?));
    }
    if !texts.is_empty() {
        return Ok(texts.join("\n\n"));
    }
    // Without license files, compose the MIT license from the names of the authors.
    if !terms.contains("MIT") {
        bail!("the package has no license file");
    }
    let authors = package["authors"].as_array().into_iter().flatten();
    let authors: Vec<_> = authors.filter_map(Value::as_str).collect();
    let name = package["name"].as_str().unwrap_or_default();
    let holders = if authors.is_empty() {
        format!("the authors of {name}")
    } else {
        authors.join(", ")
    };
    Ok(plain(&format!(
        "MIT License\n\nCopyright (c) {holders}\n\n{MIT}"
    )))
}

/// Returns the license and notice files in the root of a package.
fn license_files(shell: &Shell, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let starts = [
        "license",
        "licence",
        "copying",
        "copyright",
        "notice",
        "unlicense",
    ];
    let mut files = shell.read_dir(folder)?;
    files.retain(|path| path.is_file() && starts.iter().any(|start| name(path).starts_with(start)));
    files.sort();
    Ok(files)
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().to_lowercase()
}

/// Returns a text with normalized line endings and without trailing white space, which differ between systems and
/// editors.
fn plain(text: &str) -> String {
    let lines: Vec<_> = text
        .trim_start_matches('\u{feff}')
        .lines()
        .map(str::trim_end)
        .collect();
    lines.join("\n").trim_matches('\n').to_owned()
}
