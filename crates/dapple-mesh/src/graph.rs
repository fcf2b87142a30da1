//! Which sites are connected.

use crate::SiteIdx;

/// A symmetric graph of sites in compressed rows; the paper's mesh `M_k`, of which only the edges are used.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SiteGraph {
    offsets: Vec<u32>,
    neighbors: Vec<SiteIdx>,
}

impl SiteGraph {
    /// The graph with these edges, in any order and either direction, once or twice; an edge from a site to itself is left
    /// out.
    #[must_use]
    pub fn from_edges(n_sites: usize, edges: impl IntoIterator<Item = [SiteIdx; 2]>) -> Self {
        let mut directed: Vec<[SiteIdx; 2]> = edges
            .into_iter()
            .filter(|[a, b]| a != b)
            .flat_map(|[a, b]| [[a, b], [b, a]])
            .collect();
        directed.sort_unstable();
        directed.dedup();
        let mut offsets = vec![0_u32; n_sites + 1];
        for [from, _] in &directed {
            offsets[from.index() + 1] += 1;
        }
        for site in 0..n_sites {
            offsets[site + 1] += offsets[site];
        }
        Self {
            offsets,
            neighbors: directed.into_iter().map(|[_, to]| to).collect(),
        }
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
        let [from, to] = [site.index(), site.index() + 1].map(|at| self.offsets[at] as usize);
        &self.neighbors[from..to]
    }

    /// The number of edges, each counted once.
    #[must_use]
    pub fn n_edges(&self) -> usize {
        self.neighbors.len() / 2
    }
}
