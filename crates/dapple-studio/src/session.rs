//! The state of one page: the text, the view, and the newest generation of images.

use crate::change::changes;
use crate::message::{Reply, Request, View};
use crate::patch::{Op, apply, spliced};
use crate::render::Job;
use crate::{Document, StudioError, Variant, points, strip};
use dapple::recipe::{Images, Recipe};
use std::sync::Arc;

/// Returns the images that a recipe names.
pub type ImagesOf<'a> = &'a dyn Fn(&Recipe) -> Result<Images, StudioError>;

/// The state of one page. Requests that need no rendering are answered immediately; rendering is returned as a
/// [`Job`].
#[derive(Debug)]
pub struct Session {
    document: Arc<Document>,
    rev: u64,
    view: View,
    generation: u32,
    /// Whether the text, the view or an image file has changed since the last job.
    is_new: bool,
}

impl Default for Session {
    fn default() -> Self {
        Self::new()
    }
}

impl Session {
    /// Creates a session with an empty text and a paused view.
    #[must_use]
    pub fn new() -> Self {
        Self {
            document: Arc::new(Document::new("")),
            rev: 0,
            view: View::default(),
            generation: 0,
            is_new: false,
        }
    }

    /// Returns the current text.
    #[must_use]
    pub fn document(&self) -> &Arc<Document> {
        &self.document
    }

    /// Returns the images that the page shows.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Replaces the document by another text, at revision 0. `file` is the name of the text's file and the file's
    /// hash.
    pub fn open(&mut self, text: &str, file: Option<(String, String)>) -> Vec<Reply> {
        self.rev = 0;
        let mut replies = self.put(Document::new(text));
        let name = match self.document.recipe() {
            Ok(recipe) if !recipe.name.is_empty() => recipe.name.clone(),
            _ => file
                .as_ref()
                .map_or_else(String::new, |(file, _)| stem(file).to_owned()),
        };
        let (file, hash) = file.unzip();
        let text = self.document.text().to_owned();
        replies.insert(
            0,
            Reply::Document {
                rev: 0,
                text,
                name,
                file,
                hash,
            },
        );
        replies
    }

    /// Returns the text of a recipe that a page opens by a built-in name or as text.
    fn text_of(builtin: Option<&str>, text: Option<String>) -> Result<String, StudioError> {
        match (builtin, text) {
            (Some(name), None) => Ok(Recipe::builtin_text(name)?.to_owned()),
            (None, Some(text)) => Ok(text),
            _ => Err(StudioError::new("open one of `builtin`, `file` and `text`")),
        }
    }

    /// Replaces the whole text after an edit in the page.
    fn doc(&mut self, rev: u64, text: &str) -> Vec<Reply> {
        self.rev = rev;
        if self.document.text() == text {
            return Vec::new();
        }
        self.put(Document::new(text))
    }

    /// Applies edits to the text if `rev` is the current revision.
    fn patch(&mut self, rev: u64, ops: &[Op], drag: bool, images: ImagesOf<'_>) -> Vec<Reply> {
        if rev != self.rev {
            return vec![Reply::Stale { rev: self.rev }];
        }
        let old = self.document.text();
        // Use the fast path for edits of numbers, and the general one otherwise.
        let new = match spliced(&self.document, ops) {
            Some(new) => Ok(new),
            None => self
                .with_points(ops, images)
                .and_then(|ops| apply(old, &ops)),
        };
        let new = match new {
            Ok(new) if new.len() > dapple::recipe::MAX_TEXT => {
                let error = StudioError::new("the text would be longer than 4 MiB");
                return vec![Reply::refused("patch", &error)];
            }
            Ok(new) => new,
            Err(error) => return vec![Reply::refused("patch", &error)],
        };
        // Report the edits, then replace the document.
        let changes = changes(old, &new);
        self.rev += 1;
        let mut replies = vec![Reply::Edits {
            rev: self.rev,
            changes,
            drag,
        }];
        if new != old {
            replies.extend(self.put(Document::new(new)));
        }
        replies
    }

    /// Sets the view. If it differs from the current one, a new generation starts.
    fn look(&mut self, view: View) {
        self.is_new |= self.view != view;
        self.view = view;
        if self.is_new {
            self.generation = self.generation.wrapping_add(1);
        }
    }

    /// Answers a request that needs no file and no rendering. Returns `None` for other requests.
    pub fn handle(&mut self, request: &Request, images: ImagesOf<'_>) -> Option<Vec<Reply>> {
        Some(match request {
            Request::Open {
                builtin,
                file: None,
                text,
            } => match Self::text_of(builtin.as_deref(), text.clone()) {
                Ok(text) => self.open(&text, None),
                Err(error) => vec![Reply::refused("open", &error)],
            },
            Request::Doc { rev, text } => self.doc(*rev, text),
            Request::Patch { rev, ops, drag } => self.patch(*rev, ops, *drag, images),
            Request::View(view) => {
                self.look(view.clone());
                Vec::new()
            }
            _ => return None,
        })
    }

    /// Returns the variants of a [`Request::Strip`], at most 12. The list is empty for other requests.
    #[must_use]
    pub fn strip(&self, request: Request) -> Vec<Variant> {
        let Request::Strip {
            node,
            changes,
            size,
        } = request
        else {
            return Vec::new();
        };
        let variant = |(index, changes)| Variant {
            document: self.document.clone(),
            changes,
            node: node.clone(),
            time: self.view.time,
            index,
            side: size,
        };
        (0..).zip(changes).take(strip::MOST).map(variant).collect()
    }

    /// Returns a job that renders the current text and view, if either has changed since the last job.
    pub fn job(&mut self) -> Option<Job> {
        core::mem::take(&mut self.is_new).then(|| Job {
            generation: self.generation,
            rev: self.rev,
            document: self.document.clone(),
            view: self.view.clone(),
        })
    }

    /// Starts a new generation because something other than the text has changed, such as an image file.
    pub fn renew(&mut self) {
        self.generation = self.generation.wrapping_add(1);
        self.is_new = true;
    }

    /// Fills the control points into every [`Op::MakePoints`] that lacks them.
    fn with_points(&self, ops: &[Op], images: ImagesOf<'_>) -> Result<Vec<Op>, StudioError> {
        let with_points = |op: &Op| {
            let Op::MakePoints { node, points: None } = op else {
                return Ok(op.clone());
            };
            let recipe = self
                .document
                .recipe()
                .map_err(|error| StudioError::from(error.clone()))?;
            let points = Some(points::editable(recipe, &images(recipe)?, node)?);
            let node = node.clone();
            Ok(Op::MakePoints { node, points })
        };
        ops.iter().map(with_points).collect()
    }

    /// Replaces the document. Returns a message with its errors, or with its data.
    fn put(&mut self, document: Document) -> Vec<Reply> {
        self.document = Arc::new(document);
        self.renew();
        let mut replies = Vec::new();
        let items = self.document.diagnostics();
        if !items.is_empty() {
            // Errors of the plan are reported later, when the recipe is rendered.
            replies.push(Reply::Diagnostics {
                rev: self.rev,
                items,
            });
        } else if let Some(recipe) = self.document.data() {
            let parameters = self.document.keys("parameters");
            replies.push(Reply::Values {
                rev: self.rev,
                recipe,
                parameters,
            });
        }
        replies
    }
}

/// Returns the name of a file without its extension.
fn stem(file: &str) -> &str {
    file.rsplit_once('.').map_or(file, |(stem, _)| stem)
}
