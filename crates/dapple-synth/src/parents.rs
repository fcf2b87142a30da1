//! Upsampling along the graph: finds the coarser sites from which a finer site interpolates its value.
//!
//! Input: a hierarchy, a level and a site. Output: coarser sites with weights (equation 1 of Turk's paper).
//!
//! The paper interpolates between the coarser sites within a radius in space (section 3.2). Here they must also be at
//! most two edges away in the finer graph, which covers the radius if sites are evenly spaced. This prevents values
//! from jumping over gaps, to other components and to other sheets, where sweep distances are unrelated. It also needs
//! no spatial search.

use crate::sites::weight;
use crate::{Hierarchy, INTERPOLATION_RADIUS, SiteIdx};

/// Maximum number of parent sites; evenly spaced sites have about five within range.
const MOST: usize = 16;

/// Coarser sites near a site, and their weights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parents {
    sites: [SiteIdx; MOST],
    weights: [f64; MOST],
    count: usize,
}

impl Parents {
    /// Finds the parents of a site of `level`, on level `level + 1`. If none is within the radius, the nearest site
    /// within two edges has all the weight. A site without coarser sites within two edges has no parents.
    pub(crate) fn new(hierarchy: &Hierarchy, level: usize, site: SiteIdx) -> Self {
        let graph = hierarchy.levels()[level].graph();
        let coarser = &hierarchy.levels()[level + 1];
        let n_coarser = coarser.n_sites() as u32;
        let mut parents = Self {
            sites: [SiteIdx(0); MOST],
            weights: [0.0; MOST],
            count: 0,
        };
        // Neighbors ascend, so coarser sites precede all others.
        for &near in graph.neighbors(site) {
            if near.0 < n_coarser {
                parents.add(near);
            }
            for &far in graph.neighbors(near) {
                if far.0 >= n_coarser {
                    break;
                }
                if far != site {
                    parents.add(far);
                }
            }
        }
        // Weigh the parents by distance.
        parents.weigh(hierarchy, site, coarser.spacing() * INTERPOLATION_RADIUS);
        parents
    }

    /// Returns the indices of the parents with their weights, which are not negative and not all zero.
    #[inline]
    pub(crate) fn iter(&self) -> impl Iterator<Item = (usize, f64)> + Clone {
        let sites = self.sites[..self.count].iter().map(|site| site.index());
        sites.zip(self.weights[..self.count].iter().copied())
    }

    #[inline]
    fn add(&mut self, site: SiteIdx) {
        if self.count < MOST && !self.sites[..self.count].contains(&site) {
            self.sites[self.count] = site;
            self.count += 1;
        }
    }

    /// Computes the weights of equation 1.
    fn weigh(&mut self, hierarchy: &Hierarchy, site: SiteIdx, radius: f64) {
        let positions = hierarchy.sites().positions();
        let at = positions[site.index()];
        let (mut sum, mut nearest) = (0.0, (f64::INFINITY, 0));
        for parent in 0..self.count {
            let distance = at.distance(positions[self.sites[parent].index()]);
            if distance < nearest.0 {
                nearest = (distance, parent);
            }
            // Equation 1. Beyond the radius, the weight is w(1) = 0.
            let x = (distance / radius).min(1.0);
            self.weights[parent] = weight(x);
            sum += self.weights[parent];
        }
        // No parent is within the radius, so take the nearest one.
        if sum < 1e-9 && self.count > 0 {
            self.weights[nearest.1] = 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{sites_on, sphere};

    #[test]
    fn parents_are_the_coarser_sites_within_the_radius_and_two_edges() {
        let hierarchy = sites_on(sphere(), 1000, 3);
        let positions = hierarchy.sites().positions();
        for level in 0..2 {
            let graph = hierarchy.levels()[level].graph();
            let coarser = &hierarchy.levels()[level + 1];
            for site in coarser.n_sites()..hierarchy.levels()[level].n_sites() {
                let parents = Parents::new(&hierarchy, level, SiteIdx(site as u32));
                for other in 0..coarser.n_sites() {
                    let near = graph.neighbors(SiteIdx(site as u32)).iter();
                    let is_near = near.clone().any(|near| near.index() == other)
                        || near
                            .clone()
                            .any(|&near| graph.neighbors(near).contains(&SiteIdx(other as u32)));
                    let x = positions[site].distance(positions[other])
                        / (coarser.spacing() * INTERPOLATION_RADIUS);
                    let wanted = if is_near && x < 1.0 {
                        2.0 * x * x * x - 3.0 * x * x + 1.0
                    } else {
                        0.0
                    };
                    let found: f64 = parents
                        .iter()
                        .filter(|&(parent, _)| parent == other)
                        .map(|(_, weight)| weight)
                        .sum();
                    let is_nearest_alone = found == 1.0
                        && parents.iter().filter(|&(_, weight)| weight > 0.0).count() == 1;
                    // The order of the products differs.
                    assert!(
                        (found - wanted).abs() < 1e-12 || is_nearest_alone,
                        "{site} {other}: {found} {wanted}"
                    );
                }
            }
        }
    }
}
