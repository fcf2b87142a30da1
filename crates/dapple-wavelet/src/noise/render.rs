//! Renders noise windows. Work that the pixels of a row or column share is done once.
//!
//! All pixels of a row have the same y. The three rows of coefficients around it are blended into one, so that each
//! pixel needs three values instead of nine. The sums have the same order as for a single position.

use super::band::Band;
use super::place::{Period, Place};
use super::tile::{Tile, across};
use dapple_raster::{RasterError, RasterViewMut, Window};

/// Number of pixel rows in a band, the unit of parallel work.
const ROWS: u32 = 16;

/// Renders the weighted sum of bands (each with its own tile) in a window, on all cores if the feature `rayon` is
/// enabled.
pub(super) fn render<const N: usize>(
    bands: &[(&Band<N>, &Tile<2>)],
    periods: [Period; 2],
    window: &Window,
    out: RasterViewMut<'_, f32>,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    let picture = Picture::new(bands, periods, window);
    out.for_each_band(ROWS, |first, mut band| {
        for (row, values) in (first..).zip(band.rows_mut()) {
            picture.fill_row(row, values);
        }
    });
    Ok(())
}

/// A window of noise, with the column data that all rows share.
struct Picture<'a, const N: usize> {
    periods: [Period; 2],
    window: &'a Window,
    sheets: Vec<Sheet<'a, N>>,
    /// Indices of blind columns: columns whose coordinate is not finite.
    blind: Vec<usize>,
}

/// A band of the noise, with its column data for a window.
struct Sheet<'a, const N: usize> {
    band: &'a Band<N>,
    tile: &'a Tile<2>,
    /// Tile coordinates of the columns along x; arbitrary for blind columns.
    columns: Vec<Place>,
}

impl<'a, const N: usize> Picture<'a, N> {
    fn new(bands: &[(&'a Band<N>, &'a Tile<2>)], periods: [Period; 2], window: &'a Window) -> Self {
        let period = periods[0];
        let columns = (0..window.size[0]).map(|column| period.place_of(window.column_x(column)));
        let columns: Vec<Option<Place>> = columns.collect();
        let sheet = |&(band, tile): &(&'a Band<N>, &'a Tile<2>)| {
            let column =
                |place: &Option<Place>| band.place(period, place.unwrap_or(Place::ZERO), 0);
            let columns = columns.iter().map(column).collect();
            Sheet {
                band,
                tile,
                columns,
            }
        };
        let blind = (0..columns.len()).filter(|&column| columns[column].is_none());
        Self {
            periods,
            window,
            sheets: bands.iter().map(sheet).collect(),
            blind: blind.collect(),
        }
    }

    fn fill_row(&self, row: u32, values: &mut [f32]) {
        let Some(y) = self.periods[1].place_of(self.window.row_y(row)) else {
            values.fill(f32::NAN);
            return;
        };
        values.fill(0.0);
        for sheet in &self.sheets {
            sheet.add_row(sheet.band.place(self.periods[1], y, 1), values);
        }
        for &column in &self.blind {
            values[column] = f32::NAN;
        }
    }
}

impl<const N: usize> Sheet<'_, N> {
    /// Adds the band's weighted values to a row of pixels.
    fn add_row(&self, y: Place, values: &mut [f32]) {
        let (tile, weight) = (self.tile, self.band.weight);
        // Blending a row of the tile is worthwhile only if enough pixels read it.
        if self.columns.len() < tile.row_len() / 4 {
            for (value, &x) in values.iter_mut().zip(&self.columns) {
                *value += weight * tile.value([x, y]);
            }
            return;
        }
        let mut row = vec![0.0; tile.row_len()];
        tile.blend_row(y, &mut row);
        for (value, x) in values.iter_mut().zip(&self.columns) {
            let cells = &row[x.index()..][..3];
            *value += weight * across(x.weights(), [cells[0], cells[1], cells[2]]);
        }
    }
}
