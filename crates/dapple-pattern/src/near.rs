//! Fields whose value at a position depends on the items (stamps, or impulses of noise) in the cells around it.
//!
//! Positions and items are relative to the corner of the position's cell, so that precision does not depend on the
//! distance of the cell from the origin. The items near a cell are listed once, and each block of pixels selects its
//! items from that list.

use dapple_raster::{RasterError, RasterViewMut, Window};

/// Width and height of a block of pixels that share one list of items.
const BLOCK: usize = 16;

/// Number of pixel rows in a band, the unit of parallel work.
const BAND_ROWS: u32 = 64;

/// A field whose value depends on items in unit cells.
pub(crate) trait NearCells: Sync {
    /// Item type, such as a stamp.
    type Item: Copy;

    /// Appends the items that may affect a box, given by its center and half-size. The box and the items are
    /// relative to the corner of `cell`. The order of items does not depend on the box.
    fn near(&self, cell: [i64; 2], center: [f64; 2], half: [f64; 2], near: &mut Vec<Self::Item>);

    /// Returns whether an item may affect a box, given by its center and half-size.
    fn meets(item: &Self::Item, center: [f64; 2], half: [f64; 2]) -> bool;

    /// Returns the value at a position, given the items near it in the order of [`near`](Self::near).
    fn value_of(&self, near: &[Self::Item], position: [f64; 2]) -> f32;
}

/// A cell, and the items near it.
type Listed<T> = ([i64; 2], Vec<T>);

/// Returns the value at a position; NaN if the position is not finite.
pub(crate) fn value<F: NearCells>(field: &F, position: [f64; 2]) -> f32 {
    let [(column, x), (row, y)] = position.map(place);
    if !x.is_finite() || !y.is_finite() {
        return f32::NAN;
    }
    let mut near = Vec::new();
    field.near([column, row], [x, y], [0.0; 2], &mut near);
    field.value_of(&near, [x, y])
}

/// Computes the values at many positions.
pub(crate) fn values<F: NearCells>(
    field: &F,
    positions: &[[f64; 2]],
    values: &mut [f32],
) -> Result<(), RasterError> {
    RasterError::check_length(values.len(), positions.len())?;
    // Positions that follow each other are often in the same few cells.
    let mut cells: Vec<Option<Listed<F::Item>>> = vec![None; 64];
    for (value, &position) in values.iter_mut().zip(positions) {
        let [(column, x), (row, y)] = position.map(place);
        if !x.is_finite() || !y.is_finite() {
            *value = f32::NAN;
            continue;
        }
        let cell = [column, row];
        let slot = &mut cells[(column & 7 | (row & 7) << 3) as usize];
        let near = match slot {
            Some((known, near)) if *known == cell => near,
            slot => {
                let mut near = Vec::new();
                field.near(cell, [0.5; 2], [0.5; 2], &mut near);
                &mut slot.insert((cell, near)).1
            }
        };
        *value = field.value_of(near, [x, y]);
    }
    Ok(())
}

/// Renders a window, on all cores if the feature `rayon` is enabled.
pub(crate) fn render<F: NearCells>(
    field: &F,
    window: &Window,
    out: RasterViewMut<'_, f32>,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    let columns: Vec<_> = (0..window.size[0])
        .map(|column| place(window.column_x(column)))
        .collect();
    out.for_each_band(BAND_ROWS, |row, band| {
        let rows: Vec<_> = (row..row + band.size()[1])
            .map(|row| place(window.row_y(row)))
            .collect();
        render_band(field, &columns, &rows, band);
    });
    Ok(())
}

/// Renders rows of pixels. A column or row is given by its cell and its offset in the cell.
fn render_band<F: NearCells>(
    field: &F,
    columns: &[(i64, f64)],
    rows: &[(i64, f64)],
    mut out: RasterViewMut<'_, f32>,
) {
    let bounds = |columns: &[(i64, f64)], rows: &[(i64, f64)]| {
        let [x, y] = [extent(columns), extent(rows)];
        ([x.0, y.0], [x.1, y.1])
    };
    let (mut of_cell, mut of_block) = (Vec::new(), Vec::new());
    for (first_row, rows) in runs(rows, usize::MAX) {
        for (first_column, columns) in runs(columns, usize::MAX) {
            let (center, half) = bounds(columns, rows);
            of_cell.clear();
            field.near([columns[0].0, rows[0].0], center, half, &mut of_cell);
            // Select the items of each block of pixels from the cell's items.
            for (row, rows) in runs(rows, BLOCK) {
                for (column, columns) in runs(columns, BLOCK) {
                    let (center, half) = bounds(columns, rows);
                    of_block.clear();
                    let meeting = of_cell.iter().filter(|item| F::meets(item, center, half));
                    of_block.extend(meeting.copied());
                    let at = [first_column + column, first_row + row];
                    render_block(field, &of_block, [columns, rows], at, &mut out);
                }
            }
        }
    }
}

/// Renders a block of pixels that are in one cell. `at` is the column and row of its first pixel in `out`.
fn render_block<F: NearCells>(
    field: &F,
    near: &[F::Item],
    [columns, rows]: [&[(i64, f64)]; 2],
    at: [usize; 2],
    out: &mut RasterViewMut<'_, f32>,
) {
    for (row, &(_, y)) in (at[1]..).zip(rows) {
        let pixels = &mut out.row_mut(row as u32)[at[0]..at[0] + columns.len()];
        for (pixel, &(_, x)) in pixels.iter_mut().zip(columns) {
            *pixel = match x.is_finite() && y.is_finite() {
                true => field.value_of(near, [x, y]),
                false => f32::NAN,
            };
        }
    }
}

/// Splits a coordinate into its cell and the offset in the cell.
fn place(coordinate: f64) -> (i64, f64) {
    let cell = coordinate.floor();
    (cell as i64, coordinate - cell)
}

/// Splits a line of pixels into runs of at most `most` pixels in the same cell. Each run comes with the index of its
/// first pixel.
fn runs(pixels: &[(i64, f64)], most: usize) -> impl Iterator<Item = (usize, &[(i64, f64)])> {
    let mut first = 0;
    let same = pixels.chunk_by(|a, b| a.0 == b.0);
    let runs = same.flat_map(move |run| run.chunks(most.min(run.len())));
    runs.map(move |run| {
        let at = first;
        first += run.len();
        (at, run)
    })
}

/// Returns the center and half of the length of the range of the pixels' offsets. NaN is ignored.
fn extent(pixels: &[(i64, f64)]) -> (f64, f64) {
    let offsets = pixels.iter().map(|&(_, offset)| offset);
    let (low, high) = offsets.fold((1.0_f64, 0.0_f64), |(low, high), offset| {
        (low.min(offset), high.max(offset))
    });
    (0.5 * (low + high), (0.5 * (high - low)).max(0.0))
}
