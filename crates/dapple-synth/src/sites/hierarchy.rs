//! Nested sets of evenly spaced sites on a surface, with a neighbor graph on every level. This is the paper's mesh
//! hierarchy.

use super::oriented::Oriented;
use crate::{
    Connected, SiteGraph, SiteGrid, Sites, SynthError, SynthErrorKind, hexagonal_spacing,
    nested_points, scatter,
};
use dapple_hash::Seed;
use dapple_mesh::Surface;
use glam::DVec3;

/// Maximum number of sites of the finest level.
const SITES_MAX: usize = 1 << 28;
/// Memory per site during repulsion, neighbor lists included, in bytes; measured.
const BYTES_PER_SITE: usize = 220;
/// Maximum number of levels. With 2^28 sites, the 15th level already has a single site.
const LEVELS_MAX: usize = 16;
/// Maximum number of iterations. A larger number is rejected as a mistake, since it would run almost forever.
const ITERATIONS_MAX: usize = 10_000;

/// Default number of times that an exemplar repeats along the longest side of a mesh.
const REPEATS: f64 = 5.0;
/// Maximum number of sites by default. It takes about 13 s of processor time, and gives a site for every one to two
/// texels of a 1024 × 1024 texture.
const DEFAULT_SITES_MAX: usize = 400_000;

/// Maximum mean number of sites within two site spacings of a site. On a single sheet there are about 15.
const NEAR_MAX: f64 = 512.0;
/// Number of random points used to detect crossing sheets.
const POINTS: usize = 1 << 16;
/// Number of points in the sample whose neighbors are counted.
const SAMPLE: usize = 256;

/// Options for a hierarchy of sites.
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchyOptions {
    /// Number of sites on the finest level, from 1 to 2^28; by default 65,536. Each coarser level has a quarter of the
    /// sites of the finer one, rounded up.
    pub n_sites: usize,
    /// Number of levels, from 1 to 16; by default 3.
    pub n_levels: usize,
    /// Seed of the random points that the sites start from; by default `Seed(0)`.
    pub seed: Seed,
    /// Number of repulsion steps for the new sites of each level, at most 10,000; by default 6. The coarsest level
    /// takes four times as many. More than 40 steps change almost nothing.
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
    /// Checks the options and the surface in the same way as [`Hierarchy::new`], in a fraction of the time.
    ///
    /// # Errors
    ///
    /// Same as [`Hierarchy::new`].
    pub fn check(&self, surface: &Surface) -> Result<(), SynthError> {
        let counts = self.counts()?;
        check_crossings(surface, counts[0], self.seed)
    }

    /// Checks the options, and returns the number of sites of each level, finest first.
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
        // A level has a quarter of the sites of the finer one, as in a Gaussian pyramid (section 3).
        let coarser = |&count: &usize| Some(count.div_ceil(4));
        // Reserve the memory and release it at once, so that too many sites cause an error instead of an abort.
        let bytes = self.n_sites.saturating_mul(BYTES_PER_SITE);
        if Vec::<u8>::new().try_reserve_exact(bytes).is_err() {
            return refuse("sites", self.n_sites, "as few as fit into the memory");
        }
        Ok(core::iter::successors(Some(self.n_sites), coarser)
            .take(self.n_levels)
            .collect())
    }
}

/// Sites of all levels, coarsest level first, with the neighbor graph and the grid of every level.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    sites: Sites,
    levels: Vec<Level>,
}

/// One level of a hierarchy. Its sites are the first `n_sites` sites of the hierarchy.
#[derive(Clone, Debug)]
pub struct Level {
    n_sites: usize,
    spacing: f64,
    connected: Connected,
    grid: SiteGrid,
}

impl Hierarchy {
    /// Scatters sites over `surface`, spaces them evenly, and connects them on every level.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless there are 1 to 2^28 sites, 1 to 16 levels and at most 10,000 iterations, or if
    /// the sites do not fit into memory. [`SynthErrorKind::Range`] if the surface crosses itself so often that a site
    /// has on average more than 512 other sites within two site spacings; on a single sheet there are 15.
    pub fn new(surface: &Surface, options: &HierarchyOptions) -> Result<Self, SynthError> {
        options.check(surface)?;
        let counts = options.counts()?;
        let ascending: Vec<usize> = counts.iter().rev().copied().collect();
        // Section 3.1: place the coarsest level first, then add the points of each finer level around it.
        let points = nested_points(surface, &ascending, options.seed, options.iterations);
        let sites = Sites::new(surface, points);
        let levels = counts
            .iter()
            .map(|&n_sites| {
                let spacing = hexagonal_spacing(surface.area(), n_sites);
                let positions = &sites.positions()[..n_sites];
                let grid = SiteGrid::new(positions, 2.0 * spacing);
                // Connect each level by Delaunay triangulations in tangent planes (section 3.1).
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

    /// Returns the sites of the finest level. The sites of each coarser level are the first of them.
    #[must_use]
    pub fn sites(&self) -> &Sites {
        &self.sites
    }

    /// Returns all levels, finest first; `levels()[0]` is the paper's `M_1`.
    #[must_use]
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }
}

/// Returns the number of sites for which an image of `size` pixels repeats about `repeats` times along the longest side
/// of the surface's bounding box. Neighboring sites are then as far apart as the pixels of the image.
///
/// The result is at least 1. See [`repeats_of_sites`] for the inverse.
///
/// # Errors
///
/// [`SynthErrorKind::Range`] unless `repeats` is above 0 and at most 10,000.
///
/// # Examples
///
/// On a square of two triangles, an image of 100 × 100 pixels that repeats five times along each side needs 500 sites
/// along each side. A hexagonal lattice has 2 / sqrt(3) times as many sites as a square one of that spacing.
///
/// ```
/// use dapple_synth::mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::{repeats_of_sites, sites_for_repeats};
///
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
/// let square = Surface::new(Mesh::new(corners, &[[0, 1, 2], [0, 2, 3]])?)?;
/// let n_sites = sites_for_repeats(&square, [100, 100], 5.0)?;
/// assert_eq!(n_sites, 288_675);
/// assert!((repeats_of_sites(&square, [100, 100], n_sites) - 5.0).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sites_for_repeats(
    surface: &Surface,
    size: [u32; 2],
    repeats: f64,
) -> Result<usize, SynthError> {
    let holds = repeats > 0.0 && repeats <= 10_000.0;
    SynthError::check(holds, "number of repeats", repeats, "above 0, up to 10000")?;
    Ok(sites_at(surface, size, repeats))
}

/// Returns the default number of sites for an exemplar of `size` pixels: the image repeats five times along the longest
/// side of the surface's bounding box, or fewer times if that would take more than 400,000 sites.
///
/// See [`sites_for_repeats`] for other numbers of repeats. The result is at least 1.
///
/// # Examples
///
/// ```
/// use dapple_synth::mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::sites_for_exemplar;
///
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
/// let square = Surface::new(Mesh::new(corners, &[[0, 1, 2], [0, 2, 3]])?)?;
/// assert_eq!(sites_for_exemplar(&square, [100, 100]), 288_675);
/// assert_eq!(sites_for_exemplar(&square, [256, 256]), 400_000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn sites_for_exemplar(surface: &Surface, size: [u32; 2]) -> usize {
    sites_at(surface, size, REPEATS).min(DEFAULT_SITES_MAX)
}

/// Returns the number of sites for a number of repeats above 0.
fn sites_at(surface: &Surface, size: [u32; 2], repeats: f64) -> usize {
    // The number of sites is inversely proportional to the square of their spacing.
    let ratio = repeats / repeats_of_sites(surface, size, 1);
    (ratio * ratio).round().clamp(1.0, (1_u64 << 53) as f64) as usize
}

/// Returns the number of times that an image of `size` pixels repeats along the longest side of the surface's bounding
/// box, if there are `n_sites` sites. Inverse of [`sites_for_repeats`].
#[must_use]
pub fn repeats_of_sites(surface: &Surface, size: [u32; 2], n_sites: usize) -> f64 {
    let positions = surface.mesh().positions().iter().copied();
    let low = positions.clone().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.fold(DVec3::NEG_INFINITY, DVec3::max);
    let [width, height] = size.map(f64::from);
    // A repeat covers one site spacing for each pixel; the geometric mean stands for both sides.
    let side = (width * height).sqrt() * hexagonal_spacing(surface.area(), n_sites);
    (high - low).max_element() / side
}

/// Returns an error if `surface` has many sheets that cross each other. Each site would be compared with all sites
/// around it in space, and time would grow with the square of their number.
///
/// The number of nearby sites is estimated before any site is placed, by counting the random points within two site
/// spacings of each point of a sample.
fn check_crossings(surface: &Surface, n_sites: usize, seed: Seed) -> Result<(), SynthError> {
    let n_points = n_sites.min(POINTS);
    let spacing = hexagonal_spacing(surface.area(), n_sites);
    let points = scatter(surface, n_points, seed.child("crossings", 0));
    let positions: Vec<DVec3> = points
        .iter()
        .map(|&point| surface.position(point))
        .collect();
    let grid = SiteGrid::new(&positions, 2.0 * spacing);
    let sample = &positions[..n_points.min(SAMPLE)];
    // Count the random points around each point of the sample.
    let mut n_near = 0_usize;
    for &center in sample {
        grid.visit(center, 2.0 * spacing, |site| {
            let is_near =
                positions[site.index()].distance_squared(center) < 4.0 * spacing * spacing;
            n_near += usize::from(is_near);
        });
    }
    // Scale the count from the random points to all sites.
    let mean = n_near as f64 / sample.len().max(1) as f64 * (n_sites as f64 / n_points as f64);
    let holds = mean <= NEAR_MAX;
    let what =
        "mean number of sites within two spacings of a site, of a surface that crosses itself,";
    SynthError::check(holds, what, mean.round(), "at most 512")
}

impl Level {
    /// Returns the number of sites. The sites of this level are those with a lower index.
    #[must_use]
    pub fn n_sites(&self) -> usize {
        self.n_sites
    }

    /// Returns the site spacing, in units of the mesh. This is the paper's r, the spacing of a hexagonal lattice with
    /// the same number of sites, `sqrt(2 A / (sqrt(3) n))`.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Returns the neighbor graph of the sites.
    #[must_use]
    pub fn graph(&self) -> &SiteGraph {
        &self.connected.graph
    }

    /// Returns the number of edges that are in the star of only one of their two sites: the paper's disagreements.
    #[must_use]
    pub fn one_sided_edges(&self) -> usize {
        self.connected.one_sided
    }

    /// Returns the spatial index that finds the sites near a position.
    #[must_use]
    pub fn grid(&self) -> &SiteGrid {
        &self.grid
    }
}

#[cfg(test)]
mod tests {
    use super::{Hierarchy, HierarchyOptions};
    use crate::SynthErrorKind;
    use crate::shapes::tangle;
    use dapple_mesh::Surface;

    #[test]
    fn surface_that_crosses_itself_too_often_is_refused() {
        let tangle = |n| Surface::new(tangle(n)).unwrap();
        let options = HierarchyOptions::default();
        let error = Hierarchy::new(&tangle(5000), &options).unwrap_err();
        let SynthErrorKind::Range { what, value, .. } = error.kind() else {
            panic!("{error}");
        };
        assert!(what.contains("crosses itself"), "{error}");
        // In a ball of two spacings in the middle of the cube, sites are as dense as in the whole cube. The sheets thin
        // out toward its sides, so there can be several times as many.
        let spacing = crate::hexagonal_spacing(tangle(5000).area(), options.n_sites);
        let ball = 4.0 / 3.0 * core::f64::consts::PI * 8.0 * spacing * spacing * spacing;
        let expected = ball.min(1.0) * options.n_sites as f64;
        assert!(
            (expected / 2.0..expected * 5.0).contains(value),
            "{value}, not {expected}"
        );
        // A few crossing sheets are accepted.
        let few = HierarchyOptions {
            n_sites: 2000,
            ..options
        };
        assert!(Hierarchy::new(&tangle(20), &few).is_ok());
    }
}
