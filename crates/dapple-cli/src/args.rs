//! What many subcommands take: how large, where to, in which format.

mod alpha;
mod numbers;
mod ramp;
mod region;
mod size;

pub(crate) use alpha::{Alpha, AlphaArgs};
pub(crate) use numbers::Numbers;
pub(crate) use ramp::RampArg;
pub(crate) use region::Region;
pub(crate) use size::{Extent, Size};

use crate::encode::Format;
use crate::error::{Hint, usage};
use crate::output::Target;
use anyhow::Result;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// What every subcommand takes.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Common")]
pub(crate) struct Common {
    /// How many threads compute; 0 is one for each core. The result is the same bit for bit.
    #[arg(long, global = true, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub(crate) threads: u16,

    /// Print nothing but errors and what was asked for.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

/// Where files go, whatever they hold.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Where to write; `-` is standard output. Where several files are written, a folder.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Replace files that are there. Without it nothing is overwritten.
    #[arg(long)]
    pub(crate) force: bool,

    /// Write a JSON file beside the output: the options, the version, and size, range and SHA-256 of each file.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    pub(crate) json: Option<Option<PathBuf>>,
}

/// How images are written.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub(crate) struct ImageArgs {
    #[command(flatten)]
    pub(crate) files: OutputArgs,

    /// The format. By default by the ending of the output: EXR for `.exr`; for `.png` 8 bits for color and 16 bits for data
    /// (gray images and normals), and 16 bits for color, too, if the input is deeper than 8.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) format: Option<Format>,

    /// Color gray results: a palette (gray, lagoon, ember, terrain, cow, giraffe, labels) or colors from low to high,
    /// such as `#123,#8ac,white`.
    #[arg(long, value_name = "COLORS")]
    pub(crate) ramp: Option<RampArg>,
}

/// Along which axes something repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Axes {
    /// Left and right fit together.
    X,
    /// Top and bottom fit together.
    Y,
    /// All sides fit together.
    Both,
    /// Nothing repeats.
    None,
}

impl Axes {
    /// Whether x and y repeat.
    pub(crate) fn flags(self) -> [bool; 2] {
        [
            matches!(self, Self::X | Self::Both),
            matches!(self, Self::Y | Self::Both),
        ]
    }
}

impl OutputArgs {
    /// The target, which must be given.
    pub(crate) fn target(&self) -> Result<Target> {
        let target = self.output.as_deref().map(Target::from);
        target.ok_or_else(|| {
            usage("it is not said where to write").hint("add -o FILE, or -o - for standard output")
        })
    }

    /// The folder, if the output is one: it is there, or its name ends with a slash.
    pub(crate) fn folder(&self) -> Option<&Path> {
        let output = self.output.as_deref()?;
        let ends_with_slash = output
            .as_os_str()
            .as_encoded_bytes()
            .last()
            .is_some_and(|&last| std::path::is_separator(char::from(last)));
        (ends_with_slash || output.is_dir()).then_some(output)
    }
}
