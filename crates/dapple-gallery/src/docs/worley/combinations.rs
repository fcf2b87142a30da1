//! Rows of documentation images about combinations of F1 to F4, metrics, ranges and gradients.

use super::{N_POSITIONS, basis, color_of, color_with_edges, gray, gray_with_edges, ranged};
use crate::Panel;
use crate::docs::Strip;
use dapple_worley::{Combination, Metric, hash::Seed};
use glam::DVec3;

/// Width and height of an image, in cells.
const CELLS: f64 = 2.5;

const fn one(name: &'static str, render: fn() -> anyhow::Result<Vec<Panel>>) -> Strip {
    Strip {
        name,
        caption: "",
        render,
    }
}

pub(super) const F1: Strip = one("combination-f1", || only("F1", Combination::F1));
pub(super) const F2: Strip = one("combination-f2", || only("F2", Combination::F2));
pub(super) const F3: Strip = one("combination-f3", || only("F3", Combination::F3));
pub(super) const F4: Strip = one("combination-f4", || only("F4", Combination::F4));
pub(super) const F2_MINUS_F1: Strip = one("combination-f2-minus-f1", || {
    only("F2 − F1", Combination::F2_MINUS_F1)
});
pub(super) const F1_PLUS_F2: Strip = one("combination-f1-plus-f2", || {
    only("F1 + F2", Combination::F1_PLUS_F2)
});
pub(super) const F3_MINUS_F1: Strip = one("combination-f3-minus-f1", || {
    only("F3 − F1", Combination::F3_MINUS_F1)
});
pub(super) const F3_MINUS_F2: Strip = one("combination-f3-minus-f2", || {
    only("F3 − F2", Combination::F3_MINUS_F2)
});
pub(super) const F4_MINUS_F1: Strip = one("combination-f4-minus-f1", || {
    only("F4 − F1", Combination::F4_MINUS_F1)
});
pub(super) const F4_MINUS_F3: Strip = one("combination-f4-minus-f3", || {
    only("F4 − F3", Combination::F4_MINUS_F3)
});
pub(super) const TWO_F3_MINUS_F2_MINUS_F1: Strip =
    one("combination-two-f3-minus-f2-minus-f1", || {
        only("2 F3 − F2 − F1", Combination::TWO_F3_MINUS_F2_MINUS_F1)
    });

/// A strip about a combination without a predefined name.
pub(super) const NEW: Strip = Strip {
    name: "combination-new",
    caption: "One that has no name, F1 − 2 F2 + F3",
    render: || only("F1 − 2 F2 + F3", Combination::new([1.0, -2.0, 1.0, 0.0])),
};

fn only(label: &str, combination: Combination) -> anyhow::Result<Vec<Panel>> {
    Ok(vec![combined(label, combination)?])
}

fn combined(label: &str, combination: Combination) -> anyhow::Result<Panel> {
    let texture = ranged(basis().combine(combination))?;
    gray(label, CELLS, |at| texture.value(at))
}

pub(super) const METRIC: Strip = Strip {
    name: "metric",
    caption: "F1 of the same feature points, black where it is 0",
    render: || {
        let metrics = [
            ("Euclidean", Metric::Euclidean),
            ("Manhattan", Metric::Manhattan),
            ("Chebyshev", Metric::Chebyshev),
            ("Minkowski with p = 1.4", Metric::Minkowski(1.4)),
            ("Minkowski with p = 4", Metric::Minkowski(4.0)),
        ];
        let panels = metrics.into_iter().map(|(label, metric)| {
            let texture = basis().with_metric(metric)?.combine(Combination::F1);
            let [_, high] = texture.measure_range(Seed(1), N_POSITIONS)?;
            let texture = texture.with_range([0.0, high])?;
            gray(label, CELLS, |at| texture.value(at))
        });
        panels.collect()
    },
};

pub(super) const NORMALIZED: Strip = Strip {
    name: "normalized",
    caption: "F4 − F3, with values from 0, black, to 1, white",
    render: || {
        let plain = basis().combine(Combination::F4_MINUS_F3);
        let normalized = plain.clone().normalized()?;
        Ok(vec![
            gray("as it is", CELLS, |at| plain.value(at))?,
            gray("normalized", CELLS, |at| normalized.value(at))?,
        ])
    },
};

pub(super) const RANGE: Strip = Strip {
    name: "with-range",
    caption: "F1, with what lies beyond black and white clamped by the picture",
    render: || {
        let ranges = [("the range 0 to 1", [0.0, 1.0]), ("0 to 0.4", [0.0, 0.4])];
        let panels = ranges.into_iter().map(|(label, range)| {
            let texture = basis().combine(Combination::F1).with_range(range)?;
            gray(label, CELLS, |at| texture.value(at))
        });
        panels.collect()
    },
};

pub(super) const GRADIENT: Strip = Strip {
    name: "gradient",
    caption: "Red grows with the part along x, and green with that along y",
    render: || {
        let f1 = basis().combine(Combination::F1);
        let normalized = f1.clone().normalized()?;
        let toward = DVec3::new(-0.5, -0.6, 0.62);
        Ok(vec![
            gray("F1", CELLS, |at| normalized.value(at))?,
            color_with_edges("its gradient", CELLS, |at| color_of(f1.gradient(at), 1.0))?,
            gray_with_edges(
                "the surface of that height in light from the upper left",
                CELLS,
                |at| {
                    let slope = f1.gradient(at) * 0.7;
                    let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
                    normal.dot(toward).max(0.0) as f32
                },
            )?,
        ])
    },
};
