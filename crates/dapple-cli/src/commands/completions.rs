//! `dapple completions`: prints shell completions.

use crate::cli::Cli;
use crate::error::Exit;
use crate::job::say;
use anyhow::Result;
use clap::CommandFactory;
use clap_complete::Shell;

const EXAMPLES: &str = "\
Examples:
  dapple completions bash > dapple.bash
  dapple completions fish > dapple.fish

For bash, put `source <(dapple completions bash)` into ~/.bashrc; for zsh, write the
script as `_dapple` into a folder of $fpath.";

/// Generate shell completions.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints the completion script.
///
/// # Errors
///
/// If standard output cannot be written.
pub(crate) fn run(args: &Args) -> Result<Exit> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "dapple", &mut script);
    say(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Exit::Done)
}
