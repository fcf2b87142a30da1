//! `dapple join`: joins shards to entire images.

use crate::args::{Frame, OutputArgs, Targets};
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::input;
use crate::job::{Context, Job};
use crate::layers::LayerRows;
use crate::output::{OutputIdx, Sink, Target, cannot_be_written};
use crate::progress::Progress;
use crate::shards::{List, Task};
use crate::words::NamedValueParser;
use anyhow::{Context as _, Result, anyhow};
use dapple::color::LinearRgb;
use dapple::image::{Content, ExrImage, RowWriter};
use dapple::raster::{Raster, parallel};
use dapple::recipe::{MapKind, MapRows, Region};
use serde::Serialize;
use serde_json::Value;
use std::borrow::Cow;
use std::io::{BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple shards rock --size 256 --shard 128 -o parts/ | sh && dapple join parts/ -o rock.exr
  dapple shards ice --size 200 --shard 128 --maps height -o ice/ | sh && dapple join ice/ -o ice.png

The files are those that `dapple bake` writes of the whole picture, byte for byte. In memory is a row of shards of one map:
of a picture that is 200000 pixels wide, shards of 2048 x 256 take an eighth of what those of 2048 x 2048 do.";

/// Number of image rows that are joined at a time.
const BAND: u32 = 64;
/// Maximum number of missing files that an error message lists.
const NAMED: usize = 5;

/// Join the shards of a picture to one file for each map.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Directory with all shards, as in the list of `dapple shards`.
    #[arg(value_name = "DIR")]
    folder: PathBuf,

    /// File format [default: by the extension of the output, EXR in a directory].
    #[arg(long, value_name = "FORMAT", value_parser = NamedValueParser::<Format>::all(), help_heading = "Output")]
    format: Option<Format>,

    #[command(flatten)]
    #[serde(skip)]
    files: OutputArgs,
}

/// A map that is being written to a file.
struct Joined {
    kind: MapKind,
    format: Format,
    output: OutputIdx,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If the list is invalid, a shard is missing or damaged, or writing fails.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let folder = &args.folder;
    let list = List::read(folder)?.ok_or_else(|| {
        anyhow!("{} has no shards.json", folder.display())
            .hint("`dapple shards RECIPE … -o DIR` makes it with the list")
    })?;
    let kinds = list.map_kinds()?;
    check_whole(folder, &list, &kinds)?;
    if list.frames.is_some() && matches!(args.files.json, Some(Some(_))) {
        let error = usage("--json=FILE is for a single picture, but this is a loop");
        return Err(error.hint("use --json, which writes one file for each picture"));
    }
    for frame in Frame::all(list.frames) {
        // Check that all files can be claimed before the work begins.
        args.claim(
            &list,
            &kinds,
            frame,
            &mut Job::new(context, "join", &args.files),
        )?;
    }
    let n_files = kinds.len() as u64 * u64::from(list.frames.unwrap_or(1));
    let progress = Progress::bar("joining", n_files * u64::from(list.size[1]), context);
    for frame in Frame::all(list.frames) {
        let mut job = Job::new(context, "join", &args.files);
        for joined in args.claim(&list, &kinds, frame, &mut job)? {
            joined.write(folder, &list, frame, &mut job, &progress)?;
        }
        job.finish(args, Value::Null)?;
    }
    Ok(Exit::Done)
}

/// Checks that no file in the list is missing.
fn check_whole(folder: &Path, list: &List, kinds: &[MapKind]) -> Result<()> {
    let mut named = Vec::new();
    let [mut n_missing, mut n_files] = [0_u64; 2];
    // The directory of the last row, and whether it exists. If it does not, its files need not be looked for.
    let mut last = (PathBuf::new(), false);
    for Task { frame, shard, .. } in list.tasks()? {
        for &kind in kinds {
            n_files += 1;
            let path = folder.join(list.file(frame, shard.place, kind));
            let of_row = path.parent().unwrap_or(folder);
            if of_row != last.0 {
                last = (of_row.to_owned(), of_row.is_dir());
            }
            if last.1 && path.exists() {
                continue;
            }
            n_missing += 1;
            if named.len() < NAMED {
                named.push(path.display().to_string());
            }
        }
    }
    if n_missing == 0 {
        return Ok(());
    }
    let more = if n_missing > NAMED as u64 {
        ", …"
    } else {
        ""
    };
    let named = named.join(", ");
    let error = anyhow!("{n_missing} of {n_files} files are missing: {named}{more}");
    Err(error.hint("run the commands from `dapple shards` again; they only make missing files, and files of an older recipe do not count"))
}

impl Args {
    /// Claims a file for each map of a frame.
    fn claim(
        &self,
        list: &List,
        kinds: &[MapKind],
        frame: Option<Frame>,
        job: &mut Job<'_>,
    ) -> Result<Vec<Joined>> {
        let number = frame.map_or(String::new(), |frame| format!("_{}", frame.label()));
        let part = |kind: &MapKind| format!("{}{number}", kind.name());
        let mut parts: Vec<_> = kinds.iter().map(part).collect();
        if frame.is_some() {
            // Add a part, so that the single map of a frame is numbered like the maps of several.
            parts.push(String::new());
        }
        let ending = self.format.map_or("exr", Format::ending);
        let Targets { main, files } = self.files.targets(&list.name, &parts, ending)?;
        let mut all = Vec::new();
        for (&kind, target) in kinds.iter().zip(&files) {
            let format = self.format_of(kind, target)?;
            let output = job.claim(target)?;
            all.push(Joined {
                kind,
                format,
                output,
            });
        }
        job.claim_sidecar(&main.part(number.trim_start_matches('_'))?)?;
        Ok(all)
    }

    /// Returns the file format for a map. Fails if the format cannot be written row by row from shards.
    fn format_of(&self, kind: MapKind, target: &Target) -> Result<Format> {
        let asked = match target {
            Target::Stdout => self.format.or(Some(Format::Exr)),
            Target::Path(_) => self.format,
        };
        let format = Format::choose(asked, target, Format::Png16)?;
        format.check(kind.content(), target)?;
        if kind == MapKind::Normal && format == Format::Npy {
            let error = usage(format!(
                "{target}: normals in shards are (part + 1) / 2, rounded, and an array has the parts themselves"
            ));
            return Err(error.hint("join them as .exr or .png, or bake the array as a whole"));
        }
        Ok(format)
    }
}

impl Joined {
    /// Writes the image from its shards, one row of the grid of shards at a time.
    fn write(
        &self,
        folder: &Path,
        list: &List,
        frame: Option<Frame>,
        job: &mut Job<'_>,
        progress: &Progress,
    ) -> Result<()> {
        let target = job.target(self.output).clone();
        let failed = || cannot_be_written(&target);
        let encoding = self.format.encoding();
        let sink = job.writer(self.output)?;
        let mut writer =
            RowWriter::new(sink, list.size, content(self.kind), encoding).with_context(failed)?;
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        let mut n_clipped = 0;
        for number in 0..list.grid()?[1] {
            // Take rows and columns that shards share from the upper and from the left shard.
            let shared = if number > 0 { list.overlap } else { 0 };
            let row = list.row(frame, number)?;
            let height = row.first().map_or(0, |task| task.region.size[1]);
            let shards = parallel::map(row.len(), |at| self.read(folder, list, &row[at]));
            let shards = shards.into_iter().collect::<Result<Vec<_>>>()?;
            for first in (shared..height).step_by(BAND as usize) {
                let rows = first..height.min(first + BAND);
                progress.add(rows.len() as u64);
                let rows = self.band(&shards, list, rows)?;
                range = rows.range(range);
                let rows = LayerRows::Map(Cow::Owned(rows));
                if !self.format.keeps_numbers() {
                    n_clipped += rows.n_clipped();
                }
                rows.write(&mut writer).with_context(failed)?;
            }
        }
        finish(writer).with_context(failed)?;
        job.note(self.output, self.format, list.size, range);
        job.note_clipped(self.output, n_clipped);
        Ok(())
    }

    /// Reads the map of a shard.
    fn read(&self, folder: &Path, list: &List, task: &Task) -> Result<ExrImage> {
        let path = folder.join(list.file(task.frame, task.shard.place, self.kind));
        let Region { size, .. } = task.region;
        let image = input::exr(&path, size)?;
        for name in planes(self.kind) {
            let found = image.plane(name).map(Raster::size);
            if found.with_context(|| input::name(&path))? != size {
                return Err(anyhow!("{} has not the size of its shard", path.display()));
            }
        }
        Ok(image)
    }

    /// Returns the image rows `rows`, joined from the shards of one row of the grid.
    fn band(&self, shards: &[ExrImage], list: &List, rows: Range<u32>) -> Result<MapRows> {
        let size = [list.size[0], rows.end - rows.start];
        let plane = |name: &str| -> Result<Vec<f32>> {
            let mut values = Vec::with_capacity(size[0] as usize * size[1] as usize);
            for row in rows.clone() {
                for (column, shard) in shards.iter().enumerate() {
                    let shared = if column > 0 { list.overlap as usize } else { 0 };
                    values.extend_from_slice(&shard.plane(name)?.row(row)[shared..]);
                }
            }
            Ok(values)
        };
        let [red, green, blue] = match planes(self.kind) {
            [gray] => return Ok(MapRows::Gray(Raster::from_vec(size, plane(gray)?)?)),
            [red, green, blue, ..] => [plane(red)?, plane(green)?, plane(blue)?],
            _ => return Err(anyhow!("a map has one plane or three")),
        };
        let pixels = red.into_iter().zip(green).zip(blue);
        let pixels = pixels.map(|((red, green), blue)| [red, green, blue]);
        Ok(match content(self.kind) {
            Content::Color => {
                let colors = pixels.map(LinearRgb::from).collect();
                MapRows::Color(Raster::from_vec(size, colors)?)
            }
            _ => MapRows::Packed(Raster::from_vec(size, pixels.collect())?),
        })
    }
}

fn finish(writer: RowWriter<BufWriter<Sink>>) -> Result<()> {
    Ok(writer.finish()?.flush()?)
}

/// Returns the content type of a joined image. Shards store normals as numbers from 0 to 1, which are encoded to the
/// same codes as the normals.
fn content(kind: MapKind) -> Content {
    match kind.content() {
        Content::Normal => Content::Packed,
        content => content,
    }
}

/// Returns the names of the OpenEXR planes in a map's shards.
fn planes(kind: MapKind) -> &'static [&'static str] {
    match content(kind) {
        Content::Gray => &["Y"],
        _ => &["R", "G", "B"],
    }
}
