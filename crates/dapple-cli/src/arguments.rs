//! Parses the command line.
//!
//! Option names are case-insensitive, with `_` for `-`. A negative number after an option is its value. For an option
//! name that other programs use, the error suggests the option of this command.

use crate::cli::{Cli, command};
use crate::words::with_dashes;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;
use clap::{ArgMatches, Command, FromArgMatches};
use std::ffi::{OsStr, OsString};

/// Option names from other programs that users try here. Each entry has the subcommands, the name, and the text of the
/// suggested replacement.
const ELSEWHERE: [(&[&str], &str, &str); 9] = [
    (
        &["worley", "noise", "wavelet"],
        "--frequency",
        "--cells N, the number of cells across the picture",
    ),
    (
        &["worley", "noise", "wavelet"],
        "--scale",
        "--cells N, the number of cells across the picture",
    ),
    (
        &["pups"],
        "--frequency",
        "--spacing UNITS, the distance of control points",
    ),
    (
        &["pups"],
        "--scale",
        "--spacing UNITS, the distance of control points, or --extent WxH",
    ),
    (
        &["bake"],
        "--frequency",
        "`frequency` of a node in the recipe: `dapple recipe NAME -o my.toml`",
    ),
    (
        &["bake"],
        "--scale",
        "`extent` in the recipe: `dapple recipe NAME -o my.toml`",
    ),
    (
        &["synth"],
        "--scale",
        "--size WxH for images, and --sites N on a mesh",
    ),
    (&["bake"], "--normal", "--normal-y opengl or directx"),
    (
        &["worley", "pups", "noise", "wavelet", "tile", "info"],
        "--axes",
        "--wrap",
    ),
];

/// An option that was given on the command line.
#[derive(Clone, Debug)]
pub(crate) struct GivenOption {
    /// The long name, without the dashes before it.
    pub(crate) name: String,
    /// The value as typed; several values are joined by commas.
    pub(crate) value: String,
}

/// Parses the command line of this process, and lists the options that were given. Exits the process with a message if
/// the command line is invalid.
pub(crate) fn parse() -> (Cli, Vec<GivenOption>) {
    let words = normalized(std::env::args_os());
    let mut command = command();
    let matches = command.try_get_matches_from_mut(&words);
    let parsed = matches
        .and_then(|matches| Ok((Cli::from_arg_matches(&matches)?, given(&command, &matches))));
    parsed.unwrap_or_else(|error| advised(error.format(&mut command), &words).exit())
}

/// Returns the subcommand's options that were given on the command line.
fn given(command: &Command, matches: &ArgMatches) -> Vec<GivenOption> {
    let subcommand = matches.subcommand();
    let Some((command, matches)) =
        subcommand.and_then(|(name, matches)| Some((command.find_subcommand(name)?, matches)))
    else {
        return Vec::new();
    };
    let options = command.get_arguments().filter_map(|arg| {
        let (name, id) = (arg.get_long()?, arg.get_id().as_str());
        let source = matches
            .try_contains_id(id)
            .ok()?
            .then(|| matches.value_source(id));
        if source? != Some(ValueSource::CommandLine) {
            return None;
        }
        let values = matches.get_raw(id)?.map(OsStr::to_string_lossy);
        Some(GivenOption {
            name: name.to_owned(),
            value: values.collect::<Vec<_>>().join(","),
        })
    });
    options.collect()
}

/// Normalizes the arguments up to `--`. Option names get the spelling of their definition, and negative numbers are
/// joined with `=` to the option before them.
fn normalized(typed: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut words: Vec<OsString> = Vec::new();
    let mut are_options = true;
    for word in typed {
        are_options &= word != "--";
        let text = word.to_str().filter(|_| are_options).unwrap_or_default();
        match words.last_mut() {
            Some(option) if is_negative(text) && takes_more(option) => {
                option.push("=");
                option.push(text);
            }
            _ if text.len() > 2 && text.starts_with("--") => words.push(option(text).into()),
            _ => words.push(word),
        }
    }
    words
}

/// Converts the name of an option to lower case with dashes. The value after `=` is unchanged.
fn option(text: &str) -> String {
    match text.split_once('=') {
        Some((name, value)) => format!("{}={value}", with_dashes(name)),
        None => with_dashes(text),
    }
}

/// Returns whether `text` begins like a negative number, such as `-1` or `-.5`.
fn is_negative(text: &str) -> bool {
    let digits = text.strip_prefix('-').unwrap_or_default();
    let digits = digits.strip_prefix('.').unwrap_or(digits);
    digits.starts_with(|digit: char| digit.is_ascii_digit())
}

/// Returns whether `word` is a long option without `=`, so that the next word may be its value.
fn takes_more(word: &OsString) -> bool {
    let word = word.to_string_lossy();
    word.starts_with("--") && word.len() > 2 && !word.contains('=')
}

/// Adds a suggestion to the error for an unknown option if the option's name is from another program.
fn advised(mut error: clap::Error, words: &[OsString]) -> clap::Error {
    let unknown = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(option)) if error.kind() == ErrorKind::UnknownArgument => option,
        _ => return error,
    };
    let is_named = |subcommand: &&str| words.iter().skip(1).any(|word| word == *subcommand);
    let advice = ELSEWHERE
        .iter()
        .find(|(subcommands, option, _)| option == unknown && subcommands.iter().any(&is_named));
    if let Some((_, _, advice)) = advice {
        let advice = vec![StyledStr::from(format!("take {advice}"))];
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(advice));
    }
    error
}

#[cfg(test)]
mod tests {
    use super::normalized;

    #[test]
    fn options_are_read_in_any_case_and_take_negative_numbers() {
        for (typed, expected) in [
            ("worley --Octave_Seeds own", "worley --octave-seeds own"),
            ("tile a_B.png -o C_D.png", "tile a_B.png -o C_D.png"),
            ("points --origin -1,2", "points --origin=-1,2"),
            (
                "worley --range -.5,1 --seed -1",
                "worley --range=-.5,1 --seed=-1",
            ),
            ("x --A_b=C_D -- --E_f -1", "x --a-b=C_D -- --E_f -1"),
            ("info - -o -", "info - -o -"),
        ] {
            let words = normalized(typed.split(' ').map(Into::into));
            assert_eq!(words.join(" ".as_ref()), expected, "{typed}");
        }
    }
}
