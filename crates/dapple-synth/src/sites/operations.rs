//! The four operations on a mesh hierarchy: interpolation, low-pass, down- and upsampling of columns of values.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.2. A
//! column holds a value for each site of a level. How strongly to blur before downsampling is not in the paper: here
//! until a spot has the variance of Burt and Adelson's kernel 1-4-6-4-1 on pixels of one spacing.

use super::low_pass::check_length;
use super::oriented::Oriented;
use crate::{Blend, Hierarchy, LowPass, SiteTriangles, SynthError};
use dapple_raster::parallel;
use glam::DVec3;

/// The part t of the steps of [`Hierarchy::downsample`], which is the paper's example.
pub const DOWNSAMPLE_T: f64 = 0.1;
/// The number of steps of [`Hierarchy::downsample`]: each adds half of t to the variance, in squared spacings, and 1 is
/// wanted.
pub const DOWNSAMPLE_STEPS: usize = 20;

/// The sites that one thread works on at a time.
const CHUNK: usize = 1024;

impl Hierarchy {
    /// The value at a position of the surface: equation 1, with `w(x) = 2x³ - 3x² + 1` and the radius
    /// [`INTERPOLATION_RADIUS`](crate::INTERPOLATION_RADIUS) spacings of the level.
    ///
    /// Sites whose normal is more than a right angle from `normal` are on another sheet and do not count. Where no site
    /// is in reach, the nearest one of a wider ball counts alone; there is no value where none is within 8 radii.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if there is no such level,
    /// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if `column` does not have a value for each site of it.
    #[inline]
    pub fn interpolate<T: Blend>(
        &self,
        level: usize,
        column: &[T],
        position: DVec3,
        normal: DVec3,
    ) -> Result<Option<T>, SynthError> {
        let sites = self.oriented(level)?;
        check_length("values", column.len(), sites.positions.len())?;
        Ok(sites.interpolate(column, position, normal))
    }

    /// The filter for columns of a level.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if there is no such level.
    pub fn low_pass(&self, level: usize) -> Result<LowPass<'_>, SynthError> {
        let sites = self.oriented(level)?;
        LowPass::new(self.levels()[level].graph(), sites.positions)
    }

    /// The column of the next coarser level: the values of a level, blurred, at the sites that both have.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if there is no such level or none below it,
    /// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if `column` does not have a value for each site of it.
    pub fn downsample<T: Blend>(&self, level: usize, column: &[T]) -> Result<Vec<T>, SynthError> {
        let n_sites = self.oriented(level.saturating_add(1))?.positions.len();
        let mut column = column.to_vec();
        self.low_pass(level)?
            .apply(&mut column, DOWNSAMPLE_T, DOWNSAMPLE_STEPS)?;
        column.truncate(n_sites);
        Ok(column)
    }

    /// The column of the next finer level: the values of a level, interpolated at all sites of the finer one.
    ///
    /// # Errors
    ///
    /// Those of [`upsample_into`](Self::upsample_into).
    pub fn upsample<T: Blend>(&self, level: usize, column: &[T]) -> Result<Vec<T>, SynthError> {
        let n_sites = self.finer(level)?.positions.len();
        let mut finer = vec![T::ZERO; n_sites];
        self.upsample_into(level, column, &mut finer)?;
        Ok(finer)
    }

    /// Interpolates, as [`upsample`](Self::upsample) does, into a column that there is.
    ///
    /// Where interpolation finds no value, as on a small piece of the surface that has no site of the coarser level,
    /// that of the nearest site anywhere is taken.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if there is no such level or none above it,
    /// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if a column does not have a value for each site of its
    /// level.
    pub fn upsample_into<T: Blend>(
        &self,
        level: usize,
        column: &[T],
        finer: &mut [T],
    ) -> Result<(), SynthError> {
        let (sites, to) = (self.oriented(level)?, self.finer(level)?);
        check_length("values", column.len(), sites.positions.len())?;
        check_length("values of the finer level", finer.len(), to.positions.len())?;
        parallel::for_each_chunk(finer, CHUNK, |chunk, values| {
            for (site, value) in (chunk * CHUNK..).zip(values) {
                let (position, normal) = (to.positions[site], to.normals[site]);
                let nearest = || {
                    sites
                        .nearest_of_all(position)
                        .map(|site| column[site.index()])
                };
                if let Some(new) = sites.interpolate(column, position, normal).or_else(nearest) {
                    *value = new;
                }
            }
        });
        Ok(())
    }

    /// The sites of a level as the vertices of a triangle mesh, for export: see [`SiteTriangles`] for what is repaired.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if there is no such level.
    pub fn triangles(&self, level: usize) -> Result<SiteTriangles, SynthError> {
        SiteTriangles::new(&self.oriented(level)?)
    }

    /// The sites of a level.
    fn oriented(&self, level: usize) -> Result<Oriented<'_>, SynthError> {
        let exists = level < self.levels().len();
        SynthError::check(
            exists,
            "level",
            level as f64,
            "that of a level of the hierarchy",
        )?;
        let at = &self.levels()[level];
        Ok(Oriented {
            positions: &self.sites().positions()[..at.n_sites()],
            normals: &self.sites().normals()[..at.n_sites()],
            grid: at.grid(),
            spacing: at.spacing(),
        })
    }

    /// The sites of the level above one.
    fn finer(&self, level: usize) -> Result<Oriented<'_>, SynthError> {
        SynthError::check(
            level > 0,
            "level",
            level as f64,
            "at least 1, to have a finer one",
        )?;
        self.oriented(level - 1)
    }
}

#[cfg(test)]
mod tests;
