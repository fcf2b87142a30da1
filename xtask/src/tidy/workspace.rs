//! Reads the data that the rules check: the output of `cargo metadata` and the texts of files.

use anyhow::{Context, anyhow};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use xshell::{Shell, cmd};

/// The members of the workspace and the texts that the rules check.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    /// The packages, one per member.
    pub(crate) members: Vec<Member>,
    /// The layers by crate name, from `[workspace.metadata.layers]`.
    pub(crate) layers: BTreeMap<String, u64>,
    /// Every `.rs` file of the members.
    pub(crate) sources: Vec<Text>,
    /// The text of `ARCHITECTURE.md`.
    pub(crate) architecture: String,
    /// The text of `crates/dapple-gallery/figures.lock`.
    pub(crate) figures_lock: String,
}

/// A package of the workspace.
#[derive(Clone, Debug, Default)]
pub(crate) struct Member {
    /// The name of the package.
    pub(crate) name: String,
    /// The path of its folder from the root, with forward slashes.
    pub(crate) folder: String,
    /// The text of its manifest.
    pub(crate) manifest: String,
    /// The names of its normal and build dependencies, inside and outside the workspace.
    pub(crate) dependencies: Vec<String>,
    /// Its features, each with the features that it enables.
    pub(crate) features: BTreeMap<String, Vec<String>>,
    /// Whether the package is published to a registry.
    pub(crate) published: bool,
    /// The names of the files directly in its folder, sorted.
    pub(crate) files: Vec<String>,
}

/// A text file of the workspace.
#[derive(Clone, Debug, Default)]
pub(crate) struct Text {
    /// The path from the root, with forward slashes.
    pub(crate) path: String,
    /// The contents of the file.
    pub(crate) text: String,
}

impl Workspace {
    /// Reads the workspace in the shell's current folder. Missing files give empty texts.
    pub(crate) fn read(shell: &Shell) -> anyhow::Result<Self> {
        let json = cmd!(
            shell,
            "cargo metadata --format-version 1 --no-deps --offline"
        )
        .quiet()
        .read()?;
        let metadata: Value = serde_json::from_str(&json)?;
        let packages = list(&metadata["packages"]);
        let members: Vec<Member> = packages
            .iter()
            .map(|package| member(shell, package))
            .collect::<Result<_, _>>()?;
        let folders = members.iter().map(|member| member.folder.clone());
        Ok(Self {
            layers: layers(&metadata)?,
            sources: folders
                .map(|folder| sources(shell, &folder))
                .collect::<Result<Vec<_>, _>>()?
                .concat(),
            architecture: read_if_there(shell, "ARCHITECTURE.md")?,
            figures_lock: read_if_there(shell, "crates/dapple-gallery/figures.lock")?,
            members,
        })
    }
}

fn member(shell: &Shell, package: &Value) -> anyhow::Result<Member> {
    let manifest_path = PathBuf::from(text(&package["manifest_path"])?);
    let folder = manifest_path
        .parent()
        .context("a manifest without a folder")?;
    let dependencies = list(&package["dependencies"])
        .iter()
        .filter(|dependency| dependency["kind"] != "dev");
    let features = package["features"].clone();
    Ok(Member {
        name: text(&package["name"])?,
        folder: from_root(shell, folder),
        manifest: shell.read_file(&manifest_path)?,
        dependencies: dependencies
            .map(|dependency| text(&dependency["name"]))
            .collect::<Result<_, _>>()?,
        features: serde_json::from_value(features)?,
        published: package["publish"].is_null(),
        files: files(shell, folder)?,
    })
}

/// Returns the names of the files and folders directly in a folder, sorted.
fn files(shell: &Shell, folder: &Path) -> anyhow::Result<Vec<String>> {
    let paths = shell.read_dir(folder)?;
    let name = |path: &PathBuf| Some(path.file_name()?.to_string_lossy().into_owned());
    Ok(paths.iter().filter_map(name).collect())
}

fn layers(metadata: &Value) -> anyhow::Result<BTreeMap<String, u64>> {
    let table = metadata["metadata"]["layers"].as_object();
    let table = table.context("Cargo.toml has no [workspace.metadata.layers]")?;
    let layer = |(name, layer): (&String, &Value)| {
        let layer = layer
            .as_u64()
            .with_context(|| format!("the layer of {name} is no whole number"))?;
        Ok((name.clone(), layer))
    };
    table.iter().map(layer).collect()
}

/// Returns every `.rs` file below a folder, sorted by path.
fn sources(shell: &Shell, folder: &str) -> anyhow::Result<Vec<Text>> {
    let mut found = Vec::new();
    let mut folders = vec![shell.current_dir().join(folder)];
    while let Some(folder) = folders.pop() {
        for path in shell.read_dir(&folder)? {
            if path.is_dir() && !path.ends_with("target") {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = shell.read_file(&path)?;
                found.push(Text {
                    path: from_root(shell, &path),
                    text,
                });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(found)
}

fn read_if_there(shell: &Shell, path: &str) -> anyhow::Result<String> {
    if shell.path_exists(path) {
        Ok(shell.read_file(path)?)
    } else {
        Ok(String::new())
    }
}

/// Returns a path relative to the root, with forward slashes.
fn from_root(shell: &Shell, path: &Path) -> String {
    let root = shell.current_dir();
    path.strip_prefix(&root)
        .unwrap_or(path)
        .to_string_lossy()
        .replace('\\', "/")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value) -> anyhow::Result<String> {
    let text = value
        .as_str()
        .ok_or_else(|| anyhow!("`cargo metadata` has {value} in the place of a text"))?;
    Ok(text.to_owned())
}
