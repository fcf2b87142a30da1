//! Candidates for neighborhood matching: the neighborhoods of the exemplar's pixels, as rows of numbers.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, DOI 10.1145/383259.383297, section 5.
//!
//! Input: the [`Pyramid`] of the exemplar and a [`Pass`], which defines the shape of the neighborhood. Output: a row
//! for each candidate, and the pixel at its center.
//!
//! A row holds the pixels of a neighborhood in a fixed order: part after part, the offsets of a part row by row from
//! the top, and all channels of a pixel. Each value is multiplied by the square root of the part's weight, so the
//! squared distance of two rows is the weighted distance. If the exemplar has guides, the guides of the center pixel
//! are appended.
//!
//! Pixels whose neighborhoods reach past an edge are not candidates, as in the paper. The paper does not cover small
//! levels, where few or none remain: of 8 × 8 pixels, only ten have a complete neighborhood H(7, 0). Here, if fewer
//! than [`FEW`] usable pixels remain, all usable pixels are candidates, and the exemplar is mirrored at its edges. If
//! the exemplar is a layout of several images, each image is counted and mirrored separately.
//!
//! If [`Options::evenness`] is on, all pixels are candidates on all levels. Otherwise the first of three levels would
//! compare only two thirds of the pixels of a 128 × 128 exemplar. Measured on four such exemplars, the distance of
//! colors ([`Likeness`](crate::Likeness)) falls by a third. Passes that read both levels are an exception. They still
//! require [`FEW`] usable pixels, since narrow pieces mirrored at an edge caused specks.
//!
//! The paper centers a neighborhood on the coarser level at half of the coordinates, rounded down. Then four pixels
//! share the same F(n, 1), and the first of them always wins. By default the neighborhood is centered at exactly half,
//! with bilinear interpolation. [`CoarserCenter`] selects between the two.

use crate::error::{SynthError, SynthErrorKind};
use crate::exemplar::Area;
use crate::grid::{self, MAX_SIDE};
use crate::neighborhood::{Part, Pass, Reads};
use crate::{Edges, Exemplar, Options, Pyramid};
use core::ops::Range;

/// Minimum number of neighborhoods that lie within the exemplar. If there are fewer, neighborhoods that reach past an
/// edge are candidates, too.
///
/// Measured on leaves of 64 × 64 pixels with three levels: the distance of patches ([`Likeness`](crate::Likeness)) is
/// 0.061 with no limit, 0.039 with 200, 0.024 with 400 and 0.023 with 1000.
const FEW: usize = 400;

/// Center of a neighborhood on the coarser level, for a pixel whose halved coordinates are not integers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CoarserCenter {
    /// At exactly half of the coordinates, with bilinear interpolation between pixels.
    #[default]
    Exact,
    /// At half of the coordinates, rounded down, as in the paper: four pixels share their neighborhood.
    Floor,
}

/// All candidate neighborhoods of a pass, one row each.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidates {
    /// Number of values per row: offsets times channels of all parts, plus the guides.
    pub(crate) dims: usize,
    /// Values of all rows, stored contiguously, each multiplied by the square root of its part's weight.
    pub(crate) rows: Vec<f32>,
    /// Center pixel of each row, as `row * width + column` of the pass's level of the pyramid; ascending.
    pub(crate) pixels: Vec<u32>,
    /// Edge mode and size of the pass's level.
    edges: Edges,
    size: [u32; 2],
    /// Rectangle of the pixels that have rows: column range and line range.
    inner: [Inner; 2],
    /// For each pixel of the rectangle, the index of its row, or [`NO_ROW`]. `None` if all pixels of the rectangle have
    /// a row.
    row_of: Option<Vec<u32>>,
    /// Neighbors of each pixel if the pixels are sites of a surface; `None` for an image.
    beside: Option<Beside>,
}

/// For each site of a surface, the sites nearest to the positions of a 3 × 3 square of pixels, row by row. The site
/// itself is in the middle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Beside(pub(crate) Vec<[u32; 9]>);

/// Row index of a pixel that is not a candidate.
const NO_ROW: u32 = u32::MAX;

/// Image index of a pixel that is not a candidate.
const NO_AREA: u32 = u32::MAX;

/// Half-open range of columns or lines that have candidates, from `first` up to `end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Inner {
    first: u32,
    end: u32,
}

impl Candidates {
    /// Gathers all neighborhoods of the pass's level that do not reach past an edge. If the exemplar wraps, or if fewer
    /// than 400 would remain, gathers the neighborhoods of all pixels.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Exemplar`] if a side of a level is less than half of a neighborhood's side. If the pass reads
    /// a level that the pyramid does not have, or a part is out of range, the error is the same as from
    /// [`Schedule::check`](crate::Schedule::check).
    pub fn new(pyramid: &Pyramid, pass: &Pass, center: CoarserCenter) -> Result<Self, SynthError> {
        Self::within(pyramid, pass, center, FEW)
    }

    /// Gathers the neighborhoods of a pass, with the center and the evenness of `options`.
    pub(crate) fn for_options(
        pyramid: &Pyramid,
        pass: &Pass,
        options: &Options,
    ) -> Result<Self, SynthError> {
        Self::within(pyramid, pass, options.center, few(pass, options))
    }

    /// Gathers the neighborhoods for a pass of a [repair](crate::PlaneTexture::repair), including those that reach past
    /// an edge.
    ///
    /// The neighborhood of a repaired site near a side of the image contains that side. Only candidates near a side
    /// contain it, too, and they let a border along the side continue.
    pub(crate) fn of_repair(
        pyramid: &Pyramid,
        pass: &Pass,
        center: CoarserCenter,
    ) -> Result<Self, SynthError> {
        Self::within(pyramid, pass, center, usize::MAX)
    }

    /// Creates candidates from sites of a surface. `pixels` has the site of each row, in ascending order.
    pub(crate) fn of_sites(
        level: &Exemplar,
        number: usize,
        rows: Vec<f32>,
        pixels: Vec<u32>,
        beside: Beside,
    ) -> Result<Self, SynthError> {
        if pixels.is_empty() {
            return Err(SynthError::new(SynthErrorKind::Masked { level: number }));
        }
        // Invert the list of sites.
        let mut row_of = vec![NO_ROW; beside.0.len()];
        for (row, &pixel) in (0..).zip(&pixels) {
            row_of[pixel as usize] = row;
        }
        Ok(Self {
            dims: rows.len() / pixels.len(),
            rows,
            pixels,
            edges: Edges::Cut,
            size: level.size,
            inner: level.size.map(|end| Inner { first: 0, end }),
            row_of: Some(row_of),
            beside: Some(beside),
        })
    }

    /// Gathers the neighborhoods that do not reach past an edge, or all if fewer than `few` would remain.
    fn within(
        pyramid: &Pyramid,
        pass: &Pass,
        center: CoarserCenter,
        few: usize,
    ) -> Result<Self, SynthError> {
        // Check the sizes of the levels that are read.
        pass.check(pyramid.levels.len())?;
        for part in &pass.parts {
            check_level(pyramid, pass.level + part.reads.step(), part.side)?;
        }
        // Prepare the sampling of each part in each image of the exemplar.
        let level = &pyramid.levels[pass.level];
        let readers: Vec<Vec<PartReader<'_>>> = (0..level.areas().len())
            .map(|area| {
                let reader = |part| PartReader::new(pyramid, pass.level, part, area);
                pass.parts.iter().map(reader).collect()
            })
            .collect();
        // Find the candidates of each image.
        let mut inner = level.size.map(|end| Inner { first: 0, end });
        let mut n_rows = 0;
        let mut area_of = vec![NO_AREA; level.size[0] as usize * level.size[1] as usize];
        for (number, readers) in readers.iter().enumerate() {
            let (within, pixels) = pixels_of_area(pyramid, pass, center, few, number, readers);
            // Without a mask there is a single image, and its candidates form a rectangle.
            if level.usable.is_none() {
                inner = within;
            }
            n_rows += pixels.len();
            for pixel in pixels {
                area_of[pixel as usize] = number as u32;
            }
        }
        // Allocate the rows.
        let n_values = |part: &Part| part.offsets().len() * level.n_channels;
        let dims = pass.parts.iter().map(n_values).sum::<usize>() + level.n_guides();
        let mut candidates = Self {
            dims,
            rows: Vec::with_capacity(n_rows * dims),
            pixels: Vec::with_capacity(n_rows),
            edges: level.edges,
            size: level.size,
            inner,
            row_of: level.usable.as_ref().map(|_| vec![NO_ROW; area_of.len()]),
            beside: None,
        };
        // Fill the rows in the order of the pixels.
        let guide_scale = guide_scale(pass);
        let mut samples = Vec::new();
        for (pixel, area) in (0u32..).zip(area_of) {
            let Some(readers) = readers.get(area as usize) else {
                continue;
            };
            if let Some(row_of) = &mut candidates.row_of {
                row_of[pixel as usize] = candidates.pixels.len() as u32;
            }
            candidates.pixels.push(pixel);
            let place = [pixel % level.size[0], pixel / level.size[0]];
            for reader in readers {
                let halves = halves(place, reader.reads, center);
                reader.read(halves, &mut samples, &mut candidates.rows);
            }
            let guides = level.guides.of(pixel as usize).iter();
            // The factor makes a guide count as much as a channel that differs at every pixel.
            let guides = guides.map(|value| value * guide_scale);
            candidates.rows.extend(guides);
        }
        if candidates.is_empty() {
            return Err(SynthError::new(SynthErrorKind::Masked {
                level: pass.level,
            }));
        }
        Ok(candidates)
    }

    /// Returns the number of values per neighborhood.
    #[must_use]
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// Returns the number of neighborhoods.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Returns true if there are no neighborhoods.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Returns the values of the neighborhood with index `row`.
    ///
    /// # Panics
    ///
    /// If `row` is not below [`len`](Self::len).
    #[must_use]
    pub fn row(&self, row: usize) -> &[f32] {
        &self.rows[row * self.dims..(row + 1) * self.dims]
    }

    /// Returns the column and row of the pixel at the center of neighborhood `row`, in the exemplar's level.
    ///
    /// # Panics
    ///
    /// If `row` is not below [`len`](Self::len).
    #[must_use]
    pub fn pixel(&self, row: usize) -> [u32; 2] {
        let pixel = self.pixels[row];
        [pixel % self.size[0], pixel / self.size[0]]
    }

    /// Returns the row index of a pixel's neighborhood, or `None` if the pixel is not a candidate. If the exemplar
    /// wraps, the coordinates may be past its edges.
    #[must_use]
    #[inline]
    pub fn row_of_pixel(&self, [mut column, mut line]: [i64; 2]) -> Option<u32> {
        if self.edges == Edges::Wrap {
            column = column.rem_euclid(self.size[0].into());
            line = line.rem_euclid(self.size[1].into());
        }
        // Find the index of the pixel in the rectangle of candidates.
        let [columns, lines] = self.inner;
        let within = columns.contains(column) && lines.contains(line);
        // The cast is exact: the pixel is within the exemplar, which has at most 2^31 pixels.
        let row = || {
            let row = (line as u32 - lines.first) * columns.len() as u32;
            row + (column as u32 - columns.first)
        };
        let row = within.then(row)?;
        // If not all pixels have a row, look it up.
        match &self.row_of {
            None => Some(row),
            Some(row_of) => Some(row_of[row as usize]).filter(|&row| row != NO_ROW),
        }
    }

    /// Returns the index of the neighborhood of the pixel at the offset `[i, j]` from `pixel`. On a surface the offset
    /// is at most 1 along each axis.
    #[inline]
    pub(crate) fn row_beside(&self, pixel: u32, [i, j]: [i32; 2]) -> Option<u32> {
        if let Some(Beside(beside)) = &self.beside {
            // On a surface, the adjacent pixel is the site nearest to the end of the step (i, j).
            let beside = beside[pixel as usize][(3 * (j + 1) + i + 1) as usize];
            return self.row_of_pixel([beside.into(), 0]);
        }
        let [x, y] = [pixel % self.size[0], pixel / self.size[0]].map(i64::from);
        self.row_of_pixel([x + i64::from(i), y + i64::from(j)])
    }

    /// Returns the index of the neighborhood of one of the four children of `coarser`, a pixel of the coarser level,
    /// which has `width` columns. `[i, j]` selects the child (each is 0 or 1).
    #[inline]
    pub(crate) fn row_under(&self, coarser: u32, width: u32, [i, j]: [i32; 2]) -> Option<u32> {
        if self.beside.is_some() {
            // The sites of a level are the first sites of the finer level.
            return self.row_beside(coarser, [i, j]);
        }
        self.row_of_pixel(grid::over(coarser, width, [i, j].map(i64::from)))
    }
}

impl Inner {
    fn len(self) -> usize {
        self.end.saturating_sub(self.first) as usize
    }

    fn contains(self, at: i64) -> bool {
        (i64::from(self.first)..i64::from(self.end)).contains(&at)
    }
}

/// Returns the minimum number of neighborhoods that lie within the exemplar. If there are fewer, neighborhoods past an
/// edge are candidates, too. Unlimited if evenness is on, except in passes that read both levels.
pub(crate) fn few(pass: &Pass, options: &Options) -> usize {
    let reads = |reads| pass.parts.iter().any(|part| part.reads == reads);
    let refines = reads(Reads::Same) && reads(Reads::Coarser);
    if options.evenness > 0.0 && !refines {
        usize::MAX
    } else {
        FEW
    }
}

/// Returns the factor on guide values: the square root of the total weight of all pixels in a neighborhood.
pub(crate) fn guide_scale(pass: &Pass) -> f32 {
    let weight = |part: &Part| part.offsets().len() as f32 * part.weight;
    pass.parts.iter().map(weight).sum::<f32>().sqrt()
}

/// Returns the center of a pixel's neighborhood on the level that is read, in units of half a pixel.
pub(crate) fn halves(pixel: [u32; 2], reads: Reads, center: CoarserCenter) -> [i64; 2] {
    pixel.map(|at| match (reads, center) {
        (Reads::Same, _) => 2 * i64::from(at),
        // Half of a coordinate is as many half pixels as the coordinate has pixels.
        (Reads::Coarser, CoarserCenter::Exact) => i64::from(at),
        (Reads::Coarser, CoarserCenter::Floor) => i64::from(at / 2 * 2),
    })
}

/// Reads one part of a neighborhood from one image of the exemplar.
struct PartReader<'a> {
    level: &'a Exemplar,
    /// Rectangle of the image. Past its edges the edge mode of the level applies.
    area: Area,
    reads: Reads,
    half: i32,
    /// Square root of the part's weight.
    scale: f32,
    /// Ranges of consecutive samples of the square that belong to the part.
    runs: Vec<Range<usize>>,
}

impl<'a> PartReader<'a> {
    fn new(pyramid: &'a Pyramid, level: usize, part: &Part, area: usize) -> Self {
        let half = part.side as i32 / 2;
        let place = |&[i, j]: &[i32; 2]| ((j + half) * (2 * half + 1) + i + half) as usize;
        let read = &pyramid.levels[level + part.reads.step()];
        // Merge consecutive offsets into ranges.
        let mut runs: Vec<Range<usize>> = Vec::new();
        for place in part.offsets().iter().map(place) {
            match runs.last_mut() {
                Some(run) if run.end == place => run.end += 1,
                _ => runs.push(place..place + 1),
            }
        }
        Self {
            level: read,
            area: read.areas()[area],
            reads: part.reads,
            half,
            scale: part.weight.sqrt(),
            runs,
        }
    }

    /// Returns whether the mask allows all pixels of the square around the position `halves`, in units of half a pixel.
    fn is_usable(&self, halves: [i64; 2]) -> bool {
        let Some(usable) = &self.level.usable else {
            return true;
        };
        if self.is_empty() {
            return false;
        }
        let side = 2 * self.half as usize + 1;
        let odd = halves.map(|at| at.rem_euclid(2) as usize);
        let [columns, rows] = self.square(halves);
        rows[..side + odd[1]].iter().all(|row| {
            let row = &usable[row * self.level.size[0] as usize..];
            columns[..side + odd[0]].iter().all(|&column| row[column])
        })
    }

    /// Returns whether the image has no pixel on the level that is read.
    fn is_empty(&self) -> bool {
        (0..2).any(|axis| self.area.first[axis] >= self.area.end[axis])
    }

    /// Returns the columns and rows of the square around the position `halves`, in units of half a pixel.
    fn square(&self, halves: [i64; 2]) -> [[usize; MAX_SIDE]; 2] {
        let Area { first, end } = self.area;
        let size = [0, 1].map(|axis| end[axis] - first[axis]);
        let within = [0, 1].map(|axis| halves[axis] - 2 * i64::from(first[axis]));
        let mut places = grid::square(within, self.half, size, self.level.grid().wrap);
        for (places, first) in places.iter_mut().zip(first) {
            for place in places {
                *place += first as usize;
            }
        }
        places
    }

    /// Appends the weighted values of the part around the position `halves` to `target`. `samples` is scratch memory.
    fn read(&self, halves: [i64; 2], samples: &mut Vec<f32>, target: &mut Vec<f32>) {
        let (half, n) = (self.half, self.level.n_channels);
        let side = 2 * half as usize + 1;
        samples.resize(side * side * n, 0.0);
        let places = self.square(halves);
        self.level
            .grid()
            .read_at(&places, halves, half, -half..=half, samples);
        for run in &self.runs {
            let values = &samples[run.start * n..run.end * n];
            target.extend(values.iter().map(|value| value * self.scale));
        }
    }
}

/// Returns an error if a side of `level` is less than half of `side`, the side of a neighborhood.
fn check_level(pyramid: &Pyramid, level: usize, side: u32) -> Result<(), SynthError> {
    let size = pyramid.levels[level].size;
    if size[0].min(size[1]) > side / 2 {
        return Ok(());
    }
    Err(SynthError::new(SynthErrorKind::Exemplar {
        level,
        size,
        side,
    }))
}

/// Returns the candidates in image `number`, and their bounding rectangle. Only neighborhoods that the mask allows as a
/// whole are candidates. Neighborhoods that reach past an edge are left out unless fewer than `few` would remain.
fn pixels_of_area(
    pyramid: &Pyramid,
    pass: &Pass,
    center: CoarserCenter,
    few: usize,
    number: usize,
    readers: &[PartReader<'_>],
) -> ([Inner; 2], Vec<u32>) {
    let level = &pyramid.levels[pass.level];
    let area = &level.areas()[number];
    // Lists the pixels of a rectangle whose neighborhoods the mask allows.
    let usable = |within: [Inner; 2]| {
        let [columns, lines] = within;
        let places = (lines.first..lines.end)
            .flat_map(move |line| (columns.first..columns.end).map(move |x| [x, line]));
        let is_usable = |place: &[u32; 2]| {
            let is_usable =
                |reader: &PartReader<'_>| reader.is_usable(halves(*place, reader.reads, center));
            readers.iter().all(is_usable)
        };
        let pixel = |[x, line]: [u32; 2]| line * level.size[0] + x;
        places.filter(is_usable).map(pixel).collect::<Vec<_>>()
    };
    // First try the pixels whose neighborhoods do not reach past an edge.
    let all = [0, 1].map(|axis| Inner {
        first: area.first[axis],
        end: area.end[axis],
    });
    let within = [0, 1].map(|axis| inner_of(pyramid, pass, center, number, axis));
    let pixels = usable(within);
    if pixels.len() < few && within != all {
        return (all, usable(all));
    }
    (within, pixels)
}

/// Returns the range along `axis` of an image's pixels whose neighborhoods do not reach past its edges.
fn inner_of(
    pyramid: &Pyramid,
    pass: &Pass,
    center: CoarserCenter,
    area: usize,
    axis: usize,
) -> Inner {
    let along = |level: usize| {
        let Area { first, end } = pyramid.levels[level].areas()[area];
        [first[axis], end[axis]]
    };
    let [first, end] = along(pass.level);
    // Shrink the range for each part that does not wrap.
    let mut inner = Inner { first, end };
    for part in &pass.parts {
        let read: &Exemplar = &pyramid.levels[pass.level + part.reads.step()];
        if read.edges == Edges::Wrap {
            continue;
        }
        let offsets = part.offsets();
        let reaches = || offsets.iter().map(|offset| i64::from(offset[axis]));
        let [before, after] = [reaches().min(), reaches().max()].map(|reach| reach.unwrap_or(0));
        let [start, stop] = along(pass.level + part.reads.step()).map(i64::from);
        let fits = |at: &u32| {
            let halves = halves([*at; 2], part.reads, center)[0];
            let last = (halves + 1).div_euclid(2) + after;
            halves.div_euclid(2) + before >= start && last < stop
        };
        // The pixels that fit are contiguous.
        let first = (inner.first..inner.end).find(fits).unwrap_or(inner.end);
        let end = (first..inner.end)
            .rev()
            .find(fits)
            .map_or(first, |last| last + 1);
        inner = Inner { first, end };
    }
    inner
}

#[cfg(test)]
mod tests;
