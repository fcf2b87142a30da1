//! Result of a synthesis on a surface.

use crate::domain::Colors as _;
use crate::lift::LiftedPlaces;
use crate::places::Places;
use crate::{Pyramid, SynthError, SynthErrorKind};
use dapple_raster::Raster;

/// Result of a synthesis on a surface: the colors of a hierarchy's sites, and their sources in the exemplar.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceTexture {
    levels: Vec<Level>,
    n_channels: usize,
    /// Sources of the finest sites if they are positions on another surface.
    pub(crate) lifted: Option<LiftedPlaces>,
    /// Sources of the finest sites if they are positions between pixels.
    pub(crate) places: Option<Places>,
    /// Rotation of the exemplar at each finest site, in quarter turns; empty if the orientation field has no symmetry.
    pub(crate) quarters: Vec<u8>,
}

/// Colors and sources of the sites of a level; empty if no pass visited it.
#[derive(Clone, Debug, PartialEq)]
struct Level {
    values: Vec<f32>,
    /// Source pixel of each site, as `row * width + column`.
    sources: Vec<u32>,
    /// Size of the exemplar on this level, in pixels.
    size: [u32; 2],
}

impl SurfaceTexture {
    /// Creates a texture from the source pixels of the sites on each level of a pyramid. `places` are the subpixel
    /// sources of the finest sites, if there are any.
    pub(crate) fn new(pyramid: &Pyramid, sources: Vec<Vec<u32>>, places: Option<Places>) -> Self {
        let exemplars = pyramid.levels();
        let levels = exemplars.iter().zip(sources).map(|(exemplar, sources)| {
            let colors = exemplar.plain();
            let values = sources.iter().flat_map(|&pixel| colors.of(pixel as usize));
            Level {
                values: values.copied().collect(),
                size: exemplar.size(),
                sources,
            }
        });
        Self {
            levels: levels.collect(),
            n_channels: exemplars.first().map_or(0, |exemplar| exemplar.n_channels),
            places,
            lifted: None,
            quarters: Vec::new(),
        }
    }

    /// Returns the positions on another surface at which texels sample its maps; `None` if the texture is not lifted or
    /// if texels interpolate the values of sites.
    pub(crate) fn lifted_between(&self) -> Option<&LiftedPlaces> {
        self.lifted.as_ref().filter(|places| !places.is_mixed)
    }

    /// Returns the number of finest sites.
    pub(crate) fn n_sites(&self) -> usize {
        self.levels.first().map_or(0, |level| level.sources.len())
    }

    /// Returns the number of values per site, which equals the exemplar's number of channels.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        self.n_channels
    }

    /// Returns the values of the sites of a level, `n_channels` per site, in the exemplar's units. Level 0 is the
    /// finest. Empty for a level that no pass visited.
    ///
    /// # Panics
    ///
    /// If the texture does not have that level.
    #[must_use]
    pub fn values(&self, level: usize) -> &[f32] {
        &self.levels[level].values
    }

    /// Returns the source of each site of a level: column and row in the same level of the exemplar's pyramid.
    ///
    /// # Panics
    ///
    /// If the texture does not have that level.
    pub fn sources(&self, level: usize) -> impl ExactSizeIterator<Item = [u32; 2]> {
        let level = &self.levels[level];
        let width = level.size[0].max(1);
        level
            .sources
            .iter()
            .map(move |pixel| [pixel % width, pixel / width])
    }

    /// Returns the values of a map at the sources of the finest sites. The map must be the same size as the exemplar.
    /// Colors, heights, normals and roughness follow the same sources. For a [lifted](crate::Synthesizer::lift)
    /// texture, the map may have any size and is read at the exemplar's texture coordinates.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if the map is not the same size as the exemplar, or [`SynthErrorKind::Count`] if no
    /// pass visited the finest level.
    pub fn transfer<T: Copy>(&self, map: &Raster<T>) -> Result<Vec<T>, SynthError> {
        let Level { size, sources, .. } = &self.levels[0];
        if self.lifted.is_none() {
            map.check_same_size(*size)?;
        }
        if sources.is_empty() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "passes over the finest level",
                count: 0,
                needed: "at least 1",
            }));
        }
        if let Some(lifted) = &self.lifted {
            return Ok(lifted.transfer(map));
        }
        let pixels = map.pixels();
        Ok(sources
            .iter()
            .map(|&pixel| pixels[pixel as usize])
            .collect())
    }
}
