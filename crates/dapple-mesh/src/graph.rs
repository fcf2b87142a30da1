//! Which sites are connected.

use crate::SiteIdx;

/// A symmetric graph of sites in compressed rows; the paper's mesh `M_k`, of which only the edges are used.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SiteGraph {
    offsets: Vec<u32>,
    neighbors: Vec<SiteIdx>,
}

impl SiteGraph {
    /// The graph with these edges, in any order and either direction, once or more often.
    ///
    /// An edge from a site to itself, or with a site that there is not, is left out.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{SiteGraph, SiteIdx};
    ///
    /// let path = SiteGraph::from_edges(3, [[SiteIdx(2), SiteIdx(1)], [SiteIdx(0), SiteIdx(1)]]);
    /// assert_eq!(path.neighbors(SiteIdx(1)), [SiteIdx(0), SiteIdx(2)]);
    /// ```
    #[must_use]
    pub fn from_edges(n_sites: usize, edges: impl IntoIterator<Item = [SiteIdx; 2]>) -> Self {
        let is_edge = |&[a, b]: &[SiteIdx; 2]| a != b && a.index().max(b.index()) < n_sites;
        let edges: Vec<[SiteIdx; 2]> = edges.into_iter().filter(is_edge).collect();
        Self::from_ends(n_sites, edges.iter().copied()).0
    }

    /// The graph with these edges, and the number of those that are given once only.
    ///
    /// No edge is one from a site to itself, and the sites are below their number.
    pub(crate) fn from_ends(
        n_sites: usize,
        edges: impl Iterator<Item = [SiteIdx; 2]> + Clone,
    ) -> (Self, usize) {
        // Where the row of each site begins; while they are filled, where its next neighbor goes.
        let mut next = vec![0_u32; n_sites + 1];
        for [a, b] in edges.clone() {
            next[a.index() + 1] += 1;
            next[b.index() + 1] += 1;
        }
        for site in 0..n_sites {
            next[site + 1] += next[site];
        }
        let mut neighbors = vec![SiteIdx(0); next[n_sites] as usize];
        for [a, b] in edges {
            for [from, to] in [[a, b], [b, a]] {
                neighbors[next[from.index()] as usize] = to;
                next[from.index()] += 1;
            }
        }
        // Every row now ends where the next one began.
        Self::from_rows(&next[..n_sites], neighbors)
    }

    /// Sorts rows, which have these ends, and keeps each neighbor once; counts the edges that were in a row once only.
    fn from_rows(ends: &[u32], mut neighbors: Vec<SiteIdx>) -> (Self, usize) {
        let mut offsets = Vec::with_capacity(ends.len() + 1);
        offsets.push(0);
        let (mut from, mut kept, mut singles) = (0, 0, 0);
        for &end in ends {
            let end = end as usize;
            neighbors[from..end].sort_unstable();
            while from < end {
                let to = neighbors[from];
                let first = from;
                while from < end && neighbors[from] == to {
                    from += 1;
                }
                singles += usize::from(from - first == 1);
                neighbors[kept] = to;
                kept += 1;
            }
            offsets.push(kept as u32);
        }
        neighbors.truncate(kept);
        neighbors.shrink_to_fit();
        // Each edge is in two rows.
        (Self { offsets, neighbors }, singles / 2)
    }

    /// The number of sites.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Whether there are no sites.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The sites that a site is connected to, lowest first.
    ///
    /// # Panics
    ///
    /// If there is no such site.
    #[inline]
    #[must_use]
    pub fn neighbors(&self, site: SiteIdx) -> &[SiteIdx] {
        &self.neighbors[self.row(site)]
    }

    /// Where the neighbors of a site are among those of all sites.
    #[inline]
    pub(crate) fn row(&self, site: SiteIdx) -> core::ops::Range<usize> {
        self.offsets[site.index()] as usize..self.offsets[site.index() + 1] as usize
    }

    /// The number of edges, each counted once.
    #[must_use]
    pub fn n_edges(&self) -> usize {
        self.neighbors.len() / 2
    }
}
