//! Renders a job incrementally: a draft, then some rows at a time, then everything else.
//!
//! A worker has one thread and processes no messages while it renders, so each step must be short. Each step is a job
//! of the [`Renderer`], which caches the plan and its values. The page receives the messages of a single job.

use dapple_recipe::{Images, Recipe};
use dapple_studio::{Area, Job, Output, Picture, RenderHost, Renderer, Reply, StudioError, View};
use std::cell::RefCell;

/// Maximum and minimum number of pixels per step, approximately.
const PIECES: [u32; 2] = [1 << 16, 1 << 13];
/// Thresholds for a step's time, in milliseconds. Above the first, the size of the next step is halved; below the
/// second, it is doubled.
const PIECE_MS: [f64; 2] = [32.0, 8.0];

/// Minimum number of pixels per sent part of a map, except the last part. Few parts are better because a page that
/// scales an image down scales each part separately.
const SENT_PIXELS: usize = 1 << 18;

/// The number of pixels per step, adapted to the time of previous steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    pixels: u32,
}

impl Default for Pace {
    fn default() -> Self {
        let [most, _] = PIECES;
        Self { pixels: most }
    }
}

impl Pace {
    /// Adapts the number of pixels to the time of the last step.
    fn follow(&mut self, ms: f64) {
        let ([most, fewest], [slow, fast]) = (PIECES, PIECE_MS);
        if ms > slow {
            self.pixels = (self.pixels / 2).max(fewest);
        } else if ms < fast {
            self.pixels = (self.pixels * 2).min(most);
        }
    }

    /// Returns the number of rows per step.
    fn rows(self, area: Area) -> u32 {
        (self.pixels / area.size[0].max(1)).max(16)
    }
}

/// A job in progress.
#[derive(Debug)]
pub(crate) struct Drawing {
    job: Job,
    start: f64,
    next: Next,
    reported: ReportedProgress,
    /// Parts of maps that have not been sent yet.
    pending: RefCell<Vec<Picture>>,
}

/// The part of a job that is rendered next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// The draft. If there is no draft, the whole job.
    Draft,
    /// Rows of the maps, starting at this row of the visible region.
    Rows(u32),
    /// Everything after the maps, such as thumbnails.
    Rest,
}

/// Which messages of the job the page has received.
#[derive(Clone, Copy, Debug, Default)]
struct ReportedProgress {
    began: bool,
    graph: bool,
    draft: bool,
    refused: bool,
}

impl Drawing {
    pub(crate) fn new(job: Job, start: f64, pace: Pace) -> Self {
        let view = &job.view;
        let area = area_of(view);
        let numbers = [view.size, area.first, area.size].concat();
        // The scale of a draft is at least 2.
        let has_draft = view.draft && numbers.iter().all(|number| number % 2 == 0);
        let is_whole = view.paused || view.node.is_some() || pace.rows(area) >= area.size[1];
        Self {
            next: if has_draft || is_whole {
                Next::Draft
            } else {
                Next::Rows(0)
            },
            reported: ReportedProgress::default(),
            pending: RefCell::default(),
            job,
            start,
        }
    }

    /// Renders the next step. Returns whether there is another step.
    pub(crate) fn step(
        &mut self,
        renderer: &mut Renderer,
        pace: &mut Pace,
        now: fn() -> f64,
        put: &mut dyn FnMut(Output),
    ) -> bool {
        let area = area_of(&self.job.view);
        let mut job = self.job.clone();
        // Restrict the job to the next step.
        let after = match self.next {
            Next::Draft if job.view.node.is_some() => Next::Rest,
            Next::Draft => Next::Rows(0),
            Next::Rows(first) => {
                let rows = pace.rows(area).min(area.size[1] - first);
                job.view.region = Some(Area {
                    first: [area.first[0], area.first[1] + first],
                    size: [area.size[0], rows],
                });
                (job.view.draft, job.view.thumbnails, job.view.exact) = (false, false, None);
                if first + rows < area.size[1] {
                    Next::Rows(first + rows)
                } else {
                    Next::Rest
                }
            }
            Next::Rest => {
                // The image of a node needs the range of all its values, so it is rendered in a single step.
                if job.view.node.is_none() {
                    job.view.maps.clear();
                }
                job.view.draft = false;
                Next::Rest
            }
        };
        let place = Place {
            drawing: self,
            now,
            reported: RefCell::new(self.reported),
            put: RefCell::new(put),
        };
        let start = now();
        renderer.draw(&job, &place);
        if let Next::Rows(_) = self.next {
            pace.follow(now() - start);
        }
        self.reported = place.reported.into_inner();
        let is_last = match self.next {
            Next::Draft => !self.reported.draft,
            Next::Rows(_) => false,
            Next::Rest => true,
        };
        self.next = after;
        !is_last && !self.reported.refused
    }
}

fn area_of(view: &View) -> Area {
    let (first, size) = ([0; 2], view.size);
    view.region.unwrap_or(Area { first, size })
}

/// The render host of one step. It forwards the messages that belong to the whole job.
struct Place<'a> {
    drawing: &'a Drawing,
    now: fn() -> f64,
    reported: RefCell<ReportedProgress>,
    put: RefCell<&'a mut dyn FnMut(Output)>,
}

impl RenderHost for Place<'_> {
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError> {
        images(recipe)
    }

    fn now(&self) -> f64 {
        (self.now)()
    }

    fn is_wanted(&self, _: u32) -> bool {
        // Stop after the draft, which is a separate step.
        !(self.drawing.next == Next::Draft && self.reported.borrow().draft)
    }

    fn put(&self, output: Output) {
        let output = match output {
            Output::Reply(reply) => self.reply(reply).map(Output::Reply),
            Output::Picture(picture) => self.picture(picture).map(Output::Picture),
        };
        if let Some(output) = output {
            (self.put.borrow_mut())(output);
        }
    }
}

impl Place<'_> {
    /// Converts a message of a step to a message of the whole job. Returns `None` for messages that concern only the
    /// step.
    fn reply(&self, mut reply: Reply) -> Option<Reply> {
        let mut reported = self.reported.borrow_mut();
        let is_rows = matches!(self.drawing.next, Next::Rows(_));
        match &mut reply {
            Reply::Began { region, draft, .. } => {
                (*region, *draft) = (self.drawing.job.view.region, self.drawing.job.view.draft);
                return (!core::mem::replace(&mut reported.began, true)).then_some(reply);
            }
            Reply::Graph { .. } => {
                return (!core::mem::replace(&mut reported.graph, true)).then_some(reply);
            }
            Reply::Rendered { draft: true, .. } => reported.draft = true,
            Reply::Rendered { .. } if is_rows => return None,
            Reply::Rendered { ms, .. } => *ms = (self.now)() - self.drawing.start,
            Reply::Refused { .. } => reported.refused = true,
            Reply::Diagnostics { items, .. } => reported.refused |= !items.is_empty(),
            _ => {}
        }
        Some(reply)
    }

    /// Joins a part of a map with the pending rows above it. Returns the joined part if it is large enough or the
    /// last one.
    fn picture(&self, mut picture: Picture) -> Option<Picture> {
        if !matches!(self.drawing.next, Next::Rows(_)) {
            return Some(picture);
        }
        let area = area_of(&self.drawing.job.view);
        picture.is_last &= picture.first[1] + picture.size[1] == area.first[1] + area.size[1];
        let mut pending = self.drawing.pending.borrow_mut();
        let place = pending
            .iter()
            .position(|above| above.shown == picture.shown);
        let joined = match place.map(|place| pending.swap_remove(place)) {
            None => picture,
            Some(mut above) => {
                above.size[1] += picture.size[1];
                above.pixels.extend(picture.pixels);
                above.is_last = picture.is_last;
                above
            }
        };
        if joined.is_last || joined.pixels.len() >= 4 * SENT_PIXELS {
            return Some(joined);
        }
        pending.push(joined);
        None
    }
}

/// Returns an empty set of images. Fails if the recipe names images, since there is no folder to read them from.
pub(crate) fn images(recipe: &Recipe) -> Result<Images, StudioError> {
    if recipe.image_files().is_empty() {
        return Ok(Images::new());
    }
    let error =
        StudioError::new("images are read from the folder of a recipe, and there is none here");
    Err(error.with_hint("open the recipe with `dapple studio`"))
}
