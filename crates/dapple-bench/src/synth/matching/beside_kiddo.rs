//! Our matcher compared with `kiddo`, using the faster of two numbers of directions.

use super::{PLAIN_SMALL, Recorded, Setting};
use crate::harness::{Bench, Side};
use crate::peers::kd_tree::{Directions, KdTree};
use crate::row::{Case, Goal};
use anyhow::{Result, ensure};

const KIDDO: Case = Case {
    must: Goal::Faster(3.0),
    note: "the peer searches in 8 or 16 principal directions, filters there, and compares what is left",
    ..PLAIN_SMALL
};

/// Returns the rows of a setting: one for each number of directions, 8 and 16.
pub(super) fn cases(setting: &Setting) -> [Case; 2] {
    ["kiddo, 8 directions", "kiddo, 16 directions"].map(|peer| Case {
        case: setting.plain.case,
        peer,
        ..KIDDO
    })
}

pub(super) fn run(bench: &mut Bench, setting: &Setting, recorded: &Recorded) -> Result<()> {
    let [eight, sixteen] = cases(setting);
    beside::<8>(bench, &eight, setting, recorded)?;
    beside::<16>(bench, &sixteen, setting, recorded)
}

fn beside<const N: usize>(
    bench: &mut Bench,
    case: &Case,
    setting: &Setting,
    recorded: &Recorded,
) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let [every, theirs, _] = setting.timed;
    let directions = Directions::<N>::principal(recorded.dims, &recorded.rows);
    let tree = KdTree::new(recorded.dims, &recorded.rows, directions)?;
    let kiddo = Side::new(Vec::new(), |found: &mut Vec<u32>| {
        found.clear();
        found.extend(recorded.queries(theirs).map(|query| tree.nearest(query)));
    });
    bench.beside(case, 3, recorded.ours(every), kiddo, |ours, kiddo| {
        let same = ours.found.iter().step_by(theirs / every).eq(kiddo);
        ensure!(same, "the peer found another row");
        recorded.done([every, theirs], &ours.found, kiddo)
    })
}
