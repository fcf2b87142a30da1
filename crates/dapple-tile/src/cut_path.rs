//! Finds the cheapest path from the top of a grid of costs to its bottom.
//!
//! A path visits one cell of every row, and moves at most one column from row to row. Its total cost is the sum of the
//! costs of its cells, in the order of the rows. The open path is found by dynamic programming, as in Alexei A. Efros
//! and William T. Freeman, "Image Quilting for Texture Synthesis and Transfer", SIGGRAPH 2001,
//! <https://doi.org/10.1145/383259.383296>.
//!
//! A closed path ends at most one column from where it began, so it continues where the grid repeats. The cheapest
//! closed path with a given first cell is found in the same way. The cheapest of all is found by bisection of the first
//! cells. Two paths that cross can exchange their ends without changing the total cost. So paths of neighboring first
//! cells need not cross, and the path of the middle cell bounds the search in both halves. This takes O(rows · width ·
//! log width) and is exact.

use crate::error::check;
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;

/// Returns the columns of the cheapest path, row by row. If several paths are equally cheap, returns the one with the
/// smaller columns, compared from the last row up.
///
/// Costs must be finite.
pub(crate) fn open_path(
    costs: &Raster<f64>,
    is_cancelled: &IsCancelled,
) -> Result<Vec<u32>, TileError> {
    let [left, right] = whole_band(costs);
    let mut search = Search::new(costs, is_cancelled);
    Ok(search.cheapest(&left, &right, None)?.columns)
}

/// Returns the columns of the cheapest closed path, row by row. If several paths are equally cheap, returns the one
/// with the smallest first column.
pub(crate) fn closed_path(
    costs: &Raster<f64>,
    is_cancelled: &IsCancelled,
) -> Result<Vec<u32>, TileError> {
    let [left, right] = whole_band(costs);
    let mut search = Search::new(costs, is_cancelled);
    // Start with the first column. Its path bounds the paths of all other columns on the left.
    let mut best = search.cheapest(&left, &right, Some(0))?;
    let left = best.columns.clone();
    // Search the other columns by bisection.
    search.halve([1, costs.width()], &left, &right, &mut best)?;
    Ok(best.columns)
}

/// Returns the columns of the cheapest path between the given columns of the first and the last row, row by row.
///
/// The difference of the two columns must be less than the number of rows.
pub(crate) fn path_between(
    costs: &Raster<f64>,
    [begin, end]: [u32; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<u32>, TileError> {
    let [left, right] = whole_band(costs);
    let mut search = Search::new(costs, is_cancelled);
    search.spread(&left, &right, [begin; 2])?;
    Ok(search.trace(left.len() - 1, [end; 2]).columns)
}

/// A path with its total cost.
struct Path {
    price: f64,
    columns: Vec<u32>,
}

impl Path {
    fn first(&self) -> Option<&u32> {
        self.columns.first()
    }
}

/// Returns the bounds of a band that covers the whole grid: the smallest and the largest column of each row.
fn whole_band(costs: &Raster<f64>) -> [Vec<u32>; 2] {
    [0, costs.width() - 1].map(|column| vec![column; costs.height() as usize])
}

/// A grid of costs, with scratch memory that is reused between searches.
struct Search<'a> {
    costs: &'a Raster<f64>,
    /// Total costs of the cheapest paths to the cells of the current row and of the row above, with [`PAD`] cells
    /// before the first column.
    prices: [Vec<f64>; 2],
    /// For each cell, the last step of the cheapest path to it: from the column before (0), the same column (1), or the
    /// column after (2).
    steps: Vec<u8>,
    is_cancelled: &'a IsCancelled<'a>,
    /// Number of cells computed since the last call of the callback.
    n_cells: u32,
}

/// Number of cells between two calls of the callback, at most one row more.
const CELLS: u32 = 1 << 20;

/// Number of cells of infinite cost on either side of a band. A step moves one column, and the band of the next row may
/// extend one column farther.
const PAD: usize = 2;

impl<'a> Search<'a> {
    fn new(costs: &'a Raster<f64>, is_cancelled: &'a IsCancelled<'a>) -> Self {
        let prices = vec![f64::INFINITY; costs.width() as usize + 2 * PAD];
        Self {
            costs,
            prices: [prices.clone(), prices],
            steps: vec![1; costs.pixels().len()],
            is_cancelled,
            // Call the callback before the first row.
            n_cells: CELLS,
        }
    }

    /// Searches closed paths that start in `first[0]..first[1]` and stay in the band, by bisection.
    fn halve(
        &mut self,
        first: [u32; 2],
        left: &[u32],
        right: &[u32],
        best: &mut Path,
    ) -> Result<(), TileError> {
        if first[0] >= first[1] {
            return Ok(());
        }
        // Find the cheapest path of the middle column.
        let middle = first[0] + (first[1] - first[0]) / 2;
        let path = self.cheapest(left, right, Some(middle))?;
        // Paths of columns on either side need not cross it, so it bounds both searches.
        self.halve([first[0], middle], left, &path.columns, best)?;
        self.halve([middle + 1, first[1]], &path.columns, right, best)?;
        // If costs are equal, prefer the smaller first column.
        if path.price < best.price || (path.price == best.price && path.first() < best.first()) {
            *best = path;
        }
        Ok(())
    }

    /// Finds the cheapest path between the bounds `left` and `right`, both inclusive. With `begin`, the path is closed
    /// and starts in that column.
    fn cheapest(
        &mut self,
        left: &[u32],
        right: &[u32],
        begin: Option<u32>,
    ) -> Result<Path, TileError> {
        let last = left.len() - 1;
        let begins = begin.map_or([left[0], right[0]], |column| [column; 2]);
        self.spread(left, right, begins)?;
        let [mut from, mut to] = [left[last], right[last]];
        // A closed path ends at most one column from where it began.
        if let Some(column) = begin {
            from = from.max(column.saturating_sub(1));
            to = to.min(column + 1);
        }
        Ok(self.trace(last, [from, to]))
    }

    /// Computes the total costs of all cells of the band, for paths that start in a cell of `begins[0]..=begins[1]`.
    fn spread(&mut self, left: &[u32], right: &[u32], begins: [u32; 2]) -> Result<(), TileError> {
        self.begin([left[0], right[0]], begins);
        for row in 1..left.len() {
            if self.n_cells >= CELLS {
                check(self.is_cancelled)?;
                self.n_cells = 0;
            }
            self.advance(row, [left[row], right[row]]);
            self.n_cells += right[row] - left[row] + 1;
        }
        Ok(())
    }

    /// Computes the total costs of the first row, for paths that start in a cell of `from..=to`.
    fn begin(&mut self, band: [u32; 2], [from, to]: [u32; 2]) {
        let [low, high] = band.map(|column| column as usize + PAD);
        let prices = &mut self.prices[0];
        // Only the cells in `from..=to` can be reached.
        prices[low - PAD..=high + PAD].fill(f64::INFINITY);
        for column in from..=to {
            prices[column as usize + PAD] = self.costs.row(0)[column as usize];
        }
    }

    /// Computes the total costs of the next row, whose band starts and ends at most one column from the previous band.
    fn advance(&mut self, row: usize, band: [u32; 2]) {
        let [low, high] = band.map(|column| column as usize);
        let width = self.costs.width() as usize;
        let costs = &self.costs.pixels()[row * width..][..width];
        let steps = &mut self.steps[row * width..][..width];
        let [above, prices] = &mut self.prices;
        // Pad the band with infinite costs, since the next row reads up to two cells beyond it.
        prices[low..low + PAD].fill(f64::INFINITY);
        prices[high + PAD + 1..=high + 2 * PAD].fill(f64::INFINITY);
        for column in low..=high {
            // Take the cheapest of the three cells above; the first one if several are equal.
            let mut best = above[column + PAD - 1];
            let mut step = 0;
            if above[column + PAD] < best {
                (best, step) = (above[column + PAD], 1);
            }
            if above[column + PAD + 1] < best {
                (best, step) = (above[column + PAD + 1], 2);
            }
            prices[column + PAD] = best + costs[column];
            steps[column] = step;
        }
        self.prices.swap(0, 1);
    }

    /// Traces the path to the cheapest cell of `from..=to` in the last row.
    fn trace(&self, last: usize, [from, to]: [u32; 2]) -> Path {
        let price = |column: u32| self.prices[0][column as usize + PAD];
        let cheaper = |best, column| {
            if price(column) < price(best) {
                column
            } else {
                best
            }
        };
        // Find the cheapest end; the first one if several are equal.
        let end = (from + 1..=to).fold(from, cheaper);
        let width = self.costs.width() as usize;
        // Follow the steps from the last row to the first.
        let mut columns = vec![end; last + 1];
        for row in (1..=last).rev() {
            let step = self.steps[row * width + columns[row] as usize];
            columns[row - 1] = (columns[row] + u32::from(step)).saturating_sub(1);
        }
        Path {
            price: price(end),
            columns,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{closed_path, open_path, path_between};
    use dapple_hash::{Seed, hash2};
    use dapple_raster::Raster;

    /// Returns costs that are small integers, so that sums are exact in any order and ties are frequent.
    fn costs(seed: u64, size: [u32; 2]) -> Raster<f64> {
        let cost = |x: u32, y: u32| hash2(Seed(seed), [x.into(), y.into()], 0) % 7;
        Raster::from_fn(size, |x, y| cost(x, y) as f64).unwrap()
    }

    fn price(costs: &Raster<f64>, path: &[u32]) -> f64 {
        assert_eq!(path.len(), costs.height() as usize, "one cell per row");
        let cells = (0..).zip(path);
        cells
            .map(|(row, &column)| costs.row(row)[column as usize])
            .sum()
    }

    /// Returns the total cost of the cheapest path from any cell of `begin` to any column that `ends` accepts, cell by
    /// cell, without a band.
    fn brute_force(costs: &Raster<f64>, begin: &[u32], ends: impl Fn(u32) -> bool) -> f64 {
        let at = |column: u32, row| costs.row(row)[column as usize];
        let mut prices: Vec<_> = (0..costs.width())
            .map(|x| {
                if begin.contains(&x) {
                    at(x, 0)
                } else {
                    f64::INFINITY
                }
            })
            .collect();
        for row in 1..costs.height() {
            prices = (0..costs.width())
                .map(|x| {
                    let near = prices
                        .iter()
                        .zip(0..)
                        .filter(|(_, from)| x.abs_diff(*from) <= 1);
                    near.fold(f64::INFINITY, |best, (price, _)| best.min(*price)) + at(x, row)
                })
                .collect();
        }
        let ends = prices.iter().zip(0..).filter(|(_, column)| ends(*column));
        ends.fold(f64::INFINITY, |best, (price, _)| best.min(*price))
    }

    fn steps_are_short(path: &[u32]) -> bool {
        path.windows(2).all(|pair| pair[0].abs_diff(pair[1]) <= 1)
    }

    #[test]
    fn open_path_is_as_cheap_as_the_best_of_all() {
        for seed in 0..40 {
            for size in [[1, 1], [1, 9], [7, 1], [2, 5], [9, 13]] {
                let costs = costs(seed, size);
                let path = open_path(&costs, &|| false).unwrap();
                let all: Vec<_> = (0..size[0]).collect();
                assert!(steps_are_short(&path), "{path:?}");
                assert_eq!(price(&costs, &path), brute_force(&costs, &all, |_| true));
            }
        }
    }

    #[test]
    fn closed_path_is_as_cheap_as_the_best_of_all_first_cells() {
        for seed in 0..60 {
            for size in [[1, 1], [1, 9], [7, 1], [2, 2], [5, 30], [16, 11], [13, 40]] {
                let costs = costs(seed, size);
                let path = closed_path(&costs, &|| false).unwrap();
                let ends = path[0].abs_diff(path[path.len() - 1]);
                assert!(steps_are_short(&path) && ends <= 1, "{path:?}");
                let best = (0..size[0])
                    .map(|first| brute_force(&costs, &[first], |end| end.abs_diff(first) <= 1))
                    .fold(f64::INFINITY, f64::min);
                assert_eq!(price(&costs, &path), best, "seed {seed}, {size:?}");
            }
        }
    }

    #[test]
    fn path_between_is_as_cheap_as_the_best_of_all_with_its_ends() {
        for seed in 0..40 {
            for size in [[1, 1], [1, 9], [4, 4], [9, 13], [13, 40]] {
                let costs = costs(seed, size);
                for ends in [[0, size[0] - 1], [size[0] - 1, 0], [size[0] / 2; 2]] {
                    let path = path_between(&costs, ends, &|| false).unwrap();
                    assert!(steps_are_short(&path), "{path:?}");
                    assert_eq!([path[0], path[path.len() - 1]], ends);
                    let best = brute_force(&costs, &ends[..1], |end| end == ends[1]);
                    assert_eq!(
                        price(&costs, &path),
                        best,
                        "seed {seed}, {size:?}, {ends:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn paths_of_equal_costs_keep_to_the_smallest_column() {
        let flat = Raster::filled([6, 20], 1.0).unwrap();
        assert_eq!(open_path(&flat, &|| false).unwrap(), [0; 20]);
        assert_eq!(closed_path(&flat, &|| false).unwrap(), [0; 20]);
    }

    #[test]
    fn value_stability_paths() {
        let costs = costs(3, [8, 12]);
        let [open, closed] = [open_path, closed_path].map(|path| path(&costs, &|| false).unwrap());
        assert_eq!(open, [2, 1, 2, 3, 2, 3, 2, 1, 1, 1, 1, 0]);
        assert_eq!(closed, [3, 4, 5, 5, 5, 6, 6, 5, 4, 3, 4, 4]);
    }
}
