//! Our rasters compared with the grids of other crates.

use super::{F1, F2_MINUS_F1, F2_MINUS_F1_IN_SPACE, Grid, PLANE, SPACE};
use crate::harness::{Bench, Done, Side};
use crate::peers::noise;
use crate::row::{Case, Goal, Unit};
use anyhow::{Result, ensure};
use dapple_worley::{Dimensions, Space};
use std::ops::RangeInclusive;

const F1_64: Case = Case {
    group: "worley",
    case: "2-D, 64 px per cell, F1",
    peer: "simdnoise cellular_2d",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(7.5),
    note: "the peer has one feature point per cell, ours three on average, and its distances are squared",
};

const F2_MINUS_F1_64: Case = Case {
    case: "2-D, 64 px per cell, F2 − F1",
    peer: "simdnoise cellular2_2d",
    must: Goal::Faster(5.5),
    ..F1_64
};

const F2_MINUS_F1_16: Case = Case {
    case: "2-D, 16 px per cell, F2 − F1",
    must: Goal::Faster(2.2),
    ..F2_MINUS_F1_64
};

const F2_MINUS_F1_4: Case = Case {
    case: "2-D, 4 px per cell, F2 − F1",
    must: Goal::Faster(1.1),
    ..F2_MINUS_F1_64
};

const SPACE_64: Case = Case {
    case: "3-D, 64 px per cell, F2 − F1",
    peer: "simdnoise cellular2_3d",
    must: Goal::Faster(19.0),
    note: "as in the plane; the peer looks at 18 of the 27 places next to a position, see `src/peers/noise.rs`",
    ..F2_MINUS_F1_64
};

const SPACE_32: Case = Case {
    case: "3-D, 32 px per cell, F2 − F1",
    must: Goal::Faster(11.0),
    ..SPACE_64
};

const SPACE_4: Case = Case {
    case: "3-D, 4 px per cell, F2 − F1",
    must: Goal::Faster(1.5),
    ..SPACE_64
};

const BESIDE_SIMPLEX: Case = Case {
    peer: "simdnoise simplex, one octave",
    must: Goal::CostAtMost(0.3),
    note: "the fastest grid of one octave of Perlin or simplex noise that was found; 64 px per cell on both sides",
    ..F2_MINUS_F1_64
};

const BESIDE_SIMPLEX_IN_SPACE: Case = Case {
    case: SPACE_64.case,
    must: Goal::CostAtMost(0.5),
    ..BESIDE_SIMPLEX
};

/// Number of turns per row. Each turn runs both sides.
const TURNS: u32 = 25;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    let plane = |known, px_per_cell| Grid::new(known, PLANE, px_per_cell);
    let space = |px_per_cell| Grid::new(F2_MINUS_F1_IN_SPACE, SPACE, px_per_cell);
    row(bench, &F1_64, &plane(F1, 64)?, &CELLULAR_F1)?;
    row(bench, &F2_MINUS_F1_64, &plane(F2_MINUS_F1, 64)?, &CELLULAR)?;
    row(bench, &F2_MINUS_F1_16, &plane(F2_MINUS_F1, 16)?, &CELLULAR)?;
    row(bench, &F2_MINUS_F1_4, &plane(F2_MINUS_F1, 4)?, &CELLULAR)?;
    row(bench, &SPACE_64, &space(64)?, &CELLULAR_IN_SPACE)?;
    row(bench, &SPACE_32, &space(32)?, &CELLULAR_IN_SPACE)?;
    row(bench, &SPACE_4, &space(4)?, &CELLULAR_IN_SPACE)?;
    row(bench, &BESIDE_SIMPLEX, &plane(F2_MINUS_F1, 64)?, &SIMPLEX)?;
    row(
        bench,
        &BESIDE_SIMPLEX_IN_SPACE,
        &space(64)?,
        &SIMPLEX_IN_SPACE,
    )
}

/// A peer that computes grids with `N` axes, and the known properties of its values.
struct Peer<const N: usize> {
    /// Computes the grid. Takes its size in pixels, and the number of cells per pixel.
    make: fn([usize; N], f32) -> noise::Grid,
    /// Range of the grid's values.
    range: RangeInclusive<f32>,
    /// Minimum difference between the largest and the smallest value.
    spread: f32,
}

/// Cellular F1: a position is less than 0.45 + 0.71 away from its nearest feature point.
const CELLULAR_F1: Peer<2> = Peer {
    make: noise::simdnoise_f1,
    range: 0.0..=1.4,
    spread: 0.5,
};

/// Cellular F2 − F1: the second nearest point is less than 0.45 + 1.12 away. A small difference may be rounded below
/// zero.
const CELLULAR: Peer<2> = Peer {
    make: noise::simdnoise_f1_minus_f2,
    range: -2.5..=1e-5,
    spread: 0.5,
};

const CELLULAR_IN_SPACE: Peer<3> = Peer {
    make: noise::simdnoise_f1_minus_f2_in_space,
    range: -2.5..=1e-5,
    spread: 0.5,
};

/// Simplex noise, which `simdnoise` does not scale to [−1, 1].
const SIMPLEX: Peer<2> = Peer {
    make: noise::simdnoise_simplex,
    range: -0.04..=0.04,
    spread: 0.03,
};

const SIMPLEX_IN_SPACE: Peer<3> = Peer {
    make: noise::simdnoise_simplex_in_space,
    range: -0.04..=0.04,
    spread: 0.03,
};

fn row<const N: usize>(bench: &mut Bench, case: &Case, grid: &Grid<N>, peer: &Peer<N>) -> Result<()>
where
    Dimensions: Space<N>,
{
    let (size, frequency) = (
        grid.size.map(|side| side as usize),
        1.0 / grid.px_per_cell as f32,
    );
    let theirs = Side::new((Vec::new(), 0.0, 0.0), |made: &mut noise::Grid| {
        *made = (peer.make)(size, frequency);
    })
    .prepared(|made| made.0 = Vec::new());
    // Our side runs as often per turn as fits in about the time of the peer's run.
    let times = match case.must {
        Goal::Faster(bar) | Goal::AtLeast(bar) => bar,
        Goal::CostAtMost(bar) => 1.0 / bar,
    };
    let ours = grid.side()?.times(times.ceil() as u32);
    bench.beside(
        case,
        TURNS,
        ours,
        theirs,
        |image, (values, least, largest)| {
            grid.confirm(image)?;
            let bad = values.iter().position(|value| !peer.range.contains(value));
            ensure!(
                bad.is_none(),
                "the value {bad:?} of the peer is not in {:?}",
                peer.range
            );
            ensure!(
                largest - least >= peer.spread,
                "the peer's grid is flat: {least} to {largest}"
            );
            Ok(Done {
                ours: grid.n_pixels(),
                theirs: values.len(),
            })
        },
    )
}
