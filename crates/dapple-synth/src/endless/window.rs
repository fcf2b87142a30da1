//! The pixels of a window, level by level.

use super::Endless;
use super::stage::{DIAGONALS, N_FEATURES, Stage, narrow};
use crate::SynthError;
use crate::engine::{self, Callback, Progress};
use crate::turns::Board;
use core::ops::Range;
use core::sync::atomic::{AtomicU32, Ordering};
use dapple_hash::{hash2, unit_f64};
use dapple_raster::simd::{self, dispatch};
use dapple_raster::{Raster, parallel};

/// How often a level is corrected.
pub(super) const N_PASSES: usize = 3;

/// How often, less one at most, a pixel of a regular exemplar is first replaced by the one most like it.
const MOVES: f64 = 8.0;

/// How far the pixels are that a correction of one pixel reads.
pub(super) const READS: i64 = 2;

/// The pixels of a level from one report of the progress to the next: a quarter of them is corrected, in some
/// milliseconds.
const REPORTED: i64 = 1 << 16;

/// The pixels that are corrected at a time: the remainders of columns and rows by 2, in this order.
pub(super) const QUARTERS: [[i64; 2]; 4] = [[0, 0], [1, 1], [0, 1], [1, 0]];

/// How far the pixels are that the passes over a level depend on.
const fn reach(n_passes: usize) -> i64 {
    READS * (QUARTERS.len() * n_passes) as i64
}

/// How often the level over a coarser one is corrected, or the coarsest.
fn n_passes(coarser: Option<&Area>) -> usize {
    match coarser {
        None => 2 * N_PASSES,
        Some(_) => N_PASSES,
    }
}

/// A rectangle of the texture on one level, and the places in the exemplar that its pixels are from.
#[derive(Debug)]
pub(super) struct Area {
    pub(super) columns: Range<i64>,
    pub(super) rows: Range<i64>,
    /// Written by threads that wait for each other where they read what others write.
    places: Vec<[AtomicU32; 2]>,
}

/// A row of a quarter that is corrected.
#[derive(Clone, Copy, Debug)]
struct Turn {
    quarter: [i64; 2],
    row: i64,
    /// The turns from the first one on that must be over before.
    wait: usize,
}

impl Endless {
    /// The sources of a window.
    pub(super) fn sources(
        &self,
        [column, row]: [i64; 2],
        size: [u32; 2],
        callback: Callback<'_>,
    ) -> Result<Raster<[u32; 2]>, SynthError> {
        let [columns, rows] =
            [(column, size[0]), (row, size[1])].map(|(first, side)| first..first + i64::from(side));
        // What is to be known of each level, the finest first.
        let mut needs = vec![[columns.clone(), rows.clone()]];
        for level in 1..self.stages.len() {
            let reach = reach(N_PASSES);
            let parents = |range: Range<i64>| {
                (range.start - reach).div_euclid(2)..(range.end + reach - 1).div_euclid(2) + 1
            };
            needs.push(needs[level - 1].clone().map(parents));
        }
        let mut coarser: Option<Area> = None;
        for (level, stage) in self.stages.iter().enumerate().rev() {
            let n_passes = n_passes(coarser.as_ref());
            let reach = reach(n_passes);
            let around = needs[level]
                .clone()
                .map(|range| range.start - reach..range.end + reach);
            let area = self.start(level, coarser.as_ref(), around);
            let n_quarters = area.places.len() / QUARTERS.len();
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
        let place = |x: u32, y: u32| {
            let at = [column + i64::from(x), row + i64::from(y)];
            let place = coarser.as_ref().map_or([0; 2], |area| area.at(at));
            narrow(place)
        };
        Ok(Raster::from_fn(size, place)?)
    }

    /// The pixels of a level before they are corrected.
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

    /// The pixels of a level, corrected as far as is here what corrections read.
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

    /// The place of a pixel of the coarsest level before it is corrected: any, or where copies of a regular exemplar side by
    /// side have what is like that.
    fn random(&self, level: usize, mut at: [i64; 2]) -> [i64; 2] {
        for (at, period) in at.iter_mut().zip(self.period) {
            if let Some(period) = period {
                *at = at.rem_euclid(i64::from(period) >> level);
            }
        }
        let part = unit_f64(hash2(self.seed.child("endless", 0), at, 0));
        if !self.is_lattice {
            let pixel = self.coarsest[(part * self.coarsest.len() as f64) as usize];
            return [pixel % self.size[0], pixel / self.size[0]].map(i64::from);
        }
        let stage = &self.stages[level];
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

/// The columns or rows of a range whose remainder by 2 is `rest`, but those from which not all is here that is read.
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

    /// The number of a pixel among the places.
    #[inline(always)]
    fn index(&self, [column, row]: [i64; 2]) -> usize {
        let width = self.columns.end - self.columns.start;
        ((row - self.rows.start) * width + column - self.columns.start) as usize
    }

    /// The place of a pixel.
    #[inline(always)]
    pub(super) fn at(&self, pixel: [i64; 2]) -> [i64; 2] {
        let [column, row] = &self.places[self.index(pixel)];
        // Of a pixel that another thread writes, the board makes an order.
        [
            column.load(Ordering::Relaxed).into(),
            row.load(Ordering::Relaxed).into(),
        ]
    }

    /// Corrects quarters of the pixels in some rows one after the other, but those pixels from which not all is there that
    /// is read.
    fn correct(&self, stage: &Stage, quarters: &[[i64; 2]], rows: Range<i64>) {
        let level = simd::level();
        let turns = self.turns(quarters, &rows);
        let mut workers = vec![(); parallel::n_threads()];
        let board = Board::new(0..turns.len(), workers.len());
        parallel::together(&mut workers, |thread, ()| {
            while let Some(turn) = board.take(thread) {
                let Turn { quarter, row, wait } = turns[turn];
                board.wait(wait);
                let columns = odd_or_even(&self.columns, quarter[0]);
                dispatch!(level, _simd => self.correct_row(stage, columns, row));
            }
        });
    }

    /// The rows, in parts after which the progress is reported, each with the rows around it that it reads.
    fn parts(&self) -> impl Iterator<Item = Range<i64>> + use<> {
        let rows = self.rows.start..self.rows.end - 2 * READS;
        let n_rows = (REPORTED / (self.columns.end - self.columns.start)).max(2);
        let firsts = rows.clone().step_by(n_rows as usize);
        firsts.map(move |first| first..rows.end.min(first + n_rows) + 2 * READS)
    }

    /// Corrects some pixels of a row.
    #[inline(always)]
    fn correct_row(&self, stage: &Stage, columns: impl Iterator<Item = i64>, row: i64) {
        for column in columns {
            let [across, down] = narrow(self.corrected(stage, [column, row]));
            let to = &self.places[self.index([column, row])];
            to[0].store(across, Ordering::Relaxed);
            to[1].store(down, Ordering::Relaxed);
        }
    }

    /// The rows of quarters. Each waits for those of the quarter before it that it reads, and that read it.
    fn turns(&self, quarters: &[[i64; 2]], rows: &Range<i64>) -> Vec<Turn> {
        let mut turns: Vec<Turn> = Vec::new();
        let mut before = 0..0;
        for &quarter in quarters {
            let first = turns.len();
            for row in odd_or_even(rows, quarter[1]) {
                let is_near = |turn: &Turn| turn.row <= row + READS;
                let wait = before.start + turns[before.clone()].partition_point(is_near);
                turns.push(Turn { quarter, row, wait });
            }
            before = first..turns.len();
        }
        turns
    }

    /// The place around which the exemplar looks most like the texture around a pixel. Of equally good ones the first.
    #[inline(always)]
    fn corrected(&self, stage: &Stage, [column, row]: [i64; 2]) -> [i64; 2] {
        let mut choice = Choice {
            stage,
            area: self,
            pixel: [column, row],
            around: self.around(stage, [column, row]),
            best: (f32::INFINITY, self.at([column, row])),
        };
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
        for &place in &coherent[..n_coherent] {
            if let Some(place) = stage.similar(place) {
                choice.compare(place, 1.0 + stage.coherence);
            }
        }
        choice.best.1
    }

    /// Whether a place is less than half as far from that of a pixel beside the given one as the two pixels are from each
    /// other. Pixels of the same quarter do not count, since they are corrected at the same time.
    #[inline(always)]
    fn repeats(&self, stage: &Stage, [column, row]: [i64; 2], place: [i64; 2]) -> bool {
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

    /// The features on the diagonals of a pixel: of each the mean of what it has and what two pixels beyond it, one along
    /// each axis, go on to there.
    #[inline(always)]
    pub(super) fn around(&self, stage: &Stage, [column, row]: [i64; 2]) -> [[f32; N_FEATURES]; 4] {
        let mut around = [[0.0; N_FEATURES]; 4];
        for (sums, [x, y]) in around.iter_mut().zip(DIAGONALS) {
            for [beyond_x, beyond_y] in [[0, 0], [x, 0], [0, y]] {
                let [across, down] = self.at([column + x + beyond_x, row + y + beyond_y]);
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

/// The choice of a place for a pixel.
struct Choice<'a> {
    stage: &'a Stage,
    area: &'a Area,
    pixel: [i64; 2],
    /// The features on the diagonals of the pixel.
    around: [[f32; N_FEATURES]; 4],
    /// The squared distance of the best place up to now, and the place.
    best: (f32, [i64; 2]),
}

impl Choice<'_> {
    /// Takes a place if it is better; its squared distance counts by a factor.
    #[inline(always)]
    fn compare(&mut self, place: [i64; 2], factor: f32) {
        let stage = self.stage;
        let distance_sq = factor * stage.distance_sq(&self.around, place);
        let mut distance_sq = distance_sq + stage.costs.of(place);
        // What is too far already need not be looked for beside the pixel.
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
