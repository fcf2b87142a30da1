//! Rows of documentation images about fractal sums.

use super::{N_POSITIONS, SHADES, SIDE, basis, shaded};
use crate::Panel;
use crate::docs::Strip;
use dapple_raster::{Field, Window};
use dapple_worley::{Combination, OctaveSeeds, Octaves, hash::Seed};
use glam::DVec2;

/// Width and height of an image, in cells of the first octave.
const CELLS: f64 = 2.0;

fn sum(label: &str, combination: Combination, octaves: Octaves) -> anyhow::Result<Panel> {
    sum_from(DVec2::splat(0.5), label, combination, octaves)
}

fn sum_from(
    origin: DVec2,
    label: &str,
    combination: Combination,
    octaves: Octaves,
) -> anyhow::Result<Panel> {
    let fractal = basis().combine(combination).fractal(octaves)?;
    let range = fractal.measure_range(Seed(1), N_POSITIONS)?;
    let window = Window::new(origin, DVec2::splat(CELLS), [SIDE; 2])?;
    let raster = fractal.with_range(range)?.to_raster(&window)?;
    Ok(shaded(label, &raster, SHADES))
}

pub(super) const FRACTAL: Strip = Strip {
    name: "fractal",
    caption: "Six octaves",
    render: || {
        let combinations = [
            ("F1", Combination::F1),
            ("F2 − F1", Combination::F2_MINUS_F1),
        ];
        let panels = combinations
            .into_iter()
            .map(|(label, combination)| sum(label, combination, Octaves::paper()));
        panels.collect()
    },
};

pub(super) const COUNT: Strip = Strip {
    name: "octaves-count",
    caption: "F1",
    render: || {
        let counts = [(1, "1 octave"), (2, "2 octaves"), (6, "6 octaves")];
        let panels = counts.into_iter().map(|(count, label)| {
            let octaves = Octaves {
                count,
                ..Octaves::paper()
            };
            sum(label, Combination::F1, octaves)
        });
        panels.collect()
    },
};

pub(super) const LACUNARITY: Strip = Strip {
    name: "octaves-lacunarity",
    caption: "Three octaves of F1",
    render: || {
        let panels = [1.5, 3.0].into_iter().map(|lacunarity| {
            let octaves = Octaves {
                count: 3,
                lacunarity,
                ..Octaves::paper()
            };
            sum(
                &format!("lacunarity {lacunarity}"),
                Combination::F1,
                octaves,
            )
        });
        panels.collect()
    },
};

pub(super) const GAIN: Strip = Strip {
    name: "octaves-gain",
    caption: "Three octaves of F1",
    render: || {
        let panels = [-0.5, 0.25, 1.0].into_iter().map(|gain| {
            let octaves = Octaves {
                count: 3,
                gain,
                ..Octaves::paper()
            };
            sum(&format!("gain {gain}"), Combination::F1, octaves)
        });
        panels.collect()
    },
};

pub(super) const SEEDS: Strip = Strip {
    name: "octave-seeds",
    caption: "F2 − F1 about the origin, which is the middle",
    render: || {
        let kinds = [("same", OctaveSeeds::Same), ("own", OctaveSeeds::Own)];
        let panels = kinds.into_iter().map(|(label, seeds)| {
            let octaves = Octaves {
                seeds,
                ..Octaves::paper()
            };
            let corner = DVec2::splat(-0.5 * CELLS);
            sum_from(corner, label, Combination::F2_MINUS_F1, octaves)
        });
        panels.collect()
    },
};
