//! Computes a window of an endless texture, level by level.
//!
//! Input: the levels of the exemplar and the rectangle of the window. Output: the source pixel of each pixel. Margins
//! are added on each level, so that every value that the window depends on is computed.

use super::Endless;
use super::level::{AppearanceLevel, DIAGONALS, N_FEATURES, narrow};
use crate::SynthError;
use crate::engine::{self, Callback, Progress};
use crate::wavefront::WavefrontProgress;
use core::ops::Range;
use core::sync::atomic::{AtomicU32, Ordering};
use dapple_hash::{hash2, unit_f64};
use dapple_raster::simd::{self, dispatch};
use dapple_raster::{Raster, parallel};

/// Number of correction passes per level; the coarsest level has twice as many.
pub(super) const N_PASSES: usize = 3;

/// Number of possible replacement counts. For a regular exemplar that wraps, a pixel of the coarsest level is replaced
/// by its most similar pixel 0 to 7 times.
const MOVES: f64 = 8.0;

/// Maximum distance, along each axis, of the pixels that the correction of a pixel reads.
pub(super) const READS: i64 = 2;

/// Number of pixels between two progress reports. A quarter of them is corrected in between, which takes a few
/// milliseconds.
const REPORTED: i64 = 1 << 16;

/// The four subpasses of a correction pass, in order: column and row of the corrected pixels modulo 2.
pub(super) const QUARTERS: [[i64; 2]; 4] = [[0, 0], [1, 1], [0, 1], [1, 0]];

/// Returns the maximum distance of the pixels that a pixel depends on after `n_passes` passes over a level.
const fn reach(n_passes: usize) -> i64 {
    READS * (QUARTERS.len() * n_passes) as i64
}

/// Returns the number of correction passes on a level. `coarser` is the coarser level, or `None` on the coarsest.
fn n_passes(coarser: Option<&Area>) -> usize {
    match coarser {
        None => 2 * N_PASSES,
        Some(_) => N_PASSES,
    }
}

/// A rectangle of the texture on one level, with the source in the exemplar of each of its pixels.
#[derive(Debug)]
pub(super) struct Area {
    pub(super) columns: Range<i64>,
    pub(super) rows: Range<i64>,
    /// Source of each pixel. A thread that reads a value waits for the thread that writes it.
    places: Vec<[AtomicU32; 2]>,
}

/// One row of a subpass; the unit of work of a thread.
#[derive(Clone, Copy, Debug)]
struct Turn {
    quarter: [i64; 2],
    row: i64,
    /// Number of turns at the start of the schedule that must finish before this one runs.
    wait: usize,
}

impl Endless {
    /// Computes the source of each pixel in a window.
    pub(super) fn sources(
        &self,
        [column, row]: [i64; 2],
        size: [u32; 2],
        callback: Callback<'_>,
    ) -> Result<Raster<[u32; 2]>, SynthError> {
        let [columns, rows] =
            [(column, size[0]), (row, size[1])].map(|(first, side)| first..first + i64::from(side));
        // Find the range of pixels needed on each level, the finest first.
        let mut needs = vec![[columns.clone(), rows.clone()]];
        for level in 1..self.stages.len() {
            let reach = reach(N_PASSES);
            // A pixel depends on pixels up to `reach` away, which are upsampled from their parents.
            let parents = |range: Range<i64>| {
                (range.start - reach).div_euclid(2)..(range.end + reach - 1).div_euclid(2) + 1
            };
            needs.push(needs[level - 1].clone().map(parents));
        }
        // Compute the levels, the coarsest first.
        let mut coarser: Option<Area> = None;
        for (level, stage) in self.stages.iter().enumerate().rev() {
            let n_passes = n_passes(coarser.as_ref());
            let reach = reach(n_passes);
            // Extend the range by the pixels that corrections read.
            let around = needs[level]
                .clone()
                .map(|range| range.start - reach..range.end + reach);
            let area = self.start(level, coarser.as_ref(), around);
            let n_quarters = area.places.len() / QUARTERS.len();
            // Correct the level in parts, and report progress after each.
            for (corrected, &quarter) in (0..n_passes).flat_map(|_| &QUARTERS).enumerate() {
                for rows in area.parts() {
                    let above = (rows.start - area.rows.start) as usize;
                    let before = n_quarters * above / (area.rows.end - area.rows.start) as usize;
                    let progress = Progress {
                        pass: self.stages.len() - 1 - level,
                        n_passes: self.stages.len(),
                        done: corrected * n_quarters + before,
                        n_sites: QUARTERS.len() * n_passes * n_quarters,
                    };
                    engine::report(callback, progress)?;
                    area.correct(stage, &[quarter], rows);
                }
            }
            coarser = Some(area);
        }
        // Cut out the window.
        let place = |x: u32, y: u32| {
            let at = [column + i64::from(x), row + i64::from(y)];
            let place = coarser.as_ref().map_or([0; 2], |area| area.at(at));
            narrow(place)
        };
        Ok(Raster::from_fn(size, place)?)
    }

    /// Creates a level before its correction: upsampled from the coarser level, or random on the coarsest.
    fn start(
        &self,
        level: usize,
        coarser: Option<&Area>,
        [columns, rows]: [Range<i64>; 2],
    ) -> Area {
        Area::new(columns, rows, |at| match coarser {
            None => self.random(level, at),
            Some(coarser) => {
                let parent = coarser.at(at.map(|at| at.div_euclid(2)));
                self.stages[level].child(parent, at)
            }
        })
    }

    /// Creates a level and corrects the pixels whose neighborhoods are within the area.
    pub(super) fn area(
        &self,
        level: usize,
        coarser: Option<&Area>,
        ranges: [Range<i64>; 2],
    ) -> Area {
        let area = self.start(level, coarser, ranges);
        let (quarters, rows) = (QUARTERS.repeat(n_passes(coarser)), area.rows.clone());
        area.correct(&self.stages[level], &quarters, rows);
        area
    }

    /// Returns the initial source of a pixel of the coarsest level: a random pixel of the exemplar. For a regular
    /// exemplar that wraps, the source is the pixel's position in tiled copies of the exemplar, replaced by its most
    /// similar pixel 0 to 7 times.
    fn random(&self, level: usize, mut at: [i64; 2]) -> [i64; 2] {
        for (at, period) in at.iter_mut().zip(self.period) {
            if let Some(period) = period {
                *at = at.rem_euclid(i64::from(period) >> level);
            }
        }
        // Draw a random number from the position within the period.
        let part = unit_f64(hash2(self.seed.child("endless", 0), at, 0));
        if !self.is_lattice {
            let pixel = self.coarsest[(part * self.coarsest.len() as f64) as usize];
            return [pixel % self.size[0], pixel / self.size[0]].map(i64::from);
        }
        let stage = &self.stages[level];
        // Start with a copy of the exemplar, and replace the pixel a random number of times.
        let mut place = [0, 1].map(|axis| {
            let side = i64::from(self.size[axis]);
            (at[axis] * stage.spacing).rem_euclid(side)
        });
        for _ in 0..(part * MOVES) as u32 {
            place = stage.similar(place).unwrap_or(place);
        }
        place
    }
}

/// Returns the columns or rows of a range that equal `rest` modulo 2, except those whose correction reads past the
/// range.
fn odd_or_even(range: &Range<i64>, rest: i64) -> impl Iterator<Item = i64> + use<> {
    let first = range.start + READS;
    let first = first + (rest - first).rem_euclid(2);
    (first..range.end - READS).step_by(2)
}

impl Area {
    fn new(
        columns: Range<i64>,
        rows: Range<i64>,
        place: impl Fn([i64; 2]) -> [i64; 2] + Sync,
    ) -> Self {
        let n_rows = (rows.end - rows.start) as usize;
        let row = |row: usize| {
            let row = rows.start + row as i64;
            let places = columns.clone().map(|column| place([column, row]));
            places
                .map(|place| narrow(place).map(AtomicU32::new))
                .collect::<Vec<_>>()
        };
        Self {
            places: parallel::map(n_rows, row).into_iter().flatten().collect(),
            columns,
            rows,
        }
    }

    /// Returns the index of a pixel in `places`.
    #[inline(always)]
    fn index(&self, [column, row]: [i64; 2]) -> usize {
        let width = self.columns.end - self.columns.start;
        ((row - self.rows.start) * width + column - self.columns.start) as usize
    }

    /// Returns the source of a pixel.
    #[inline(always)]
    pub(super) fn at(&self, pixel: [i64; 2]) -> [i64; 2] {
        let [column, row] = &self.places[self.index(pixel)];
        // Relaxed ordering suffices, because the board orders reads after writes by other threads.
        [
            column.load(Ordering::Relaxed).into(),
            row.load(Ordering::Relaxed).into(),
        ]
    }

    /// Corrects the pixels of the given subpasses in `rows`, except pixels whose correction reads past the area.
    /// Subpasses run in order; the rows of a subpass run in parallel.
    fn correct(&self, stage: &AppearanceLevel, quarters: &[[i64; 2]], rows: Range<i64>) {
        let level = simd::level();
        let turns = self.turns(quarters, &rows);
        let mut workers = vec![(); parallel::n_threads()];
        let board = WavefrontProgress::new(0..turns.len(), workers.len());
        parallel::together(&mut workers, |thread, ()| {
            while let Some(turn) = board.take(thread) {
                let Turn { quarter, row, wait } = turns[turn];
                board.wait(wait);
                let columns = odd_or_even(&self.columns, quarter[0]);
                dispatch!(level, _simd => self.correct_row(stage, columns, row));
            }
        });
    }

    /// Splits the rows into parts for progress reports. Each part includes the surrounding rows that it reads.
    fn parts(&self) -> impl Iterator<Item = Range<i64>> + use<> {
        let rows = self.rows.start..self.rows.end - 2 * READS;
        let n_rows = (REPORTED / (self.columns.end - self.columns.start)).max(2);
        let firsts = rows.clone().step_by(n_rows as usize);
        firsts.map(move |first| first..rows.end.min(first + n_rows) + 2 * READS)
    }

    /// Corrects the pixels of a row at the given columns.
    #[inline(always)]
    fn correct_row(&self, stage: &AppearanceLevel, columns: impl Iterator<Item = i64>, row: i64) {
        for column in columns {
            let [across, down] = narrow(self.corrected(stage, [column, row]));
            let to = &self.places[self.index([column, row])];
            to[0].store(across, Ordering::Relaxed);
            to[1].store(down, Ordering::Relaxed);
        }
    }

    /// Builds the wavefront schedule of the rows of all subpasses. A row waits for the rows of the previous subpass
    /// that it reads, and for those that read it.
    fn turns(&self, quarters: &[[i64; 2]], rows: &Range<i64>) -> Vec<Turn> {
        let mut turns: Vec<Turn> = Vec::new();
        let mut before = 0..0;
        for &quarter in quarters {
            let first = turns.len();
            for row in odd_or_even(rows, quarter[1]) {
                // Rows ascend, so the turns to wait for are the first ones of the previous subpass.
                let is_near = |turn: &Turn| turn.row <= row + READS;
                let wait = before.start + turns[before.clone()].partition_point(is_near);
                turns.push(Turn { quarter, row, wait });
            }
            before = first..turns.len();
        }
        turns
    }

    /// Returns the best source of a pixel: the exemplar pixel whose surroundings are most similar to the pixel's
    /// surroundings in the texture. The first of equally good sources is returned.
    #[inline(always)]
    fn corrected(&self, stage: &AppearanceLevel, [column, row]: [i64; 2]) -> [i64; 2] {
        let mut choice = Choice {
            stage,
            area: self,
            pixel: [column, row],
            around: self.around(stage, [column, row]),
            best: (f32::INFINITY, self.at([column, row])),
        };
        // Compare the pixels that the nine neighbors predict, the pixel itself included.
        let mut coherent = [choice.best.1; 9];
        let mut n_coherent = 0;
        for y in -1..=1 {
            for x in -1..=1 {
                let [across, down] = self.at([column + x, row + y]);
                let place = [across - x * stage.spacing, down - y * stage.spacing];
                if let Some(place) = stage.usable(place)
                    && !coherent[..n_coherent].contains(&place)
                {
                    coherent[n_coherent] = place;
                    n_coherent += 1;
                    choice.compare(place, 1.0);
                }
            }
        }
        // Compare the pixels most similar to these, with a penalty.
        for &place in &coherent[..n_coherent] {
            if let Some(place) = stage.similar(place) {
                choice.compare(place, 1.0 + stage.coherence);
            }
        }
        choice.best.1
    }

    /// Returns whether the source `place` is repeated nearby: its distance from the source of a nearby pixel is less
    /// than half the distance between the two pixels. Pixels of the same subpass are ignored, because they are
    /// corrected at the same time.
    #[inline(always)]
    fn repeats(&self, stage: &AppearanceLevel, [column, row]: [i64; 2], place: [i64; 2]) -> bool {
        for y in -READS..=READS {
            for x in -READS..=READS {
                if x % 2 == 0 && y % 2 == 0 {
                    continue;
                }
                let other = self.at([column + x, row + y]);
                let apart = (other[0] - place[0]).abs().max((other[1] - place[1]).abs());
                if 2 * apart < x.abs().max(y.abs()) * stage.spacing {
                    return true;
                }
            }
        }
        false
    }

    /// Returns the features on each diagonal of a pixel: the mean of three values. One is at the source of the diagonal
    /// pixel; the other two are predicted by the pixels one step beyond it along each axis.
    #[inline(always)]
    pub(super) fn around(
        &self,
        stage: &AppearanceLevel,
        [column, row]: [i64; 2],
    ) -> [[f32; N_FEATURES]; 4] {
        let mut around = [[0.0; N_FEATURES]; 4];
        for (sums, [x, y]) in around.iter_mut().zip(DIAGONALS) {
            for [beyond_x, beyond_y] in [[0, 0], [x, 0], [0, y]] {
                let [across, down] = self.at([column + x + beyond_x, row + y + beyond_y]);
                // The source of the pixel beyond predicts the diagonal.
                let place = [
                    across - beyond_x * stage.spacing,
                    down - beyond_y * stage.spacing,
                ];
                let features = stage.features(place);
                for i in 0..N_FEATURES {
                    sums[i] += features[i];
                }
            }
            for sum in sums {
                *sum /= 3.0;
            }
        }
        around
    }
}

/// State of the search for the best source of a pixel.
struct Choice<'a> {
    stage: &'a AppearanceLevel,
    area: &'a Area,
    pixel: [i64; 2],
    /// Features on the diagonals of the pixel.
    around: [[f32; N_FEATURES]; 4],
    /// Score (squared distance plus costs) and position of the best source so far.
    best: (f32, [i64; 2]),
}

impl Choice<'_> {
    /// Takes a source if its score is lower than the lowest so far. `factor` multiplies its squared distance, but not
    /// its costs.
    #[inline(always)]
    fn compare(&mut self, place: [i64; 2], factor: f32) {
        let stage = self.stage;
        let distance_sq = factor * stage.distance_sq(&self.around, place);
        let mut distance_sq = distance_sq + stage.costs.of(place);
        // Test for repetition only if the source could still win.
        if distance_sq < self.best.0
            && stage.repetition_cost > 0.0
            && self.area.repeats(stage, self.pixel, place)
        {
            distance_sq += stage.repetition_cost;
        }
        if distance_sq < self.best.0 {
            self.best = (distance_sq, place);
        }
    }
}
