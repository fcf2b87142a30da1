//! The command `dapple`: textures from the command line.
//!
//! `cli.rs` has the command line as a whole, `commands/` a file for each subcommand, and the other files what they share:
//! `args.rs` the options, `input.rs` what is read, `encode.rs` and `output.rs` what is written, `baking.rs` recipes drawn band by
//! band, `field.rs` a single field as a recipe, `job.rs` a run from its first claim of a file to its last word,
//! `error.rs` what went wrong.

#![forbid(unsafe_code)]

mod args;
mod baking;
mod cli;
mod commands;
mod encode;
mod error;
mod field;
mod foresight;
mod input;
mod job;
mod output;
mod progress;

use anyhow::{Context as _, Result};
use clap::Parser;
use cli::Cli;
use error::Exit;
use job::Context;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    run(&cli)
        .unwrap_or_else(|error| error::report(&error))
        .into()
}

fn run(cli: &Cli) -> Result<Exit> {
    ctrlc::set_handler(|| output::exit_without_rubbish(Exit::Interrupted))
        .context("there is no way to hear of Ctrl-C")?;
    rayon::ThreadPoolBuilder::new()
        .num_threads(cli.common.threads.into())
        .build_global()
        .context("the threads cannot be started")?;
    let arguments = std::env::args_os().skip(1);
    let context = Context {
        quiet: cli.common.quiet,
        arguments: arguments
            .map(|argument| argument.to_string_lossy().into_owned())
            .collect(),
    };
    commands::run(&cli.command, &context)
}
