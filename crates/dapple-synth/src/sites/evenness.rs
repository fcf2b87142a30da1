//! Evenness of points on a surface, measured by nearest-neighbor distances.

use crate::{SiteGrid, SiteIdx, Sites};
use dapple_mesh::Surface;
use dapple_raster::parallel;

/// Evenness of points, as nearest-neighbor distances relative to the spacing of a hexagonal lattice with the same
/// number of points on the same area.
///
/// Random points have a mean of 0.465 and a minimum near zero; in a hexagonal lattice both are 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evenness {
    /// Mean over all points.
    pub mean: f64,
    /// Minimum over all points.
    pub min: f64,
}

/// Returns the spacing of a hexagonal lattice of `n` points on the given area. This is the paper's r:
/// `sqrt(2 A / (sqrt(3) n))`.
///
/// Returns 0 if `n` is 0.
#[must_use]
pub fn hexagonal_spacing(area: f64, n: usize) -> f64 {
    if n == 0 {
        return 0.0;
    }
    (2.0 * area / (3.0_f64.sqrt() * n as f64)).sqrt()
}

/// Measures how evenly the first `n` sites are spaced.
///
/// A neighbor whose normal is more than 90 degrees from the site's normal is on another sheet and does not count. If a
/// site has no neighbor within four hexagonal spacings, its distance counts as four spacings. Without sites, mean and
/// minimum are 0.
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::{Sites, evenness, scatter};
///
/// let triangle = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let surface = Surface::new(triangle)?;
/// let sites = Sites::new(&surface, scatter(&surface, 1000, Seed(7)));
/// assert!(evenness(&surface, &sites, 1000).mean < 0.6);
/// # Ok::<(), dapple_synth::SynthError>(())
/// ```
#[must_use]
pub fn evenness(surface: &Surface, sites: &Sites, n: usize) -> Evenness {
    let n = n.min(sites.len());
    if n == 0 {
        return Evenness {
            mean: 0.0,
            min: 0.0,
        };
    }
    let spacing = hexagonal_spacing(surface.area(), n);
    let grid = SiteGrid::new(&sites.positions()[..n], 2.0 * spacing);
    let ratios = parallel::map(n, |site| {
        nearest(sites, &grid, SiteIdx(site as u32), spacing) / spacing
    });
    Evenness {
        mean: ratios.iter().sum::<f64>() / n as f64,
        min: ratios.iter().copied().fold(f64::INFINITY, f64::min),
    }
}

/// Returns the distance to the nearest neighbor on the same sheet, clamped to four spacings.
fn nearest(sites: &Sites, grid: &SiteGrid, site: SiteIdx, spacing: f64) -> f64 {
    let (position, normal) = (
        sites.positions()[site.index()],
        sites.normals()[site.index()],
    );
    // Most sites have a neighbor within 1.5 spacings, so the large radius is rarely needed.
    for reach in [1.5 * spacing, 4.0 * spacing] {
        let mut least = reach;
        grid.visit(position, reach, |other| {
            let distance = position.distance(sites.positions()[other.index()]);
            if other != site
                && distance < least
                && normal.dot(sites.normals()[other.index()]) >= 0.0
            {
                least = distance;
            }
        });
        if least < reach {
            return least;
        }
    }
    4.0 * spacing
}

#[cfg(test)]
mod tests;
