//! Command line parsing.

use crate::ci::Step;
use anyhow::{anyhow, bail};
use lexopt::{Arg, Parser};
use std::ffi::OsString;
use std::path::PathBuf;

/// The help text, printed by `cargo xtask` without a command.
pub(crate) const HELP: &str = "\
The chores of dapple.

Usage: cargo xtask <command>

  gallery [filter...]   render the figures, or those with a filter in their name, into target/gallery/
      --size N            pixels along the longer side of a picture (512)
      --out DIR           another folder
      --open              open the page in the browser
      --check             compare with crates/dapple-gallery/figures.lock instead
      --bless             accept the figures as they are now into figures.lock
      --list              print the names of the figures
  docs-images [--check] rewrite the pictures in the documentation and the READMEs, crates/*/docs/*, or compare them
  bench [filter...]     measure beside the peers, and print a table
      --json FILE         write the rows to a file, too
      --check             fail when a row misses its bar
  studio [argument...]  build the page of the studio with Node, and open it; arguments are those of `dapple studio`
  web [--out DIR]       build the studio without a server, for any host of files, into target/web/
  golden [--bless]      compare the golden images of tests/golden/, or rewrite them
  licenses [--check]    rewrite the texts of the licenses of other people's crates, or compare them
  tidy                  check the house rules: layers, lints, headers, lengths, figures.lock
  ci [step...]          what CI runs, or some of its steps: test fmt clippy doc tidy
                      licenses shaders features package exchange page web python fuzz";

/// A command of `cargo xtask` and its arguments.
#[derive(Debug, PartialEq)]
pub(crate) enum Command {
    /// Render figures. The arguments are passed to the binary `dapple-gallery`.
    Gallery(Vec<OsString>),
    /// Rewrite or compare the images in the documentation.
    DocsImages {
        /// Compare the images instead of rewriting them.
        check: bool,
    },
    /// Run the benchmarks. The arguments are passed to the binary `dapple-bench`.
    Bench(Vec<OsString>),
    /// Build the page of the studio and open it. The arguments are passed to `dapple studio`.
    Studio(Vec<OsString>),
    /// Build the studio without a server.
    Web {
        /// The output folder.
        out: Option<PathBuf>,
    },
    /// Compare or rewrite the golden images.
    Golden {
        /// Rewrite the images instead of comparing them.
        bless: bool,
    },
    /// Rewrite or compare the license texts of third-party crates.
    Licenses {
        /// Compare the texts instead of rewriting them.
        check: bool,
    },
    /// Check the project rules.
    Tidy,
    /// Run steps of CI.
    Ci(Vec<Step>),
    /// Print the help.
    Help,
}

/// Parses the arguments into a command.
pub(crate) fn parse(mut parser: Parser) -> anyhow::Result<Command> {
    let name = match parser.next()? {
        None | Some(Arg::Long("help") | Arg::Short('h')) => return Ok(Command::Help),
        Some(Arg::Value(name)) => name.to_string_lossy().into_owned(),
        Some(other) => bail!("{}; see `cargo xtask help`", other.unexpected()),
    };
    match name.as_str() {
        "gallery" => Ok(Command::Gallery(parser.raw_args()?.collect())),
        "bench" => Ok(Command::Bench(parser.raw_args()?.collect())),
        "studio" => Ok(Command::Studio(parser.raw_args()?.collect())),
        "docs-images" => Ok(Command::DocsImages {
            check: flag(parser, &name, "check")?,
        }),
        "web" => web(parser),
        "golden" => Ok(Command::Golden {
            bless: flag(parser, &name, "bless")?,
        }),
        "licenses" => Ok(Command::Licenses {
            check: flag(parser, &name, "check")?,
        }),
        "tidy" => nothing_more(parser, Command::Tidy),
        "ci" => ci(parser),
        "help" => nothing_more(parser, Command::Help),
        _ => bail!(
            "there is no command `{name}`; there are gallery, docs-images, bench, studio, web, golden, licenses, tidy, ci and help"
        ),
    }
}

/// Parses the arguments of a command with a single option, and returns whether it was given.
fn flag(mut parser: Parser, command: &str, option: &str) -> anyhow::Result<bool> {
    let mut is_there = false;
    while let Some(argument) = parser.next()? {
        match argument {
            Arg::Long(long) if long == option => is_there = true,
            other => bail!(
                "{}; `{command}` takes `--{option}` and nothing else",
                other.unexpected()
            ),
        }
    }
    Ok(is_there)
}

fn web(mut parser: Parser) -> anyhow::Result<Command> {
    let mut out = None;
    while let Some(argument) = parser.next()? {
        match argument {
            Arg::Long("out") => out = Some(parser.value()?.into()),
            other => bail!(
                "{}; `web` takes `--out DIR` and nothing else",
                other.unexpected()
            ),
        }
    }
    Ok(Command::Web { out })
}

fn ci(mut parser: Parser) -> anyhow::Result<Command> {
    let mut steps = Vec::new();
    while let Some(argument) = parser.next()? {
        let Arg::Value(name) = argument else {
            bail!("{}; `ci` takes the names of steps", argument.unexpected());
        };
        let name = name.to_string_lossy();
        let step = Step::ALL.into_iter().find(|step| step.name() == name);
        steps.push(
            step.ok_or_else(|| anyhow!("CI has no step `{name}`; it has {}", Step::names()))?,
        );
    }
    if steps.is_empty() {
        steps = Step::ALL.to_vec();
    }
    Ok(Command::Ci(steps))
}

fn nothing_more(mut parser: Parser, command: Command) -> anyhow::Result<Command> {
    match parser.next()? {
        None => Ok(command),
        Some(argument) => bail!("{}; this command takes no arguments", argument.unexpected()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Command, parse};
    use crate::ci::Step;
    use lexopt::Parser;

    fn command(arguments: &[&str]) -> Result<Command, String> {
        parse(Parser::from_args(arguments)).map_err(|error| error.to_string())
    }

    #[test]
    fn commands_are_understood() {
        let filtered = ["gallery", "pups", "--size", "64"];
        let rest = filtered[1..].iter().map(Into::into).collect();
        assert_eq!(command(&filtered), Ok(Command::Gallery(rest)));
        assert_eq!(
            command(&["golden", "--bless"]),
            Ok(Command::Golden { bless: true })
        );
        assert_eq!(command(&["golden"]), Ok(Command::Golden { bless: false }));
        assert_eq!(
            command(&["docs-images", "--check"]),
            Ok(Command::DocsImages { check: true })
        );
        assert_eq!(
            command(&["ci", "fmt", "tidy"]),
            Ok(Command::Ci(vec![Step::Fmt, Step::Tidy]))
        );
        assert_eq!(command(&["ci"]), Ok(Command::Ci(Step::ALL.to_vec())));
        assert_eq!(
            command(&["licenses", "--check"]),
            Ok(Command::Licenses { check: true })
        );
        let out = Some("a".into());
        assert_eq!(command(&["web", "--out", "a"]), Ok(Command::Web { out }));
        for help in [&[][..], &["help"], &["--help"], &["-h"]] {
            assert_eq!(command(help), Ok(Command::Help));
        }
    }

    #[test]
    fn unknown_words_are_answered_with_what_there_is() {
        for (arguments, hint) in [
            (&["galery"][..], "there are gallery, docs-images"),
            (&["--chek"], "cargo xtask help"),
            (&["golden", "--check"], "takes `--bless`"),
            (&["docs-images", "pups"], "takes `--check`"),
            (&["web", "now"], "takes `--out DIR`"),
            (&["tidy", "now"], "takes no arguments"),
            (&["ci", "lint"], "clippy"),
        ] {
            let error = command(arguments).unwrap_err();
            assert!(error.contains(hint), "{arguments:?} gives: {error}");
        }
    }
}
