//! Baking: a texture map from the sites (section 6).
//!
//! Texels are taken in small blocks; those of one face of a block read the same sites. What a texel shows is either a mean
//! of the values at the sites around it, as in the paper, or the exemplar itself ([`magnify`](crate::magnify)).

use crate::atlas::Atlas;
use crate::ground::{Plain, Samples};
use crate::mesh_ground::{Around, Interpolation, Lattice, Nearby, interpolate};
use crate::{Hierarchy, INTERPOLATION_RADIUS, SynthError, SynthErrorKind};
use dapple_mesh::{FaceIdx, Surface, SurfacePoint};
use dapple_raster::{Raster, parallel, simd};
use glam::DVec3;

/// The sides of a block in texels.
const BLOCK: u32 = 8;
/// The reach within which there is a site of the finest level of a piece of the surface, in spacings.
const REACH: f64 = 2.0;

/// Texels of one face, close together.
pub(crate) struct Group<'a> {
    pub(crate) surface: &'a Surface,
    pub(crate) face: FaceIdx,
    pub(crate) points: &'a [SurfacePoint],
    /// The position in space that those of `sites` are relative to.
    pub(crate) center: DVec3,
    /// The finest sites that can reach one of the texels, and some more.
    pub(crate) sites: Around<'a>,
}

/// A way to get the values of texels from the sites around them.
pub(crate) trait Paint<const N: usize>: Sync {
    /// Memory that is kept from group to group.
    type Memory: Default;

    /// Writes a value for every point of the group.
    fn paint(&self, group: &Group<'_>, memory: &mut Self::Memory, values: &mut [[f32; N]]);
}

/// Memory of a thread that bakes blocks of texels.
struct Memory<const N: usize, M> {
    /// The texels of a block by face.
    texels: Vec<(FaceIdx, [u32; 2])>,
    points: Vec<SurfacePoint>,
    nearby: Nearby,
    values: Vec<[f32; N]>,
    paint: M,
}

/// Mixes the values of the finest sites at every texel of an atlas; `background` where there is no face.
///
/// `column` has `N` values for each site.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] for another number of values.
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
    bake_with(
        surface,
        hierarchy,
        atlas,
        background,
        &Mixed { column, radius },
    )
}

/// Paints every texel of an atlas; `background` where there is no face.
pub(crate) fn bake_with<const N: usize>(
    surface: &Surface,
    hierarchy: &Hierarchy,
    atlas: &Atlas,
    background: [f32; N],
    paint: &impl Paint<N>,
) -> Result<Raster<[f32; N]>, SynthError> {
    let size = atlas.size();
    let baker = Baker {
        surface,
        hierarchy,
        atlas,
        paint,
    };
    let band = |band: usize| {
        let first = band as u32 * BLOCK;
        baker.bake_rows(first..(first + BLOCK).min(size[1]), background)
    };
    let bands = parallel::map(size[1].div_ceil(BLOCK) as usize, band);
    Ok(Raster::from_vec(size, bands.concat())?)
}

/// The input of all blocks.
struct Baker<'a, P> {
    surface: &'a Surface,
    hierarchy: &'a Hierarchy,
    atlas: &'a Atlas,
    paint: &'a P,
}

impl<P> Baker<'_, P> {
    fn bake_rows<const N: usize>(
        &self,
        rows: core::ops::Range<u32>,
        background: [f32; N],
    ) -> Vec<[f32; N]>
    where
        P: Paint<N>,
    {
        let width = self.atlas.size()[0];
        let mut values = vec![background; (width * (rows.end - rows.start)) as usize];
        let mut memory = Memory::<N, P::Memory>::default();
        for first in (0..width).step_by(BLOCK as usize) {
            memory.texels.clear();
            for row in rows.clone() {
                for column in first..(first + BLOCK).min(width) {
                    let texel = [column, row];
                    let face = self.atlas.face(texel);
                    memory.texels.extend(face.map(|face| (face, texel)));
                }
            }
            // Stable, so that the texels of a face stay row by row.
            memory.texels.sort_by_key(|(face, _)| *face);
            let texels = core::mem::take(&mut memory.texels);
            for group in texels.chunk_by(|a, b| a.0 == b.0) {
                self.bake_group(group, &mut memory);
                for ((_, [column, row]), value) in group.iter().zip(&memory.values) {
                    values[((row - rows.start) * width + column) as usize] = *value;
                }
            }
            memory.texels = texels;
        }
        values
    }

    /// Fills `memory.values` with those of some texels of one face.
    fn bake_group<const N: usize>(
        &self,
        group: &[(FaceIdx, [u32; 2])],
        memory: &mut Memory<N, P::Memory>,
    ) where
        P: Paint<N>,
    {
        let surface = self.surface;
        memory.points.clear();
        let points = group
            .iter()
            .map(|(_, texel)| self.atlas.point(surface, *texel));
        memory.points.extend(points.flatten());
        let positions = || memory.points.iter().map(|&point| surface.position(point));
        let center = positions().sum::<DVec3>() / memory.points.len().max(1) as f64;
        let far_sq = positions()
            .map(|at| at.distance_squared(center))
            .fold(0.0, f64::max);
        let spacing = self.hierarchy.levels()[0].spacing();
        let reach = far_sq.sqrt() + REACH * spacing;
        let group = Group {
            surface,
            face: group[0].0,
            points: &memory.points,
            center,
            sites: memory.nearby.collect_ball(self.hierarchy, 0, center, reach),
        };
        memory.values.resize(memory.points.len(), [0.0; N]);
        self.paint
            .paint(&group, &mut memory.paint, &mut memory.values);
    }
}

impl<const N: usize, M: Default> Default for Memory<N, M> {
    fn default() -> Self {
        Self {
            texels: Vec::new(),
            points: Vec::new(),
            nearby: Nearby::default(),
            values: Vec::new(),
            paint: M::default(),
        }
    }
}

/// Means of the values at the sites around: equation 1, in the registers that also read the neighborhoods.
struct Mixed<'a> {
    column: &'a [f32],
    radius: f32,
}

impl<const N: usize> Paint<N> for Mixed<'_> {
    type Memory = (Lattice, Samples, Interpolation);

    fn paint(&self, group: &Group<'_>, memory: &mut Self::Memory, values: &mut [[f32; N]]) {
        let (lattice, samples, interpolation) = memory;
        lattice.line_up(group.surface, group.points, group.center);
        samples.values.resize(group.points.len() * N, 0.0);
        samples.nearest.resize(group.points.len(), 0);
        let colors = Plain {
            values: self.column,
            n_channels: N,
        };
        let target = (colors, &mut *samples);
        interpolate(
            simd::level(),
            lattice,
            group.sites,
            self.radius,
            target,
            interpolation,
        );
        for (value, mixed) in values.iter_mut().zip(samples.values.chunks_exact(N)) {
            value.copy_from_slice(mixed);
        }
    }
}

#[cfg(test)]
mod tests;
