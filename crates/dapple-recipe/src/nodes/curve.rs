//! Maps a number by a smooth curve through points.
//!
//! Monotone cubic Hermite splines of F. N. Fritsch and J. Butland, "A Method for Constructing Local Monotone Piecewise
//! Cubic Interpolants", SIAM Journal on Scientific and Statistical Computing 5(2), 1984,
//! <https://doi.org/10.1137/0905021>, with the variant that weights slopes by the widths of both intervals. The slope
//! at an end point is the slope of the line to its neighbor.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{Input, RecipeError, RecipeErrorKind};
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, double_value};
use serde::{Deserialize, Serialize};

/// Number mapped by a smooth curve through points, which does not overshoot them.
///
/// Before the first point and after the last one, the curve is constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SplineCurve {
    /// Number to map.
    pub input: Input,
    /// Points `[input, result]` with ascending inputs, from 2 to 256.
    #[serde(default = "line")]
    pub points: Vec<[f32; 2]>,
}

fn line() -> Vec<[f32; 2]> {
    vec![[0.0, 0.0], [1.0, 1.0]]
}

const NUMBER: Range = range!(finite);

impl NodeKind for SplineCurve {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let spline = Spline::new(&self.points)?;
        plan.each(&self.input, move |value| spline.at(value.into()) as f32)
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let spline = Spline::new(&self.points)?;
        let input = shader.number(&self.input)?;
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        let parts = (1..self.points.len()).map(|after| spline.part(after).map(double_value));
        let parts = parts.map(|parts| format!("SplinePart({})", parts.join(", ")));
        let parts: Vec<_> = parts.collect();
        let bounds = self.points[1..self.points.len() - 1].iter();
        let bounds: Vec<_> = bounds.map(|&[at, _]| literal(at)).collect();
        shader.needs(Module::Spline);
        let parts_name = shader.constant("PARTS", format!("array({})", parts.join(", ")));
        let index = match bounds.is_empty() {
            true => "0u".to_owned(),
            false => {
                let count = bounds.iter().map(|bound| format!("u32(x >= {bound})"));
                count.collect::<Vec<_>>().join(" + ")
            }
        };
        let [(from, start), (to, end)] =
            [first, last].map(|[at, value]| (literal(at), literal(value)));
        let body = format!(
            "(x: f32, zero: u32) -> f32 {{\n    if x < {from} {{ return {start}; }}\n    \
             if x >= {to} {{ return {end}; }}\n    var parts = {parts_name};\n    \
             return spline_value(parts[{index}], x);\n}}"
        );
        let curve = shader.function("curve", &body);
        Ok(Code::number(format!("{curve}({input}, zero)")))
    }
}

/// Control points of a spline and the slope at each.
struct Spline {
    points: Vec<[f64; 2]>,
    slopes: Vec<f64>,
}

impl Spline {
    fn new(points: &[[f32; 2]]) -> Result<Self, RecipeError> {
        if !(2..=256).contains(&points.len()) {
            return Err(RecipeError::new(RecipeErrorKind::Count {
                what: "points of the curve",
                count: points.len(),
                needed: "2 to 256",
            }));
        }
        for &number in points.iter().flatten() {
            RecipeError::check_in(NUMBER, "number of a point", number.into())?;
        }
        for pair in points.windows(2) {
            let what = "input of a point";
            let range = "above that of the point before";
            RecipeError::check(pair[0][0] < pair[1][0], what, pair[1][0].into(), range)?;
        }
        let points: Vec<_> = points.iter().map(|point| point.map(f64::from)).collect();
        let widths = points.windows(2).map(|pair| pair[1][0] - pair[0][0]);
        let widths: Vec<_> = widths.collect();
        let secants = points.windows(2).zip(&widths);
        let secants = secants.map(|(pair, width)| (pair[1][1] - pair[0][1]) / width);
        let secants: Vec<f64> = secants.collect();
        let last = points.len() - 1;
        let slope = |index: usize| match index {
            0 => secants[0],
            _ if index == last => secants[last - 1],
            _ => {
                let [before, after] = [secants[index - 1], secants[index]];
                // At a peak, the slope is 0.
                if before * after <= 0.0 {
                    return 0.0;
                }
                let [left, right] = [widths[index - 1], widths[index]];
                let weights = [2.0 * right + left, right + 2.0 * left];
                (weights[0] + weights[1]) / (weights[0] / before + weights[1] / after)
            }
        };
        let slopes = (0..=last).map(slope).collect();
        Ok(Self { points, slopes })
    }

    /// Returns the cubic between point `after - 1` and point `after`: x and y of the first point, the distance in x, y
    /// of the second point, and the slopes at both points times that distance.
    fn part(&self, after: usize) -> [f64; 6] {
        let [[x0, y0], [x1, y1]] = [self.points[after - 1], self.points[after]];
        let width = x1 - x0;
        let [from, to] = [self.slopes[after - 1] * width, self.slopes[after] * width];
        [x0, y0, width, y1, from, to]
    }

    /// Returns the value of the curve at `x`. Beyond the first and last points, the curve is constant.
    fn at(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|&[at, _]| at <= x);
        let Some(before) = after.checked_sub(1) else {
            // Before the first point, or not a number
            return if x.is_nan() { x } else { self.points[0][1] };
        };
        if after == self.points.len() {
            return self.points[before][1];
        }
        let [x0, y0, width, y1, from, to] = self.part(after);
        let t = (x - x0) / width;
        let rest = 1.0 - t;
        let ends = y0 * (1.0 + 2.0 * t) * rest * rest + y1 * (3.0 - 2.0 * t) * t * t;
        ends + t * rest * (from * rest - to * t)
    }
}

#[cfg(test)]
mod tests {
    use super::Spline;

    #[test]
    fn curves_meet_their_points_and_are_monotone_between_them() {
        let points = [[0.0, 0.1], [0.2, 0.15], [0.25, 0.9], [0.6, 0.9], [1.0, 0.3]];
        let spline = Spline::new(&points).unwrap();
        for [x, y] in points {
            assert_eq!(spline.at(x.into()), f64::from(y));
        }
        assert_eq!(
            [spline.at(-1.0), spline.at(2.0)],
            [0.1_f32, 0.3].map(f64::from)
        );
        let values: Vec<_> = (0..=1000)
            .map(|step| spline.at(f64::from(step) / 1000.0))
            .collect();
        for (step, pair) in values.windows(2).enumerate() {
            // Sums round by a few parts in 2^53.
            let rise = pair[1] - pair[0];
            match step {
                0..250 => assert!(rise >= -1e-15, "{step}: {rise}"),
                250..600 => assert!(rise.abs() < 1e-15, "{step}: {rise}"),
                _ => assert!(rise <= 1e-15, "{step}: {rise}"),
            }
        }
    }

    #[test]
    fn two_points_are_a_line_and_even_slopes_have_the_harmonic_mean() {
        let line = Spline::new(&[[0.0, 1.0], [2.0, 5.0]]).unwrap();
        assert_eq!(line.at(0.5), 2.0);
        // Slopes of 1 and 3 meet with the slope 2 · 1 · 3 / (1 + 3) in the middle of equal widths.
        let bent = Spline::new(&[[0.0, 0.0], [1.0, 1.0], [2.0, 4.0]]).unwrap();
        assert_eq!(bent.slopes, [1.0, 1.5, 3.0]);
        assert_eq!(bent.at(0.5), 0.5 + 0.125 * (1.0 - 1.5));
        assert!(bent.at(f64::NAN).is_nan());
    }
}
