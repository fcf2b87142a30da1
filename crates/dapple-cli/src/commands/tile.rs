//! `dapple tile`: images made to repeat.

mod method;

use crate::args::{Axes, ImageArgs, Region, Size};
use crate::commands::info::measured;
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::input::{self, Kind, Loaded};
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Context as _, Error, Result};
use dapple::raster::Raster;
use dapple::tile::{Map, SeamOptions, SeamReport, Seamless, TileError, TileErrorKind, repeat};
use method::MethodArgs;
use serde::Serialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple tile photo.png -o tile.png
  dapple tile photo.png --method soft-cut --margin 24 --sheet -o cut.png
  dapple tile albedo.png height.png --normal normal.png \\
    --method soft-cut -o tiles/
  dapple tile photo.png --wrap x -o wall.exr
  dapple tile photo.png --report

Which method:
  periodic         keeps all detail and the size; the default
  poisson          the same with another gradient across the wrap
  soft-cut         cuts along the line of least difference; smaller by the margin;
                   for grains, leaves and stones
  spline           the blend tile of Du, Wang and Meng; smooths, and hides a seam only
                   in part
  periodic-spline  periodic first, then spline
  feather          a crossfade, the usual baseline
  mirror           the image beside its mirror image, twice as large

To make a tile of another size or from an example, see `dapple synth`.";

/// Make an image repeat, or all maps of a material along the same cut.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The images. Gray ones are values as they are; color is worked on in linear light. `-` is standard input.
    #[arg(value_name = "IMAGE")]
    images: Vec<PathBuf>,

    /// A normal map that belongs to them; may be given several times.
    #[arg(long, value_name = "IMAGE")]
    normal: Vec<PathBuf>,

    /// Use only this part of the images, in pixels.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    #[command(flatten)]
    method: MethodArgs,

    /// Which sides fit together.
    #[arg(long, value_name = "AXES", default_value = "both", value_parser = Axes::some())]
    wrap: Axes,

    /// Print how well source and tile repeat, and what of the source was kept.
    #[arg(long, help_heading = "Quality")]
    report: bool,

    /// Exit with 3 if a tile does not pass: if its seam ratio is not from 0.8 to 1.25, at 1 and at 4 pixels.
    #[arg(long, help_heading = "Quality")]
    check: bool,

    /// Compare the seam only with every n-th boundary of pixels; by default 2^levels for spline, else 1.
    #[arg(long, value_name = "N[xN]", help_heading = "Quality")]
    lattice: Option<Size>,

    /// Write 2 x 2 copies of each tile, too, as `NAME_2x2`.
    #[arg(long, help_heading = "Output")]
    sheet: bool,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// An image, its name, and where its tile goes.
struct Source {
    name: String,
    loaded: Loaded,
    outputs: Option<[Option<OutputIdx>; 2]>,
}

/// Runs it.
///
/// # Errors
///
/// Whatever went wrong.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let seamless = Seamless {
        method: args.method.method()?,
        axes: args.wrap.flags(),
    };
    let mut job = Job::new(context, "tile", &args.image.files);
    let sources = sources(args, &mut job)?;
    let progress = Progress::spinner("making it repeat", context);
    let maps: Vec<Map> = sources
        .iter()
        .map(|source| source.loaded.map.clone())
        .collect();
    let tiles = seamless.apply_maps(&maps).map_err(advise)?;
    drop(progress);

    let (report, passes) = reports(args, &sources, &tiles, &job)?;
    for (source, tile) in sources.iter().zip(tiles) {
        let Some([output, sheet]) = source.outputs else {
            continue;
        };
        let is_deep = source.loaded.is_deep;
        if let Some(sheet) = sheet {
            job.write_image(sheet, doubled(&tile)?, is_deep, &args.image)?;
        }
        if let Some(output) = output {
            job.write_image(output, tile, is_deep, &args.image)?;
        }
    }
    job.finish(args, report)?;
    Ok(if args.check && !passes {
        Exit::Check
    } else {
        Exit::Done
    })
}

/// Reads all images, after their outputs were claimed.
fn sources(args: &Args, job: &mut Job<'_>) -> Result<Vec<Source>> {
    let images = args.images.iter().map(|path| (path, Kind::ByChannels));
    let normals = args.normal.iter().map(|path| (path, Kind::Normals));
    let inputs: Vec<_> = images.chain(normals).collect();
    if inputs.is_empty() {
        return Err(usage("there is no image").hint("name one, or several that belong together"));
    }
    let paths: Vec<&Path> = inputs.iter().map(|(path, _)| path.as_path()).collect();
    let mut outputs = claim(&paths, args, job)?.into_iter();
    let mut sources: Vec<Source> = Vec::new();
    for (path, kind) in inputs {
        let outputs = outputs.next();
        let loaded = input::map(path, kind, args.region)?;
        let first = sources.first().map(|source| &source.loaded.map);
        let first = first.map_or(loaded.map.size(), Map::size);
        input::check_size(path, loaded.map.size(), first)
            .hint("maps that are cut together have one size")?;
        sources.push(Source {
            name: input::name(path),
            outputs,
            loaded,
        });
    }
    Ok(sources)
}

/// Claims the tiles of images, and their sheets; none where only a report is wanted.
fn claim(paths: &[&Path], args: &Args, job: &mut Job<'_>) -> Result<Vec<[Option<OutputIdx>; 2]>> {
    let files = &args.image.files;
    if files.output.is_none() && (args.report || args.check) {
        job.claim_sidecar(&Target::Stdout)?;
        return Ok(Vec::new());
    }
    let stems: Vec<_> = paths.iter().map(|path| stem(path)).collect();
    let parts: Vec<_> = stems.iter().map(|stem| map_of(stem)).collect();
    let first = stems.first().map_or("", String::as_str);
    let targets = match &parts[..] {
        [_] => files.targets(first, &[""], args.image.ending())?,
        parts => files.targets(first, parts, args.image.ending())?,
    };
    let mut outputs = Vec::new();
    for (stem, target) in stems.iter().zip(targets.files) {
        // In a folder, tiles keep the names of their images unless another was given.
        let target = match files.folder(paths.len()) {
            Some(folder) if files.name.is_none() => {
                Target::Path(folder.join(format!("{stem}.{}", args.image.ending())))
            }
            _ => target,
        };
        // A name that no format has is refused before the work, whatever the map will be.
        Format::choose(args.image.format, &target, Format::Png16)?;
        let output = job.claim(&target)?;
        let sheet = match args.sheet {
            true => Some(job.claim(&target.part("2x2")?)?),
            false => None,
        };
        outputs.push([Some(output), sheet]);
    }
    job.claim_sidecar(&targets.main)?;
    Ok(outputs)
}

/// The name of a file without its ending.
fn stem(path: &Path) -> String {
    match path.file_stem() {
        Some(stem) if path != Path::new("-") => stem.to_string_lossy().into_owned(),
        _ => "tile".to_owned(),
    }
}

/// The map that an image is of, by its name: `normal` for `rock_normal`.
fn map_of(stem: &str) -> &str {
    stem.rsplit_once('_').map_or(stem, |(_, map)| map)
}

/// Prints the reports that were asked for; gives them as JSON, and whether all tiles pass.
fn reports(args: &Args, sources: &[Source], tiles: &[Map], job: &Job<'_>) -> Result<(Value, bool)> {
    let is_wanted = args.report || args.check || args.image.files.json.is_some();
    if !is_wanted {
        return Ok((Value::Null, true));
    }
    let lattice = args
        .lattice
        .map_or(args.method.lattice(), |lattice| lattice.0);
    let options = SeamOptions {
        axes: args.wrap.flags(),
        lattice,
    };
    let plain = SeamOptions {
        lattice: [1; 2],
        ..options
    };
    let (mut all, mut passes) = (Vec::new(), true);
    for (source, tile) in sources.iter().zip(tiles) {
        let befores = measured(&source.loaded.map);
        let afters = measured(tile);
        for ((part, before), (_, after)) in befores.iter().zip(&afters) {
            let name = format!("{}{part}", source.name);
            let before_report = SeamReport::of(before, &plain).with_context(|| name.clone())?;
            let report = SeamReport::beside(before, after, &options);
            let report = report.with_context(|| name.clone())?;
            passes &= report.passes();
            if args.report {
                job.say(&format!("{name}, as it was:\n{before_report}\n"))?;
                job.say(&format!("{name}, made to repeat:\n{report}\n"))?;
            } else if args.check && !report.passes() {
                job.say(&format!("{name} does not pass:\n{report}"))?;
            }
            all.push(json!({ "map": name, "source": before_report, "tile": report }));
        }
    }
    Ok((Value::Array(all), passes))
}

/// Two copies beside and below each other.
fn doubled(map: &Map) -> Result<Map> {
    fn twice<T: Copy + Send + Sync>(raster: &Raster<T>) -> Result<Raster<T>> {
        let [width, height] = raster.size();
        Ok(repeat(
            raster,
            [width.saturating_mul(2), height.saturating_mul(2)],
        )?)
    }
    Ok(match map {
        Map::Value(raster) => Map::Value(twice(raster)?),
        Map::Color(raster) => Map::Color(twice(raster)?),
        Map::Normal(raster) => Map::Normal(twice(raster)?),
    })
}

/// Adds what to do about sizes that a method does not take.
fn advise(error: TileError) -> Error {
    let hint = match error.kind() {
        TileErrorKind::Margin { .. } => "take a smaller --margin",
        TileErrorKind::Wavelet(_) => {
            "cut it to a multiple of 2^levels with --region, or take fewer --levels"
        }
        TileErrorKind::NotFinite { .. } => return error.into(),
        _ => return Error::new(error).wrong_value(),
    };
    Error::new(error).hint(hint).wrong_value()
}
