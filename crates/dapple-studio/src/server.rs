//! The local server of the page.
//!
//! It listens on 127.0.0.1 only, and serves only a page that was opened with the token of this run: see `guard.rs`.
//! Each page has a session, which answers requests, and a rendering thread, which keeps only the newest state.

mod browser;
mod connections;
mod exports;
mod files;
mod flow;
mod gallery;
mod guard;
mod page;
mod socket;
mod worker;

use crate::message::{Export, Hello, Mode, Named};
use crate::{Lit, Renderer, StudioError};
use axum::extract::Request;
use axum::http::{Method, StatusCode};
use axum::response::{IntoResponse as _, Response};
use browser::Way;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{Images, Plan, PlanCache, Recipe, RendererError};
use exports::Exports;
use files::Folder;
use gallery::Gallery;
use guard::Guard;
use std::net::Ipv4Addr;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::{Notify, Semaphore};

/// The program that runs the server. It loads images and exports files, so that both work as in its other commands.
pub trait Host: Send + Sync {
    /// Loads the images that a recipe names, from its folder. The names have been validated.
    ///
    /// # Errors
    ///
    /// If an image cannot be read.
    fn images(&self, recipe: &Recipe, folder: &Path) -> Result<Images, StudioError>;

    /// Bakes the recipe to files and returns them with their names. Stops early once `stop` is true.
    ///
    /// # Errors
    ///
    /// If the bake is refused or was stopped.
    fn export(
        &self,
        recipe: &Recipe,
        folder: &Path,
        export: &Export,
        stop: &Arc<AtomicBool>,
    ) -> Result<Vec<ExportedFile>, StudioError>;

    /// Renders the preview of a lit material.
    ///
    /// # Errors
    ///
    /// If the bake is refused.
    fn preview(&self, lit: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError>;

    /// Returns the plan of a recipe with all nodes on a GPU, as [`RenderHost::on_gpu`](crate::RenderHost::on_gpu).
    fn on_gpu(&self, recipe: &Recipe, plan: &Plan) -> Option<Plan> {
        let _ = (recipe, plan);
        None
    }

    /// Receives the error of a GPU, as [`RenderHost::gpu_failed`](crate::RenderHost::gpu_failed).
    fn gpu_failed(&self, error: &RendererError) {
        let _ = error;
    }

    /// Returns the export presets, one for each program that can import the files.
    fn presets(&self) -> Vec<Named>;
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportedFile {
    /// The name of the file, without a folder.
    pub name: String,
    /// The content of the file.
    pub bytes: Vec<u8>,
}

/// Options of the server.
#[derive(Clone, Debug, Default)]
pub struct ServeOptions {
    /// The port to listen on. Default: 0, which means any free port.
    pub port: u16,
    /// The address of the page in browsers, for use behind a proxy that forwards to the port.
    pub public_url: Option<String>,
    /// Whether to leave the browser closed instead of opening it at the address of the page.
    pub no_open: bool,
    /// Whether the server ends when the last page is closed.
    pub once: bool,
    /// The rights of every page.
    pub mode: Mode,
    /// The recipe to open in every page: the name of a built-in recipe or of a file in the folder.
    pub recipe: Option<String>,
    /// The folder of the recipes and their images. Default: the current folder.
    pub folder: PathBuf,
    /// A folder with the page's files, which are served instead of the built-in page. It is for developers of the page.
    pub dist: Option<PathBuf>,
}

/// The state that all pages share.
struct Shared {
    options: ServeOptions,
    host: Arc<dyn Host>,
    guard: Guard,
    folder: Folder,
    exports: Exports,
    /// Cache of node values, shared by the renderers of all pages.
    cache: PlanCache,
    /// Cache of recipe thumbnails.
    gallery: Gallery,
    /// Permits that limit the number of open pages.
    pages: Arc<Semaphore>,
    /// Lock that serializes exports of all pages, since each needs the memory of a bake.
    exporting: Mutex<()>,
    way: Way,
    closed: Notify,
}

/// Maximum number of simultaneous pages.
const MOST_PAGES: usize = 16;

/// Time for a reloaded page to reconnect before a server with `once` ends.
const GRACE: Duration = Duration::from_secs(2);

/// Returns whether the page is built into this program. Otherwise the server sends a page that says how to build it.
#[must_use]
pub fn has_page() -> bool {
    page::is_built()
}

/// Returns the license texts of third-party code in the page. `None` if the page is not built into this program.
#[must_use]
pub fn page_licenses() -> Option<&'static str> {
    page::licenses()
}

/// Serves the page until the process ends. With [`once`](ServeOptions::once), serves until the last page is closed.
/// Calls `tell` with the address as soon as the address can be opened.
///
/// # Errors
///
/// If the port is in use, the public URL is invalid, or the folder cannot be read.
pub fn serve(
    options: ServeOptions,
    host: Arc<dyn Host>,
    tell: impl FnOnce(&str),
) -> Result<(), StudioError> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build();
    let runtime = runtime
        .map_err(|error| StudioError::new(format!("the server cannot be started: {error}")))?;
    runtime.block_on(run(options, host, tell))
}

async fn run(
    options: ServeOptions,
    host: Arc<dyn Host>,
    tell: impl FnOnce(&str),
) -> Result<(), StudioError> {
    let port = options.port;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .await
        .map_err(|error| {
            StudioError::new(format!("port {port} cannot be had: {error}"))
                .with_hint("leave --port out for any free one")
        })?;
    let port = listener.local_addr().map_or(port, |address| address.port());
    // Set up access control and the folder of recipes.
    let guard = Guard::new(port, options.public_url.as_deref())?;
    let url = guard.url();
    let named = options.recipe.as_deref();
    let folder = Folder::new(
        &options.folder,
        named.filter(|name| name.ends_with(".toml")),
    )?;
    let no_open = options.no_open;
    let shared = Arc::new(Shared {
        options,
        host,
        guard,
        exports: Exports::default(),
        cache: Renderer::cache(),
        gallery: Gallery::default(),
        folder,
        pages: Arc::new(Semaphore::new(MOST_PAGES)),
        exporting: Mutex::default(),
        way: Way::default(),
        closed: Notify::new(),
    });
    // Build the greeting while the browser starts.
    drop(std::thread::spawn(Hello::new));
    tell(&url);
    // Open the browser, and remove its temporary file after a while.
    if !no_open {
        shared.way.open(&url);
        let shared = shared.clone();
        drop(tokio::spawn(async move {
            tokio::time::sleep(browser::LONGEST).await;
            shared.way.close();
        }));
    }
    connections::serve(listener, shared).await;
    Ok(())
}

impl Shared {
    /// Returns the folder of a recipe's images. Fails if the recipe names images outside of this folder.
    fn of_images(&self, recipe: &Recipe) -> Result<&Path, StudioError> {
        self.folder.check_images(recipe)?;
        Ok(self.folder.path())
    }

    /// Loads the images of a recipe from its folder.
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError> {
        self.host.images(recipe, self.of_images(recipe)?)
    }

    /// Writes the files of an export into a folder in the folder of the recipe, if the page may write.
    fn write(&self, to: &str, files: &[ExportedFile], overwrite: bool) -> Result<(), StudioError> {
        if self.options.mode != Mode::Studio {
            return Err(StudioError::new("here recipes are only looked at"));
        }
        self.folder.write(to, files, overwrite)
    }

    /// Waits until the last page is closed, if `once` is set. Otherwise never returns.
    async fn ended(&self) {
        loop {
            self.closed.notified().await;
            if !self.options.once {
                continue;
            }
            tokio::time::sleep(GRACE).await;
            if self.pages.available_permits() == MOST_PAGES {
                return;
            }
        }
    }
}

/// Checks and answers an HTTP request.
async fn answer(shared: Arc<Shared>, request: Request) -> Response {
    let mut response = match shared.guard.check(&request) {
        Err(refusal) => (StatusCode::FORBIDDEN, refusal).into_response(),
        Ok(()) => route(shared, request).await,
    };
    Guard::protect(response.headers_mut());
    response
}

async fn route(shared: Arc<Shared>, request: Request) -> Response {
    if !matches!(*request.method(), Method::GET | Method::HEAD) {
        return StatusCode::METHOD_NOT_ALLOWED.into_response();
    }
    let path = request.uri().path().to_owned();
    if path == "/ws" {
        return socket::upgrade(shared, request).await;
    }
    if let Some(name) = path.strip_prefix("/export/") {
        return shared.exports.get(name);
    }
    if let Some(name) = path.strip_prefix("/image/") {
        return shared.folder.image(name);
    }
    page::file(&path, shared.options.dist.as_deref())
}
