//! `dapple studio`: serves the recipe editor in the browser.

use super::bake;
use crate::args::FiniteArgs;
use crate::baking::read_images;
use crate::error::{Exit, Hint, usage};
#[cfg(feature = "gpu")]
use crate::gpu::pages;
use crate::job::{Context, eprintln_if_possible, say};
use crate::preview::{self, Thing};
use crate::words::with_dashes;
use anyhow::{Error, Result};
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{Images, Recipe};
#[cfg(feature = "gpu")]
use dapple::recipe::{Plan, RendererError};
use dapple_studio::{
    Export, ExportedFile, Host, Lit, Mode, Named, ServeOptions, Shape, StudioError, has_page, serve,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const EXAMPLES: &str = "\
Examples:
  dapple studio
  dapple studio flagstone
  dapple studio my-rock.toml
  dapple studio --port 7878 --no-open giraffe
  dapple studio --port 7878 --no-open --public-url https://name-7878.example/ giraffe

The page shows the maps of a recipe while it is changed, as text, by sliders or as a graph. It is
served to this machine alone, under the address that is printed, and ends with Ctrl-C. Recipes and
images are read from the recipe's folder, and recipes are written only when they are saved.

A forwarded port (ssh, containers) needs no option: open the printed address with that port. Give
--public-url where a proxy has a name of its own. Keep the address to yourself: it opens the page.";

/// Warning for a program that was built without the editor's page.
const NO_PAGE: &str = "warning: this program was built without the page: `cargo xtask studio` in the repository of dapple builds \
    both, with Node";

/// Make recipes on a page in the browser: see each change at once.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Built-in recipe, or a TOML file [default: choose on the page].
    #[arg(value_name = "RECIPE")]
    recipe: Option<String>,

    #[command(flatten)]
    finite: FiniteArgs,

    #[command(flatten)]
    page: PageArgs,
}

/// How a page is served.
#[derive(clap::Args, Clone, Debug)]
#[group(skip)]
pub(crate) struct PageArgs {
    /// Port [default: any free one].
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,

    /// The page's address in the browser, where a proxy forwards it to the port.
    ///
    /// A forwarded port of localhost needs none.
    #[arg(long, value_name = "URL")]
    public_url: Option<String>,

    /// Print the address without opening a browser.
    #[arg(long)]
    no_open: bool,

    /// Exit when the last page is closed.
    #[arg(long)]
    once: bool,

    /// Directory of another build of the page, for its developers.
    #[arg(long, value_name = "FOLDER", hide = true)]
    dist: Option<PathBuf>,
}

/// Runs the subcommand until it is interrupted.
///
/// # Errors
///
/// If the recipe does not exist, or the port is in use.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let recipe = args.recipe.as_deref();
    args.page.serve(recipe, Mode::Studio, args.finite, context)
}

impl PageArgs {
    /// Serves the page with a recipe.
    ///
    /// # Errors
    ///
    /// If the recipe does not exist, or the port is in use.
    pub(crate) fn serve(
        &self,
        recipe: Option<&str>,
        mode: Mode,
        finite: FiniteArgs,
        context: &Context,
    ) -> Result<Exit> {
        let (recipe, folder) = match recipe {
            None => (None, PathBuf::new()),
            Some(name) => place(name)?,
        };
        let has_page = self.dist.is_some() || has_page();
        let options = ServeOptions {
            port: self.port,
            public_url: self.public_url.clone(),
            no_open: self.no_open,
            once: self.once,
            mode,
            recipe,
            folder,
            dist: self.dist.clone(),
        };
        let bakes = Bakes {
            context: context.silent(),
            finite,
        };
        #[cfg(feature = "gpu")]
        pages::open();
        let told = serve(options, Arc::new(bakes), |url| {
            if !has_page {
                eprintln_if_possible(NO_PAGE);
            }
            // Ignore errors: if standard output is closed, the browser still has the address.
            let _ = say(url);
        });
        told.map_err(advise)?;
        Ok(Exit::Done)
    }
}

/// Converts an error from the studio, with its hint.
fn advise(error: StudioError) -> Error {
    let hint = error.hint().map(str::to_owned);
    let error = Error::new(error);
    match hint {
        Some(hint) => error.hint(hint),
        None => error,
    }
}

/// Returns the name by which the page opens a recipe, and the recipe's directory. The directory of a built-in recipe is
/// empty.
fn place(name: &str) -> Result<(Option<String>, PathBuf)> {
    let path = Path::new(name);
    let builtin = with_dashes(name);
    if !path.is_file() {
        return match Recipe::builtin_text(&builtin) {
            Ok(_) => Ok((Some(builtin), PathBuf::new())),
            Err(error) => Err(
                usage(format!("there is no recipe and no file {name}: {error}"))
                    .hint("`dapple recipe --list` names the built-in recipes"),
            ),
        };
    }
    let file = path
        .file_name()
        .map(|file| file.to_string_lossy().into_owned());
    if !name.ends_with(".toml") {
        return Err(usage(format!("{name} is no recipe in TOML"))
            .hint("`dapple recipe FILE -o my.toml` rewrites one in JSON"));
    }
    Ok((file, path.parent().unwrap_or(Path::new("")).to_owned()))
}

/// The studio's host: it reads images and bakes files with the code of the other subcommands.
struct Bakes {
    context: Context,
    finite: FiniteArgs,
}

impl Host for Bakes {
    fn images(&self, recipe: &Recipe, folder: &Path) -> Result<Images, StudioError> {
        read_images(recipe, folder, self.finite).map_err(told)
    }

    fn export(
        &self,
        recipe: &Recipe,
        folder: &Path,
        export: &Export,
        stop: &Arc<AtomicBool>,
    ) -> Result<Vec<ExportedFile>, StudioError> {
        self.files(recipe, folder, export, stop).map_err(told)
    }

    fn preview(&self, lit: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError> {
        let thing = match lit.shape {
            Shape::Plane => Thing::Plane,
            Shape::Sphere => Thing::Sphere,
            Shape::Torus => Thing::Torus,
        };
        preview::picture(lit.recipe, lit.images, lit.time, thing).map_err(told)
    }

    #[cfg(feature = "gpu")]
    fn on_gpu(&self, recipe: &Recipe, plan: &Plan) -> Option<Plan> {
        pages::on_gpu(recipe, plan)
    }

    #[cfg(feature = "gpu")]
    fn gpu_failed(&self, error: &RendererError) {
        pages::failed(error);
    }

    fn presets(&self) -> Vec<Named> {
        let named = |(name, about): (&str, &str)| Named {
            name: name.to_owned(),
            about: about.to_owned(),
        };
        bake::presets().map(named).collect()
    }
}

impl Bakes {
    /// Bakes a recipe to a temporary directory with the code of `dapple bake`, and returns the files' contents.
    #[expect(
        clippy::disallowed_methods,
        reason = "what a bake has written is read for the page"
    )]
    fn files(
        &self,
        recipe: &Recipe,
        folder: &Path,
        export: &Export,
        stop: &Arc<AtomicBool>,
    ) -> Result<Vec<ExportedFile>> {
        let mut recipe = recipe.clone();
        if recipe.name.is_empty() {
            "recipe".clone_into(&mut recipe.name);
        }
        let made = tempfile::tempdir()?;
        let mut words = words(export);
        words.extend(self.finite.word());
        words.push(format!("--output={}/", made.path().display()));
        bake::bake_with(&words, &recipe, folder, stop.clone(), &self.context)?;
        let mut files = Vec::new();
        for entry in fs::read_dir(made.path())? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let bytes = fs::read(entry.path())?;
            files.push(ExportedFile { name, bytes });
        }
        files.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(files)
    }
}

/// Converts an export to arguments of `dapple bake`. Each is a single word, `--NAME=VALUE`, so that a value cannot be
/// parsed as an option.
fn words(export: &Export) -> Vec<String> {
    let mut words = Vec::new();
    let mut add = |name: &str, value: Option<String>| {
        words.extend(value.map(|value| format!("--{name}={value}")));
    };
    add(
        "size",
        export
            .size
            .map(|[width, height]| format!("{width}x{height}")),
    );
    add("maps", export.maps.as_ref().map(|maps| maps.join(",")));
    add("preset", export.preset.clone());
    add("format", export.format.clone());
    add("normal-y", export.normal_y.clone());
    add(
        "frame",
        export
            .frame
            .map(|[number, count]| format!("{number}/{count}")),
    );
    add("frames", export.frames.map(|frames| frames.to_string()));
    words
}

/// Converts an error to a message for the page.
fn told(error: Error) -> StudioError {
    StudioError::new(format!("{error:#}"))
}
