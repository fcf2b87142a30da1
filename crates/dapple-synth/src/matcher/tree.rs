//! k-d tree over the rows, with bounding boxes.
//!
//! Rows are split in two along the direction in which they spread most (Bentley, Multidimensional binary search trees
//! used for associative searching, Communications of the ACM 18, 1975), recursively until at most sixteen are left.
//! These form a leaf, and fill the lanes of a register. Sixteen consecutive leaves are a subtree, called a group;
//! sixteen consecutive groups are a subtree as well. The boxes of sixteen leaves or groups are tested at once.
//!
//! Coordinates are integers of a [`Lattice`]. The coordinates along two directions are interleaved, as required by the
//! instruction that multiplies and adds pairs.

use super::basis::{Basis, LANES};
use super::lattice::Lattice;
use super::margin;
use dapple_raster::parallel;
use dapple_raster::simd;
use dapple_raster::simd::dispatch;

/// Number of pairs of directions between two tests of a leaf's rows.
pub(crate) const STEP: usize = 4;

/// Number of directions along which rows are split and boxed: the first ones, in which rows differ most.
const BOX_DIRECTIONS: usize = 2 * STEP;

/// Coordinates of sixteen rows along two directions, interleaved: both of the first row, both of the second, and so on.
pub(crate) type Pairs = [i16; 2 * LANES];

/// Number of rows that a thread rotates at a time.
const CHUNK: usize = 512;

/// Bounding boxes of sixteen leaves or groups: minimum and maximum coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Boxes {
    pub(crate) low: [Pairs; STEP],
    pub(crate) high: [Pairs; STEP],
}

/// The rows, grouped into leaves, as coordinates along the directions of a basis.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    /// Row index in each lane of each leaf. Unused lanes of the last leaf repeat its last row.
    pub(crate) rows: Vec<[u32; LANES]>,
    /// Coordinates of all leaves along the first eight directions, then along the next eight, and so on. So each step
    /// reads contiguous memory.
    pub(crate) steps: Vec<Vec<[Pairs; STEP]>>,
    /// Bounding boxes of the leaves, in groups of sixteen.
    pub(crate) leaves: Vec<Boxes>,
    /// Bounding boxes of the groups, sixteen at a time.
    pub(crate) groups: Vec<Boxes>,
}

/// Quantized coordinates of the rows, in their original order.
pub(crate) struct Placed {
    n_directions: usize,
    coordinates: Vec<i16>,
    pub(crate) lattice: Lattice,
    /// Length of the longest centered row.
    pub(crate) longest: f64,
}

impl Placed {
    /// Rotates and quantizes rows of `dims` values. Returns `None` if a row is not finite or is longer than
    /// [`margin::LONGEST`].
    pub(crate) fn new(dims: usize, rows: &[f32], basis: &Basis) -> Option<Self> {
        // Rotate the rows into the basis.
        let n_directions = basis.n_directions();
        let chunks: Vec<&[f32]> = rows.chunks(CHUNK * dims).collect();
        let rotated = parallel::map(chunks.len(), |chunk| rotate(dims, chunks[chunk], basis));
        let longest = rotated.iter().fold(0.0, |max, part| part.longest.max(max));
        // False for NaN, which `f64::max` would discard.
        let all_short = rotated.iter().all(|part| part.length_sq < f64::INFINITY);
        if !all_short || longest > margin::LONGEST {
            return None;
        }
        // Quantize the coordinates.
        let length_sq: f64 = rotated.iter().map(|part| part.length_sq).sum();
        let spread = (length_sq / (rows.len() / dims) as f64).sqrt();
        let lattice = Lattice::new(longest, spread);
        let coordinates = parallel::map(rotated.len(), |part| {
            let values = rotated[part].values.as_flattened();
            let mut placed = vec![0; values.len()];
            for (row, placed) in values
                .chunks_exact(n_directions)
                .zip(placed.chunks_exact_mut(n_directions))
            {
                lattice.place(row, placed);
            }
            placed
        });
        Some(Self {
            n_directions,
            coordinates: coordinates.concat(),
            lattice,
            longest,
        })
    }

    #[inline(always)]
    fn row(&self, row: u32) -> &[i16] {
        &self.coordinates[row as usize * self.n_directions..][..self.n_directions]
    }
}

impl Tree {
    /// Builds the tree over the rows in `order`.
    pub(crate) fn new(placed: &Placed, mut order: Vec<u32>) -> Self {
        // Sort the rows into leaves, and repeat the last row in unused lanes.
        sort(&mut order, placed);
        let leaf = |leaf: &[u32]| std::array::from_fn(|lane| leaf[lane.min(leaf.len() - 1)]);
        let rows: Vec<[u32; LANES]> = order.chunks(LANES).map(leaf).collect();
        // Copy the coordinates, step by step.
        let steps = parallel::map(placed.n_directions / (2 * STEP), |step| {
            let coordinates = |leaf: &[u32; LANES]| {
                let lanes = leaf.map(|row| &placed.row(row)[2 * STEP * step..][..2 * STEP]);
                std::array::from_fn(|pair| pairs(&lanes, pair))
            };
            rows.iter().map(coordinates).collect()
        });
        // Compute the bounding boxes of the leaves and of the groups.
        let around = |leaf: &[u32; LANES]| around_rows(&leaf.map(|row| placed.row(row)));
        let boxes: Vec<Box> = rows.iter().map(around).collect();
        let boxes_16: Vec<Box> = boxes.chunks(LANES).map(around_boxes).collect();
        Self {
            rows,
            steps,
            leaves: boxes.chunks(LANES).map(side_by_side).collect(),
            groups: boxes_16.chunks(LANES).map(side_by_side).collect(),
        }
    }
}

/// Returns the indices of all rows.
pub(crate) fn every_row(dims: usize, rows: &[f32]) -> Vec<u32> {
    (0..rows.len().checked_div(dims).unwrap_or(0) as u32).collect()
}

/// Returns the indices of all rows except bitwise duplicates of an earlier row, in no particular order.
///
/// Of equal rows, only the first is ever returned. An image that is constant along one axis has many duplicates.
pub(crate) fn distinct_rows(dims: usize, rows: &[f32]) -> Vec<u32> {
    let mut order = every_row(dims, rows);
    let bits = |row: u32| {
        let row = &rows[row as usize * dims..][..dims];
        row.iter().map(|value| value.to_bits())
    };
    // Equal rows become adjacent, the lowest index first.
    order.sort_unstable_by(|&a, &b| bits(a).cmp(bits(b)).then(a.cmp(&b)));
    order.dedup_by(|later, first| bits(*later).eq(bits(*first)));
    order
}

/// Rotated rows of one chunk.
struct Rotated {
    values: Vec<[f32; LANES]>,
    longest: f64,
    /// Sum of the squared lengths of the centered rows.
    length_sq: f64,
}

fn rotate(dims: usize, rows: &[f32], basis: &Basis) -> Rotated {
    let level = simd::level();
    let n_groups = basis.n_directions() / LANES;
    let mut centered = Vec::with_capacity(dims);
    let mut part = Rotated {
        values: vec![[0.0; LANES]; rows.len() / dims * n_groups],
        longest: 0.0,
        length_sq: 0.0,
    };
    for (row, rotated) in rows
        .chunks_exact(dims)
        .zip(part.values.chunks_exact_mut(n_groups))
    {
        let length = dispatch!(level, simd => {
            basis.center(row, &mut centered);
            basis.rotate(simd, &centered, rotated);
            margin::length(&centered)
        });
        part.longest = part.longest.max(length);
        part.length_sq += length * length;
    }
    part
}

/// Splits rows recursively into leaves. All leaves except the last are full, and each aligned run of sixteen leaves is
/// a subtree.
fn sort(rows: &mut [u32], placed: &Placed) {
    let n_leaves = rows.len().div_ceil(LANES);
    if n_leaves < 2 {
        return;
    }
    // Find the direction of the largest spread.
    let mut low = [i16::MAX; BOX_DIRECTIONS];
    let mut high = [i16::MIN; BOX_DIRECTIONS];
    for &row in rows.iter() {
        for (i, &coordinate) in placed.row(row)[..BOX_DIRECTIONS].iter().enumerate() {
            low[i] = low[i].min(coordinate);
            high[i] = high[i].max(coordinate);
        }
    }
    let mut widest = 0;
    for i in 1..BOX_DIRECTIONS {
        if high[i] - low[i] > high[widest] - low[widest] {
            widest = i;
        }
    }
    let middle = n_leaves.next_power_of_two() / 2 * LANES;
    // Split so that the first part is a full subtree: its number of leaves is a power of two.
    rows.select_nth_unstable_by_key(middle, |&row| (placed.row(row)[widest], row));
    let (before, after) = rows.split_at_mut(middle);
    sort(before, placed);
    sort(after, placed);
}

/// Returns the coordinates of sixteen rows along two directions, interleaved.
fn pairs(lanes: &[&[i16]; LANES], pair: usize) -> Pairs {
    std::array::from_fn(|i| lanes[i / 2][2 * pair + i % 2])
}

/// Bounding box: the minimum and maximum coordinates.
type Box = [[i16; BOX_DIRECTIONS]; 2];

fn around_rows(lanes: &[&[i16]; LANES]) -> Box {
    let along = |i: usize| lanes.map(|row| row[i]);
    [
        std::array::from_fn(|i| least(along(i))),
        std::array::from_fn(|i| largest(along(i))),
    ]
}

fn around_boxes(boxes: &[Box]) -> Box {
    [
        std::array::from_fn(|i| least(boxes.iter().map(|b| b[0][i]))),
        std::array::from_fn(|i| largest(boxes.iter().map(|b| b[1][i]))),
    ]
}

/// Interleaves up to sixteen boxes so that they can be tested at once. Unused lanes repeat the last box.
fn side_by_side(boxes: &[Box]) -> Boxes {
    let side = |side: usize| {
        let lanes = |i: usize| &boxes[i.min(boxes.len() - 1)][side];
        std::array::from_fn(|pair| std::array::from_fn(|i| lanes(i / 2)[2 * pair + i % 2]))
    };
    Boxes {
        low: side(0),
        high: side(1),
    }
}

fn least(values: impl IntoIterator<Item = i16>) -> i16 {
    values.into_iter().fold(i16::MAX, i16::min)
}

fn largest(values: impl IntoIterator<Item = i16>) -> i16 {
    values.into_iter().fold(i16::MIN, i16::max)
}
