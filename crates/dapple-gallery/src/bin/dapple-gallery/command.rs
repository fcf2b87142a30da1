//! Parses the command line.

use crate::own::OwnArguments;
use anyhow::{Result, anyhow, bail, ensure};
use dapple_synth::Coherence;
use lexopt::{Arg, Parser};
use std::ffi::OsString;
use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

/// The text that `--help` prints.
pub(crate) const HELP: &str = "\
Renders every figure, or those whose name contains one of the filters, with a page to look at them.

Usage: cargo xtask gallery [OPTIONS] [FILTER]...

  [FILTER]...             parts of the names of figures; without any, all figures

Options:
      --size N            pixels along the longer side of a picture, 1 to 16384 (512)
      --full              make pictures of 1024 pixels: some minutes
      --out DIR           where the pictures and the page go (target/gallery)
      --open              open the page in the browser
      --check             compare the figures with figures.lock, and write nothing
      --bless             rewrite figures.lock with the figures as they are now, and print what changed
      --list              print the names of the figures and nothing more
      --ranges            print the ranges of the combinations of Worley's basis, as the table in `dapple-worley` has them
      --docs              rewrite the pictures in the documentation of the crates and in their READMEs, `docs/*` in their
                          folders, or compare them with `--check`: what `cargo xtask docs-images` does
  -h, --help              print this help
  -V, --version           print the version

A mesh and an exemplar of your own:
      --mesh FILE         render a mesh, of any format that is read, with the texture of `--exemplar`
      --exemplar FILE     the image (PNG, JPEG) that the texture is synthesized from
      --tiles             the exemplar tiles
      --directions FILE   directions of the texture's down, as lines `x,y,z,dx,dy,dz`; without any it runs along -y
      --points N          how many points get a color (262144)
      --levels N          how many levels the points have: 4 for large features (3)
      --coherence auto|K  how much worse a match may be that continues its neighbors; 0 as in the paper (auto)";

/// Names of all options that begin with two dashes.
const OPTIONS: [&str; 18] = [
    "size",
    "full",
    "out",
    "open",
    "check",
    "bless",
    "list",
    "ranges",
    "docs",
    "help",
    "version",
    "mesh",
    "exemplar",
    "tiles",
    "directions",
    "points",
    "levels",
    "coherence",
];

/// Options with the options that they cannot be combined with.
const CONFLICTS: [(&str, &[&str]); 7] = [
    ("full", &["size"]),
    ("check", &["bless", "out", "open", "size"]),
    ("bless", &["out", "open", "size"]),
    ("list", &["check", "bless", "out", "open", "size"]),
    ("ranges", &["list", "check", "bless", "out", "open", "size"]),
    ("mesh", &["list", "check", "bless", "ranges", "docs"]),
    ("docs", &["list", "bless", "out", "open", "size", "ranges"]),
];

/// Options that require `--mesh`.
const OF_MESH: [&str; 6] = [
    "exemplar",
    "tiles",
    "directions",
    "points",
    "levels",
    "coherence",
];

/// Size of an image along its longer side, in pixels: the default, and with `--full`.
const SIZE: u32 = 512;
const FULL_SIZE: u32 = 1024;

/// Default numbers of points and levels for a mesh given with `--mesh`.
const POINTS: usize = 262_144;
const LEVELS: usize = 3;

/// A parsed command line: a task, and the figures that it applies to.
#[derive(Debug, PartialEq)]
pub(crate) struct Command {
    /// The task to run.
    pub(crate) task: Task,
    /// Substrings of figure names that select figures; an empty list selects all.
    pub(crate) filter: Vec<String>,
    /// Number of pixels along the longer side of an image.
    pub(crate) size: u32,
    /// Output folder for the images, if one was given.
    pub(crate) out: Option<PathBuf>,
}

/// A task of the gallery.
#[derive(Debug, PartialEq)]
pub(crate) enum Task {
    /// Write the images and the page.
    Export {
        /// Open the page in the browser.
        open: bool,
    },
    /// Render a mesh provided by the user.
    Own(OwnArguments),
    /// Compare the figures with the lock.
    Check,
    /// Rewrite the lock.
    Bless,
    /// Print the names of the figures.
    List,
    /// Print the ranges of the combinations of Worley's basis.
    Ranges,
    /// Rewrite or compare the images in the documentation.
    Docs {
        /// Compare the images with the files instead of writing them.
        check: bool,
    },
    /// Print the help.
    Help,
    /// Print the version.
    Version,
}

/// The options as typed, before conflicts between them are checked.
#[derive(Default)]
struct Typed {
    names: Vec<&'static str>,
    filter: Vec<String>,
    size: Option<u32>,
    out: Option<PathBuf>,
    mesh: Option<PathBuf>,
    exemplar: Option<PathBuf>,
    directions: Option<PathBuf>,
    points: Option<usize>,
    levels: Option<usize>,
    coherence: Option<Coherence>,
}

/// Parses the arguments into a command.
pub(crate) fn parse(mut parser: Parser) -> Result<Command> {
    let mut typed = Typed::default();
    while let Some(argument) = parser.next()? {
        let name = match argument {
            Arg::Value(filter) => {
                typed.filter.push(text(filter)?);
                continue;
            }
            Arg::Short('h') => "help",
            Arg::Short('V') => "version",
            Arg::Short(letter) => return Err(unknown(&format!("-{letter}"))),
            Arg::Long(name) => option(name)?,
        };
        ensure!(!typed.has(name), "`--{name}` is there twice");
        typed.names.push(name);
        typed.read_value(name, &mut parser)?;
    }
    if !typed.has("help") && !typed.has("version") {
        typed.refuse_conflicts()?;
    }
    Ok(typed.into_command())
}

impl Typed {
    fn has(&self, name: &str) -> bool {
        self.names.contains(&name)
    }

    /// Reads the value of the option `name` if that option takes one.
    fn read_value(&mut self, name: &str, parser: &mut Parser) -> Result<()> {
        let mut path = || Ok::<_, lexopt::Error>(Some(PathBuf::from(parser.value()?)));
        match name {
            "out" => self.out = path()?,
            "mesh" => self.mesh = path()?,
            "exemplar" => self.exemplar = path()?,
            "directions" => self.directions = path()?,
            "size" => {
                let size = value(name, parser)?;
                let is_allowed = (1..=16384).contains(&size);
                ensure!(is_allowed, "`--size {size}` is not in 1 to 16384");
                self.size = Some(size);
            }
            "points" => self.points = Some(value(name, parser)?),
            "levels" => self.levels = Some(value(name, parser)?),
            "coherence" => self.coherence = Some(value(name, parser)?),
            _ => {}
        }
        Ok(())
    }

    /// Returns an error if two options conflict, or if an option is missing that another one requires.
    fn refuse_conflicts(&self) -> Result<()> {
        for (name, others) in CONFLICTS {
            if let Some(other) = others
                .iter()
                .find(|other| self.has(name) && self.has(other))
            {
                bail!("`--{name}` cannot be used with `--{other}`");
            }
        }
        if self.has("docs") && !self.filter.is_empty() {
            bail!("`--docs` makes all pictures, and takes no filter");
        }
        if self.has("mesh") {
            ensure!(self.has("exemplar"), "`--mesh` needs `--exemplar FILE`");
        } else if let Some(name) = OF_MESH.into_iter().find(|name| self.has(name)) {
            bail!("`--{name}` needs `--mesh FILE`");
        }
        Ok(())
    }

    fn into_command(self) -> Command {
        let size = if self.has("full") {
            FULL_SIZE
        } else {
            self.size.unwrap_or(SIZE)
        };
        Command {
            task: self.task(),
            filter: self.filter,
            size,
            out: self.out,
        }
    }

    fn task(&self) -> Task {
        let check = self.has("check");
        let open = self.has("open");
        let named = [
            ("help", Task::Help),
            ("version", Task::Version),
            ("ranges", Task::Ranges),
            ("docs", Task::Docs { check }),
            ("list", Task::List),
            ("check", Task::Check),
            ("bless", Task::Bless),
        ];
        let task = named.into_iter().find(|(name, _)| self.has(name));
        task.map(|(_, task)| task)
            .or_else(|| self.own().map(Task::Own))
            .unwrap_or(Task::Export { open })
    }

    fn own(&self) -> Option<OwnArguments> {
        Some(OwnArguments {
            mesh: self.mesh.clone()?,
            exemplar: self.exemplar.clone()?,
            tiles: self.has("tiles"),
            directions: self.directions.clone(),
            points: self.points.unwrap_or(POINTS),
            levels: self.levels.unwrap_or(LEVELS),
            coherence: self.coherence.unwrap_or_default(),
        })
    }
}

/// Returns the known option that is typed as `name`.
fn option(name: &str) -> Result<&'static str> {
    let known = OPTIONS.into_iter().find(|option| *option == name);
    known.ok_or_else(|| unknown(&format!("--{name}")))
}

fn unknown(typed: &str) -> anyhow::Error {
    anyhow!("there is no option `{typed}`; see `cargo xtask gallery --help`")
}

/// Parses the value that follows the option `name`.
fn value<T: FromStr<Err: Display>>(name: &str, parser: &mut Parser) -> Result<T> {
    let text = text(parser.value()?)?;
    let value = text.parse();
    value.map_err(|error: T::Err| anyhow!("`--{name} {text}`: {error}"))
}

fn text(typed: OsString) -> Result<String> {
    let text = typed.into_string();
    text.map_err(|typed| anyhow!("`{}` is not Unicode", typed.display()))
}

#[cfg(test)]
mod tests {
    use super::{Command, HELP, OPTIONS, Task, parse};
    use crate::own::OwnArguments;
    use dapple_synth::Coherence;
    use lexopt::Parser;

    fn command(typed: &str) -> Result<Command, String> {
        parse(Parser::from_args(typed.split_whitespace())).map_err(|error| error.to_string())
    }

    fn task(typed: &str) -> Task {
        command(typed).map(|command| command.task).unwrap()
    }

    #[test]
    fn options_are_understood() {
        assert_eq!(task(""), Task::Export { open: false });
        assert_eq!(task("--open pups"), Task::Export { open: true });
        assert_eq!(task("--check pups"), Task::Check);
        assert_eq!(task("--bless"), Task::Bless);
        assert_eq!(task("--list pups"), Task::List);
        assert_eq!(task("--ranges"), Task::Ranges);
        assert_eq!(task("--docs"), Task::Docs { check: false });
        assert_eq!(task("--check --docs"), Task::Docs { check: true });
        assert_eq!(task("--size 9 -h"), Task::Help);
        assert_eq!(task("--mesh a.obj --help"), Task::Help);
        assert_eq!(task("-V"), Task::Version);
        let drawn = command("pups --size=64 worley --out there").unwrap();
        assert_eq!(drawn.filter, ["pups", "worley"]);
        assert_eq!(drawn.out, Some("there".into()));
        assert_eq!(drawn.size, 64);
        assert_eq!(command("").unwrap().size, 512);
        assert_eq!(command("--full").unwrap().size, 1024);
    }

    #[test]
    fn own_mesh_has_the_defaults_of_the_help() {
        let mut own = OwnArguments {
            mesh: "a.obj".into(),
            exemplar: "b.png".into(),
            tiles: false,
            directions: None,
            points: 262_144,
            levels: 3,
            coherence: Coherence::Auto,
        };
        let typed = "--mesh a.obj --exemplar b.png";
        assert_eq!(task(typed), Task::Own(own.clone()));
        own.tiles = true;
        own.directions = Some("c.csv".into());
        own.points = 9;
        own.levels = 4;
        own.coherence = Coherence::Factor(0.5);
        let more = "--tiles --directions c.csv --points 9 --levels 4 --coherence 0.5";
        assert_eq!(task(&format!("{typed} {more}")), Task::Own(own));
    }

    #[test]
    fn refusals_name_the_option() {
        for (typed, expected) in [
            ("--sise 9", "there is no option `--sise`"),
            ("-s", "there is no option `-s`"),
            ("--size", "'--size'"),
            ("--size 0", "`--size 0` is not in 1 to 16384"),
            ("--size 16385", "`--size 16385` is not in 1 to 16384"),
            ("--size large", "`--size large`: invalid digit"),
            ("--list=yes", "'--list'"),
            ("--size 9 --size 9", "`--size` is there twice"),
            ("--size 9 --full", "`--full` cannot be used with `--size`"),
            ("--bless --check", "`--check` cannot be used with `--bless`"),
            ("--check --open", "`--check` cannot be used with `--open`"),
            ("--bless --out x", "`--bless` cannot be used with `--out`"),
            ("--check --list", "`--list` cannot be used with `--check`"),
            ("--list --ranges", "`--ranges` cannot be used with `--list`"),
            ("--docs --bless", "`--docs` cannot be used with `--bless`"),
            (
                "--docs pups",
                "`--docs` makes all pictures, and takes no filter",
            ),
            (
                "--mesh a.obj --list",
                "`--mesh` cannot be used with `--list`",
            ),
            ("--mesh a.obj", "`--mesh` needs `--exemplar FILE`"),
            ("--exemplar a.png", "`--exemplar` needs `--mesh FILE`"),
            ("--coherence 1", "`--coherence` needs `--mesh FILE`"),
        ] {
            let error = command(typed).unwrap_err();
            assert!(error.contains(expected), "{typed} gives: {error}");
        }
    }

    #[test]
    fn help_has_every_option() {
        for option in OPTIONS {
            let is_there = HELP.contains(&format!("--{option} "));
            assert!(is_there, "--{option}");
        }
    }
}
