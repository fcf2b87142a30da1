//! Computes the sweep distances of a single level.

use super::Distances;
use crate::links::Links;
use crate::parents::Parents;
use crate::solve::{System, conjugate_gradients};
use crate::{Hierarchy, Orientation, SiteIdx, Symmetry, columns};
use glam::DVec3;

/// Solver tolerance on the coarsest level, in multiples of the site spacing. The solver stops when another sweep of
/// equation 5 would change no distance by more.
const TOLERANCE: f64 = 1e-6;
/// Maximum number of solver steps. It bounds the time if the coarsest level is large.
const STEPS_MAX: usize = 500;
/// Number of sweeps of equation 5 on every finer level.
const SWEEPS: usize = 20;
/// Sum of the β in equation 5; α is 1 minus this.
const SWEEP_STRENGTH: f64 = 0.8;

/// Number of solves on the coarsest level in iteratively reweighted least squares. Each solve derives its edge weights
/// from the previous solution.
const ROUNDS: usize = 3;

/// Linear system of equation 5 on a level.
pub(super) struct LevelSweep<'a> {
    hierarchy: &'a Hierarchy,
    level: usize,
    orientation: &'a Orientation,
    links: Links<'a>,
    /// Right-hand side of the system. For each site, this is the weighted sum of its leads over its neighbors along the
    /// field.
    ahead: Vec<f64>,
    /// Spacing of the level, in units of the mesh.
    spacing: f64,
}

impl<'a> LevelSweep<'a> {
    pub(super) fn new(
        hierarchy: &'a Hierarchy,
        orientation: &'a Orientation,
        level: usize,
    ) -> Self {
        Self {
            hierarchy,
            level,
            orientation,
            links: links(hierarchy, orientation, level),
            ahead: Vec::new(),
            spacing: hierarchy.levels()[level].spacing(),
        }
    }

    /// Solves for the distances of the coarsest level.
    pub(super) fn solve(mut self, components: &[u32], anchor: Option<SiteIdx>) -> Vec<f64> {
        let mut distances = vec![0.0; self.links.len()];
        let mut assigned = vec![false; self.links.len()];
        // Start at the anchor of each component, which is the given anchor or the lowest site.
        let anchored = anchor.map(|site| (site.index(), components[site.index()]));
        for (site, component) in lowest_sites(components) {
            let site = anchored
                .filter(|&(_, of_anchor)| of_anchor == component)
                .map_or(site, |(anchor, _)| anchor);
            assigned[site] = true;
        }
        self.fill(&mut assigned, &mut distances);
        // Solve, with edge weights from the previous distances.
        for round in 0..ROUNDS {
            if round > 0 {
                self.links = links(self.hierarchy, self.orientation, self.level);
            }
            self.ease(&distances);
            conjugate_gradients(&self, &mut distances, STEPS_MAX);
        }
        distances
    }

    /// Computes the distances of a finer level from the next coarser one.
    ///
    /// If a component of this level consists of several components on the coarser level, only the coarser component of
    /// its lowest site is inherited. The distances of the others are not comparable.
    pub(super) fn refine(mut self, components: &[u32], coarser: &Distances) -> Vec<f64> {
        let n_coarser = coarser.distances.len();
        // For each component, find the coarser component whose distances it inherits.
        let pieces: Vec<Option<u32>> = lowest_sites(components)
            .map(|(site, _)| coarser.components.get(site).copied())
            .collect();
        let inherits =
            |site: usize| pieces[components[site] as usize] == Some(coarser.components[site]);
        let inherited: Vec<Option<f64>> = columns::column(self.links.len(), |site| {
            // Copy the distances of shared sites, and interpolate the others.
            if site < n_coarser {
                inherits(site).then(|| coarser.distances[site])
            } else {
                self.inherit(site, &coarser.distances, inherits)
            }
        });
        let mut assigned: Vec<bool> = inherited.iter().map(Option::is_some).collect();
        let mut distances: Vec<f64> = inherited
            .into_iter()
            .map(Option::unwrap_or_default)
            .collect();
        // A component without a coarser one starts at its lowest site, with distance 0.
        for (site, component) in lowest_sites(components) {
            if pieces[component as usize].is_none() {
                assigned[site] = true;
            }
        }
        self.fill(&mut assigned, &mut distances);
        self.ease(&distances);
        let mut before = distances.clone();
        // Relax with sweeps of equation 5.
        for _ in 0..SWEEPS {
            core::mem::swap(&mut before, &mut distances);
            columns::update(&mut distances, |site, distance| {
                *distance = self.sweep(site, &before);
            });
        }
        distances
    }

    /// Returns the distance of `site` as predicted by the coarser sites around it. `None` if there is no coarser site
    /// for which `inherits` is true.
    fn inherit(
        &self,
        site: usize,
        coarser: &[f64],
        inherits: impl Fn(usize) -> bool + Copy,
    ) -> Option<f64> {
        let parents = Parents::new(self.hierarchy, self.level, SiteIdx(site as u32));
        let (normals, orientation) = (self.hierarchy.sites().normals(), self.orientation);
        let is_cut = |parent| orientation.quarters_toward(normals, site, parent, 0) != 0;
        let believers = parents
            .iter()
            .filter(|&(parent, _)| inherits(parent) && !is_cut(parent));
        self.consensus(site, believers, coarser)
    }

    /// Assigns distances to all sites that are connected to assigned ones, breadth first. Each uses equation 5 with its
    /// assigned neighbors only. Sites that cuts separate from all assigned sites start at 0.
    fn fill(&self, assigned: &mut [bool], distances: &mut [f64]) {
        let opinion = |site, assigned: &[bool], distances: &[f64]| {
            let neighbors = self.links.neighbors(site).iter();
            let weights = self.links.weights(site).iter().copied();
            let believers = neighbors
                .map(|other| other.index())
                .zip(weights)
                .filter(|&(other, _)| assigned[other]);
            self.consensus(site, believers, distances)
                .unwrap_or_default()
        };
        self.links.fill(assigned, distances, opinion);
        if self.orientation.symmetry() == Symmetry::One {
            // Without cuts, links connect all sites of a component to an assigned one.
            return;
        }
        for site in 0..assigned.len() {
            if !assigned[site] {
                assigned[site] = true;
                self.links.fill(assigned, distances, opinion);
            }
        }
    }

    /// Returns the distance of `site` as the weighted mean of the predictions of other sites, `believers`. Predictions
    /// that disagree with the one with the largest weight count less.
    #[inline]
    fn consensus(
        &self,
        site: usize,
        believers: impl Iterator<Item = (usize, f64)> + Clone,
        distances: &[f64],
    ) -> Option<f64> {
        let (mut leader, mut most) = (site, 0.0);
        // Find the prediction with the largest weight.
        for (other, weight) in believers.clone() {
            if weight > most {
                (leader, most) = (other, weight);
            }
        }
        if leader == site {
            return None;
        }
        let first = distances[leader] + self.step(site, leader);
        // Average the differences to it, weighted down where they are large.
        let (mut sum, mut weights) = (0.0, most);
        for (other, weight) in believers {
            if other != leader {
                let difference = distances[other] + self.step(site, other) - first;
                let weight = weight * trust(difference, self.spacing);
                sum += difference * weight;
                weights += weight;
            }
        }
        Some(first + sum / weights)
    }

    /// Lowers the weights of edges whose ends disagree, and updates `ahead`.
    fn ease(&mut self, distances: &[f64]) {
        let (sites, vectors) = (self.hierarchy.sites(), self.orientation.vectors());
        let (positions, normals) = (sites.positions(), sites.normals());
        let spacing = self.spacing;
        self.ahead = self.links.reweigh(|site, neighbors, weights| {
            let (at, vector, normal) = (positions[site], vectors[site], normals[site]);
            let mut sum = 0.0;
            for (weight, other) in weights.iter_mut().zip(neighbors) {
                let other = other.index();
                let step = step(
                    at - positions[other],
                    vector + vectors[other],
                    normal + normals[other],
                );
                // Iteratively reweighted least squares: edges that the last solution violates count less.
                *weight *= trust(distances[site] - distances[other] - step, spacing);
                sum += step * *weight;
            }
            sum
        });
    }

    /// Computes one sweep of equation 5 for `site`.
    #[inline]
    fn sweep(&self, site: usize, distances: &[f64]) -> f64 {
        let sum = self.links.sums()[site];
        if sum == 0.0 {
            return distances[site];
        }
        // Equation 5: the weighted mean of s(w) + Δ over the neighbors w.
        let average = (self.neighbors_sum(site, distances) + self.ahead[site]) / sum;
        distances[site] * (1.0 - SWEEP_STRENGTH) + average * SWEEP_STRENGTH
    }

    /// Returns the weighted sum of the distances of the neighbors of `site`.
    #[inline]
    fn neighbors_sum(&self, site: usize, distances: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (other, weight) in self
            .links
            .neighbors(site)
            .iter()
            .zip(self.links.weights(site))
        {
            sum += distances[other.index()] * *weight;
        }
        sum
    }

    /// Returns the lead of `site` over `other` along the field, in units of the mesh; 0 if their orientations cancel.
    /// This is the paper's Δ.
    #[inline]
    fn step(&self, site: usize, other: usize) -> f64 {
        let vectors = self.orientation.vectors();
        let (positions, normals) = (
            self.hierarchy.sites().positions(),
            self.hierarchy.sites().normals(),
        );
        step(
            positions[site] - positions[other],
            vectors[site] + vectors[other],
            normals[site] + normals[other],
        )
    }
}

/// Builds the links of `level`, with weight 0 where they cross a cut of the field.
fn links<'a>(hierarchy: &'a Hierarchy, orientation: &Orientation, level: usize) -> Links<'a> {
    let mut links = Links::new(hierarchy, level);
    let normals = hierarchy.sites().normals();
    if orientation.symmetry() != Symmetry::One {
        links.reweigh(|site, neighbors, weights| {
            for (weight, other) in weights.iter_mut().zip(neighbors) {
                let there = orientation.quarters_toward(normals, other.index(), site, 0);
                let here = orientation.quarters_toward(normals, site, other.index(), 0);
                // Test from both ends, since weights must be symmetric.
                if here != 0 || there != 0 {
                    *weight = 0.0;
                }
            }
        });
    }
    links
}

/// Returns the Cauchy weight of a prediction that is off by `difference`. It is 1/2 if `difference` equals `spacing`.
#[inline]
fn trust(difference: f64, spacing: f64) -> f64 {
    let x = difference / spacing;
    1.0 / (1.0 + x * x)
}

/// Projects `sum` to the plane perpendicular to `normal`, and returns the component of `way` along the projection; 0 if
/// the projection vanishes.
#[inline]
pub(super) fn step(way: DVec3, sum: DVec3, normal: DVec3) -> f64 {
    let up = normal.length_squared();
    // Drop the component of the summed orientations along the normal.
    let consensus = if up > 0.0 {
        sum - normal * (sum.dot(normal) / up)
    } else {
        sum
    };
    // The paper's Δ: the component of the offset along the consensus orientation, which has unit length.
    let length = consensus.length();
    if length > 1e-9 {
        way.dot(consensus) / length
    } else {
        0.0
    }
}

/// Returns, for every component in ascending order, its lowest site and its index.
fn lowest_sites(components: &[u32]) -> impl Iterator<Item = (usize, u32)> {
    let mut next = 0;
    components
        .iter()
        .copied()
        .enumerate()
        .filter(move |&(_, component)| {
            let is_first = component == next;
            next += u32::from(is_first);
            is_first
        })
}

impl System<f64> for LevelSweep<'_> {
    #[inline]
    fn row(&self, column: &[f64], row: usize) -> f64 {
        // A row of the graph Laplacian. With the leads on the right-hand side, the solution satisfies equation 5.
        column[row] * self.links.sums()[row] - self.neighbors_sum(row, column)
    }

    fn right(&self, row: usize) -> f64 {
        self.ahead[row]
    }

    fn diagonal(&self, row: usize) -> f64 {
        self.links.sums()[row]
    }

    fn is_near(&self, _value: f64, change: f64) -> bool {
        change.abs() <= TOLERANCE * self.spacing
    }
}
