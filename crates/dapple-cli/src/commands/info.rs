//! `dapple info`: describes images and meshes.

mod channels;
mod mesh;

use crate::args::{Axes, OutputArgs, Region, Size};
use crate::error::{Exit, Hint, printable};
use crate::input;
use crate::job::{Context, Job};
use crate::output::Target;
use crate::words::NamedValueParser;
use anyhow::{Context as _, Error, Result};
use channels::{Channel, channels, format};
use dapple::image::{ImageHeader, read_header};
use dapple::mesh_io::MeshFormat;
use dapple::tile::{ChannelReport, SeamOptions, SeamReports};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple info photo.png
  dapple info height.png albedo.png --format json
  dapple info grain.png --check --wrap x
  dapple info model.obj

Numbers are those of the file: code / max in PNG and .r16, from 0 to 1, and as they are in EXR and .npy. An .r16 has
its size in the JSON file beside it. Of images with more pixels than --max-pixels only size and format are read.
A seam ratio near 1 says that the step across the wrap is like the steps inside, between
means of 1, 2, 4 and 8 pixels. An image does not pass if, in any of its channels, the seam
stands out by 2.5 standard deviations or more among the boundaries inside.";

/// Describe images and meshes: size, range, histogram, how well they repeat, faults.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[arg(value_name = "FILE", required = true, help = format!(
        "Images, or meshes ({}). `-` is an image from standard input",
        input::mesh_endings()
    ))]
    files: Vec<PathBuf>,

    /// Describe only this part of images, in pixels.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    /// Axes along which images should repeat; `none` omits the seam report.
    #[arg(long, value_name = "AXES", value_parser = NamedValueParser::<Axes>::all(), default_value_t = Axes::Both)]
    wrap: Axes,

    /// Compare the seam with every n-th pixel boundary only.
    #[arg(long, value_name = "N[xN]", default_value_t = Size([1, 1]))]
    lattice: Size,

    /// Exit with 3 if an image does not tile well or has non-finite pixels, or a mesh needs repair.
    #[arg(long)]
    check: bool,

    /// Report format, text or JSON [default: by the extension of the output].
    #[arg(long, value_name = "FORMAT", value_parser = NamedValueParser::<Format>::all(), help_heading = "Output")]
    format: Option<Format>,

    #[command(flatten)]
    #[serde(skip)]
    output: OutputArgs,
}

dapple::raster::named! {
    /// The format of findings.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Format {
        /// Text for people.
        Text = "text",
        /// JSON for programs.
        Json = "json",
    }
}

/// The description of a file.
pub(super) struct Findings {
    /// The description as text.
    text: String,
    /// The description as JSON.
    json: Value,
    /// Whether the file passes `--check`.
    is_good: bool,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If a file cannot be read, or is neither an image nor a mesh.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let target = args.target()?;
    let is_json = match args.format {
        Some(format) => format == Format::Json,
        None => target.ending() == "json",
    };
    let mut job = Job::new(context, "info", &args.output);
    let output = job.claim_text(&target)?;
    job.claim_sidecar(&target)?;
    let (mut texts, mut reports, mut is_good) = (Vec::new(), Vec::new(), true);
    for path in &args.files {
        let findings = if MeshFormat::of_path(path).is_some() {
            mesh::findings(path)?
        } else {
            image_findings(path, args)?
        };
        is_good &= findings.is_good;
        texts.push(findings.text);
        reports.push(findings.json);
    }
    let text = if is_json {
        serde_json::to_string_pretty(&reports)?
    } else {
        printable(&texts.join("\n")).into_owned()
    };
    job.write(output, format!("{text}\n").as_bytes())?;
    job.finish(args, Value::Null)?;
    Ok(if args.check && !is_good {
        Exit::Check
    } else {
        Exit::Done
    })
}

impl Args {
    /// Returns the output; standard output by default.
    fn target(&self) -> Result<Target> {
        let ending = match self.format {
            Some(Format::Text) => "txt",
            Some(Format::Json) | None => "json",
        };
        match self.output.output {
            Some(_) => self.output.target("info", ending),
            None => Ok(Target::Stdout),
        }
    }
}

/// Converts seam reports to JSON, with their faults and whether they pass.
pub(super) fn seams_json(reports: &SeamReports) -> Value {
    let of_channel = |of: &ChannelReport| {
        let faults = of.report.faults().into_iter();
        let faults =
            faults.map(|fault| json!({ "channel": of.channel, "fault": fault.to_string() }));
        faults.collect::<Vec<_>>()
    };
    let faults: Vec<_> = reports.channels().iter().flat_map(of_channel).collect();
    json!({ "passes": reports.passes(), "faults": faults, "channels": reports.channels() })
}

/// Describes an image's channels, transparency and seams.
fn image_findings(path: &Path, args: &Args) -> Result<Findings> {
    let image = match input::numbers(path, args.region) {
        Ok(image) => image,
        Err(error) if args.region.is_none() => return header_findings(path, error),
        Err(error) => return Err(error),
    };
    let mut channels = channels(&image.content).with_context(|| input::name(path))?;
    if let Some(Region { first, size }) = args.region.filter(|_| !image.is_part) {
        for channel in &mut channels {
            let part = channel.values.crop(first, size);
            channel.values = part.wrong_value().with_context(|| input::name(path))?;
        }
    }
    let n_not_finite: usize = channels.iter().map(Channel::n_not_finite).sum();
    let seams = match args.wrap {
        Axes::None => None,
        _ if n_not_finite > 0 => None,
        axes => {
            let options = SeamOptions {
                axes: axes.flags(),
                lattice: args.lattice.0,
            };
            let named = channels.iter().map(|of| (of.name.as_str(), &of.values));
            let reports = SeamReports::of(named, &options);
            Some(reports.with_context(|| input::name(path))?)
        }
    };
    let size = channels
        .first()
        .map_or([0; 2], |channel| channel.values.size());
    let format = format(&image.content);
    let mut text = format!(
        "{}: {} × {} pixels, {format}",
        input::name(path),
        size[0],
        size[1]
    );
    text += &channels::table(&channels);
    let transparency = channels::transparency(&channels);
    if let Some(transparency) = &transparency {
        text += &format!("\n{transparency}");
    }
    match &seams {
        Some(report) => text += &format!("\n{report}"),
        None if n_not_finite > 0 => text += "\nno seam report: not all pixels are finite",
        None => {}
    }
    let channels: Vec<_> = channels.iter().map(Channel::to_json).collect();
    let json = json!({
        "file": input::name(path), "kind": "image", "format": format, "size": size,
        "channels": channels, "transparency": transparency,
        "seams": seams.as_ref().map(seams_json),
    });
    Ok(Findings {
        text: text + "\n",
        json,
        is_good: n_not_finite == 0 && seams.is_none_or(|report| report.passes()),
    })
}

/// Describes an image that has too many pixels, from its header alone. Returns `error` unless the number of pixels
/// caused it.
fn header_findings(path: &Path, error: Error) -> Result<Findings> {
    let Some(limit) = input::exceeded_limit(&error) else {
        return Err(error);
    };
    let Ok(ImageHeader {
        format, size, bits, ..
    }) = read_header(path)
    else {
        return Err(error);
    };
    let [width, height] = size;
    let bits = bits.map_or(String::new(), |bits| format!(", {bits} bits per channel"));
    let name = input::name(path);
    let text = format!(
        "{name}: {width} × {height} pixels, {format}{bits}\n  \
        pixels were not read, since there are more than {limit}; see --max-pixels and --region\n"
    );
    let json = json!({
        "file": name, "kind": "image", "format": format!("{format}{bits}"), "size": size,
        "channels": null, "transparency": null, "seams": null,
    });
    Ok(Findings {
        text,
        json,
        // An image whose pixels were not read does not pass.
        is_good: false,
    })
}
