//! Rows of documentation images about the scatter of feature points: seeds, densities, jitter, periods.

use super::{SIDE, basis, flat, gray_with_edges};
use crate::Panel;
use crate::docs::Strip;
use dapple_worley::{Scatter, hash::Seed};
use glam::DVec2;

/// Width and height of an image, in cells.
const CELLS: f64 = 4.0;

/// Densities to show, in feature points per cell.
const DENSITIES: [f64; 3] = [1.0, 3.0, 8.0];

/// Renders the cells of a basis for each of `values`, which vary one option of the scatter.
fn scattered(
    what: &str,
    values: [f64; 3],
    scatter: impl Fn(f64) -> Scatter,
) -> anyhow::Result<Vec<Panel>> {
    let panels = values.into_iter().map(|value| {
        let worley = basis().with_scatter(scatter(value))?;
        flat(&format!("{what} {value}"), CELLS, &worley)
    });
    panels.collect()
}

pub(super) const SEED: Strip = Strip {
    name: "with-seed",
    caption: "Feature points and their Voronoi cells in 4 by 4 unit cells",
    render: || {
        let panels = [3, 4].into_iter().map(|seed| {
            let worley = basis().with_seed(Seed(seed));
            flat(&format!("seed {seed}"), CELLS, &worley)
        });
        panels.collect()
    },
};

pub(super) const POISSON: Strip = Strip {
    name: "scatter-poisson",
    caption: "Feature points and their Voronoi cells in 4 by 4 unit cells, clamped",
    render: || scattered("density", DENSITIES, |density| Scatter::Poisson { density }),
};

pub(super) const UNCLAMPED: Strip = Strip {
    name: "scatter-unclamped",
    caption: "Feature points and their Voronoi cells in 4 by 4 unit cells, not clamped",
    render: || {
        scattered("density", DENSITIES, |density| Scatter::Unclamped {
            density,
        })
    },
};

pub(super) const JITTERED: Strip = Strip {
    name: "scatter-jittered",
    caption: "Feature points and their Voronoi cells in 4 by 4 unit cells",
    render: || {
        scattered("jitter", [0.0, 0.5, 1.0], |jitter| Scatter::Jittered {
            jitter,
        })
    },
};

pub(super) const VARYING: Strip = Strip {
    name: "with-varying-density",
    caption: "Feature points and their Voronoi cells in 8 by 8 unit cells",
    render: || {
        let worley = basis();
        let ramp = worley
            .clone()
            .with_varying_density(|at| 0.25 + 0.12 * at.x * at.x);
        let disk = worley.with_varying_density(|at| {
            let from_middle = (at - DVec2::splat(4.0)).length_squared();
            if from_middle < 6.25 { 8.0 } else { 0.5 }
        });
        Ok(vec![
            flat("a density that grows to the right", 8.0, &ramp)?,
            flat("density 8 in a disk and 0.5 around it", 8.0, &disk)?,
        ])
    },
};

pub(super) const PERIOD: Strip = Strip {
    name: "with-period",
    caption: "Feature points and their Voronoi cells in 4 by 4 unit cells",
    render: || {
        let periods = [
            ("no period", [None, None]),
            ("a period of 2 along x", [Some(2), None]),
            ("a period of 2 along both axes", [Some(2), Some(2)]),
        ];
        let panels = periods.into_iter().map(|(label, period)| {
            let worley = basis().with_period(period)?;
            flat(label, CELLS, &worley)
        });
        panels.collect()
    },
};

pub(super) const CELL_POINTS: Strip = Strip {
    name: "cell-points",
    caption: "The feature points of 4 by 4 unit cells, which are outlined",
    render: || {
        let worley = basis();
        let pixel = CELLS / f64::from(SIDE);
        let panel = gray_with_edges("unit cells and their points", CELLS, |at| {
            let [nearest] = worley.sample(at);
            let to_line = at - at.round();
            if f64::from(nearest.distance) < 1.6 * pixel {
                0.0
            } else if to_line.abs().min_element() < 0.5 * pixel {
                0.7
            } else {
                1.0
            }
        })?;
        Ok(vec![panel])
    },
};
