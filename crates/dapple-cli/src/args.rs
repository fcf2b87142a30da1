//! Defines options shared by many subcommands, such as size, output and format.

mod alpha;
mod frame;
mod maps;
mod numbers;
mod part;
mod ramp;
mod read;
mod region;
mod samples;
mod shard;
mod size;

pub(crate) use alpha::{Alpha, AlphaArgs, image_alpha};
pub(crate) use frame::Frame;
pub(crate) use maps::MapArg;
pub(crate) use numbers::{Numbers, numbers_of};
pub(crate) use part::{PartArgs, resampled};
pub(crate) use ramp::RampArg;
pub(crate) use read::{FiniteArgs, NonFinite, ReadArgs};
pub(crate) use region::Region;
pub(crate) use samples::SamplesArgs;
pub(crate) use shard::Shard;
pub(crate) use size::{Extent, Size};

use crate::encode::Format;
use crate::error::{Hint, usage};
use crate::output::Target;
use crate::progress::Style;
use crate::words::NamedValueParser;
use anyhow::Result;
use clap::Args;
use dapple::color::Palette;
use dapple::raster::Named;
use std::path::{Path, PathBuf};

/// Options of all subcommands.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Common")]
pub(crate) struct Common {
    /// Number of threads; 0 means one per core. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub(crate) threads: u16,

    /// Maximum number of pixels of an input image [default: 2^28, which is 16384 x 16384].
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) max_pixels: Option<u64>,

    /// Progress display on standard error.
    ///
    /// `auto` is a bar on a terminal and lines elsewhere.
    #[arg(long, global = true, value_name = "STYLE", value_parser = NamedValueParser::<Style>::all(), default_value_t = Style::Auto)]
    pub(crate) progress: Style,

    /// Print only errors and requested reports.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

/// The output of subcommands that write files.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Output file, directory, or `-` for standard output.
    ///
    /// An existing directory or a trailing slash means a directory; for several files, so does a path without an
    /// extension. Missing directories are created.
    #[arg(short, long, value_name = "FILE|DIR/")]
    pub(crate) output: Option<PathBuf>,

    /// File name in a directory: `NAME.EXT` or `NAME_MAP.EXT` [default: the recipe, input or subcommand].
    #[arg(long, value_name = "NAME", value_parser = plain_name)]
    pub(crate) name: Option<String>,

    /// Overwrite existing files.
    #[arg(long)]
    pub(crate) force: bool,

    /// Also write a JSON sidecar: options, version, and the size, range and SHA-256 of each file. Raw heights always
    /// have one.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    pub(crate) json: Option<Option<PathBuf>>,
}

/// The output files of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Targets {
    /// The path `NAME.EXTENSION`. A run with several output files may not write this file itself. The sidecar has the
    /// same path with the extension `.json`.
    pub(crate) main: Target,
    /// The file of each part, such as a map, in the order in which the parts were given.
    pub(crate) files: Vec<Target>,
}

/// Options of subcommands that write images.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub(crate) struct ImageArgs {
    #[command(flatten)]
    pub(crate) files: OutputArgs,

    /// File format [default: by the extension of the output].
    ///
    /// `.exr` is OpenEXR, `.npy` a NumPy array, `.r16` raw heights. `.png` has 8 bits for color and 16 bits for data
    /// (gray images and normals), and 16 bits for color, too, if the input is deeper than 8.
    #[arg(long, value_name = "FORMAT", value_parser = NamedValueParser::<Format>::all())]
    pub(crate) format: Option<Format>,

    #[arg(long, value_name = "COLORS", help = ramp_help())]
    pub(crate) ramp: Option<RampArg>,
}

/// Returns the help text of `--ramp`, with the names of all palettes.
fn ramp_help() -> String {
    format!(
        "Color gray results: a palette ({}) or colors from low to high, such as `#123,#8ac,white`",
        Palette::NAMES.join(", ")
    )
}

dapple::raster::named! {
    /// The axes along which a picture repeats.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Axes {
        /// Left and right fit together.
        X = "x",
        /// Top and bottom fit together.
        Y = "y",
        /// All sides fit together.
        Both = "both",
        /// The picture does not repeat.
        None = "none",
    }
}

impl Axes {
    /// Creates a parser that accepts one or both axes, for options where `none` has no meaning.
    pub(crate) fn some() -> NamedValueParser<Self> {
        NamedValueParser::some(&[Self::X, Self::Y, Self::Both])
    }

    /// Returns, for each axis, whether the image repeats along it.
    pub(crate) fn flags(self) -> [bool; 2] {
        [
            matches!(self, Self::X | Self::Both),
            matches!(self, Self::Y | Self::Both),
        ]
    }

    /// Returns, for each axis, `wrapped` if the image repeats along it; otherwise `cut`.
    pub(crate) fn choose<T: Copy>(self, wrapped: T, cut: T) -> [T; 2] {
        self.flags().map(|wraps| if wraps { wrapped } else { cut })
    }
}

impl ImageArgs {
    /// Returns the file extension for images whose names the command chooses, from `--format`; `png` by default.
    pub(crate) fn ending(&self) -> &'static str {
        self.format.map_or("png", Format::ending)
    }
}

impl OutputArgs {
    /// Returns the output file of a run that writes a single file.
    ///
    /// # Errors
    ///
    /// Same as [`targets`](Self::targets).
    pub(crate) fn target(&self, name: &str, ending: &str) -> Result<Target> {
        Ok(self.targets(name, &[""], ending)?.main)
    }

    /// Returns the output files of a run that writes a file for each part: `NAME_PART.EXTENSION`, and `NAME.EXTENSION`
    /// for a part with an empty name.
    ///
    /// A single part is written to the output path itself, unless that is a directory. In a directory, NAME is the
    /// value of `--name`, or `name` without it.
    ///
    /// # Errors
    ///
    /// If no output is given, if several files would go to standard output, or if `--name` is given without a
    /// directory.
    pub(crate) fn targets<S: AsRef<str>>(
        &self,
        name: &str,
        parts: &[S],
        ending: &str,
    ) -> Result<Targets> {
        let Some(output) = self.output.as_deref() else {
            return Err(usage("missing output")
                .hint("add -o FILE, -o DIR/ for a folder, or -o - for standard output"));
        };
        let folder = self.folder(parts.len());
        if let (None, Some(name)) = (folder, &self.name) {
            let message = format!(
                "--name {name} is for folders, and {} is a file",
                output.display()
            );
            return Err(usage(message).hint("let -o end with a slash"));
        }
        let main = match folder {
            Some(folder) => {
                let name = self.name.clone().unwrap_or_else(|| file_name(name));
                Target::Path(folder.join(format!("{name}.{ending}")))
            }
            None => Target::from(output),
        };
        let files = match parts {
            [_] if folder.is_none() => vec![main.clone()],
            _ => {
                let files = parts.iter().map(|part| main.part(part.as_ref()));
                files.collect::<Result<_>>()?
            }
        };
        Ok(Targets { main, files })
    }

    /// Returns the output path if it means a directory; otherwise `None`. An existing directory or a trailing slash
    /// means a directory. If `n_files` is above 1, so does a path without an extension.
    pub(crate) fn folder(&self, n_files: usize) -> Option<&Path> {
        let output = self.output.as_deref()?;
        let ends_with_slash = output
            .as_os_str()
            .as_encoded_bytes()
            .last()
            .is_some_and(|&last| std::path::is_separator(char::from(last)));
        let has_ending = output.extension().is_some() || output == Path::new("-");
        (ends_with_slash || output.is_dir() || (n_files > 1 && !has_ending)).then_some(output)
    }
}

/// Parses a random seed.
///
/// # Errors
///
/// If the text is not a whole number from 0 to 2^64 − 1.
pub(crate) fn seed(text: &str) -> Result<u64, String> {
    let range = format!("a seed is a whole number from 0 to {}", u64::MAX);
    text.trim()
        .parse()
        .map_err(|_| match text.trim().starts_with('-') {
            true => format!("{range}, and not negative"),
            false => range,
        })
}

/// Parses a file name, which must not contain a directory.
fn plain_name(text: &str) -> Result<String, String> {
    if text.is_empty() || text.starts_with('.') || text.contains(['/', '\\']) {
        return Err("it becomes part of file names, without a slash or a leading dot".to_owned());
    }
    Ok(text.to_owned())
}

/// Makes a name safe for use in file names. Characters other than letters, digits, `.` and `_` become `-`, and leading
/// dots are removed. An empty result becomes `recipe`.
pub(crate) fn file_name(name: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || c == '.' || c == '_' {
            c
        } else {
            '-'
        }
    };
    let name: String = name.chars().map(plain).collect();
    let name = name.trim_start_matches('.');
    if name.is_empty() {
        "recipe".to_owned()
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::{OutputArgs, Target, file_name};
    use std::path::PathBuf;

    fn files(output: &str, name: Option<&str>, parts: &[&str]) -> Vec<String> {
        let args = OutputArgs {
            output: Some(PathBuf::from(output)),
            name: name.map(str::to_owned),
            ..OutputArgs::default()
        };
        let targets = args
            .targets("my rock", parts, "png")
            .map(|targets| targets.files);
        let targets = targets.unwrap_or_default();
        targets.iter().map(Target::to_string).collect()
    }

    #[test]
    fn an_output_is_a_file_or_a_folder_by_one_rule() {
        let maps = ["height", "ao"];
        for (output, name, parts, expected) in [
            ("a.png", None, &[""][..], &["a.png"][..]),
            ("a.png", None, &maps[..1], &["a.png"]),
            ("a.png", None, &maps, &["a_height.png", "a_ao.png"]),
            ("b/", None, &[""], &["b/my-rock.png"]),
            ("b/", None, &maps[..1], &["b/my-rock_height.png"]),
            (
                "b",
                None,
                &maps,
                &["b/my-rock_height.png", "b/my-rock_ao.png"],
            ),
            ("b", Some("x"), &["", "2x2"], &["b/x.png", "b/x_2x2.png"]),
            ("/", None, &[""], &["/my-rock.png"]),
            ("-", None, &[""], &["standard output"]),
            ("-", None, &maps, &[]),
            ("a.png", Some("x"), &maps, &[]),
        ] {
            assert_eq!(
                files(output, name, parts),
                expected,
                "{output} {name:?} {parts:?}"
            );
        }
    }

    #[test]
    fn names_of_recipes_are_safe_in_file_names() {
        for (name, expected) in [
            ("giraffe", "giraffe"),
            ("my rock", "my-rock"),
            ("../up", "-up"),
            ("..", "recipe"),
            ("a/b", "a-b"),
        ] {
            assert_eq!(file_name(name), expected, "{name}");
        }
    }
}
