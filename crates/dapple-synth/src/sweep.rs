//! How far downstream every site is: the order in which sites get their colors.
//!
//! Source: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, section 4.2,
//! <https://doi.org/10.1145/383259.383297>.
//!
//! All of the method: from an anchor on, sites are assigned the distance along the field that their assigned neighbors
//! believe in (equation 5), first on the coarsest level and then, from interpolated values, on every finer one. The
//! consensus orientation of two sites lies in the plane of their mean normal, so that both believe in the same
//! difference. Where the paper is silent or slow:
//!
//! * the coarsest level is assigned breadth first and then solved, not repeated until it settles, as that takes as many
//!   sweeps as the square of the number of sites across the surface;
//! * interpolation adds how far the site is ahead of those it takes its value from, and 20 sweeps of equation 5 with
//!   0.2 for α and 0.8 for the sum of the β do the rest;
//! * where the field turns around a point or runs around a tube, no distance increases along it everywhere. The best mean
//!   would not increase at all there, so neighbors count less that disagree by about a spacing or more (Cauchy's weights):
//!   all the error gathers in a tear, a line along which the order jumps, and the distance increases everywhere else;
//! * across the cuts of a field with a symmetry, where the next direction is another turn, sites believe nothing of each
//!   other; the cuts join singularities, so that nearly all of a component is still reached;
//! * every connected component of a level has an anchor of its own, and the order goes through one component after the
//!   other.
//!
//! Distances are in units of the mesh.

mod level;
#[cfg(test)]
mod tests;

use crate::links::components;
use crate::{Hierarchy, Orientation, SiteIdx, SynthError, SynthErrorKind};
use dapple_raster::parallel;
use level::LevelSweep;

/// The sweep distance s at every site, for every level.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The finest level first.
    levels: Vec<Distances>,
}

/// Sweep distances and components of the sites of a level.
#[derive(Clone, Debug, PartialEq)]
struct Distances {
    /// The sweep distances.
    distances: Vec<f64>,
    /// The connected components, numbered in the order of their lowest sites.
    components: Vec<u32>,
}

impl Sweep {
    /// Measures from an anchor: the one given in its component, and the site with the lowest number in every other.
    ///
    /// Sites are scattered at random, so that the lowest is as good as any; the anchor hardly matters but for where the
    /// distance is zero.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if there is no such site, and [`SynthErrorKind::Count`] if the orientation is not one of
    /// this hierarchy.
    pub fn new(
        hierarchy: &Hierarchy,
        orientation: &Orientation,
        anchor: Option<SiteIdx>,
    ) -> Result<Self, SynthError> {
        let n_sites = hierarchy.sites().len();
        if let Some(site) = anchor {
            let holds = site.index() < n_sites;
            SynthError::check(holds, "anchor", f64::from(site.0), "the number of a site")?;
        }
        let count = orientation.vectors().len();
        if count != n_sites {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "vectors of the orientation",
                count,
                needed: "as many as sites",
            }));
        }
        let mut levels: Vec<Distances> = Vec::new();
        for level in (0..hierarchy.levels().len()).rev() {
            let sweep = LevelSweep::new(hierarchy, orientation, level);
            let components = components(hierarchy.levels()[level].graph());
            let distances = match levels.last() {
                None => sweep.solve(&components, coarse_anchor(hierarchy, level, anchor)),
                Some(coarser) => sweep.refine(&components, coarser),
            };
            levels.push(Distances {
                distances,
                components,
            });
        }
        levels.reverse();
        let mut sweep = Self { levels };
        sweep.measure_from(anchor);
        Ok(sweep)
    }

    /// The distances of the sites of a level, in units of the mesh; 0 at the anchor.
    ///
    /// Those of different components have nothing in common.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    #[must_use]
    pub fn distances(&self, level: usize) -> &[f64] {
        &self.levels[level].distances
    }

    /// The sites of a level in the order of the sweep: component by component in the order of their lowest sites, in each
    /// by distance, and of several at one distance the lowest first.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    #[must_use]
    pub fn order(&self, level: usize) -> Vec<SiteIdx> {
        let Distances {
            distances,
            components,
        } = &self.levels[level];
        let mut keys: Vec<u128> = (0..)
            .zip(components.iter().zip(distances))
            .map(|(site, (&component, &distance))| {
                let site: u32 = site;
                u128::from(component) << 96 | u128::from(rising(distance)) << 32 | u128::from(site)
            })
            .collect();
        parallel::sort(&mut keys);
        keys.into_iter().map(|key| SiteIdx(key as u32)).collect()
    }

    /// Shifts every component so that its anchor on the finest level is at zero.
    fn measure_from(&mut self, anchor: Option<SiteIdx>) {
        let Some(finest) = self.levels.first() else {
            return;
        };
        let mut zeros: Vec<f64> = Vec::new();
        for (&component, &distance) in finest.components.iter().zip(&finest.distances) {
            if component as usize == zeros.len() {
                zeros.push(distance);
            }
        }
        if let Some(site) = anchor {
            zeros[finest.components[site.index()] as usize] = finest.distances[site.index()];
        }
        let of_finest = finest.components.clone();
        for level in &mut self.levels {
            // A component of a coarse level has one shift, that of its lowest site.
            let mut shifts: Vec<f64> = Vec::new();
            for (site, &component) in level.components.iter().enumerate() {
                if component as usize == shifts.len() {
                    shifts.push(zeros[of_finest[site] as usize]);
                }
                level.distances[site] -= shifts[component as usize];
            }
        }
    }
}

/// The site of a level that stands for the anchor: the first that is found breadth first from it on the finest level.
fn coarse_anchor(hierarchy: &Hierarchy, level: usize, anchor: Option<SiteIdx>) -> Option<SiteIdx> {
    let n_sites = hierarchy.levels()[level].n_sites();
    let graph = hierarchy.levels()[0].graph();
    let mut found = vec![anchor?];
    let mut is_found = vec![false; graph.len()];
    is_found[found[0].index()] = true;
    let mut at = 0;
    while at < found.len() {
        if found[at].index() < n_sites {
            return Some(found[at]);
        }
        for &other in graph.neighbors(found[at]) {
            if !is_found[other.index()] {
                is_found[other.index()] = true;
                found.push(other);
            }
        }
        at += 1;
    }
    None
}

/// A whole number that rises with the distance; the same for both zeros.
fn rising(distance: f64) -> u64 {
    let bits = (distance + 0.0).to_bits();
    if bits >> 63 == 1 {
        !bits
    } else {
        bits | 1 << 63
    }
}
