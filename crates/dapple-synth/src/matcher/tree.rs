//! Rows in the order of a k-d tree, with boxes around them.
//!
//! Rows are halved along the direction in which they spread most (Bentley, Multidimensional binary search trees used for
//! associative searching, Communications of the ACM 18, 1975) until sixteen are left: a leaf, whose rows fill the lanes of a
//! register. Sixteen leaves after one another are a subtree, and so are sixteen of those; the boxes of sixteen are tested
//! at once.

use super::basis::{Basis, LANES};
use super::margin;
use super::parallel::par_map;
use dapple_raster::simd;
use fearless_simd::dispatch;

/// Directions along which rows are halved and have boxes: those in which they differ most.
pub(crate) const BOX_DIRECTIONS: usize = 8;

/// The least unit of coordinates: 2^-100.
const LEAST_UNIT: f32 = f32::from_bits((127 - 100) << 23);

/// The largest coordinate in units.
const LARGEST_COORDINATE: f32 = 32767.0;

/// Rows that are rotated by one thread at a time.
const CHUNK: usize = 1024;

/// Boxes of sixteen things, for each direction the least or the largest coordinate.
#[derive(Clone, Debug)]
pub(crate) struct Boxes {
    pub(crate) low: [[f32; LANES]; BOX_DIRECTIONS],
    pub(crate) high: [[f32; LANES]; BOX_DIRECTIONS],
}

/// The rows along the directions of a basis, in leaves.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) basis: Basis,
    /// The length of the longest centered row.
    pub(crate) longest: f64,
    /// The row in each lane of each leaf. The lanes that are left over in the last leaf repeat its last row.
    pub(crate) rows: Vec<[u32; LANES]>,
    /// The length of which coordinates are whole multiples: a power of two.
    pub(crate) unit: f32,
    /// For each leaf its coordinates along the first [`BOX_DIRECTIONS`] directions, in units.
    pub(crate) heads: Vec<[[i16; LANES]; BOX_DIRECTIONS]>,
    /// For each leaf its coordinates along all other directions, in units.
    pub(crate) tails: Vec<[i16; LANES]>,
    /// Boxes around the rows of sixteen leaves each.
    pub(crate) leaves: Vec<Boxes>,
    /// Boxes around the leaves of sixteen of those each.
    pub(crate) groups: Vec<Boxes>,
}

impl Tree {
    /// Sorts rows of `dims` numbers. Nothing if they are not finite or too long.
    pub(crate) fn new(dims: usize, all: &[f32]) -> Option<Self> {
        let basis = Basis::new(dims, all);
        let (rotated, longest) = rotate(dims, all, &basis);
        if longest.is_nan() || longest > margin::LONGEST {
            return None;
        }
        let mut indices: Vec<u32> = (0..(all.len() / dims) as u32).collect();
        let n_directions = basis.n_directions();
        let unit = unit(&rotated);
        sort(&mut indices, &rotated, n_directions);
        let mut tree = Self {
            basis,
            longest,
            unit,
            rows: Vec::new(),
            heads: Vec::new(),
            tails: Vec::new(),
            leaves: Vec::new(),
            groups: Vec::new(),
        };
        for leaf in indices.chunks(LANES) {
            let rows = std::array::from_fn(|lane| leaf[lane.min(leaf.len() - 1)]);
            let coordinates = |direction: usize| {
                rows.map(|row| in_units(rotated[row as usize * n_directions + direction], unit))
            };
            tree.rows.push(rows);
            tree.heads.push(std::array::from_fn(coordinates));
            tree.tails.extend((BOX_DIRECTIONS..n_directions).map(coordinates));
        }
        let boxes: Vec<_> = tree.heads.iter().map(around_rows).collect();
        tree.leaves = boxes.chunks(LANES).map(side_by_side).collect();
        let boxes: Vec<_> = tree.leaves.iter().map(around_boxes).collect();
        tree.groups = boxes.chunks(LANES).map(side_by_side).collect();
        Some(tree)
    }
}

/// The coordinates of all rows, and the length of the longest one centered.
fn rotate(dims: usize, all: &[f32], basis: &Basis) -> (Vec<f32>, f64) {
    let level = simd::level();
    let n_groups = basis.n_directions() / LANES;
    let chunks: Vec<&[f32]> = all.chunks(CHUNK * dims).collect();
    let rotated = par_map(chunks.len(), |chunk| {
        let mut centered = Vec::with_capacity(dims);
        let mut rotated = vec![[0.0; LANES]; chunks[chunk].len() / dims * n_groups];
        let mut longest = 0.0_f64;
        for (row, rotated) in chunks[chunk]
            .chunks_exact(dims)
            .zip(rotated.chunks_exact_mut(n_groups))
        {
            dispatch!(level, simd => {
                basis.center(row, &mut centered);
                basis.rotate(simd, &centered, rotated);
            });
            longest = longest.max(margin::length(&centered));
        }
        (rotated, longest)
    });
    let longest = rotated.iter().fold(0.0_f64, |max, (_, length)| max.max(*length));
    let rotated: Vec<f32> = rotated.iter().flat_map(|(rotated, _)| rotated.as_flattened()).copied().collect();
    (rotated, longest)
}

/// The least power of two, in a range that does not overflow, in which all coordinates fit 16 bits.
fn unit(rotated: &[f32]) -> f32 {
    let largest = rotated.iter().fold(0.0_f32, |max, value| max.max(value.abs()));
    let mut unit = LEAST_UNIT;
    while largest > unit * LARGEST_COORDINATE {
        unit *= 2.0;
    }
    unit
}

/// The nearest multiple of a unit.
fn in_units(value: f32, unit: f32) -> i16 {
    (value / unit).round_ties_even() as i16
}

/// Halves rows, and the halves again, down to leaves. All leaves but the last one are full, and sixteen of them that are
/// tested at once are a subtree.
fn sort(indices: &mut [u32], rotated: &[f32], n_directions: usize) {
    let n_leaves = indices.len().div_ceil(LANES);
    if n_leaves < 2 {
        return;
    }
    let (mut low, mut high) = ([f32::INFINITY; BOX_DIRECTIONS], [f32::NEG_INFINITY; BOX_DIRECTIONS]);
    for &row in indices.iter() {
        let coordinates = &rotated[row as usize * n_directions..][..BOX_DIRECTIONS];
        for (i, &value) in coordinates.iter().enumerate() {
            low[i] = low[i].min(value);
            high[i] = high[i].max(value);
        }
    }
    let mut widest = 0;
    for i in 1..BOX_DIRECTIONS {
        if high[i] - low[i] > high[widest] - low[widest] {
            widest = i;
        }
    }
    let key = |&row: &u32| rotated[row as usize * n_directions + widest];
    let middle = n_leaves.next_power_of_two() / 2 * LANES;
    indices.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
    let (before, after) = indices.split_at_mut(middle);
    sort(before, rotated, n_directions);
    sort(after, rotated, n_directions);
}

/// A box: the least and the largest coordinate for each direction.
type Box = [[f32; BOX_DIRECTIONS]; 2];

/// The box around nothing, which is infinitely far from everything.
const NOTHING: Box = [
    [f32::INFINITY; BOX_DIRECTIONS],
    [f32::NEG_INFINITY; BOX_DIRECTIONS],
];

fn around_rows(head: &[[i16; LANES]; BOX_DIRECTIONS]) -> Box {
    let head = head.map(|values| values.map(f32::from));
    [head.map(least), head.map(largest)]
}

fn around_boxes(boxes: &Boxes) -> Box {
    [boxes.low.map(least), boxes.high.map(largest)]
}

/// Up to sixteen boxes side by side. Lanes that are left over hold nothing.
fn side_by_side(boxes: &[Box]) -> Boxes {
    let side = |side: usize| {
        std::array::from_fn(|direction| {
            std::array::from_fn(|lane| boxes.get(lane).unwrap_or(&NOTHING)[side][direction])
        })
    };
    Boxes { low: side(0), high: side(1) }
}

fn least(values: [f32; LANES]) -> f32 {
    values.into_iter().fold(f32::INFINITY, f32::min)
}

fn largest(values: [f32; LANES]) -> f32 {
    values.into_iter().fold(f32::NEG_INFINITY, f32::max)
}
