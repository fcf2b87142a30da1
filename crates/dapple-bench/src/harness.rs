//! How a row is measured.
//!
//! **One thread.** Both sides run inside a thread pool of one thread, in turns (ours, theirs, ours, theirs …), and the
//! clock is the processor time of that thread: other programs on the machine take wall time away, not processor time.
//! What they do take (cache, memory bandwidth, clock speed) they take from both sides alike, since the turns are
//! short. The time of a side is the median of its runs. What prepares a run (a copy of the input, freeing the last
//! output) is outside the clock. One run of our side goes first, without the clock, so that memory is mapped.
//!
//! **Two threads.** Processor time cannot tell whether two threads ran at the same time, so the run on two threads is
//! timed by the wall. On a machine that others use, a wall time is never too short and nearly always too long; its
//! least value over many runs comes near the true one. The row divides the least *processor* time of a run on one
//! thread by the least *wall* time of a run on two, turn by turn. Noise can make that ratio smaller but not larger, so
//! that a row which holds is proven, and one that does not hold may want a quieter machine: runs go on until the
//! time of the row is used up. A job takes at least [`LEAST_JOB_S`] on one thread, so that waking threads does not
//! count. Both results must have the same bits. The note of the row helps to judge one that does not hold:
//! the processor time that both threads took in all, as a part of that of one: 1.00 means that dividing the work costs
//! nothing; and the busier thread's: what remains of the wall time where nobody disturbs. And what two loops reached,
//! turn by turn beside the row, that share nothing and touch no memory: nothing is faster on the machine as it is now.
//!
//! **Nothing wins by doing nothing.** Results pass through [`black_box`], and every row ends with a check of what both
//! sides made, which also counts it (pixels, points), so that times are for work that was seen.

use crate::report::three_digits;
use crate::row::{Case, Row};
use anyhow::{Context, Result, ensure};
use cpu_time::ThreadTime;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The least time of a job on one thread in a row on two threads, in seconds.
pub(crate) const LEAST_JOB_S: f64 = 0.1;

/// The least number of turns of a row on two threads.
const LEAST_TURNS: u32 = 3;

/// What runs cases and keeps their rows.
#[derive(Debug)]
pub(crate) struct Bench {
    filters: Vec<String>,
    one: ThreadPool,
    two: ThreadPool,
    rows: Vec<Row>,
}

/// One side of a row: its memory, what prepares a run, and the run.
pub(crate) struct Side<'a, S> {
    state: S,
    runs_per_turn: u32,
    prepare: Box<dyn FnMut(&mut S) + Send + 'a>,
    work: Box<dyn FnMut(&mut S) + Send + 'a>,
}

impl<'a, S: Send> Side<'a, S> {
    /// A side that works on `state`, where it finds its input and leaves its output.
    pub(crate) fn new(state: S, work: impl FnMut(&mut S) + Send + 'a) -> Self {
        Self {
            state,
            runs_per_turn: 1,
            prepare: Box::new(|_| ()),
            work: Box::new(work),
        }
    }

    /// Runs `prepare` before every run, outside the clock.
    pub(crate) fn prepared(mut self, prepare: impl FnMut(&mut S) + Send + 'a) -> Self {
        self.prepare = Box::new(prepare);
        self
    }

    /// Runs this often in every turn, each timed on its own: for a job that is short beside the other side's.
    pub(crate) fn times(mut self, runs_per_turn: u32) -> Self {
        self.runs_per_turn = runs_per_turn;
        self
    }

    /// The runs of one turn: seconds of processor time of this thread, each.
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

/// How much each side did in one run, counted from its output, in what the row's unit is for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Done {
    /// Our side's pixels, points or positions.
    pub(crate) ours: usize,
    /// The other side's.
    pub(crate) theirs: usize,
}

impl Done {
    /// The same number on both sides.
    pub(crate) const fn both(n: usize) -> Self {
        Self { ours: n, theirs: n }
    }
}

impl Bench {
    /// A bench that measures the cases which the filters select.
    pub(crate) fn new(filters: Vec<String>) -> Result<Self> {
        let pool = |n_threads| ThreadPoolBuilder::new().num_threads(n_threads).build();
        Ok(Self {
            filters,
            one: pool(1).context("starting one thread")?,
            two: pool(2).context("starting two threads")?,
            rows: Vec::new(),
        })
    }

    /// Whether the filters select a case.
    pub(crate) fn wants(&self, case: &Case) -> bool {
        case.is_wanted(&self.filters)
    }

    /// Whether the filters select one of some cases, so that what they share is worth preparing.
    #[cfg(feature = "peers")]
    pub(crate) fn wants_any(&self, cases: &[Case]) -> bool {
        cases.iter().any(|case| self.wants(case))
    }

    /// The rows measured so far, in their order.
    pub(crate) fn into_rows(self) -> Vec<Row> {
        self.rows
    }

    /// Measures both sides on one thread in `turns` turns, and keeps the row; does nothing if the case is not wanted.
    ///
    /// `confirm` looks at what both sides made in their last run.
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

    /// Keeps a row and tells of it.
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

/// The name of a case in messages.
fn in_case(case: &Case) -> String {
    format!("{}: {}, {}", case.group, case.case, case.peer)
}

/// The wall clock.
#[expect(
    clippy::disallowed_methods,
    reason = "a benchmark reads the clock; no value depends on it"
)]
fn now() -> Instant {
    Instant::now()
}

/// The median: the middle value, or the mean of the two in the middle; NaN of nothing. Sorts the values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[middle],
        _ => (values[middle - 1] + values[middle]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::{Must, Unit};
    use anyhow::bail;

    const CASE: Case = Case {
        group: "pups",
        case: "sum",
        peer: "itself",
        unit: Unit::NsPerPoint,
        must: Must::Faster(1.0),
        note: "",
    };

    /// Integer work of a length that the compiler cannot know.
    fn spin(n: u64) -> u64 {
        (0..black_box(n)).fold(1, |sum, i| black_box(sum * 16_807 + i) % 1_000_003)
    }

    #[test]
    fn median_of_odd_even_and_no_values() {
        assert_eq!(
            median(&mut [3.0, 1.0, 2.0]).to_bits(),
            2.0_f64.to_bits(),
            "the middle of three"
        );
        assert_eq!(
            median(&mut [4.0, 1.0, 3.0, 2.0]).to_bits(),
            2.5_f64.to_bits(),
            "between the middle two of four"
        );
        assert!(median(&mut []).is_nan(), "nothing has no median");
    }

    #[test]
    fn beside_runs_in_turns_and_prepares_outside_the_clock() {
        let mut bench = Bench::new(Vec::new()).expect("threads can be started");
        let ours = Side::new([0_u32; 2], |counts| counts[1] += 1)
            .prepared(|counts| counts[0] += 1)
            .times(3);
        let theirs = Side::new(0_u64, |n| *n += spin(1000) % 2 + 1);
        let confirm = |counts: &[u32; 2], n: &u64| {
            assert_eq!(
                *counts,
                [13, 13],
                "4 turns of 3 runs and one to warm up, each prepared"
            );
            assert!(*n >= 4, "4 turns of one run, not {n}");
            Ok(Done::both(1))
        };
        bench
            .beside(&CASE, 4, ours, theirs, confirm)
            .expect("both sides did something");
        let rows = bench.into_rows();
        assert!(
            rows[0].ours < rows[0].theirs,
            "adding one takes less time than 1000 divisions"
        );
    }

    #[test]
    fn beside_fails_when_the_check_fails_or_counts_nothing() {
        let mut bench = Bench::new(Vec::new()).expect("threads can be started");
        let side = || Side::new(0_u32, |n| *n += 1);
        let error = bench
            .beside(&CASE, 1, side(), side(), |_, _| bail!("wrong image"))
            .expect_err("the check failed");
        assert!(
            format!("{error:#}").contains("wrong image"),
            "the reason is told: {error:#}"
        );
        let nothing = |_: &u32, _: &u32| Ok(Done { ours: 0, theirs: 1 });
        assert!(
            bench.beside(&CASE, 1, side(), side(), nothing).is_err(),
            "no work is no result"
        );
        assert!(bench.into_rows().is_empty(), "a failed case leaves no row");
    }

    #[test]
    fn beside_skips_a_case_that_is_not_wanted() {
        let mut bench = Bench::new(vec!["graph".to_owned()]).expect("threads can be started");
        let side = || Side::new((), |()| panic!("a case that no filter selects ran"));
        bench
            .beside(&CASE, 1, side(), side(), |(), ()| Ok(Done::both(1)))
            .expect("skipping is no error");
        assert!(bench.into_rows().is_empty(), "a skipped case leaves no row");
    }

    #[test]
    fn two_threads_needs_a_long_job_and_the_same_bits() {
        let mut bench = Bench::new(Vec::new()).expect("threads can be started");
        let short = bench.two_threads(
            &CASE,
            Duration::ZERO,
            [0_u64; 2],
            |n| *n = spin(10),
            |a, b| a == b,
        );
        assert!(
            short.is_err(),
            "a job of microseconds says nothing about two threads"
        );
        let other = bench.two_threads(
            &CASE,
            Duration::ZERO,
            [0_u64; 2],
            tenth_of_a_second,
            |_, _| false,
        );
        let error = other.expect_err("`same` says that the bits differ");
        assert!(
            error.to_string().contains("other bits"),
            "the reason is told: {error}"
        );
    }

    #[test]
    fn two_threads_gains_nothing_from_a_job_that_is_not_divided() {
        let mut bench = Bench::new(Vec::new()).expect("threads can be started");
        bench
            .two_threads(
                &CASE,
                Duration::ZERO,
                [0_u64; 2],
                tenth_of_a_second,
                |a, b| a == b,
            )
            .expect("the same bits");
        let ratio = bench.into_rows()[0].ratio;
        assert!(
            ratio < 1.1,
            "the job takes a tenth of a second on any number of threads, but the ratio is {ratio}"
        );
    }

    /// Works on one thread until a little more than the least time of a job is over.
    fn tenth_of_a_second(n: &mut u64) {
        let start = ThreadTime::now();
        while start.elapsed().as_secs_f64() < LEAST_JOB_S * 1.01 {
            black_box(spin(1000));
        }
        *n = 1;
    }
}
