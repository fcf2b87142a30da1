//! Push: computes the field on the coarsest level from the known directions, and refines it from there to the finest
//! level. Equations and sections are those of Turk's paper (see the parent module).
//!
//! With one direction per site, a field near its neighbors' average is found by diffusion, a linear system. With two or
//! four equivalent directions, averages depend on which ones are chosen, so `smooth.rs` finds the smoothest field
//! first, and `comb.rs` then chooses one direction per site.

use super::comb::comb;
use super::pull::Known;
use super::smooth::smoothest;
use super::{Symmetry, axis_tangent, flat_part};
use crate::links::{Links, components};
use crate::parents::Parents;
use crate::solve::{System, conjugate_gradients};
use crate::{Hierarchy, SiteIdx, columns};
use glam::DVec3;

/// Tolerance of the diffusion, in radians. The solver stops when another averaging step would rotate no vector by more.
const TOLERANCE: f64 = 1e-5;
/// Maximum number of solver steps. It bounds the time if the coarsest level is large.
const STEPS_MAX: usize = 500;
/// Number of sweeps of equation 4 on each finer level.
const SWEEPS: usize = 4;
/// Weight of the neighbors' average in a sweep, from 0 to 1.
const SWEEP_STRENGTH: f64 = 0.8;

/// Computes a unit tangent vector for every site from the known directions of every level.
pub(super) fn push(
    hierarchy: &Hierarchy,
    pulled: &[Vec<Known>],
    axis: DVec3,
    symmetry: Symmetry,
) -> Vec<DVec3> {
    let mut vectors = Vec::new();
    for (level, known) in pulled.iter().enumerate().rev() {
        let links = Links::new(hierarchy, level);
        let field = Field {
            links: &links,
            normals: hierarchy.sites().normals(),
            axis,
            symmetry,
        };
        // Solve on the coarsest level, and refine the result on all others.
        if level + 1 == pulled.len() {
            vectors = match symmetry {
                Symmetry::One => field.diffuse(known),
                _ => field.smoothest(&components(hierarchy.levels()[level].graph()), known),
            };
        } else {
            vectors = field.refine(hierarchy, level, &vectors, known);
        }
    }
    // Orient components along the axis whose vectors are still zero: those without a known direction. The smoothest
    // fields have oriented all components of the coarsest level, so only those without a site there remain.
    let normals = hierarchy.sites().normals();
    columns::update(&mut vectors, |site, vector| {
        if *vector == DVec3::ZERO {
            *vector = axis_tangent(axis, normals[site]);
        }
    });
    vectors
}

/// Context of a level: its weighted edges, the normals of the tangent planes, the axis and the symmetry.
pub(super) struct Field<'a> {
    pub(super) links: &'a Links<'a>,
    pub(super) normals: &'a [DVec3],
    pub(super) axis: DVec3,
    pub(super) symmetry: Symmetry,
}

impl Field<'_> {
    /// Diffuses the known directions over the coarsest level. Returns unit vectors at the sites that are connected to a
    /// known site; zero at the others.
    fn diffuse(&self, known: &[Known]) -> Vec<DVec3> {
        let n_sites = self.links.len();
        let mut vectors = vec![DVec3::ZERO; n_sites];
        let mut is_fixed = vec![false; n_sites];
        for known in known {
            vectors[known.site] = known.vector;
            is_fixed[known.site] = true;
        }
        let mut assigned = is_fixed.clone();
        // Initialize breadth first from the known sites.
        self.fill(&mut assigned, &mut vectors);
        // Exclude components without a direction from the system.
        for (fixed, assigned) in is_fixed.iter_mut().zip(&assigned) {
            *fixed |= !assigned;
        }
        let system = Diffusion {
            field: self,
            is_fixed,
        };
        conjugate_gradients(&system, &mut vectors, STEPS_MAX);
        // Normalize the solution.
        columns::update(&mut vectors, |site, vector| {
            if assigned[site] {
                *vector = self.unit(site, *vector);
            }
        });
        vectors
    }

    /// Returns the smoothest field on the coarsest level that has the known directions, after combing.
    fn smoothest(&self, components: &[u32], known: &[Known]) -> Vec<DVec3> {
        let mut vectors = smoothest(self, components, known);
        comb(self, &mut vectors);
        vectors
    }

    /// Upsamples a field to a finer level. Returns unit vectors at the sites that are connected to a site with a
    /// vector, and zero elsewhere.
    fn refine(
        &self,
        hierarchy: &Hierarchy,
        level: usize,
        coarser: &[DVec3],
        known: &[Known],
    ) -> Vec<DVec3> {
        // Copy the vectors of shared sites, and interpolate the others.
        let mut vectors = columns::column(self.links.len(), |site| {
            coarser
                .get(site)
                .copied()
                .unwrap_or_else(|| self.inherit(hierarchy, level, site, coarser))
        });
        self.mix(&mut vectors, known);
        let mut assigned: Vec<bool> = vectors
            .iter()
            .map(|&vector| vector != DVec3::ZERO)
            .collect();
        self.fill(&mut assigned, &mut vectors);
        let mut before = vectors.clone();
        // Smooth with sweeps of equation 4, and mix in the known directions after each.
        for _ in 0..SWEEPS {
            core::mem::swap(&mut before, &mut vectors);
            columns::update(&mut vectors, |site, vector| {
                *vector = if assigned[site] {
                    self.sweep(site, &before)
                } else {
                    DVec3::ZERO
                };
            });
            self.mix(&mut vectors, known);
        }
        vectors
    }

    /// Returns the weighted mean direction of the coarser sites around `site`, as a unit vector; zero if they have no
    /// direction.
    fn inherit(
        &self,
        hierarchy: &Hierarchy,
        level: usize,
        site: usize,
        coarser: &[DVec3],
    ) -> DVec3 {
        let parents = Parents::new(hierarchy, level, SiteIdx(site as u32));
        let sum = self.sum(parents.iter(), coarser);
        flat_part(sum, self.normals[site]).normalize_or_zero()
    }

    /// Assigns a direction to every site that is connected to an assigned one, breadth first.
    fn fill(&self, assigned: &mut [bool], vectors: &mut [DVec3]) {
        self.links
            .fill(assigned, vectors, |site, assigned, vectors| {
                let near = self.near(site).filter(|&(other, _)| assigned[other]);
                self.unit(site, self.sum(near, vectors))
            });
    }

    /// Computes one sweep of equation 4 for `site`: the relaxed average of vectors, projected and normalized.
    #[inline]
    fn sweep(&self, site: usize, vectors: &[DVec3]) -> DVec3 {
        let sum = self.links.sums()[site];
        if sum == 0.0 {
            return vectors[site];
        }
        // Equation 4 with α = 1 - strength, and the βᵢ as the normalized weights times the strength.
        let average = self.neighbor_sum(site, vectors) * (SWEEP_STRENGTH / sum);
        self.unit(site, vectors[site] * (1.0 - SWEEP_STRENGTH) + average)
    }

    /// Returns the weighted sum of the neighbors' vectors, each rotated to the equivalent direction nearest to the
    /// site's vector.
    #[inline]
    fn neighbor_sum(&self, site: usize, vectors: &[DVec3]) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (other, weight) in self.near(site) {
            let vector = vectors[other];
            sum += self
                .symmetry
                .nearest(vector, self.normals[other], vectors[site])
                * weight;
        }
        sum
    }

    /// Returns the weighted sum of vectors, each rotated to the equivalent direction nearest to the vector with the
    /// largest weight.
    fn sum(&self, near: impl Iterator<Item = (usize, f64)> + Clone, vectors: &[DVec3]) -> DVec3 {
        let (mut leader, mut most) = (DVec3::ZERO, 0.0);
        for (other, weight) in near.clone() {
            if weight > most {
                (leader, most) = (vectors[other], weight);
            }
        }
        let mut sum = DVec3::ZERO;
        for (other, weight) in near {
            sum += self
                .symmetry
                .nearest(vectors[other], self.normals[other], leader)
                * weight;
        }
        sum
    }

    /// Returns the neighbors of `site` with their weights.
    #[inline]
    fn near(&self, site: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        let neighbors = self.links.neighbors(site).iter();
        let weights = self.links.weights(site).iter().copied();
        neighbors.map(|other| other.index()).zip(weights)
    }

    /// Returns the unit tangent vector along `vector`, a sum of vectors. If the sum cancels, returns the tangent along
    /// the axis.
    #[inline]
    pub(super) fn unit(&self, site: usize, vector: DVec3) -> DVec3 {
        let normal = self.normals[site];
        flat_part(vector, normal)
            .try_normalize()
            .unwrap_or_else(|| axis_tangent(self.axis, normal))
    }

    /// Mixes in the known directions by their weights. At a weight of 1 the known direction replaces the vector.
    fn mix(&self, vectors: &mut [DVec3], known: &[Known]) {
        for known in known {
            let vector = vectors[known.site];
            let turned = self
                .symmetry
                .nearest(known.vector, self.normals[known.site], vector);
            let mixed = vector * (1.0 - known.weight) + turned * known.weight;
            vectors[known.site] = mixed.normalize_or(turned);
        }
    }
}

/// Linear system of the diffusion. At the solution, every free vector equals the projected average of its neighbors;
/// fixed vectors do not change.
struct Diffusion<'a> {
    field: &'a Field<'a>,
    is_fixed: Vec<bool>,
}

impl System<DVec3> for Diffusion<'_> {
    #[inline]
    fn row(&self, column: &[DVec3], row: usize) -> DVec3 {
        if self.is_fixed[row] {
            return DVec3::ZERO;
        }
        // Equation 4 at rest, with the projection of section 4.1: Σ wᵢ v is the projected Σ wᵢ vᵢ.
        let sum = self.field.neighbor_sum(row, column);
        column[row] * self.field.links.sums()[row] - flat_part(sum, self.field.normals[row])
    }

    fn right(&self, _row: usize) -> DVec3 {
        DVec3::ZERO
    }

    fn diagonal(&self, row: usize) -> f64 {
        if self.is_fixed[row] {
            0.0
        } else {
            self.field.links.sums()[row]
        }
    }

    fn is_near(&self, value: DVec3, change: DVec3) -> bool {
        change.length_squared() <= TOLERANCE * TOLERANCE * value.length_squared()
    }
}
