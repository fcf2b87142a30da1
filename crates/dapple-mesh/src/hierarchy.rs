//! Nested sets of even points on a surface, connected on every level: the paper's mesh hierarchy.

use crate::oriented::Oriented;
use crate::{Connected, MeshError, SiteGraph, SiteGrid, Sites, Surface, SurfacePoint};
use dapple_hash::{Seed, unit_f64};

/// How a hierarchy is made.
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchyOptions {
    /// The number of sites of the finest level; by default 65 536. Each coarser level has a quarter, rounded up.
    pub n_sites: usize,
    /// The number of levels; by default 3.
    pub n_levels: usize,
    /// Where the sites begin.
    pub seed: Seed,
}

impl Default for HierarchyOptions {
    fn default() -> Self {
        Self {
            n_sites: 65_536,
            n_levels: 3,
            seed: Seed(0),
        }
    }
}

/// The sites of all levels, those of the coarsest first, and what is known of every level.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    sites: Sites,
    levels: Vec<Level>,
}

/// One level of a hierarchy: its sites are the first `n_sites` of all.
#[derive(Clone, Debug)]
pub struct Level {
    n_sites: usize,
    spacing: f64,
    connected: Connected,
    grid: SiteGrid,
}

impl Hierarchy {
    /// Scatters and connects sites.
    ///
    /// # Errors
    ///
    /// Typed errors for counts of zero and counts beyond memory.
    pub fn new(surface: &Surface, options: &HierarchyOptions) -> Result<Self, MeshError> {
        // SKELETON: random sites without repulsion, connected to those within 1.6 spacings. To be replaced by nested,
        // repelled sites and by the Delaunay stars in the tangent planes.
        let mut counts = vec![options.n_sites];
        for _ in 1..options.n_levels {
            counts.push(counts[counts.len() - 1].div_ceil(4));
        }
        let seed = options.seed.child("skeleton sites", 0);
        let mut ends = Vec::new();
        let mut sum = 0.0;
        for face in 0..surface.mesh().faces().len() as u32 {
            sum += surface.face_area(crate::FaceIdx(face));
            ends.push(sum);
        }
        let points: Vec<SurfacePoint> = (0..options.n_sites as i64)
            .map(|site| {
                let at = |counter| unit_f64(dapple_hash::hash1(seed, [site], counter));
                let face = ends
                    .partition_point(|&end| end <= at(0) * sum)
                    .min(ends.len() - 1);
                let root = at(1).sqrt();
                let weights = [1.0 - root, root * (1.0 - at(2)), root * at(2)];
                surface.point(crate::FaceIdx(face as u32), weights)
            })
            .collect();
        let sites = Sites::new(surface, points);
        let levels = counts
            .iter()
            .map(|&n_sites| {
                let spacing = (2.0 * surface.area() / (3.0_f64.sqrt() * n_sites as f64)).sqrt();
                let positions = &sites.positions()[..n_sites];
                let grid = SiteGrid::new(positions, 2.0 * spacing);
                let connected = Connected::among(&Oriented {
                    positions,
                    normals: &sites.normals()[..n_sites],
                    grid: &grid,
                    spacing,
                });
                Level {
                    n_sites,
                    spacing,
                    connected,
                    grid,
                }
            })
            .collect();
        Ok(Self { sites, levels })
    }

    /// The sites of the finest level; those of the coarser levels are the first of them.
    #[must_use]
    pub fn sites(&self) -> &Sites {
        &self.sites
    }

    /// The levels, the finest first: `levels()[0]` is the paper's `M_1`.
    #[must_use]
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }
}

impl Level {
    /// The number of sites: those with an index below it.
    #[must_use]
    pub fn n_sites(&self) -> usize {
        self.n_sites
    }

    /// The paper's r: the distance of neighbors if the sites were a hexagonal lattice, `sqrt(2 A / (sqrt(3) n))`.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Which sites are connected.
    #[must_use]
    pub fn graph(&self) -> &SiteGraph {
        &self.connected.graph
    }

    /// The number of edges that only one of their two sites asked for: the paper's disagreements.
    #[must_use]
    pub fn one_sided_edges(&self) -> usize {
        self.connected.one_sided
    }

    /// Which sites are near a position.
    #[must_use]
    pub fn grid(&self) -> &SiteGrid {
        &self.grid
    }
}
