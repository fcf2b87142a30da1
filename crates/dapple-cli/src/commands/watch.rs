//! `dapple watch`: bakes a recipe each time it is saved.

use super::bake;
use crate::baking::read_recipe;
use crate::error::{Exit, report};
use crate::job::{Context, eprintln_if_possible};
use anyhow::Result;
use dapple::image::FileChanges;
use std::path::{Path, PathBuf};
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
/// Interval at which the files are checked for changes.
const LOOK: Duration = Duration::from_millis(60);

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
/// If the recipe is not a single file, or the first bake fails.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let recipe = args.bake.only_file()?;
    #[cfg(feature = "studio")]
    if !args.bake.has_output() {
        let mode = dapple_studio::Mode::Watch;
        let (recipe, finite) = (recipe.to_string_lossy(), args.bake.finite());
        return args.page.serve(Some(&recipe), mode, finite, context);
    }
    let sizes = args.bake.sizes(SMALL);
    let mut may_replace = args.bake.may_replace();
    loop {
        let files = files_of(recipe);
        // Record the state of the files before they are read, so that later writes count as changes.
        let mut changes = FileChanges::new(&files);
        for &size in &sizes {
            match bake::run(&args.bake.at(size, may_replace), context) {
                Ok(_) => may_replace = true,
                Err(error) if may_replace => {
                    report(&error, &context.options);
                    break;
                }
                Err(error) => return Err(error),
            }
            if changes.has_changed() {
                break;
            }
        }
        while !changes.look(&files) {
            std::thread::sleep(LOOK);
        }
        if !context.quiet {
            eprintln_if_possible(&format!("{} has changed", recipe.display()));
        }
    }
}

/// Returns the files to watch, which are the recipe and its images.
fn files_of(recipe: &Path) -> Vec<PathBuf> {
    let mut files = vec![recipe.to_owned()];
    // Without a valid recipe, its images are unknown.
    if let Ok((content, folder)) = read_recipe(&recipe.to_string_lossy()) {
        let images = content.image_files();
        files.extend(images.into_iter().map(|file| folder.join(file)));
    }
    files
}
