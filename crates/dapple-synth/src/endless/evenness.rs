//! How evenly textures use the parts of an exemplar: what a part costs in a match.
//!
//! Corrections alone take what fits many neighborhoods again and again: of a photograph of grass, one that is lighter on one
//! side, textures have little but the middle. So every part of the exemplar, of which there are up to 16 × 16, has a cost
//! that is added to the squared distance of its pixels. Costs are found by trials: a piece of the texture is made, the
//! parts that it has too often become dearer, and those that it has too rarely cheaper; the costs of the most even trial
//! are kept. They belong to the texture and not to a window, so that windows are crops of larger ones.
//!
//! What lies beside something that looks the same in every detail is noticed even where all parts are used equally often. So
//! a pixel costs more, too, that is nearly from where one beside it is from, instead of as far from there as it should be. In
//! what is regular, such as bricks, everything is repeated, and it costs nothing.
//!
//! Only levels have costs of which the piece is at least as wide as the exemplar: on finer ones it is too small to show all
//! parts, and what they have follows from the coarser ones.
//!
//! Reference: our own; prices that rise with the demand are those of Bertsekas's auctions for assignment problems.

use super::Endless;
use super::stage::Stage;
use super::window::{Area, READS};
use crate::SynthError;
use crate::engine::Wanted;
use dapple_raster::parallel;

/// The columns and rows of the piece that a trial makes, in pixels of the level.
const SIDE: i64 = 64;

/// The trials of a level.
const N_TRIALS: u32 = 20;

/// The most parts along an axis.
const MAX_PARTS: u32 = 16;

/// How much a cost changes after the first trial, in mean squared distances, for a part that textures never have.
const STEP: f32 = 0.8;

/// The trials after which costs change by half as much as after the first.
const HALF_STEP: f32 = 8.0;

/// The cost of a place that repeats what lies beside a pixel, in mean squared distances: 4 % of the pixels of a texture of leaves have
/// their source again within 16 pixels without it, and 1 % with it; twice as much leaves hardly fewer.
pub(super) const REPETITION: f32 = 1.0;

/// What the parts of an exemplar cost; nothing if they are not told apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Costs {
    /// The part of each column in the first row, and what each row adds to that.
    of_column: Vec<u32>,
    of_row: Vec<u32>,
    of_part: Vec<f32>,
}

impl Costs {
    /// Parts of an exemplar that cost nothing.
    pub(crate) fn new(size: [u32; 2], spacing: u32) -> Self {
        let side = spacing.max((size[0].max(size[1]) - 1) / MAX_PARTS + 1);
        let [n_columns, n_rows] = size.map(|n| (n - 1) / side + 1);
        Self {
            of_column: (0..size[0]).map(|column| column / side).collect(),
            of_row: (0..size[1]).map(|row| row / side * n_columns).collect(),
            of_part: vec![0.0; (n_columns * n_rows) as usize],
        }
    }

    /// The part of a place within the exemplar.
    #[inline]
    fn part(&self, [column, row]: [i64; 2]) -> usize {
        (self.of_row[row as usize] + self.of_column[column as usize]) as usize
    }

    /// What a place within the exemplar costs.
    #[inline]
    pub(crate) fn of(&self, place: [i64; 2]) -> f32 {
        if self.of_part.is_empty() {
            return 0.0;
        }
        self.of_part[self.part(place)]
    }

    /// The share of each part among some places.
    pub(crate) fn shares(&self, places: impl IntoIterator<Item = [u32; 2]>) -> Vec<f32> {
        let mut counts = vec![0_u32; self.of_part.len()];
        let mut n_places = 0;
        for place in places {
            counts[self.part(place.map(i64::from))] += 1;
            n_places += 1;
        }
        let share = |count| count as f32 / n_places.max(1) as f32;
        counts.into_iter().map(share).collect()
    }

    /// Makes parts dearer that there are too many of, and those cheaper that there are too few of: by `step` where all or
    /// none are too many.
    pub(crate) fn change(&mut self, shares: &[f32], wanted: &[f32], step: f32) {
        for (cost, (share, wanted)) in self.of_part.iter_mut().zip(shares.iter().zip(wanted)) {
            if *wanted > 0.0 {
                *cost += step * (share - wanted) / (share + wanted);
            }
        }
    }
}

impl Endless {
    /// Finds out what the parts of the exemplar cost on the coarser levels, and what `repetition` does, which is given in mean
    /// squared distances.
    pub(crate) fn even_out(
        &mut self,
        repetition: f32,
        wanted: &Wanted<'_>,
    ) -> Result<(), SynthError> {
        let mut coarser: Option<Area> = None;
        for level in (0..self.stages.len()).rev() {
            let Stage { size, spacing, .. } = self.stages[level];
            if SIDE * spacing < i64::from(size[0].max(size[1])) {
                return Ok(());
            }
            let mut costs = Costs::new(size, spacing as u32);
            let usable = self.stages[level].usable_pixels();
            let even = costs.shares(
                usable
                    .iter()
                    .map(|pixel| [pixel % size[0], pixel / size[0]]),
            );
            let half = SIDE / 2;
            let mut scale = None;
            let mut best = (f32::INFINITY, costs.clone(), None);
            for trial in 0..N_TRIALS {
                wanted.check()?;
                self.stages[level].costs = costs.clone();
                let made = self.area(level, coarser.as_ref(), [-half..half, -half..half]);
                let scale = *scale.get_or_insert_with(|| made.mean_sq(&self.stages[level]));
                // Where it is farther, what goes on past the edge of an exemplar that wraps would count as repeated.
                if 2 * READS * spacing <= i64::from(size[0].min(size[1])) {
                    self.stages[level].repetition_cost = repetition * scale;
                }
                let shares = costs.shares(made.inner().map(|at| made.at(at).map(|at| at as u32)));
                let pairs = || shares.iter().zip(&even);
                let uneven = pairs().map(|(a, b)| (a - b).abs()).sum();
                if uneven < best.0 {
                    best = (uneven, costs.clone(), Some(made));
                }
                costs.change(
                    &shares,
                    &even,
                    STEP * scale / (1.0 + trial as f32 / HALF_STEP),
                );
            }
            (_, self.stages[level].costs, coarser) = best;
        }
        Ok(())
    }
}

impl Area {
    /// The pixels around which everything is here that a correction reads.
    fn inner(&self) -> impl Iterator<Item = [i64; 2]> {
        let rows = self.rows.start + READS..self.rows.end - READS;
        let columns = self.columns.start + READS..self.columns.end - READS;
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }

    /// The mean squared distance of what is around pixels and around their places in the exemplar.
    fn mean_sq(&self, stage: &Stage) -> f32 {
        let inner: Vec<[i64; 2]> = self.inner().collect();
        let distances = parallel::map_at_least(64, inner.len(), |at| {
            stage.distance_sq(&self.around(stage, inner[at]), self.at(inner[at]))
        });
        distances.iter().sum::<f32>() / inner.len() as f32
    }
}
