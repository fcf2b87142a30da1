//! Computes weights at a single position.
//!
//! Candidates are evaluated in groups of eight. First, the axes of one candidate at a time are projected, eight axes
//! per register. The registers are then transposed so that each holds one axis of all candidates, and the products of
//! all candidates are computed in parallel.

use crate::bins::{Bins, Candidates, GROUP};
use crate::net::{AxisBlock, Exponents, Net};
use crate::power::powers;
use crate::profile::{Cubic, Profile, minus_u};
use crate::shift::shift_weights;
use crate::weight::AxialWeight;
use dapple_raster::simd;
use dapple_raster::simd::dispatch;
use fearless_simd::{f32x4, f32x8, prelude::*};
use glam::DVec2;

/// Callback that receives the record indices and the weights of a group of candidates.
type TakeGroup<'a> = dyn FnMut(&[u32; GROUP], &[f32; GROUP]) + 'a;

impl Net {
    /// Folds over the weights of all candidates at a position, in the order of summation.
    /// `take(state, record, weight)` returns the next state. The position must be in range; `record` is an index in
    /// the [`Bins`]. Zero weights are included, since unpredictable branches would cost more than skipping them saves.
    #[inline]
    pub(crate) fn fold_weights<A: Copy>(
        &self,
        position: DVec2,
        mut state: A,
        mut take: impl FnMut(A, usize, f32) -> A,
    ) -> A {
        self.for_each_group(position, &mut |records, weights| {
            for (&record, &weight) in records.iter().zip(weights) {
                state = take(state, record as usize, weight);
            }
        });
        state
    }

    /// Calls `take` with the records and weights of each group of candidates. Not generic, so it is compiled once for
    /// all uses of the weights.
    fn for_each_group(&self, position: DVec2, take: &mut TakeGroup<'_>) {
        match self.options.weight {
            AxialWeight::Cubic => {
                dispatch!(simd::level(), simd => self.walk(simd, Cubic, position, take));
            }
            other => {
                dispatch!(simd::level(), simd => self.walk(simd, other, position, take));
            }
        }
    }

    /// Returns the control point nearest to a position. If several are equally near, returns the first.
    pub(crate) fn nearest(&self, position: DVec2) -> u32 {
        let bins = self.bins();
        // The support of the nearest control point contains the position, so one is found; the initial index is unused.
        let mut nearest = (f64::INFINITY, 0);
        let mut candidates = bins.first_candidates(position);
        loop {
            for (&record, one) in candidates.records.iter().zip(candidates.ones) {
                let distance_sq = bins.centers[record as usize].distance_squared(position);
                if one > 0.0 && distance_sq < nearest.0 {
                    nearest = (distance_sq, bins.points[record as usize]);
                }
            }
            match candidates.next {
                Some(next) => candidates = bins.next_candidates(next),
                None => return nearest.1,
            }
        }
    }

    #[inline(always)]
    fn walk<S: Simd, P: Profile>(
        &self,
        simd: S,
        profile: P,
        position: DVec2,
        take: &mut TakeGroup<'_>,
    ) {
        let bins = self.bins();
        let mut candidates = bins.first_candidates(position);
        loop {
            let weights = self.weights_of(simd, profile, bins, &candidates, position);
            take(&candidates.records, &weights);
            match candidates.next {
                Some(next) => candidates = bins.next_candidates(next),
                None => return,
            }
        }
    }

    /// Computes the weights of a group of candidates; 0 in unused lanes.
    #[inline(always)]
    fn weights_of<S: Simd, P: Profile>(
        &self,
        simd: S,
        profile: P,
        bins: &Bins,
        candidates: &Candidates,
        position: DVec2,
    ) -> [f32; GROUP] {
        // Project the position onto the axes of the first block of each candidate.
        let mut projections = [f32x8::splat(simd, 0.0); GROUP];
        let mut offsets = [[0.0; GROUP]; 2];
        for lane in 0..GROUP {
            let record = candidates.records[lane] as usize;
            let (axes, center) = (&bins.axes[record], bins.centers[record]);
            let offset = [position.x - center.x, position.y - center.y].map(|axis| axis as f32);
            projections[lane] = project(simd, axes, offset);
            // Separate arrays let the compiler pass both numbers in registers; a pair would wait for a store.
            (offsets[0][lane], offsets[1][lane]) = (offset[0], offset[1]);
        }
        // Multiply the axial weights of all candidates.
        let weights = profile.product(transposed(projections));
        let weights = weights * f32x8::from_slice(simd, &candidates.ones);
        let mut weights: [f32; GROUP] = weights.into();
        // Apply further blocks of axes and orientations, candidate by candidate.
        if candidates.long != 0 || !self.shifts.is_empty() {
            for lane in 0..GROUP {
                let record = candidates.records[lane] as usize;
                let offset = [offsets[0][lane], offsets[1][lane]];
                if candidates.long >> lane & 1 != 0 {
                    let instance = &self.instances[bins.instances[record] as usize];
                    let (blocks, exponents) = (self.blocks(instance), self.exponents(instance));
                    weights[lane] = go_on(simd, profile, weights[lane], blocks, exponents, offset);
                }
                if let Some(&shift) = self.shifts.get(bins.points[record] as usize) {
                    weights[lane] = shifted(simd, weights[lane], shift, offset);
                }
            }
        }
        weights
    }
}

/// Computes `−u` along each axis of a block, at an offset `[x, y]` from the control point.
#[inline(always)]
fn project<S: Simd>(simd: S, axes: &AxisBlock, [x, y]: [f32; 2]) -> f32x8<S> {
    // Group the terms as everywhere in this crate, (1 − a_y d_y) − a_x d_x, so that the bits agree.
    let rest = f32x8::splat(simd, 1.0) - f32x8::from_slice(simd, &axes.y) * y;
    minus_u(simd, f32x8::from_slice(simd, &axes.x) * x, rest)
}

/// Completes the weight of a control point with several blocks of axes: multiplies `weight`, the product of the first
/// block, by the products of the other `blocks`.
#[inline(always)]
fn go_on<S: Simd, P: Profile>(
    simd: S,
    profile: P,
    mut weight: f32,
    blocks: &[AxisBlock],
    exponents: &[Exponents],
    offset: [f32; 2],
) -> f32 {
    for (index, block) in blocks.iter().enumerate().skip(1) {
        let minus_u = project(simd, block, offset);
        // Fading axes come first in their block, so the first exponent tells whether any axis fades.
        weight *= match exponents.get(index) {
            Some(exponents) if exponents[0] < 1.0 => faded(simd, profile, exponents, minus_u),
            _ => profile.product::<f32>(minus_u.into()),
        };
    }
    weight
}

/// Returns the product of the axial weights of a block, each raised to the exponent of its axis.
#[inline(always)]
fn faded<S: Simd, P: Profile>(
    simd: S,
    profile: P,
    exponents: &Exponents,
    minus_u: f32x8<S>,
) -> f32 {
    let weights = [profile.single(minus_u)];
    let [weights] = powers(simd, &weights, &[f32x8::from_slice(simd, exponents)]);
    let mut product = 1.0;
    for (&weight, &exponent) in weights.as_slice().iter().zip(exponents) {
        // Unused slots have the exponent 1.
        if exponent < 1.0 {
            product *= weight;
        }
    }
    product
}

/// Transposes eight registers: register `i` of the result holds lane `i` of every register.
#[inline(always)]
fn transposed<S: Simd>(rows: [f32x8<S>; GROUP]) -> [f32x8<S>; GROUP] {
    let mut from = rows;
    // Interleaving the two halves of the registers (a perfect shuffle) three times transposes them.
    for _ in 0..3 {
        let mut to = from;
        for i in 0..GROUP / 2 {
            to[2 * i] = from[i].zip_low(from[i + GROUP / 2]);
            to[2 * i + 1] = from[i].zip_high(from[i + GROUP / 2]);
        }
        from = to;
    }
    from
}

/// Shifts one weight by its orientation (equation 4).
#[inline(always)]
fn shifted<S: Simd>(simd: S, weight: f32, shift: [f32; 2], [x, y]: [f32; 2]) -> f32 {
    let (weight, x) = (f32x4::splat(simd, weight), f32x4::splat(simd, x));
    let [weight] = shift_weights(simd, &[weight], shift, x, &[y]);
    weight.as_slice()[0]
}
