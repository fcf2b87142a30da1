//! Defines the command line.

use crate::args::Common;
use crate::commands::Command;
use crate::error::EXIT_CODES;
use clap::{Arg, Command as ClapCommand, CommandFactory, Parser};

/// The introduction of `dapple --help`, before the subcommands.
const ABOUT: &str = "\
Makes textures: bakes the maps of materials from recipes, draws cells and noise, makes
images repeat, blends them, and synthesizes more from an example, on the plane and on models.

The same options and the same seed give the same bits on every machine, with any number of threads.
No file is overwritten without --force, and a failed or interrupted command leaves no files.";

/// The examples at the end of the help.
const EXAMPLES: &str = "\
Examples:
  dapple bake flagstone -o out/ --size 2048
  dapple worley --value f2_minus_f1 -o cracks.png
  dapple tile photo.png -o tile.png --report
  dapple synth grass.png --size 256 --wrap both -o meadow.png
  dapple points poisson --count 500 -o points.csv
  dapple info photo.png

`dapple help SUBCOMMAND` explains a subcommand, with examples.";

/// The command line.
#[derive(Debug, Parser)]
#[command(
    name = "dapple",
    version,
    about = "Makes textures: bakes, draws, tiles, blends and synthesizes them",
    long_about = ABOUT,
    after_help = EXAMPLES,
    after_long_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"),
    subcommand_required = true,
    arg_required_else_help = true,
    max_term_width = 110
)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) common: Common,

    #[command(subcommand)]
    pub(crate) command: Command,
}

/// Defines the command line. Values that are words are case-insensitive.
pub(crate) fn command() -> ClapCommand {
    let any_case = |arg: Arg| {
        let takes_values = arg.get_action().takes_values();
        arg.ignore_case(takes_values)
    };
    let command = Cli::command();
    command.mut_subcommands(|subcommand| subcommand.mut_args(any_case))
}

#[cfg(test)]
mod tests {
    use clap::Command;
    use clap::error::ErrorKind;

    /// Returns the command line, with all subcommands and their options built.
    fn command() -> Command {
        let mut command = super::command();
        command.build();
        command
    }

    #[test]
    fn the_command_line_is_consistent() {
        super::command().debug_assert();
    }

    #[test]
    fn words_are_read_with_underscores_too() {
        let mut n_values = 0;
        for subcommand in command().get_subcommands() {
            // Its options are defined once for all values.
            let mut parser = subcommand.clone();
            for arg in subcommand.get_arguments() {
                for value in arg.get_possible_values() {
                    let value = value.get_name().replace('-', "_").to_uppercase();
                    let typed = match arg.get_long() {
                        Some(option) => format!("--{option}={value}"),
                        None => value,
                    };
                    let words = [subcommand.get_name(), &typed];
                    let refused = parser.try_get_matches_from_mut(words).err();
                    let is_valid =
                        refused.is_none_or(|error| error.kind() != ErrorKind::InvalidValue);
                    assert!(is_valid, "{words:?}");
                    n_values += 1;
                }
            }
        }
        assert!(n_values > 50, "they were seen: {n_values}");
    }
    #[test]
    fn the_help_of_values_is_a_plain_sentence() {
        let mut n_sentences = 0;
        for subcommand in command().get_subcommands() {
            for arg in subcommand.get_arguments() {
                for value in arg.get_possible_values() {
                    let Some(help) = value.get_help().map(ToString::to_string) else {
                        continue;
                    };
                    assert!(!help.contains("](") && !help.ends_with('.'), "{help}");
                    n_sentences += 1;
                }
            }
        }
        assert!(
            n_sentences > 60,
            "values of libraries have help, too: {n_sentences}"
        );
    }

    #[test]
    fn short_help_has_few_words_and_synth_few_options() {
        let command = command();
        for subcommand in command.get_subcommands() {
            let name = subcommand.get_name();
            for arg in subcommand.get_arguments() {
                let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
                let n_words = help.split_whitespace().count();
                assert!(n_words <= 25, "{name} {}: {n_words} words", arg.get_id());
            }
        }
        // Count the options of the subcommand alone, without those that every subcommand has.
        let command = super::command();
        let synth = command.find_subcommand("synth").expect("it is there");
        let shown = synth.get_arguments().filter(|arg| {
            !arg.is_hide_short_help_set() && arg.get_help_heading() != Some("Output")
        });
        let names: Vec<_> = shown.filter_map(|arg| arg.get_long()).collect();
        assert!(names.len() <= 20, "{names:?}");
    }
}
