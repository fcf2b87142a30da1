//! `dapple shards`: lists the commands that bake a recipe in shards.

mod openjd;

use super::bake::MaterialArgs;
use crate::args::Size;
use crate::baking::{STILL, advise_shard, read_images, read_recipe};
use crate::error::{Exit, Hint, usage};
use crate::job::{Context, eprintln_if_possible};
use crate::shards::{List, Task, Wanted};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::recipe::{Bake, BakeMemory, BakeOptions, MapKind, Plan, Region};
use serde::{Serialize, Serializer};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple shards flagstone --size 256 --shard 64 -o parts/ > list
  dapple shards rock --size 200000 --shard 2048 --maps height,normal -o rock/ > list
  dapple shards clouds --size 512 --shard 256 --frames 24 -o sky/ --format json
  dapple shards rock --size 8192 --shard 1024 -o rock/ --format openjd > job.json

A shard has the bits that the whole picture has there, so that any number of machines bake them, in any order. Each is
written whole or not at all, and one that is there is not made again: after anything that went wrong, run the list again.
Then `dapple join rock/ -o rock.exr` puts them together.

On one machine, in a shell or with GNU parallel (with --threads 1 the list says so to each bake):
  sh list
  parallel --jobs 4 < list

On a cluster with SLURM, as the last line of a script with `#SBATCH --array=1-9604`, or of one with `--array=0-999` where
arrays may not be that long:
  sed -n \"${SLURM_ARRAY_TASK_ID}p\" list | sh
  awk \"NR % 1000 == ${SLURM_ARRAY_TASK_ID}\" list | sh -e

On a render farm with Open Job Description, from a template in this folder:
  openjd check job.json
  openjd run job.json

Terrain tiles of engines share the samples along their borders: shards with --overlap 1 have the same bits there. Pictures of
1009, 2017, 4033 and 8129 pixels fit Unreal, and of 2^n + 1 Unity. With --samples corners the samples lie on the sides of the
tile, and the last ones equal the first ones where it repeats. `bake --region` writes single tiles as raw heights:
  dapple shards flagstone --size 257 --samples corners --shard 129 --overlap 1 \\
    --maps height -o tiles/ > list
  dapple bake flagstone --size 257 --samples corners --maps height \\
    --region 128,0,129,129 -o x1_y0.r16";

dapple::raster::named! {
    /// The formats of a list of shards.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum ListFormat {
        /// A shell command for each shard, one per line.
        Lines = "lines",
        /// A document in JSON.
        Json = "json",
        /// A job template of Open Job Description.
        OpenJd = "openjd",
    }
}

/// List the commands that bake a picture in shards, on any number of machines.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A built-in recipe, or a file in TOML or JSON.
    #[arg(value_name = "RECIPE")]
    recipe: String,

    #[command(flatten)]
    material: MaterialArgs,

    /// Size of a shard in pixels; shards at the right and at the bottom may be smaller.
    #[arg(long, value_name = "WxH")]
    shard: Size,

    /// Columns and rows shared by neighboring shards, included in their size; 1 for terrain tiles with equal borders.
    #[arg(long, value_name = "PX", default_value_t = 0)]
    overlap: u32,

    /// Number of frames of a loop, each in shards.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,

    /// Format of the printed list.
    #[arg(long, value_name = "FORM", value_parser = NamedValueParser::<ListFormat>::all(), default_value_t = ListFormat::Lines)]
    format: ListFormat,

    /// Directory of the shards; its file `shards.json` describes them.
    #[arg(short, long, value_name = "DIR", default_value = "shards")]
    output: PathBuf,

    /// Overwrite the `shards.json` of other shards; their files stay and remain distinct.
    #[arg(long)]
    force: bool,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If the recipe cannot be baked in shards, or the directory has a list of other shards.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    if args.recipe == "-" {
        let error = usage("shards need a recipe file, since every one of them reads it again");
        return Err(error.hint("put it into a file"));
    }
    let (mut recipe, folder) = read_recipe(&args.recipe)?;
    args.material.check_single()?;
    args.material.change(&mut recipe, None)?;
    let maps = args.material.map_kinds(&recipe.material);
    let wanted = Wanted {
        size: args.material.size,
        samples: args.material.samples,
        supersample: args.material.supersample_word(),
        shard: args.shard,
        overlap: args.overlap,
        maps: &maps,
        frames: args.frames,
        finite: args.material.finite,
    };
    let list = List::new(&args.recipe, &recipe, folder, &wanted)?;
    let images = read_images(&recipe, folder, args.material.finite)?;
    let plan = Plan::new(&recipe, &images, 0.0).map_err(|error| args.material.blame(error))?;
    let first = list.tasks()?.next().map(|task| task.region);
    check(&plan, args, first, &maps)?;
    if args.frames.is_some() && !plan.moves() && !context.quiet {
        eprintln_if_possible(STILL);
    }
    list.write(&args.output, args.force)?;
    let mut options = args.material.words();
    if context.threads > 0 {
        options.push(format!("--threads={}", context.threads));
    }
    let mut out = BufWriter::new(io::stdout().lock());
    match args.format {
        ListFormat::Lines => lines(args, &options, &list, &mut out)?,
        ListFormat::Json => json(&list, &maps, &mut out)?,
        ListFormat::OpenJd => {
            let template = openjd::template(args, options, &list)?;
            serde_json::to_writer_pretty(&mut out, &template)?;
            out.write_all(b"\n")?;
        }
    }
    out.flush()?;
    if !context.quiet {
        let count = list.n_tasks()?;
        eprintln_if_possible(&format!(
            "{count} shards; `dapple join {}` puts them together",
            args.output.display()
        ));
    }
    Ok(Exit::Done)
}

/// Checks that the bake of a shard can be set up.
fn check(plan: &Plan, args: &Args, region: Option<Region>, maps: &[MapKind]) -> Result<()> {
    let options = BakeOptions {
        size: args.material.size.0,
        samples: args.material.samples.samples,
        supersample: args.material.supersample,
        region,
        maps: maps.to_vec(),
        memory: BakeMemory::Banded,
        ..BakeOptions::default()
    };
    let bake = Bake::new(plan, &options);
    bake.map_err(|error| advise_shard(error).wrong_value())?;
    Ok(())
}

/// Writes a shell command for each shard. `options` are the arguments of every bake.
fn lines(args: &Args, options: &[String], list: &List, out: &mut impl Write) -> Result<()> {
    let output = text_of_path(&args.output)?;
    for Task { frame, shard, .. } in list.tasks()? {
        let mut words = vec!["dapple".to_owned(), "bake".to_owned(), args.recipe.clone()];
        words.extend_from_slice(options);
        words.push(format!("--shard={shard}"));
        words.extend(frame.map(|frame| format!("--frame={frame}")));
        words.extend(["-o".to_owned(), output.to_owned()]);
        let words: Vec<_> = words.iter().map(|word| quoted(word)).collect();
        writeln!(out, "{}", words.join(" "))?;
    }
    Ok(())
}

/// Writes the list with all shards as a JSON document.
fn json(list: &List, maps: &[MapKind], out: &mut impl Write) -> Result<()> {
    let document = Document {
        list,
        shards: Entries { list, maps },
    };
    serde_json::to_writer_pretty(&mut *out, &document)?;
    Ok(out.write_all(b"\n")?)
}

/// The list of shards as a JSON document.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    list: &'a List,
    shards: Entries<'a>,
}

/// The shards of a list, as a sequence that is generated during serialization. A long list needs no memory.
struct Entries<'a> {
    list: &'a List,
    maps: &'a [MapKind],
}

/// A shard in the JSON document.
#[derive(Serialize)]
struct Entry {
    index: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<String>,
    first: [u32; 2],
    size: [u32; 2],
    files: Vec<PathBuf>,
}

impl Serialize for Entries<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let tasks = self.list.tasks().map_err(serde::ser::Error::custom)?;
        let entry = |(index, task): (u64, Task)| {
            let place = task.shard.place;
            let file = |&kind: &MapKind| self.list.file(task.frame, place, kind);
            Entry {
                index,
                frame: task.frame.map(|frame| frame.to_string()),
                first: task.region.first,
                size: task.region.size,
                files: self.maps.iter().map(file).collect(),
            }
        };
        serializer.collect_seq((0..).zip(tasks).map(entry))
    }
}

/// Converts a path to text. Fails unless it is valid UTF-8.
fn text_of_path(path: &Path) -> Result<&str> {
    path.to_str().ok_or_else(|| {
        usage(format!(
            "{} is not in UTF-8, which a list has to be",
            path.display()
        ))
    })
}

/// Quotes a word for a POSIX shell if it has special characters.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./,:=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_are_quoted_where_a_shell_would_change_them() {
        for (word, expected) in [
            ("a/b-c_1,2.toml", "a/b-c_1,2.toml"),
            ("my rock", "'my rock'"),
            ("it's", r"'it'\''s'"),
            ("$HOME", "'$HOME'"),
            ("~/rock", "'~/rock'"),
            ("", "''"),
            ("größe", "'größe'"),
        ] {
            assert_eq!(quoted(word), expected);
        }
    }
}
