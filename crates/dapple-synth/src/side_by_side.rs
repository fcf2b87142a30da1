//! Layouts that place several images side by side in one, for synthesis from several examples.

use crate::exemplar::Area;
use crate::turned::{Turn, Turned};
use crate::{SynthError, SynthErrorKind};
use dapple_color::Normal;
use dapple_raster::Raster;

/// A layout that places several images side by side in one, separated by one empty column each. Every image can also
/// appear [rotated and mirrored](Self::with_turned).
///
/// The joined images and their joined maps form one exemplar, in which each image has [its own
/// edges](crate::Exemplar::with_layout). Textures use no pixels between images. To control where in a texture each
/// image is used, pass its [`membership`](Self::membership) as a [guide](crate::Exemplar::with_guides).
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
    /// Sizes of the images, in pixels.
    images: Vec<[u32; 2]>,
    parts: Vec<Part>,
    size: [u32; 2],
}

/// An image in one of its rotations and reflections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    image: usize,
    turn: Turn,
    /// First column in the joined image.
    first: u32,
    size: [u32; 2],
}

impl SideBySide {
    /// Creates a layout of images of the given sizes, from left to right.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if there are no images, and [`SynthErrorKind::Range`] if the total width is not from 1
    /// to 2^31.
    pub fn new(sizes: &[[u32; 2]]) -> Result<Self, SynthError> {
        Self::laid_out(sizes, Turned::None)
    }

    /// Creates a layout of the same images with the given rotations and reflections. All versions of an image are
    /// adjacent, with the unchanged one first; images retain their order.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if the total width is more than 2^31.
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
        // List every image in every version.
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
        // Place the versions from left to right.
        let mut parts = Vec::with_capacity(sizes.len());
        let mut first = 0;
        for ((image, turn), &size) in ways.zip(&sizes) {
            parts.push(Part {
                image,
                turn,
                first,
                size,
            });
            // Leave a column between images, which the mask excludes.
            first += size[0] + 1;
        }
        let height = sizes.iter().map(|size| size[1]).max().unwrap_or(0);
        Ok(Self {
            images: images.to_vec(),
            parts,
            size: [width as u32, height],
        })
    }

    /// Returns the size of the joined image, in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the size of an image, in pixels. `image` is its index, from 0.
    ///
    /// # Panics
    ///
    /// If the layout has no image with that index.
    #[must_use]
    pub fn size_of(&self, image: usize) -> [u32; 2] {
        self.images[image]
    }

    /// Returns the index (from 0) of the image at a pixel; `None` between images and below the shorter ones.
    #[must_use]
    pub fn image_at(&self, place: [u32; 2]) -> Option<usize> {
        self.part_at(place).map(|part| part.image)
    }

    /// Returns the part at a pixel.
    fn part_at(&self, [column, row]: [u32; 2]) -> Option<&Part> {
        let is_within = |part: &&Part| {
            (part.first..part.first + part.size[0]).contains(&column) && row < part.size[1]
        };
        self.parts.iter().find(is_within)
    }

    /// Returns the rectangles of all parts: each image in all its rotations and reflections.
    pub(crate) fn areas(&self) -> Vec<Area> {
        let area = |part: &Part| Area {
            first: [part.first, 0],
            end: [part.first + part.size[0], part.size[1]],
        };
        self.parts.iter().map(area).collect()
    }

    /// Joins all images into one. Pixels without an image get `between`.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if the number of images differs from the layout's, or [`SynthErrorKind::Raster`] if an
    /// image's size differs from the layout's or the joined image is too large.
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

    /// Joins all normal maps into one. Green points up. Normals are rotated and mirrored with their images; pixels
    /// without an image are flat.
    ///
    /// If images are rotated or mirrored, codes adjacent to the middle count as 0 (see [`Normal::centered`]), so that
    /// flat regions have a single color.
    ///
    /// # Errors
    ///
    /// Same as [`join`](Self::join).
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

    /// Returns the layout's mask: true at pixels that belong to an image.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if the joined image is too large.
    pub fn mask(&self) -> Result<Raster<bool>, SynthError> {
        Ok(Raster::from_fn(self.size, |column, row| {
            self.image_at([column, row]).is_some()
        })?)
    }

    /// Returns the membership mask of an image: 1 at its pixels and 0 at all others. `image` is its index, from 0.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if the joined image is too large.
    pub fn membership(&self, image: usize) -> Result<Raster<f32>, SynthError> {
        Ok(Raster::from_fn(self.size, |column, row| {
            f32::from(self.image_at([column, row]) == Some(image))
        })?)
    }
}

#[cfg(test)]
mod tests;
