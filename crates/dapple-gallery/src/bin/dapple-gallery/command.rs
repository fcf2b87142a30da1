//! The command line.

use clap::{ArgGroup, Parser, value_parser};
use std::path::PathBuf;

/// Renders the figures of the papers, with a page to look at them.
#[derive(Debug, Parser)]
#[command(bin_name = "cargo xtask gallery", version)]
#[command(group = ArgGroup::new("task"))]
pub(crate) struct Command {
    /// Parts of the names of figures; without filters, all figures
    #[arg(value_name = "FILTER")]
    pub(crate) filters: Vec<String>,
    /// Pixels along the longer side of an image, 1 to 16384
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = value_parser!(u32).range(1..=16384))]
    size: u32,
    /// Render images of 1024 pixels, which takes some minutes
    #[arg(long, conflicts_with = "size")]
    full: bool,
    /// Folder of the images and the page [default: target/gallery]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// Compare the figures with figures.lock, and write nothing
    #[arg(long, conflicts_with_all = ["size", "full", "out", "open", "bless", "list", "ranges"])]
    pub(crate) check: bool,
    /// Rewrite figures.lock and print what changed
    #[arg(long, group = "task", conflicts_with_all = ["size", "full", "out", "open"])]
    pub(crate) bless: bool,
    /// Print the names of the figures
    #[arg(long, group = "task", conflicts_with_all = ["size", "full", "out", "open"])]
    pub(crate) list: bool,
    /// Print the ranges of the combinations of Worley's basis, as in the table of dapple-worley
    #[arg(long, group = "task", conflicts_with_all = ["size", "full", "out", "open"])]
    pub(crate) ranges: bool,
    /// Rewrite the images in the documentation and READMEs of the crates, or compare them with --check
    #[arg(long, group = "task", conflicts_with_all = ["filters", "size", "full", "out", "open"])]
    pub(crate) docs: bool,
}

impl Command {
    /// Returns the size of images along their longer side, in pixels.
    pub(crate) fn size(&self) -> u32 {
        if self.full { 1024 } else { self.size }
    }
}

#[cfg(test)]
mod tests {
    use super::Command;
    use clap::{CommandFactory, Parser};

    fn parse(typed: &str) -> Result<Command, String> {
        let arguments = ["gallery"].into_iter().chain(typed.split_whitespace());
        Command::try_parse_from(arguments).map_err(|error| error.to_string())
    }

    #[test]
    fn options_are_consistent() {
        Command::command().debug_assert();
    }

    #[test]
    fn options_combine() {
        let drawn = parse("pups --size=64 worley --out there --open").unwrap();
        assert_eq!(drawn.filters, ["pups", "worley"]);
        assert_eq!((drawn.out, drawn.open), (Some("there".into()), true));
        for (typed, size) in [("", 512), ("--size 64", 64), ("--full", 1024)] {
            assert_eq!(parse(typed).unwrap().size(), size, "{typed}");
        }
        let docs = parse("--check --docs").unwrap();
        assert!(docs.check && docs.docs);
        assert!(parse("--check pups").unwrap().check);
    }

    #[test]
    fn refusals_name_the_options() {
        for (typed, names) in [
            ("--size 0", ["--size", "1..=16384"]),
            ("--size 16385", ["--size", "1..=16384"]),
            ("--size 9 --full", ["--size", "--full"]),
            ("--bless --check", ["--bless", "--check"]),
            ("--check --open", ["--check", "--open"]),
            ("--bless --out x", ["--bless", "--out"]),
            ("--check --list", ["--check", "--list"]),
            ("--list --ranges", ["--list", "--ranges"]),
            ("--docs --bless", ["--docs", "--bless"]),
            ("--docs pups", ["--docs", "FILTER"]),
        ] {
            let error = parse(typed).unwrap_err();
            let named = names.iter().all(|name| error.contains(name));
            assert!(named, "{typed} gives: {error}");
        }
    }
}
