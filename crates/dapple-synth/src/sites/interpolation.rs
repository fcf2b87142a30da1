//! Interpolates values between sites (equation 1).
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.2, with
//! the weights `w(x) = 2x³ - 3x² + 1`, where x is the distance divided by the radius. The paper states neither the
//! radius nor the value where no site is in reach; see [`INTERPOLATION_RADIUS`] and
//! [`Hierarchy::interpolate`](crate::Hierarchy::interpolate).
//!
//! Differences to the value of the first site in reach are summed, so that a constant column gives exactly that
//! constant. Sites are visited in the order of [`SiteGrid::visit`](crate::SiteGrid::visit). Lengths are in units of the
//! mesh.

use super::oriented::Oriented;
use crate::{Blend, SiteIdx};
use fearless_simd::{f32x8, prelude::*};
use glam::DVec3;

/// Interpolation radius, in multiples of the level's site spacing.
///
/// The paper does not give a radius. At 1.0, most positions have three or four sites in reach. At 2.0, colors blur.
pub const INTERPOLATION_RADIUS: f64 = 1.1;

/// Minimum sum of weights. A smaller sum means that all sites are at the rim of the ball; the nearest site is then
/// used.
const WEIGHTS_LEAST: f64 = 1e-9;
/// Search radii for the nearest site if no site is in reach, in multiples of the interpolation radius.
const NEAREST_REACHES: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// Returns the weight of a site in equation 1, `w(x) = 2x³ - 3x² + 1`. `x` is the distance divided by the radius, from
/// 0 to 1.
#[inline]
pub(crate) fn weight(x: f64) -> f64 {
    (2.0 * x - 3.0) * x * x + 1.0
}

/// Returns the weights of a site in equation 1 for eight positions. `x_sq` are the squares of distances divided by the
/// radius; weights are 0 at one radius or more.
#[inline(always)]
pub(crate) fn weights<S: Simd>(simd: S, x_sq: f32x8<S>) -> f32x8<S> {
    // w(x) = 2x³ - 3x² + 1 = (2x - 3) x² + 1
    let weights = (x_sq.sqrt() * 2.0 - 3.0) * x_sq + 1.0;
    x_sq.simd_lt(1.0).select(weights, f32x8::splat(simd, 0.0))
}

impl Oriented<'_> {
    /// Returns the weighted mean of the values around `position`, or the value of the nearest site if none is in reach.
    /// `None` if no site is within 8 radii.
    ///
    /// `column` has one value per site.
    #[inline]
    pub(crate) fn interpolate<T: Blend>(
        &self,
        column: &[T],
        position: DVec3,
        normal: DVec3,
    ) -> Option<T> {
        let radius = INTERPOLATION_RADIUS * self.spacing;
        let (mut base, mut sum, mut weights) = (None, T::ZERO, 0.0);
        // Sum up weighted differences to the value of the first site in reach.
        self.grid.visit(position, radius, |site| {
            let x = self.positions[site.index()].distance(position) / radius;
            if x < 1.0 && self.is_on_side(site, normal) {
                let weight = weight(x);
                let value = column[site.index()];
                // Equation 1, rearranged: base + Σ wᵢ (Cᵢ - base) / Σ wᵢ.
                let base = *base.get_or_insert(value);
                sum = sum.add_scaled(value.add_scaled(base, -1.0), weight);
                weights += weight;
            }
        });
        match base {
            Some(base) if weights > WEIGHTS_LEAST => Some(base.add_scaled(sum, 1.0 / weights)),
            _ => self
                .nearest(position, normal)
                .map(|site| column[site.index()]),
        }
    }

    /// Returns the nearest site on the side of the surface that `normal` points to; ties go to the lowest index. `None`
    /// if all are more than 8 interpolation radii away.
    #[cold]
    fn nearest(&self, position: DVec3, normal: DVec3) -> Option<SiteIdx> {
        for reach in NEAREST_REACHES {
            // Grow the ball until it has a site; all sites outside of the ball are farther away.
            let radius = reach * INTERPOLATION_RADIUS * self.spacing;
            let mut nearest = Nearest::within(radius);
            self.grid.visit(position, radius, |site| {
                if self.is_on_side(site, normal) {
                    nearest.offer(site, self.positions[site.index()].distance(position));
                }
            });
            if nearest.site.is_some() {
                return nearest.site;
            }
        }
        None
    }

    /// Returns the site nearest to `position`, on either side of the surface. `None` if there are no sites.
    #[cold]
    pub(crate) fn nearest_of_all(&self, position: DVec3) -> Option<SiteIdx> {
        let mut nearest = Nearest::within(f64::INFINITY);
        for (site, at) in (0..).zip(self.positions) {
            nearest.offer(SiteIdx(site), at.distance(position));
        }
        nearest.site
    }

    /// Returns whether the normal of `site` is at most 90 degrees from `normal`.
    #[inline]
    fn is_on_side(&self, site: SiteIdx, normal: DVec3) -> bool {
        self.normals[site.index()].dot(normal) >= 0.0
    }
}

/// Nearest site seen so far, and its distance.
struct Nearest {
    site: Option<SiteIdx>,
    distance: f64,
}

impl Nearest {
    /// Returns an empty search that accepts sites nearer than `distance`.
    fn within(distance: f64) -> Self {
        Self {
            site: None,
            distance,
        }
    }

    /// Takes `site` if it is nearer than the best so far, or as near with a lower index.
    #[inline]
    fn offer(&mut self, site: SiteIdx, distance: f64) {
        let is_first = self.site.is_none_or(|nearest| site < nearest);
        if distance < self.distance || distance == self.distance && is_first {
            (self.site, self.distance) = (Some(site), distance);
        }
    }
}

#[cfg(test)]
mod tests;
