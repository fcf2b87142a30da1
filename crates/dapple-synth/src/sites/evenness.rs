//! How even points are on a surface: the distances to nearest neighbors.

use crate::{SiteGrid, SiteIdx, Sites};
use dapple_mesh::Surface;
use dapple_raster::parallel;

/// How far from their nearest neighbors points are, in units of the distance that a hexagonal lattice with as many
/// points on the same area would have.
///
/// Random points have a mean of 0.465 and a minimum near zero; in a hexagonal lattice both are 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evenness {
    /// The mean over all points.
    pub mean: f64,
    /// The least of all points.
    pub min: f64,
}

/// The distance of neighbors in a hexagonal lattice of `n` points on an area: the paper's r, `sqrt(2 A / (sqrt(3) n))`.
///
/// Zero without points.
#[must_use]
pub fn hexagonal_spacing(area: f64, n: usize) -> f64 {
    if n == 0 {
        return 0.0;
    }
    (2.0 * area / (3.0_f64.sqrt() * n as f64)).sqrt()
}

/// Measures how even the first `n` sites are.
///
/// A neighbor whose normal is more than a right angle from a site's own is on another sheet and does not count. A site
/// without a neighbor within four hexagonal distances counts as if it had one there. Without sites both numbers are
/// zero.
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

/// The distance to the nearest neighbor on the same sheet, at most four spacings.
fn nearest(sites: &Sites, grid: &SiteGrid, site: SiteIdx, spacing: f64) -> f64 {
    let (position, normal) = (
        sites.positions()[site.index()],
        sites.normals()[site.index()],
    );
    // Most sites have a neighbor within one and a half spacings, so the wide ball is rarely needed.
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
