//! Upsampling along the graph: the coarser sites that a finer site takes its value from.
//!
//! The paper interpolates with the coarser sites within a radius in space (section 3.2). Here they are also at most two
//! edges of the finer level away, which is as far as the radius reaches on even sites: that keeps values from jumping
//! over gaps, to other components and to other sheets, where sweep distances have nothing in common; and it needs no
//! search.

use crate::sites::weight;
use crate::{Hierarchy, INTERPOLATION_RADIUS, SiteIdx};

/// The most coarser sites that count; even sites have about five in reach.
const MOST: usize = 16;

/// Coarser sites around a site, and their weights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parents {
    sites: [SiteIdx; MOST],
    weights: [f64; MOST],
    count: usize,
}

impl Parents {
    /// The sites of level `level + 1` around a site of level `level`; where none is within the radius, the nearest of
    /// those two edges away counts alone, and there may be none at all.
    pub(crate) fn new(hierarchy: &Hierarchy, level: usize, site: SiteIdx) -> Self {
        let graph = hierarchy.levels()[level].graph();
        let coarser = &hierarchy.levels()[level + 1];
        let n_coarser = coarser.n_sites() as u32;
        let mut parents = Self {
            sites: [SiteIdx(0); MOST],
            weights: [0.0; MOST],
            count: 0,
        };
        // Neighbors come lowest first, so the coarser ones come before all others.
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
        parents.weigh(hierarchy, site, coarser.spacing() * INTERPOLATION_RADIUS);
        parents
    }

    /// The sites and their weights, which are not negative and not all zero.
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

    /// Gives the sites the weights of equation 1.
    fn weigh(&mut self, hierarchy: &Hierarchy, site: SiteIdx, radius: f64) {
        let positions = hierarchy.sites().positions();
        let at = positions[site.index()];
        let (mut sum, mut nearest) = (0.0, (f64::INFINITY, 0));
        for parent in 0..self.count {
            let distance = at.distance(positions[self.sites[parent].index()]);
            if distance < nearest.0 {
                nearest = (distance, parent);
            }
            let x = (distance / radius).min(1.0);
            self.weights[parent] = weight(x);
            sum += self.weights[parent];
        }
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
