//! Generates the feature points of each cell from a hash of the cell, without any storage.
//!
//! The hash of a cell is two words. Each word is the exclusive or of one hash for each coordinate, so a search hashes
//! only a few rows and columns, and combines the results. The first word, after mixing, gives the number of points.
//! Both words, after adding a constant once per point and mixing, give a point's position. Interpreted as the state of
//! a [`CellHash`], the words give the id of point `i` at counter `2^31 + i`. With a period, a cell has the same words
//! as the cell that it repeats.

use crate::fixed::{MOST_AXES, STEP_BITS, STEPS};
use crate::places::LANES;
use crate::scatter::{DENSITIES, JITTER_PARTS, Scatter};
use crate::search::PointId;
use core::fmt;
use core::ops::{Add, BitAnd, BitOr, BitXor, Mul, Shl, Shr};
use dapple_hash::{
    LatticeHash, PoissonCounts, Seed, lattice_part_pairs, mix32, mix32_pairs, poisson_count,
};
use fearless_simd::{prelude::*, u32x16};
use std::sync::Arc;

/// Constants for a cell's two words, added `i + 1` times for point `i`. They are odd, so all sums differ.
pub(crate) const STRIDES: [u32; 2] = [0x9E37_79B9, 0xC2B2_AE3D];

/// Counter at which a cell's hash gives the id of its point 0.
pub(crate) const IDS: u32 = 1 << 31;

/// The feature points of all unit cells, generated from a seed.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Number of axes: 2, 3 or 4.
    pub(crate) n_axes: usize,
    /// For each of a cell's two words, the hash that computes it.
    pub(crate) hashes: [LatticeHash<MOST_AXES>; 2],
    /// For each of `hashes`, its key for the axis of each lane. Lanes 0 to 2 are for the first axis, lanes 3 to 5 for
    /// the second, and so on.
    pub(crate) lane_keys: [[u32; LANES]; 2],
    /// Distribution of the number of points per cell.
    pub(crate) counts: PoissonCounts,
    /// Spatially varying density; replaces `counts`. `None` if the density is constant.
    pub(crate) density: Option<Density>,
    /// Jitter, in units of 1/[`JITTER_PARTS`].
    pub(crate) jitter: u32,
    /// Period along each axis, in cells; 0 for an axis that does not repeat.
    pub(crate) period: [u32; MOST_AXES],
}

impl Lattice {
    pub(crate) fn new(n_axes: usize, seed: Seed, scatter: Scatter, counts: PoissonCounts) -> Self {
        let hashes = Self::hashes(seed);
        Self {
            n_axes,
            hashes,
            lane_keys: Self::lane_keys(&hashes),
            counts,
            density: None,
            jitter: scatter.jitter(),
            period: [0; MOST_AXES],
        }
    }

    /// Returns the two hashes that compute a cell's two words.
    fn hashes(seed: Seed) -> [LatticeHash<MOST_AXES>; 2] {
        [0, 1].map(|word| LatticeHash::new(seed.child("feature points", word)))
    }

    /// Returns this lattice with another seed.
    pub(crate) fn with_seed(&self, seed: Seed) -> Self {
        let hashes = Self::hashes(seed);
        Self {
            hashes,
            lane_keys: Self::lane_keys(&hashes),
            ..self.clone()
        }
    }

    fn lane_keys(hashes: &[LatticeHash<MOST_AXES>; 2]) -> [[u32; LANES]; 2] {
        hashes.map(|hash| core::array::from_fn(|lane| hash.key(lane / 3 % MOST_AXES)))
    }

    /// Hashes a cell's coordinate along an axis, after wrapping. The exclusive or of the results for all axes gives
    /// the cell's two words.
    #[inline(always)]
    pub(crate) fn parts(&self, axis: usize, cell: i64) -> [u32; 2] {
        let cell = self.wrap(axis, cell);
        // No `map` here: it would compile to a call.
        let [first, second] = &self.hashes;
        [first.part(axis, cell), second.part(axis, cell)]
    }

    /// Wraps a cell's coordinate along an axis by the period.
    #[inline]
    pub(crate) fn wrap(&self, axis: usize, cell: i64) -> i64 {
        match self.period[axis] {
            0 => cell,
            period => cell.rem_euclid(i64::from(period)),
        }
    }

    /// Returns the number of bits that hold the index of a point in its cell. Valid only for a constant density.
    #[inline]
    pub(crate) fn index_bits(&self) -> u32 {
        u32::BITS - self.counts.range().end().leading_zeros()
    }

    /// Returns wrapped coordinates along one axis: those of a cell, of its neighbor on the side `nearer` (-1 or 1), and
    /// of the neighbor on the other side.
    #[inline(always)]
    pub(crate) fn cells_around(&self, axis: usize, cell: i64, nearer: i64) -> [i64; 3] {
        let period = i64::from(self.period[axis]);
        if period == 0 {
            return [cell, cell + nearer, cell - nearer];
        }
        // The neighbors leave the period by at most one cell, so a comparison wraps them without another division.
        let own = cell.rem_euclid(period);
        let wrapped = |cell: i64| match cell {
            -1 => period - 1,
            cell if cell == period => 0,
            cell => cell,
        };
        [own, wrapped(own + nearer), wrapped(own - nearer)]
    }

    /// Returns whether all cells beyond `ring` rings repeat cells within these rings.
    pub(crate) fn repeats_within(&self, ring: i64) -> bool {
        let mut periods = self.period[..self.n_axes]
            .iter()
            .map(|&period| i64::from(period));
        // The rings up to `ring` span 2 · ring + 1 cells along each axis.
        periods.all(|period| period > 0 && period <= 2 * ring + 1)
    }

    /// Returns the two hash words of a cell.
    #[inline]
    pub(crate) fn words<const N: usize>(&self, cell: [i64; N]) -> [u32; 2] {
        (0..N).fold([0; 2], |words, axis| {
            both(words, self.parts(axis, cell[axis]))
        })
    }

    /// Returns the position of point `index` in its cell, in steps from the lower corner. `words` are the hash words
    /// of the cell.
    #[inline]
    pub(crate) fn steps<const N: usize>(&self, words: [u32; 2], index: u32) -> [i32; N] {
        // Each point adds a multiple of an odd stride, so the points of a cell get different words.
        let word = |which: usize| {
            let stride = STRIDES[which].wrapping_mul(index + 1);
            mix32(words[which].wrapping_add(stride))
        };
        steps([word(0), word(1)], self.jitter).map(u32::cast_signed)
    }

    /// Calls `each` with every point of a cell. The arguments are the point's steps from the cell's lower corner, and
    /// its identity.
    #[inline]
    pub(crate) fn visit<const N: usize>(
        &self,
        cell: [i64; N],
        each: impl FnMut([i32; N], PointId),
    ) {
        self.visit_words(cell, self.words(cell), each);
    }

    /// Calls `each` with every point of a cell, given the cell's hash words.
    #[inline(always)]
    pub(crate) fn visit_words<const N: usize>(
        &self,
        cell: [i64; N],
        words: [u32; 2],
        mut each: impl FnMut([i32; N], PointId),
    ) {
        for index in 0..self.count(&cell, words[0]) {
            each(self.steps(words, index), PointId { words, index });
        }
    }

    /// Returns the number of points in a cell; `word` is the first hash word of the cell.
    #[inline]
    pub(crate) fn count(&self, cell: &[i64], word: u32) -> u32 {
        match &self.density {
            // As in the paper, a random number selects the count from the cumulative Poisson probabilities.
            None => self.counts.count(mix32(word)),
            Some(density) => poisson_count(self.density_at(density, cell), mix32(word)),
        }
    }

    /// Returns the mean number of points per cell near `cell`.
    pub(crate) fn mean(&self, cell: &[i64]) -> f64 {
        match &self.density {
            None => self.counts.mean(),
            Some(density) => self.density_at(density, cell),
        }
    }

    /// Returns the density at the center of a cell, after wrapping, clamped to the allowed range.
    pub(crate) fn density_at(&self, density: &Density, cell: &[i64]) -> f64 {
        let mut middle = [0.5; MOST_AXES];
        for (axis, (middle, &cell)) in middle.iter_mut().zip(cell).enumerate() {
            *middle += self.wrap(axis, cell) as f64;
        }
        // One density holds for the whole cell, so its points do not depend on the position that is searched.
        let density = (density.of)(middle);
        if density.is_nan() {
            return *DENSITIES.start();
        }
        density.clamp(*DENSITIES.start(), *DENSITIES.end())
    }
}

/// A density of feature points that varies in space.
#[derive(Clone)]
pub(crate) struct Density {
    /// Function that returns the number of feature points per cell at a position. It ignores coordinates along missing
    /// axes.
    pub(crate) of: Arc<dyn Fn([f64; MOST_AXES]) -> f64 + Send + Sync>,
}

impl fmt::Debug for Density {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Density(..)")
    }
}

/// Combines the hash words of a cell with the hashed coordinate of one more axis.
#[inline(always)]
pub(crate) fn both<W: BitXor<Output = W> + Copy>(words: [W; 2], parts: [W; 2]) -> [W; 2] {
    [words[0] ^ parts[0], words[1] ^ parts[1]]
}

/// Hashes cell coordinates along an axis, one cell in each lane of `C` register pairs; see [`Lattice::parts`]. The
/// coordinates are given as low and high words, and must be wrapped.
#[inline(always)]
pub(crate) fn parts_each<S: Simd, const C: usize>(
    simd: S,
    lattice: &Lattice,
    axis: usize,
    cells: [[u32x16<S>; 2]; C],
) -> [[u32x16<S>; 2]; C] {
    let [first, second] = &lattice.hashes;
    lattice_part_pairs(simd, [first.key(axis), second.key(axis)], cells)
}

/// Hash words and point counts of sixteen cells, one in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SixteenCells<S: Simd> {
    /// The two hash words of each cell.
    pub(crate) words: [u32x16<S>; 2],
    /// Number of points of each cell, if the density is constant.
    pub(crate) counts: u32x16<S>,
}

impl<S: Simd> SixteenCells<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, lattice: &Lattice, words: [u32x16<S>; 2]) -> Self {
        let [cells] = Self::new_each(simd, lattice, [words]);
        cells
    }

    /// Builds `C` groups of sixteen cells at once, like [`new`](Self::new). Their operations are interleaved, which is
    /// faster.
    #[inline(always)]
    pub(crate) fn new_each<const C: usize>(
        simd: S,
        lattice: &Lattice,
        words: [[u32x16<S>; 2]; C],
    ) -> [Self; C] {
        let counts = u32x16::splat(simd, lattice.counts.least());
        let mut cells = [Self {
            words: words[0],
            counts,
        }; C];
        for i in 0..C {
            cells[i].words = words[i];
        }
        if lattice.counts.thresholds().is_empty() {
            return cells;
        }
        // Draw the number of points by counting the thresholds that the mixed first word reaches.
        let mut draws = words;
        for i in 0..C {
            draws[i][1] = draws[i][0];
        }
        let draws = mix32_pairs(draws);
        let one = u32x16::splat(simd, 1);
        for &threshold in lattice.counts.thresholds() {
            for i in 0..C {
                let is_more = draws[i][0].simd_ge(threshold);
                cells[i].counts = is_more.select(cells[i].counts + one, cells[i].counts);
            }
        }
        cells
    }

    /// Returns the maximum number of points in any of the cells.
    #[inline(always)]
    pub(crate) fn most(&self, lattice: &Lattice) -> u32 {
        if lattice.counts.thresholds().is_empty() {
            return lattice.counts.least();
        }
        self.counts.reduce_max()
    }

    /// Returns the position of one point of each cell, in steps from the cell's lower corner; zero along missing axes.
    #[inline(always)]
    pub(crate) fn flat_steps(&self, index: u32x16<S>, lattice: &Lattice) -> [u32x16<S>; MOST_AXES] {
        let words = self.words_of(index);
        let zero = u32x16::splat(index.simd, 0);
        match lattice.n_axes {
            2 => {
                let [x, y] = steps(words, lattice.jitter);
                [x, y, zero, zero]
            }
            3 => {
                let [x, y, z] = steps(words, lattice.jitter);
                [x, y, z, zero]
            }
            _ => steps(words, lattice.jitter),
        }
    }

    /// Returns 64 random bits, as two words, for point `index` of each cell.
    #[inline(always)]
    fn words_of(&self, index: u32x16<S>) -> [u32x16<S>; 2] {
        let mut words = self.words;
        for which in 0..2 {
            words[which] += (index + 1) * STRIDES[which];
        }
        let [words] = mix32_pairs([words]);
        words
    }

    /// Returns the position of one point of each cell, in steps from the cell's lower corner.
    #[inline(always)]
    pub(crate) fn steps<const N: usize>(&self, index: u32x16<S>, jitter: u32) -> [u32x16<S>; N] {
        steps(self.words_of(index), jitter)
    }

    /// Returns the positions of points in `C` groups of sixteen cells at once, like [`steps`](Self::steps). Operations
    /// are interleaved, which is faster.
    #[inline(always)]
    pub(crate) fn steps_each<const N: usize, const C: usize>(
        cells: [Self; C],
        index: [u32x16<S>; C],
        jitter: u32,
    ) -> [[u32x16<S>; N]; C] {
        let mut words = [cells[0].words; C];
        for i in 0..C {
            for which in 0..2 {
                words[i][which] = cells[i].words[which] + (index[i] + 1) * STRIDES[which];
            }
        }
        let words = mix32_pairs(words);
        let mut points = [[index[0]; N]; C];
        for i in 0..C {
            points[i] = steps(words[i], jitter);
        }
        points
    }
}

/// Operations on 32 random bits in one integer, or in each of sixteen lanes.
pub(crate) trait Word:
    Copy
    + Shr<u32, Output = Self>
    + Shl<u32, Output = Self>
    + BitAnd<u32, Output = Self>
    + BitOr<Output = Self>
    + Add<u32, Output = Self>
    + Mul<u32, Output = Self>
{
}

impl<W> Word for W where
    W: Copy
        + Shr<u32, Output = W>
        + Shl<u32, Output = W>
        + BitAnd<u32, Output = W>
        + BitOr<Output = W>
        + Add<u32, Output = W>
        + Mul<u32, Output = W>
{
}

/// Converts 64 random bits to steps from the cell's lower corner, along each axis.
///
/// With two and three axes every step is equally likely. With four axes, only every 32nd step occurs.
#[inline(always)]
pub(crate) fn steps<W: Word, const N: usize>([high, low]: [W; 2], jitter: u32) -> [W; N] {
    let mut steps = [high; N];
    for (axis, steps) in steps.iter_mut().enumerate() {
        // The first two axes take the upper 21 bits of a word each. The third one takes 11 and 10 of the bits below.
        // With four axes, each has 16 bits, centered in its interval of 32 steps.
        *steps = match (N, axis) {
            (2 | 3, 0) => high >> (32 - STEP_BITS),
            (2 | 3, 1) => low >> (32 - STEP_BITS),
            (3, _) => (high & 0x7FF) << 10 | (low & 0x3FF),
            (_, 0) => ((high >> 16) << 5) + 16,
            (_, 1) => ((high & 0xFFFF) << 5) + 16,
            (_, 2) => ((low >> 16) << 5) + 16,
            _ => ((low & 0xFFFF) << 5) + 16,
        };
        if jitter < JITTER_PARTS {
            // Weighted mean of the position and the center of the cell; the sum stays below 2^32.
            let middle = STEPS as u32 / 2 * (JITTER_PARTS - jitter);
            *steps = (*steps * jitter + middle) >> JITTER_PARTS.ilog2();
        }
    }
    steps
}
