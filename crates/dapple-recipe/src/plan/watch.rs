//! Reports progress to the caller's callback, which can stop the work.

use crate::{RecipeError, RecipeErrorKind};
use core::fmt;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use dapple_points::Cancel;
use dapple_synth::Progress;
use std::sync::Arc;

/// An optional progress callback, together with the reported progress. Clones share both.
#[derive(Clone, Default)]
pub(crate) struct Watch(Option<Arc<Heard>>);

type Callback = dyn Fn(Progress) -> ControlFlow<()> + Send + Sync;

/// A progress callback and the progress of one task, such as a bake.
struct Heard {
    callback: Arc<Callback>,
    pass: AtomicUsize,
    done: AtomicUsize,
    n_sites: AtomicUsize,
    /// Whether the callback has asked to stop; it is not called again after that.
    is_over: AtomicBool,
}

/// The passes of a task, in order.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pass {
    /// Builds the nodes.
    Nodes,
    /// Evaluates the nodes that depend on the whole tile.
    Whole,
    /// Computes the rows of maps; each row counts as one site.
    Rows,
}

/// Number of passes.
const N_PASSES: usize = 3;

/// Number of sites that each node counts as in progress reports.
pub(crate) const OF_NODE: usize = 1000;

impl Watch {
    /// Creates a watch that reports to `callback`.
    pub(super) fn by(
        callback: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static,
    ) -> Self {
        Self::of(Arc::new(callback))
    }

    fn of(callback: Arc<Callback>) -> Self {
        let [pass, done, n_sites] = [0, 0, 0].map(AtomicUsize::new);
        let is_over = AtomicBool::new(false);
        Self(Some(Arc::new(Heard {
            callback,
            pass,
            done,
            n_sites,
            is_over,
        })))
    }

    /// Creates a watch with the same callback and separate progress, for another task that may run at the same time.
    pub(crate) fn again(&self) -> Self {
        let heard = self.0.as_ref();
        heard.map_or_else(Self::default, |heard| Self::of(heard.callback.clone()))
    }

    /// Begins a pass over `n_sites` sites.
    pub(crate) fn begin(&self, pass: Pass, n_sites: usize) {
        if let Some(heard) = &self.0 {
            heard.pass.store(pass as usize, Relaxed);
            heard.n_sites.store(n_sites, Relaxed);
            heard.done.store(0, Relaxed);
        }
    }

    /// Sets the number of completed sites.
    pub(crate) fn reach(&self, done: usize) {
        if let Some(heard) = &self.0 {
            heard.done.store(done, Relaxed);
        }
    }

    /// Returns the number of completed sites.
    pub(crate) fn done(&self) -> usize {
        self.0.as_ref().map_or(0, |heard| heard.done.load(Relaxed))
    }

    /// Calls the callback. Returns whether it asks to stop now, or did so before.
    pub(crate) fn is_cancelled(&self) -> bool {
        let Some(heard) = &self.0 else {
            return false;
        };
        if heard.is_over.load(Relaxed) {
            return true;
        }
        let progress = Progress {
            pass: heard.pass.load(Relaxed),
            n_passes: N_PASSES,
            done: heard.done.load(Relaxed),
            n_sites: heard.n_sites.load(Relaxed),
        };
        let is_cancelled = (heard.callback)(progress).is_break();
        if is_cancelled {
            heard.is_over.store(true, Relaxed);
        }
        is_cancelled
    }

    /// Calls the callback. Fails if it asks to stop now, or did so before.
    pub(crate) fn check(&self) -> Result<(), RecipeError> {
        match self.is_cancelled() {
            true => Err(cancelled()),
            false => Ok(()),
        }
    }

    /// Converts the callback to the form that texture options take.
    pub(crate) fn cancel(&self) -> Cancel {
        match &self.0 {
            None => Cancel::default(),
            Some(_) => {
                let watch = self.clone();
                Cancel::by(move || watch.is_cancelled())
            }
        }
    }

    /// Returns [`Cancelled`](RecipeErrorKind::Cancelled) if the callback asked to stop; otherwise `error`.
    pub(crate) fn reason(&self, error: RecipeError) -> RecipeError {
        let is_over = |heard: &Arc<Heard>| heard.is_over.load(Relaxed);
        match self.0.as_ref().is_some_and(is_over) {
            true => cancelled(),
            false => error,
        }
    }
}

fn cancelled() -> RecipeError {
    RecipeError::new(RecipeErrorKind::Cancelled)
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Watch").field(&self.0.is_some()).finish()
    }
}
