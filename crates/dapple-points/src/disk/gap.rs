//! The exact search of a cell for places that no disc covers.
//!
//! The set subcells of a cell are squares of places. A square that lies wholly in one disc is dropped; of the others a
//! few random places are tried, then each square is cut in four, and so on down to single places. Whatever the
//! search returns is uniformly random among the free places of the cell, and if it returns none there is none.
//!
//! Nothing rounds here: the corners of squares are places, and [`Grid::distance_sq`] keeps their order, so a square
//! whose farthest corner is covered is covered at every place.

use super::grid::{Grid, LATTICE, STEP};
use super::mask::{SIDE, select};
use dapple_hash::CellHash;

/// Random places tried for each size of squares.
const TRIES: u32 = 2;

/// A square of places: its first corner in steps of the lattice.
type Corner = [u32; 2];

/// The search, with memory that is used again for the next cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct GapSearch {
    /// The discs that reach into the cell, by their centers relative to it.
    discs: Vec<[f32; 2]>,
    squares: Vec<Corner>,
    halves: Vec<Corner>,
}

impl GapSearch {
    /// A random free place of a cell whose mask is `mask`, or none if all of its places are covered.
    ///
    /// `points` are the places of points around the cell, relative to it. The bits of subcells that turn out to be
    /// covered by one disc are cleared.
    pub(crate) fn find(
        &mut self,
        grid: &Grid,
        mask: &mut u64,
        points: impl Iterator<Item = [f32; 2]>,
        hash: CellHash,
    ) -> Option<[f32; 2]> {
        self.discs.clear();
        self.discs.extend(points.filter(|&disc| {
            let whole = span([0, 0], LATTICE);
            near_sq(grid, &whole, disc) < 1.0
        }));
        let mut size = LATTICE / SIDE as u32;
        self.start(grid, mask, size);
        let mut draws = 0;
        while !self.squares.is_empty() {
            for _ in 0..TRIES {
                let place = self.random_place(size, hash.at(draws));
                draws += 1;
                if self.is_free(grid, place) {
                    return Some(place);
                }
            }
            size /= 2;
            self.cut(grid, size);
        }
        None
    }

    /// Takes the set subcells that no disc covers alone as the first squares.
    fn start(&mut self, grid: &Grid, mask: &mut u64, size: u32) {
        self.squares.clear();
        for rank in 0..mask.count_ones() {
            let bit = select(*mask, rank);
            let square = [bit % SIDE as u32 * size, bit / SIDE as u32 * size];
            if !self.is_covered(grid, square, size) {
                self.squares.push(square);
            }
        }
        *mask = self.squares.iter().fold(0, |bits, &[x, y]| {
            bits | 1 << (y / size * SIDE as u32 + x / size)
        });
    }

    /// Cuts every square in four of side `size` and keeps those that no disc covers alone.
    fn cut(&mut self, grid: &Grid, size: u32) {
        let mut halves = core::mem::take(&mut self.halves);
        halves.clear();
        for &[x, y] in &self.squares {
            for square in [[x, y], [x + size, y], [x, y + size], [x + size, y + size]] {
                if !self.is_covered(grid, square, size) {
                    halves.push(square);
                }
            }
        }
        self.halves = core::mem::replace(&mut self.squares, halves);
    }

    fn is_covered(&self, grid: &Grid, square: Corner, size: u32) -> bool {
        let square = span(square, size);
        self.discs
            .iter()
            .any(|&disc| far_sq(grid, &square, disc) < 1.0)
    }

    fn is_free(&self, grid: &Grid, [x, y]: [f32; 2]) -> bool {
        self.discs
            .iter()
            .all(|disc| grid.distance_sq(x - disc[0], y - disc[1]) >= 1.0)
    }

    /// A place of the squares, each as likely as the others.
    fn random_place(&self, size: u32, bits: u64) -> [f32; 2] {
        let rank = (bits >> 40) * self.squares.len() as u64 >> 24;
        let [x, y] = self.squares[rank as usize];
        let within = |bits: u64| bits as u32 & (size - 1);
        [x + within(bits), y + within(bits >> 20)].map(|steps| steps as f32 * STEP)
    }
}

/// First and last place of a square, along each axis.
fn span(square: Corner, size: u32) -> [[f32; 2]; 2] {
    square.map(|first| [first as f32 * STEP, (first + size - 1) as f32 * STEP])
}

/// The square of the distance from a disc's center to the farthest place of a square.
fn far_sq(grid: &Grid, [x, y]: &[[f32; 2]; 2], disc: [f32; 2]) -> f32 {
    let far = |[first, last]: [f32; 2], at: f32| (at - first).max(last - at);
    grid.distance_sq(far(*x, disc[0]), far(*y, disc[1]))
}

/// The square of the distance from a disc's center to the nearest place of a square.
fn near_sq(grid: &Grid, [x, y]: &[[f32; 2]; 2], disc: [f32; 2]) -> f32 {
    let near = |[first, last]: [f32; 2], at: f32| (first - at).max(at - last).max(0.0);
    grid.distance_sq(near(*x, disc[0]), near(*y, disc[1]))
}
