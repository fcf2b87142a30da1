//! How a row on two threads is measured.
//!
//! Processor time cannot tell whether two threads ran at the same time, so the run on two threads is timed by the wall.
//! On a machine that others use, a wall time is nearly always too long and never too short; its least value over many
//! runs comes near the true one. The row divides the least *processor* time of a run on one thread by the least *wall*
//! time of a run on two. What other programs do to the wall can only make that ratio smaller, so that a row which
//! holds can be believed, and one that does not may want a quieter machine: runs go on, in turns, until the time of
//! the row is used up. A job takes at least [`LEAST_JOB_S`] on one thread, so that waking threads does not count. Both
//! results must have the same bits.
//!
//! The note of the row helps to judge one that does not hold. It has the processor time of both threads together, as
//! a part of that of one: 1.00 means that dividing the work costs nothing. It has the busier thread's part: what
//! would remain of the wall time where nobody disturbs and no thread waits for the other. And it has what two loops
//! reached, turn by turn beside the row, that share nothing and touch no memory: the machine, as it is, gives no more.

use super::{Bench, in_case};
use crate::report::three_digits;
use crate::row::Case;
use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The least time of a job on one thread in a row on two threads, in seconds.
pub(crate) const LEAST_JOB_S: f64 = 0.1;

/// The least number of turns of a row on two threads.
const LEAST_TURNS: u32 = 3;

impl Bench {
    /// Measures a job on one and on two threads for about `budget`, and keeps the row; `same` compares two results
    /// bit for bit.
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

    /// Runs a job on two threads: its seconds by the wall, and what it made.
    pub(crate) fn on_two<T: Send>(&self, job: impl FnOnce() -> T + Send) -> (f64, T) {
        let start = now();
        let made = black_box(self.two.install(job));
        (start.elapsed().as_secs_f64(), made)
    }

    /// One job on one thread, then another on two.
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

/// Times of a job on one and on two threads in seconds, each the least so far.
#[derive(Clone, Copy, Debug)]
struct Best {
    /// Processor time on one thread.
    one: f64,
    /// Wall time on two.
    wall: f64,
    /// Processor time of both of two threads.
    both: f64,
    /// Processor time of the one that worked longer.
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
    /// Takes what is less.
    fn keep(&mut self, turn: &Self) {
        self.one = self.one.min(turn.one);
        self.wall = self.wall.min(turn.wall);
        self.both = self.both.min(turn.both);
        self.busier = self.busier.min(turn.busier);
    }
}

/// Two pieces of work of some 50 ms each that share nothing and touch no memory: what two threads do best.
fn two_loops() {
    let work =
        || (0..black_box(12_000_000_u64)).fold(1, |sum, i| black_box(sum * 16_807 + i) % 1_000_003);
    black_box(rayon::join(work, work));
}

/// The wall clock.
#[expect(
    clippy::disallowed_methods,
    reason = "a benchmark reads the clock; no value depends on it"
)]
fn now() -> Instant {
    Instant::now()
}
