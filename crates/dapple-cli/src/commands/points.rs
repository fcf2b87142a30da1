//! `dapple points`: scatters points.

mod picture;
mod report;
mod scatter;

use crate::args::{OutputArgs, RampArg, Size};
use crate::error::{Exit, Hint, usage};
use crate::job::{Context, Job};
use crate::output::Target;
use crate::progress::Progress;
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::points::PointSet;
use dapple::raster::Named;
use scatter::{ScatterArgs, Scattered};
use serde::Serialize;
use serde_json::{Value, json};

const EXAMPLES: &str = "\
Examples:
  dapple points poisson --count 500 -o points.csv
  dapple points poisson --radius 0.05 --domain 2x1 --wrap x -o points.json
  dapple points variable --count 3000 --density photo.png --wrap none \\
    -o stipple.png --size 512
  dapple points variable --count 2000 --density 1:8 --wrap y -o ramp.png
  dapple points nested --count 2000 --levels 3 -o nested.png \\
    --ramp white,#28f,#f80,#c22
  dapple points jittered --cells 20x10 --jitter 0.8
  dapple points white --count 100 --seed 7 --format json

Kinds:
  poisson   random points at least a radius apart, with room for no further one
  variable  the same with a radius that varies: denser where --density is higher
  nested    poisson in levels, each of which holds the one before
  jittered  one point in each cell of a grid
  white     anywhere

CSV has a line x,y for each point (x,y,level for nested ones) under a header, with
numbers that read back as the same bits.";

/// Scatter points: Poisson disk, with varying density, nested, jittered or white; and measure them.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    scatter: ScatterArgs,

    /// Print measurements of the points: distances, empty circle, spectrum.
    #[arg(long, help_heading = "Output")]
    report: bool,

    /// csv, json, or png for an image [default: by the extension of the output, else csv].
    #[arg(long, value_name = "FORMAT", value_parser = NamedValueParser::<Format>::all(), help_heading = "Output")]
    format: Option<Format>,

    /// Image size in pixels; a single number is the longer side.
    #[arg(
        long,
        value_name = "WxH",
        help_heading = "Output",
        default_value = "512"
    )]
    size: Size,

    /// Radius of the dots in pixels [default: a quarter of the mean distance].
    #[arg(long, value_name = "PX", help_heading = "Output")]
    dot: Option<f64>,

    /// Colors: the background, then the dots of each level [default: black on white].
    ///
    /// By default several levels have several colors.
    #[arg(long, value_name = "COLORS", help_heading = "Output")]
    ramp: Option<RampArg>,

    #[command(flatten)]
    #[serde(skip)]
    output: OutputArgs,
}

dapple::raster::named! {
    /// The format of the points.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Format {
        Csv = "csv",
        Json = "json",
        Png = "png",
    }
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option, an image or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let target = match &args.output.output {
        Some(_) => (args.output).target("points", args.format.map_or("csv", Format::name))?,
        None => Target::Stdout,
    };
    let format = format(args, &target)?;
    let mut job = Job::new(context, "points", &args.output);
    let output = match format {
        Format::Png => job.claim(&target)?,
        Format::Csv | Format::Json => job.claim_text(&target)?,
    };
    job.claim_sidecar(&target)?;
    let progress = Progress::spinner("scattering", context);
    let scattered = args.scatter.scatter()?;
    let report = if args.report || args.output.json.is_some() {
        Some(report::Report::of(&scattered)?)
    } else {
        None
    };
    drop(progress);
    match format {
        Format::Csv => job.write(output, csv(&scattered).as_bytes())?,
        Format::Json => job.write(output, json_text(args, &scattered)?.as_bytes())?,
        Format::Png => {
            let picture = picture::picture(&scattered, args.size, args.dot, args.ramp.as_ref())?;
            let map = dapple::tile::Map::Color(picture);
            job.write_map(output, &map, crate::encode::Format::Png8)?;
        }
    }
    if let (true, Some(report)) = (args.report, &report) {
        job.say(&report.to_string())?;
    }
    let report = report.map_or(Value::Null, |report| report.to_json());
    job.finish(args, report)?;
    Ok(Exit::Done)
}

/// Returns the requested format, or else the format of the file extension.
fn format(args: &Args, target: &Target) -> Result<Format> {
    let by_ending = match target.ending().as_str() {
        "csv" | "txt" => Some(Format::Csv),
        "json" => Some(Format::Json),
        "png" => Some(Format::Png),
        _ => None,
    };
    match (args.format, by_ending, target) {
        (Some(format), None, _) => Ok(format),
        (Some(format), Some(ending), _) if format == ending => Ok(format),
        (Some(_), Some(_), _) => Err(usage(format!(
            "{target} is the name of another format than --format says"
        ))),
        (None, Some(ending), _) => Ok(ending),
        (None, None, Target::Stdout) => Ok(Format::Csv),
        (None, None, Target::Path(_)) => {
            let error = usage(format!("{target}: no format has this ending"));
            Err(error.hint("let it end in .csv, .json or .png, or add --format"))
        }
    }
}

/// Formats the points as CSV, with a header and a line for each point.
fn csv(scattered: &Scattered) -> String {
    let is_nested = scattered.lengths.len() > 1;
    let mut text = String::from(if is_nested { "x,y,level\n" } else { "x,y\n" });
    for (point, at) in scattered.points.iter() {
        // Rust prints the shortest digits that parse to the same number.
        text += &format!("{},{}", at.x, at.y);
        if is_nested {
            text += &format!(",{}", scattered.level(point.index()));
        }
        text.push('\n');
    }
    text
}

/// Formats the points as JSON. Contains the seed, the domain, the radius, and for each level the number of points up to
/// and including it.
fn json_text(args: &Args, scattered: &Scattered) -> Result<String> {
    let set: &PointSet = &scattered.points;
    let domain = set.domain();
    let positions: Vec<_> = set.positions().iter().map(|at| at.to_array()).collect();
    let text = serde_json::to_string(&json!({
        "seed": args.scatter.seed,
        "domain": {
            "origin": domain.origin.to_array(), "size": domain.size.to_array(), "wrap": domain.wrap,
        },
        "radius": scattered.radius, "lengths": scattered.lengths, "points": positions,
    }))?;
    Ok(text + "\n")
}
