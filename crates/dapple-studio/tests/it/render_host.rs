//! A render host for tests of sessions.

use dapple::raster::Window;
use dapple::recipe::{Images, Plan, Recipe, RendererError, Values};
use dapple_studio::{Output, Picture, RenderHost, Renderer, Reply, Request, Session, StudioError};
use serde_json::{Value, json};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A host that collects outputs. Its job may be superseded after a number of outputs.
#[derive(Default)]
pub(crate) struct TestWorld {
    pub(crate) outputs: RefCell<Vec<Output>>,
    pub(crate) wanted: Cell<Option<usize>>,
    /// Number of further checks at which the job still counts as current; `None` for no limit.
    pub(crate) patience: Cell<Option<usize>>,
    /// Milliseconds that the clock advances at every query.
    pub(crate) pace: Cell<f64>,
    time: Cell<f64>,
    /// Whether plans are on a GPU, which fails.
    pub(crate) has_broken_gpu: Cell<bool>,
    pub(crate) gpu_errors: RefCell<Vec<String>>,
}

/// A GPU that computes all nodes, and fails.
#[derive(Debug)]
struct BrokenGpu;

impl dapple::recipe::Renderer for BrokenGpu {
    fn inputs(&self, _: &str) -> Option<Vec<String>> {
        Some(Vec::new())
    }

    fn render(
        &self,
        _: &[&str],
        _: &Window,
        _: &BTreeMap<&str, &Values>,
    ) -> Result<Vec<Values>, RendererError> {
        Err(RendererError::new(StudioError::new("it is broken")))
    }
}

impl RenderHost for TestWorld {
    fn images(&self, _: &Recipe) -> Result<Images, StudioError> {
        Ok(Images::new())
    }

    fn on_gpu(&self, _: &Recipe, plan: &Plan) -> Option<Plan> {
        let on_gpu = || plan.clone().with_renderer(Arc::new(BrokenGpu));
        self.has_broken_gpu.get().then(on_gpu)
    }

    fn gpu_failed(&self, error: &RendererError) {
        self.gpu_errors.borrow_mut().push(error.to_string());
    }

    fn now(&self) -> f64 {
        self.time.set(self.time.get() + self.pace.get());
        self.time.get()
    }

    fn is_wanted(&self, _: u32) -> bool {
        if let Some(left) = self.patience.get() {
            self.patience.set(Some(left.saturating_sub(1)));
            return left > 0;
        }
        self.wanted
            .get()
            .is_none_or(|most| self.outputs.borrow().len() < most)
    }

    fn put(&self, output: Output) {
        self.outputs.borrow_mut().push(output);
    }
}

/// A session with its renderer.
#[derive(Default)]
pub(crate) struct Page {
    pub(crate) session: Session,
    pub(crate) renderer: Renderer,
}

impl Page {
    /// Sends a request and returns the replies.
    pub(crate) fn ask(&mut self, message: Value) -> Vec<Value> {
        let request: Request = serde_json::from_value(message).unwrap();
        let replies = self
            .session
            .handle(&request, &|_| Ok(Images::new()))
            .unwrap();
        replies.iter().map(json_of).collect()
    }

    /// Opens a built-in recipe.
    pub(crate) fn open(name: &str) -> Self {
        let mut page = Self::default();
        page.ask(json!({ "type": "open", "builtin": name }));
        page
    }

    /// Renders the pending job, if any. Returns the messages and images.
    pub(crate) fn draw(&mut self) -> (Vec<Value>, Vec<Picture>) {
        let world = TestWorld::default();
        if let Some(job) = self.session.job() {
            self.renderer.draw(&job, &world);
        }
        split(world.outputs.into_inner())
    }
}

pub(crate) fn split(outputs: Vec<Output>) -> (Vec<Value>, Vec<Picture>) {
    let (mut replies, mut pictures) = (Vec::new(), Vec::new());
    for output in outputs {
        match output {
            Output::Reply(reply) => replies.push(json_of(&reply)),
            Output::Picture(picture) => pictures.push(picture),
        }
    }
    (replies, pictures)
}

pub(crate) fn json_of(reply: &Reply) -> Value {
    serde_json::to_value(reply).unwrap()
}

/// Returns the messages of one type.
pub(crate) fn of_type<'a>(replies: &'a [Value], name: &str) -> Vec<&'a Value> {
    replies
        .iter()
        .filter(|reply| reply["type"] == name)
        .collect()
}
