//! `dapple tile`: images made to repeat.

mod method;

use crate::args::{Axes, ImageArgs, Region, Size};
use crate::commands::info::seams_json;
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::input::{self, Kind, Loaded};
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Context as _, Error, Result};
use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use dapple::raster::Raster;
use dapple::tile::{
    Map, SeamOptions, SeamReport, SeamReports, Seamless, TileError, TileErrorKind, repeat,
};
use method::{Candidate, MethodArgs};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple tile photo.png -o tile.png
  dapple tile photo.png --margin 24 --sheet -o cut.png
  dapple tile photo.png --method auto --report -o best.png
  dapple tile albedo.png height.png --normal normal.png -o tiles/
  dapple tile photo.png --axes x -o wall.exr
  dapple tile photo.png --report

Which method:
  soft-cut         cuts along the line of least difference; smaller by the margin;
                   for photographs; the default
  auto             tries all of these and keeps the best by the report
  periodic         keeps all detail and the size; spreads the step across the wrap over
                   the image, which shows as a stain where it is large
  poisson          the same with another gradient across the wrap
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
    #[arg(long, value_parser = repeating(), default_value = "both")]
    axes: Axes,

    /// Print how well source and tile repeat, and what of the source was kept.
    #[arg(long, help_heading = "Quality")]
    report: bool,

    /// Exit with 3 if a tile does not pass, in any of its channels: if the seam shows, a band has gone soft, contrast was lost,
    /// the seam is unlike anything in the source, copies mirror each other, or samples are clipped.
    #[arg(long, help_heading = "Quality")]
    check: bool,

    /// Compare the seam only with every n-th boundary of pixels; by default 2^levels for spline, else 1.
    #[arg(long, value_name = "N[xN]", help_heading = "Quality")]
    lattice: Option<Size>,

    /// Write 2 x 2 copies of each tile, too, as `NAME-2x2`.
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
    args.method.check_used()?;
    let mut job = Job::new(context, "tile", &args.image.files);
    let sources = sources(args, &mut job)?;
    job.claim_sidecar()?;
    let progress = Progress::spinner("making it repeat", context.quiet);
    let maps: Vec<Map> = sources
        .iter()
        .map(|source| source.loaded.map.clone())
        .collect();
    let candidates = args.method.candidates(maps[0].size());
    let made = best(args, &maps, candidates)?;
    drop(progress);
    if args.method.is_auto() && !context.quiet {
        job.say(&format!("auto takes {}", made.candidate.name))?;
    }

    let (report, passes) = reports(args, &sources, &made, &job)?;
    let tiles = made.tiles;
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
    let folder = args.image.files.folder();
    if inputs.len() > 1 && folder.is_none() && args.image.files.output.is_some() {
        return Err(usage("several maps need a folder for their tiles")
            .hint("let -o end with a slash, as in -o tiles/"));
    }
    if let Some(folder) = folder {
        job.make_folder(folder)?;
    }
    let mut sources: Vec<Source> = Vec::new();
    for (path, kind) in inputs {
        let outputs = claim(path, folder, args, job)?;
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

/// Claims the tile of an image, and its sheet.
fn claim(
    path: &Path,
    folder: Option<&Path>,
    args: &Args,
    job: &mut Job<'_>,
) -> Result<Option<[Option<OutputIdx>; 2]>> {
    let target = match folder {
        Some(folder) => {
            let ending = args.image.format.map_or("png", |format| format.ending());
            let mut name = path.file_stem().unwrap_or_default().to_owned();
            name.push(".");
            name.push(ending);
            Target::Path(folder.join(name))
        }
        None if args.image.files.output.is_none() && (args.report || args.check) => {
            return Ok(None);
        }
        None => args.image.files.target()?,
    };
    // A name that no format has is refused before the work, whatever the map will be.
    Format::choose(args.image.format, &target, Format::Png16)?;
    let output = job.claim(&target)?;
    let sheet = match (&target, args.sheet) {
        (_, false) => None,
        (Target::Stdout, true) => {
            return Err(
                usage("a sheet lies beside its tile, and standard output has no place")
                    .hint("give a file with -o"),
            );
        }
        (Target::Path(tile), true) => {
            let mut name = tile.file_stem().unwrap_or_default().to_owned();
            name.push("-2x2.");
            name.push(target.ending());
            Some(job.claim(&Target::Path(tile.with_file_name(name)))?)
        }
    };
    Ok(Some([Some(output), sheet]))
}

/// The tiles of all maps by a method.
struct Made {
    candidate: Candidate,
    tiles: Vec<Map>,
}

/// The tiles by the only method, or by the one whose reports are the best of those that can be used.
fn best(args: &Args, maps: &[Map], mut candidates: Vec<Candidate>) -> Result<Made> {
    let make = |candidate: Candidate| -> Result<Made, TileError> {
        let seamless = Seamless {
            method: candidate.method,
            axes: args.axes.flags(),
        };
        let tiles = seamless.apply_maps(maps)?;
        Ok(Made { candidate, tiles })
    };
    if let [_] = candidates.as_slice() {
        return make(candidates.remove(0)).map_err(hint_at_size);
    }
    let (mut best, mut refused) = (None, None);
    for candidate in candidates {
        let made = match make(candidate) {
            Ok(made) => made,
            Err(error) => {
                refused.get_or_insert(error);
                continue;
            }
        };
        let cost = cost(args, maps, &made)?;
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, made));
        }
    }
    match (best, refused) {
        (Some((_, made)), _) => Ok(made),
        (None, Some(error)) => Err(hint_at_size(error)),
        (None, None) => Err(usage("there is no method")),
    }
}

/// How bad the tiles are: the badness of the worst channel, and the part of the finest octave that it has lost.
fn cost(args: &Args, maps: &[Map], made: &Made) -> Result<f64> {
    let mut worst: f64 = 0.0;
    for (map, tile) in maps.iter().zip(&made.tiles) {
        let reports = SeamReports::beside(map, tile, &options(args, &made.candidate))?;
        for of in reports.channels() {
            let finest = of
                .report
                .kept
                .as_ref()
                .and_then(|kept| kept.octaves.first());
            let lost = finest.map_or(0.0, |kept| (1.0 - kept).max(0.0));
            worst = worst.max(of.report.badness() + lost);
        }
    }
    Ok(worst.min(SeamReport::MOST))
}

fn options(args: &Args, candidate: &Candidate) -> SeamOptions {
    SeamOptions {
        axes: args.axes.flags(),
        lattice: args.lattice.map_or(candidate.lattice, |lattice| lattice.0),
    }
}

/// Prints the reports that were asked for; gives them as JSON, and whether all tiles pass.
fn reports(args: &Args, sources: &[Source], made: &Made, job: &Job<'_>) -> Result<(Value, bool)> {
    let is_wanted = args.report || args.check || args.image.files.json.is_some();
    if !is_wanted {
        return Ok((Value::Null, true));
    }
    let options = options(args, &made.candidate);
    let plain = SeamOptions {
        lattice: [1; 2],
        ..options
    };
    let (mut all, mut passes) = (Vec::new(), true);
    for (source, tile) in sources.iter().zip(&made.tiles) {
        let name = &source.name;
        let before =
            SeamReports::of_map(&source.loaded.map, &plain).with_context(|| name.clone())?;
        let after = SeamReports::beside(&source.loaded.map, tile, &options);
        let after = after.with_context(|| name.clone())?;
        passes &= after.passes();
        if args.report {
            job.say(&format!("{name}, as it was:\n{before}\n"))?;
            job.say(&format!("{name}, made to repeat:\n{after}\n"))?;
        } else if args.check && !after.passes() {
            job.say(&format!("{name} does not pass:\n{after}"))?;
        }
        all.push(json!({
            "map": name, "method": made.candidate.name, "source": seams_json(&before), "tile": seams_json(&after),
        }));
    }
    Ok((Value::Array(all), passes))
}

/// The axes of which at least one repeats.
fn repeating() -> impl TypedValueParser<Value = Axes> {
    let variants = Axes::value_variants().iter();
    let repeating = variants.filter(|axes| axes.flags() != [false; 2]);
    PossibleValuesParser::new(repeating.filter_map(ValueEnum::to_possible_value))
        .try_map(|name| Axes::from_str(&name, false))
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
fn hint_at_size(error: TileError) -> Error {
    let hint = match error.kind() {
        TileErrorKind::Margin { .. } => "take a smaller --margin",
        TileErrorKind::Wavelet(_) => {
            "cut it to a multiple of 2^levels with --region, or take fewer --levels"
        }
        _ => return error.into(),
    };
    Error::new(error).hint(hint)
}
