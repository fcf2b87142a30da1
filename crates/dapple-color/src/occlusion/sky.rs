//! Computes the visible sky for a row of pixels, in registers of adjacent pixels.

use super::lines::{Lines, View};
use crate::arctangent::arctangent;
use fearless_simd::{f32x16, prelude::*};

/// Number of columns in a register.
const LANES: usize = 16;

/// Number of registers processed together, so that the data of a sample is read once for all of them.
const SIDE: usize = 2;

/// Number of columns processed together.
pub(super) const COLUMNS: usize = SIDE * LANES;

/// Maximum slope, to which larger ones are clamped. Its square is far from the limit of `f32`.
const STEEPEST: f32 = 1e9;

/// Computes the visible fraction of the sky for a row of pixels.
#[inline(always)]
pub(super) fn see_row<S: Simd>(simd: S, lines: &Lines<'_>, values: &mut [f32]) {
    for (values, first) in values.chunks_mut(COLUMNS).zip((0..).step_by(COLUMNS)) {
        let seen = see(simd, lines, first);
        for (register, values) in values.chunks_mut(LANES).enumerate() {
            let seen: [f32; LANES] = seen[register].into();
            values.copy_from_slice(&seen[..values.len()]);
        }
    }
}

/// Returns the visible fraction of the sky for the columns starting at `first`.
#[inline(always)]
fn see<S: Simd>(simd: S, lines: &Lines<'_>, first: usize) -> [f32x16<S>; SIDE] {
    let zero = f32x16::splat(simd, 0.0);
    let mut here = [zero; SIDE];
    let mut slopes = [[zero; 2]; SIDE];
    // Load the heights and the slopes of the tangent planes.
    for register in 0..SIDE {
        let first = first + register * LANES;
        here[register] = load(simd, lines.here, first);
        slopes[register] = slope(simd, lines, first);
    }
    let (mut seen, mut whole) = ([zero; SIDE], [zero; SIDE]);
    // Add the visible sky of each pair of opposite azimuths, and the sky above the tangent plane.
    for [there, back] in lines.views.as_chunks::<2>().0 {
        let [x, y] = there.direction;
        let (mut tangents, mut opposite) = ([zero; SIDE], [zero; SIDE]);
        for register in 0..SIDE {
            let [across, down] = slopes[register];
            tangents[register] = limit(simd, across * x + down * y, -STEEPEST, STEEPEST);
            opposite[register] = -tangents[register];
        }
        let ahead = horizons(simd, there, &here, first, &tangents);
        let behind = horizons(simd, back, &here, first, &opposite);
        for register in 0..SIDE {
            let (tangent, opposite) = (tangents[register], opposite[register]);
            seen[register] +=
                arc(simd, tangent, ahead[register]) + arc(simd, opposite, behind[register]);
            whole[register] += tangent * arctangent(simd, tangent) + 1.0;
        }
    }
    // Normalize by the sky above the tangent plane.
    for register in 0..SIDE {
        let part = seen[register] / (whole[register] + whole[register]);
        seen[register] = limit(simd, part, 0.0, 1.0);
    }
    seen
}

/// Returns the slopes of the tangent planes to the right and downward; level where a component is not finite.
#[inline(always)]
fn slope<S: Simd>(simd: S, lines: &Lines<'_>, first: usize) -> [f32x16<S>; 2] {
    let [left, right, above, below] = lines.around;
    let x = (load(simd, right, first) - load(simd, left, first)) * lines.scale[0];
    let y = (load(simd, below, first) - load(simd, above, first)) * lines.scale[1];
    let is_finite = (x.abs() + y.abs()).simd_le(f32::MAX);
    let level = f32x16::splat(simd, 0.0);
    [is_finite.select(x, level), is_finite.select(y, level)]
}

/// Returns the slopes of the horizons: the maximum slope to the samples of a ray, but at least the slope of the
/// tangent plane. NaN is ignored.
#[inline(always)]
fn horizons<S: Simd>(
    simd: S,
    view: &View<'_>,
    here: &[f32x16<S>; SIDE],
    first: usize,
    tangents: &[f32x16<S>; SIDE],
) -> [f32x16<S>; SIDE] {
    let mut horizons = *tangents;
    for line in &view.samples {
        let near = &line.near[first..first + COLUMNS];
        let far = &line.far[first..first + COLUMNS];
        for register in 0..SIDE {
            let mut height = load(simd, near, register * LANES);
            if line.part > 0.0 {
                height = height + (load(simd, far, register * LANES) - height) * line.part;
            }
            let tangent = tangents[register];
            let mut slope = (height - here[register]) * line.scale;
            if line.weight < 1.0 {
                slope = tangent + (slope - tangent) * line.weight;
            }
            let horizon = horizons[register];
            horizons[register] = slope.simd_gt(horizon).select(slope, horizon);
        }
    }
    for horizon in &mut horizons {
        *horizon = limit(simd, *horizon, -STEEPEST, STEEPEST);
    }
    horizons
}

/// Returns the amount of sky between the zenith and a horizon, in multiples of half the normal's z component. Parts of
/// the integral that cancel between opposite azimuths are omitted.
#[inline(always)]
fn arc<S: Simd>(simd: S, tangent: f32x16<S>, horizon: f32x16<S>) -> f32x16<S> {
    (tangent * horizon + 1.0) / (horizon * horizon + 1.0) + tangent * arctangent(simd, horizon)
}

#[inline(always)]
fn load<S: Simd>(simd: S, line: &[f32], first: usize) -> f32x16<S> {
    f32x16::from_slice(simd, &line[first..first + LANES])
}

/// Clamps numbers to a range. Processors differ in how their minimum and maximum treat NaN, so this uses selects.
#[inline(always)]
fn limit<S: Simd>(simd: S, x: f32x16<S>, low: f32, high: f32) -> f32x16<S> {
    let [low, high] = [f32x16::splat(simd, low), f32x16::splat(simd, high)];
    let x = x.simd_lt(low).select(low, x);
    x.simd_gt(high).select(high, x)
}
