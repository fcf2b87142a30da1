//! Weighted edges of a level, for the averages in equations 4 and 5 of the paper.
//!
//! The weight of an edge is its inverse length (section 3.2). Weights are not normalized per site, so they are
//! symmetric. The averages are then the fixed points of a symmetric system, which
//! [`conjugate_gradients`](crate::solve::conjugate_gradients) solves.

use crate::{Hierarchy, SiteGraph, SiteIdx, columns};

/// Minimum edge length for weights, in multiples of the site spacing. Shorter lengths are clamped to it, so that no
/// neighbor outweighs all others.
pub(crate) const LEAST_LENGTH: f64 = 1e-3;

/// Neighbor graph of a level with a weight for every edge, stored at both ends.
#[derive(Debug)]
pub(crate) struct Links<'a> {
    graph: &'a SiteGraph,
    /// Start of each site's range in the weights, plus the end of the last one.
    offsets: Vec<u32>,
    weights: Vec<f64>,
    /// Sum of the weights of each site.
    sums: Vec<f64>,
}

impl<'a> Links<'a> {
    /// Builds the links of `level`, weighted by inverse length.
    pub(crate) fn new(hierarchy: &'a Hierarchy, level: usize) -> Self {
        let level = &hierarchy.levels()[level];
        let graph = level.graph();
        let positions = hierarchy.sites().positions();
        let least = level.spacing() * LEAST_LENGTH;
        let mut offsets = vec![0_u32; level.n_sites() + 1];
        for site in 0..level.n_sites() {
            offsets[site + 1] = offsets[site] + graph.neighbors(SiteIdx(site as u32)).len() as u32;
        }
        let mut links = Self {
            graph,
            weights: vec![0.0; offsets[level.n_sites()] as usize],
            sums: vec![0.0; level.n_sites()],
            offsets,
        };
        links.reweigh(|site, neighbors, row| {
            let at = positions[site];
            for (weight, other) in row.iter_mut().zip(neighbors) {
                *weight = 1.0 / at.distance(positions[other.index()]).max(least);
            }
        });
        links
    }

    /// Calls `change` with each site, its neighbors and its mutable weights, and collects the returned values.
    ///
    /// The weights must stay symmetric.
    pub(crate) fn reweigh<T: Send>(
        &mut self,
        change: impl Fn(usize, &[SiteIdx], &mut [f64]) -> T + Sync + Send,
    ) -> Vec<T> {
        let n_sites = self.len();
        let mut rows: Vec<&mut [f64]> = Vec::with_capacity(n_sites);
        // Split the weights into one mutable row per site.
        let mut rest = self.weights.as_mut_slice();
        for ends in self.offsets.windows(2) {
            let (row, after) = rest.split_at_mut((ends[1] - ends[0]) as usize);
            rows.push(row);
            rest = after;
        }
        let graph = self.graph;
        let found = columns::map(&mut rows, |site, row| {
            change(site, graph.neighbors(SiteIdx(site as u32)), row)
        });
        self.sums = columns::column(n_sites, |site| self.weights(site).iter().sum());
        found
    }

    /// Returns the number of sites.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Returns the neighbors of `site`.
    #[inline]
    pub(crate) fn neighbors(&self, site: usize) -> &[SiteIdx] {
        self.graph.neighbors(SiteIdx(site as u32))
    }

    /// Returns the weights of the edges to the neighbors of `site`, in the order of [`neighbors`](Self::neighbors).
    #[inline]
    pub(crate) fn weights(&self, site: usize) -> &[f64] {
        &self.weights[self.row(site)]
    }

    /// Returns the range of the site's links in the concatenated links of all sites.
    #[inline]
    pub(crate) fn row(&self, site: usize) -> core::ops::Range<usize> {
        self.offsets[site] as usize..self.offsets[site + 1] as usize
    }

    /// Returns the sum of the weights of each site; 0 for a site without neighbors.
    #[inline]
    pub(crate) fn sums(&self) -> &[f64] {
        &self.sums
    }

    /// Assigns values breadth first, in rings around the assigned sites. `opinion` computes the value of a site from
    /// the sites assigned in earlier rings. Links of weight 0 are ignored. Sites not connected to an assigned site stay
    /// unchanged.
    pub(crate) fn fill<T: Copy>(
        &self,
        assigned: &mut [bool],
        values: &mut [T],
        opinion: impl Fn(usize, &[bool], &[T]) -> T,
    ) {
        let touches = |site: usize, assigned: &[bool]| {
            let mut linked = self.linked(site);
            !assigned[site] && linked.any(|other| assigned[other])
        };
        // The first ring: unassigned sites with an assigned neighbor.
        let mut ring: Vec<usize> = (0..self.len())
            .filter(|&site| touches(site, assigned))
            .collect();
        while !ring.is_empty() {
            // Compute all values of the ring before any is assigned.
            let found: Vec<T> = ring
                .iter()
                .map(|&site| opinion(site, assigned, values))
                .collect();
            for (&site, value) in ring.iter().zip(found) {
                values[site] = value;
                assigned[site] = true;
            }
            // The next ring: unassigned neighbors, in ascending order.
            let mut next: Vec<usize> = ring
                .iter()
                .flat_map(|&site| self.linked(site))
                .filter(|&other| !assigned[other])
                .collect();
            next.sort_unstable();
            next.dedup();
            ring = next;
        }
    }
}

impl Links<'_> {
    /// Returns the neighbors of `site` whose link has a positive weight.
    fn linked(&self, site: usize) -> impl Iterator<Item = usize> {
        let linked = self.neighbors(site).iter().zip(self.weights(site));
        let linked = linked.filter(|&(_, &weight)| weight > 0.0);
        linked.map(|(other, _)| other.index())
    }
}

/// Returns the index of each site's connected component. Components are numbered in the order of their lowest sites.
pub(crate) fn components(graph: &SiteGraph) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut components = vec![NONE; graph.len()];
    // Depth-first search from the lowest site of each component.
    let mut found = Vec::new();
    let mut count = 0;
    for start in 0..graph.len() {
        if components[start] != NONE {
            continue;
        }
        components[start] = count;
        found.push(SiteIdx(start as u32));
        while let Some(site) = found.pop() {
            for &other in graph.neighbors(site) {
                if components[other.index()] == NONE {
                    components[other.index()] = count;
                    found.push(other);
                }
            }
        }
        count += 1;
    }
    components
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{sites_on, sphere, two_squares};

    #[test]
    fn weights_are_inverse_lengths_and_symmetric() {
        let hierarchy = sites_on(sphere(), 300, 2);
        for level in 0..2 {
            let links = Links::new(&hierarchy, level);
            assert_eq!(links.len(), hierarchy.levels()[level].n_sites());
            for site in 0..links.len() {
                let at = hierarchy.sites().positions()[site];
                let mut sum = 0.0;
                for (other, &weight) in links.neighbors(site).iter().zip(links.weights(site)) {
                    let there = hierarchy.sites().positions()[other.index()];
                    assert_eq!(weight, 1.0 / at.distance(there));
                    let back = links
                        .neighbors(other.index())
                        .iter()
                        .position(|end| end.index() == site);
                    assert_eq!(
                        links.weights(other.index())[back.unwrap()],
                        weight,
                        "from the other end"
                    );
                    sum += weight;
                }
                assert_eq!(links.sums()[site], sum);
            }
        }
    }

    #[test]
    fn fill_goes_ring_by_ring_and_not_beyond_a_component() {
        let hierarchy = sites_on(two_squares(), 400, 1);
        let links = Links::new(&hierarchy, 0);
        let components = components(hierarchy.levels()[0].graph());
        let mut assigned = vec![false; 400];
        let mut rings = vec![0_u32; 400];
        assigned[7] = true;
        links.fill(&mut assigned, &mut rings, |site, assigned, rings| {
            let before = links.neighbors(site).iter().map(|other| other.index());
            1 + before
                .filter(|&other| assigned[other])
                .map(|other| rings[other])
                .min()
                .unwrap()
        });
        for site in 0..400 {
            assert_eq!(
                assigned[site],
                components[site] == components[7],
                "site {site}"
            );
            for other in links.neighbors(site) {
                assert!(
                    rings[site].abs_diff(rings[other.index()]) <= 1,
                    "neighbors are in rings side by side"
                );
            }
            assert!(
                rings[site] > 0 || site == 7 || !assigned[site],
                "site {site} is in ring 0"
            );
        }
    }

    #[test]
    fn components_are_numbered_by_their_lowest_sites() {
        let edges = [[0, 3], [1, 5], [5, 2]].map(|ends: [u32; 2]| ends.map(SiteIdx));
        assert_eq!(
            components(&SiteGraph::from_edges(7, edges)),
            [0, 1, 1, 0, 2, 1, 3]
        );
        assert!(components(&SiteGraph::default()).is_empty(), "no sites");
    }
}
