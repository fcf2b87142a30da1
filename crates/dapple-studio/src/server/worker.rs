//! The two threads of a page. The first renders images, always of the newest state, after it has answered pending
//! requests for reports. The second runs exports, which are slow.

use super::Shared;
use crate::message::{Export, Output, Reply};
use crate::render::{Job, RenderHost, Renderer};
use crate::{Lit, Shown, StudioError, Task, Variant};
use dapple::color::LinearRgb;
use dapple::image::FileStamp;
use dapple::raster::Raster;
use dapple::recipe::{Images, Plan, Recipe, RendererError};
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use tokio::sync::mpsc::UnboundedSender;

/// The work queues of the threads.
#[derive(Default)]
struct Queue {
    job: Option<Job>,
    tasks: VecDeque<Task>,
    exports: VecDeque<Task>,
    /// Remaining thumbnails of the strip that was requested last.
    variants: VecDeque<Variant>,
    /// Thumbnails of the gallery, rendered at the lowest priority.
    samples: VecDeque<Sample>,
    is_over: bool,
}

/// A request for a recipe's thumbnail.
pub(super) struct Sample {
    pub(super) shown: Shown,
    pub(super) text: String,
    pub(super) side: u32,
}

/// The page's handle to its threads. Dropping it ends them.
pub(super) struct Worker {
    inside: Arc<Inside>,
}

struct Inside {
    shared: Arc<Shared>,
    queue: Mutex<Queue>,
    changed: Condvar,
    /// The newest generation that was requested.
    newest: AtomicU32,
    /// Set to true to stop the running export.
    stop: Arc<AtomicBool>,
    start: Instant,
    output: UnboundedSender<Output>,
    images: Mutex<Loaded>,
}

/// Images of the last recipe, cached with the stamps of their files.
#[derive(Default)]
struct Loaded {
    stamps: Vec<(PathBuf, Option<FileStamp>)>,
    images: Images,
}

/// Maximum number of waiting tasks.
const MOST_TASKS: usize = 32;

impl Worker {
    #[expect(
        clippy::disallowed_methods,
        reason = "how long drawing takes is told, and decides on the size of drafts"
    )]
    pub(super) fn new(
        shared: Arc<Shared>,
        output: UnboundedSender<Output>,
    ) -> Result<Self, StudioError> {
        let inside = Arc::new(Inside {
            shared,
            queue: Mutex::default(),
            changed: Condvar::new(),
            newest: AtomicU32::new(0),
            stop: Arc::default(),
            start: Instant::now(),
            output,
            images: Mutex::default(),
        });
        // Dropping the worker ends the threads, even if the second one fails to start.
        let worker = Self { inside };
        worker.spawn("studio", Inside::run)?;
        worker.spawn("studio export", Inside::run_exports)?;
        Ok(worker)
    }

    fn spawn(&self, name: &str, run: fn(&Inside)) -> Result<(), StudioError> {
        let inside = self.inside.clone();
        let thread = std::thread::Builder::new().name(name.to_owned());
        let spawned = thread.spawn(move || run(&inside));
        spawned.map_err(|error| StudioError::new(format!("no thread can be started: {error}")))?;
        Ok(())
    }

    /// Schedules a rendering job. A waiting job is dropped, and a running one is canceled.
    pub(super) fn draw(&self, job: Job) {
        self.inside.newest.store(job.generation, Ordering::SeqCst);
        self.inside.lock().job = Some(job);
        self.inside.changed.notify_all();
    }

    /// Schedules the thumbnails of a strip at low priority. They replace those of the previous strip.
    pub(super) fn vary(&self, variants: Vec<Variant>) {
        self.inside.lock().variants = variants.into();
        self.inside.changed.notify_all();
    }

    /// Schedules thumbnails at the lowest priority.
    pub(super) fn sample(&self, samples: Vec<Sample>) {
        self.inside.lock().samples = samples.into();
        self.inside.changed.notify_all();
    }

    /// Loads the images of a recipe.
    pub(super) fn images(&self, recipe: &Recipe) -> Result<Images, StudioError> {
        RenderHost::images(&*self.inside, recipe)
    }

    /// Queues a task, or refuses it if too many are waiting.
    pub(super) fn ask(&self, task: Task) {
        let mut queue = self.inside.lock();
        if queue.tasks.len() + queue.exports.len() >= MOST_TASKS {
            drop(queue);
            let error = StudioError::new("too much is asked for at once");
            self.inside.put(Reply::refused(task.what(), &error).into());
            return;
        }
        if task.what() == "export" {
            queue.exports.push_back(task);
        } else {
            queue.tasks.push_back(task);
        }
        drop(queue);
        self.inside.changed.notify_all();
    }

    /// Stops the running export and the waiting exports of the page.
    pub(super) fn stop_exports(&self) {
        let mut queue = self.inside.lock();
        self.inside.stop.store(true, Ordering::SeqCst);
        let waiting = std::mem::take(&mut queue.exports);
        drop(queue);
        for task in waiting {
            self.inside.refuse_stopped(&task);
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        let mut queue = self.inside.lock();
        self.inside.stop.store(true, Ordering::SeqCst);
        *queue = Queue {
            is_over: true,
            ..Queue::default()
        };
        drop(queue);
        self.inside.changed.notify_all();
    }
}

/// The next task of the rendering thread.
enum Next {
    Draw(Job),
    Do(Task),
    Vary(Variant),
    Sample(Sample),
}

impl Inside {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn run(&self) {
        let mut renderer = Renderer::new(&self.shared.cache);
        while let Some(next) = self.next() {
            let what = match &next {
                Next::Draw(_) => "view",
                Next::Do(task) => task.what(),
                Next::Vary(_) => "strip",
                Next::Sample(_) => "gallery",
            };
            let is_done = self.attempt(what, || match next {
                Next::Draw(job) => renderer.draw(&job, self),
                Next::Do(task) => self.perform(&task),
                Next::Vary(variant) => renderer.draw_variant(&variant, self),
                Next::Sample(sample) => self.show(&sample),
            });
            if !is_done {
                renderer = Renderer::new(&self.shared.cache);
            }
        }
    }

    fn run_exports(&self) {
        while let Some(task) = self.next_export() {
            let exporting = &self.shared.exporting;
            let one = exporting.lock().unwrap_or_else(PoisonError::into_inner);
            // The page may have been closed, or the export stopped, while other exports ran.
            if self.lock().is_over {
                return;
            }
            if self.stop.load(Ordering::SeqCst) {
                self.refuse_stopped(&task);
            } else {
                self.attempt(task.what(), || self.perform(&task));
            }
            drop(one);
        }
    }

    /// Reports that an export was stopped before it began.
    fn refuse_stopped(&self, task: &Task) {
        let error = StudioError::new("the export was stopped");
        self.put(Reply::refused(task.what(), &error).into());
    }

    /// Runs `work`. Returns false if it panicked; the panic is reported to the page, and the server continues.
    fn attempt(&self, what: &str, work: impl FnOnce()) -> bool {
        let is_done = catch_unwind(AssertUnwindSafe(work)).is_ok();
        if !is_done {
            let error = StudioError::new("this failed, which is a defect of dapple");
            self.put(Reply::refused(what, &error).into());
        }
        is_done
    }

    /// Waits for the next export. Returns `None` when the page is closed.
    fn next_export(&self) -> Option<Task> {
        let mut queue = self.lock();
        loop {
            if queue.is_over {
                return None;
            }
            if let Some(task) = queue.exports.pop_front() {
                self.stop.store(false, Ordering::SeqCst);
                return Some(task);
            }
            queue = self.wait(queue);
        }
    }

    fn wait<'a>(&self, queue: MutexGuard<'a, Queue>) -> MutexGuard<'a, Queue> {
        let woken = self.changed.wait(queue);
        woken.unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the next task. In order of priority: reports, the view, the strip, the gallery.
    fn next(&self) -> Option<Next> {
        let mut queue = self.lock();
        loop {
            if queue.is_over {
                return None;
            }
            if let Some(task) = queue.tasks.pop_front() {
                return Some(Next::Do(task));
            }
            if let Some(job) = queue.job.take() {
                return Some(Next::Draw(job));
            }
            if let Some(variant) = queue.variants.pop_front() {
                return Some(Next::Vary(variant));
            }
            if let Some(sample) = queue.samples.pop_front() {
                return Some(Next::Sample(sample));
            }
            queue = self.wait(queue);
        }
    }

    /// Renders and sends the thumbnail of a recipe. A recipe that cannot be baked is skipped.
    fn show(&self, sample: &Sample) {
        let Sample { shown, text, side } = sample;
        let images = |recipe: &Recipe| self.shared.images(recipe);
        let made = self.shared.gallery.of(*shown, text, *side, images);
        if let Ok(picture) = made {
            self.put(Output::Picture(picture));
        }
    }

    fn perform(&self, task: &Task) {
        let images = |recipe: &Recipe| self.images(recipe);
        let export = |recipe: &Recipe, export: &Export| {
            let shared = &self.shared;
            let folder = shared.of_images(recipe)?;
            let files = shared.host.export(recipe, folder, export, &self.stop)?;
            if let Some(folder) = &export.folder {
                shared.write(folder, &files, export.overwrite)?;
            }
            let (id, files) = shared.exports.keep(files);
            Ok(Reply::Exported { id, files })
        };
        self.put(task.answer(&images, &export).into());
    }
}

impl RenderHost for Inside {
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError> {
        if recipe.image_files().is_empty() {
            return Ok(Images::new());
        }
        self.shared.of_images(recipe)?;
        let stamps = self.shared.folder.image_stamps(recipe);
        let mut loaded = self.images.lock().unwrap_or_else(PoisonError::into_inner);
        if loaded.stamps != stamps {
            let images = self.shared.images(recipe)?;
            *loaded = Loaded { stamps, images };
        }
        Ok(loaded.images.clone())
    }

    fn preview(&self, lit: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError> {
        self.shared.host.preview(lit)
    }

    fn on_gpu(&self, recipe: &Recipe, plan: &Plan) -> Option<Plan> {
        self.shared.host.on_gpu(recipe, plan)
    }

    fn gpu_failed(&self, error: &RendererError) {
        self.shared.host.gpu_failed(error);
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64() * 1e3
    }

    fn is_wanted(&self, generation: u32) -> bool {
        self.newest.load(Ordering::SeqCst) == generation
    }

    fn put(&self, output: Output) {
        // A send error means that the page is closed; the thread ends soon.
        let _ = self.output.send(output);
    }
}
