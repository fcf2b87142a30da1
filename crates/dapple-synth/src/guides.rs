//! Guides: values beside those that a texture gets, which say where in it which part of the exemplar goes.
//!
//! Reference: Hertzmann, Jacobs, Oliver, Curless and Salesin, "Image Analogies", SIGGRAPH 2001, DOI
//! 10.1145/383259.383295.
//!
//! The exemplar has guides at its pixels, and the texture at its sites. To the distance of two neighborhoods comes that of
//! the guides in their middles, on the level that is matched, times the number of pixels that are compared: a guide with the
//! weight 1 counts as much as a channel of the colors that is off by as much everywhere.

use crate::exemplar::{Area, halved, interleaved, roots};
use crate::grid::Grid;
use crate::ground::Plain;
use crate::{Exemplar, Hierarchy, SynthError, SynthErrorKind};
use dapple_raster::{Raster, Wrap};

/// The guides of an exemplar, of one level.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Guides {
    /// The roots of their weights.
    pub(crate) roots: Vec<f32>,
    /// One value of each guide for every pixel, times the root of its weight.
    pub(crate) values: Vec<f32>,
}

/// The guides of a texture.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Targets {
    /// For each level one value of each guide for every site, times the root of its weight.
    levels: Vec<Vec<f32>>,
    /// The number of guides.
    n: usize,
}

impl Exemplar {
    /// This exemplar with guides, each with the weight of its squared differences: planes of its size that say which of its
    /// pixels go where a texture has the same values.
    ///
    /// A texture of it needs as many guides: [`synthesize_plane_guided`](crate::synthesize_plane_guided) and
    /// [`Synthesizer::synthesize_guided`](crate::Synthesizer::synthesize_guided). With the weight 1 a guide counts as much
    /// as one channel of the colors; with as much as there are channels, of colors from 0 to 1, a guide of zeros and ones
    /// is obeyed nearly everywhere.
    ///
    /// # Errors
    ///
    /// Those of [`from_planes`](Self::from_planes), and [`SynthErrorKind::Raster`] for guides of another size.
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

    /// The number of [guides](Self::with_guides).
    #[must_use]
    pub fn n_guides(&self) -> usize {
        self.guides.roots.len()
    }
}

impl Guides {
    /// The guides of the next coarser level of an image of a size, in which images have these rectangles.
    pub(crate) fn halved(&self, size: [u32; 2], wrap: [Wrap; 2], areas: &[Area]) -> Self {
        Self {
            roots: self.roots.clone(),
            values: halved(&self.grid(size, wrap), areas),
        }
    }

    /// The values at a pixel.
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
    /// The guides of a texture in the plane, on levels of these sizes.
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
            let coarser = guide.halved(size, wrap, &[Area { first, end }]);
            levels.push(core::mem::replace(&mut guide, coarser).values);
        }
        Ok(Self {
            levels,
            n: guides.len(),
        })
    }

    /// The guides of a texture on a surface: for each a value for every site.
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

    /// The number of guides.
    pub(crate) fn len(&self) -> usize {
        self.n
    }

    /// The values at a site of a level.
    pub(crate) fn of(&self, level: usize, site: u32) -> &[f32] {
        &self.levels[level][site as usize * self.n..][..self.n]
    }
}

/// Refuses guides of a texture that are not as many as those of the exemplar.
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
