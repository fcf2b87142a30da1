//! Development commands of the workspace: `cargo xtask gallery`, `docs-images`, `bench`, `studio`, `web`, `golden`,
//! `licenses`, `tidy` and `ci`.
//!
//! The binary depends on no other crate of the workspace, so that it compiles quickly. Commands that need one run
//! `cargo run --release`.

#![forbid(unsafe_code)]

mod ci;
mod command;
mod licenses;
mod run;
mod tidy;
mod web;

use command::{Command, HELP};
use std::path::Path;
use std::process::ExitCode;
use xshell::Shell;

fn main() -> ExitCode {
    match command::parse(lexopt::Parser::from_env()).and_then(|command| perform(&command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn perform(command: &Command) -> anyhow::Result<()> {
    let shell = Shell::new()?;
    shell.change_dir(root());
    match command {
        Command::Gallery(arguments) => run::gallery(&shell, arguments),
        Command::DocsImages { check } => run::docs_images(&shell, *check),
        Command::Bench(arguments) => run::bench(&shell, arguments),
        Command::Studio(arguments) => run::studio(&shell, arguments),
        Command::Web { out } => web::web(&shell, out.clone()),
        Command::Golden { bless } => run::golden(&shell, *bless),
        Command::Licenses { check } => licenses::licenses(&shell, *check),
        Command::Tidy => tidy::tidy(&shell),
        Command::Ci(steps) => ci::ci(&shell, steps),
        Command::Help => {
            say(HELP);
            Ok(())
        }
    }
}

/// Returns the root of the workspace.
fn root() -> &'static Path {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask)
}

#[expect(clippy::print_stdout, reason = "this is what the program says")]
fn say(text: &str) {
    println!("{text}");
}
