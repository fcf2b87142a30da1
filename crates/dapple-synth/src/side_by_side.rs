//! Several images in one, for a texture of several examples.

use crate::{SynthError, SynthErrorKind};
use dapple_raster::Raster;

/// Where several images lie in one that holds them all: side by side, a column of no image between them.
///
/// Joined images and their joined maps make one exemplar. [`mask`](Self::mask) keeps what lies between the images out of
/// textures; with the [`membership`](Self::membership) of each image as a [guide](crate::Exemplar::with_guides), the caller
/// says which of them goes where.
///
/// # Examples
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_synth::{Edges, Exemplar, Options, SideBySide, synthesize_plane};
///
/// let dots = Raster::from_fn([32, 32], |x, y| f32::from(x % 4 == 0 && y % 4 == 0))?;
/// let bars = Raster::from_fn([24, 40], |x, _| f32::from(x % 3 == 0))?;
/// let layout = SideBySide::new(&[dots.size(), bars.size()])?;
/// assert_eq!(layout.size(), [32 + 1 + 24, 40]);
/// let both = layout.join(&[&dots, &bars], 0.0)?;
/// let exemplar = Exemplar::from_planes(&[(&both, 1.0)], Edges::Cut)?.with_mask(&layout.mask()?)?;
/// let options = Options { n_levels: 2, ..Options::default() };
/// let texture = synthesize_plane(&exemplar, [48, 48], [Edges::Cut; 2], &options)?;
/// assert!(texture.sources().pixels().iter().all(|&source| layout.image_at(source).is_some()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SideBySide {
    /// The first column of each image, and its size.
    images: Vec<(u32, [u32; 2])>,
    size: [u32; 2],
}

impl SideBySide {
    /// The layout of images of these sizes, from left to right.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] for no image, and [`SynthErrorKind::Range`] for a width of all together that is not from 1
    /// to 2^31.
    pub fn new(sizes: &[[u32; 2]]) -> Result<Self, SynthError> {
        if sizes.is_empty() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "images side by side",
                count: 0,
                needed: "at least 1",
            }));
        }
        let width: u64 = sizes.iter().map(|size| u64::from(size[0])).sum();
        let width = width + sizes.len() as u64 - 1;
        let holds = (1..=1 << 31).contains(&width);
        SynthError::check(holds, "width of all images", width as f64, "from 1 to 2^31")?;
        let mut images = Vec::with_capacity(sizes.len());
        let mut first = 0;
        for &size in sizes {
            images.push((first, size));
            first += size[0] + 1;
        }
        let height = sizes.iter().map(|size| size[1]).max().unwrap_or(0);
        Ok(Self {
            images,
            size: [width as u32, height],
        })
    }

    /// The size of the image that holds all others.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The size of an image, from 0.
    ///
    /// # Panics
    ///
    /// If there is no such image.
    #[must_use]
    pub fn size_of(&self, image: usize) -> [u32; 2] {
        self.images[image].1
    }

    /// The image that a pixel belongs to, from 0; nothing between them and below the lower ones.
    #[must_use]
    pub fn image_at(&self, [column, row]: [u32; 2]) -> Option<usize> {
        let is_within = |&(first, size): &(u32, [u32; 2])| {
            (first..first + size[0]).contains(&column) && row < size[1]
        };
        self.images.iter().position(is_within)
    }

    /// All images in one, with `between` where no image is.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] for another number of images, [`SynthErrorKind::Raster`] for images of other sizes than
    /// those of the layout, and if all together are too large.
    pub fn join<T: Copy + Send + Sync>(
        &self,
        images: &[&Raster<T>],
        between: T,
    ) -> Result<Raster<T>, SynthError> {
        if images.len() != self.images.len() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "images to join",
                count: images.len(),
                needed: "as many as the layout has",
            }));
        }
        for (image, &(_, size)) in images.iter().zip(&self.images) {
            image.check_same_size(size)?;
        }
        Ok(Raster::from_fn(self.size, |column, row| {
            match self.image_at([column, row]) {
                Some(at) => images[at].row(row)[(column - self.images[at].0) as usize],
                None => between,
            }
        })?)
    }

    /// Whether there is an image at each pixel.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if all together are too large.
    pub fn mask(&self) -> Result<Raster<bool>, SynthError> {
        Ok(Raster::from_fn(self.size, |column, row| {
            self.image_at([column, row]).is_some()
        })?)
    }

    /// 1 at the pixels of one image, from 0, and 0 at those of all others.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if all together are too large.
    pub fn membership(&self, image: usize) -> Result<Raster<f32>, SynthError> {
        Ok(Raster::from_fn(self.size, |column, row| {
            f32::from(self.image_at([column, row]) == Some(image))
        })?)
    }
}

#[cfg(test)]
mod tests;
