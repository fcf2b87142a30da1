//! The weights at one position.

use crate::bins::Record;
use crate::net::{BLOCK, Net};
use crate::profile::{Cubic, Profile};
use crate::shift::shift_weights;
use crate::simd;
use crate::weight::AxialWeight;
use fearless_simd::{dispatch, f32x4, f32x8, prelude::*};
use glam::DVec2;

impl Net {
    /// Calls `take(record, weight)` for every candidate at a position that is in range, in the order in which weights are
    /// summed. Some weights are zero: which ones cannot be foreseen, so that leaving them out costs more than it saves.
    #[inline]
    pub(crate) fn for_each_weight(&self, position: DVec2, take: impl FnMut(&Record, f32)) {
        match self.options.weight {
            AxialWeight::Cubic => {
                dispatch!(simd::level(), simd => self.walk_candidates(simd, Cubic, position, take));
            }
            other => {
                dispatch!(simd::level(), simd => self.walk_candidates(simd, other, position, take));
            }
        }
    }

    /// The candidate whose center is nearest to a position; of equals, the first.
    pub(crate) fn nearest(&self, position: DVec2) -> &Record {
        let bins = self.bins();
        let distance_sq = |candidate: u32| bins.record(candidate).center.distance_squared(position);
        let nearer = |best, candidate| {
            if distance_sq(candidate) < distance_sq(best) {
                candidate
            } else {
                best
            }
        };
        let nearest = bins.candidates(position).iter().copied().reduce(nearer);
        // The support of the nearest control point covers the position, so there is one; the first is only for form.
        bins.record(nearest.unwrap_or(0))
    }

    #[inline(always)]
    fn walk_candidates<S: Simd, P: Profile>(
        &self,
        simd: S,
        profile: P,
        position: DVec2,
        mut take: impl FnMut(&Record, f32),
    ) {
        let bins = self.bins();
        for &candidate in bins.candidates(position) {
            let record = bins.record(candidate);
            let x = (position.x - record.center.x) as f32;
            let y = (position.y - record.center.y) as f32;
            let mut weight = product(simd, profile, (&record.x, &record.y), (x, y));
            if record.has_more {
                for block in &self.blocks(&self.instances[record.instance as usize])[1..] {
                    weight *= product(simd, profile, (&block.x, &block.y), (x, y));
                }
            }
            if let Some(&shift) = self.shifts.get(record.point as usize) {
                weight = shifted(simd, weight, shift, x, y);
            }
            take(record, weight);
        }
    }
}

/// The product of the axial weights of a block.
#[inline(always)]
fn product<S: Simd, P: Profile>(
    simd: S,
    profile: P,
    (ax, ay): (&[f32; BLOCK], &[f32; BLOCK]),
    (x, y): (f32, f32),
) -> f32 {
    let zero = f32x8::splat(simd, 0.0);
    let minus_one = f32x8::splat(simd, -1.0);
    let rest = zero - minus_one - f32x8::from_slice(simd, ay) * y;
    let minus_u = f32x8::from_slice(simd, ax) * x - rest;
    let minus_u = minus_u.max(minus_one).min(zero);
    let (mut q, mut t) = profile.first(minus_u.as_slice()[0]);
    for &minus_u in &minus_u.as_slice()[1..] {
        (q, t) = profile.step(q, t, minus_u);
    }
    profile.finish(q, t, BLOCK)
}

/// Equation 4 for one weight.
#[inline(always)]
fn shifted<S: Simd>(simd: S, weight: f32, shift: [f32; 2], x: f32, y: f32) -> f32 {
    let (weight, x) = (f32x4::splat(simd, weight), f32x4::splat(simd, x));
    let [weight] = shift_weights(simd, &[weight], shift, x, &[y]);
    weight.as_slice()[0]
}
