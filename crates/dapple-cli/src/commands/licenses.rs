//! `dapple licenses`: prints the licenses of third-party code.

use crate::error::Exit;
use crate::job::say;
use anyhow::Result;

/// The licenses of the crates, written by `cargo xtask licenses`.
const CRATES: &str = include_str!("../../THIRD-PARTY.txt");

const EXAMPLES: &str = "\
Examples:
  dapple licenses > THIRD-PARTY.txt";

/// Print the licenses of the code of other people that is in this program.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {}

/// Runs the subcommand.
///
/// # Errors
///
/// If standard output cannot be written.
pub(crate) fn run(_: &Args) -> Result<Exit> {
    say(CRATES.trim_end())?;
    #[cfg(feature = "studio")]
    if let Some(page) = dapple_studio::page_licenses() {
        say("\n# The page of `dapple studio`\n")?;
        say(page.trim_end())?;
    }
    Ok(Exit::Done)
}
