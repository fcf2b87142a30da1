//! A job drawn in pieces: a draft, then some rows at a time, then the rest.
//!
//! A worker has one thread and hears nothing while it draws, so that a piece must be short. Each piece is a job of the
//! [`Renderer`], whose plan and values stay in its memory; the page sees the messages of one job.

use dapple_recipe::{Images, Recipe};
use dapple_studio::{Area, Job, Output, Picture, RenderHost, Renderer, Reply, StudioError, View};
use std::cell::RefCell;

/// The most and the fewest pixels of a piece, about.
const PIECES: [u32; 2] = [1 << 16, 1 << 13];
/// The milliseconds for which the next piece is made smaller, and those for which it is made larger.
const PIECE_MS: [f64; 2] = [32.0, 8.0];

/// The pixels that are sent at a time: parts of a picture that is shown smaller should be few, since each is scaled alone.
const SENT_PIXELS: usize = 1 << 18;

/// How large pieces are, which follows from how long the last ones took.
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
    fn follow(&mut self, ms: f64) {
        let ([most, fewest], [slow, fast]) = (PIECES, PIECE_MS);
        if ms > slow {
            self.pixels = (self.pixels / 2).max(fewest);
        } else if ms < fast {
            self.pixels = (self.pixels * 2).min(most);
        }
    }

    /// The rows of a piece.
    fn rows(self, area: Area) -> u32 {
        (self.pixels / area.size[0].max(1)).max(16)
    }
}

/// A job, and how far it is drawn.
#[derive(Debug)]
pub(crate) struct Drawing {
    job: Job,
    start: f64,
    next: Next,
    told: ReportedProgress,
    /// Parts of maps that are not sent yet.
    pending: RefCell<Vec<Picture>>,
}

/// The next piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// The draft; all of it where there is no draft.
    Draft,
    /// The rows of the pictures from this one on.
    Rows(u32),
    /// All that follows the pictures.
    Rest,
}

/// What the page was told of the job.
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
        // The pixels of a draft are at least two pixels wide.
        let has_draft = view.draft && numbers.iter().all(|number| number % 2 == 0);
        let is_whole = view.paused || view.node.is_some() || pace.rows(area) >= area.size[1];
        Self {
            next: if has_draft || is_whole {
                Next::Draft
            } else {
                Next::Rows(0)
            },
            told: ReportedProgress::default(),
            pending: RefCell::default(),
            job,
            start,
        }
    }

    /// Draws the next piece, and says whether there is another one.
    pub(crate) fn step(
        &mut self,
        renderer: &mut Renderer,
        pace: &mut Pace,
        now: fn() -> f64,
        put: &mut dyn FnMut(Output),
    ) -> bool {
        let area = area_of(&self.job.view);
        let mut job = self.job.clone();
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
                // The picture of a node spreads the values of all its pixels from black to white, and so is one piece.
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
            told: RefCell::new(self.told),
            put: RefCell::new(put),
        };
        let start = now();
        renderer.draw(&job, &place);
        if let Next::Rows(_) = self.next {
            pace.follow(now() - start);
        }
        self.told = place.told.into_inner();
        let is_last = match self.next {
            Next::Draft => !self.told.draft,
            Next::Rows(_) => false,
            Next::Rest => true,
        };
        self.next = after;
        !is_last && !self.told.refused
    }
}

fn area_of(view: &View) -> Area {
    let (first, size) = ([0; 2], view.size);
    view.region.unwrap_or(Area { first, size })
}

/// The place of a piece: it passes on what belongs to the whole job.
struct Place<'a> {
    drawing: &'a Drawing,
    now: fn() -> f64,
    told: RefCell<ReportedProgress>,
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
        // The draft is a piece of its own.
        !(self.drawing.next == Next::Draft && self.told.borrow().draft)
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
    /// A message as the page gets it; none for those that belong to a piece alone.
    fn reply(&self, mut reply: Reply) -> Option<Reply> {
        let mut told = self.told.borrow_mut();
        let is_rows = matches!(self.drawing.next, Next::Rows(_));
        match &mut reply {
            Reply::Began { region, draft, .. } => {
                (*region, *draft) = (self.drawing.job.view.region, self.drawing.job.view.draft);
                return (!core::mem::replace(&mut told.began, true)).then_some(reply);
            }
            Reply::Graph { .. } => {
                return (!core::mem::replace(&mut told.graph, true)).then_some(reply);
            }
            Reply::Rendered { draft: true, .. } => told.draft = true,
            Reply::Rendered { .. } if is_rows => return None,
            Reply::Rendered { ms, .. } => *ms = (self.now)() - self.drawing.start,
            Reply::Refused { .. } => told.refused = true,
            Reply::Diagnostics { items, .. } => told.refused |= !items.is_empty(),
            _ => {}
        }
        Some(reply)
    }

    /// The part of a map that is to be sent, if it is large enough or the last one.
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

/// The images of a recipe: there are none here.
pub(crate) fn images(recipe: &Recipe) -> Result<Images, StudioError> {
    if recipe.image_files().is_empty() {
        return Ok(Images::new());
    }
    let error =
        StudioError::new("images are read from the folder of a recipe, and there is none here");
    Err(error.with_hint("open the recipe with `dapple studio`"))
}
