//! Windows of noise: what the pixels of a column or of a row share is computed once.
//!
//! A row of pixels lies in one row of places. The three rows of coefficients around it become one, and then each pixel
//! needs three numbers of that instead of nine. The sums are those of a single position, in the same order.

use super::band::Band;
use super::place::{Period, Place};
use super::tile::{Tile, across};
use dapple_raster::{RasterError, RasterViewMut, Window};

/// How many rows of pixels a thread takes at once.
const ROWS: u32 = 16;

/// Fills a window with the weighted values of bands, each with its tile, on all cores where the feature `rayon` is on.
pub(super) fn render<const N: usize>(
    bands: &[(&Band<N>, &Tile<2>)],
    period: Period,
    window: &Window,
    out: RasterViewMut<'_, f32>,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    let [n_columns, n_rows] = window.size;
    let columns = (0..n_columns).map(|column| period.places([window.column_x(column)]));
    let rows = (0..n_rows).map(|row| period.places([window.row_y(row)]));
    let lines = Lines {
        columns: columns.collect(),
        rows: rows.collect(),
    };
    let sheets = bands.iter();
    let sheets: Vec<_> = sheets
        .map(|(band, tile)| Sheet::new(band, tile, period, &lines))
        .collect();
    let fill = |(index, mut strip): (usize, RasterViewMut<'_, f32>)| {
        let first = index * ROWS as usize;
        for (row, values) in (first..).zip(strip.rows_mut()) {
            lines.fill_row(&sheets, row, values);
        }
    };
    let strips = out.bands(ROWS).enumerate();
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        let strips: Vec<_> = strips.collect();
        strips.into_par_iter().for_each(fill);
    }
    #[cfg(not(feature = "rayon"))]
    strips.for_each(fill);
    Ok(())
}

/// The columns and rows of a window, with no place where the coordinate is not finite.
struct Lines {
    columns: Vec<Option<[Place; 1]>>,
    rows: Vec<Option<[Place; 1]>>,
}

/// A band in a window.
struct Sheet<'a> {
    tile: &'a Tile<2>,
    weight: f32,
    columns: Vec<Place>,
    rows: Vec<Place>,
}

impl<'a> Sheet<'a> {
    fn new<const N: usize>(
        band: &Band<N>,
        tile: &'a Tile<2>,
        period: Period,
        lines: &Lines,
    ) -> Self {
        let place = |line: &Option<[Place; 1]>, axis| {
            // Any place does where there is none: its values are replaced by NaN.
            line.map_or(Place::ZERO, |[place]| band.place(period, place, axis))
        };
        Self {
            tile,
            weight: band.weight,
            columns: lines.columns.iter().map(|line| place(line, 0)).collect(),
            rows: lines.rows.iter().map(|line| place(line, 1)).collect(),
        }
    }

    /// Adds the weighted values of a row of pixels.
    fn add_row(&self, y: Place, values: &mut [f32]) {
        let (tile, weight) = (self.tile, self.weight);
        // A row of the tile repays itself only if it is read often enough.
        if self.columns.len() < tile.side() / 4 {
            for (value, &x) in values.iter_mut().zip(&self.columns) {
                *value += weight * tile.value([x, y]);
            }
            return;
        }
        let mut row = vec![0.0; tile.side()];
        tile.blend_row(y, &mut row);
        for (value, x) in values.iter_mut().zip(&self.columns) {
            let cells = &row[x.index()..][..3];
            *value += weight * across(x.weights(), [cells[0], cells[1], cells[2]]);
        }
    }
}

impl Lines {
    fn fill_row(&self, sheets: &[Sheet<'_>], row: usize, values: &mut [f32]) {
        if self.rows[row].is_none() {
            values.fill(f32::NAN);
            return;
        }
        values.fill(0.0);
        for sheet in sheets {
            sheet.add_row(sheet.rows[row], values);
        }
        for (value, column) in values.iter_mut().zip(&self.columns) {
            if column.is_none() {
                *value = f32::NAN;
            }
        }
    }
}
