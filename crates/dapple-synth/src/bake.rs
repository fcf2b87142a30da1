//! Baking: a texture map from the values at the sites (section 6).
//!
//! Texels are taken in small blocks; those of one face of a block read the same sites, and go through the registers that
//! also read the neighborhoods.

use crate::atlas::Atlas;
use crate::ground::{Plain, Samples};
use crate::mesh_ground::{Interpolation, Lattice, Nearby, interpolate};
use crate::{Hierarchy, INTERPOLATION_RADIUS, SynthError, SynthErrorKind};
use dapple_mesh::{FaceIdx, Surface, SurfacePoint};
use dapple_raster::{Raster, parallel, simd};
use glam::DVec3;

/// The sides of a block in texels.
const BLOCK: u32 = 8;
/// The reach within which there is a site of the finest level of a piece of the surface, in spacings.
const REACH: f64 = 2.0;

/// Memory of a thread that bakes blocks of texels.
#[derive(Debug, Default)]
struct Memory {
    /// The texels of a block by face.
    texels: Vec<(FaceIdx, [u32; 2])>,
    points: Vec<SurfacePoint>,
    lattice: Lattice,
    nearby: Nearby,
    samples: Samples,
    interpolation: Interpolation,
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
    let size = atlas.size();
    let baker = Baker {
        surface,
        hierarchy,
        column,
        atlas,
    };
    let n_bands = size[1].div_ceil(BLOCK);
    let band = |band: u32| {
        let rows = band * BLOCK..((band + 1) * BLOCK).min(size[1]);
        baker.bake_rows::<N>(rows, background)
    };
    let bands = parallel::map(n_bands as usize, |number| band(number as u32));
    Ok(Raster::from_vec(size, bands.concat())?)
}

/// The input of all blocks.
struct Baker<'a> {
    surface: &'a Surface,
    hierarchy: &'a Hierarchy,
    column: &'a [f32],
    atlas: &'a Atlas,
}

impl Baker<'_> {
    fn bake_rows<const N: usize>(
        &self,
        rows: core::ops::Range<u32>,
        background: [f32; N],
    ) -> Vec<[f32; N]> {
        let width = self.atlas.size()[0];
        let mut values = vec![background; (width * (rows.end - rows.start)) as usize];
        let mut memory = Memory::default();
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
                self.bake_group::<N>(group, &mut memory);
                for ((_, [column, row]), value) in
                    group.iter().zip(memory.samples.values.chunks_exact(N))
                {
                    let at = (row - rows.start) * width + column;
                    values[at as usize].copy_from_slice(value);
                }
            }
            memory.texels = texels;
        }
        values
    }

    /// Fills `memory.samples` with the values at some texels of one face.
    fn bake_group<const N: usize>(&self, group: &[(FaceIdx, [u32; 2])], memory: &mut Memory) {
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
        let sites = memory.nearby.collect_ball(self.hierarchy, 0, center, reach);
        memory.lattice.line_up(surface, &memory.points, center);
        memory.samples.values.resize(memory.points.len() * N, 0.0);
        memory.samples.nearest.resize(memory.points.len(), 0);
        let colors = Plain {
            values: self.column,
            n_channels: N,
        };
        interpolate(
            simd::level(),
            &memory.lattice,
            sites,
            (spacing * INTERPOLATION_RADIUS) as f32,
            (colors, &mut memory.samples),
            &mut memory.interpolation,
        );
    }
}

#[cfg(test)]
mod tests;
