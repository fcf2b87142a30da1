//! Reports errors to users, with the message, its causes, a hint, and the exit code.

use crate::arguments::GivenOption;
use anyhow::Error;
use dapple::points::{PointsError, PointsErrorKind};
use dapple::pups::{PupsError, PupsErrorKind};
use dapple::recipe::{RecipeError, RecipeErrorKind};
use dapple::synth::{SynthError, SynthErrorKind};
use dapple::tile::{TileError, TileErrorKind};
use dapple::worley::{WorleyError, WorleyErrorKind};
use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};
use std::process::ExitCode;

/// The exit code of the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// The command succeeded.
    Done = 0,
    /// The command failed. Files that were reported before are complete, and no other files were written.
    Failed = 1,
    /// The command line was invalid; clap exits with the same code.
    Usage = 2,
    /// The command succeeded, but a condition of `--check` does not hold.
    Check = 3,
    /// The user interrupted the command. The code is 128 plus the number of SIGINT.
    Interrupted = 130,
}

/// The description of the exit codes in `--help` and the manual pages.
pub(crate) const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    refused or failed: nothing was written but the files that were reported before
  2    wrong usage, or a value that is out of its range before the work
  3    done, but a quality that --check asks for is not there
  130  interrupted: each file is the old one or the whole new one";

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// An error with a hint or a specific exit code.
#[derive(Debug)]
struct Refusal {
    error: Error,
    hint: Option<String>,
    exit: Exit,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl std::error::Error for Refusal {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.error.source()
    }
}

/// Creates an error for an invalid command line that clap does not detect.
pub(crate) fn usage(message: impl Into<String>) -> Error {
    Error::new(Refusal {
        error: Error::msg(message.into()),
        hint: None,
        exit: Exit::Usage,
    })
}

/// Adds a hint to an error.
pub(crate) trait Hint {
    /// The type of the result.
    type Hinted;

    /// Adds a hint: an imperative sentence without a period.
    fn hint(self, hint: impl Into<String>) -> Self::Hinted;

    /// Marks an error as incorrect usage: a library has rejected the value of an option.
    fn wrong_value(self) -> Self::Hinted;
}

impl Hint for Error {
    type Hinted = Self;

    fn hint(self, hint: impl Into<String>) -> Self {
        let hint = Some(hint.into());
        match self.downcast::<Refusal>() {
            Ok(refusal) => Self::new(Refusal { hint, ..refusal }),
            Err(error) => Self::new(Refusal {
                error,
                hint,
                exit: Exit::Failed,
            }),
        }
    }

    fn wrong_value(self) -> Self {
        let exit = Exit::Usage;
        match self.downcast::<Refusal>() {
            Ok(refusal) => Self::new(Refusal { exit, ..refusal }),
            Err(error) => Self::new(Refusal {
                error,
                hint: None,
                exit,
            }),
        }
    }
}

impl<T, E: Into<Error>> Hint for Result<T, E> {
    type Hinted = Result<T, Error>;

    fn hint(self, hint: impl Into<String>) -> Result<T, Error> {
        self.map_err(|error| error.into().hint(hint))
    }

    fn wrong_value(self) -> Result<T, Error> {
        self.map_err(|error| error.into().wrong_value())
    }
}

/// Prints an error to standard error, and returns the exit code. The message begins with the option that caused the
/// error, if it is known.
pub(crate) fn report(error: &Error, options: &[GivenOption]) -> Exit {
    let exit = exit(error);
    if exit != Exit::Done {
        let option = match exit {
            Exit::Usage => refused_number(error).and_then(|what| option_of(what, options)),
            _ => None,
        };
        let text = text(error, option.as_deref());
        // If standard error cannot be written, the exit code must suffice.
        let _ = io::stderr().lock().write_all(printable(&text).as_bytes());
    }
    exit
}

/// Returns the name of the quantity that a library reports as out of range; `None` for other errors.
fn refused_number(error: &Error) -> Option<&'static str> {
    use PointsErrorKind::{NotDescending, NotPositive, OutOfRange, PeriodTooShort, Radius};
    error.chain().find_map(|cause| {
        if let Some(Refusal { error, .. }) = cause.downcast_ref() {
            return refused_number(error);
        }
        if let Some(error) = cause.downcast_ref::<PointsError>() {
            return match error.kind() {
                NotPositive { what, .. } | OutOfRange { what, .. } => Some(*what),
                Radius { .. } | PeriodTooShort { .. } | NotDescending { .. } => Some("radius"),
                _ => None,
            };
        }
        let recipe = cause.downcast_ref().map(RecipeError::kind);
        let pups = cause.downcast_ref().map(PupsError::kind);
        let worley = cause.downcast_ref().map(WorleyError::kind);
        let tile = cause.downcast_ref().map(TileError::kind);
        let synth = cause.downcast_ref().map(SynthError::kind);
        match (recipe, pups, worley, tile, synth) {
            (Some(RecipeErrorKind::Range { what, .. }), ..)
            | (_, Some(PupsErrorKind::Range { what, .. }), ..)
            | (_, _, Some(WorleyErrorKind::Range { what, .. }), ..)
            | (_, _, _, Some(TileErrorKind::Range { what, .. }), _)
            | (.., Some(SynthErrorKind::Range { what, .. })) => Some(*what),
            _ => None,
        }
    })
}

/// Returns the first cause of an error that has this type.
pub(crate) fn cause<T: std::error::Error + 'static>(error: &Error) -> Option<&T> {
    let mut causes = error.chain();
    causes.find_map(|found| match found.downcast_ref() {
        // A refusal displays as the error in it, which is not part of the chain.
        Some(Refusal { error, .. }) => cause(error),
        None => found.downcast_ref(),
    })
}

/// Quantities with another name in error messages of libraries, as pairs of the option's name and the library's name.
const OTHER_NAMES: [(&str, &str); 5] = [
    ("persistence", "gain"),
    ("radii", "radius"),
    ("share", "width of the cuts"),
    ("spacing", "radius"),
    ("width", "width of the cuts"),
];

/// Returns the option that sets the quantity `what`, as the user typed it; `None` unless exactly one given option
/// matches. `what` is a library's name for the quantity.
///
/// Options are matched by name only. Their values are not compared, since equal values would match unrelated options.
fn option_of(what: &str, options: &[GivenOption]) -> Option<String> {
    let what = what.strip_prefix("the ").unwrap_or(what);
    let what = what.strip_prefix("number of ").unwrap_or(what);
    let is_named = |option: &&GivenOption| {
        let other = (option.name.as_str(), what);
        option.name.replace('-', " ") == what || OTHER_NAMES.contains(&other)
    };
    let mut named = options.iter().filter(is_named);
    match (named.next(), named.next()) {
        (Some(option), None) => Some(format!("--{} {}", option.name, option.value)),
        _ => None,
    }
}

/// Returns the exit code for an error.
fn exit(error: &Error) -> Exit {
    if is_broken_pipe(error) {
        // The reader of the pipe has closed it. This is not a failure of the command.
        return Exit::Done;
    }
    let refusals = error.chain().filter_map(|cause| cause.downcast_ref());
    refusals
        .map(|refusal: &Refusal| refusal.exit)
        .find(|&exit| exit != Exit::Failed)
        .unwrap_or(Exit::Failed)
}

/// Formats an error: the option, the message, the causes that add information, and the hint.
fn text(error: &Error, option: Option<&str>) -> String {
    let mut said = error.to_string();
    let option = option.map_or(String::new(), |option| format!("{option}: "));
    let mut text = format!("error: {option}{said}\n");
    for cause in error.chain().skip(1) {
        let cause = cause.to_string();
        // Skip a cause that the message above it repeats, or that repeats this message.
        if !said.contains(&cause) && !cause.ends_with(&said) {
            text += &format!("  because: {cause}\n");
            said = cause;
        }
    }
    let hint = error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<Refusal>())
        .find_map(|refusal| refusal.hint.as_ref());
    if let Some(hint) = hint {
        text += &format!("hint: {hint}\n");
    }
    text
}

/// Escapes text for output to a terminal. Control characters, which file names and recipes may contain, are written as
/// `\u{1b}`. So are characters that change the writing direction. Line feeds and tabs are unchanged.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let turns = |c: char| matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let is_odd = |c: char| (c.is_control() && c != '\n' && c != '\t') || turns(c);
    if !text.contains(is_odd) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_odd(c) {
            safe.extend(c.escape_unicode());
        } else {
            safe.push(c);
        }
    }
    Cow::Owned(safe)
}

fn is_broken_pipe(error: &Error) -> bool {
    let io_errors = error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>());
    io_errors
        .into_iter()
        .any(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

#[cfg(test)]
mod tests {
    use super::{Exit, Hint, exit, option_of, printable, text, usage};
    use crate::arguments::GivenOption;
    use anyhow::{Context, anyhow};
    use std::io;

    #[test]
    fn a_message_has_its_causes_once_and_the_hint_last() {
        let error = anyhow!("no room")
            .context("the plate: no room")
            .context("cannot cook")
            .hint("buy plates");
        assert_eq!(
            text(&error, None),
            "error: cannot cook\n  because: the plate: no room\nhint: buy plates\n"
        );
    }

    #[test]
    fn hints_and_exit_codes_survive_what_is_put_around_them() {
        let error = usage("no such thing").hint("try another");
        let error = Err::<(), _>(error).context("reading").unwrap_err();
        assert!(
            text(&error, None).ends_with("hint: try another\n"),
            "{error:?}"
        );
        assert_eq!(exit(&error), Exit::Usage);
        assert_eq!(exit(&anyhow!("else")), Exit::Failed);
    }

    #[test]
    fn the_option_of_a_number_goes_by_its_name() {
        let options = [
            ("threads", "1"),
            ("size", "1"),
            ("spacing", "0"),
            ("gain", "0.5"),
            ("persistence", "2"),
            ("feature-size", "1"),
        ];
        let options = options.map(|(name, value)| GivenOption {
            name: name.to_owned(),
            value: value.to_owned(),
        });
        for (what, expected) in [
            ("radius", Some("--spacing 0")),
            ("the radius", Some("--spacing 0")),
            ("feature size", Some("--feature-size 1")),
            ("side of the exemplar", None),
            ("size of a cell", None),
            ("octaves", None),
            // Two options have this name.
            ("gain", None),
        ] {
            assert_eq!(option_of(what, &options).as_deref(), expected, "{what}");
        }
    }

    #[test]
    fn control_characters_are_printed_as_their_codes() {
        for (text, expected) in [
            ("a line\n\tand é, ▁", "a line\n\tand é, ▁"),
            ("a\u{1b}[31mred.png", "a\\u{1b}[31mred.png"),
            (
                "\r\u{7}\u{7f}\u{9b}\u{202e}",
                "\\u{d}\\u{7}\\u{7f}\\u{9b}\\u{202e}",
            ),
        ] {
            assert_eq!(printable(text), expected);
        }
    }

    #[test]
    fn a_reader_that_went_away_is_no_failure() {
        let error = anyhow::Error::from(io::Error::from(io::ErrorKind::BrokenPipe));
        assert_eq!(exit(&error.context("standard output")), Exit::Done);
    }
}
