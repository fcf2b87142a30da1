//! A page with its session, pending work, and queue of results.

use crate::drawing::{Drawing, Pace, images};
use crate::export;
use dapple_recipe::{Images, PlanCache, Recipe};
use dapple_studio::{
    Export, Hello, Mode, Output, RenderHost, Renderer, Reply, Request, Session, Shown, StudioError,
    Task, Variant, sample,
};
use std::cell::RefCell;
use std::collections::VecDeque;

/// Maximum size of the cached node values, in bytes.
const MEMORY: usize = 1 << 28;

/// A result to send to the page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Made {
    /// A message as JSON.
    Message(String),
    /// An image with its header.
    Picture(Vec<u8>),
    /// The content of an exported file. The files follow the message `exported` in the order of its list.
    File(Vec<u8>),
}

/// A page that receives messages, works in steps, and queues results.
#[derive(Debug)]
pub struct Page {
    now: fn() -> f64,
    session: Session,
    renderer: Renderer,
    tasks: VecDeque<Task>,
    drawing: Option<Drawing>,
    pace: Pace,
    /// Variants still to render, of the strip that was requested last.
    variants: VecDeque<Variant>,
    /// Built-in recipes whose thumbnails are pending. `side` is the longer side of the thumbnails, in pixels.
    samples: VecDeque<(u16, &'static str)>,
    side: u32,
    made: VecDeque<Made>,
}

impl Page {
    /// Creates a page and queues its greeting. `now` returns milliseconds since an arbitrary moment.
    #[must_use]
    pub fn new(now: fn() -> f64) -> Self {
        let mut page = Self {
            now,
            session: Session::new(),
            renderer: Renderer::new(&PlanCache::new(MEMORY)),
            tasks: VecDeque::new(),
            drawing: None,
            pace: Pace::default(),
            variants: VecDeque::new(),
            samples: VecDeque::new(),
            side: 0,
            made: VecDeque::new(),
        };
        let mut hello = Hello::new();
        hello.mode = Mode::Static;
        page.say(&Reply::Hello(Box::new(hello)));
        page
    }

    /// Removes the oldest result from the queue.
    pub fn poll(&mut self) -> Option<Made> {
        self.made.pop_front()
    }

    /// Processes a message in JSON.
    pub fn receive(&mut self, message: &[u8]) {
        match serde_json::from_slice(message) {
            Ok(request) => self.answer(&request),
            Err(error) => {
                let error = StudioError::new(format!("the message cannot be read: {error}"));
                self.say(&Reply::refused("message", &error));
            }
        }
    }

    fn answer(&mut self, request: &Request) {
        if let Some(task) = self.session.task(request, "") {
            self.tasks.push_back(task);
            return;
        }
        match self.session.handle(request, &images) {
            Some(replies) => replies.iter().for_each(|reply| self.say(reply)),
            None => self.answer_here(request),
        }
        if let Some(job) = self.session.job() {
            self.drawing = Some(Drawing::new(job, (self.now)(), self.pace));
        }
    }

    /// Answers a request that needs files on a server.
    fn answer_here(&mut self, request: &Request) {
        let (what, message) = match request {
            Request::Gallery { size } => {
                self.side = *size;
                self.samples = (0..).zip(Recipe::builtin_names()).collect();
                return;
            }
            Request::Strip { .. } => {
                self.variants = self.session.strip(request.clone()).into();
                return;
            }
            // Images are not flow-controlled here, and an export is complete before the next message is read.
            Request::Ack { .. } | Request::Stop => return,
            Request::Save { .. } => ("save", "recipes are not saved here, but downloaded"),
            _ => ("open", "open one of `builtin` and `text`"),
        };
        self.say(&Reply::refused(what, &StudioError::new(message)));
    }

    /// Performs the next step of work. Returns whether more work is pending.
    pub fn step(&mut self) -> bool {
        // In order of priority: tasks, the view, the strip, the gallery.
        if let Some(task) = self.tasks.pop_front() {
            self.perform(&task);
        } else if let Some(mut drawing) = self.drawing.take() {
            let made = &mut self.made;
            let put = &mut |output| put(made, output);
            if drawing.step(&mut self.renderer, &mut self.pace, self.now, put) {
                self.drawing = Some(drawing);
            }
        } else if let Some(variant) = self.variants.pop_front() {
            let made = RefCell::new(&mut self.made);
            self.renderer.draw_variant(
                &variant,
                &Beside {
                    now: self.now,
                    made,
                },
            );
        } else if let Some((index, name)) = self.samples.pop_front() {
            let picture = Recipe::builtin(name).map_err(StudioError::from);
            let picture = picture.and_then(|recipe| {
                sample(Shown::Builtin(index), &recipe, &images(&recipe)?, self.side)
            });
            // A recipe that cannot be baked has no thumbnail.
            if let Ok(picture) = picture {
                self.made.push_back(Made::Picture(picture.to_bytes()));
            }
        }
        let is_left = [
            !self.tasks.is_empty(),
            self.drawing.is_some(),
            !self.variants.is_empty(),
            !self.samples.is_empty(),
        ];
        is_left.contains(&true)
    }

    fn perform(&mut self, task: &Task) {
        let files = RefCell::new(Vec::new());
        let export = |recipe: &Recipe, export: &Export| {
            let (sizes, contents): (Vec<_>, Vec<_>) =
                export::files(recipe, export)?.into_iter().unzip();
            *files.borrow_mut() = contents;
            let id = "1".to_owned();
            Ok(Reply::Exported { id, files: sizes })
        };
        self.say(&task.answer(&images, &export));
        self.made
            .extend(files.into_inner().into_iter().map(Made::File));
    }

    fn say(&mut self, reply: &Reply) {
        put(&mut self.made, Output::Reply(reply.clone()));
    }
}

/// The render host of the variants of a strip.
struct Beside<'a> {
    now: fn() -> f64,
    made: RefCell<&'a mut VecDeque<Made>>,
}

impl RenderHost for Beside<'_> {
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError> {
        images(recipe)
    }

    fn now(&self) -> f64 {
        (self.now)()
    }

    fn is_wanted(&self, _: u32) -> bool {
        true
    }

    fn put(&self, output: Output) {
        put(&mut self.made.borrow_mut(), output);
    }
}

fn put(made: &mut VecDeque<Made>, output: Output) {
    made.push_back(match output {
        Output::Picture(picture) => Made::Picture(picture.to_bytes()),
        Output::Reply(reply) => match serde_json::to_string(&reply) {
            Ok(text) => Made::Message(text),
            Err(_) => return,
        },
    });
}
