//! Long calls that show their progress and stop at Ctrl-C.
//!
//! The work is done on the threads of the package. The calling thread waits for it, and periodically takes the
//! interpreter to run the handlers of signals, which only the main thread may do, and the callback for the progress.

use crate::error::{Error, Result};
use crate::threads;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use dapple::synth::Progress;
use pyo3::prelude::*;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Instant;

/// The time between checks for signals.
const PERIOD: Duration = Duration::from_millis(50);

/// A callback for the progress of a synthesis, which can stop it.
pub(crate) type Heard<'a> = &'a mut dyn FnMut(Progress) -> ControlFlow<()>;

/// Runs `work` on the threads of the package and without the interpreter, and returns its result, unless a signal or
/// `progress` raises an exception. `progress` is called with the part of the work done, from 0 to 1.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Heard<'_>) -> T + Send,
) -> Result<T> {
    let pool = threads::pool(py)?;
    let progress = progress.map(|progress| progress.clone().unbind());
    let stop = AtomicBool::new(false);
    let (mut made, mut heard) = (None, Ok(()));
    py.detach(|| {
        let (made, stop) = (&mut made, &stop);
        let (sender, receiver) = channel();
        pool.in_place_scope(|scope| {
            scope.spawn(move |_| {
                let mut tell = |steps: Progress| {
                    // After the first exception nobody receives the progress.
                    let _ = sender.send(part(steps));
                    match stop.load(Ordering::Relaxed) {
                        true => ControlFlow::Break(()),
                        false => ControlFlow::Continue(()),
                    }
                };
                *made = Some(work(&mut tell));
            });
            heard = listen(&receiver, progress.as_ref());
            stop.store(heard.is_err(), Ordering::Relaxed);
        });
    });
    heard?;
    made.ok_or_else(|| Error::new("threads", "the work was not done"))
}

/// The part of a synthesis that is done; all passes count the same.
fn part(steps: Progress) -> f64 {
    let part = steps.done as f64 / steps.n_sites.max(1) as f64;
    (steps.pass as f64 + part) / steps.n_passes.max(1) as f64
}

/// Waits until the work is done, or an exception is raised.
#[expect(
    clippy::disallowed_methods,
    reason = "the clock says when to look for signals, and no value depends on it"
)]
fn listen(parts: &Receiver<f64>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    let mut looked = Instant::now();
    let mut part = None;
    loop {
        match parts.recv_timeout(PERIOD.saturating_sub(looked.elapsed())) {
            Ok(done) => part = Some(done),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
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
