//! Twenty surfaces, all of them combinations C1·F1 + C2·F2 + C3·F3 + C4·F4 of the four lowest basis functions. The values
//! of each go through one generic color spline, after their measured range has become 0 to 1.

use super::{F3_MINUS_F1, relief, slice};
use crate::draw::{sheet, shrink};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorRamp, Interpolation, LinearRgb};
use dapple_worley::{Combination, Worley3, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "4",
    parameters: &[
        ("row 1", "F1, F2, F3, F4, F2 − F1"),
        ("row 2", "F3 − F2, F4 − F3, F3 − F1, F4 − F1, F4 − F2"),
        (
            "row 3",
            "F1 + F2, F1 − F2 + F3, 2 F3 − F2 − F1, 2 F2 − F1 − F3, F1 + F2 − F3",
        ),
        (
            "row 4",
            "F1 + F3 − 2 F2 + F4, 3 F1 − F2 − F3, F4 − F3 + F2 − F1, F4 − F3 − F2 + F1, 2 F1 − F2",
        ),
        ("cells across each", "3"),
    ],
    source: source!(),
    render,
};

/// The coefficients of F1 to F4 where the combination has no name.
const COMBINATIONS: [Combination; 20] = [
    Combination::F1,
    Combination::F2,
    Combination::F3,
    Combination::F4,
    Combination::F2_MINUS_F1,
    Combination::F3_MINUS_F2,
    Combination::new([0.0, 0.0, -1.0, 1.0]),
    F3_MINUS_F1,
    Combination::new([-1.0, 0.0, 0.0, 1.0]),
    Combination::new([0.0, -1.0, 0.0, 1.0]),
    Combination::F1_PLUS_F2,
    Combination::new([1.0, -1.0, 1.0, 0.0]),
    Combination::TWO_F3_MINUS_F2_MINUS_F1,
    Combination::new([-1.0, 2.0, -1.0, 0.0]),
    Combination::new([1.0, 1.0, -1.0, 0.0]),
    Combination::new([1.0, -2.0, 1.0, 1.0]),
    Combination::new([3.0, -1.0, -1.0, 0.0]),
    Combination::new([-1.0, 1.0, -1.0, 1.0]),
    Combination::new([1.0, -1.0, -1.0, 1.0]),
    Combination::new([2.0, -1.0, 0.0, 0.0]),
];

/// Samples along each side of a pixel.
const SIDE: u32 = 2;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let spline = [
        "#1d2b53", "#2f6f8f", "#8fbf9f", "#f2e3b3", "#d98849", "#7c2d2d",
    ];
    let spline = ColorRamp::from_hex(&spline)?.with_interpolation(Interpolation::Smooth);
    let worley = Worley3::new(Seed(4));
    let white = LinearRgb::WHITE;
    let surfaces = sheet(
        [size, size * 4 / 5],
        [5, 4],
        size / 128,
        white,
        |number, size| {
            let combination = worley.combine(COMBINATIONS[number as usize]);
            let height = slice(combination, 3.0, size.map(|pixels| pixels * SIDE))?;
            Ok(shrink(&relief(&height, &spline, 0.08)?, SIDE)?)
        },
    )?;
    Ok(vec![Panel::color("", surfaces)])
}
