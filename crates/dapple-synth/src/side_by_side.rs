//! Several images in one, for a texture of several examples.

use crate::exemplar::Area;
use crate::turned::{Turn, Turned};
use crate::{SynthError, SynthErrorKind};
use dapple_color::Normal;
use dapple_raster::Raster;

/// Where several images lie in one that holds them all: side by side, a column of no image between them. Each
/// may lie there [turned and mirrored](Self::with_turned), too.
///
/// Joined images and their joined maps make one exemplar, in which each image has
/// [edges of its own](crate::Exemplar::with_layout). What lies between them is in no texture. With the [`membership`](Self::membership) of each image as a [guide](crate::Exemplar::with_guides), the caller
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
/// let exemplar = Exemplar::from_planes(&[(&both, 1.0)], Edges::Cut)?.with_layout(&layout)?;
/// let options = Options { n_levels: 2, ..Options::default() };
/// let texture = synthesize_plane(&exemplar, [48, 48], [Edges::Cut; 2], &options)?;
/// assert!(texture.sources().pixels().iter().all(|&source| layout.image_at(source).is_some()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SideBySide {
    /// The sizes of the images.
    images: Vec<[u32; 2]>,
    parts: Vec<Part>,
    size: [u32; 2],
}

/// An image in one of the ways in which it lies there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    image: usize,
    turn: Turn,
    /// The first column.
    first: u32,
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
        Self::laid_out(sizes, Turned::None)
    }

    /// The layout of the same images, each turned and mirrored in all the given ways: those of the first image come first,
    /// beginning with the image as it is.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] for a width of all together that is more than 2^31.
    pub fn with_turned(self, turned: Turned) -> Result<Self, SynthError> {
        Self::laid_out(&self.images, turned)
    }

    fn laid_out(images: &[[u32; 2]], turned: Turned) -> Result<Self, SynthError> {
        if images.is_empty() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "images side by side",
                count: 0,
                needed: "at least 1",
            }));
        }
        let ways = turned.ways();
        let of_image = |image: usize| ways.iter().map(move |&turn| (image, turn));
        let ways = (0..images.len()).flat_map(of_image);
        let sizes: Vec<_> = ways
            .clone()
            .map(|(image, turn)| turn.size(images[image]))
            .collect();
        let width: u64 = sizes.iter().map(|size| u64::from(size[0])).sum();
        let width = width + sizes.len() as u64 - 1;
        let holds = (1..=1 << 31).contains(&width);
        SynthError::check(holds, "width of all images", width as f64, "from 1 to 2^31")?;
        let mut parts = Vec::with_capacity(sizes.len());
        let mut first = 0;
        for ((image, turn), &size) in ways.zip(&sizes) {
            parts.push(Part {
                image,
                turn,
                first,
                size,
            });
            first += size[0] + 1;
        }
        let height = sizes.iter().map(|size| size[1]).max().unwrap_or(0);
        Ok(Self {
            images: images.to_vec(),
            parts,
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
        self.images[image]
    }

    /// The image that a pixel belongs to, from 0; nothing between them and below the lower ones.
    #[must_use]
    pub fn image_at(&self, place: [u32; 2]) -> Option<usize> {
        self.part_at(place).map(|part| part.image)
    }

    /// The part that a pixel belongs to.
    fn part_at(&self, [column, row]: [u32; 2]) -> Option<&Part> {
        let is_within = |part: &&Part| {
            (part.first..part.first + part.size[0]).contains(&column) && row < part.size[1]
        };
        self.parts.iter().find(is_within)
    }

    /// The rectangles of the images, in all the ways in which they lie.
    pub(crate) fn areas(&self) -> Vec<Area> {
        let area = |part: &Part| Area {
            first: [part.first, 0],
            end: [part.first + part.size[0], part.size[1]],
        };
        self.parts.iter().map(area).collect()
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
        for (image, &size) in images.iter().zip(&self.images) {
            image.check_same_size(size)?;
        }
        Ok(Raster::from_fn(self.size, |column, row| {
            let Some(part) = self.part_at([column, row]) else {
                return between;
            };
            let place = [column - part.first, row];
            let [column, row] = part.turn.pixel(place, self.images[part.image]);
            images[part.image].row(row)[column as usize]
        })?)
    }

    /// All normal maps in one, with green up, turned as the images are; flat where no image is.
    ///
    /// Where images are turned or mirrored, codes next to the middle count as 0 (see [`Normal::centered`]), so that what is
    /// flat stays one color.
    ///
    /// # Errors
    ///
    /// Those of [`join`](Self::join).
    pub fn join_normals(&self, images: &[&Raster<Normal>]) -> Result<Raster<Normal>, SynthError> {
        let joined = self.join(images, Normal::FLAT)?;
        let is_turned = self.parts.iter().any(|part| part.turn != Turn::default());
        Ok(Raster::from_fn(self.size, |column, row| {
            let normal = joined.row(row)[column as usize];
            let normal = if is_turned { normal.centered() } else { normal };
            let part = self.part_at([column, row]);
            part.map_or(normal, |part| part.turn.normal(normal))
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
