//! Twenty surfaces, all of them combinations C1·F1 + C2·F2 + C3·F3 + C4·F4 of the four lowest basis functions. The
//! values of each are mapped by one generic color spline, after their measured range is scaled to 0 to 1.

use super::{relief, slice};
use crate::draw::{sheet, shrink};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorRamp, Interpolation, LinearRgb};
use dapple_raster::Raster;
use dapple_worley::{Combination, Worley3, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "4",
    parameters: &[("cells across each", "4")],
    source: source!(),
    render,
};

/// Label of each sheet, from the upper left to the lower right, and its coefficients for F1 to F4.
const SHEETS: [(&str, [[f32; 4]; 4]); 5] = [
    (
        "F1, F2, F3, F4",
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ],
    ),
    (
        "F2 − F1, F3 − F2, F4 − F3, F3 − F1",
        [
            [-1.0, 1.0, 0.0, 0.0],
            [0.0, -1.0, 1.0, 0.0],
            [0.0, 0.0, -1.0, 1.0],
            [-1.0, 0.0, 1.0, 0.0],
        ],
    ),
    (
        "F4 − F1, F1 + F2, 2 F3 − F2 − F1, 2 F1 − F2",
        [
            [-1.0, 0.0, 0.0, 1.0],
            [1.0, 1.0, 0.0, 0.0],
            [-1.0, -1.0, 2.0, 0.0],
            [2.0, -1.0, 0.0, 0.0],
        ],
    ),
    (
        "F1 − F2 + F3, 2 F2 − F1 − F3, F1 + F2 − F3, 3 F1 − F2 − F3",
        [
            [1.0, -1.0, 1.0, 0.0],
            [-1.0, 2.0, -1.0, 0.0],
            [1.0, 1.0, -1.0, 0.0],
            [3.0, -1.0, -1.0, 0.0],
        ],
    ),
    (
        "F4 − F2, F1 + F3 − 2 F2 + F4, F4 − F3 + F2 − F1, F4 − F3 − F2 + F1",
        [
            [0.0, -1.0, 0.0, 1.0],
            [1.0, -2.0, 1.0, 1.0],
            [-1.0, 1.0, -1.0, 1.0],
            [1.0, -1.0, -1.0, 1.0],
        ],
    ),
];

/// Number of samples along each side of a pixel.
const SIDE: u32 = 2;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let spline = [
        "#1d2b53", "#2f6f8f", "#8fbf9f", "#f2e3b3", "#d98849", "#7c2d2d",
    ];
    let spline = ColorRamp::from_hex(&spline)?.with_interpolation(Interpolation::Smooth);
    let worley = Worley3::new(Seed(4));
    let surface = |coefficients, size: [u32; 2]| -> anyhow::Result<Raster<LinearRgb>> {
        let combination = worley.combine(Combination::new(coefficients));
        let height = slice(combination, 4.0, size.map(|pixels| pixels * SIDE))?;
        Ok(shrink(&relief(&height, &spline, 0.06)?, SIDE)?)
    };
    let mut panels = Vec::new();
    for (label, four) in SHEETS {
        let picture = |number: u32, size| surface(four[number as usize], size);
        let surfaces = sheet([size; 2], [2, 2], size / 64, LinearRgb::WHITE, picture)?;
        panels.push(Panel::color(label, surfaces));
    }
    Ok(panels)
}
