//! The command `dapple`: textures from the command line.
//!
//! `cli.rs` defines the command line, and `commands/` has a file for each subcommand. The other files are shared:
//!
//! - `arguments.rs` normalizes the arguments, `words.rs` parses names of values, and `args.rs` defines shared options.
//! - `input.rs` reads files; `encode.rs` and `output.rs` write them.
//! - `baking.rs` bakes recipes band by band, `layers.rs` assigns maps to the channels of images, `field.rs` renders a
//!   single field as a recipe, and `shards.rs` names the shards of a map.
//! - `job.rs` is a run of a subcommand, from its first claimed file to its last message. `error.rs` reports errors.

#![forbid(unsafe_code)]

mod args;
mod arguments;
mod baking;
mod cli;
mod commands;
mod encode;
mod error;
mod estimate;
mod exemplar;
mod field;
mod finite;
mod gpu;
mod input;
mod job;
mod layers;
mod node;
mod output;
mod preview;
mod progress;
mod shader_language;
mod shards;
mod words;

use anyhow::{Context as _, Result};
use arguments::GivenOption;
use cli::Cli;
use error::Exit;
use job::Context;
use std::process::ExitCode;

fn main() -> ExitCode {
    let (cli, options) = arguments::parse();
    let typed: Vec<_> = std::env::args_os().skip(1).collect();
    let arguments: Vec<_> = typed
        .iter()
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    run(&cli, &arguments, &options)
        .unwrap_or_else(|error| error::report(&error, &options))
        .into()
}

fn run(cli: &Cli, arguments: &[String], options: &[GivenOption]) -> Result<Exit> {
    ctrlc::set_handler(|| output::exit_without_rubbish(Exit::Interrupted))
        .context("the handler of Ctrl-C cannot be installed")?;
    rayon::ThreadPoolBuilder::new()
        .num_threads(cli.common.threads.into())
        .build_global()
        .context("the threads cannot be started")?;
    if let Some(pixels) = cli.common.max_pixels {
        input::set_max_pixels(pixels);
    }
    input::set_quiet(cli.common.quiet);
    let context = Context {
        quiet: cli.common.quiet,
        progress: cli.common.progress,
        threads: cli.common.threads,
        arguments: arguments.to_vec(),
        options: options.to_vec(),
    };
    commands::run(&cli.command, &context)
}
