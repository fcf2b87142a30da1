//! Bakes recipes band by band, and writes an image file for each map.

use crate::args::{FiniteArgs, ReadArgs};
use crate::encode::Format;
use crate::error::Hint;
use crate::input;
use crate::job::Job;
use crate::layers::{Image, LayerRows, Layers};
use crate::output::{OutputIdx, Sink, Target, cannot_be_written};
use crate::progress::Progress;
use crate::words::with_dashes;
use anyhow::{Context as _, Error, Result};
use dapple::image::RowWriter;
use dapple::raster::parallel;
use dapple::recipe::{
    Bake, Band, ImageAlpha, Images, Picture, Recipe, RecipeError, RecipeErrorKind,
};
use dapple::tile::Map;
use serde_json::{Value, json};
use std::io::{BufWriter, Cursor, Write};
use std::path::Path;
use std::sync::Arc;

/// Maximum number of pixels in a flipbook, or in a bake without `--banded`: 32768 × 32768.
pub(crate) const MOST_PIXELS: u64 = 1 << 30;

/// The file of a baked image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapFile {
    pub(crate) image: Image,
    pub(crate) output: OutputIdx,
    /// The file of a sheet of 2 × 2 copies of the image; `None` if no sheet is requested.
    pub(crate) sheet: Option<OutputIdx>,
}

/// Returns the recipe's name, seed and scale for the sidecar, for programs that read the maps. One unit of the plane is
/// one meter.
pub(crate) fn report(recipe: &Recipe) -> Value {
    json!({
        "name": recipe.name,
        "seed": recipe.seed.0,
        "extent": recipe.extent,
        "repeats": recipe.wrap,
        "relief": recipe.material.relief,
        "meters_per_unit": 1.0,
    })
}

/// Reads a recipe from a file, from standard input (`-`), or from the built-in recipes by its name. Returns the recipe
/// and the directory of its images.
///
/// # Errors
///
/// If no recipe has this name (the error suggests the nearest one), or if it cannot be read.
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

/// Returns whether a recipe file is in JSON, by its extension.
pub(crate) fn is_json(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

/// Reads the images of a recipe from a directory.
///
/// # Errors
///
/// If an image does not exist or cannot be read.
pub(crate) fn read_images(recipe: &Recipe, folder: &Path, finite: FiniteArgs) -> Result<Images> {
    let mut images = Images::new();
    let hint = "give its node alpha = \"drop\" or alpha = \"over:#rrggbb\"";
    for source in recipe.image_sources()? {
        let path = folder.join(source.file);
        input::check_regular(&path, "an image")?;
        let read = ReadArgs {
            layer: source.layer.map(str::to_owned),
            needs_layer: true,
            finite,
        };
        let picture = read_picture(&path, source.alpha, &read, hint)?;
        images.insert(source.key(), picture);
    }
    Ok(images)
}

/// Reads an image for a recipe.
///
/// # Errors
///
/// If the image does not exist or cannot be read, or if it is partly transparent and `alpha` is `None`. In the latter
/// case, the error has the given `hint`.
pub(crate) fn read_picture(
    path: &Path,
    alpha: Option<ImageAlpha>,
    read: &ReadArgs,
    hint: &str,
) -> Result<Picture> {
    let loaded = input::map(path, input::Kind::ByChannels, None, alpha, read, hint)?;
    Ok(match loaded.map {
        Map::Value(values) => Picture::Numbers(Arc::new(values)),
        Map::Color(colors) => Picture::Colors(Arc::new(colors)),
        Map::Normal(normals) => Picture::Numbers(Arc::new(normals.map(|normal| normal.z))),
    })
}

/// Writes the maps of a bake to claimed files, and reports progress in rows.
///
/// # Errors
///
/// If the recipe or the operating system reports an error.
pub(crate) fn write(
    job: &mut Job<'_>,
    bake: Bake<'_>,
    files: &[MapFile],
    progress: &Progress,
) -> Result<()> {
    let size = bake.size();
    let mut rows = Vec::new();
    for file in files {
        rows.push(Rows::new(job, file, size)?);
    }
    // Bake the lower half of a sheet a second time, instead of storing the upper half.
    let has_sheets = files.iter().any(|file| file.sheet.is_some());
    let again = has_sheets.then(|| bake.clone());
    draw(bake, &mut rows, progress, Rows::write)?;
    if let Some(again) = again {
        draw(again, &mut rows, progress, Rows::write_sheet)?;
    }
    finish(job, rows, files, size)
}

/// Finishes the image files, and records their properties in the job.
fn finish(job: &mut Job<'_>, rows: Vec<Rows>, files: &[MapFile], size: [u32; 2]) -> Result<()> {
    for (rows, file) in rows.into_iter().zip(files) {
        rows.map.finish()?;
        let format = file.image.format;
        job.note(file.output, format, size, rows.range);
        job.note_clipped(file.output, rows.n_clipped);
        if let (Some(writer), Some(sheet)) = (rows.sheet, file.sheet) {
            writer.finish()?;
            job.note(sheet, format, size.map(|side| 2 * side), rows.range);
        }
    }
    Ok(())
}

/// Writes images that are grids of equally large bakes, row of bakes by row of bakes.
pub(crate) struct GridWriter {
    rows: Vec<Rows>,
    /// Width and height of the images, in pixels.
    size: [u32; 2],
}

impl GridWriter {
    /// Begins the images, which are `size` pixels wide and high.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub(crate) fn new(job: &Job<'_>, files: &[MapFile], size: [u32; 2]) -> Result<Self> {
        let rows = files.iter().map(|file| Rows::new(job, file, size));
        Ok(Self {
            rows: rows.collect::<Result<_>>()?,
            size,
        })
    }

    /// Writes bakes as the next row of the grid, from left to right.
    ///
    /// # Errors
    ///
    /// If a recipe or the operating system reports an error.
    pub(crate) fn write(&mut self, mut bakes: Vec<Bake<'_>>, progress: &Progress) -> Result<()> {
        loop {
            let bands = bakes.iter_mut().filter_map(Iterator::next);
            let bands = bands.collect::<Result<Vec<_>, _>>().map_err(advise)?;
            let Some(first) = bands.first() else {
                return Ok(());
            };
            let n_rows = first.maps.first().map_or(0, |(_, rows)| rows.size()[1]);
            let written = parallel::map_mut_at_least(1, &mut self.rows, |_, rows| {
                let parts = bands.iter().map(|band| rows.layers.rows(band));
                let parts = parts.collect::<Result<Vec<_>>>()?;
                let parts: Vec<_> = parts.iter().collect();
                rows.write(&LayerRows::side_by_side(&parts)?)
            });
            written.into_iter().collect::<Result<()>>()?;
            progress.add(u64::from(n_rows) * bands.len() as u64);
            progress.check()?;
        }
    }

    /// Finishes the files, and records their properties.
    ///
    /// # Errors
    ///
    /// If rows are missing, or a file cannot be written.
    pub(crate) fn finish(self, job: &mut Job<'_>, files: &[MapFile]) -> Result<()> {
        finish(job, self.rows, files, self.size)
    }
}

/// Encodes the images of a bake in memory, and reports progress in rows.
///
/// # Errors
///
/// If the recipe cannot be baked.
pub(crate) fn encode(
    bake: Bake<'_>,
    images: &[Image],
    progress: &Progress,
) -> Result<Vec<Vec<u8>>> {
    let size = bake.size();
    let writer = |image: &Image| {
        let (content, encoding) = (image.layers.content(), image.format.encoding());
        RowWriter::new(Cursor::new(Vec::new()), size, content, encoding)
    };
    let mut writers = images.iter().map(writer).collect::<Result<Vec<_>, _>>()?;
    for_each_band(bake, progress, |band| {
        let written = parallel::map_mut_at_least(1, &mut writers, |index, writer| {
            Ok(images[index].layers.rows(band)?.write(writer)?)
        });
        written.into_iter().collect()
    })?;
    let finished = writers.into_iter().map(RowWriter::finish);
    finished.map(|file| Ok(file?.into_inner())).collect()
}

/// Passes each band of a bake to the writers of all files, in parallel.
fn draw(
    bake: Bake<'_>,
    rows: &mut [Rows],
    progress: &Progress,
    write: fn(&mut Rows, &LayerRows<'_>) -> Result<()>,
) -> Result<()> {
    for_each_band(bake, progress, |band| {
        let written =
            parallel::map_mut_at_least(1, rows, |_, rows| write(rows, &rows.layers.rows(band)?));
        written.into_iter().collect()
    })
}

/// Writes the bands of a bake, and reports progress in rows. Each band is written while the next one is computed.
fn for_each_band(
    mut bake: Bake<'_>,
    progress: &Progress,
    mut write: impl FnMut(&Band) -> Result<()> + Send,
) -> Result<()> {
    progress.check()?;
    let mut next = bake.next();
    while let Some(band) = next.transpose().map_err(advise)? {
        let mut written = Ok(());
        next = None;
        let work: Vec<Box<dyn FnOnce() + Send + '_>> = vec![
            Box::new(|| written = write(&band)),
            Box::new(|| next = bake.next()),
        ];
        parallel::consume(work, |_, work| work());
        written?;
        let n_rows = band.maps.first().map_or(0, |(_, rows)| rows.size()[1]);
        progress.add(n_rows.into());
        progress.check()?;
    }
    Ok(())
}

/// Returns the format of a map's file; 16-bit PNG by default.
///
/// # Errors
///
/// Same as [`Format::choose`].
pub(crate) fn format(asked: Option<Format>, target: &Target) -> Result<Format> {
    Format::choose(asked, target, Format::Png16)
}

/// The note for a looping animation in which no node changes with time.
pub(crate) const STILL: &str = "note: nothing in this recipe moves, so that all pictures of the loop are equal; \
    see `motion` in `dapple recipe --reference`";

/// Adds a hint to an error about a recipe.
pub(crate) fn advise(error: RecipeError) -> Error {
    let hint = match error.kind() {
        RecipeErrorKind::Global { .. } => {
            return Error::new(error)
                .hint("bake it without --banded")
                .wrong_value();
        }
        RecipeErrorKind::UnknownRecipe { .. } => return Error::new(error).wrong_value(),
        RecipeErrorKind::NotInShader { .. } => {
            return Error::new(error)
                .hint("with --textures, the shader takes their values as arguments; bake each with `dapple bake --node`")
                .wrong_value();
        }
        RecipeErrorKind::NoImage { .. } => "put the images into the folder of the recipe",
        RecipeErrorKind::Schema { .. } => "see the changelog for what has changed in recipes",
        _ => return error.into(),
    };
    Error::new(error).hint(hint)
}

/// Adds a hint to an error about a recipe that is baked in shards.
pub(crate) fn advise_shard(error: RecipeError) -> Error {
    match error.kind() {
        RecipeErrorKind::Global { .. } => Error::new(error)
            .context("the recipe cannot be baked in shards")
            .hint("make the picture of the node beforehand, with `dapple tile`, `dapple blend-map` or `dapple bake`, and read it with an `image` node"),
        _ => advise(error),
    }
}

/// A writer of an image row by row, with its target for error messages.
struct Writer {
    target: Target,
    rows: RowWriter<BufWriter<Sink>>,
}

/// The writers of an image and of its sheet of 2 × 2 copies, with statistics of the written values.
struct Rows {
    layers: Layers,
    map: Writer,
    sheet: Option<Writer>,
    /// Whether to record the range of the values.
    is_noted: bool,
    /// Minimum and maximum of the values written so far.
    range: [f32; 2],
    /// Number of pixels written so far with a value that the format clips.
    n_clipped: u64,
    /// Whether the format clips values to 0 to 1.
    clips: bool,
}

impl Rows {
    fn new(job: &Job<'_>, file: &MapFile, size: [u32; 2]) -> Result<Self> {
        let twice = size.map(|side| side.saturating_mul(2));
        let sheet = file
            .sheet
            .map(|sheet| Writer::new(job, file.image, sheet, twice));
        Ok(Self {
            layers: file.image.layers,
            map: Writer::new(job, file.image, file.output, size)?,
            sheet: sheet.transpose()?,
            is_noted: job.has_sidecar(),
            range: [f32::INFINITY, f32::NEG_INFINITY],
            n_clipped: 0,
            clips: !file.image.format.keeps_numbers(),
        })
    }

    fn write(&mut self, rows: &LayerRows<'_>) -> Result<()> {
        self.map.write(rows)?;
        if self.is_noted {
            self.range = rows.range(self.range);
        }
        if self.clips {
            self.n_clipped += rows.n_clipped();
        }
        self.write_sheet(rows)
    }

    fn write_sheet(&mut self, rows: &LayerRows<'_>) -> Result<()> {
        match &mut self.sheet {
            Some(sheet) => sheet.write(&rows.beside_themselves()?),
            None => Ok(()),
        }
    }
}

impl Writer {
    fn new(job: &Job<'_>, image: Image, output: OutputIdx, size: [u32; 2]) -> Result<Self> {
        let (content, encoding) = (image.layers.content(), image.format.encoding());
        let target = job.target(output).clone();
        let rows = RowWriter::new(job.writer(output)?, size, content, encoding);
        let rows = rows.with_context(|| cannot_be_written(&target))?;
        Ok(Self { target, rows })
    }

    fn write(&mut self, rows: &LayerRows<'_>) -> Result<()> {
        let written = rows.write(&mut self.rows);
        written.with_context(|| cannot_be_written(&self.target))
    }

    fn finish(self) -> Result<()> {
        let ended = self.rows.finish().map_err(Error::from);
        let flushed = ended.and_then(|mut file| Ok(file.flush()?));
        flushed.with_context(|| cannot_be_written(&self.target))
    }
}
