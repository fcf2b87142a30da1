//! Neighbor graph of sites, in compressed rows.

use crate::SiteIdx;
use dapple_raster::Groups;

/// A symmetric graph of sites in compressed rows: the edges of the paper's mesh `M_k`. Its triangles are not stored.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SiteGraph {
    offsets: Vec<u32>,
    neighbors: Vec<SiteIdx>,
}

impl SiteGraph {
    /// Builds a graph from edges in any order and either direction; duplicates are merged.
    ///
    /// Self-loops and edges with an index of `n_sites` or more are dropped.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_synth::{SiteGraph, SiteIdx};
    ///
    /// let path = SiteGraph::from_edges(3, [[SiteIdx(2), SiteIdx(1)], [SiteIdx(0), SiteIdx(1)]]);
    /// assert_eq!(path.neighbors(SiteIdx(1)), [SiteIdx(0), SiteIdx(2)]);
    /// ```
    #[must_use]
    pub fn from_edges(n_sites: usize, edges: impl IntoIterator<Item = [SiteIdx; 2]>) -> Self {
        let is_edge = |&[a, b]: &[SiteIdx; 2]| a != b && a.index().max(b.index()) < n_sites;
        let edges: Vec<[SiteIdx; 2]> = edges.into_iter().filter(is_edge).collect();
        // Sort the ends of the edges by site. The other end of the end `i` is `i ^ 1`.
        let ends = edges.as_flattened();
        let sites: Vec<u32> = ends.iter().map(|end| end.0).collect();
        let rows = Groups::sort(n_sites, &sites);
        Self::from_rows(n_sites, ends.len(), |site, row| {
            row.extend(
                rows.of(site.index())
                    .iter()
                    .map(|&end| ends[end as usize ^ 1]),
            );
        })
    }

    /// Builds a graph row by row: `add` appends the neighbors of a site to the given list. Each row is then sorted, and
    /// duplicates are removed. The rows must be symmetric; `n_neighbors` is the expected total number of neighbors.
    pub(crate) fn from_rows(
        n_sites: usize,
        n_neighbors: usize,
        mut add: impl FnMut(SiteIdx, &mut Vec<SiteIdx>),
    ) -> Self {
        let mut offsets = Vec::with_capacity(n_sites + 1);
        offsets.push(0);
        let mut neighbors = Vec::with_capacity(n_neighbors);
        let mut row = Vec::new();
        for site in (0..n_sites as u32).map(SiteIdx) {
            row.clear();
            add(site, &mut row);
            row.sort_unstable();
            row.dedup();
            neighbors.extend_from_slice(&row);
            offsets.push(neighbors.len() as u32);
        }
        neighbors.shrink_to_fit();
        Self { offsets, neighbors }
    }

    /// Returns the number of sites.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Returns whether there are no sites.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the neighbors of `site`, in ascending order.
    ///
    /// # Panics
    ///
    /// If the graph does not have the site.
    #[inline]
    #[must_use]
    pub fn neighbors(&self, site: SiteIdx) -> &[SiteIdx] {
        &self.neighbors[self.row(site)]
    }

    /// Returns the range of a site's neighbors in the concatenated rows of all sites.
    #[inline]
    pub(crate) fn row(&self, site: SiteIdx) -> core::ops::Range<usize> {
        self.offsets[site.index()] as usize..self.offsets[site.index() + 1] as usize
    }

    /// Returns the number of edges, each counted once.
    #[must_use]
    pub fn n_edges(&self) -> usize {
        self.neighbors.len() / 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dapple_hash::{Seed, hash1};
    use std::collections::BTreeSet;

    #[test]
    fn graph_has_each_edge_once_in_both_rows() {
        for n_sites in [0_u32, 1, 2, 7, 50] {
            // Random edges include self-loops, duplicates, and indices out of range.
            let end =
                |edge, counter| SiteIdx(hash1(Seed(9), [edge], counter) as u32 % (n_sites + 2));
            let edges: Vec<[SiteIdx; 2]> =
                (0..200).map(|edge| [end(edge, 0), end(edge, 1)]).collect();
            let mut expected = BTreeSet::new();
            for &[a, b] in &edges {
                if a != b && a.0 < n_sites && b.0 < n_sites {
                    expected.extend([[a, b], [b, a]]);
                }
            }
            let graph = SiteGraph::from_edges(n_sites as usize, edges);
            assert_eq!(graph.len(), n_sites as usize, "a row for each site");
            assert_eq!(
                2 * graph.n_edges(),
                expected.len(),
                "edges of {n_sites} sites"
            );
            let row = |site| graph.neighbors(site).iter().map(move |&to| [site, to]);
            let found: Vec<[SiteIdx; 2]> = (0..n_sites).map(SiteIdx).flat_map(row).collect();
            assert!(found.iter().eq(&expected), "rows are sorted and complete");
        }
    }
}
