//! Tests of the harness: turns, checks, filters and medians.

use super::two_threads::LEAST_JOB_S;
use super::*;
use crate::row::{Goal, Unit};
use anyhow::bail;
use std::time::Duration;

const CASE: Case = Case {
    group: "pups",
    case: "sum",
    peer: "itself",
    unit: Unit::NsPerPoint,
    must: Goal::Faster(1.0),
    note: "",
};

/// Does integer work proportional to `n`; the compiler cannot compute the result ahead of time.
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
    let mut bench = Bench::new(Vec::new(), Page::default()).expect("threads can be started");
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
    let mut bench = Bench::new(Vec::new(), Page::default()).expect("threads can be started");
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
    let mut bench =
        Bench::new(vec!["graph".to_owned()], Page::default()).expect("threads can be started");
    let side = || Side::new((), |()| panic!("a case that no filter selects ran"));
    bench
        .beside(&CASE, 1, side(), side(), |(), ()| Ok(Done::both(1)))
        .expect("skipping is no error");
    assert!(bench.into_rows().is_empty(), "a skipped case leaves no row");
}

#[test]
fn two_threads_needs_a_long_job_and_the_same_bits() {
    let mut bench = Bench::new(Vec::new(), Page::default()).expect("threads can be started");
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
    let mut bench = Bench::new(Vec::new(), Page::default()).expect("threads can be started");
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

/// Works on one thread for slightly longer than [`LEAST_JOB_S`], the minimum time of a job.
fn tenth_of_a_second(n: &mut u64) {
    let start = ThreadTime::now();
    while start.elapsed().as_secs_f64() < LEAST_JOB_S * 1.01 {
        black_box(spin(1000));
    }
    *n = 1;
}
