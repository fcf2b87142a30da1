//! The threads of the package: a pool of its own, which a forked process makes anew.

use crate::error::{Error, Result};
use crate::watch;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, PoisonError};

/// The pool, the process that made it, and the requested number of threads (0: one for each core).
struct Threads {
    wanted: Option<usize>,
    pool: Option<(u32, Arc<ThreadPool>)>,
}

/// It is locked with the interpreter held, and unlocked before the interpreter is released, so that it is never locked
/// in a fork.
static THREADS: Mutex<Threads> = Mutex::new(Threads {
    wanted: None,
    pool: None,
});

/// The environment variable with the number of threads.
const VARIABLE: &str = "DAPPLE_THREADS";

/// The largest number of threads.
const MOST: usize = 1024;

/// Runs `work` on the threads of the package and without the interpreter, and returns its result, unless a signal
/// raises an exception; then the work is left behind ([`watch`]).
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T> {
    watch::run(py, None, |_, _| work())
}

/// The pool of this process.
pub(crate) fn pool(_py: Python<'_>) -> Result<Arc<ThreadPool>> {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match threads.pool.take() {
        Some((maker, pool)) if maker == process => {
            threads.pool = Some((maker, Arc::clone(&pool)));
            return Ok(pool);
        }
        // The threads of a pool do not survive a fork, and waiting for them would never end.
        Some((_, pool)) => core::mem::forget(pool),
        None => {}
    }
    let wanted = match threads.wanted {
        Some(wanted) => wanted,
        None => from_environment()?,
    };
    let builder = ThreadPoolBuilder::new().num_threads(wanted);
    let builder = builder.thread_name(|index| format!("dapple-{index}"));
    let pool = builder
        .build()
        .map_err(|error| Error::new("threads", error.to_string()))?;
    let pool = Arc::new(pool);
    threads.pool = Some((process, Arc::clone(&pool)));
    Ok(pool)
}

/// Leaves a pool to the work on it, so that the next call has a new one. The threads end with their work.
pub(crate) fn leave(busy: &Arc<ThreadPool>) {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let is_it = |(_, pool): &(u32, Arc<ThreadPool>)| Arc::ptr_eq(pool, busy);
    if threads.pool.as_ref().is_some_and(is_it) {
        threads.pool = None;
    }
}

/// The number of threads in the environment; 0 if it is not set.
fn from_environment() -> Result<usize> {
    let Ok(text) = std::env::var(VARIABLE) else {
        return Ok(0);
    };
    let number = text.trim().parse().ok();
    number.filter(|&number| number <= MOST).ok_or_else(|| {
        let message = format!("{VARIABLE} is `{text}`, but it must be a number from 0 to {MOST}");
        Error::new("threads", message)
    })
}

/// The number of threads on which calls work.
///
/// Returns
/// -------
/// int
///     The number.
#[pyfunction]
pub(crate) fn threads(py: Python<'_>) -> Result<usize> {
    Ok(pool(py)?.current_num_threads())
}

/// Sets the number of threads on which calls work: 0 is one for each core. The results have the same bits.
///
/// By default it is the number in the environment variable `DAPPLE_THREADS`, or one for each core. Workers of a cluster
/// that run one task on each core set it to 1.
///
/// Parameters
/// ----------
/// count : int
///     The number of them.
///
/// Raises
/// ------
/// DappleError
///     If `count` is not a whole number from 0 to 1024.
#[pyfunction]
pub(crate) fn set_threads(count: &Bound<'_, PyAny>) -> Result<()> {
    let number = count.extract().ok().filter(|&number| number <= MOST);
    let count = number.ok_or_else(|| {
        let message = format!(
            "the number of threads is {count:?}, but it must be a whole number from 0 to {MOST}"
        );
        Error::new("threads", message)
    })?;
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    threads.wanted = Some(count);
    // A forked process leaves the pool of its parent alone.
    if let Some((maker, pool)) = threads.pool.take()
        && maker != std::process::id()
    {
        core::mem::forget(pool);
    }
    Ok(())
}
