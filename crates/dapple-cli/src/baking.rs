//! Recipes drawn: bands of maps, each map into a file of its own.

use crate::encode::Format;
use crate::error::Hint;
use crate::input;
use crate::job::Job;
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use crate::words::with_dashes;
use anyhow::{Context as _, Error, Result};
use dapple::image::{Content, RowWriter};
use dapple::recipe::{
    Bake, Images, MapKind, MapRows, Picture, Recipe, RecipeError, RecipeErrorKind,
};
use dapple::tile::Map;
use rayon::prelude::*;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

/// A file for a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapFile {
    pub(crate) kind: MapKind,
    pub(crate) output: OutputIdx,
    pub(crate) format: Format,
}

/// A recipe, from a file, from standard input (`-`), or by the name of a built-in one, with the folder of its images.
///
/// # Errors
///
/// If there is none, or it cannot be read, with what was perhaps meant.
pub(crate) fn read_recipe(name: &str) -> Result<(Recipe, &Path)> {
    let path = Path::new(name);
    let builtin = with_dashes(name);
    let is_builtin = Recipe::builtin_names().any(|known| known == builtin);
    let looks_like_a_path =
        path.extension().is_some() || path.components().count() > 1 || name == "-";
    if is_builtin && !path.is_file() {
        return Ok((Recipe::builtin(&builtin).map_err(advise)?, Path::new("")));
    }
    if !looks_like_a_path && !path.exists() {
        let error = Recipe::builtin(&builtin).map(drop).map_err(advise);
        error.hint("`dapple recipe --list` names the built-in recipes; a recipe of your own ends in .toml or .json")?;
    }
    let text = input::text(path)?;
    let is_json = is_json(path) || (name == "-" && text.trim_start().starts_with('{'));
    let recipe = if is_json {
        Recipe::from_json(&text)
    } else {
        Recipe::from_toml(&text)
    };
    let mut recipe = recipe.map_err(advise).with_context(|| input::name(path))?;
    if recipe.name.is_empty() {
        recipe.name = path.file_stem().map_or_else(
            || "recipe".to_owned(),
            |stem| stem.to_string_lossy().into_owned(),
        );
    }
    Ok((recipe, path.parent().unwrap_or(Path::new(""))))
}

/// Whether a recipe in this file is one in JSON.
pub(crate) fn is_json(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

/// The images that a recipe names, from a folder.
///
/// # Errors
///
/// If one is not there, or cannot be read.
pub(crate) fn read_images(recipe: &Recipe, folder: &Path) -> Result<Images> {
    let mut images = Images::new();
    for file in recipe.image_files() {
        images.insert(file.to_owned(), read_picture(&folder.join(file))?);
    }
    Ok(images)
}

/// An image for a recipe.
///
/// # Errors
///
/// If it is not there, or cannot be read.
pub(crate) fn read_picture(path: &Path) -> Result<Picture> {
    Ok(match input::map(path, input::Kind::ByChannels, None)?.map {
        Map::Value(values) => Picture::Numbers(Arc::new(values)),
        Map::Color(colors) => Picture::Colors(Arc::new(colors)),
        Map::Normal(normals) => Picture::Numbers(Arc::new(normals.map(|normal| normal.z))),
    })
}

/// Draws the maps of a bake into files that were claimed.
///
/// # Errors
///
/// What the recipe or the operating system refuses.
pub(crate) fn write(job: &mut Job<'_>, bake: &mut Bake<'_>, files: &[MapFile]) -> Result<()> {
    let size = bake.size();
    let mut rows = Vec::new();
    for file in files {
        let (content, encoding) = (content(file.kind), file.format.encoding());
        rows.push(Rows {
            writer: RowWriter::new(job.writer(file.output)?, size, content, encoding)?,
            range: [f32::INFINITY, f32::NEG_INFINITY],
        });
    }
    let progress = Progress::bar("baking", size[1].into(), job.is_quiet());
    for band in bake {
        let band = band.map_err(advise)?;
        let height = band.maps.first().map_or(0, |(_, rows)| rows.size()[1]);
        let work = rows.par_iter_mut().zip(&band.maps);
        work.try_for_each(|(rows, (_, map))| rows.write(map))?;
        progress.set(u64::from(band.first_row) + u64::from(height));
    }
    for (rows, file) in rows.into_iter().zip(files) {
        rows.writer.finish()?.flush()?;
        job.note(file.output, file.format, size, rows.range);
    }
    Ok(())
}

/// The format of a map's file.
///
/// # Errors
///
/// As [`Format::choose`].
pub(crate) fn format(asked: Option<Format>, target: &Target) -> Result<Format> {
    Format::choose(asked, target, Format::Png16)
}

/// Adds what can be done about an error of a recipe.
pub(crate) fn advise(error: RecipeError) -> Error {
    let hint = match error.kind() {
        RecipeErrorKind::Global { .. } => {
            return Error::new(error)
                .hint("bake it without --banded")
                .wrong_value();
        }
        RecipeErrorKind::UnknownRecipe { .. } => return Error::new(error).wrong_value(),
        RecipeErrorKind::NoImage { .. } => "images lie in the folder of the recipe",
        RecipeErrorKind::Schema { .. } => "see the changelog for what has changed in recipes",
        _ => return error.into(),
    };
    Error::new(error).hint(hint)
}

/// A map on its way into a file.
struct Rows {
    writer: RowWriter<BufWriter<File>>,
    /// The smallest and the largest number so far.
    range: [f32; 2],
}

impl Rows {
    fn write(&mut self, map: &MapRows) -> Result<()> {
        match map {
            MapRows::Gray(raster) => self.writer.write_gray(raster.view())?,
            MapRows::Color(raster) => self.writer.write_color(raster.view())?,
            MapRows::Normal(raster) => self.writer.write_normals(raster.view())?,
            MapRows::Packed(raster) => self.writer.write_packed(raster.view())?,
        }
        self.range = map.range(self.range);
        Ok(())
    }
}

fn content(kind: MapKind) -> Content {
    match kind {
        MapKind::Normal => Content::Normal,
        MapKind::Albedo => Content::Color,
        MapKind::Orm => Content::Packed,
        _ => Content::Gray,
    }
}
