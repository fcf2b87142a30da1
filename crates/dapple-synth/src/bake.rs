//! Baking: renders a texture map from the sites (section 6).
//!
//! Texels are processed in small blocks. Within a block, all texels of the same face read the same sites. A texel shows
//! either a weighted mean of the values of the sites around it, as in the paper, or a piece of the exemplar
//! ([`magnify`](crate::magnify)).

use crate::atlas::Atlas;
use crate::domain::{Plain, Samples};
use crate::mesh_domain::{Interpolation, Lattice, NeighborScratch, NeighborhoodView, interpolate};
use crate::{Hierarchy, INTERPOLATION_RADIUS, SynthError, SynthErrorKind};
use dapple_mesh::{FaceIdx, Surface, SurfacePoint};
use dapple_raster::{Raster, parallel, simd};
use glam::DVec3;

/// Side of a block, in texels.
const BLOCK: u32 = 8;
/// Search margin around a group of texels, in multiples of the site spacing. Every point of the surface has a finest
/// site within this distance.
const REACH: f64 = 2.0;

/// Texels of a block that show the same face.
pub(crate) struct Group<'a> {
    pub(crate) surface: &'a Surface,
    pub(crate) face: FaceIdx,
    pub(crate) points: &'a [SurfacePoint],
    /// Origin of the positions in `sites`, in space.
    pub(crate) center: DVec3,
    /// Superset of the finest sites within reach of any texel of the group.
    pub(crate) sites: NeighborhoodView<'a>,
}

/// Computes the values of texels from nearby sites, with scratch memory that is reused from group to group.
pub(crate) trait Paint {
    /// Writes the channels of every point of `group` to `values`, point by point.
    fn paint(&mut self, group: &Group<'_>, values: &mut [f32]);
}

/// Per-thread scratch memory for baking blocks of texels.
struct Memory<'a> {
    /// Texels of the block, sorted by face.
    texels: Vec<(FaceIdx, [u32; 2])>,
    points: Vec<SurfacePoint>,
    nearby: NeighborScratch,
    /// Channels of the group's texels, texel by texel.
    values: Vec<f32>,
    paint: Box<dyn Paint + 'a>,
}

/// Interpolates the values of the finest sites at every texel of an atlas. Texels without a face get `background`.
///
/// `column` has `N` values per site.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] if `column` does not have `N` values per site.
pub fn bake<const N: usize>(
    surface: &Surface,
    hierarchy: &Hierarchy,
    column: &[f32],
    atlas: &Atlas,
    background: [f32; N],
) -> Result<Raster<[f32; N]>, SynthError> {
    let n_sites = hierarchy.sites().len();
    if column.len() != n_sites * N {
        return Err(SynthError::new(SynthErrorKind::Count {
            what: "values at sites",
            count: column.len(),
            needed: "as many for each site as the map has channels",
        }));
    }
    let radius = (hierarchy.levels()[0].spacing() * INTERPOLATION_RADIUS) as f32;
    bake_with(surface, hierarchy, atlas, background, &|| {
        Box::new(Mixed {
            colors: Plain {
                values: column,
                n_channels: N,
            },
            radius,
            lattice: Lattice::default(),
            samples: Samples::default(),
            interpolation: Interpolation::default(),
        })
    })
}

/// Paints every texel of an atlas. Each thread creates its own painter with `painter`. Texels without a face get
/// `background`.
pub(crate) fn bake_with<'a, const N: usize>(
    surface: &Surface,
    hierarchy: &Hierarchy,
    atlas: &Atlas,
    background: [f32; N],
    painter: &(dyn Fn() -> Box<dyn Paint + 'a> + Sync),
) -> Result<Raster<[f32; N]>, SynthError> {
    let size = atlas.size();
    let baker = Baker {
        surface,
        hierarchy,
        atlas,
        background: &background,
        painter,
    };
    let band = |band: usize| {
        let first = band as u32 * BLOCK;
        let values = baker.bake_rows(first..(first + BLOCK).min(size[1]));
        values.as_chunks::<N>().0.to_vec()
    };
    // A texel depends on the sites alone, so bands of rows are independent.
    let bands = parallel::map(size[1].div_ceil(BLOCK) as usize, band);
    Ok(Raster::from_vec(size, bands.concat())?)
}

/// Input shared by all blocks.
struct Baker<'a, 'p> {
    surface: &'a Surface,
    hierarchy: &'a Hierarchy,
    atlas: &'a Atlas,
    background: &'a [f32],
    painter: &'a (dyn Fn() -> Box<dyn Paint + 'p> + Sync),
}

impl Baker<'_, '_> {
    /// Returns the channels of the given rows of the map, texel by texel.
    fn bake_rows(&self, rows: core::ops::Range<u32>) -> Vec<f32> {
        let width = self.atlas.size()[0];
        let n_channels = self.background.len();
        let n_texels = width as usize * rows.len();
        let mut values = self.background.repeat(n_texels);
        let mut memory = Memory {
            texels: Vec::new(),
            points: Vec::new(),
            nearby: NeighborScratch::default(),
            values: Vec::new(),
            paint: (self.painter)(),
        };
        for first in (0..width).step_by(BLOCK as usize) {
            // Collect the texels of the block, and group them by face.
            memory.texels.clear();
            for row in rows.clone() {
                for column in first..(first + BLOCK).min(width) {
                    let texel = [column, row];
                    let face = self.atlas.face(texel);
                    memory.texels.extend(face.map(|face| (face, texel)));
                }
            }
            // The sort is stable, so that the texels of a face stay in row order.
            memory.texels.sort_by_key(|(face, _)| *face);
            let texels = core::mem::take(&mut memory.texels);
            for group in texels.chunk_by(|a, b| a.0 == b.0) {
                self.bake_group(group, &mut memory);
                let channels = memory.values.chunks_exact(n_channels);
                for ((_, [column, row]), channels) in group.iter().zip(channels) {
                    let texel = ((row - rows.start) * width + column) as usize;
                    values[texel * n_channels..][..n_channels].copy_from_slice(channels);
                }
            }
            memory.texels = texels;
        }
        values
    }

    /// Computes the values of the texels in `group`, all of the same face, into `memory.values`.
    fn bake_group(&self, group: &[(FaceIdx, [u32; 2])], memory: &mut Memory<'_>) {
        let surface = self.surface;
        memory.points.clear();
        let points = group
            .iter()
            .map(|(_, texel)| self.atlas.point(surface, *texel));
        memory.points.extend(points.flatten());
        memory.values.clear();
        if memory.points.is_empty() {
            return;
        }
        // Collect the sites around the bounding ball of the texels.
        let positions = || memory.points.iter().map(|&point| surface.position(point));
        let center = positions().sum::<DVec3>() / memory.points.len() as f64;
        let far_sq = positions()
            .map(|at| at.distance_squared(center))
            .fold(0.0, f64::max);
        let spacing = self.hierarchy.levels()[0].spacing();
        // The ball of the texels, extended by the reach, contains the balls around all texels.
        let reach = far_sq.sqrt() + REACH * spacing;
        let group = Group {
            surface,
            face: group[0].0,
            points: &memory.points,
            center,
            sites: memory.nearby.collect_ball(self.hierarchy, 0, center, reach),
        };
        let n_values = memory.points.len() * self.background.len();
        memory.values.resize(n_values, 0.0);
        memory.paint.paint(&group, &mut memory.values);
    }
}

/// Paints weighted means of the sites around each texel (equation 1), with the SIMD code that also reads neighborhoods.
struct Mixed<'a> {
    colors: Plain<'a>,
    radius: f32,
    lattice: Lattice,
    samples: Samples,
    interpolation: Interpolation,
}

impl Paint for Mixed<'_> {
    fn paint(&mut self, group: &Group<'_>, values: &mut [f32]) {
        self.lattice
            .line_up(group.surface, group.points, group.center);
        self.samples.values.resize(values.len(), 0.0);
        self.samples.nearest.resize(group.points.len(), 0);
        // Equation 1 at each texel, on the sites that the group shares.
        let target = (self.colors, &mut self.samples);
        interpolate(
            simd::level(),
            &self.lattice,
            group.sites,
            self.radius,
            target,
            &mut self.interpolation,
        );
        values.copy_from_slice(&self.samples.values);
    }
}

#[cfg(test)]
mod tests;
