//! Constructs a point set slice by slice, on all cores.
//!
//! Each step of a slice runs over bands of rows in parallel. A band reads the results of the previous step and writes
//! only its own rows, so that the result does not depend on the number of threads.

use super::grid::{Cell, FAR, Grid, HALO};
use super::mask::Coverage;
use super::sheet::{GIVEN, POINT, Sheet, domain_rows};
use super::slice::{Band, cover, dart_chances};
use crate::PointsError;
use crate::cancel::{IsCancelled, cancelled};
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
use dapple_hash::Seed;
use dapple_raster::parallel;
use dapple_raster::simd::dispatch;
use fearless_simd::Level;
use glam::DVec2;

/// Number of cell rows in a band: small enough to occupy several cores, large enough that bands duplicate little work.
const BAND_ROWS: u32 = 64;

/// Mean number of darts per cell in each slice.
const DARTS: [f64; 8] = [0.3, 0.4, 0.6, 1.0, 2.0, 4.0, 8.0, 16.0];

/// A point set under construction. After a cancellation, every step returns an error without doing work.
pub(crate) struct Solution<'a> {
    is_cancelled: &'a IsCancelled<'a>,
    grid: &'a Grid,
    coverage: &'a Coverage,
    sheet: Sheet,
    masks: Vec<u64>,
    bands: Vec<Band>,
    level: Level,
}

impl<'a> Solution<'a> {
    /// Creates an empty solution for the domain.
    pub(crate) fn new(
        grid: &'a Grid,
        coverage: &'a Coverage,
        level: Level,
        is_cancelled: &'a IsCancelled<'a>,
    ) -> Result<Self, PointsError> {
        let end = HALO + grid.cells[1];
        let first_rows = (HALO..end).step_by(BAND_ROWS as usize);
        let mut bands = vec![Band::default(); first_rows.len()];
        let items = bands.iter_mut().zip(first_rows);
        for_each(is_cancelled, items, |(band, first)| {
            *band = Band::new(grid, first..end.min(first + BAND_ROWS));
        })?;
        Ok(Self {
            is_cancelled,
            grid,
            coverage,
            sheet: Sheet::new(grid),
            masks: vec![u64::MAX; grid.stride() * grid.rows()],
            bands,
            level,
        })
    }

    /// Adds given points, each in a separate cell.
    pub(crate) fn give(&mut self, places: &[(Cell, [f32; 2])]) -> Result<(), PointsError> {
        for &(cell, offset) in places {
            let band = (cell.row - HALO) / BAND_ROWS;
            self.bands[band as usize].accepted.push((cell, offset));
        }
        for (band, mut sheet) in self
            .bands
            .iter()
            .zip(self.sheet.bands(self.grid, BAND_ROWS))
        {
            for &(cell, offset) in &band.accepted {
                sheet.put(self.grid, cell, offset, GIVEN);
            }
        }
        self.cover()
    }

    /// Adds points until no further point fits.
    pub(crate) fn fill(&mut self, seed: Seed) -> Result<(), PointsError> {
        for (slice, mean) in (0..).zip(DARTS) {
            self.throw_darts(mean, seed.child("darts", slice))?;
            self.settle()?;
            self.cover()?;
        }
        let mut round = 0;
        while self.bands.iter().any(|band| !band.open.is_empty()) {
            self.search_gaps(seed.child("gaps", round))?;
            self.settle()?;
            self.cover()?;
            round += 1;
        }
        Ok(())
    }

    /// Returns the positions of the added points (not the given ones), cell by cell.
    pub(crate) fn positions(&self) -> Result<Vec<DVec2>, PointsError> {
        let mut parts = vec![Vec::new(); self.bands.len()];
        let items = self.bands.iter().zip(&mut parts);
        for_each(self.is_cancelled, items, |(band, part)| {
            *part = self.positions_in(band);
        })?;
        Ok(parts.concat())
    }

    fn positions_in(&self, band: &Band) -> Vec<DVec2> {
        let (grid, sheet) = (self.grid, &self.sheet);
        let columns = HALO..HALO + grid.cells[0];
        let cells = band
            .rows
            .clone()
            .flat_map(|row| columns.clone().map(move |column| Cell { row, column }));
        let mut positions = Vec::with_capacity(band.rows.len() * columns.len() * 2 / 5);
        for cell in cells {
            let index = grid.index(cell);
            if sheet.x[index] < FAR && sheet.rank[index] == POINT {
                positions.push(grid.position(cell, [sheet.x[index], sheet.y[index]]));
            }
        }
        positions
    }

    /// Throws random darts at the open cells, as proposals of points.
    fn throw_darts(&mut self, mean: f64, seed: Seed) -> Result<(), PointsError> {
        let (grid, level) = (self.grid, self.level);
        let chances = dart_chances(mean);
        let masks = self.masks[domain_rows(grid)].chunks(BAND_ROWS as usize * grid.stride());
        let rows = self.sheet.bands(grid, BAND_ROWS).zip(masks);
        let items = self.bands.iter_mut().zip(rows);
        for_each(self.is_cancelled, items, |(band, (sheet, masks))| {
            dispatch!(level, _simd => band.draw_darts(grid, sheet, masks, &chances, seed));
        })
    }

    /// Proposes a random free position in each open cell.
    fn search_gaps(&mut self, seed: Seed) -> Result<(), PointsError> {
        let (grid, sheet, level) = (self.grid, &self.sheet, self.level);
        let masks = self.masks[domain_rows(grid)].chunks_mut(BAND_ROWS as usize * grid.stride());
        let items = self.bands.iter_mut().zip(masks);
        for_each(self.is_cancelled, items, |(band, masks)| {
            dispatch!(level, simd => band.draw_gaps(simd, grid, sheet, masks, seed));
        })?;
        let rows = self.sheet.bands(grid, BAND_ROWS);
        let items = self.bands.iter().zip(rows);
        for_each(self.is_cancelled, items, |(band, sheet)| {
            band.place_gaps(grid, sheet, seed);
        })
    }

    /// Resolves conflicts between proposals, and converts accepted ones to points.
    fn settle(&mut self) -> Result<(), PointsError> {
        let (grid, level) = (self.grid, self.level);
        self.sheet.wrap_rows(grid);
        let sheet = &self.sheet;
        for_each(self.is_cancelled, self.bands.iter_mut(), |band| {
            dispatch!(level, simd => band.judge(simd, grid, sheet));
            band.settle(grid, sheet);
        })?;
        let rows = self.sheet.bands(grid, BAND_ROWS);
        let items = self.bands.iter().zip(rows);
        for_each(self.is_cancelled, items, |(band, sheet)| {
            band.keep_accepted(grid, sheet);
        })?;
        self.sheet.wrap_rows(grid);
        Ok(())
    }

    /// Clears the subcells that the newest points cover.
    fn cover(&mut self) -> Result<(), PointsError> {
        let (grid, coverage, level) = (self.grid, self.coverage, self.level);
        let bands = &self.bands;
        let masks = self.masks[domain_rows(grid)].chunks_mut(BAND_ROWS as usize * grid.stride());
        let items = bands.iter().enumerate().zip(masks);
        for_each(self.is_cancelled, items, |((own, band), masks)| {
            for neighbor in neighbors(own, bands.len()) {
                let accepted = &bands[neighbor].accepted;
                dispatch!(level, _simd => cover(grid, coverage, masks, &band.rows, accepted));
            }
        })
    }
}

/// Returns the indices of a band and its two neighbors, wrapped around the domain, without duplicates.
fn neighbors(band: usize, count: usize) -> impl Iterator<Item = usize> {
    let around = [band, (band + 1) % count, (band + count - 1) % count];
    (0..around.len().min(count)).map(move |at| around[at])
}

/// Calls `work` for every item unless canceled, on all cores if the feature `rayon` is enabled.
fn for_each<T: Send>(
    is_cancelled: &IsCancelled,
    items: impl Iterator<Item = T>,
    work: impl Fn(T) + Sync,
) -> Result<(), PointsError> {
    let is_over = AtomicBool::new(false);
    parallel::consume(items.collect(), |_, item| {
        if is_over.load(Relaxed) || is_cancelled() {
            is_over.store(true, Relaxed);
        } else {
            work(item);
        }
    });
    cancelled(is_over.into_inner())
}
