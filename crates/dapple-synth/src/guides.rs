//! Guides: additional channels that control where in a texture each part of the exemplar is used.
//!
//! Reference: Hertzmann, Jacobs, Oliver, Curless and Salesin, "Image Analogies", SIGGRAPH 2001, DOI
//! 10.1145/383259.383295.
//!
//! The exemplar has a guide value at each pixel, and the texture at each site. The distance between two neighborhoods
//! includes the difference of the guides at their centers, on the level that is matched, times the number of pixels
//! compared. A guide with a weight of 1 therefore counts as much as a color channel with the same difference at every
//! pixel.

use crate::domain::Plain;
use crate::exemplar::{Area, halved, interleaved, roots};
use crate::grid::Grid;
use crate::{Exemplar, Hierarchy, SynthError, SynthErrorKind};
use dapple_raster::{Raster, Wrap};

/// Guides of an exemplar on one level.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Guides {
    /// Square root of each guide's weight.
    pub(crate) roots: Vec<f32>,
    /// Guide values of every pixel, one per guide, each multiplied by the square root of the guide's weight.
    pub(crate) values: Vec<f32>,
}

/// Guides of a texture on all levels.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Targets {
    /// For each level, the guide values of every site, one per guide, each multiplied by the square root of the guide's
    /// weight.
    levels: Vec<Vec<f32>>,
    /// Number of guides.
    n: usize,
}

impl Exemplar {
    /// Adds guides, each with a weight on its squared differences. Guides are planes of the same size as the exemplar.
    /// Each pixel is preferably used where the texture's guides have values similar to the pixel's.
    ///
    /// The texture needs the same number of guides; see [`synthesize_plane_guided`](crate::synthesize_plane_guided) and
    /// [`Synthesizer::synthesize_guided`](crate::Synthesizer::synthesize_guided). With a weight of 1, a guide counts as
    /// much as one color channel. With colors from 0 to 1 and a weight equal to the number of channels, the texture
    /// follows a guide of zeros and ones nearly everywhere.
    ///
    /// # Errors
    ///
    /// Same as [`from_planes`](Self::from_planes), and [`SynthErrorKind::Raster`] if a guide is not the same size as
    /// the exemplar.
    pub fn with_guides(self, guides: &[(&Raster<f32>, f32)]) -> Result<Self, SynthError> {
        for (guide, _) in guides {
            guide.check_same_size(self.size)?;
        }
        let (planes, weights): (Vec<_>, Vec<_>) = guides.iter().copied().unzip();
        let roots = roots(&weights)?;
        let values = interleaved(&planes, &roots)?;
        Ok(Self {
            guides: Guides { roots, values },
            ..self
        })
    }

    /// Returns the number of [guides](Self::with_guides).
    #[must_use]
    pub fn n_guides(&self) -> usize {
        self.guides.roots.len()
    }
}

impl Guides {
    /// Returns the guides of the next coarser level. `size` is the size of this level, and `areas` are the rectangles
    /// of the images in it.
    pub(crate) fn halved(&self, size: [u32; 2], wrap: [Wrap; 2], areas: &[Area]) -> Self {
        Self {
            roots: self.roots.clone(),
            values: halved(&self.grid(size, wrap), areas),
        }
    }

    /// Returns the values of all guides at `pixel`.
    pub(crate) fn of(&self, pixel: usize) -> &[f32] {
        let n = self.roots.len();
        &self.values[pixel * n..][..n]
    }

    fn grid(&self, size: [u32; 2], wrap: [Wrap; 2]) -> Grid<Plain<'_>> {
        let colors = Plain {
            values: &self.values,
            n_channels: self.roots.len(),
        };
        Grid { colors, size, wrap }
    }
}

impl Targets {
    /// Builds the guides of a texture in the plane, on levels of the given sizes.
    pub(crate) fn of_plane(
        exemplar: &Exemplar,
        guides: &[&Raster<f32>],
        sizes: &[[u32; 2]],
        wrap: [Wrap; 2],
    ) -> Result<Self, SynthError> {
        check_count(guides.len(), exemplar.n_guides())?;
        let roots = exemplar.guides.roots.clone();
        let values = interleaved(guides, &roots)?;
        let mut guide = Guides { roots, values };
        let mut levels = Vec::new();
        for &size in sizes {
            let [first, end] = [[0; 2], size];
            // Reduce the guide by the filter of the exemplar's pyramid, so that both have the same resolution.
            let coarser = guide.halved(size, wrap, &[Area { first, end }]);
            levels.push(core::mem::replace(&mut guide, coarser).values);
        }
        Ok(Self {
            levels,
            n: guides.len(),
        })
    }

    /// Builds the guides of a texture on a surface, from one value per finest site for each guide.
    pub(crate) fn of_surface(
        exemplar: &Exemplar,
        guides: &[&[f32]],
        hierarchy: &Hierarchy,
        n_levels: usize,
    ) -> Result<Self, SynthError> {
        let n = guides.len();
        check_count(n, exemplar.n_guides())?;
        let mut levels: Vec<Vec<f32>> = hierarchy.levels()[..n_levels]
            .iter()
            .map(|level| vec![0.0; level.n_sites() * n])
            .collect();
        for (at, (guide, root)) in guides.iter().zip(&exemplar.guides.roots).enumerate() {
            let n_sites = hierarchy.sites().len();
            if guide.len() != n_sites {
                return Err(SynthError::new(SynthErrorKind::Count {
                    what: "values of a guide",
                    count: guide.len(),
                    needed: "as many as sites",
                }));
            }
            if let Some(&value) = guide.iter().find(|value| !value.is_finite()) {
                let range = "finite";
                SynthError::check(false, "value of a guide", value.into(), range)?;
            }
            // Weight the values, and filter them from level to level.
            let mut column: Vec<f32> = guide.iter().map(|value| value * root).collect();
            for (level, values) in levels.iter_mut().enumerate() {
                if level > 0 {
                    column = hierarchy.downsample(level - 1, &column)?;
                }
                for (values, &value) in values.chunks_exact_mut(n).zip(&column) {
                    values[at] = value;
                }
            }
        }
        Ok(Self { levels, n })
    }

    /// Returns the number of guides.
    pub(crate) fn len(&self) -> usize {
        self.n
    }

    /// Returns the values of all guides at `site` on `level`.
    pub(crate) fn of(&self, level: usize, site: u32) -> &[f32] {
        &self.levels[level][site as usize * self.n..][..self.n]
    }
}

/// Returns an error unless the texture has `expected` guides, the number of the exemplar's guides.
pub(crate) fn check_count(count: usize, expected: usize) -> Result<(), SynthError> {
    if count == expected {
        return Ok(());
    }
    Err(SynthError::new(SynthErrorKind::Count {
        what: "guides of the texture",
        count,
        needed: "as many as the exemplar has",
    }))
}

#[cfg(test)]
mod tests;
