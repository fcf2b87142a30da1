//! `dapple tile`: makes images repeat.

mod best;
mod method;
mod synth;

use crate::args::{AlphaArgs, Axes, ImageArgs, MapArg, PartArgs, ReadArgs, Size, resampled};
use crate::commands::info::seams_json;
use crate::encode::{Clear, Cover, Format, map_raster};
use crate::error::{Exit, Hint, usage};
use crate::input::{self, Kind, Loaded};
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Context as _, Error, Result};
pub(super) use best::best;
use best::{Made, options};
use dapple::raster::{Raster, Wrap};
use dapple::tile::{
    self, Map, SeamOptions, SeamReports, TileError, TileErrorKind, even_out, repeat,
};
pub(super) use method::MethodArgs;
use method::{Candidate, How};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple tile photo.png -o tile.png
  dapple tile photo.png --margin 24 --sheet -o cut.png
  dapple tile photo.png --method auto --report -o best.png
  dapple tile albedo.png height.png --map normal=normal.png -o tiles/
  dapple tile photo.png --even --size 2048 -o ground.png
  dapple tile photo.png --wrap x -o wall.exr
  dapple tile photo.png --rectify 8,4,60,0,62,63,3,58 -o flat.png
  dapple tile photo.png --report

To make a tile of another size or from an example, see `dapple synth`.";

/// Make an image repeat, or all maps of a material along the same cut.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Images; `-` is standard input. Gray is plain values, color is processed in linear light.
    #[arg(value_name = "IMAGE")]
    images: Vec<PathBuf>,

    /// Further map of the same material, such as normal=FILE or roughness=FILE; repeatable.
    #[arg(long, value_name = "NAME=IMAGE")]
    map: Vec<MapArg>,

    /// Same as --map normal=IMAGE.
    #[arg(long, value_name = "IMAGE", hide = true)]
    normal: Vec<PathBuf>,

    #[command(flatten)]
    #[serde(flatten)]
    part: PartArgs,

    /// Remove changes of light over more than PX pixels, such as vignettes [default: a sixth of the shorter side].
    ///
    /// Each channel is evened out on its own; normals are unchanged.
    #[arg(long, value_name = "PX", num_args = 0..=1, require_equals = true)]
    even: Option<Option<f64>>,

    #[command(flatten)]
    #[serde(flatten)]
    alpha: AlphaArgs,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    #[command(flatten)]
    method: MethodArgs,

    /// Axes along which the images repeat.
    #[arg(long, value_name = "AXES", default_value = "both", value_parser = Axes::some())]
    wrap: Axes,

    /// Print how well source and tile repeat, and how much of the source is kept.
    #[arg(long, help_heading = "Quality")]
    report: bool,

    /// Exit with 3 if a tile does not pass the seam report in any channel.
    ///
    /// A tile fails if the seam is visible, a band is blurred, contrast is lost, the seam is unlike the source, copies
    /// mirror each other, or samples are clipped.
    #[arg(long, help_heading = "Quality")]
    check: bool,

    /// Compare the seam with every n-th pixel boundary only [default: 2^levels for spline, else 1].
    #[arg(long, value_name = "N[xN]", help_heading = "Quality")]
    lattice: Option<Size>,

    /// Resample the tile to this size: each pixel is the mean of its area, in linear light.
    #[arg(long, value_name = "N[xN]", help_heading = "Output")]
    size: Option<Size>,

    /// Also write 2 x 2 copies of each tile, as `NAME_2x2`.
    #[arg(long, help_heading = "Output")]
    sheet: bool,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// An input image with its name, and the outputs for its tile and for a sheet of copies.
struct Source {
    name: String,
    loaded: Loaded,
    outputs: Option<[Option<OutputIdx>; 2]>,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option, an image or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    args.method.check_used()?;
    let mut job = Job::new(context, "tile", &args.image.files);
    let sources = sources(args, &mut job)?;
    let progress = Progress::spinner("making it repeat", context);
    let maps = sources.iter().map(|source| source.loaded.map.clone());
    // Treat the alpha channels as further maps with the same cut.
    let alphas = sources
        .iter()
        .filter_map(|source| source.loaded.alpha.clone());
    let maps: Vec<Map> = maps.chain(alphas.map(Map::Value)).collect();
    let mut made = best(&args.method, &maps, args.wrap.flags(), args.lattice)?;
    let alphas = made.tiles.split_off(sources.len());
    drop(progress);
    if args.method.is_auto() && !context.quiet {
        job.say(&format!("auto takes {}", made.candidate.name))?;
    }

    let wraps = args.wrap.flags();
    let clear = Clear::Bleed { wraps };
    let (report, passes) = reports(args, &sources, &mut made, &job)?;
    let note = args
        .size
        .and_then(|size| size.stretch_note(made.tiles[0].size()));
    if let Some(note) = note.filter(|_| !context.quiet) {
        job.say(&note)?;
    }
    let wrap = wraps.map(|repeats| if repeats { Wrap::Repeat } else { Wrap::Clamp });
    let mut alphas = alphas.into_iter();
    for (source, mut map) in sources.iter().zip(made.tiles) {
        let has_alpha = source.loaded.alpha.is_some();
        let mut alpha = match has_alpha.then(|| alphas.next()).flatten() {
            Some(Map::Value(alpha)) => Some(alpha),
            _ => None,
        };
        let is_associated = source.loaded.is_associated;
        if let Some(Size(size)) = args.size {
            let resize = |map: &Map| tile::resize(map, size, wrap);
            (map, alpha) =
                resampled(&map, alpha.as_ref(), is_associated, resize).map_err(advise)?;
        }
        let Some([output, sheet]) = source.outputs else {
            continue;
        };
        let is_deep = source.loaded.is_deep;
        if let Some(sheet) = sheet {
            let alpha = alpha.as_ref().map(twice).transpose()?;
            let map = doubled(&map)?;
            let cover = Cover::of(alpha.as_ref(), is_associated, clear);
            job.write_with_alpha(sheet, map, cover, is_deep, &args.image)?;
        }
        if let Some(output) = output {
            let cover = Cover::of(alpha.as_ref(), is_associated, clear);
            job.write_with_alpha(output, map, cover, is_deep, &args.image)?;
        }
    }
    job.finish(args, report)?;
    Ok(if args.check && !passes {
        Exit::Check
    } else {
        Exit::Done
    })
}

/// Claims the outputs, and reads all images.
fn sources(args: &Args, job: &mut Job<'_>) -> Result<Vec<Source>> {
    let images = args.images.iter().map(|path| (path, Kind::ByChannels));
    let normals = args.normal.iter().map(|path| (path, Kind::Normals));
    let maps = args.map.iter().map(|map| (&map.path, map.kind()));
    let inputs: Vec<_> = images.chain(maps).chain(normals).collect();
    if inputs.is_empty() {
        return Err(usage("missing image").hint("name one, or several that belong together"));
    }
    let paths: Vec<&Path> = inputs.iter().map(|(path, _)| path.as_path()).collect();
    let mut outputs = claim(&paths, args, job)?.into_iter();
    let mut sources: Vec<Source> = Vec::new();
    for (path, kind) in inputs {
        let outputs = outputs.next();
        let mut loaded =
            input::map_with_alpha(path, kind, args.part.region, args.alpha.alpha, &args.read)?;
        args.part
            .rectify(&mut loaded)
            .with_context(|| input::name(path))?;
        let size = loaded.map.size();
        if let Some(radius) = args.even {
            let shorter = size[0].min(size[1]);
            let radius = radius.unwrap_or_else(|| (f64::from(shorter) / 6.0).max(1.0));
            loaded.map = even_out(&loaded.map, radius).map_err(advise)?;
        }
        let first = sources.first().map(|source| source.loaded.map.size());
        input::check_size(path, size, paths[0], first.unwrap_or(size))
            .hint("maps that are cut together must have the same size")?;
        sources.push(Source {
            name: input::name(path),
            outputs,
            loaded,
        });
    }
    Ok(sources)
}

/// Claims the outputs for tiles and their sheets, or none if only a report was requested.
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
        // In a directory, tiles have the names of their images, unless `--name` is given.
        let target = match files.folder(paths.len()) {
            Some(folder) if files.name.is_none() => {
                Target::Path(folder.join(format!("{stem}.{}", args.image.ending())))
            }
            _ => target,
        };
        // Refuse an invalid extension before the work. The default format does not matter here.
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

/// Returns the file name without its extension, or `tile` for standard input.
fn stem(path: &Path) -> String {
    match path.file_stem() {
        Some(stem) if path != Path::new("-") => stem.to_string_lossy().into_owned(),
        _ => "tile".to_owned(),
    }
}

/// Returns the name of the map in a file name, such as `normal` for `rock_normal`.
fn map_of(stem: &str) -> &str {
    stem.rsplit_once('_').map_or(stem, |(_, map)| map)
}

/// Computes the seam reports if they are requested, and prints them. Returns them as JSON, and whether all tiles pass.
fn reports(
    args: &Args,
    sources: &[Source],
    made: &mut Made,
    job: &Job<'_>,
) -> Result<(Value, bool)> {
    let is_wanted = args.report || args.check || args.image.files.json.is_some();
    if !is_wanted {
        return Ok((Value::Null, true));
    }
    let options = options(args.wrap.flags(), args.lattice, &made.candidate);
    let plain = SeamOptions {
        lattice: [1; 2],
        ..options
    };
    let (mut all, mut passes) = (Vec::new(), true);
    let mut known = core::mem::take(&mut made.reports).into_iter();
    for (source, tile) in sources.iter().zip(&made.tiles) {
        let name = &source.name;
        let before =
            SeamReports::of_map(&source.loaded.map, &plain).with_context(|| name.clone())?;
        let after = match known.next() {
            Some(after) => after,
            None => SeamReports::beside(&source.loaded.map, tile, &options)
                .with_context(|| name.clone())?,
        };
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
    if !passes && (args.report || args.check) {
        job.say(next_step(&made.candidate, args.method.is_auto()))?;
    }
    Ok((Value::Array(all), passes))
}

/// Returns a suggestion for a tile that does not pass, such as another method.
fn next_step(made: &Candidate, is_auto: bool) -> &'static str {
    match &made.how {
        _ if is_auto => {
            "no method passes: look at the tile with --sheet, or cut out a more even part with --region"
        }
        How::Synth(_) => {
            "try another --seed or a wider --margin, or cut out a more even part with --region"
        }
        How::Seamless(_) => "try --method synth, or --method auto",
    }
}

/// Builds a sheet of 2 × 2 copies of a map.
fn doubled(map: &Map) -> Result<Map> {
    Ok(map_raster!(map, raster => twice(raster)?))
}

/// Builds a sheet of 2 × 2 copies of a raster.
fn twice<T: Copy + Send + Sync>(raster: &Raster<T>) -> Result<Raster<T>> {
    let size = raster.size().map(|side| side.saturating_mul(2));
    Ok(repeat(raster, size)?)
}

/// Adds a hint to errors about sizes that the method does not allow.
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
