//! The four operations on a mesh hierarchy: interpolation, low-pass filter, down- and upsampling of columns of values.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.2. A
//! column holds one value for each site of a level. The paper does not say how much to blur before downsampling. Here a
//! spot is blurred to the same variance as with Burt and Adelson's kernel 1-4-6-4-1 on pixels one site spacing apart.

use super::low_pass::check_length;
use super::oriented::Oriented;
use crate::{Blend, Hierarchy, LowPass, SiteTriangles, SynthError};
use dapple_raster::parallel;
use glam::DVec3;

/// Strength t of each low-pass step of [`Hierarchy::downsample`], from the paper's example.
pub const DOWNSAMPLE_T: f64 = 0.1;
/// Number of low-pass steps of [`Hierarchy::downsample`]. Each adds t / 2 to the variance, in multiples of the squared
/// site spacing; the target is 1.
pub const DOWNSAMPLE_STEPS: usize = 20;

/// Number of sites in one parallel task.
const CHUNK: usize = 1024;

impl Hierarchy {
    /// Interpolates `column` at `position` by equation 1, with `w(x) = 2x³ - 3x² + 1`. The radius is
    /// [`INTERPOLATION_RADIUS`](crate::INTERPOLATION_RADIUS) times the level's site spacing.
    ///
    /// Sites whose normal is more than 90 degrees from `normal` are on another sheet and do not count. If no site is in
    /// reach, the result is the value of the nearest site up to 8 radii away, or `None` if there is none.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if the level does not exist, and
    /// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if `column` does not have one value for each site of the
    /// level.
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

    /// Returns the low-pass filter for columns of `level`.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if the level does not exist.
    pub fn low_pass(&self, level: usize) -> Result<LowPass<'_>, SynthError> {
        let sites = self.oriented(level)?;
        LowPass::new(self.levels()[level].graph(), sites.positions)
    }

    /// Downsamples `column` to the next coarser level: blurs the values, and returns them at the sites that both levels
    /// share.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if the level or the next coarser one does not exist, and
    /// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if `column` does not have one value for each site of the
    /// level.
    pub fn downsample<T: Blend>(&self, level: usize, column: &[T]) -> Result<Vec<T>, SynthError> {
        let n_sites = self.oriented(level.saturating_add(1))?.positions.len();
        let mut column = column.to_vec();
        self.low_pass(level)?
            .apply(&mut column, DOWNSAMPLE_T, DOWNSAMPLE_STEPS)?;
        // The sites of the coarser level are the first ones; they inherit their blurred values (section 3.2).
        column.truncate(n_sites);
        Ok(column)
    }

    /// Upsamples `column` to the next finer level: returns the values interpolated at all sites of the finer level.
    ///
    /// # Errors
    ///
    /// Same as [`upsample_into`](Self::upsample_into).
    pub fn upsample<T: Blend>(&self, level: usize, column: &[T]) -> Result<Vec<T>, SynthError> {
        let n_sites = self.finer(level)?.positions.len();
        let mut finer = vec![T::ZERO; n_sites];
        self.upsample_into(level, column, &mut finer)?;
        Ok(finer)
    }

    /// Upsamples like [`upsample`](Self::upsample), into the existing column `finer`.
    ///
    /// Where interpolation finds no value, the value of the nearest site of the whole surface is used. This happens on
    /// a small piece of the surface that has no site on the coarser level.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if the level or the next finer one does not exist, and
    /// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if a column does not have one value for each site of its
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
                // Equation 1 on the coarser level, at the position of the finer site.
                if let Some(new) = sites.interpolate(column, position, normal).or_else(nearest) {
                    *value = new;
                }
            }
        });
        Ok(())
    }

    /// Triangulates the sites of `level`, for export. See [`SiteTriangles`] for the counts of triangles and holes.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if the level does not exist.
    pub fn triangles(&self, level: usize) -> Result<SiteTriangles, SynthError> {
        SiteTriangles::new(&self.oriented(level)?)
    }

    /// Returns the sites of `level`.
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

    /// Returns the sites of the next finer level.
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
