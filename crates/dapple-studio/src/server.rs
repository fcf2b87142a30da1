//! The local server of the page.
//!
//! It answers on 127.0.0.1 alone, and only to a page that was opened with the secret of this run: see `guard.rs`. Each page
//! has a session, which answers at once, and a thread that draws, of which only the newest state is kept.

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
use dapple::recipe::{Images, PlanCache, Recipe};
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

/// The program around the server. It reads images and makes files, so that they are those of its other commands.
pub trait Host: Send + Sync {
    /// The images that a recipe names, from its folder. The names have been checked.
    ///
    /// # Errors
    ///
    /// If one of them cannot be read.
    fn images(&self, recipe: &Recipe, folder: &Path) -> Result<Images, StudioError>;

    /// The files of a bake, by their names. It ends early once `stop` is true.
    ///
    /// # Errors
    ///
    /// The refusal of the bake, or that it was stopped.
    fn export(
        &self,
        recipe: &Recipe,
        folder: &Path,
        export: &Export,
        stop: &Arc<AtomicBool>,
    ) -> Result<Vec<ExportedFile>, StudioError>;

    /// The picture of a lit material.
    ///
    /// # Errors
    ///
    /// The refusal of the bake.
    fn preview(&self, lit: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError>;

    /// The programs that files can be made for.
    fn presets(&self) -> Vec<Named>;
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportedFile {
    /// Its name, without a folder.
    pub name: String,
    /// The content of the file.
    pub bytes: Vec<u8>,
}

/// Options of the server.
#[derive(Clone, Debug, Default)]
pub struct ServeOptions {
    /// The port; any free one for 0, which is the default.
    pub port: u16,
    /// The address of the page in browsers, where a proxy forwards it to the port.
    pub public_url: Option<String>,
    /// Whether the browser is left alone.
    pub no_open: bool,
    /// Whether the server ends when the last page is closed.
    pub once: bool,
    /// The rights of pages.
    pub mode: Mode,
    /// The recipe that a page begins with: a built-in one, or a file in the folder.
    pub recipe: Option<String>,
    /// The folder of the recipes and their images; the current one by default.
    pub folder: PathBuf,
    /// A folder with another page than the one that is part of the program, for those who work on the page.
    pub dist: Option<PathBuf>,
}

/// The state that all pages share.
struct Shared {
    options: ServeOptions,
    host: Arc<dyn Host>,
    guard: Guard,
    folder: Folder,
    exports: Exports,
    /// Values of nodes that were drawn for any page.
    memory: PlanCache,
    /// Small pictures of recipes, by their texts and sides.
    gallery: Gallery,
    /// The places of pages that are not taken.
    pages: Arc<Semaphore>,
    /// Exports are made one after the other, whoever asks: each needs the memory of a bake.
    exporting: Mutex<()>,
    way: Way,
    closed: Notify,
}

/// The most pages at once.
const MOST_PAGES: usize = 16;

/// How long a page may be gone before a server with `once` ends: a page that is loaded again comes back.
const GRACE: Duration = Duration::from_secs(2);

/// Whether the page is part of this program. Without it the server answers, and its page says how to build it.
#[must_use]
pub fn has_page() -> bool {
    page::is_built()
}

/// The texts of the licenses of other people's code in the page, if the page is part of this program.
#[must_use]
pub fn page_licenses() -> Option<&'static str> {
    page::licenses()
}

/// Serves the page until the process ends or, with [`once`](ServeOptions::once), until the last page is closed. Gives the
/// address to `tell` as soon as it can be opened.
///
/// # Errors
///
/// If the port is taken, the public URL is none, or the folder cannot be read.
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
        memory: Renderer::memory(),
        gallery: Gallery::default(),
        folder,
        pages: Arc::new(Semaphore::new(MOST_PAGES)),
        exporting: Mutex::default(),
        way: Way::default(),
        closed: Notify::new(),
    });
    // The first greeting is made while the browser begins.
    drop(std::thread::spawn(Hello::new));
    tell(&url);
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
    /// The folder of the images of a recipe, which names none outside of it.
    fn of_images(&self, recipe: &Recipe) -> Result<&Path, StudioError> {
        self.folder.check_images(recipe)?;
        Ok(self.folder.path())
    }

    /// The images of a recipe, from its folder alone.
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError> {
        self.host.images(recipe, self.of_images(recipe)?)
    }

    /// Waits until the last page is closed, where the server ends then.
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

/// Answers a request.
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
