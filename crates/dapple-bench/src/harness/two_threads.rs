//! Measures a row on two threads.
//!
//! Processor time cannot tell whether two threads ran at the same time, so the run on two threads is timed by the wall
//! clock. On a shared machine a wall time is nearly always too long and never too short, so its minimum over many runs
//! approaches the true time. The row divides the minimum *processor* time of a run on one thread by the minimum *wall*
//! time of a run on two threads. Other programs can only make that ratio smaller. A row that holds can therefore be
//! trusted, and a row that fails may need a quieter machine. Runs continue, in turns, until the time of the row is
//! used up. A job takes at least [`LEAST_JOB_S`] on one thread, so that the time to wake threads is negligible. Both
//! results must have the same bits.
//!
//! The row's note has three numbers that help to judge a failure. The first is the processor time of both threads
//! together divided by the processor time on one thread: 1.00 means that dividing the work has no cost. The second is
//! the busier thread's share of the processor time, that is, the relative wall time without other programs and
//! without waiting. The third is the speedup of two loops that share nothing and touch no memory, measured in the
//! same turns as the row: the upper limit on this machine.

use super::{Bench, in_case};
use crate::report::three_digits;
use crate::row::Case;
use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Minimum time of a job on one thread, in seconds, for a row on two threads.
pub(crate) const LEAST_JOB_S: f64 = 0.1;

/// Minimum number of turns for a row on two threads.
const LEAST_TURNS: u32 = 3;

impl Bench {
    /// Measures a job on one and on two threads for about `budget`, and adds the row. `same` compares two results bit
    /// for bit.
    pub(crate) fn two_threads<S: Send>(
        &mut self,
        case: &Case,
        budget: Duration,
        mut states: [S; 2],
        job: impl Fn(&mut S) + Sync,
        same: impl Fn(&S, &S) -> bool,
    ) -> Result<()> {
        if !self.wants(case) {
            return Ok(());
        }
        let (mut best, mut ceiling) = (Best::default(), Best::default());
        let begin = now();
        let mut turns = 0;
        while turns < LEAST_TURNS || begin.elapsed() < budget {
            let [one, two] = &mut states;
            best.keep(&self.turn_of_two(|| job(one), || job(two)));
            ceiling.keep(&self.turn_of_two(two_loops, two_loops));
            turns += 1;
        }
        let one = best.one;
        ensure!(
            one >= LEAST_JOB_S,
            "{}: a job of {one} s is too short to divide",
            in_case(case)
        );
        ensure!(
            same(&states[0], &states[1]),
            "{}: two threads made other bits than one",
            in_case(case)
        );
        let mut row = case.row(best.wall, one);
        row.note = format!(
            "best of {turns} turns; both threads took {} of the processor time of one, the busier {}; two loops that \
             share nothing reached {} on this machine",
            three_digits(best.both / one),
            three_digits(best.busier / one),
            three_digits(ceiling.one / ceiling.wall),
        );
        self.keep(row);
        Ok(())
    }

    /// Runs a job on two threads. Returns its wall time in seconds and its result.
    pub(crate) fn on_two<T: Send>(&self, job: impl FnOnce() -> T + Send) -> (f64, T) {
        let start = now();
        let made = black_box(self.two.install(job));
        (start.elapsed().as_secs_f64(), made)
    }

    /// Runs one job on one thread, then another on two threads, and returns their times.
    fn turn_of_two(&self, on_one: impl FnOnce() + Send, on_two: impl FnOnce() + Send) -> Best {
        let one = self.one.install(|| {
            let start = ThreadTime::now();
            on_one();
            start.elapsed().as_secs_f64()
        });
        let used = || {
            self.two
                .broadcast(|_| ThreadTime::now().as_duration().as_secs_f64())
        };
        let (before, start) = (used(), now());
        self.two.install(on_two);
        let wall = start.elapsed().as_secs_f64();
        let threads: Vec<f64> = used()
            .iter()
            .zip(&before)
            .map(|(after, before)| after - before)
            .collect();
        Best {
            one,
            wall,
            both: threads.iter().sum(),
            busier: threads.iter().copied().fold(0.0, f64::max),
        }
    }
}

/// Minimum times so far of a job on one and on two threads, in seconds.
#[derive(Clone, Copy, Debug)]
struct Best {
    /// Processor time of the job on one thread.
    one: f64,
    /// Wall time of the job on two threads.
    wall: f64,
    /// Total processor time of the two threads.
    both: f64,
    /// Processor time of the busier thread.
    busier: f64,
}

impl Default for Best {
    fn default() -> Self {
        let never = f64::INFINITY;
        Self {
            one: never,
            wall: never,
            both: never,
            busier: never,
        }
    }
}

impl Best {
    /// Takes the smaller value of each time.
    fn keep(&mut self, turn: &Self) {
        self.one = self.one.min(turn.one);
        self.wall = self.wall.min(turn.wall);
        self.both = self.both.min(turn.both);
        self.busier = self.busier.min(turn.busier);
    }
}

/// Runs two loops of about 50 ms each that share nothing and touch no memory: the best case for two threads.
fn two_loops() {
    let work =
        || (0..black_box(12_000_000_u64)).fold(1, |sum, i| black_box(sum * 16_807 + i) % 1_000_003);
    black_box(rayon::join(work, work));
}

/// Reads the wall clock.
#[expect(
    clippy::disallowed_methods,
    reason = "a benchmark reads the clock; no value depends on it"
)]
fn now() -> Instant {
    Instant::now()
}
