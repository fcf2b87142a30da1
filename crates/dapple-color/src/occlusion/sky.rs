//! What a row of pixels sees of the sky, in registers of neighboring pixels.

use super::lines::{Lines, View};
use crate::arctangent::arctangent;
use fearless_simd::{f32x16, prelude::*};

/// How many columns are done side by side.
pub(super) const LANES: usize = 16;

/// Slopes up to this are told apart: their squares are far from the end of `f32`.
const STEEPEST: f32 = 1e9;

/// The part of the sky that a row of pixels sees.
#[inline(always)]
pub(super) fn see_row<S: Simd>(simd: S, lines: &Lines<'_>, values: &mut [f32]) {
    for (values, first) in values.chunks_mut(LANES).zip((0..).step_by(LANES)) {
        let seen: [f32; LANES] = see(simd, lines, first).into();
        values.copy_from_slice(&seen[..values.len()]);
    }
}

/// The part of the sky that the columns from `first` on see.
#[inline(always)]
fn see<S: Simd>(simd: S, lines: &Lines<'_>, first: usize) -> f32x16<S> {
    let here = load(simd, lines.here, first);
    let slope = slope(simd, lines, first);
    let mut seen = f32x16::splat(simd, 0.0);
    let mut whole = seen;
    for [there, back] in lines.views.as_chunks::<2>().0 {
        let [x, y] = there.direction;
        let tangent = limit(simd, slope[0] * x + slope[1] * y, -STEEPEST, STEEPEST);
        let horizons = [
            horizon(simd, there, here, first, tangent),
            horizon(simd, back, here, first, -tangent),
        ];
        seen += arc(simd, tangent, horizons[0]) + arc(simd, -tangent, horizons[1]);
        whole += tangent * arctangent(simd, tangent) + 1.0;
    }
    limit(simd, seen / (whole + whole), 0.0, 1.0)
}

/// The slopes of the tangent planes to the right and downward; level where a part is not finite.
#[inline(always)]
fn slope<S: Simd>(simd: S, lines: &Lines<'_>, first: usize) -> [f32x16<S>; 2] {
    let [left, right, above, below] = lines.around;
    let x = (load(simd, right, first) - load(simd, left, first)) * lines.scale[0];
    let y = (load(simd, below, first) - load(simd, above, first)) * lines.scale[1];
    let is_finite = (x.abs() + y.abs()).simd_le(f32::MAX);
    let level = f32x16::splat(simd, 0.0);
    [is_finite.select(x, level), is_finite.select(y, level)]
}

/// The largest slope to a sample of a ray, from that of the tangent plane on. What is not a number is not larger.
#[inline(always)]
fn horizon<S: Simd>(
    simd: S,
    view: &View<'_>,
    here: f32x16<S>,
    first: usize,
    tangent: f32x16<S>,
) -> f32x16<S> {
    let mut horizon = tangent;
    for line in &view.samples {
        let mut height = load(simd, line.near, first);
        if line.part > 0.0 {
            height = height + (load(simd, line.far, first) - height) * line.part;
        }
        let mut slope = (height - here) * line.scale;
        if line.weight < 1.0 {
            slope = tangent + (slope - tangent) * line.weight;
        }
        horizon = slope.simd_gt(horizon).select(slope, horizon);
    }
    limit(simd, horizon, -STEEPEST, STEEPEST)
}

/// The sky between the zenith and a horizon, twice over the upward part of the normal, without what opposite azimuths take
/// from each other.
#[inline(always)]
fn arc<S: Simd>(simd: S, tangent: f32x16<S>, horizon: f32x16<S>) -> f32x16<S> {
    (tangent * horizon + 1.0) / (horizon * horizon + 1.0) + tangent * arctangent(simd, horizon)
}

#[inline(always)]
fn load<S: Simd>(simd: S, line: &[f32], first: usize) -> f32x16<S> {
    f32x16::from_slice(simd, &line[first..first + LANES])
}

/// Numbers brought between two ends. Minimum and maximum of a processor would do, but differ in what is not a number.
#[inline(always)]
fn limit<S: Simd>(simd: S, x: f32x16<S>, low: f32, high: f32) -> f32x16<S> {
    let [low, high] = [f32x16::splat(simd, low), f32x16::splat(simd, high)];
    let x = x.simd_lt(low).select(low, x);
    x.simd_gt(high).select(high, x)
}
