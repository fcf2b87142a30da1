//! Rows that compare our own methods with each other and need no other crate.

use super::{F2_MINUS_F1, F2_MINUS_F1_IN_SPACE, Grid, Known, PLANE, SPACE};
use crate::harness::{Bench, Done};
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::Result;
use dapple_raster::Raster;
use dapple_worley::{Dimensions, Metric, Space, Worley};
use std::time::Duration;

const MANHATTAN: Case = Case {
    group: "worley",
    case: "2-D, 64 px per cell, F2 − F1, Manhattan",
    peer: "ours, Euclidean",
    unit: Unit::NsPerPixel,
    must: Goal::CostAtMost(1.3),
    note: "",
};

const FOUR_AXES: Case = Case {
    case: "4-D, 16 px per cell, F2 − F1",
    peer: "ours, 3-D",
    must: Goal::CostAtMost(6.0),
    ..MANHATTAN
};

const TWO_THREADS: Case = Case {
    case: "2-D, 4 px per cell, F2 − F1, 8192×8192 on two threads",
    peer: "ours, one thread",
    unit: Unit::Ms,
    must: Goal::Faster(1.75),
    ..MANHATTAN
};

/// Width and height, in pixels, of the image for two threads: large enough for a job of at least 100 ms.
const TWO_THREADS_SIDE: u32 = 8192;

/// F2 − F1 with the Manhattan metric. Its disks have the area 2r² instead of πr², so distances are √(π/2) times as
/// long.
const MANHATTAN_F2_MINUS_F1: Known = Known {
    mean: 0.182,
    ..F2_MINUS_F1
};

/// F2 − F1 in four dimensions.
const F2_MINUS_F1_OF_FOUR_AXES: Known = Known {
    mean: 0.116,
    ..F2_MINUS_F1
};

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    let manhattan = Worley::<2>::new(SEED).with_metric(Metric::Manhattan)?;
    beside(
        bench,
        &MANHATTAN,
        101,
        &Grid::of(&manhattan, MANHATTAN_F2_MINUS_F1, PLANE, 64)?,
        &Grid::new(F2_MINUS_F1, PLANE, 64)?,
    )?;
    beside(
        bench,
        &FOUR_AXES,
        51,
        &Grid::new(F2_MINUS_F1_OF_FOUR_AXES, [64, 64, 16, 16], 16)?,
        &Grid::new(F2_MINUS_F1_IN_SPACE, SPACE, 16)?,
    )?;
    two_threads(bench)
}

fn beside<const M: usize, const N: usize>(
    bench: &mut Bench,
    case: &Case,
    turns: u32,
    ours: &Grid<M>,
    theirs: &Grid<N>,
) -> Result<()>
where
    Dimensions: Space<M> + Space<N>,
{
    bench.beside(case, turns, ours.side()?, theirs.side()?, |image, other| {
        ours.confirm(image)?;
        theirs.confirm(other)?;
        Ok(Done {
            ours: ours.n_pixels(),
            theirs: theirs.n_pixels(),
        })
    })
}

fn two_threads(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&TWO_THREADS) {
        return Ok(());
    }
    let grid = Grid::new(F2_MINUS_F1, [TWO_THREADS_SIDE; 2], 4)?;
    let bits = |image: &Raster<f32>| {
        image
            .pixels()
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    bench.two_threads(
        &TWO_THREADS,
        Duration::from_secs(15),
        [grid.image()?, grid.image()?],
        |image| grid.render(image),
        |one, two| grid.confirm(one).is_ok() && bits(one) == bits(two),
    )
}
