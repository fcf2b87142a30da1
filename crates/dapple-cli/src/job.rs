//! Manages a run of a subcommand, with its output files, its messages, and its sidecar, a JSON file next to the output.

use crate::args::{ImageArgs, OutputArgs, Targets};
use crate::arguments::GivenOption;
use crate::encode::{
    Cover, Format, content, default_format, encode, encode_with_alpha, n_clipped_of, ramped, range,
};
use crate::error::{Exit, Hint, printable, usage};
use crate::output::{OutputIdx, Outputs, Sink, Target};
use crate::progress::Style;
use anyhow::{Context as _, Result};
use dapple::image::Content;
use dapple::tile::Map;
use serde::Serialize;
use serde_json::Value;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::Path;

/// Settings for the whole process.
#[derive(Clone, Debug)]
pub(crate) struct Context {
    /// Whether only errors and requested reports are printed.
    pub(crate) quiet: bool,
    /// The style of the progress display.
    pub(crate) progress: Style,
    /// Number of threads; 0 means one per core.
    pub(crate) threads: u16,
    /// The command line of this process, one entry per argument.
    pub(crate) arguments: Vec<String>,
    /// The options that were given on the command line, for error messages.
    pub(crate) options: Vec<GivenOption>,
}

#[cfg(feature = "studio")]
impl Context {
    /// Returns a copy of the settings that suppresses messages.
    pub(crate) fn silent(&self) -> Self {
        Self {
            quiet: true,
            ..self.clone()
        }
    }
}

/// A run of a subcommand.
#[derive(Debug)]
pub(crate) struct Job<'a> {
    context: &'a Context,
    /// The name of the subcommand.
    command: &'static str,
    args: &'a OutputArgs,
    outputs: Outputs,
    files: Vec<(OutputIdx, FileRecord)>,
    sidecar: Option<OutputIdx>,
}

/// An output's entry in the sidecar.
#[derive(Clone, Debug, Default, Serialize)]
struct FileRecord {
    file: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    format: Option<Format>,
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<[u32; 2]>,
    /// Minimum and maximum of the values, before they are clamped and rounded for the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f32; 2]>,
    /// Number of pixels with a value that the format clips.
    #[serde(skip_serializing_if = "is_zero")]
    clipped: u64,
    bytes: u64,
    sha256: String,
}

/// Returns whether the count is zero; serde then omits it.
fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// The content of the sidecar.
#[derive(Serialize)]
struct Sidecar<'a> {
    dapple: &'static str,
    command: &'static str,
    arguments: &'a [String],
    options: Value,
    #[serde(skip_serializing_if = "Value::is_null")]
    report: Value,
    outputs: Vec<&'a FileRecord>,
    #[serde(flatten)]
    raw: Option<RawSize>,
}

/// The size and bit depth of raw heights, which their file does not contain. The names are those that the landscape
/// importer of Unreal reads from the sidecar.
#[derive(Serialize)]
struct RawSize {
    width: u32,
    height: u32,
    bpp: u32,
}

/// Minimum fraction of clipped pixels at which a note is printed.
const CLIPPED_MIN: f64 = 0.01;

impl FileRecord {
    /// Returns the fraction of clipped pixels, from 0 to 1; `None` if it is below [`CLIPPED_MIN`].
    fn clipped_share(&self) -> Option<f64> {
        let [width, height] = self.size?;
        let share = self.clipped as f64 / (f64::from(width) * f64::from(height));
        (share >= CLIPPED_MIN).then_some(share)
    }

    /// Returns the size for the sidecar if the file has raw heights; otherwise `None`.
    fn raw_size(&self) -> Option<RawSize> {
        let [width, height] = self.size.filter(|_| self.format == Some(Format::R16))?;
        Some(RawSize {
            width,
            height,
            bpp: 16,
        })
    }
}

impl<'a> Job<'a> {
    /// Starts a run of the subcommand `command`.
    pub(crate) fn new(context: &'a Context, command: &'static str, args: &'a OutputArgs) -> Self {
        Self {
            context,
            command,
            args,
            outputs: Outputs::new(args.force),
            files: Vec::new(),
            sidecar: None,
        }
    }

    /// Claims an output file with binary content.
    ///
    /// # Errors
    ///
    /// Same as [`Outputs::claim`], or if the output is a terminal.
    pub(crate) fn claim(&mut self, target: &Target) -> Result<OutputIdx> {
        if *target == Target::Stdout && io::stdout().is_terminal() {
            let error = usage("standard output is a terminal, which cannot show this file");
            return Err(error.hint("give a file with -o, or add a pipe"));
        }
        self.claim_text(target)
    }

    /// Claims a file for each image, and the sidecar. Invalid names and formats fail here, before the work.
    ///
    /// # Errors
    ///
    /// Same as [`Format::choose`], [`claim`](Self::claim) and [`claim_sidecar`](Self::claim_sidecar).
    pub(crate) fn claim_images(
        &mut self,
        targets: &Targets,
        asked: Option<Format>,
    ) -> Result<Vec<OutputIdx>> {
        let mut outputs = Vec::new();
        for target in &targets.files {
            Format::choose(asked, target, Format::Png16)?;
            outputs.push(self.claim(target)?);
        }
        self.claim_sidecar(&targets.main)?;
        Ok(outputs)
    }

    /// Claims an output file with text.
    ///
    /// # Errors
    ///
    /// Same as [`Outputs::claim`].
    pub(crate) fn claim_text(&mut self, target: &Target) -> Result<OutputIdx> {
        let output = self.claim_in_folder(target)?;
        let record = FileRecord {
            file: target.to_string(),
            ..FileRecord::default()
        };
        self.files.push((output, record));
        Ok(output)
    }

    /// Claims the sidecar, if it is requested. It is next to the output, unless the command line names it. Raw heights
    /// always have a sidecar with their name, since their file does not contain their size. Claim all outputs before.
    ///
    /// # Errors
    ///
    /// Same as [`Outputs::claim`], or if the output is standard output and the sidecar has no name, or if the sidecar
    /// has the name of an output.
    pub(crate) fn claim_sidecar(&mut self, main: &Target) -> Result<()> {
        let target = match &self.args.json {
            None => {
                let targets = self
                    .files
                    .iter()
                    .map(|(output, _)| self.outputs.target(*output));
                match targets.into_iter().find(|target| target.ending() == "r16") {
                    Some(raw) => raw.clone().with_ending("json"),
                    None => return Ok(()),
                }
            }
            Some(Some(path)) => Target::from(path.as_path()),
            Some(None) => self.beside(main)?,
        };
        self.sidecar = Some(self.claim_in_folder(&target)?);
        Ok(())
    }

    /// Writes the content of a claimed file.
    ///
    /// # Errors
    ///
    /// Same as [`Outputs::write`].
    pub(crate) fn write(&self, output: OutputIdx, bytes: &[u8]) -> Result<()> {
        self.outputs.write(output, bytes)
    }

    /// Writes a map as an image in `format`, and records its size, its range and the number of clipped pixels.
    ///
    /// # Errors
    ///
    /// Same as [`encode`] and [`Outputs::write`].
    pub(crate) fn write_map(&mut self, output: OutputIdx, map: &Map, format: Format) -> Result<()> {
        format.check(content(map), self.target(output))?;
        self.write(output, &encode(map, format)?)?;
        self.note(output, format, map.size(), range(map));
        if !format.keeps_numbers() {
            self.note_clipped(output, n_clipped_of(map));
        }
        Ok(())
    }

    /// Records the number of pixels of an image that its format clips.
    pub(crate) fn note_clipped(&mut self, output: OutputIdx, n_pixels: u64) {
        for (_, record) in self.files.iter_mut().filter(|(at, _)| *at == output) {
            record.clipped = n_pixels;
        }
    }

    /// Returns the output options of the subcommand.
    pub(crate) fn args(&self) -> &'a OutputArgs {
        self.args
    }

    /// Prints a note that work begins to standard error, unless the command is quiet.
    pub(crate) fn note_work(&self, text: &str) {
        if !self.context.quiet {
            eprintln_if_possible(text);
        }
    }

    /// Returns the target of a claimed file.
    pub(crate) fn target(&self, output: OutputIdx) -> &Target {
        self.outputs.target(output)
    }

    /// Returns a writer for a claimed file, from its start. Flush it before [`finish`](Self::finish).
    ///
    /// # Errors
    ///
    /// Same as [`Outputs::writer`].
    pub(crate) fn writer(&self, output: OutputIdx) -> Result<BufWriter<Sink>> {
        self.outputs.writer(output)
    }

    /// Returns whether a sidecar is written. [`note`](Self::note) records the properties of the images for it.
    pub(crate) fn has_sidecar(&self) -> bool {
        self.sidecar.is_some()
    }

    /// Records the format, the size and the range of an image.
    pub(crate) fn note(
        &mut self,
        output: OutputIdx,
        format: Format,
        size: [u32; 2],
        range: [f32; 2],
    ) {
        for (_, record) in self.files.iter_mut().filter(|(at, _)| *at == output) {
            record.format = Some(format);
            record.size = Some(size);
            record.range = Some(range);
        }
    }

    /// Applies the ramp to a map of values, chooses the format, and writes the image.
    ///
    /// # Errors
    ///
    /// Same as [`Format::choose`] and [`write_map`](Self::write_map).
    pub(crate) fn write_image(
        &mut self,
        output: OutputIdx,
        map: Map,
        is_deep: bool,
        args: &ImageArgs,
    ) -> Result<()> {
        let map = ramped(map, args.ramp.as_ref());
        let default = default_format(&map, is_deep);
        let format = Format::choose(args.format, self.outputs.target(output), default)?;
        self.write_map(output, &map, format)
    }

    /// Writes an image like [`write_image`](Self::write_image). A color image is written with the given alpha.
    ///
    /// # Errors
    ///
    /// Same as [`write_image`](Self::write_image).
    pub(crate) fn write_with_alpha(
        &mut self,
        output: OutputIdx,
        map: Map,
        cover: Option<Cover<'_>>,
        is_deep: bool,
        args: &ImageArgs,
    ) -> Result<()> {
        let (Map::Color(colors), Some(cover)) = (&map, cover) else {
            return self.write_image(output, map, is_deep, args);
        };
        let default = default_format(&map, is_deep);
        let format = Format::choose(args.format, self.outputs.target(output), default)?;
        format.check(Content::ColorAlpha, self.target(output))?;
        self.write(output, &encode_with_alpha(colors, cover, format)?)?;
        self.note(output, format, map.size(), range(&map));
        if !format.keeps_numbers() {
            self.note_clipped(output, n_clipped_of(&map));
        }
        Ok(())
    }

    /// Prints a requested report to standard output, or to standard error if an output file is standard output.
    ///
    /// # Errors
    ///
    /// If standard output cannot be written.
    pub(crate) fn say(&self, text: &str) -> Result<()> {
        let is_taken =
            |(output, _): &(OutputIdx, FileRecord)| *self.outputs.target(*output) == Target::Stdout;
        if self.files.iter().any(is_taken) {
            eprintln_if_possible(text);
            return Ok(());
        }
        say(text)
    }

    /// Writes the sidecar, renames all files to their final paths, and prints a message for each.
    ///
    /// # Errors
    ///
    /// Same as [`Outputs::commit`].
    pub(crate) fn finish(self, options: &impl Serialize, report: Value) -> Result<()> {
        self.finish_with(&|| serde_json::to_value(options), report)
    }

    /// Implements [`finish`](Self::finish) without generics. `options` is called only if a sidecar is written.
    fn finish_with(
        mut self,
        options: &dyn Fn() -> serde_json::Result<Value>,
        report: Value,
    ) -> Result<()> {
        if let Some(sidecar) = self.sidecar {
            for (output, record) in &mut self.files {
                let content = self.outputs.content(*output)?;
                (record.bytes, record.sha256) = (content.bytes, content.sha256);
            }
            let options = options().context("the JSON file")?;
            let sidecar_content = Sidecar {
                dapple: env!("CARGO_PKG_VERSION"),
                command: self.command,
                arguments: &self.context.arguments,
                options,
                report,
                outputs: self.files.iter().map(|(_, record)| record).collect(),
                raw: self.files.iter().find_map(|(_, record)| record.raw_size()),
            };
            let mut text = serde_json::to_string_pretty(&sidecar_content)?;
            text.push('\n');
            self.outputs.write(sidecar, text.as_bytes())?;
        }
        // Commit the files, and report each on standard error.
        let is_file = |output| self.outputs.target(output) != &Target::Stdout;
        let files = self.files.iter().filter(|(output, _)| is_file(*output));
        let told = match self.context.progress {
            Style::Json => told_as_json,
            Style::Auto | Style::Lines => told,
        };
        let written: Vec<_> = files.map(|(_, record)| told(record)).collect();
        self.outputs.commit()?;
        for line in written.iter().filter(|_| !self.context.quiet) {
            eprintln_if_possible(line);
        }
        Ok(())
    }

    /// Claims a file, and creates its directory if it does not exist.
    fn claim_in_folder(&mut self, target: &Target) -> Result<OutputIdx> {
        let folder = target.path().and_then(Path::parent);
        if let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty()) {
            self.outputs.make_folder(folder)?;
        }
        self.outputs.claim(target)
    }

    /// Returns the default path of the sidecar: the output's path with the extension `.json`.
    fn beside(&self, main: &Target) -> Result<Target> {
        let Some(path) = main.path() else {
            return Err(
                usage("there is no output file beside which to write the JSON file")
                    .hint("name it: --json=FILE"),
            );
        };
        let target = Target::Path(path.with_extension("json"));
        let is_target =
            |(output, _): &(OutputIdx, FileRecord)| *self.outputs.target(*output) == target;
        if self.files.iter().any(is_target) {
            return Err(
                usage("the output and the JSON file would have the same name")
                    .hint("name the other: --json=FILE"),
            );
        }
        Ok(target)
    }
}

/// Prints to standard output.
///
/// # Errors
///
/// If standard output cannot be written.
pub(crate) fn say(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(printable(text).as_bytes())?;
    stdout.write_all(b"\n")?;
    Ok(stdout.flush()?)
}

/// Writes a text to the output, or to standard output if no output is given. In a directory, the file is
/// `NAME.EXTENSION`.
///
/// # Errors
///
/// If the output cannot be written.
pub(crate) fn put_text(
    mut job: Job<'_>,
    name: &str,
    ending: &str,
    text: &str,
    options: &impl Serialize,
) -> Result<Exit> {
    let target = match job.args.output {
        Some(_) => job.args.target(name, ending)?,
        None => Target::Stdout,
    };
    let output = job.claim_text(&target)?;
    job.claim_sidecar(&target)?;
    job.write(output, text.as_bytes())?;
    job.finish(options, Value::Null)?;
    Ok(Exit::Done)
}

/// Prints a line to standard error, and ignores errors.
pub(crate) fn eprintln_if_possible(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", printable(text));
}

/// Formats the message about a written file as a line of JSON.
fn told_as_json(record: &FileRecord) -> String {
    let mut line = serde_json::json!({
        "wrote": record.file, "size": record.size, "format": record.format
    });
    if let Some(share) = record.clipped_share() {
        line["clipped"] = share.into();
    }
    line.to_string()
}

/// Formats the message about a written file.
fn told(record: &FileRecord) -> String {
    let FileRecord {
        file, size, format, ..
    } = record;
    match (size, format) {
        (Some([width, height]), Some(format)) => {
            let (_, depth) = format.depth();
            let clipped = record.clipped_share().map_or(String::new(), |share| {
                let percent = 100.0 * share;
                format!(
                    "; {percent:.1} % of them are below 0 or above 1 and were clipped, which .exr and .npy keep"
                )
            });
            format!("wrote {file}: {width} × {height} pixels, {depth}{clipped}")
        }
        _ => format!("wrote {file}"),
    }
}
