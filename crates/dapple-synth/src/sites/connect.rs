//! Connects sites: all stars, and the graph of what any of two sites takes for an edge.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1: two
//! sites that disagree whether they are connected are connected. So the graph is no triangulation.

use super::oriented::Oriented;
use super::star::{Spoke, StarFinder};
use crate::{SiteGraph, SiteGrid, SiteIdx, SynthError, SynthErrorKind};
use dapple_raster::parallel;
use glam::DVec3;

/// The stars that one thread makes at a time.
const CHUNK: usize = 1024;
/// The side of the cells of the grid, in spacings: most stars then look into two or three cells along each axis.
const GRID_SIDE: f64 = 2.0;

/// Sites that are connected where either of the two has the other in its star.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Connected {
    /// Which sites are connected.
    pub graph: SiteGraph,
    /// The number of edges that are in the star of only one of their sites.
    pub one_sided: usize,
}

impl Connected {
    /// Connects sites by the Delaunay triangulations in their tangent planes.
    ///
    /// `normals` are unit vectors; `spacing` is the distance of neighbors that is expected. Sites at the same place are
    /// not connected to each other, but any of them may be to what is around.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if there is not one normal for each position, [`SynthErrorKind::Range`] for a spacing
    /// that is not above zero and finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::glam::DVec3;
    /// use dapple_synth::{Connected, SiteIdx};
    ///
    /// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    /// let square = Connected::new(&corners, &[DVec3::Z; 4], 1.0)?;
    /// // Either diagonal would do, so there is none.
    /// assert_eq!(square.graph.neighbors(SiteIdx(0)), [SiteIdx(1), SiteIdx(2)]);
    /// # Ok::<(), dapple_synth::SynthError>(())
    /// ```
    pub fn new(positions: &[DVec3], normals: &[DVec3], spacing: f64) -> Result<Self, SynthError> {
        SynthError::check(
            spacing > 0.0 && spacing < f64::INFINITY,
            "spacing",
            spacing,
            "above zero and finite",
        )?;
        if normals.len() != positions.len() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "normals",
                count: normals.len(),
                needed: "one for each position",
            }));
        }
        let grid = SiteGrid::new(positions, GRID_SIDE * spacing);
        let grid = &grid;
        Ok(Self::among(&Oriented {
            positions,
            normals,
            grid,
            spacing,
        }))
    }

    /// The connections of sites whose columns and grid are known to fit.
    pub(crate) fn among(sites: &Oriented<'_>) -> Self {
        Stars::new(sites).union()
    }
}

/// The stars of all sites.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stars {
    /// Where the star of each site begins and ends.
    spans: Vec<[u32; 2]>,
    spokes: Vec<Spoke>,
}

/// The stars of some sites, one after the other.
#[derive(Debug, Default)]
struct Part {
    ends: Vec<u32>,
    spokes: Vec<Spoke>,
}

impl Stars {
    /// Finds the stars of all sites, on all cores where the feature `rayon` is on.
    pub(crate) fn new(sites: &Oriented<'_>) -> Self {
        // In the order of the grid, so that those which follow each other are near each other.
        let members = sites.grid.members();
        let n_sites = members.len();
        let mut stars = Self {
            spans: vec![[0; 2]; n_sites],
            spokes: Vec::with_capacity(6 * n_sites),
        };
        let part = |index: usize| {
            Part::new(
                sites,
                &members[index * CHUNK..((index + 1) * CHUNK).min(n_sites)],
            )
        };
        let parts = parallel::map(n_sites.div_ceil(CHUNK), part);
        for (part, members) in parts.into_iter().zip(members.chunks(CHUNK)) {
            let before = stars.spokes.len() as u32;
            let mut from = before;
            for (site, end) in members.iter().zip(part.ends) {
                stars.spans[site.index()] = [from, before + end];
                from = before + end;
            }
            stars.spokes.extend(part.spokes);
        }
        stars
    }

    /// The number of sites.
    pub(crate) fn len(&self) -> usize {
        self.spans.len()
    }

    /// The star of a site, counterclockwise.
    #[inline]
    pub(crate) fn star(&self, site: SiteIdx) -> &[Spoke] {
        let [from, to] = self.spans[site.index()].map(|at| at as usize);
        &self.spokes[from..to]
    }

    /// The graph of the edges of all stars.
    pub(crate) fn union(&self) -> Connected {
        let one_sided = self.one_sided();
        let n_neighbors = self.spokes.len() + one_sided.len();
        let mut others = one_sided.iter().peekable();
        let graph = SiteGraph::from_rows(self.len(), n_neighbors, |site, row| {
            row.extend(self.star(site).iter().map(|spoke| spoke.to));
            while let Some([_, other]) = others.next_if(|[end, _]| *end == site) {
                row.push(*other);
            }
        });
        let one_sided = one_sided.len();
        Connected { graph, one_sided }
    }

    /// The edges that are in the star of their second site only, in ascending order.
    fn one_sided(&self) -> Vec<[SiteIdx; 2]> {
        let mut found = Vec::new();
        for site in (0..self.len() as u32).map(SiteIdx) {
            for spoke in self.star(site) {
                if self.star(spoke.to).iter().all(|back| back.to != site) {
                    found.push([spoke.to, site]);
                }
            }
        }
        found.sort_unstable();
        found
    }
}

impl Part {
    fn new(sites: &Oriented<'_>, centers: &[SiteIdx]) -> Self {
        let mut finder = StarFinder::default();
        let mut part = Self::default();
        for &center in centers {
            finder.find(sites, center, &mut part.spokes);
            part.ends.push(part.spokes.len() as u32);
        }
        part
    }
}

#[cfg(test)]
mod tests;
