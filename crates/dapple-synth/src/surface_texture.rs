//! What a synthesis on a surface made.

use crate::engine::LevelTexture;
use crate::{SynthError, SynthErrorKind};
use dapple_raster::Raster;

/// Colors at the sites of a hierarchy, and which pixels of the exemplar they are from.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceTexture {
    pub(crate) levels: Vec<LevelTexture>,
    /// The sizes of the levels of the exemplar.
    pub(crate) sizes: Vec<[u32; 2]>,
    pub(crate) n_channels: usize,
}

impl SurfaceTexture {
    /// The number of values at a site, that of the exemplar's channels.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        self.n_channels
    }

    /// The values at the sites of a level, 0 the finest, `n_channels` for each, as the exemplar has them; empty for a level
    /// that no pass visited.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    #[must_use]
    pub fn values(&self, level: usize) -> &[f32] {
        &self.levels[level].colors
    }

    /// The column and row of the pixel that each site of a level is from, in that level of the exemplar's pyramid.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    pub fn sources(&self, level: usize) -> impl ExactSizeIterator<Item = [u32; 2]> {
        let width = self.sizes[level][0].max(1);
        let sources = &self.levels[level].sources;
        sources
            .iter()
            .map(move |pixel| [pixel % width, pixel / width])
    }

    /// What another map of the exemplar's size has at the sources of the finest sites: how colors, heights, normals and
    /// roughness follow what was matched.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] for a map of another size, [`SynthErrorKind::Count`] if no pass visited the finest level.
    pub fn transfer<T: Copy>(&self, map: &Raster<T>) -> Result<Vec<T>, SynthError> {
        map.check_same_size(self.sizes[0])?;
        let sources = &self.levels[0].sources;
        if sources.is_empty() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "passes over the finest level",
                count: 0,
                needed: "at least 1",
            }));
        }
        let pixels = map.pixels();
        Ok(sources
            .iter()
            .map(|&pixel| pixels[pixel as usize])
            .collect())
    }
}
