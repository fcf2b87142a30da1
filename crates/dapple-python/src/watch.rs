//! Runs calls that can be interrupted with Ctrl-C and report their progress.
//!
//! The work runs on the package's threads. The calling thread waits for it. Periodically, it takes the interpreter
//! lock to run the signal handlers, which only the main thread may do, and the progress callback.
//!
//! A thread cannot be stopped from outside. Work that owns its data ([`run`]) is abandoned when a handler raises an
//! exception: the call returns at once, the work ends when it next checks [`Stop`] or when it is done, and the next
//! call gets new threads. Work that writes to the caller's memory ([`within`]) is always waited for. It is divided into
//! slices of a few milliseconds ([`in_parts`]).

use crate::error::{Error, Result};
use crate::threads;
use core::cell::RefCell;
use core::ops::{ControlFlow, Range};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use dapple::points::Cancel;
use dapple::synth::Progress;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Instant;

/// Time between checks for signals.
const PERIOD: Duration = Duration::from_millis(25);

/// Target duration of a slice of the work: far shorter than [`PERIOD`], and far longer than the overhead of a slice.
const PART: Duration = Duration::from_millis(10);

/// A progress callback of a synthesis, which can stop it.
pub(crate) type Heard<'a> = &'a mut (dyn FnMut(Progress) -> ControlFlow<()> + Send);

/// A flag that requests that work stops. Clones share it.
#[derive(Clone, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

thread_local! {
    /// The current stop flag of this thread, for objects that are built from their descriptions deep within the work.
    static CURRENT: RefCell<Stop> = RefCell::default();
}

/// Runs work with `stop` as the current stop flag of the thread.
fn with_current<T>(stop: &Stop, work: impl FnOnce() -> T) -> T {
    /// Restores the previous stop flag of the thread on drop.
    struct Restore(Stop);
    impl Drop for Restore {
        fn drop(&mut self) {
            CURRENT.replace(self.0.clone());
        }
    }
    let _restore = Restore(CURRENT.replace(stop.clone()));
    work()
}

impl Stop {
    /// Returns the current stop flag of this thread.
    pub(crate) fn current() -> Self {
        CURRENT.with_borrow(Self::clone)
    }

    /// Converts the flag to the type that texture options use.
    pub(crate) fn cancel(&self) -> Cancel {
        let stop = self.clone();
        Cancel::by(move || stop.is_set())
    }

    /// Converts the flag to the return value of a progress callback.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        match self.is_set() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Returns whether the work should end.
    pub(crate) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Returns an error if a stop was requested. The error ends the work and is never shown, since the Python call has
    /// already returned.
    pub(crate) fn check(&self) -> Result<()> {
        match self.is_set() {
            true => Err(Error::new("interrupted", "the call was interrupted")),
            false => Ok(()),
        }
    }
}

/// A message from the work to the thread that waits for it.
enum Message<T> {
    /// The completed fraction of the work, from 0 to 1.
    Part(f64),
    /// The result, or the panic that ended the work.
    Done(std::thread::Result<T>),
}

/// Runs `work` on the package's threads without the interpreter lock, and returns its result, unless a signal or
/// `progress` raises an exception. `progress` is called with the completed fraction of the work, from 0 to 1.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Heard<'_>, &Stop) -> T + Send + 'static,
) -> Result<T> {
    let pool = threads::pool(py)?;
    let progress = progress.map(|progress| progress.clone().unbind());
    let stop = Stop::default();
    let (sender, receiver) = channel();
    let ended = stop.clone();
    pool.spawn(move || {
        let mut tell = |steps: Progress| {
            // Ignore errors: after an exception, nothing receives the progress.
            let _ = sender.send(Message::Part(steps.part()));
            ended.flow()
        };
        // Catch panics, since a panic in a spawned task would abort the process.
        let made = catch_unwind(AssertUnwindSafe(|| {
            with_current(&ended, || work(&mut tell, &ended))
        }));
        let _ = sender.send(Message::Done(made));
    });
    match py.detach(move || listen(&receiver, progress.as_ref())) {
        Ok(Some(Ok(made))) => Ok(made),
        Ok(Some(Err(panic))) => resume_unwind(panic),
        Ok(None) => Err(Error::new("threads", "the work was not done")),
        Err(error) => {
            stop.0.store(true, Ordering::Relaxed);
            threads::leave(&pool);
            Err(error.into())
        }
    }
}

/// Runs work that borrows data on the package's threads, without the interpreter lock. The call waits for it even
/// after an exception, so `work` must check [`Stop`] often.
pub(crate) fn within<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Stop) -> Result<T> + Send,
) -> Result<T> {
    let pool = threads::pool(py)?;
    let stop = Stop::default();
    let mut made = None;
    let heard = py.detach(|| {
        let (made, stop) = (&mut made, &stop);
        let (sender, receiver) = channel::<Message<()>>();
        pool.in_place_scope(|scope| {
            scope.spawn(move |_| {
                *made = Some(work(stop));
                // Close the channel, which signals the end of the work.
                drop(sender);
            });
            let heard = listen(&receiver, None);
            stop.0.store(heard.is_err(), Ordering::Relaxed);
            heard.map(drop)
        })
    });
    heard?;
    made.unwrap_or_else(|| Err(Error::new("threads", "the work was not done")))
}

/// Processes `count` items in slices that take a few milliseconds each. Stops if requested. `first` is the number of
/// items in the first slice.
#[expect(
    clippy::disallowed_methods,
    reason = "the clock decides how many items come at once, and no value depends on it"
)]
pub(crate) fn in_parts(
    stop: &Stop,
    count: usize,
    first: usize,
    mut work: impl FnMut(Range<usize>) -> Result<()>,
) -> Result<()> {
    let (mut begin, mut size) = (0, first.max(1));
    while begin < count {
        stop.check()?;
        let end = begin.saturating_add(size).min(count);
        let start = Instant::now();
        work(begin..end)?;
        // Choose the size of the next part from the time per item of this part.
        let ratio = PART.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-9);
        size = ((size as f64 * ratio.clamp(0.05, 4.0)) as usize).max(1);
        begin = end;
    }
    Ok(())
}

/// Waits until the work is done or an exception is raised. Returns `None` if the channel is closed without a result.
#[expect(
    clippy::disallowed_methods,
    reason = "the clock says when to look for signals, and no value depends on it"
)]
fn listen<T>(
    messages: &Receiver<Message<T>>,
    progress: Option<&Py<PyAny>>,
) -> PyResult<Option<std::thread::Result<T>>> {
    let mut looked = Instant::now();
    let mut part = None;
    loop {
        match messages.recv_timeout(PERIOD.saturating_sub(looked.elapsed())) {
            Ok(Message::Done(made)) => return Ok(Some(made)),
            Ok(Message::Part(done)) => part = Some(done),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
        }
        if looked.elapsed() < PERIOD {
            continue;
        }
        Python::attach(|py| {
            py.check_signals()?;
            match (progress, part.take()) {
                (Some(progress), Some(part)) => progress.call1(py, (part,)).map(drop),
                _ => Ok(()),
            }
        })?;
        looked = Instant::now();
    }
}
