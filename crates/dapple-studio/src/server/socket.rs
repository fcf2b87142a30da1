//! The WebSocket of a page, which receives requests and sends replies and images.

use super::Shared;
use super::files::decoded;
use super::flow::Flow;
use super::worker::{Sample, Worker};
use crate::message::{Hello, Mode, Output, Reply, Request, View};
use crate::{Session, Shown, StudioError};
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{FromRequestParts as _, Request as HttpRequest};
use axum::http::StatusCode;
use axum::response::{IntoResponse as _, Response};
use dapple::image::FileChanges;
use dapple::recipe::{MAX_TEXT, Recipe};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc::unbounded_channel;
use tokio::time::{MissedTickBehavior, interval};

/// Maximum length of a message in bytes: the text of the largest recipe, with room for JSON escapes.
const MAX_MESSAGE: usize = 2 * MAX_TEXT;
/// Polling interval for changes of the files that a page shows.
const LOOK: Duration = Duration::from_millis(100);

/// Upgrades a request to a socket.
pub(super) async fn upgrade(shared: Arc<Shared>, request: HttpRequest) -> Response {
    let (mut parts, _) = request.into_parts();
    let upgrade = match WebSocketUpgrade::from_request_parts(&mut parts, &()).await {
        Ok(upgrade) => upgrade,
        Err(refusal) => return refusal.into_response(),
    };
    // Acquire the permit before responding, so that simultaneous pages cannot exceed the limit.
    let Ok(place) = shared.pages.clone().try_acquire_owned() else {
        return StatusCode::SERVICE_UNAVAILABLE.into_response();
    };
    let view = view_of(parts.uri.query().unwrap_or_default());
    let upgrade = upgrade
        .max_message_size(MAX_MESSAGE)
        .max_frame_size(MAX_MESSAGE);
    upgrade.on_upgrade(move |socket| async move {
        shared.way.close();
        // An error means that the page has disconnected, so no one is left to receive it.
        let _ = Page::serve(shared.clone(), socket, view).await;
        drop(place);
        shared.closed.notify_one();
    })
}

/// Parses the initial view from the query. It is rendered while the page loads.
fn view_of(query: &str) -> Option<View> {
    let text = query
        .split('&')
        .find_map(|pair| pair.strip_prefix("view="))?;
    serde_json::from_str(&decoded(text)?).ok()
}

/// A connected page.
struct Page {
    shared: Arc<Shared>,
    socket: WebSocket,
    session: Session,
    worker: Worker,
    flow: Flow,
    /// The open file: its name, and its hash when it was last read or written.
    file: Option<(String, String)>,
    changes: FileChanges,
}

/// The socket was closed.
struct Ended;

impl From<axum::Error> for Ended {
    fn from(_: axum::Error) -> Self {
        Self
    }
}

impl From<StudioError> for Ended {
    fn from(_: StudioError) -> Self {
        Self
    }
}

impl Page {
    async fn serve(
        shared: Arc<Shared>,
        socket: WebSocket,
        view: Option<View>,
    ) -> Result<(), Ended> {
        let (sender, mut outputs) = unbounded_channel();
        let mut looks = interval(LOOK);
        looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut page = Self {
            worker: Worker::new(shared.clone(), sender)?,
            session: Session::new(),
            flow: Flow::default(),
            file: None,
            changes: FileChanges::default(),
            shared,
            socket,
        };
        page.greet(view).await?;
        loop {
            tokio::select! {
                message = page.socket.recv() => match message {
                    Some(message) => page.hear(message?).await?,
                    None => return Ok(()),
                },
                Some(output) = outputs.recv() => page.pass_on(output).await?,
                _ = looks.tick() => if page.looks_other() {
                    page.compare_with_disk().await?;
                },
            }
        }
    }

    /// Sends the greeting, sets the initial view, and opens the recipe of the command line.
    async fn greet(&mut self, view: Option<View>) -> Result<(), Ended> {
        let options = &self.shared.options;
        let mut hello = Hello::new();
        hello.mode = options.mode;
        hello.files = self.shared.folder.recipes();
        hello.presets = self.shared.host.presets();
        hello.open = options.recipe.clone();
        let first = options.recipe.clone();
        self.say(Reply::Hello(Box::new(hello))).await?;
        if let Some(view) = view {
            self.answer(Request::View(view)).await?;
        }
        if let Some(name) = first {
            let is_builtin = Recipe::builtin_text(&name).is_ok();
            let (builtin, file) = if is_builtin {
                (Some(name), None)
            } else {
                (None, Some(name))
            };
            self.answer(Request::Open {
                builtin,
                file,
                text: None,
            })
            .await?;
        }
        Ok(())
    }

    /// Parses and answers a message.
    async fn hear(&mut self, message: Message) -> Result<(), Ended> {
        match message {
            Message::Text(text) => match serde_json::from_str(&text) {
                Ok(request) => self.answer(request).await,
                Err(error) => {
                    let error = StudioError::new(format!("the message cannot be read: {error}"));
                    self.say(Reply::refused("message", &error)).await
                }
            },
            Message::Binary(_) => {
                let error = StudioError::new("messages are text");
                self.say(Reply::refused("message", &error)).await
            }
            Message::Close(_) => Err(Ended),
            Message::Ping(_) | Message::Pong(_) => Ok(()),
        }
    }

    async fn answer(&mut self, request: Request) -> Result<(), Ended> {
        // Handle flow control and slow requests.
        if let Request::Ack { map, .. } = request {
            return match self.flow.drawn(map) {
                Some(picture) => self.show(&picture).await,
                None => Ok(()),
            };
        }
        if let Request::Stop = request {
            self.worker.stop_exports();
            return Ok(());
        }
        let file = self.file.as_ref().map_or("", |(name, _)| name);
        if let Some(task) = self.session.task(&request, file) {
            self.worker.ask(task);
            return Ok(());
        }
        let images = |recipe: &Recipe| self.worker.images(recipe);
        // Answer the others immediately.
        let replies = match self.session.handle(&request, &images) {
            Some(replies) => {
                if let Request::Open { .. } = request {
                    self.file = None;
                }
                replies
            }
            None => match self.answer_with_files(request) {
                Ok(replies) => replies,
                Err((what, error)) => vec![Reply::refused(what, &error)],
            },
        };
        for reply in replies {
            self.say(reply).await?;
        }
        if let Some(job) = self.session.job() {
            // Record the files' state before the images are read, so that no later change is missed.
            for file in self.files() {
                self.changes.remember(file);
            }
            self.worker.draw(job);
        }
        Ok(())
    }

    /// Answers a request that needs files.
    fn answer_with_files(
        &mut self,
        request: Request,
    ) -> Result<Vec<Reply>, (&'static str, StudioError)> {
        match request {
            Request::Open {
                file: Some(file),
                builtin: None,
                text: None,
            } => self.open(file).map_err(|error| ("open", error)),
            Request::Gallery { size } => {
                self.worker.sample(self.samples(size));
                Ok(Vec::new())
            }
            request @ Request::Strip { .. } => {
                self.worker.vary(self.session.strip(request));
                Ok(Vec::new())
            }
            Request::Save {
                text,
                file,
                overwrite,
                seen,
            } => {
                let seen = seen.as_deref();
                let saved = self.save(file, &text, seen, overwrite);
                saved.map_err(|error| ("save", error))
            }
            _ => Err((
                "open",
                StudioError::new("give one of `builtin`, `file` and `text`"),
            )),
        }
    }

    fn open(&mut self, file: String) -> Result<Vec<Reply>, StudioError> {
        let path = self.shared.folder.path().join(&file);
        self.changes.remember(path);
        let (text, hash) = self.shared.folder.read(&file)?;
        self.file = Some((file.clone(), hash.clone()));
        Ok(self.session.open(&text, Some((file, hash))))
    }

    fn save(
        &mut self,
        file: String,
        text: &str,
        seen: Option<&str>,
        overwrite: bool,
    ) -> Result<Vec<Reply>, StudioError> {
        if self.shared.options.mode != Mode::Studio {
            return Err(StudioError::new("here recipes are only looked at"));
        }
        let hash = self.shared.folder.save(&file, text, seen, overwrite)?;
        self.file = Some((file.clone(), hash.clone()));
        Ok(vec![Reply::Saved { file, hash }])
    }

    /// Lists the recipes of the gallery, which are the built-in ones and those in the folder.
    fn samples(&self, side: u32) -> Vec<Sample> {
        let builtin = |(index, name): (u16, &str)| Sample {
            shown: Shown::Builtin(index),
            text: Recipe::builtin_text(name).unwrap_or_default().to_owned(),
            side,
        };
        let folder = &self.shared.folder;
        let file = |(index, name): (u16, String)| {
            let (text, _) = folder.read(&name).ok()?;
            let shown = Shown::File(index);
            Some(Sample { shown, text, side })
        };
        let files = (0..).zip(folder.recipes()).filter_map(file);
        (0..)
            .zip(Recipe::builtin_names())
            .map(builtin)
            .chain(files)
            .collect()
    }

    /// Returns the open file and the images of its recipe.
    fn files(&self) -> Vec<PathBuf> {
        let folder = &self.shared.folder;
        let file = self.file.iter().map(|(name, _)| folder.path().join(name));
        let mut files: Vec<PathBuf> = file.collect();
        if let Ok(recipe) = self.session.document().recipe() {
            files.extend(folder.image_paths(recipe));
        }
        files
    }

    /// Returns whether the open file or an image of its recipe has changed on disk. A file that is still being written
    /// counts as unchanged.
    fn looks_other(&mut self) -> bool {
        let files = self.files();
        self.changes.look(&files)
    }

    /// Notifies the page if the open file has changed on disk. Renders again if the recipe has images.
    async fn compare_with_disk(&mut self) -> Result<(), Ended> {
        if let Some((file, known)) = &mut self.file
            && let Ok((text, hash)) = self.shared.folder.read(file)
            && *known != hash
        {
            known.clone_from(&hash);
            let file = file.clone();
            self.say(Reply::Disk { text, hash, file }).await?;
        }
        if self
            .session
            .document()
            .recipe()
            .is_ok_and(|recipe| !recipe.image_files().is_empty())
        {
            self.session.renew();
            if let Some(job) = self.session.job() {
                self.worker.draw(job);
            }
        }
        Ok(())
    }

    /// Sends a reply, or queues an image for flow control.
    async fn pass_on(&mut self, output: Output) -> Result<(), Ended> {
        match output {
            Output::Reply(reply) => self.say(reply).await,
            Output::Picture(picture) => match self.flow.put(picture) {
                Some(picture) => self.show(&picture).await,
                None => Ok(()),
            },
        }
    }

    async fn show(&mut self, picture: &crate::Picture) -> Result<(), Ended> {
        Ok(self
            .socket
            .send(Message::Binary(picture.to_short_bytes().into()))
            .await?)
    }

    async fn say(&mut self, reply: Reply) -> Result<(), Ended> {
        let text = serde_json::to_string(&reply).map_err(|_| Ended)?;
        Ok(self.socket.send(Message::Text(text.into())).await?)
    }
}
