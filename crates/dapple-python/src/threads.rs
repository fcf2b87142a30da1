//! The package's thread pool. A forked process creates a new pool.

use crate::error::{Error, Result};
use crate::watch;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, PoisonError};

/// State of the pool: the requested number of threads (0: one per core), the pool, and the id of the process that
/// created it.
struct Threads {
    wanted: Option<usize>,
    pool: Option<(u32, Arc<ThreadPool>)>,
}

/// The pool's state. It is locked only while the interpreter lock is held, and so is never locked during a fork.
static THREADS: Mutex<Threads> = Mutex::new(Threads {
    wanted: None,
    pool: None,
});

/// The environment variable that sets the number of threads.
const VARIABLE: &str = "DAPPLE_THREADS";

/// Maximum number of threads.
const MOST: usize = 1024;

/// Runs `work` on the package's threads without the interpreter lock, and returns its result. If a signal raises an
/// exception, the call returns and the work is abandoned ([`watch`]).
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T> {
    watch::run(py, None, |_, _| work())
}

/// Returns the pool of this process.
pub(crate) fn pool(_py: Python<'_>) -> Result<Arc<ThreadPool>> {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match threads.pool.take() {
        Some((maker, pool)) if maker == process => {
            threads.pool = Some((maker, Arc::clone(&pool)));
            return Ok(pool);
        }
        // Forget a pool of the parent process: its threads do not survive a fork, and dropping it would wait for them
        // forever.
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

/// Abandons a busy pool, so that the next call creates a new one. The threads of the old pool end when their work
/// does.
pub(crate) fn leave(busy: &Arc<ThreadPool>) {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let is_it = |(_, pool): &(u32, Arc<ThreadPool>)| Arc::ptr_eq(pool, busy);
    if threads.pool.as_ref().is_some_and(is_it) {
        threads.pool = None;
    }
}

/// Reads the number of threads from the environment variable; 0 if it is not set.
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

/// Returns the number of threads on which calls work.
///
/// Returns
/// -------
/// int
///     The number of threads.
#[pyfunction]
pub(crate) fn threads(py: Python<'_>) -> Result<usize> {
    Ok(pool(py)?.current_num_threads())
}

/// Sets the number of threads on which calls work; 0 means one per core. The number does not change the bits of any
/// result.
///
/// By default it is the value of the environment variable `DAPPLE_THREADS`, or one thread per core. Set it to 1 in
/// cluster workers that run one task per core.
///
/// Parameters
/// ----------
/// count : int
///     The number of threads, from 0 to 1024.
///
/// Raises
/// ------
/// DappleError
///     If `count` is not an integer from 0 to 1024.
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
    // Forget a pool of the parent process instead of dropping it.
    if let Some((maker, pool)) = threads.pool.take()
        && maker != std::process::id()
    {
        core::mem::forget(pool);
    }
    Ok(())
}
