//! Performs slow requests other than rendering: reports, programs and exports.

use crate::code::Code;
use crate::message::{CodeKind, Export, Reply, Request};
use crate::{Document, ImagesOf, Session, StudioError, points, seams};
use dapple::recipe::{Images, Recipe};
use std::sync::Arc;

/// Bakes a recipe to files. Returns the reply that lists them.
pub type ExportOf<'a> = &'a dyn Fn(&Recipe, &Export) -> Result<Reply, StudioError>;

/// A request for a report, a program or files, together with the document it refers to.
#[derive(Clone, Debug)]
pub struct Task {
    document: Arc<Document>,
    time: f64,
    /// The name of the recipe's file. Empty if there is no file.
    file: String,
    what: &'static str,
    request: Request,
}

impl Session {
    /// Returns the task for a slow request, and `None` for other requests. `file` is the name of the recipe's file,
    /// or empty.
    #[must_use]
    pub fn task(&self, request: &Request, file: &str) -> Option<Task> {
        let what = match request {
            Request::Seams { .. } => "seams",
            Request::Points { .. } => "points",
            Request::Code { .. } => "code",
            Request::Export(_) => "export",
            _ => return None,
        };
        Some(Task {
            document: self.document().clone(),
            time: self.view().time,
            file: file.to_owned(),
            what,
            request: request.clone(),
        })
    }
}

impl Task {
    /// Returns the type of the request.
    #[must_use]
    pub fn what(&self) -> &'static str {
        self.what
    }

    /// Performs the task and returns the reply: the result, or the refusal.
    #[must_use]
    pub fn answer(&self, images: ImagesOf<'_>, export: ExportOf<'_>) -> Reply {
        self.reply(images, export)
            .unwrap_or_else(|error| Reply::refused(self.what, &error))
    }

    fn reply(&self, images: ImagesOf<'_>, export: ExportOf<'_>) -> Result<Reply, StudioError> {
        let recipe = self.document.recipe();
        let recipe = recipe.map_err(|error| StudioError::from(error.clone()))?;
        Ok(match &self.request {
            Request::Seams { size } => Reply::Seams {
                maps: seams::report(recipe, &images(recipe)?, *size)?,
            },
            Request::Points { node } => {
                let points = points::report(recipe, &images(recipe)?, node, self.time)?;
                Reply::Points(Box::new(points))
            }
            Request::Code { kind, size, maps } => {
                let (kind, size, name) = (*kind, *size, self.file.as_str());
                let maps = maps.as_deref();
                // Only the shader is computed from images.
                let images = match kind {
                    CodeKind::Wgsl => images(recipe)?,
                    _ => Images::new(),
                };
                let code = Code {
                    kind,
                    size,
                    maps,
                    name,
                };
                let text = code.text(&self.document, recipe, &images)?;
                Reply::Code { kind, text }
            }
            Request::Export(options) => export(recipe, options)?,
            _ => return Err(StudioError::new("this is answered at once")),
        })
    }
}
