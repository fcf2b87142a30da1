//! Renders the figures of the papers into a folder with a page, or checks them against `figures.lock`.

mod check;
mod command;
mod docs;
mod export;
mod ranges;

use anyhow::ensure;
use clap::Parser;
use command::Command;
use dapple_gallery::{Figure, select};
use dapple_raster::parallel;
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    match perform(&Command::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn perform(command: &Command) -> anyhow::Result<()> {
    if command.docs {
        return if command.check {
            docs::check()
        } else {
            docs::write()
        };
    }
    if command.ranges {
        say(&ranges::table()?);
        return Ok(());
    }
    let figures = selected(&command.filters)?;
    if command.list {
        figures.iter().for_each(|figure| say(&figure.name()));
        return Ok(());
    }
    if command.check {
        return check::check(&figures, &lock_path());
    }
    if command.bless {
        return check::bless(&figures, &lock_path());
    }
    let out = command.out.clone();
    let out = out.unwrap_or_else(|| root().join("target/gallery"));
    let page = export::export(&figures, command.size(), &out)?;
    let shown = page.canonicalize().unwrap_or_else(|_| page.clone());
    say(&format!("{} figures in {}", figures.len(), shown.display()));
    if command.open {
        export::open(&page)?;
    }
    Ok(())
}

/// Returns the figures that the filters select; fails if there are none.
fn selected(filters: &[String]) -> anyhow::Result<Vec<&'static Figure>> {
    let figures = select(filters);
    ensure!(
        !figures.is_empty(),
        "no figure has `{}` in its name; `--list` shows all names",
        filters.join("` or `")
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
