//! The harness that measures one row.
//!
//! **One thread.** Both sides run inside a thread pool of one thread, in turns (ours, theirs, ours, theirs …). The
//! clock is the processor time of that thread, because other programs on the machine reduce wall time but not
//! processor time. Other programs also share cache, memory bandwidth and clock speed, but the turns are short, so both
//! sides are affected equally. A side's time is the median of its runs. The setup of a run (copying the input,
//! freeing the last output) is not timed. Our side first does one untimed warm-up run, so that memory is mapped.
//!
//! **Two threads** are measured differently, see `two_threads`.
//!
//! **No side wins by skipping work.** Results pass through [`black_box`]. Every row ends with a check of both sides'
//! output, which also counts it (pixels, points), so that times are per unit of verified work.

mod two_threads;

#[cfg(test)]
mod tests;

use crate::report::{Page, three_digits};
use crate::row::{Case, Row};
use anyhow::{Context, Result, ensure};
use cpu_time::ThreadTime;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;

/// The benchmark: runs the cases that the filters select and collects their rows.
#[derive(Debug)]
pub(crate) struct Bench {
    filters: Vec<String>,
    /// Earlier results. Cases that have a row there are not measured.
    known: Page,
    one: ThreadPool,
    two: ThreadPool,
    rows: Vec<Row>,
}

/// One side of a row: its state, a setup function for each run, and the measured function.
pub(crate) struct Side<'a, S> {
    state: S,
    runs_per_turn: u32,
    prepare: Box<dyn FnMut(&mut S) + Send + 'a>,
    work: Box<dyn FnMut(&mut S) + Send + 'a>,
}

impl<'a, S: Send> Side<'a, S> {
    /// Creates a side whose runs call `work` on `state`, which holds the input and the output.
    pub(crate) fn new(state: S, work: impl FnMut(&mut S) + Send + 'a) -> Self {
        Self {
            state,
            runs_per_turn: 1,
            prepare: Box::new(|_| ()),
            work: Box::new(work),
        }
    }

    /// Adds a setup function that is called before every run and is not timed.
    pub(crate) fn prepared(mut self, prepare: impl FnMut(&mut S) + Send + 'a) -> Self {
        self.prepare = Box::new(prepare);
        self
    }

    /// Sets the number of runs per turn, each timed separately. Use it if this side's job is much shorter than the
    /// other side's.
    pub(crate) fn times(mut self, runs_per_turn: u32) -> Self {
        self.runs_per_turn = runs_per_turn;
        self
    }

    /// Runs one turn and appends the processor time of each run in seconds.
    fn turn(&mut self, seconds: &mut Vec<f64>) {
        for _ in 0..self.runs_per_turn {
            (self.prepare)(&mut self.state);
            let start = ThreadTime::now();
            (self.work)(&mut self.state);
            black_box(&mut self.state);
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
}

/// Amount of work that each side did in one run, counted from its output in the row's unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Done {
    /// Number of pixels, points or positions processed by our side.
    pub(crate) ours: usize,
    /// Number of pixels, points or positions processed by the other side.
    pub(crate) theirs: usize,
}

impl Done {
    /// Returns the amount of work for two sides that both process `n` units.
    pub(crate) const fn both(n: usize) -> Self {
        Self { ours: n, theirs: n }
    }
}

impl Bench {
    /// Creates a benchmark that measures the cases selected by `filters`, except for those that have a row in `known`.
    pub(crate) fn new(filters: Vec<String>, known: Page) -> Result<Self> {
        let pool = |n_threads| ThreadPoolBuilder::new().num_threads(n_threads).build();
        Ok(Self {
            filters,
            known,
            one: pool(1).context("starting one thread")?,
            two: pool(2).context("starting two threads")?,
            rows: Vec::new(),
        })
    }

    /// Returns whether `case` must be measured: the filters select it, and it has no row in the earlier results.
    pub(crate) fn wants(&self, case: &Case) -> bool {
        case.is_wanted(&self.filters) && !self.known.has(case)
    }

    /// Returns whether any of `cases` must be measured, so that preparing their common inputs is worthwhile.
    pub(crate) fn wants_any(&self, cases: &[Case]) -> bool {
        cases.iter().any(|case| self.wants(case))
    }

    /// Returns the measured rows, in order.
    pub(crate) fn into_rows(self) -> Vec<Row> {
        self.rows
    }

    /// Measures both sides on one thread in `turns` turns, and adds the row. Does nothing if the case is not selected.
    ///
    /// `confirm` checks the output of the last run of both sides, and counts the work.
    pub(crate) fn beside<A: Send, B: Send>(
        &mut self,
        case: &Case,
        turns: u32,
        mut ours: Side<'_, A>,
        mut theirs: Side<'_, B>,
        confirm: impl FnOnce(&A, &B) -> Result<Done>,
    ) -> Result<()> {
        if !self.wants(case) {
            return Ok(());
        }
        let (mut our_times, mut their_times) = (Vec::new(), Vec::new());
        self.one.install(|| {
            (ours.prepare)(&mut ours.state);
            (ours.work)(&mut ours.state);
            for _ in 0..turns {
                ours.turn(&mut our_times);
                theirs.turn(&mut their_times);
            }
        });
        let done = confirm(&ours.state, &theirs.state).with_context(|| in_case(case))?;
        ensure!(
            done.ours > 0 && done.theirs > 0,
            "{}: a side did nothing",
            in_case(case)
        );
        let each = |times: &mut [f64], n: usize| median(times) / n as f64;
        self.keep(case.row(
            each(&mut our_times, done.ours),
            each(&mut their_times, done.theirs),
        ));
        Ok(())
    }

    /// Runs a job on one thread. Returns its processor time in seconds and its result.
    pub(crate) fn on_one<T: Send>(&self, job: impl FnOnce() -> T + Send) -> (f64, T) {
        self.one.install(|| {
            let start = ThreadTime::now();
            let made = black_box(job());
            (start.elapsed().as_secs_f64(), made)
        })
    }

    /// Adds a row for a case that was measured elsewhere. `ours` and `theirs` are seconds per unit of work.
    pub(crate) fn measured(&mut self, case: &Case, ours: f64, theirs: f64) {
        self.keep(case.row(ours, theirs));
    }

    /// Adds a row like [`measured`](Self::measured), with a note that was computed at run time.
    pub(crate) fn measured_with(&mut self, case: &Case, ours: f64, theirs: f64, note: String) {
        let mut row = case.row(ours, theirs);
        row.note = note;
        self.keep(row);
    }

    /// Adds a row, and prints it to standard error.
    fn keep(&mut self, row: Row) {
        let verdict = if row.holds { "" } else { "  BELOW ITS BAR" };
        eprintln!(
            "{}: {}, {}: {} beside {} {}, ratio {}{verdict}",
            row.group,
            row.case,
            row.peer,
            three_digits(row.ours),
            three_digits(row.theirs),
            row.unit,
            three_digits(row.ratio)
        );
        self.rows.push(row);
    }
}

/// Returns the case's name for error messages.
fn in_case(case: &Case) -> String {
    format!("{}: {}, {}", case.group, case.case, case.peer)
}

/// Returns the median: the middle value, or the mean of the two middle values; NaN for no values. Sorts the values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[middle],
        _ => (values[middle - 1] + values[middle]) / 2.0,
    }
}
