//! How far downstream every site is: the order in which sites get their colors (section 4.2).

use crate::{Orientation, SynthError};
use dapple_mesh::{Hierarchy, SiteIdx};

/// The sweep distance s at every site, for every level.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// For each level, the finest first, the distances of its sites.
    levels: Vec<Vec<f64>>,
}

impl Sweep {
    /// Measures from an anchor, or from one that the hierarchy chooses, in every component.
    ///
    /// # Errors
    ///
    /// If there is no such site.
    pub fn new(
        hierarchy: &Hierarchy,
        orientation: &Orientation,
        anchor: Option<SiteIdx>,
    ) -> Result<Self, SynthError> {
        // SKELETON: minus the height. To be replaced.
        let _ = (orientation, anchor);
        let level = |level: &dapple_mesh::Level| {
            hierarchy.sites().positions()[..level.n_sites()]
                .iter()
                .map(|at| at.z)
                .collect()
        };
        Ok(Self {
            levels: hierarchy.levels().iter().map(level).collect(),
        })
    }

    /// The distances of the sites of a level, in units of the mesh.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    #[must_use]
    pub fn distances(&self, level: usize) -> &[f64] {
        &self.levels[level]
    }

    /// The sites of a level in the order of the sweep; of several at one distance the lowest first.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    #[must_use]
    pub fn order(&self, level: usize) -> Vec<SiteIdx> {
        let distances = self.distances(level);
        let mut order: Vec<SiteIdx> = (0..distances.len() as u32).map(SiteIdx).collect();
        order.sort_by(|a, b| {
            distances[a.index()]
                .total_cmp(&distances[b.index()])
                .then(a.cmp(b))
        });
        order
    }
}
