//! The command line as a whole.

use crate::args::Common;
use crate::commands::Command;
use crate::error::EXIT_CODES;
use clap::Parser;

/// What `dapple --help` says before the subcommands.
const ABOUT: &str = "\
Makes textures: bakes the maps of materials from recipes, draws cells and noise, makes
images repeat, blends them, and synthesizes more from an example, on the plane and on models.

The same options and the same seed give the same bits on every machine, with any number of threads.
Nothing is overwritten without --force, and what is not done whole leaves nothing behind.";

/// What it says at the end.
const EXAMPLES: &str = "\
Examples:
  dapple bake flagstone -o out/ --size 2048
  dapple worley --value f2_minus_f1 -o cracks.png
  dapple tile photo.png -o tile.png --report
  dapple synth grass.png --size 256 --wrap both -o meadow.png
  dapple points poisson --count 500 -o points.csv
  dapple info photo.png

`dapple help SUBCOMMAND` says more of one, with examples.";

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

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
