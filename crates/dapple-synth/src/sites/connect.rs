//! Builds the neighbor graph of sites from their stars. Two sites are connected if at least one has the other in its
//! star.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1: sites
//! that disagree about an edge are connected. Edges can therefore cross, and the graph need not be a triangulation.

use super::oriented::Oriented;
use super::star::{Spoke, StarFinder};
use crate::{SiteGraph, SiteGrid, SiteIdx, SynthError, SynthErrorKind};
use dapple_raster::parallel;
use glam::DVec3;

/// Number of stars that one task computes.
const CHUNK: usize = 1024;
/// Side of the grid cells, in multiples of the site spacing. With this size, most stars read two or three cells along
/// each axis.
const GRID_SIDE: f64 = 2.0;

/// Graph in which two sites are connected if at least one of them has the other in its star.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Connected {
    /// Edges between the sites.
    pub graph: SiteGraph,
    /// Number of edges that are in the star of only one of their two sites.
    pub one_sided: usize,
}

impl Connected {
    /// Connects sites by the Delaunay triangulations in their tangent planes.
    ///
    /// `normals` are unit vectors; `spacing` is the expected distance between neighbors. Sites at the same position are
    /// not connected to each other, but each of them may be connected to the sites around them.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless there is one normal for each position, and [`SynthErrorKind::Range`] unless
    /// `spacing` is above zero and finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::glam::DVec3;
    /// use dapple_synth::{Connected, SiteIdx};
    ///
    /// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    /// let square = Connected::new(&corners, &[DVec3::Z; 4], 1.0)?;
    /// // Both diagonals are equally good, so neither is taken.
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

    /// Connects sites like [`new`](Self::new), without checks: columns and grid are known to match.
    pub(crate) fn among(sites: &Oriented<'_>) -> Self {
        Stars::new(sites).union()
    }
}

/// Stars of all sites.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stars {
    /// For each site, the range of its star in `spokes`.
    spans: Vec<[u32; 2]>,
    spokes: Vec<Spoke>,
}

/// Stars of consecutive sites, concatenated.
#[derive(Debug, Default)]
struct Part {
    ends: Vec<u32>,
    spokes: Vec<Spoke>,
}

impl Stars {
    /// Finds the stars of all sites, on all cores if the feature `rayon` is on.
    pub(crate) fn new(sites: &Oriented<'_>) -> Self {
        // Process sites in grid order: consecutive sites are then near each other and share grid lookups.
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
        // Concatenate the parts, and record the range of each star.
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

    /// Returns the number of sites.
    pub(crate) fn len(&self) -> usize {
        self.spans.len()
    }

    /// Returns the star of `site`, counterclockwise.
    #[inline]
    pub(crate) fn star(&self, site: SiteIdx) -> &[Spoke] {
        let [from, to] = self.spans[site.index()].map(|at| at as usize);
        &self.spokes[from..to]
    }

    /// Builds the graph of the edges that are in at least one star.
    pub(crate) fn union(&self) -> Connected {
        let one_sided = self.one_sided();
        let n_neighbors = self.spokes.len() + one_sided.len();
        let mut others = one_sided.iter().peekable();
        let graph = SiteGraph::from_rows(self.len(), n_neighbors, |site, row| {
            row.extend(self.star(site).iter().map(|spoke| spoke.to));
            // Connect sites that disagree: add those that have this site in their stars (section 3.1).
            while let Some([_, other]) = others.next_if(|[end, _]| *end == site) {
                row.push(*other);
            }
        });
        let one_sided = one_sided.len();
        Connected { graph, one_sided }
    }

    /// Returns the edges that are in the star of their second site only, in ascending order.
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
