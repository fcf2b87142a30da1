//! Calls that stop at Ctrl-C and show their progress.
//!
//! The work is done on the threads of the package. The calling thread waits for it, and periodically takes the
//! interpreter to run the handlers of signals, which only the main thread may do, and the callback for the progress.
//!
//! A thread cannot be stopped from outside. Work that owns its data ([`run`]) is left behind when a handler raises an
//! exception: the call ends at once, and the work ends when it looks at [`Stop`] next, or else when it is done; the next
//! call has new threads. Work that writes into memory of the caller ([`within`]) is waited for, and comes in parts of
//! some milliseconds ([`in_parts`]).

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

/// The time between checks for signals.
const PERIOD: Duration = Duration::from_millis(25);

/// The time for a part of work: far below a period, and far above the time to begin one.
const PART: Duration = Duration::from_millis(10);

/// A callback for the progress of a synthesis, which can stop it.
pub(crate) type Heard<'a> = &'a mut (dyn FnMut(Progress) -> ControlFlow<()> + Send);

/// Whether the result of some work is no longer wanted.
#[derive(Clone, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

thread_local! {
    /// The request to stop the work that this thread does, for objects that are made deep inside of it from their
    /// descriptions.
    static CURRENT: RefCell<Stop> = RefCell::default();
}

/// Does work whose request to stop is the one of the thread meanwhile.
fn with_current<T>(stop: &Stop, work: impl FnOnce() -> T) -> T {
    /// Restores the request of other work, which this thread goes on with after this one.
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
    /// The request to stop the work that this thread does.
    pub(crate) fn current() -> Self {
        CURRENT.with_borrow(Self::clone)
    }

    /// The request in the form that options of textures hold.
    pub(crate) fn cancel(&self) -> Cancel {
        let stop = self.clone();
        Cancel::by(move || stop.is_set())
    }

    /// What a callback for progress returns.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        match self.is_set() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Whether the work should end.
    pub(crate) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Ends the work with an error, which nobody sees, if its result is no longer wanted.
    pub(crate) fn check(&self) -> Result<()> {
        match self.is_set() {
            true => Err(Error::new("interrupted", "the call was interrupted")),
            false => Ok(()),
        }
    }
}

/// A message of work to the thread that waits for it.
enum Message<T> {
    /// The part of the work done, from 0 to 1.
    Part(f64),
    /// The result, or the panic that ended the work.
    Done(std::thread::Result<T>),
}

/// Runs `work` on the threads of the package and without the interpreter, and returns its result, unless a signal or
/// `progress` raises an exception. `progress` is called with the part of the work done, from 0 to 1.
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
            // After an exception nobody receives the progress.
            let _ = sender.send(Message::Part(steps.part()));
            ended.flow()
        };
        // A panic in a spawned task would end the process.
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

/// Runs work that borrows on the threads of the package and without the interpreter. After an exception it is waited
/// for, so `work` must look at [`Stop`] often.
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
                // The end of the channel is the end of the work.
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

/// Does the work of a number of items in parts that take some milliseconds, until its result is no longer wanted.
/// `first` is the number of items of the first part.
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
        // The next part takes about the wanted time if its items are like those of this one.
        let ratio = PART.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-9);
        size = ((size as f64 * ratio.clamp(0.05, 4.0)) as usize).max(1);
        begin = end;
    }
    Ok(())
}

/// Waits until the work is done, or an exception is raised.
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
