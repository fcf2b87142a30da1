//! Nested sets of even points on a surface, connected on every level: the paper's mesh hierarchy.

use super::oriented::Oriented;
use crate::{
    Connected, SiteGraph, SiteGrid, Sites, SynthError, SynthErrorKind, hexagonal_spacing,
    nested_points,
};
use dapple_hash::Seed;
use dapple_mesh::Surface;

/// The most sites.
const SITES_MAX: usize = 1 << 28;
/// The memory for a site and its lists of neighbors while sites repel each other, as measured.
const BYTES_PER_SITE: usize = 220;
/// The most levels; even of the most sites, the coarsest of 15 has only one.
const LEVELS_MAX: usize = 16;
/// The most iterations, so that a mistaken number does not take forever.
const ITERATIONS_MAX: usize = 10_000;

/// Options of a hierarchy.
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchyOptions {
    /// The number of sites of the finest level; by default 65 536. Each coarser level has a quarter, rounded up.
    pub n_sites: usize,
    /// The number of levels; by default 3.
    pub n_levels: usize,
    /// Where the sites begin.
    pub seed: Seed,
    /// How often the new sites of a level push each other apart; by default 6. Those of the coarsest level do so four
    /// times as often. More than 40 change next to nothing.
    pub iterations: usize,
}

impl Default for HierarchyOptions {
    fn default() -> Self {
        Self {
            n_sites: 65_536,
            n_levels: 3,
            seed: Seed(0),
            iterations: 6,
        }
    }
}

impl HierarchyOptions {
    /// The number of sites of each level, the finest first.
    fn counts(&self) -> Result<Vec<usize>, SynthError> {
        let refuse = |what, count, needed| {
            Err(SynthError::new(SynthErrorKind::Count {
                what,
                count,
                needed,
            }))
        };
        if !(1..=SITES_MAX).contains(&self.n_sites) {
            return refuse("sites", self.n_sites, "1 to 2^28");
        }
        if !(1..=LEVELS_MAX).contains(&self.n_levels) {
            return refuse("levels", self.n_levels, "1 to 16");
        }
        if self.iterations > ITERATIONS_MAX {
            return refuse("iterations", self.iterations, "at most 10000");
        }
        let coarser = |&count: &usize| Some(count.div_ceil(4));
        // Asked for and given back at once, so that too many sites are an error and no abort.
        let bytes = self.n_sites.saturating_mul(BYTES_PER_SITE);
        if Vec::<u8>::new().try_reserve_exact(bytes).is_err() {
            return refuse("sites", self.n_sites, "as few as fit into the memory");
        }
        Ok(core::iter::successors(Some(self.n_sites), coarser)
            .take(self.n_levels)
            .collect())
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
    /// [`SynthErrorKind::Count`] unless there are 1 to 2^28 sites, which fit into the memory, 1 to 16 levels and at most
    /// 10,000 iterations.
    pub fn new(surface: &Surface, options: &HierarchyOptions) -> Result<Self, SynthError> {
        let counts = options.counts()?;
        let ascending: Vec<usize> = counts.iter().rev().copied().collect();
        let points = nested_points(surface, &ascending, options.seed, options.iterations);
        let sites = Sites::new(surface, points);
        let levels = counts
            .iter()
            .map(|&n_sites| {
                let spacing = hexagonal_spacing(surface.area(), n_sites);
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
