//! `dapple man`: prints or writes the manual pages.

use crate::args::OutputArgs;
use crate::cli::Cli;
use crate::error::{EXIT_CODES, Exit};
use crate::job::{Context, Job, say};
use crate::output::Target;
use anyhow::Result;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  dapple man > dapple.1
  dapple man -o man1/ --force";

/// Print the manual page, or write those of all subcommands to a folder.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Directory for all pages, `dapple.1`, `dapple-tile.1` and so on; created if missing.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Replace existing pages.
    #[arg(long)]
    force: bool,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If a page cannot be written.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut command = Cli::command();
    command.build();
    let Some(folder) = &args.output else {
        say(String::from_utf8_lossy(&page(command)?).trim_end())?;
        return Ok(Exit::Done);
    };
    let output = OutputArgs {
        force: args.force,
        ..OutputArgs::default()
    };
    let mut job = Job::new(context, "man", &output);
    let subcommands = command
        .get_subcommands()
        .filter(|sub| sub.get_name() != "help");
    let mut commands = vec![(String::from("dapple"), command.clone())];
    for subcommand in subcommands {
        let name = format!("dapple-{}", subcommand.get_name());
        // Join the names by a dash, since a manual page has a name of one word.
        let subcommand = subcommand
            .clone()
            .name(name.clone())
            .display_name(name.clone());
        commands.push((name, subcommand));
    }
    for (name, command) in commands {
        let path = folder.join(format!("{name}.1"));
        let output = job.claim_text(&Target::Path(path))?;
        job.write(output, &page(command)?)?;
    }
    job.finish(&Value::Null, Value::Null)?;
    Ok(Exit::Done)
}

/// Renders the page of a command, with the exit codes at its end.
fn page(command: Command) -> Result<Vec<u8>> {
    let after = command.get_after_long_help().or(command.get_after_help());
    let after = after.map(ToString::to_string).unwrap_or_default();
    let command = if after.contains(EXIT_CODES) {
        command
    } else {
        command.after_long_help(format!("{after}\n\n{EXIT_CODES}"))
    };
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    Ok(page)
}
