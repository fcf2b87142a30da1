//! `dapple watch`: bakes a recipe at every save.

use super::bake;
use crate::baking::read_recipe;
use crate::error::{Exit, report};
use crate::job::{Context, eprintln_if_possible};
use anyhow::{Context as _, Result, anyhow};
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  dapple watch my-rock.toml
  dapple watch my-rock.toml -o rock/ --size 2048 --preview

Without -o a page in the browser shows the maps as they are after each save.

With -o each save is baked small first, so that something can be seen at once, and then as large as
--size says. Errors of a recipe are printed, and the files stay as they were. Ctrl-C ends it.";

/// The longer side of the first bake after a save, in pixels.
const SMALL: u32 = 256;
/// The time without changes after which files are read: programs write in several steps.
const QUIET: Duration = Duration::from_millis(60);

/// Bake a recipe again at every save of it or of its images, small first.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub(crate) struct Args {
    #[command(flatten)]
    bake: bake::Args,

    #[cfg(feature = "studio")]
    #[command(flatten)]
    page: super::studio::PageArgs,
}

/// Runs the subcommand until it is interrupted.
///
/// # Errors
///
/// If there is no file to watch, or the first files cannot be written.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let recipe = args.bake.only_file()?;
    #[cfg(feature = "studio")]
    if !args.bake.has_output() {
        let mode = dapple_studio::Mode::Watch;
        return args
            .page
            .serve(Some(&recipe.to_string_lossy()), mode, context);
    }
    let (sender, changes) = channel();
    let watcher = notify::recommended_watcher(move |event| {
        // If the receiver is gone, the process is about to end.
        let _ = sender.send(event);
    });
    let mut watcher = watcher.context("changes of files cannot be watched")?;
    let sizes = args.bake.sizes(SMALL);
    let mut may_replace = args.bake.may_replace();
    loop {
        let names = watch(&mut watcher, recipe)?;
        let mut has_changed = false;
        for &size in &sizes {
            match bake::run(&args.bake.at(size, may_replace), context) {
                Ok(_) => may_replace = true,
                Err(error) if may_replace => {
                    report(&error, &context.arguments);
                    break;
                }
                Err(error) => return Err(error),
            }
            has_changed = changes.try_iter().any(|event| is_of(&event, &names));
            if has_changed {
                break;
            }
        }
        if !has_changed {
            wait(&changes, &names)?;
        }
        // A file that is written in several steps is read once.
        while changes.recv_timeout(QUIET).is_ok() {}
        if !context.quiet {
            eprintln_if_possible(&format!("{} has changed", recipe.display()));
        }
    }
}

/// Watches the folders of a recipe and its images, and returns the names of these files.
fn watch(watcher: &mut RecommendedWatcher, recipe: &Path) -> Result<Vec<OsString>> {
    let mut files = vec![recipe.to_owned()];
    // The images of a recipe that cannot be read are not known yet.
    if let Ok((content, folder)) = read_recipe(&recipe.to_string_lossy()) {
        let images = content.image_files();
        files.extend(images.into_iter().map(|file| folder.join(file)));
    }
    let mut names = Vec::new();
    for file in &files {
        let folder = match file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        // Programs replace files by new ones, so the folder is watched.
        let watched = watcher.watch(folder, RecursiveMode::NonRecursive);
        watched.with_context(|| format!("{} cannot be watched", folder.display()))?;
        names.extend(file.file_name().map(OsString::from));
    }
    Ok(names)
}

/// Waits until one of the files has changed.
fn wait(changes: &Receiver<notify::Result<Event>>, names: &[OsString]) -> Result<()> {
    let mut events = changes.iter();
    match events.find(|event| is_of(event, names)) {
        Some(_) => Ok(()),
        None => Err(anyhow!("changes of files are no longer reported")),
    }
}

/// Whether a change is to the content of one of the files.
fn is_of(event: &notify::Result<Event>, names: &[OsString]) -> bool {
    let Ok(event) = event else { return false };
    let is_named = |path: &PathBuf| {
        path.file_name()
            .is_some_and(|name| names.iter().any(|other| other == name))
    };
    !event.kind.is_access() && event.paths.iter().any(is_named)
}
