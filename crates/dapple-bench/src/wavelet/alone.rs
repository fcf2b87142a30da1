//! Our filters compared with a plain convolution, and at other raster sizes. These rows need no other crate.

use super::straight::Straight;
use super::{SIDE, confirm_equal, down_and_up, white_noise};
use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use anyhow::Result;

const STRAIGHT: Case = Case {
    group: "wavelet",
    case: "down and up, 2048×2048",
    peer: "straight convolution with 32 taps",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(1.0),
    note: "ours has no taps to leave out: it is exact; times are per pixel of the fine raster",
};

const SIZE: Case = Case {
    case: "down and up, 8192×8192",
    peer: "ours, 256×256",
    must: Goal::CostAtMost(1.5),
    note: "",
    ..STRAIGHT
};

/// Raster sizes, in ascending order, whose cost is measured relative to the smallest.
const SIZES: [(u32, Case); 3] = [
    (
        1024,
        Case {
            case: "down and up, 1024×1024",
            ..SIZE
        },
    ),
    (
        4096,
        Case {
            case: "down and up, 4096×4096",
            ..SIZE
        },
    ),
    (8192, SIZE),
];

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if bench.wants(&STRAIGHT) {
        let raster = white_noise(SIDE)?;
        let straight = Straight::new(SIDE as usize);
        let theirs = Side::new(straight, |straight: &mut Straight| {
            straight.run(raster.pixels());
        });
        bench.beside(
            &STRAIGHT,
            31,
            down_and_up(&raster)?,
            theirs,
            |ours, theirs| {
                // The omitted taps sum to less than 1e-3 on either side and axis.
                confirm_equal(ours.fine.pixels(), &theirs.fine, 4e-3)?;
                Ok(Done::both(raster.pixels().len()))
            },
        )?;
    }
    for (side, case) in &SIZES {
        if !bench.wants(case) {
            continue;
        }
        let [large, small] = [white_noise(*side)?, white_noise(256)?];
        let turns = if *side > 4096 { 7 } else { 21 };
        let theirs = down_and_up(&small)?.times(20);
        bench.beside(case, turns, down_and_up(&large)?, theirs, |_, _| {
            Ok(Done {
                ours: large.pixels().len(),
                theirs: small.pixels().len(),
            })
        })?;
    }
    Ok(())
}
