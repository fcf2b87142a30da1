//! All data of the four nearest points compared with only the distances to two of them.
//!
//! The band is small enough to stay in the cache, so that the row measures the search, not memory access.

use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::{Result, ensure};
use dapple_raster::{Field as _, Raster, Window};
use dapple_worley::{Combination, FeatureView, Plane, Worley2};
use glam::DVec2;

const FOUR: Case = Case {
    group: "worley",
    case: "2-D, 64 px per cell, band of 256×32, F1 to F4 with vectors and ids",
    peer: "ours, F1 and F2",
    unit: Unit::NsPerPixel,
    must: Goal::CostAtMost(5.0),
    note: "the two are textures, rendered one after the other, which is the fastest way to them; 80 bytes for each pixel \
           beside 8",
};

/// Width and height of the band in pixels. All data of the four nearest points takes 640 KiB.
const BAND: [u32; 2] = [256, 32];

/// Pixels per unit cell along each axis.
const PX_PER_CELL: f64 = 64.0;

/// Number of turns for the row, and number of runs per side in each turn.
const TURNS: u32 = 101;
const RUNS: u32 = 5;

/// Data of one of the nearest points, at every pixel of the band.
struct Nearest {
    distance: Raster<f32>,
    vector: Raster<[f32; 2]>,
    id: Raster<u64>,
}

impl Nearest {
    fn new() -> Result<Self> {
        Ok(Self {
            distance: Raster::filled(BAND, 0.0)?,
            vector: Raster::filled(BAND, [0.0; 2])?,
            id: Raster::filled(BAND, 0)?,
        })
    }

    fn all(&mut self) -> FeatureView<'_, 2> {
        FeatureView {
            distance: Some(self.distance.view_mut()),
            vector: Some(self.vector.view_mut()),
            id: Some(self.id.view_mut()),
            ..FeatureView::default()
        }
    }
}

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    let worley = Worley2::new(SEED);
    let [width, height] = BAND.map(f64::from);
    let window = Window::new(DVec2::ZERO, DVec2::new(width, height) / PX_PER_CELL, BAND)?;
    let [a, b, c, d] = [(); 4].map(|()| Nearest::new());
    let ours = Side::new([a?, b?, c?, d?], |nearest: &mut [Nearest; 4]| {
        let views = nearest.each_mut().map(Nearest::all);
        worley
            .render_features(&Plane::default(), &window, views)
            .expect("the views have the window's size");
    })
    .times(RUNS);
    let distances = [Combination::F1, Combination::F2].map(|distance| worley.combine(distance));
    let theirs = Side::new(
        [Raster::filled(BAND, 0.0)?, Raster::filled(BAND, 0.0)?],
        |bands: &mut [Raster<f32>; 2]| {
            for (distance, band) in distances.iter().zip(bands) {
                distance
                    .render(&window, band.view_mut())
                    .expect("the band has the window's size");
            }
        },
    )
    .times(RUNS);
    bench.beside(&FOUR, TURNS, ours, theirs, |four, two| {
        for row in 0..BAND[1] {
            for column in 0..BAND[0] {
                let expected = worley.sample::<4>(window.position(column, row));
                for (rank, (found, expected)) in four.iter().zip(&expected).enumerate() {
                    let at = column as usize;
                    let distance = found.distance.row(row)[at];
                    let vector = DVec2::from(found.vector.row(row)[at].map(f64::from));
                    ensure!(
                        distance == expected.distance
                            && vector == expected.vector
                            && found.id.row(row)[at] == expected.id,
                        "F{} at {column}, {row} is not {expected:?}",
                        rank + 1
                    );
                }
            }
        }
        for (two, four) in two.iter().zip(four) {
            ensure!(*two == four.distance, "two distances are not those of four");
        }
        Ok(Done::both(window.n_pixels()))
    })
}
