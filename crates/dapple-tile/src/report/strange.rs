//! Strangeness, which measures how much a tile near its seams differs from the source.
//!
//! Sample squares of pixels across and next to the wrap are compared with all squares of the source. Parts that were
//! cut or moved as a whole have a match there; a stain, an interrupted line, or a double exposure has none. The
//! distance of a good match depends on the image, so squares of the source are compared with the rest of the source,
//! too. The measure is the mean distance of the tile's squares to their nearest match, as a multiple of the mean
//! distance of the source's squares.
//!
//! The measure is taken at two scales. A cut through grass is detected in squares of 8 × 8 pixels. A course of bricks
//! that ends at the cut looks like any other joint at that scale; only larger squares have no match in the source.
//! Sources above 256 × 256 pixels are reduced, so that all positions can be compared.
//!
//! Most candidates are rejected by the means of the quarters of their squares: the squared distance of two quarters is
//! at least 16 times the squared difference of their means (Cauchy-Schwarz inequality).
//!
//! Reference: our own, after the nearest neighbors of Alexei A. Efros and Thomas K. Leung, "Texture Synthesis by
//! Non-parametric Sampling", ICCV 1999, <https://doi.org/10.1109/ICCV.1999.790383>.

use super::quotient;
use crate::TileError;
use crate::axis::transpose;
use dapple_raster::{Raster, Wrap, parallel, simd};
use fearless_simd::{f32x16, prelude::*};

/// Side length of a square, in pixels.
const SIDE: u32 = 8;

/// Number of squares that are compared in each zone.
const SQUARES: u32 = 128;

/// Maximum number of pixels of a source that is compared without averaging blocks: 256 × 256.
const PIXELS: u64 = 1 << 16;

/// Divisor of the side that gives the width of the zone on the far side of the wrap, where methods blend two images.
/// The zone is a fifth of the side.
const BESIDE: u32 = 5;

/// Number of candidates that are compared at once.
const LANES: usize = 16;

/// Width and height of a quarter of a square.
const HALF: usize = SIDE as usize / 2;

/// Factor that makes a bound valid despite rounding of the bound and of distances. Each takes fewer than 100 operations
/// with a relative error of at most half of the last bit, 6e-8.
const SAFE: f32 = 1.0 - 1e-5;

/// Maximum rounding error of the difference of two quarter means, as a fraction of the largest value. It is half of the
/// last bit for either mean, and twice as much for their difference.
const MEAN_ERROR: f32 = 4e-7;

/// Minimum distance of a match in the source, as a multiple of the standard deviation of the source.
const LEAST_DISTANCE: f64 = 0.01;

/// Maximum distance of a copy, as a multiple of the standard deviation of the source. Noise of compressed images stays
/// below it.
const COPY_DISTANCE: f64 = 0.02;

/// Minimum number of squares of the source that are no copies.
const DISTINCT: usize = SQUARES as usize / 8;

/// Values of a square, row by row.
type Square = [f32; (SIDE * SIDE) as usize];

/// First column and row of each quarter of a square.
const QUARTERS: [[usize; 2]; 4] = [[0, 0], [HALF, 0], [0, HALF], [HALF, HALF]];

/// Returns the smallest scale at which a source has at most [`PIXELS`] blocks.
///
/// All positions of the reduced source are candidates. With every second position of a larger source, half of the copied
/// parts would have no exact match, and a clean cut would look as strange as a crossfade.
pub(super) fn finest_scale(size: [u32; 2]) -> u32 {
    let n_blocks = |scale: u32| {
        size.iter()
            .map(|side| u64::from(side / scale))
            .product::<u64>()
    };
    (1..).find(|&scale| n_blocks(scale) <= PIXELS).unwrap_or(1)
}

/// Computes the strangeness at a scale, as the maximum over all zones. Each value of a square is the mean of `scale` ×
/// `scale` pixels. Returns `None` if an image is too small or the source is flat.
pub(super) fn strangeness(
    source: &Raster<f32>,
    tile: &Raster<f32>,
    axes: [bool; 2],
    scale: u32,
) -> Result<Option<f64>, TileError> {
    let sides = source.size().into_iter().chain(tile.size());
    if sides.min().unwrap_or(0) < 3 * SIDE * scale {
        return Ok(None);
    }
    let reduced = reduced(source, scale)?;
    let deviation = reduced.statistics().deviation;
    if deviation == 0.0 {
        return Ok(None);
    }
    // Measure the distance of matches within the source.
    let places = Places::new(&reduced);
    let usual = places.usual(COPY_DISTANCE * deviation * f64::from(SIDE));
    // Limit that distance from below, since squares of a regular source have exact matches.
    let usual = usual.max(LEAST_DISTANCE * deviation * f64::from(SIDE));
    // Measure the distances of the tile's squares, along each axis that repeats.
    let mut most: f64 = 0.0;
    for (axis, _) in axes.iter().enumerate().filter(|(_, repeats)| **repeats) {
        let turned = match axis {
            0 => tile.clone(),
            _ => transpose(tile)?,
        };
        for zone in zones(&turned, axis == 1, scale) {
            most = most.max(quotient(places.mean_distance(&zone), usual));
        }
    }
    Ok(Some(most))
}

/// Averages blocks of `scale` × `scale` pixels. Remaining pixels of the last columns and rows are left out.
fn reduced(source: &Raster<f32>, scale: u32) -> Result<Raster<f32>, TileError> {
    let size = source.size().map(|side| side / scale);
    let wrap = [Wrap::Clamp; 2];
    Ok(Raster::from_fn(size, |x, y| {
        mean_at(source, [x, y].map(|at| i64::from(at * scale)), scale, wrap)
    })?)
}

/// Returns the mean of `scale` × `scale` pixels with the given upper left corner.
fn mean_at(image: &Raster<f32>, [x, y]: [i64; 2], scale: u32, wrap: [Wrap; 2]) -> f32 {
    let mut sum = 0.0;
    for row in 0..i64::from(scale) {
        for column in 0..i64::from(scale) {
            sum += f64::from(*image.at(x + column, y + row, wrap));
        }
    }
    (sum / f64::from(scale * scale)) as f32
}

/// Returns the squares across the wrap of the columns, and the squares next to it. If the tile was transposed, squares
/// are transposed back.
fn zones(tile: &Raster<f32>, is_turned: bool, scale: u32) -> [Vec<Square>; 2] {
    let [width, height] = tile.size();
    // Number of positions for squares next to the wrap.
    let beside = (width / scale / BESIDE).saturating_sub(SIDE).max(1);
    let from = |column: i64, index: u32| {
        let row = spread(index, height / scale) * i64::from(scale);
        square(tile, [column, row], is_turned, scale)
    };
    // Squares across the wrap begin at most seven values before it.
    let across = |index: u32| i64::from(width) - i64::from(scale * (1 + index % (SIDE - 1)));
    // Squares next to the wrap begin in the zone after it.
    let after = |index: u32| i64::from(scale * (index % beside));
    [
        (0..SQUARES)
            .map(|index| from(across(index), index))
            .collect(),
        (0..SQUARES)
            .map(|index| from(after(index), index))
            .collect(),
    ]
}

/// Returns a position along a side from a well-spread sequence, multiples of the golden ratio.
fn spread(index: u32, side: u32) -> i64 {
    // The factor is 2^32 divided by the golden ratio.
    let part = u64::from(index.wrapping_mul(2_654_435_769));
    ((part * u64::from(side)) >> 32) as i64
}

/// Returns the values of the square with the given corner, in a tile that repeats.
fn square(tile: &Raster<f32>, corner: [i64; 2], is_turned: bool, scale: u32) -> Square {
    core::array::from_fn(|index| {
        let (row, column) = (
            index as i64 / i64::from(SIDE),
            index as i64 % i64::from(SIDE),
        );
        let [x, y] = if is_turned {
            [row, column]
        } else {
            [column, row]
        };
        let [x, y] = [x, y].map(|at| at * i64::from(scale));
        let wrap = [Wrap::Repeat; 2];
        mean_at(tile, [corner[0] + x, corner[1] + y], scale, wrap)
    })
}

fn mean_of_distances(distances: &[f64]) -> f64 {
    distances.iter().sum::<f64>() / distances.len() as f64
}

/// Returns the largest absolute value.
fn largest(values: &[f32]) -> f32 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Returns the mean of one quarter of a square.
fn mean(square: &Square, [column, row]: [usize; 2]) -> f32 {
    let rows = square.chunks_exact(SIDE as usize).skip(row).take(HALF);
    let values = rows.flat_map(|row| &row[column..column + HALF]);
    mean_of(values.map(|&value| f64::from(value)).sum())
}

/// Returns the mean of a quarter with the given sum, which may exceed the range of single precision.
fn mean_of(sum: f64) -> f32 {
    (sum / (HALF * HALF) as f64) as f32
}

/// Computes the means of one quarter of every square, row by row.
fn quarter_means(source: &Raster<f32>, size: [usize; 2], [column, row]: [usize; 2]) -> Vec<f32> {
    let mut sums = vec![0.0; padded(size[0]) * size[1]];
    for (y, sums) in sums.chunks_exact_mut(padded(size[0])).enumerate() {
        // Add the rows of the quarter, in all squares of this row.
        for line in 0..HALF {
            let line = &source.row((y + row + line) as u32)[column..];
            for (x, sum) in sums[..size[0]].iter_mut().enumerate() {
                let values = &line[x..x + HALF];
                *sum += values.iter().map(|&value| f64::from(value)).sum::<f64>();
            }
        }
    }
    sums.into_iter().map(mean_of).collect()
}

/// Limits bounds to the largest finite number. An infinite bound only means that the distance is not below it.
#[inline(always)]
fn at_most_largest<S: Simd>(simd: S, bounds: f32x16<S>) -> f32x16<S> {
    bounds.min(f32x16::splat(simd, f32::MAX))
}

/// Returns the number of candidates in a row, padded for the last register.
fn padded(columns: usize) -> usize {
    columns.next_multiple_of(LANES)
}

/// The candidates: all squares of the source.
struct Places<'a> {
    source: &'a Raster<f32>,
    /// Number of candidates in a row, and in a column.
    size: [usize; 2],
    /// Rows of the source, each padded for the last register.
    rows: Vec<f32>,
    /// Length of a padded row.
    row_length: usize,
    /// Quarter means of the square of each candidate, row by row, padded for the last register.
    quarters: [Vec<f32>; 4],
    /// Maximum error of quarter means.
    mean_error: f32,
}

impl<'a> Places<'a> {
    fn new(source: &'a Raster<f32>) -> Self {
        let size = source.size().map(|side| (side - SIDE + 1) as usize);
        let width = source.width() as usize;
        let row_length = width + LANES;
        let mut rows = vec![0.0; row_length * source.height() as usize];
        for (line, row) in source.view().rows().zip(rows.chunks_exact_mut(row_length)) {
            row[..width].copy_from_slice(line);
        }
        Self {
            source,
            size,
            rows,
            row_length,
            quarters: QUARTERS.map(|quarter| quarter_means(source, size, quarter)),
            mean_error: MEAN_ERROR * largest(source.pixels()),
        }
    }

    /// Returns the mean distance of sample squares of the source to their nearest match.
    ///
    /// Squares with a copy, at most `copy` away, are left out if enough others remain: an image that was assembled from
    /// copies of a smaller one says nothing there about the distance of different parts.
    fn usual(&self, copy: f64) -> f64 {
        let [columns, rows] = self.source.size().map(|side| side - SIDE + 1);
        let distances = parallel::map(SQUARES as usize, |index| {
            // Spread the sample squares over the source. Each is compared with all squares that it does not overlap.
            let index = index as u32;
            let corner = [
                spread(index.wrapping_mul(7) + 3, columns),
                spread(index, rows),
            ];
            let own = square(self.source, corner, false, 1);
            self.distance(&own, Some(corner.map(|at| at as usize)))
        });
        let is_distinct = |distance: &f64| *distance > copy;
        let distinct: Vec<f64> = distances.iter().copied().filter(is_distinct).collect();
        if distinct.len() < DISTINCT {
            mean_of_distances(&distances)
        } else {
            mean_of_distances(&distinct)
        }
    }

    fn mean_distance(&self, squares: &[Square]) -> f64 {
        let distance = |index: usize| self.distance(&squares[index], None);
        mean_of_distances(&parallel::map(squares.len(), distance))
    }

    /// Returns the distance of a square to the nearest candidate, except for candidates that overlap the square at
    /// `left_out`.
    fn distance(&self, square: &Square, left_out: Option<[usize; 2]>) -> f64 {
        simd::dispatch!(simd::level(), simd => self.search(simd, square, left_out)).sqrt()
    }

    /// Returns the squared distance of a square to the nearest candidate.
    #[inline(always)]
    fn search<S: Simd>(&self, simd: S, square: &Square, left_out: Option<[usize; 2]>) -> f64 {
        // Compute the quarters' means, and the rounding error of their differences.
        let own = QUARTERS.map(|quarter| mean(square, quarter));
        let error = self.mean_error + MEAN_ERROR * largest(square);
        let rows = 0..self.size[1];
        let groups = rows.flat_map(|row| (0..self.size[0]).step_by(LANES).map(move |at| [at, row]));
        // Start with the candidate with the lowest bound; its distance rejects most others.
        let (mut lowest, mut guess) = (f32::INFINITY, None);
        for group in groups.clone() {
            let bounds = self.bounds(simd, &own, error, group);
            if bounds.simd_lt(f32x16::splat(simd, lowest)).any_true() {
                for (lane, &bound) in bounds.as_slice().iter().enumerate() {
                    if bound < lowest && self.is_compared([group[0] + lane, group[1]], left_out) {
                        (lowest, guess) = (bound, Some(group));
                    }
                }
            }
        }
        // Visit the groups of candidates; compute exact distances only where the bounds allow a nearer one.
        let mut least = f64::INFINITY;
        for group in guess.into_iter().chain(groups) {
            // The squares of smaller numbers are not exact.
            let limit = f32x16::splat(simd, least as f32 + f32::MIN_POSITIVE);
            let bounds = self.bounds(simd, &own, error, group);
            if bounds.simd_lt(limit).any_true() && self.may_be_nearer(simd, square, group, limit) {
                for (lane, sum) in self.sums(square, group).into_iter().enumerate() {
                    if self.is_compared([group[0] + lane, group[1]], left_out) {
                        least = least.min(sum);
                    }
                }
            }
        }
        least
    }

    /// Returns whether `place` is a candidate, and its square does not overlap the one at `left_out`.
    #[inline(always)]
    fn is_compared(&self, place: [usize; 2], left_out: Option<[usize; 2]>) -> bool {
        // Squares that overlap the sample square are left out.
        let meets = |axis: usize| {
            left_out.is_some_and(|corner| place[axis].abs_diff(corner[axis]) < SIDE as usize)
        };
        place[0] < self.size[0] && !(meets(0) && meets(1))
    }

    /// Computes lower bounds on the squared distances of adjacent candidates.
    #[inline(always)]
    fn bounds<S: Simd>(
        &self,
        simd: S,
        own: &[f32; 4],
        error: f32,
        [first, row]: [usize; 2],
    ) -> f32x16<S> {
        let at = row * padded(self.size[0]) + first;
        let [zero, error] = [0.0, error].map(|value| f32x16::splat(simd, value));
        let mut bounds = zero;
        for (own, others) in own.iter().zip(&self.quarters) {
            let others = f32x16::from_slice(simd, &others[at..at + LANES]);
            // Reduce the difference of the means by its rounding error.
            let apart = ((f32x16::splat(simd, *own) - others).abs() - error).max(zero);
            bounds += apart * apart;
        }
        // The squared distance of two quarters of 16 values is at least 16 times the squared difference of their means.
        let factor = SAFE * (HALF * HALF) as f32;
        at_most_largest(simd, bounds * f32x16::splat(simd, factor))
    }

    /// Returns whether the squared distance of any of a group of adjacent candidates may be below a limit.
    #[inline(always)]
    fn may_be_nearer<S: Simd>(
        &self,
        simd: S,
        square: &Square,
        group: [usize; 2],
        limit: f32x16<S>,
    ) -> bool {
        let safe = f32x16::splat(simd, SAFE);
        // Sum the squared differences of sixteen candidates, pixel by pixel.
        let mut sums = f32x16::splat(simd, 0.0);
        for (row, part) in square.chunks_exact(SIDE as usize).enumerate() {
            for (column, &value) in part.iter().enumerate() {
                let others = f32x16::from_slice(simd, self.others(group, [column, row]));
                let apart = f32x16::splat(simd, value) - others;
                sums += apart * apart;
            }
            // Stop as soon as the partial sums exceed the limit.
            if !(at_most_largest(simd, sums) * safe)
                .simd_lt(limit)
                .any_true()
            {
                return false;
            }
        }
        true
    }

    /// Computes the squared distances of adjacent candidates.
    #[inline(always)]
    fn sums(&self, square: &Square, group: [usize; 2]) -> [f64; LANES] {
        let mut sums = [0.0; LANES];
        for (row, part) in square.chunks_exact(SIDE as usize).enumerate() {
            let mut of_row = [0.0; LANES];
            for (column, &value) in part.iter().enumerate() {
                let others = self.others(group, [column, row]);
                for (sum, &other) in of_row.iter_mut().zip(others) {
                    let apart = f64::from(value) - f64::from(other);
                    *sum += apart * apart;
                }
            }
            for (sum, of_row) in sums.iter_mut().zip(of_row) {
                *sum += of_row;
            }
        }
        sums
    }

    /// Returns the pixels at one position within the squares of adjacent candidates.
    #[inline(always)]
    fn others(&self, [first, row]: [usize; 2], [x, y]: [usize; 2]) -> &[f32] {
        let at = (row + y) * self.row_length + first + x;
        &self.rows[at..at + LANES]
    }
}

#[cfg(test)]
mod tests {
    use super::{Places, SIDE, Square, finest_scale, square, strangeness};
    use crate::test_fields::{fbm, gravel};
    use crate::{Crossfade, Feather, Method, Seamless, SoftCut};
    use dapple_raster::Raster;

    fn of(method: Method) -> f64 {
        let source = gravel(4, [128; 2], false);
        let tile = Seamless::new(method).apply(&source).unwrap();
        strangeness(&source, &tile, [true; 2], 1).unwrap().unwrap()
    }

    /// Returns the distance of a square to the nearest of all candidates.
    fn of_all(places: &Places<'_>, own: &Square, left_out: Option<[usize; 2]>) -> f64 {
        let meets = |at: [usize; 2]| {
            left_out
                .is_some_and(|out| (0..2).all(|axis| at[axis].abs_diff(out[axis]) < SIDE as usize))
        };
        let [columns, rows] = places.size;
        let all = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        let all = all.filter(|&at| !meets(at));
        let apart = |corner: [usize; 2]| {
            let other = square(places.source, corner.map(|at| at as i64), false, 1);
            let squares = own
                .iter()
                .zip(&other)
                .map(|(a, b)| f64::from(*a) - f64::from(*b));
            let squares: Vec<f64> = squares.map(|apart| apart * apart).collect();
            let rows = squares.chunks_exact(SIDE as usize);
            rows.map(|row| row.iter().sum::<f64>()).sum::<f64>()
        };
        all.map(apart).fold(f64::INFINITY, f64::min).sqrt()
    }

    #[test]
    fn nearest_square_is_that_of_comparing_with_all() {
        for (source, factor, offset) in [
            (gravel(4, [61, 37], false), 1.0, 0.0),
            (fbm(2, [300, 290], false), 1.0, 0.0),
            (fbm(3, [40, 50], false), 1.0, 1e4),
            (gravel(6, [40, 50], false), 1e30, 0.0),
            (gravel(6, [40, 50], false), 1e38, 2e38),
            (gravel(6, [40, 50], false), 1e-30, 0.0),
        ] {
            let source = source.map(|value| factor * value + offset);
            let places = Places::new(&source);
            let tile = gravel(5, [64; 2], true).map(|value| factor * value + offset);
            for at in 0..12 {
                let own = square(&tile, [5 * at, 3 * at], false, 1);
                assert_eq!(places.distance(&own, None), of_all(&places, &own, None));
                let corner = [at as usize + 2, 2 * at as usize];
                let own = square(&source, corner.map(|at| at as i64), false, 1);
                let (found, expected) = (
                    places.distance(&own, Some(corner)),
                    of_all(&places, &own, Some(corner)),
                );
                assert_eq!(found, expected, "without {corner:?}");
            }
        }
    }

    #[test]
    fn crossfaded_stones_are_stranger_than_cut_ones() {
        let cut = of(Method::SoftCut(SoftCut::default()));
        let faded = of(Method::Feather(Feather::Margin {
            margin: 32,
            crossfade: Crossfade::KeepVariance,
        }));
        assert!(cut < 0.8 && faded > 1.5 * cut, "{cut} and {faded}");
    }

    #[test]
    fn a_picture_that_repeats_is_not_strange_beside_itself() {
        let tile = fbm(2, [96, 64], true);
        let strangeness = strangeness(&tile, &tile, [true; 2], 1).unwrap().unwrap();
        // Squares inside have exact matches, and squares across the wrap match like any others.
        assert!(strangeness < 1.12, "{strangeness}");
    }

    #[test]
    fn means_of_one_pixel_are_its_bits() {
        let source = gravel(4, [61, 37], false);
        assert_eq!(super::reduced(&source, 1).unwrap(), source);
        let halved = super::reduced(&source, 2).unwrap();
        assert_eq!(halved.size(), [30, 18]);
        let of = |x, y| f64::from(source.row(y)[x]);
        let mean = (of(4, 6) + of(5, 6) + of(4, 7) + of(5, 7)) / 4.0;
        assert_eq!(halved.row(3)[2], mean as f32);
    }

    #[test]
    fn sources_are_reduced_to_as_many_pixels_as_can_be_compared() {
        let sizes = [[256, 256], [512, 100], [257, 256], [320, 320], [1024, 1024]];
        assert_eq!(sizes.map(finest_scale), [1, 1, 2, 2, 4]);
        assert_eq!([[1, 1], [1, 1 << 28]].map(finest_scale), [1, 2]);
        // Parts that a cut has copied have exact matches in a large source, too.
        let source = gravel(4, [320; 2], false);
        let of = |method| {
            let tile = Seamless::new(method).apply(&source).unwrap();
            strangeness(&source, &tile, [true; 2], 2).unwrap().unwrap()
        };
        let cut = of(Method::SoftCut(SoftCut::default()));
        let faded = of(Method::Feather(Feather::Margin {
            margin: 40,
            crossfade: Crossfade::Linear,
        }));
        assert!(cut < 0.7 * faded, "{cut} and {faded}");
    }

    #[test]
    fn copies_within_the_source_do_not_make_its_tiles_strange() {
        // Three quarters of the image are copies of the first 128 × 128 pixels, and the rest is its own.
        let [part, other] = [4, 5].map(|seed| fbm(seed, [128; 2], false));
        let assembled = Raster::from_fn([240; 2], |x, y| {
            if x.min(y) < 128 {
                part.row(y % 128)[(x % 128) as usize]
            } else {
                other.row(y - 128)[(x - 128) as usize]
            }
        });
        let assembled = assembled.unwrap();
        let of = |source: &Raster<f32>| {
            let cut = Seamless::new(Method::SoftCut(SoftCut::default()));
            let tile = cut.apply(source).unwrap();
            strangeness(source, &tile, [true; 2], 1).unwrap().unwrap()
        };
        let of_assembled = of(&assembled);
        let of_single = of(&fbm(6, [240; 2], false));
        assert!(
            of_assembled < 1.3 * of_single,
            "{of_assembled} and {of_single}"
        );
    }

    #[test]
    fn small_and_flat_sources_are_not_compared() {
        let flat = Raster::filled([64; 2], 0.5).unwrap();
        assert_eq!(strangeness(&flat, &flat, [true; 2], 1), Ok(None));
        let small = fbm(2, [20, 64], true);
        assert_eq!(strangeness(&small, &small, [true; 2], 1), Ok(None));
        let small = fbm(2, [47, 64], true);
        assert!(strangeness(&small, &small, [true; 2], 1).unwrap().is_some());
        assert_eq!(strangeness(&small, &small, [true; 2], 2), Ok(None));
    }
}
