//! The folder of the recipes: what may be read and written there, and nothing else.

#![expect(
    clippy::disallowed_methods,
    reason = "recipes are read here, from their folder alone"
)]

use super::page::content_type;
use crate::StudioError;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse as _, Response};
use dapple::recipe::{MAX_TEXT, Recipe};
use sha2::{Digest as _, Sha256};
use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};

/// A folder, without what links in it lead to elsewhere.
pub(super) struct Folder {
    path: PathBuf,
}

/// The most recipes that are listed.
const MOST_RECIPES: usize = 500;
/// The endings of images.
const IMAGES: [&str; 4] = ["png", "exr", "jpg", "jpeg"];
/// The most bytes of an image that a page may see.
const MOST_IMAGE_BYTES: u64 = 1 << 28;

impl Folder {
    pub(super) fn new(path: &Path) -> Result<Self, StudioError> {
        let path = if path.as_os_str().is_empty() {
            Path::new(".")
        } else {
            path
        };
        let path = path.canonicalize();
        let path = path.map_err(|error| {
            StudioError::new(format!("the folder of the recipe cannot be read: {error}"))
        })?;
        Ok(Self { path })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The names of the recipes.
    pub(super) fn recipes(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<_> = names
            .filter(|name| name.ends_with(".toml"))
            .take(4 * MOST_RECIPES)
            .collect();
        names.sort();
        // Other programs have files in TOML, too.
        let is_recipe = |name: &String| {
            self.read(name)
                .is_ok_and(|(text, _)| text.contains("dapple"))
        };
        names
            .into_iter()
            .filter(is_recipe)
            .take(MOST_RECIPES)
            .collect()
    }

    /// The text and the hash of a recipe.
    pub(super) fn read(&self, name: &str) -> Result<(String, String), StudioError> {
        let path = self.inside(Path::new(name))?;
        let cannot = |error: &dyn std::fmt::Display| {
            StudioError::new(format!("{name} cannot be read: {error}"))
        };
        let mut bytes = Vec::new();
        let file = File::open(path).map_err(|error| cannot(&error))?;
        file.take(MAX_TEXT as u64 + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| cannot(&error))?;
        if bytes.len() > MAX_TEXT {
            return Err(StudioError::new(format!("{name} is larger than 4 MiB")));
        }
        let hash = hash(&bytes);
        let text =
            String::from_utf8(bytes).map_err(|_| StudioError::new(format!("{name} is no text")))?;
        Ok((text, hash))
    }

    /// Writes a recipe, if the file there is still the one that was seen, and gives its hash.
    pub(super) fn save(
        &self,
        name: &str,
        text: &str,
        seen: Option<&str>,
        overwrite: bool,
    ) -> Result<String, StudioError> {
        let is_plain = |c: char| c.is_alphanumeric() || " _-.".contains(c);
        let is_name =
            name.ends_with(".toml") && !name.starts_with('.') && name.chars().all(is_plain);
        if !is_name || name.len() > 200 {
            let error = StudioError::new(format!("{name:?} is no name for a recipe"));
            return Err(
                error.with_hint("take letters, digits, `_` and `-`, and let it end in .toml")
            );
        }
        if text.len() > MAX_TEXT {
            return Err(StudioError::new("the text is longer than 4 MiB"));
        }
        let path = self.path.join(name);
        if let Ok(found) = fs::symlink_metadata(&path) {
            if !found.is_file() {
                return Err(StudioError::new(format!(
                    "{name} is no file that can be replaced"
                )));
            }
            let (_, hash) = self.read(name)?;
            if !overwrite && seen != Some(&hash) {
                let message = format!("{name} has changed since it was read, or is there already");
                return Err(StudioError::new(message).with_reason("changed_on_disk"));
            }
        }
        dapple::image::replace(&path, text.as_bytes())
            .map_err(|error| StudioError::new(format!("{name} cannot be written: {error}")))?;
        Ok(hash(text.as_bytes()))
    }

    /// Refuses a recipe that names images outside of the folder.
    pub(super) fn check_images(&self, recipe: &Recipe) -> Result<(), StudioError> {
        for file in recipe.image_files() {
            check_ending(file)?;
            self.inside(Path::new(file))?;
        }
        Ok(())
    }

    /// When the images of a recipe were written last, to know whether they have changed.
    pub(super) fn image_times(
        &self,
        recipe: &Recipe,
    ) -> Vec<(String, Option<std::time::SystemTime>)> {
        let time = |file: &str| {
            fs::metadata(self.path.join(file))
                .and_then(|data| data.modified())
                .ok()
        };
        recipe
            .image_files()
            .into_iter()
            .map(|file| (file.to_owned(), time(file)))
            .collect()
    }

    /// An image, for the page.
    pub(super) fn image(&self, address: &str) -> Response {
        let read = || {
            let name = decoded(address)?;
            check_ending(&name).ok()?;
            let path = self.inside(Path::new(&name)).ok()?;
            if fs::metadata(&path).ok()?.len() > MOST_IMAGE_BYTES {
                return None;
            }
            Some((content_type(&name), fs::read(path).ok()?))
        };
        match read() {
            Some((kind, bytes)) => ([(CONTENT_TYPE, kind)], bytes).into_response(),
            None => StatusCode::NOT_FOUND.into_response(),
        }
    }

    /// The path of a file in the folder, wherever links lead.
    fn inside(&self, file: &Path) -> Result<PathBuf, StudioError> {
        let outside = || {
            StudioError::new(format!(
                "{} is not in the folder of the recipe",
                file.display()
            ))
        };
        let is_within = file
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !is_within || file.as_os_str().is_empty() {
            return Err(outside());
        }
        let path = self.path.join(file).canonicalize();
        let path = path.map_err(|error| {
            StudioError::new(format!("{} cannot be read: {error}", file.display()))
        })?;
        let is_file = path.starts_with(&self.path) && path.is_file();
        if is_file { Ok(path) } else { Err(outside()) }
    }
}

fn check_ending(name: &str) -> Result<(), StudioError> {
    let ending = name
        .rsplit_once('.')
        .map_or("", |(_, ending)| ending)
        .to_ascii_lowercase();
    if IMAGES.contains(&ending.as_str()) {
        return Ok(());
    }
    Err(StudioError::new(format!(
        "{name} is no image that can be read: PNG, JPEG or OpenEXR"
    )))
}

fn hash(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The text of an address with percent signs.
pub(super) fn decoded(address: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = address.as_bytes();
    while let [first, after @ ..] = rest {
        if *first == b'%' {
            let code = std::str::from_utf8(after.get(..2)?).ok()?;
            bytes.push(u8::from_str_radix(code, 16).ok()?);
            rest = &after[2..];
        } else {
            bytes.push(*first);
            rest = after;
        }
    }
    String::from_utf8(bytes).ok()
}
