//! Repair: re-synthesizes part of a texture and leaves everything around it unchanged.
//!
//! Reference: Sylvain Lefebvre and Hugues Hoppe, "Parallel Controllable Texture Synthesis", SIGGRAPH 2005, DOI
//! 10.1145/1073204.1073261, for correction passes that visit distant pixels in parallel, and repeat.
//!
//! A sweep would know only one side of a hole. In a repair, every pixel of a level has a color before any is visited,
//! including pixels inside the hole, and each compares its full neighborhood.
//!
//! On the coarsest level, a hole starts as the piece of the exemplar that fits its surroundings best. If no piece is as
//! large as the hole, it starts with random pixels. On finer levels, a pixel starts with the continuation of its
//! parent's source, as in the paper of 2005.

use super::{PlaneDomain, PlaneTexture};
use crate::domain::{Colors as _, Start, UNKNOWN};
use crate::engine::Progress;
use crate::exemplar::{covered, taps};
use crate::{Exemplar, Options, Pyramid, Schedule, SynthError};
use core::ops::ControlFlow;
use dapple_raster::Raster;

/// Maximum inscribed radius of a hole on the coarsest level, in pixels, for which [`repair_levels`] adds no level.
const COARSE_RADIUS: u32 = 6;

/// Minimum shorter side of the coarsest level, in pixels, for [`repair_levels`].
const COARSE_SIDE: u32 = 16;

/// Returns the number of levels that fills a hole: at least 3, and the smallest number for which the inscribed radius of
/// the hole is at most 6 pixels on the coarsest level. The shorter side of that level is at least 16 pixels if there are
/// more than 3 levels.
///
/// The radius is the largest distance of a pixel of the hole from the nearest other pixel, the maximum of columns and
/// rows. Long scratches are as narrow as small spots.
///
/// # Examples
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_synth::repair_levels;
///
/// let hole = |side: u32| Raster::from_fn([600, 600], |x, y| x.max(y) < side);
/// assert_eq!([hole(24)?, hole(25)?, hole(400)?].map(|hole| repair_levels(&hole)), [3, 4, 6]);
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
#[must_use]
pub fn repair_levels(hole: &Raster<bool>) -> usize {
    let radius = inscribed_radius(hole);
    let [width, height] = hole.size();
    let shorter = width.min(height);
    let mut n_levels = Options::default().n_levels;
    while radius.div_ceil(1 << (n_levels - 1)) > COARSE_RADIUS && shorter >> n_levels >= COARSE_SIDE
    {
        n_levels += 1;
    }
    n_levels
}

/// Returns the largest chessboard distance of a pixel of the hole from a pixel that is kept. Pixels outside are not kept.
fn inscribed_radius(hole: &Raster<bool>) -> u32 {
    let [width, height] = hole.size().map(|side| side as usize);
    let far = width.max(height) as u32;
    let distance = |&is_made: &bool| if is_made { far } else { 0 };
    let mut distances: Vec<u32> = hole.pixels().iter().map(distance).collect();
    // Pass the distances on from the top left, and then, in the reverse order, from the bottom right.
    for _ in 0..2 {
        for row in 0..height {
            for column in 0..width {
                let mut least = u32::MAX;
                if column > 0 {
                    least = distances[row * width + column - 1];
                }
                if row > 0 {
                    let above = &distances[(row - 1) * width..row * width];
                    let near = &above[column.saturating_sub(1)..(column + 2).min(width)];
                    least = near
                        .iter()
                        .fold(least, |least, &distance| least.min(distance));
                }
                let distance = &mut distances[row * width + column];
                *distance = (*distance).min(least.saturating_add(1));
            }
        }
        distances.reverse();
    }
    distances.into_iter().max().unwrap_or(0)
}

/// Side of the square tiles that define the visiting order, in pixels. It is larger than the reach of a 7 × 7
/// neighborhood, so that consecutive sites, one per tile, do not wait for each other.
const STRIDE: u32 = 4;

/// Rank in the visiting order of each site within a tile. Sites of consecutive ranks are far apart.
const DITHER: [[u8; STRIDE as usize]; STRIDE as usize] =
    [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// Width of the ring around a hole that is compared with the exemplar, in pixels; equal to the reach of a neighborhood.
const RING: i64 = 3;

/// Penalty factor on the squared differences of a piece that lacks part of its ring. Such a piece wins against a
/// complete one only with less than half the deviation. Part of a ring rarely is that much more similar by chance.
const PARTIAL: f64 = 4.0;

impl PlaneTexture {
    /// Creates a texture identical to the exemplar: every pixel is its own source.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) if the exemplar has no pixels.
    pub fn identity(exemplar: &Exemplar) -> Result<Self, SynthError> {
        Ok(Self {
            sources: Raster::from_fn(exemplar.size, |column, row| [column, row])?,
            edges: [exemplar.edges; 2],
            exemplar_size: exemplar.size,
            exemplar_edges: exemplar.edges,
        })
    }

    /// Re-synthesizes the pixels at which a mask is true. All others keep their sources.
    ///
    /// Use this to remove scratches, or objects that do not belong to a texture: take the photograph [without the
    /// defects](Exemplar::with_mask) as the exemplar, and its [`identity`](Self::identity) as the texture.
    ///
    /// Large holes need more levels than the default: [`repair_levels`] returns their number.
    ///
    /// If the options have no schedule, [`Schedule::repair`] is used. Sites are visited in an order in which
    /// consecutive ones are far apart. [`Options::evenness`] has no effect, because a small region need not use the
    /// whole exemplar.
    ///
    /// # Errors
    ///
    /// Same as [`synthesize_plane_with`](crate::synthesize_plane_with), or
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) if the mask and the texture have different sizes, or
    /// if the exemplar is not the same size as the texture's.
    ///
    /// # Examples
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use dapple_raster::Raster;
    /// use dapple_synth::{Edges, Exemplar, Options, PlaneTexture};
    ///
    /// // A checker with a spot in it.
    /// let is_spot = |x: u32, y: u32| x.abs_diff(30) < 4 && y.abs_diff(27) < 4;
    /// let photo = Raster::from_fn([64, 64], |x, y| match is_spot(x, y) {
    ///     true => 0.5,
    ///     false => f32::from((x / 4 + y / 4) % 2 == 0),
    /// })?;
    /// let clean = Raster::from_fn([64, 64], |x, y| !is_spot(x, y))?;
    /// let exemplar = Exemplar::from_planes(&[(&photo, 1.0)], Edges::Cut)?.with_mask(&clean)?;
    /// let hole = clean.map(|is_clean| !is_clean);
    /// let options = Options { n_levels: 2, ..Options::default() };
    /// let repaired = PlaneTexture::identity(&exemplar)?
    ///     .repair(&exemplar, &hole, &options, |_| ControlFlow::Continue(()))?
    ///     .transfer(&photo)?;
    /// assert_eq!(repaired.row(27)[30], f32::from((30 / 4 + 27 / 4) % 2 == 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn repair(
        &self,
        exemplar: &Exemplar,
        mask: &Raster<bool>,
        options: &Options,
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Self, SynthError> {
        self.sources.check_same_size(mask.size())?;
        Raster::filled(self.exemplar_size, ())?.check_same_size(exemplar.size)?;
        let schedule = options.schedule.clone();
        let options = Options {
            schedule: Some(schedule.unwrap_or_else(|| Schedule::repair(options.n_levels))),
            evenness: 0.0,
            ..options.clone()
        };
        let pyramid = exemplar.pyramid(options.n_levels)?;
        let mut domain = PlaneDomain::new(mask.size(), self.edges, &options)?;
        domain.starts = self.starts(mask, &pyramid, &domain)?;
        Self::grown(&domain, &pyramid, &options, &mut callback)
    }

    /// Computes the initial pixels of the sites on each level.
    fn starts(
        &self,
        mask: &Raster<bool>,
        pyramid: &Pyramid,
        domain: &PlaneDomain,
    ) -> Result<Vec<Start>, SynthError> {
        let mut starts = Vec::new();
        let mut sources = self.sources.clone();
        let mut is_kept = mask.map(|&is_made| !is_made);
        // Fixed sites start with their sources. Other sites start with theirs only if the pixel is usable.
        for exemplar in pyramid.levels() {
            if !starts.is_empty() {
                (sources, is_kept) = coarser(&sources, &is_kept, domain)?;
            }
            let pixel = |(&[column, row], &is_kept): (&[u32; 2], &bool)| {
                let pixel = row * exemplar.size[0] + column;
                let is_usable = is_kept || exemplar.is_usable(pixel as usize);
                if is_usable { pixel } else { UNKNOWN }
            };
            let sites = sources.pixels().iter().zip(is_kept.pixels());
            starts.push(Start {
                pixels: sites.map(pixel).collect(),
                is_kept: is_kept.pixels().to_vec(),
            });
        }
        // Fill the holes of the coarsest level with the pieces that fit best.
        if let (Some(start), Some(exemplar)) = (starts.last_mut(), pyramid.levels().last()) {
            let level = pyramid.levels().len() - 1;
            for hole in holes(start, domain, level) {
                hole.fill(start, domain, level, exemplar);
            }
        }
        Ok(starts)
    }
}

/// Computes the sources and the mask of kept sites on the next coarser level. A coarser site is kept if the four finer
/// sites that it covers are kept.
fn coarser(
    sources: &Raster<[u32; 2]>,
    is_kept: &Raster<bool>,
    domain: &PlaneDomain,
) -> Result<(Raster<[u32; 2]>, Raster<bool>), SynthError> {
    let size = sources.size();
    let half = size.map(|side| side.div_ceil(2));
    // The coarser pixel (x, y) is centered on the finer pixel (2x, 2y), in the texture as in the exemplar.
    let halved = |column: u32, row: u32| sources.row(2 * row)[2 * column as usize].map(|at| at / 2);
    let all_kept = |column, row| {
        let columns = taps(column, size[0], domain.wrap[0]);
        let rows = taps(row, size[1], domain.wrap[1]);
        covered(rows).all(|row| covered(columns).all(|column| is_kept.row(row as u32)[column]))
    };
    Ok((
        Raster::from_fn(half, halved)?,
        Raster::from_fn(half, all_kept)?,
    ))
}

/// A connected group of sites without an initial pixel, and the ring of sites around it.
struct Hole {
    /// Columns and rows of the sites. If the hole crosses a wrapping edge, they continue past the size of the texture.
    sites: Vec<[i64; 2]>,
    ring: Vec<[i64; 2]>,
}

/// Returns the holes of a level.
fn holes(start: &Start, domain: &PlaneDomain, level: usize) -> Vec<Hole> {
    let [width, height] = domain.sizes[level].map(i64::from);
    let mut found = vec![false; start.pixels.len()];
    let mut holes = Vec::new();
    for first in 0..start.pixels.len() {
        if found[first] || start.pixels[first] != UNKNOWN {
            continue;
        }
        // Grow the hole from its first site; diagonal neighbors are connected.
        found[first] = true;
        let mut sites = vec![[first as i64 % width, first as i64 / width]];
        let mut at = 0;
        while at < sites.len() {
            for site in square(sites[at], 1) {
                if let Some(index) = domain.index(level, site)
                    && !found[index]
                    && start.pixels[index] == UNKNOWN
                {
                    found[index] = true;
                    sites.push(site);
                }
            }
            at += 1;
        }
        // Collect the known sites around the hole.
        let mut in_ring = vec![false; (width * height) as usize];
        let mut ring = Vec::new();
        for place in sites.iter().flat_map(|&site| square(site, RING)) {
            if let Some(index) = domain.index(level, place)
                && !in_ring[index]
                && start.pixels[index] != UNKNOWN
            {
                in_ring[index] = true;
                ring.push(place);
            }
        }
        holes.push(Hole { sites, ring });
    }
    holes
}

/// Returns the pixels at most `reach` columns and rows from a pixel, which is included.
fn square([column, row]: [i64; 2], reach: i64) -> impl Iterator<Item = [i64; 2]> {
    let rows = row - reach..=row + reach;
    rows.flat_map(move |row| (column - reach..=column + reach).map(move |column| [column, row]))
}

impl Hole {
    /// Fills the sites with the piece of the exemplar whose ring is most similar to the ring of the hole; of equally
    /// similar pieces, with the first in row-major order. If the hole is larger than every piece, the sites remain
    /// unknown.
    ///
    /// On the coarsest level of a small image, a piece may lack part of its ring, which reaches past an edge or into
    /// the hole. Pieces with at least half of their ring are compared by that part, but their squared differences are
    /// multiplied by [`PARTIAL`].
    fn fill(&self, start: &mut Start, domain: &PlaneDomain, level: usize, exemplar: &Exemplar) {
        let pixel_of = |place: [i64; 2]| {
            let pixel = exemplar.pixel_at(place);
            pixel.filter(|&pixel| exemplar.is_usable(pixel))
        };
        // If the exemplar consists of several images, a piece is within one of them.
        let areas = exemplar.areas();
        let width = exemplar.size[0] as usize;
        let area_of = |pixel: usize| {
            if areas.len() == 1 {
                return Some(0);
            }
            let place = [(pixel % width) as u32, (pixel / width) as u32];
            areas.iter().position(|area| area.contains(place))
        };
        let colors = exemplar.plain();
        // Colors of the ring around the hole.
        let painted: Vec<([i64; 2], &[f32])> = self
            .ring
            .iter()
            .filter_map(|&place| {
                let site = domain.index(level, place)?;
                Some((place, colors.of(start.pixels[site] as usize)))
            })
            .collect();
        let [width, height] = exemplar.size.map(i64::from);
        let [column, row] = self.sites[0];
        let n_least = painted.len().div_ceil(2);
        // Sum of squared differences of a piece's ring, if below a limit.
        let difference = |offset: [i64; 2], limit: f64| {
            let moved = |[column, row]: [i64; 2]| pixel_of([column + offset[0], row + offset[1]]);
            let area = moved([column, row]).and_then(&area_of);
            let moved = |place| moved(place).filter(|&pixel| area_of(pixel) == area);
            // The piece must contain a usable pixel for every site of the hole.
            if !self.sites.iter().all(|&site| moved(site).is_some()) {
                return None;
            }
            let (mut sum, mut n_there) = (0.0, painted.len());
            for (place, color) in &painted {
                let Some(pixel) = moved(*place) else {
                    n_there -= 1;
                    if n_there < n_least {
                        return None;
                    }
                    continue;
                };
                let other = colors.of(pixel).iter();
                let squares = other
                    .zip(*color)
                    .map(|(a, b)| f64::from(a - b) * f64::from(a - b));
                sum += squares.sum::<f64>();
                // The sum only grows, so this piece cannot become the best.
                if sum >= limit {
                    return None;
                }
            }
            // Scale the sum to the whole ring, with the penalty.
            if n_there < painted.len() {
                sum *= PARTIAL * painted.len() as f64 / n_there as f64;
                // If nothing differs, a piece with its whole ring wins.
                sum += f64::MIN_POSITIVE;
            }
            (sum < limit).then_some(sum)
        };
        // Compare the piece at every offset from the hole within the exemplar.
        let mut best = (f64::INFINITY, None);
        for offset in (0..height).flat_map(|y| (0..width).map(move |x| [x - column, y - row])) {
            if let Some(sum) = difference(offset, best.0) {
                best = (sum, Some(offset));
            }
        }
        let Some([x, y]) = best.1 else { return };
        // Copy the piece.
        for &[column, row] in &self.sites {
            let site = domain.index(level, [column, row]);
            if let (Some(site), Some(pixel)) = (site, pixel_of([column + x, row + y])) {
                start.pixels[site] = pixel as u32;
            }
        }
    }
}

/// Returns the sites to synthesize in visiting order: one site of each tile of [`STRIDE`] columns and rows, then the
/// next site of each tile, and so on.
pub(super) fn order(start: &Start, width: u32) -> Vec<u32> {
    let in_square = |site: u32| {
        let [column, row] = [site % width, site / width].map(|at| (at % STRIDE) as usize);
        DITHER[row][column]
    };
    let sites = (0..start.is_kept.len() as u32).filter(|&site| !start.is_kept[site as usize]);
    let mut order: Vec<u32> = sites.collect();
    order.sort_by_key(|&site| in_square(site));
    order
}

#[cfg(test)]
mod tests;
