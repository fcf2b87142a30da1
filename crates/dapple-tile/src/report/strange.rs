//! Strangeness: how unlike the source a tile is near its seams.
//!
//! Sample squares of pixels across and beside the wrap are compared with all of the source. Parts that were cut or
//! moved as a whole are found there; a stain, a cut-off line, or two pictures laid over each other is not. The distance
//! of a good match depends on the picture: squares of the source are compared with the rest of the source. The measure
//! is the mean distance of the tile's squares to their nearest match, as a multiple of that of the source's squares.
//!
//! Reference: our own, after the nearest neighbors of Alexei A. Efros and Thomas K. Leung, "Texture Synthesis by
//! Non-parametric Sampling", ICCV 1999, <https://doi.org/10.1109/ICCV.1999.790383>.

use super::quotient;
use crate::TileError;
use crate::axis::transpose;
use dapple_raster::{Raster, Wrap, parallel, simd};

/// The side of a square, in pixels.
const SIDE: u32 = 8;

/// The number of squares that are compared in each zone.
const SQUARES: u32 = 128;

/// The largest number of places of the source that are compared: all of 256 × 256 pixels.
const PLACES: usize = 1 << 16;

/// The part of a side, on the far side of the wrap, where methods lay two pictures over each other.
const BESIDE: u32 = 5;

/// The places that are compared at once.
const LANES: usize = 8;

/// The smallest distance of a match in the source, as a multiple of the deviation of the source.
const LEAST_DISTANCE: f64 = 0.01;

type Square = [f32; (SIDE * SIDE) as usize];

/// [`DetailKept::strangeness`](super::DetailKept::strangeness): the strangest of all zones; `None` if an image is too small.
pub(super) fn strangeness(
    source: &Raster<f32>,
    tile: &Raster<f32>,
    axes: [bool; 2],
) -> Result<Option<f64>, TileError> {
    let sides = source.size().into_iter().chain(tile.size());
    if sides.min().unwrap_or(0) < 3 * SIDE {
        return Ok(None);
    }
    let places = Places::new(source);
    let usual = places.usual();
    let deviation = source.statistics().deviation;
    if deviation == 0.0 {
        return Ok(None);
    }
    let usual = usual.max(LEAST_DISTANCE * deviation * f64::from(SIDE));
    let mut most: f64 = 0.0;
    for (axis, _) in axes.iter().enumerate().filter(|(_, repeats)| **repeats) {
        let turned = match axis {
            0 => tile.clone(),
            _ => transpose(tile)?,
        };
        for zone in zones(&turned, axis == 1) {
            most = most.max(quotient(places.mean_distance(&zone), usual));
        }
    }
    Ok(Some(most))
}

/// Squares across the wrap of the columns, and squares beside it; transposed back if the tile was transposed.
fn zones(tile: &Raster<f32>, is_turned: bool) -> [Vec<Square>; 2] {
    let [width, height] = tile.size();
    let beside = (width / BESIDE).saturating_sub(SIDE).max(1);
    let across = |index: u32| i64::from(width - 1 - index % (SIDE - 1));
    let from = |column: i64, index: u32| square(tile, [column, spread(index, height)], is_turned);
    [
        (0..SQUARES)
            .map(|index| from(across(index), index))
            .collect(),
        (0..SQUARES)
            .map(|index| from((index % beside).into(), index))
            .collect(),
    ]
}

/// Places along a side that are far from each other: multiples of the golden section of the side.
fn spread(index: u32, side: u32) -> i64 {
    // 2^32 divided by the golden ratio.
    let part = u64::from(index.wrapping_mul(2_654_435_769));
    ((part * u64::from(side)) >> 32) as i64
}

/// The pixels of a square from its corner on, of a tile that repeats.
fn square(tile: &Raster<f32>, corner: [i64; 2], is_turned: bool) -> Square {
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
        *tile.at(corner[0] + x, corner[1] + y, [Wrap::Repeat; 2])
    })
}

/// Squares of the source, on a lattice that is as fine as the largest number of places allows.
struct Places<'a> {
    source: &'a Raster<f32>,
    /// The distance of neighbors in the lattice.
    step: usize,
    /// The columns and rows of the lattice.
    size: [usize; 2],
    /// For each row of the source its pixels in runs, one for each remainder of the column by `step`: what squares side by
    /// side have at one column of theirs lies side by side.
    runs: Vec<f32>,
    /// The length of a run, with room for the last register.
    run_length: usize,
}

impl<'a> Places<'a> {
    fn new(source: &'a Raster<f32>) -> Self {
        let ends = source.size().map(|side| (side - SIDE + 1) as usize);
        let step = (1..)
            .find(|step| ends[0] * ends[1] / (step * step) <= PLACES)
            .unwrap_or(1);
        let run_length = (source.width() as usize).div_ceil(step) + LANES;
        let mut runs = vec![0.0; run_length * step * source.height() as usize];
        for (line, runs) in source
            .view()
            .rows()
            .zip(runs.chunks_exact_mut(run_length * step))
        {
            for (column, &value) in line.iter().enumerate() {
                runs[column % step * run_length + column / step] = value;
            }
        }
        Self {
            source,
            step,
            size: ends.map(|end| end.div_ceil(step)),
            runs,
            run_length,
        }
    }

    /// The mean distance of squares of the source from their nearest match elsewhere in it.
    fn usual(&self) -> f64 {
        let [columns, rows] = self.source.size().map(|side| side - SIDE + 1);
        self.mean(SQUARES as usize, |index| {
            let index = index as u32;
            let corner = [
                spread(index.wrapping_mul(7) + 3, columns),
                spread(index, rows),
            ];
            let own = square(self.source, corner, false);
            self.distance(&own, Some(corner.map(|at| at as usize)))
        })
    }

    fn mean_distance(&self, squares: &[Square]) -> f64 {
        self.mean(squares.len(), |index| self.distance(&squares[index], None))
    }

    fn mean(&self, count: usize, distance: impl Fn(usize) -> f64 + Sync) -> f64 {
        parallel::map(count, distance).iter().sum::<f64>() / count as f64
    }

    /// The distance of a square from the nearest in the source, apart from those that meet the one at a corner.
    fn distance(&self, square: &Square, left_out: Option<[usize; 2]>) -> f64 {
        simd::dispatch!(simd::level(), _simd => self.search(square, left_out)).sqrt()
    }

    /// The square of the distance. Plain loops over lanes, which are compiled to the registers of the level.
    #[inline(always)]
    fn search(&self, square: &Square, left_out: Option<[usize; 2]>) -> f64 {
        let mut least = f64::INFINITY;
        let meets = |at: usize, axis: usize| {
            left_out.is_some_and(|corner| at.abs_diff(corner[axis]) < SIDE as usize)
        };
        for y in (0..self.size[1]).map(|row| row * self.step) {
            for first in (0..self.size[0]).step_by(LANES) {
                let Some(sums) = self.sums(square, [first, y], least) else {
                    continue;
                };
                for (lane, sum) in sums.into_iter().enumerate() {
                    let is_out = first + lane >= self.size[0]
                        || meets(y, 1) && meets((first + lane) * self.step, 0);
                    least = if is_out { least } else { least.min(sum) };
                }
            }
        }
        least
    }

    /// The squares of the distances from places side by side, unless all are at least the limit.
    #[inline(always)]
    fn sums(&self, square: &Square, [first, y]: [usize; 2], limit: f64) -> Option<[f64; LANES]> {
        let mut sums = [0.0; LANES];
        for (row, part) in (y..).zip(square.chunks_exact(SIDE as usize)) {
            let mut of_row = [0.0; LANES];
            for (column, &value) in part.iter().enumerate() {
                let run = row * self.step + column % self.step;
                let at = run * self.run_length + first + column / self.step;
                let others: &[f32; LANES] = self.runs[at..].first_chunk()?;
                let apart = others.map(|other| f64::from(value) - f64::from(other));
                of_row = core::array::from_fn(|lane| of_row[lane] + apart[lane] * apart[lane]);
            }
            sums = core::array::from_fn(|lane| sums[lane] + of_row[lane]);
            if sums.iter().all(|sum| *sum >= limit) {
                return None;
            }
        }
        Some(sums)
    }
}

#[cfg(test)]
mod tests {
    use super::strangeness;
    use crate::test_fields::{fbm, gravel};
    use crate::{Crossfade, Feather, Method, Seamless, SoftCut};
    use dapple_raster::Raster;

    fn of(method: Method) -> f64 {
        let source = gravel(4, [128; 2], false);
        let tile = Seamless::new(method).apply(&source).unwrap();
        strangeness(&source, &tile, [true; 2]).unwrap().unwrap()
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
        let strangeness = strangeness(&tile, &tile, [true; 2]).unwrap().unwrap();
        // Squares inside are found exactly, and those across the wrap match like any others.
        assert!(strangeness < 1.12, "{strangeness}");
    }

    #[test]
    fn small_and_flat_sources_are_not_compared() {
        let flat = Raster::filled([64; 2], 0.5).unwrap();
        assert_eq!(strangeness(&flat, &flat, [true; 2]), Ok(None));
        let small = fbm(2, [20, 64], true);
        assert_eq!(strangeness(&small, &small, [true; 2]), Ok(None));
    }
}
