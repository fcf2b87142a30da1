//! Measures single steps whose times the paper reports.

use super::table_1::TORI;
use crate::harness::Bench;
use crate::row::{Case, Goal, Unit};
use anyhow::Result;
use dapple_synth::{Hierarchy, Orientation, Sweep};

const FIELD: Case = Case {
    group: "synth",
    case: "vector field, 256,000 sites, 4 levels",
    peer: "the paper's 30 seconds",
    unit: Unit::S,
    must: Goal::Faster(100.0),
    note: "wall time on two threads; the model is the blended tori",
};

const SWEEP: Case = Case {
    case: "sweep, 256,000 sites, 4 levels",
    peer: "the paper's 45 seconds",
    ..FIELD
};

/// Number of runs of each step; the fastest one counts.
const RUNS: u32 = 3;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[FIELD, SWEEP]) {
        return Ok(());
    }
    let hierarchy = Hierarchy::new(&TORI.surface()?, &TORI.sites())?;
    let directions = TORI.directions();
    let orientation = Orientation::new(&hierarchy, &directions)?;
    let (mut field, mut sweep) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let (seconds, made) = bench.on_two(|| Orientation::new(&hierarchy, &directions));
        made?;
        field = field.min(seconds);
        let (seconds, made) = bench.on_two(|| Sweep::new(&hierarchy, &orientation, None));
        made?;
        sweep = sweep.min(seconds);
    }
    for (case, ours, theirs) in [(FIELD, field, 30.0), (SWEEP, sweep, 45.0)] {
        if bench.wants(&case) {
            bench.measured(&case, ours, theirs);
        }
    }
    Ok(())
}
