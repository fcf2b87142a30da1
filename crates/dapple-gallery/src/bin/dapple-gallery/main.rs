//! Renders the figures of the papers into a folder with a page, or checks them against `figures.lock`.

mod check;
mod docs;
mod export;
mod own;
mod ranges;

use anyhow::ensure;
use clap::Parser;
use dapple_gallery::{Figure, select};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};

/// Renders every figure, or those whose name contains one of the filters, with a page to look at them.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask gallery", version)]
struct Arguments {
    /// Parts of the names of figures; without any, all figures.
    filter: Vec<String>,

    /// Pixels along the longer side of a picture.
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=16384))]
    size: u32,

    /// Makes pictures of 1024 pixels: some minutes.
    #[arg(long, conflicts_with = "size")]
    full: bool,

    /// Where the pictures and the page go; by default `target/gallery`.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Compares the figures with figures.lock, and writes nothing.
    #[arg(long, conflicts_with_all = ["bless", "out", "open", "size"])]
    check: bool,

    /// Rewrites figures.lock with the figures as they are now, and prints what changed.
    #[arg(long, conflicts_with_all = ["out", "open", "size"])]
    bless: bool,

    /// Opens the page in the browser.
    #[arg(long)]
    open: bool,

    /// Prints the names of the figures and nothing more.
    #[arg(long, conflicts_with_all = ["check", "bless", "out", "open", "size"])]
    list: bool,

    /// Prints the ranges of the combinations of Worley's basis, as the table in `dapple-worley` has them.
    #[arg(long, conflicts_with_all = ["list", "check", "bless", "out", "open", "size"])]
    ranges: bool,

    /// Rewrites the pictures in the documentation of the crates and in their READMEs, `docs/*` in their folders, or compares
    /// them with `--check`: what `cargo xtask docs-images` does.
    #[arg(long, conflicts_with_all = ["filter", "list", "bless", "out", "open", "size", "ranges"])]
    docs: bool,

    #[command(flatten)]
    own: own::OwnArguments,
}

/// The pixels of a picture with `--full`.
const FULL_SIZE: u32 = 1024;

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let figures = select(&arguments.filter);
    ensure!(
        !figures.is_empty(),
        "no figure has `{}` in its name; `--list` shows all names",
        arguments.filter.join("` or `")
    );
    let size = if arguments.full {
        FULL_SIZE
    } else {
        arguments.size
    };
    let out = arguments
        .out
        .unwrap_or_else(|| root().join("target/gallery"));
    if arguments.own.mesh.is_some() {
        own::run(&arguments.own, size, &out)
    } else if arguments.ranges {
        say(&ranges::table()?);
        Ok(())
    } else if arguments.docs && arguments.check {
        docs::check()
    } else if arguments.docs {
        docs::write()
    } else if arguments.list {
        figures.iter().for_each(|figure| say(&figure.name()));
        Ok(())
    } else if arguments.check {
        check::check(&figures, &lock_path())
    } else if arguments.bless {
        check::bless(&figures, &lock_path())
    } else {
        let page = export::export(&figures, size, &out)?;
        let shown = page.canonicalize().unwrap_or_else(|_| page.clone());
        say(&format!("{} figures in {}", figures.len(), shown.display()));
        if arguments.open {
            export::open(&page)
        } else {
            Ok(())
        }
    }
}

/// The root of the workspace.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

fn lock_path() -> PathBuf {
    root().join("crates/dapple-gallery/figures.lock")
}

/// A bar on the terminal that counts figures; nothing where there is no terminal.
fn progress(figures: &[&Figure]) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:32} {pos}/{len} {elapsed:>4} {msg}");
    ProgressBar::new(figures.len() as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

#[expect(clippy::print_stdout, reason = "this is what the program says")]
fn say(text: &str) {
    println!("{text}");
}
