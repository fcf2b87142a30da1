//! Workspace-wide tests, compiled into one binary.

mod chain;
mod docs;
mod examples;
mod figures;
mod golden;
mod how_to_add;
mod periods;
mod readme;
mod recipe_code;
mod recipes;
mod seams;
mod surfaces;
mod tiles;

/// Runs `work` in a pool of `n` threads and returns its result.
fn with_threads<T: Send>(n: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
    pool.expect("a thread pool").install(work)
}
