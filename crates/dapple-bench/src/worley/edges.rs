//! The distance to cell edges compared with F2 − F1, which is often used instead.

use super::{F2_MINUS_F1, Grid, PLANE};
use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::{Result, ensure};
use dapple_raster::{Field as _, Raster};
use dapple_worley::Worley2;

const AT_64: Case = Case {
    group: "worley",
    case: "2-D, 64 px per cell, distance to the edge",
    peer: "ours, F2 − F1",
    unit: Unit::NsPerPixel,
    must: Goal::CostAtMost(6.0),
    note: "",
};

const AT_16: Case = Case {
    case: "2-D, 16 px per cell, distance to the edge",
    ..AT_64
};

const AT_256: Case = Case {
    case: "2-D, 256 px per cell, distance to the edge",
    ..AT_64
};

/// Number of turns per row. Each turn runs both sides.
const TURNS: u32 = 31;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    row(bench, &AT_16, 16)?;
    row(bench, &AT_64, 64)?;
    row(bench, &AT_256, 256)
}

fn row(bench: &mut Bench, case: &Case, px_per_cell: u32) -> Result<()> {
    let worley = Worley2::new(SEED);
    let edges = worley.edge_distances();
    let grid = Grid::new(F2_MINUS_F1, PLANE, px_per_cell)?;
    let ours = Side::new(grid.image()?, |image: &mut Raster<f32>| {
        edges
            .render(&grid.window, image.view_mut())
            .expect("the image has the window's size");
    });
    bench.beside(case, TURNS, ours, grid.side()?, |image, _| {
        // The stride is a prime, so that the checked pixels cover all positions within a block.
        for index in (0..grid.n_pixels() as u32).step_by(1009) {
            let (column, row) = (index % PLANE[0], index / PLANE[0]);
            let expected = worley.edge_distance(grid.window.position(column, row));
            let found = image.row(row)[column as usize];
            ensure!(
                found.to_bits() == expected.to_bits(),
                "{found} at {column}, {row}, and {expected} asked alone"
            );
        }
        Ok(Done::both(grid.n_pixels()))
    })
}
