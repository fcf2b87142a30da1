//! Synthesis on two threads compared with one thread.

use super::scene::{N_SITES, endless, exact, leaves, model, synthesizer};
use super::whole;
use crate::harness::Bench;
use crate::row::{Case, Goal, Unit};
use anyhow::{Context as _, Result};
use std::time::Duration;

const SYNTHESIS: Case = Case {
    group: "synth",
    case: "synthesis on two threads, 262,144 sites",
    peer: "ours, one thread",
    unit: Unit::S,
    must: Goal::Faster(1.75),
    note: "",
};

const WHOLE: Case = Case {
    case: "whole run on two threads, 262,144 sites, map 2048×2048",
    must: Goal::Faster(1.6),
    ..SYNTHESIS
};

const ENDLESS: Case = Case {
    case: "endless texture on two threads, 512×512",
    must: Goal::Faster(1.85),
    ..SYNTHESIS
};

/// Time for measuring a row. It is exceeded if three turns take longer.
const BUDGET: Duration = Duration::from_secs(20);

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[SYNTHESIS, WHOLE, ENDLESS]) {
        return Ok(());
    }
    let (model, exemplar) = (model()?, leaves(64)?.exemplar()?);
    if bench.wants(&SYNTHESIS) {
        let sites = synthesizer(&model, N_SITES, 3)?;
        // Checked here once, so that a run of the row cannot fail.
        sites
            .synthesize(&exemplar, &exact(3))
            .context("synthesis")?;
        bench.two_threads(
            &SYNTHESIS,
            BUDGET,
            [None, None],
            |made| *made = sites.synthesize(&exemplar, &exact(3)).ok(),
            |one, two| one.is_some() && one == two,
        )?;
    }
    bench.two_threads(
        &ENDLESS,
        BUDGET,
        [None, None],
        |made| *made = endless(&exemplar).ok(),
        |one, two| one.is_some() && one == two,
    )?;
    bench.two_threads(
        &WHOLE,
        BUDGET,
        [None, None],
        |made| *made = whole::run(&model, &exemplar, &exact(3)).ok(),
        |one, two| one.is_some() && one == two,
    )
}
