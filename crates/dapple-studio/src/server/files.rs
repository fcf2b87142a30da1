//! Restricts file access to the recipes and images of one folder.

#![expect(
    clippy::disallowed_methods,
    reason = "recipes are read here, from their folder alone"
)]

use super::ExportedFile;
use super::page::content_type;
use crate::StudioError;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse as _, Response};
use dapple::image::FileStamp;
use dapple::raster::text::decode;
use dapple::recipe::{MAX_TEXT, Recipe};
use sha2::{Digest as _, Sha256};
use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};
use toml_edit::DocumentMut;

/// A folder of recipes. Hidden files, and links to files outside of the folder, are excluded.
pub(super) struct Folder {
    path: PathBuf,
    /// The recipe that the user named on the command line. It is read and written without the checks of other files:
    /// its links may lead outside of the folder, and its text need not be a recipe.
    named: Option<String>,
}

/// Maximum number of listed recipes.
const MOST_RECIPES: usize = 500;
/// File extensions of images.
const IMAGES: [&str; 9] = [
    "png", "exr", "jpg", "jpeg", "tif", "tiff", "webp", "tga", "hdr",
];
/// Maximum size in bytes of an image sent to a page.
const MOST_IMAGE_BYTES: u64 = 1 << 28;

impl Folder {
    pub(super) fn new(path: &Path, named: Option<&str>) -> Result<Self, StudioError> {
        let path = if path.as_os_str().is_empty() {
            Path::new(".")
        } else {
            path
        };
        let path = path.canonicalize();
        let path = path.map_err(|error| {
            StudioError::new(format!("the folder of the recipe cannot be read: {error}"))
        })?;
        let named = named.map(str::to_owned);
        Ok(Self { path, named })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the names of the recipes in the folder, sorted.
    pub(super) fn recipes(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<_> = names
            .filter(|name| name.ends_with(".toml"))
            .take(4 * MOST_RECIPES)
            .collect();
        names.sort();
        names
            .into_iter()
            .filter(|name| self.read(name).is_ok())
            .take(MOST_RECIPES)
            .collect()
    }

    /// Reads a recipe. Returns its text without the byte order mark, and the hash of the file.
    pub(super) fn read(&self, name: &str) -> Result<(String, String), StudioError> {
        let path = self.recipe(name)?;
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
        let text = decode(&bytes).map_err(|error| cannot(&error))?;
        if !self.is_named(name) && !is_recipe(text) {
            return Err(no_recipe(name));
        }
        Ok((text.to_owned(), hash))
    }

    /// Writes a recipe if the file still has the hash `seen` or `overwrite` is set. Returns the new hash.
    pub(super) fn save(
        &self,
        name: &str,
        text: &str,
        seen: Option<&str>,
        overwrite: bool,
    ) -> Result<String, StudioError> {
        // Validate the name and the text.
        if !self.is_named(name) {
            check_name(name)?;
            if !is_recipe(text) {
                return Err(no_recipe("the text"));
            }
        }
        if text.len() > MAX_TEXT {
            return Err(StudioError::new("the text is longer than 4 MiB"));
        }
        let mut path = self.path.join(name);
        // Detect changes by other programs.
        if fs::symlink_metadata(&path).is_ok() {
            let (_, hash) = self.read(name)?;
            if !overwrite && seen != Some(&hash) {
                let message = format!("{name} has changed since it was read, or is there already");
                return Err(StudioError::new(message).with_reason("changed_on_disk"));
            }
            // Replace the target of a link, not the link.
            path = self.recipe(name)?;
            // The folder may allow a replacement that the permissions of the file forbid.
            if fs::metadata(&path).is_ok_and(|found| found.permissions().readonly()) {
                let hint = "make it writable, or save the recipe under another name";
                let error = StudioError::new(format!("{name} is read-only"));
                return Err(error.with_hint(hint));
            }
        }
        // Remove temporary files left behind by killed processes.
        dapple::image::remove_left_behind(&path);
        dapple::image::replace(&path, text.as_bytes())
            .map_err(|error| StudioError::new(format!("{name} cannot be written: {error}")))?;
        Ok(hash(text.as_bytes()))
    }

    /// Writes files into a subfolder, which is created if it is missing. Without `overwrite`, fails before anything is
    /// written if any of the files exists.
    pub(super) fn write(
        &self,
        to: &str,
        files: &[ExportedFile],
        overwrite: bool,
    ) -> Result<(), StudioError> {
        let is_plain = |c: char| c.is_alphanumeric() || " _-.".contains(c);
        let is_name = !to.is_empty() && !to.starts_with('.') && to.chars().all(is_plain);
        if !is_name || to.len() > 200 {
            let error = StudioError::new(format!("{to:?} is no name for a folder"));
            return Err(error.with_hint("take letters, digits, `_` and `-`"));
        }
        let cannot = |error: &dyn std::fmt::Display| {
            StudioError::new(format!("{to} cannot be written: {error}"))
        };
        let folder = self.path.join(to);
        fs::create_dir_all(&folder).map_err(|error| cannot(&error))?;
        // A link may lead elsewhere.
        let folder = folder.canonicalize().map_err(|error| cannot(&error))?;
        if folder.parent() != Some(&self.path) {
            return Err(cannot(&"it is not in the folder of the recipe"));
        }
        let is_there = |file: &&ExportedFile| fs::symlink_metadata(folder.join(&file.name)).is_ok();
        if !overwrite && let Some(file) = files.iter().find(is_there) {
            let message = format!("{to}/{} is there already", file.name);
            return Err(StudioError::new(message).with_reason("exists"));
        }
        for file in files {
            dapple::image::replace(&folder.join(&file.name), &file.bytes)
                .map_err(|error| cannot(&error))?;
        }
        Ok(())
    }

    /// Rejects a recipe that names images outside of the folder.
    pub(super) fn check_images(&self, recipe: &Recipe) -> Result<(), StudioError> {
        for file in recipe.image_files() {
            check_ending(file)?;
            self.inside(Path::new(file))?;
        }
        Ok(())
    }

    /// Returns the paths of a recipe's images with the stamps of their files. A file's stamp changes when the file
    /// does.
    pub(super) fn image_stamps(&self, recipe: &Recipe) -> Vec<(PathBuf, Option<FileStamp>)> {
        let files = self.image_paths(recipe).into_iter();
        files
            .map(|file| {
                let stamp = FileStamp::of(&file);
                (file, stamp)
            })
            .collect()
    }

    /// Returns the paths of the images of a recipe.
    pub(super) fn image_paths(&self, recipe: &Recipe) -> Vec<PathBuf> {
        let files = recipe.image_files().into_iter();
        files.map(|file| self.path.join(file)).collect()
    }

    /// Answers a request for an image.
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

    /// Returns whether `name` is the recipe that the user named.
    fn is_named(&self, name: &str) -> bool {
        self.named.as_deref() == Some(name)
    }

    /// Returns the path of a recipe, with links resolved.
    fn recipe(&self, name: &str) -> Result<PathBuf, StudioError> {
        if self.is_named(name) {
            let path = self.path.join(name).canonicalize();
            let path =
                path.map_err(|error| StudioError::new(format!("{name} cannot be read: {error}")))?;
            if path.is_file() {
                return Ok(path);
            }
        }
        if !name.ends_with(".toml") {
            return Err(no_recipe(name));
        }
        self.inside(Path::new(name))
    }

    /// Returns the path of a file in the folder, with links resolved. Hidden files and links to hidden files are
    /// rejected.
    fn inside(&self, file: &Path) -> Result<PathBuf, StudioError> {
        let outside = |why: &str| StudioError::new(format!("{} {why}", file.display()));
        let elsewhere = "is not in the folder of the recipe";
        let is_within = file
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !is_within || file.as_os_str().is_empty() {
            return Err(outside(elsewhere));
        }
        let path = self.path.join(file).canonicalize();
        let path = path.map_err(|error| {
            StudioError::new(format!("{} cannot be read: {error}", file.display()))
        })?;
        let Ok(within) = path.strip_prefix(&self.path) else {
            return Err(outside(elsewhere));
        };
        if is_hidden(file) || is_hidden(within) {
            return Err(outside("is hidden, or in a hidden folder"));
        }
        if path.is_file() {
            Ok(path)
        } else {
            Err(outside("is no file"))
        }
    }
}

/// Returns whether a component of a path begins with a dot.
fn is_hidden(path: &Path) -> bool {
    path.components()
        .any(|part| part.as_os_str().as_encoded_bytes().starts_with(b"."))
}

/// Returns whether a text is a recipe. A recipe has the key `dapple`, which TOML files of other programs lack. A text
/// that is not valid TOML, for example while it is being edited, needs a line with this key before its first table.
fn is_recipe(text: &str) -> bool {
    if let Ok(document) = text.parse::<DocumentMut>() {
        return document.contains_key("dapple");
    }
    let is_key = |line: &str| {
        let line = line.trim_start();
        line.strip_prefix("dapple")
            .is_some_and(|rest| rest.trim_start().starts_with('='))
    };
    text.lines()
        .take_while(|line| !line.trim_start().starts_with('['))
        .any(is_key)
}

fn no_recipe(name: &str) -> StudioError {
    StudioError::new(format!("{name} is no recipe"))
        .with_hint("a recipe is a file that ends in .toml and has `dapple = 1` at its top")
}

/// Rejects names for new recipes that are special to a system or a shell.
fn check_name(name: &str) -> Result<(), StudioError> {
    let is_plain = |c: char| c.is_alphanumeric() || " _-.".contains(c);
    let is_name = name.ends_with(".toml")
        && !name.starts_with('.')
        && name.chars().all(is_plain)
        && name.len() <= 200;
    let wrong = || StudioError::new(format!("{name:?} is no name for a recipe"));
    if !is_name {
        let hint = "take letters, digits, `_` and `-`, and let it end in .toml";
        return Err(wrong().with_hint(hint));
    }
    // Windows reserves these names for devices, with any extension.
    let stem = name.split('.').next().unwrap_or_default().trim_end();
    let stem = stem.to_ascii_uppercase();
    let is_numbered = ["COM", "LPT"].iter().any(|port| {
        let number = stem.strip_prefix(port);
        number.is_some_and(|number| number.chars().count() == 1 && number.parse::<u8>().is_ok())
    });
    if is_numbered || ["CON", "PRN", "AUX", "NUL"].contains(&stem.as_str()) {
        return Err(wrong().with_hint("Windows keeps this name for a device"));
    }
    Ok(())
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
        "{name} is no image that can be read: PNG, JPEG, OpenEXR, TIFF, WebP, TGA or Radiance HDR"
    )))
}

fn hash(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Decodes percent-encoding.
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
