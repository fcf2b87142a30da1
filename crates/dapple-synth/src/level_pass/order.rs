//! Determines the order of the sites of a pass, and distributes them over threads.
//!
//! There are three cases:
//!
//! - A pass that reads only the coarser level visits sites in any order, on all threads ([`LevelPass::visit_freely`]).
//! - A pass that reads its own level follows the sweep in a wavefront schedule ([`WavefrontSchedule`]): a site runs after every
//!   earlier site that it reads. The result equals a sequential sweep.
//! - A pass that counts usage ([`Usage`]) is sequential, because each site depends on all earlier ones.

use super::{LevelPass, State, Worker};
use crate::SynthError;
use crate::domain::{LevelState, Sources, SynthesisDomain};
use crate::sample_cache::SampleCache;
use crate::usage::Usage;
use crate::wavefront::{WavefrontProgress, WavefrontSchedule};
use core::iter::repeat_with;
use dapple_raster::parallel;
use std::sync::{Mutex, PoisonError};

/// Maximum number of sites between two progress callbacks.
const STRETCH: usize = 1 << 14;
/// Number of independent sites that a thread takes at a time.
const PIECE: usize = 64;

impl<G: SynthesisDomain> LevelPass<'_, G> {
    /// Visits all sites of the level. `levels` holds their sources, `kept` the coarser squares retained by the previous
    /// pass. Returns the coarser squares that this pass retains for the next one, `keep` samples wide.
    pub(crate) fn run(
        &self,
        levels: &[Sources],
        kept: &SampleCache,
        keep: u32,
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<SampleCache, SynthError> {
        let painted = |level: usize| LevelState {
            pixels: self.pyramid[level].plain(),
            sources: &levels[level],
        };
        let state = State {
            here: painted(self.level),
            coarser: self.coarser.map(|_| painted(self.level + 1)),
            kept,
            factors: None,
        };
        // Choose the order by the levels that the pass reads.
        let mut workers = Vec::new();
        workers.resize_with(parallel::n_threads(), Worker::default);
        if self.same.is_none() {
            return self.visit_freely(&state, &mut workers, keep as usize, tell);
        }
        if self.evenness > 0.0 {
            self.visit_and_count(state, tell)?;
        } else {
            self.visit_in_turns(&state, &mut workers, tell)?;
        }
        Ok(SampleCache::default())
    }

    /// Visits sites sequentially and counts how often pixels are used.
    fn visit_and_count(
        &self,
        state: State<'_>,
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<(), SynthError> {
        let order = self.domain.order(self.level);
        let mut usage = Usage::new(self.evenness, self.candidates.len(), order.len());
        let mut worker = Worker::default();
        let mut done = 0;
        for stretch in order.chunks(STRETCH) {
            for &site in stretch {
                let factors = usage.factors();
                let row = self.visit(site, &mut worker, &State { factors, ..state });
                usage.add(row, &self.candidates);
            }
            done += stretch.len();
            tell(done)?;
        }
        Ok(())
    }

    /// Visits sites that may read each other, in the wavefront schedule.
    fn visit_in_turns(
        &self,
        state: &State<'_>,
        workers: &mut [Worker<G::Memory>],
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<(), SynthError> {
        // One thread needs no schedule.
        let turns = if workers.len() == 1 {
            WavefrontSchedule::in_order(self.domain.order(self.level))
        } else {
            self.domain.turns(self.level, &self.prepared)
        };
        // Run the schedule in stretches, with a progress report after each.
        for first in (0..turns.len()).step_by(STRETCH) {
            let end = turns.len().min(first + STRETCH);
            let board = WavefrontProgress::new(first..end, workers.len());
            parallel::together(workers, |thread, worker| {
                while let Some(turn) = board.take(thread) {
                    let (site, wait) = turns.turn(turn);
                    board.wait(wait);
                    self.visit(site, worker, state);
                }
            });
            tell(end)?;
        }
        Ok(())
    }

    /// Visits sites that read only the coarser level. They are independent, so any order gives the same result.
    fn visit_freely(
        &self,
        state: &State<'_>,
        workers: &mut [Worker<G::Memory>],
        keep: usize,
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<SampleCache, SynthError> {
        let n_sites = self.domain.n_sites(self.level);
        let mut kept = SampleCache::new(n_sites, keep, self.n_channels);
        let side = self.coarser.map_or(0, |half| 2 * half.half as usize + 1);
        // Pair each site with the memory for its retained square, if squares are retained.
        let rooms = kept.sites().map(Some).chain(repeat_with(|| None));
        let start = self.domain.start(self.level);
        let is_visited = |site: u32| start.is_none_or(|start| !start.is_kept[site as usize]);
        let mut sites = (0..n_sites as u32).zip(rooms);
        for first in (0..n_sites).step_by(STRETCH) {
            let end = n_sites.min(first + STRETCH);
            let left = Mutex::new(sites.by_ref().take(end - first));
            parallel::together(workers, |_, worker| {
                loop {
                    // Take the next sites.
                    let mut left = left.lock().unwrap_or_else(PoisonError::into_inner);
                    let piece: Vec<_> = left.by_ref().take(PIECE).collect();
                    drop(left);
                    if piece.is_empty() {
                        return;
                    }
                    // Visit them, and store their coarser squares.
                    for (site, room) in piece.into_iter().filter(|(site, _)| is_visited(*site)) {
                        self.visit(site, worker, state);
                        if let Some(mut room) = room {
                            room.copy(&worker.coarser, side);
                        }
                    }
                }
            });
            tell(end)?;
        }
        drop(sites);
        Ok(kept)
    }
}
