//! Renders the figures of the papers into a folder with a page, or checks them against `figures.lock`.

mod check;
mod command;
mod docs;
mod export;
mod own;
mod ranges;

use anyhow::ensure;
use command::{Command, HELP, Task};
use dapple_gallery::{Figure, select};
use dapple_raster::parallel;
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    let command = command::parse(lexopt::Parser::from_env());
    match command.and_then(|command| perform(&command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn perform(command: &Command) -> anyhow::Result<()> {
    let out = command.out.as_deref();
    let out = out.map_or_else(|| root().join("target/gallery"), Path::to_path_buf);
    match &command.task {
        Task::Help => say(HELP),
        Task::Version => say(concat!("dapple-gallery ", env!("CARGO_PKG_VERSION"))),
        Task::Own(own) => own::run(own, command.size, &out)?,
        Task::Ranges => say(&ranges::table()?),
        Task::Docs { check: true } => docs::check()?,
        Task::Docs { check: false } => docs::write()?,
        Task::List => selected(command)?
            .iter()
            .for_each(|figure| say(&figure.name())),
        Task::Check => check::check(&selected(command)?, &lock_path())?,
        Task::Bless => check::bless(&selected(command)?, &lock_path())?,
        Task::Export { open } => {
            let figures = selected(command)?;
            let page = export::export(&figures, command.size, &out)?;
            let shown = page.canonicalize().unwrap_or_else(|_| page.clone());
            say(&format!("{} figures in {}", figures.len(), shown.display()));
            if *open {
                export::open(&page)?;
            }
        }
    }
    Ok(())
}

/// Returns the figures that the filters select; fails if there are none.
fn selected(command: &Command) -> anyhow::Result<Vec<&'static Figure>> {
    let figures = select(&command.filter);
    ensure!(
        !figures.is_empty(),
        "no figure has `{}` in its name; `--list` shows all names",
        command.filter.join("` or `")
    );
    Ok(figures)
}

/// Returns the root folder of the workspace.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

fn lock_path() -> PathBuf {
    root().join("crates/dapple-gallery/figures.lock")
}

/// Calls `draw` for each figure, several at a time on several cores, since few figures use all cores on their own.
/// Prints a line before each one if standard error is a terminal.
fn draw_each<T: Send>(
    figures: &[&'static Figure],
    draw: impl Fn(&'static Figure) -> anyhow::Result<T> + Sync,
) -> anyhow::Result<Vec<T>> {
    let is_shown = stderr().is_terminal();
    let drawn = parallel::map(figures.len(), |at| {
        let figure = figures[at];
        if is_shown {
            eprintln!("{}/{} {}", at + 1, figures.len(), figure.name());
        }
        draw(figure)
    });
    drawn.into_iter().collect()
}

#[expect(clippy::print_stdout, reason = "this is what the program says")]
fn say(text: &str) {
    println!("{text}");
}
