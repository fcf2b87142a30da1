//! Evens out how often the parts of an exemplar are used, by costs that are added to the distances during correction.
//!
//! Without costs, correction prefers pixels that fit many neighborhoods. For example, textures of a photograph of grass
//! that is lighter on one side use little but its middle. So the exemplar is divided into at most 16 × 16 parts, and
//! the cost of a part is added to the squared distance of its pixels.
//!
//! Costs are found by trials. Each trial computes a piece of the texture, then raises the costs of parts that it uses
//! too often and lowers the costs of parts that it uses too rarely. The costs of the most even trial are retained. They
//! belong to the texture and not to a window, so a pixel does not depend on the window that contains it.
//!
//! A second cost penalizes repetition: two equal details close to each other are visible even if all parts are used
//! equally often. It applies if two nearby pixels have sources that are much closer to each other than the pixels are.
//! Regular exemplars such as bricks repeat everywhere, and have no such cost.
//!
//! Costs are used only on levels on which the trial piece is at least as wide as the exemplar. On finer levels the
//! piece is too small to show all parts, and the usage of parts follows from the coarser levels.
//!
//! Reference: the method is our own. Prices that rise with demand come from Bertsekas's auction algorithm for
//! assignment problems.

use super::Endless;
use super::level::AppearanceLevel;
use super::window::{Area, READS};
use crate::SynthError;
use crate::engine::Wanted;
use dapple_raster::parallel;

/// Side of the piece that a trial computes, in pixels of the level.
const SIDE: i64 = 64;

/// Number of trials per level.
const N_TRIALS: u32 = 20;

/// Maximum number of parts along an axis.
const MAX_PARTS: u32 = 16;

/// Decrease in the cost of a part that the first trial does not use, in multiples of the mean squared distance.
const STEP: f32 = 0.8;

/// Number of trials after which the changes in costs are half as large.
const HALF_STEP: f32 = 8.0;

/// Cost of a source that is repeated nearby, in multiples of the mean squared distance.
///
/// Measured on a texture of leaves: 4 % of the pixels have their source repeated within 16 pixels without this cost,
/// and 1 % with it. Doubling the cost hardly lowers this further.
pub(super) const REPETITION: f32 = 1.0;

/// Costs of the parts of an exemplar; empty if all parts cost nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Costs {
    /// Contribution of each column to the index of a pixel's part; the index is the sum of a column's and a row's
    /// value.
    of_column: Vec<u32>,
    of_row: Vec<u32>,
    of_part: Vec<f32>,
}

impl Costs {
    /// Divides an exemplar into parts without costs. A part is at least `spacing` pixels wide.
    pub(crate) fn new(size: [u32; 2], spacing: u32) -> Self {
        let side = spacing.max((size[0].max(size[1]) - 1) / MAX_PARTS + 1);
        let [n_columns, n_rows] = size.map(|n| (n - 1) / side + 1);
        Self {
            of_column: (0..size[0]).map(|column| column / side).collect(),
            of_row: (0..size[1]).map(|row| row / side * n_columns).collect(),
            of_part: vec![0.0; (n_columns * n_rows) as usize],
        }
    }

    /// Returns the index of the part that contains a pixel of the exemplar.
    #[inline]
    fn part(&self, [column, row]: [i64; 2]) -> usize {
        (self.of_row[row as usize] + self.of_column[column as usize]) as usize
    }

    /// Returns the cost of a pixel of the exemplar.
    #[inline]
    pub(crate) fn of(&self, place: [i64; 2]) -> f32 {
        if self.of_part.is_empty() {
            return 0.0;
        }
        self.of_part[self.part(place)]
    }

    /// Returns the fraction of the given pixels in each part.
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

    /// Raises the costs of parts whose share exceeds the one in `wanted`, and lowers the costs of parts with a smaller
    /// share. The decrease is `step` for a part without pixels; the increase approaches `step` for a part with far too
    /// many.
    pub(crate) fn change(&mut self, shares: &[f32], wanted: &[f32], step: f32) {
        for (cost, (share, wanted)) in self.of_part.iter_mut().zip(shares.iter().zip(wanted)) {
            if *wanted > 0.0 {
                *cost += step * (share - wanted) / (share + wanted);
            }
        }
    }
}

impl Endless {
    /// Finds the costs of the exemplar's parts on the coarser levels. `repetition` is the cost of a repeated source, in
    /// multiples of the mean squared distance.
    pub(crate) fn even_out(
        &mut self,
        repetition: f32,
        wanted: &Wanted<'_>,
    ) -> Result<(), SynthError> {
        let mut coarser: Option<Area> = None;
        for level in (0..self.stages.len()).rev() {
            // Stop at the first level on which the piece is smaller than the exemplar.
            let AppearanceLevel { size, spacing, .. } = self.stages[level];
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
            // Compute a piece with the current costs.
            let half = SIDE / 2;
            let mut scale = None;
            let mut best = (f32::INFINITY, costs.clone(), None);
            for trial in 0..N_TRIALS {
                wanted.check()?;
                self.stages[level].costs = costs.clone();
                let made = self.area(level, coarser.as_ref(), [-half..half, -half..half]);
                // Costs are relative to the distances of the first trial, so they do not depend on the exemplar's
                // contrast.
                let scale = *scale.get_or_insert_with(|| made.mean_sq(&self.stages[level]));
                // At larger distances, an exemplar that wraps would count as repeated where it continues past its edge.
                if 2 * READS * spacing <= i64::from(size[0].min(size[1])) {
                    self.stages[level].repetition_cost = repetition * scale;
                }
                // Measure the unevenness; retain the costs and the piece of the most even trial.
                let shares = costs.shares(made.inner().map(|at| made.at(at).map(|at| at as u32)));
                let pairs = || shares.iter().zip(&even);
                let uneven = pairs().map(|(a, b)| (a - b).abs()).sum();
                if uneven < best.0 {
                    best = (uneven, costs.clone(), Some(made));
                }
                // Adjust the costs for the next trial.
                costs.change(
                    &shares,
                    &even,
                    STEP * scale / (1.0 + trial as f32 / HALF_STEP),
                );
            }
            // The trials of the next level start from the piece of the most even trial.
            (_, self.stages[level].costs, coarser) = best;
        }
        Ok(())
    }
}

impl Area {
    /// Returns the pixels whose correction reads only pixels within the area.
    fn inner(&self) -> impl Iterator<Item = [i64; 2]> {
        let rows = self.rows.start + READS..self.rows.end - READS;
        let columns = self.columns.start + READS..self.columns.end - READS;
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }

    /// Returns the mean squared distance between the features around pixels and around their sources.
    fn mean_sq(&self, stage: &AppearanceLevel) -> f32 {
        let inner: Vec<[i64; 2]> = self.inner().collect();
        let distances = parallel::map_at_least(64, inner.len(), |at| {
            stage.distance_sq(&self.around(stage, inner[at]), self.at(inner[at]))
        });
        distances.iter().sum::<f32>() / inner.len() as f32
    }
}
