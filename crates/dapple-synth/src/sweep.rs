//! Sweep distance: the position of every site along the orientation field. It defines the order in which sites get
//! colors.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, section 4.2,
//! <https://doi.org/10.1145/383259.383297>.
//!
//! Starting at an anchor, each site gets the distance along the field that its assigned neighbors predict (equation 5).
//! The coarsest level comes first; every finer level starts from interpolated values. The consensus orientation of two
//! sites is in the plane of their mean normal, so that both predict the same difference. The following differs from the
//! paper, or is not specified in it:
//!
//! * the coarsest level is initialized breadth first and then solved by conjugate gradients. Repeating equation 5 until
//!   convergence takes as many sweeps as the square of the number of sites across the surface;
//! * interpolation adds the distance along the field from each coarser site to the new one. Then 20 sweeps of equation
//!   5 follow, with 0.2 for α and 0.8 for the sum of the β;
//! * where the field circles around a point or a tube, no distance can increase along it everywhere. In a least-squares
//!   solution it would not increase there at all. So predictions that are off by about a spacing or more get less
//!   weight (Cauchy's weights). The error is then concentrated in a tear, a line across which the order jumps, and the
//!   distance increases everywhere else;
//! * in a field with a symmetry, edges between neighbors with different rotations cross a cut and have weight 0. Cuts
//!   connect singularities, so nearly all of a component is still reached;
//! * every connected component of a level has its own anchor, and components are swept one after another.
//!
//! Distances are in units of the mesh.

mod level;
#[cfg(test)]
mod tests;

use crate::links::components;
use crate::{Hierarchy, Orientation, SiteIdx, SynthError, SynthErrorKind};
use dapple_raster::parallel;
use level::LevelSweep;

/// Sweep distance s of every site, for every level.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Distances by level, the finest first.
    levels: Vec<Distances>,
}

/// Sweep distances and connected components of the sites of a level.
#[derive(Clone, Debug, PartialEq)]
struct Distances {
    /// Sweep distance of each site, in units of the mesh.
    distances: Vec<f64>,
    /// Connected component of each site; components are numbered in the order of their lowest sites.
    components: Vec<u32>,
}

impl Sweep {
    /// Computes sweep distances. Each connected component is measured from the given anchor if it contains it, and from
    /// its lowest site otherwise.
    ///
    /// Sites are scattered at random, so the lowest site is as suitable as any other. The anchor mainly determines
    /// where the distance is zero.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if the anchor is not a site, and [`SynthErrorKind::Count`] if the orientation does not
    /// have one vector for each site of the hierarchy.
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

    /// Returns the sweep distances of a level's sites, in units of the mesh; 0 at the anchor.
    ///
    /// Distances in different components are not comparable.
    ///
    /// # Panics
    ///
    /// If the level does not exist.
    #[must_use]
    pub fn distances(&self, level: usize) -> &[f64] {
        &self.levels[level].distances
    }

    /// Returns the sites of a level in the order of the sweep: by component, then by distance, then by index.
    /// Components are in the order of their lowest sites.
    ///
    /// # Panics
    ///
    /// If the level does not exist.
    #[must_use]
    pub fn order(&self, level: usize) -> Vec<SiteIdx> {
        let Distances {
            distances,
            components,
        } = &self.levels[level];
        // Pack component, distance and site into one integer that sorts in this order.
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

    /// Shifts the distances of every component so that its anchor on the finest level is at 0.
    fn measure_from(&mut self, anchor: Option<SiteIdx>) {
        let Some(finest) = self.levels.first() else {
            return;
        };
        let mut zeros: Vec<f64> = Vec::new();
        // Find the distance at the anchor of each component of the finest level; the lowest site by default.
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
            // Shift each component of a level like the finest component that contains its lowest site.
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

/// Returns the anchor on a coarser level: the first site of that level in a breadth-first search from the anchor on the
/// finest level.
fn coarse_anchor(hierarchy: &Hierarchy, level: usize, anchor: Option<SiteIdx>) -> Option<SiteIdx> {
    let n_sites = hierarchy.levels()[level].n_sites();
    let graph = hierarchy.levels()[0].graph();
    let mut found = vec![anchor?];
    let mut is_found = vec![false; graph.len()];
    is_found[found[0].index()] = true;
    let mut at = 0;
    while at < found.len() {
        // The sites of a coarser level are the first ones of the hierarchy.
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

/// Maps a distance to an integer with the same order; both zeros map to the same integer.
fn rising(distance: f64) -> u64 {
    let bits = (distance + 0.0).to_bits();
    // Negative numbers sort backward by their bits, so flip all of them; otherwise set the sign bit.
    if bits >> 63 == 1 {
        !bits
    } else {
        bits | 1 << 63
    }
}
