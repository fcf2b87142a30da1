//! Searches many scattered positions, sixteen at a time, one in each lane.
//!
//! Every lane visits the cell of its position and the neighboring cells. The nearer neighbors are needed by most
//! lanes, so all lanes visit them together. The farther neighbors are needed by few lanes. These visits are collected
//! in a list for a whole group of positions, and then processed with all lanes in use.
//!
//! A search compares points by key, a stand-in for the distance (see [`metric`](crate::metric)). The low bits of a key
//! are replaced by a code that identifies the point, so that one minimum and one maximum sort keys and codes at once.
//! If the other bits of two keys are equal, the order of their points is unknown. Positions with such points, and
//! positions that need cells beyond the neighbors, are searched again individually.

use crate::fixed::{MOST_AXES, STEP, STEPS};
use crate::lattice::{IDS, Lattice, SixteenCells, both, parts_each};
use crate::levels::wide;
use crate::metric::{Exact, Measure as _};
use crate::places::{LANES, Places, Words, cells_by_distance, digit, load, store};
use crate::{MAX_NEAREST, Metric, Worley};
use dapple_hash::CellHashes;
use fearless_simd::{Level, f32x16, i32x16, mask32x16, prelude::*, u32x16, u64x8};

/// Number of positions in a group.
pub(crate) const GROUP: usize = 4 * LANES;

/// Key of a missing point: the largest finite number. (Infinity with a code in its low bits would be NaN.)
pub(crate) const NOTHING: u32 = f32::MAX.to_bits();

/// A search's parameters, and the layout of a key's low bits.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) exact: Exact,
    /// Number of bits that hold a point's index in its cell. Above them, the code has two bits per axis for the
    /// neighbor.
    pub(crate) index_bits: u32,
    /// Mask of the code's bits in a key.
    pub(crate) code_mask: u32,
}

/// A group of positions, with the scratch memory for searching their nearest points.
#[derive(Debug)]
pub struct Group<const N: usize> {
    /// Number of nearest points to find: 1, 2 or 4.
    depth: usize,
    /// Number of unused ranks at the beginning of `best`, which stay zero.
    unused: usize,
    /// Positions in cells, axis by axis. Only the first `len` are in use.
    pub(crate) positions: [[f64; GROUP]; N],
    pub(crate) len: usize,
    /// Bit mask of the positions that are in range (finite and below 2^62).
    has_place: u64,
    /// Cells of the positions: low and high words of the coordinates along each axis.
    cells: [[[u32; GROUP]; 2]; N],
    /// Steps of the positions within their cells.
    steps: [[i32; GROUP]; N],
    /// Own cells and nearer neighbors of the sixteen positions that are being searched.
    near: [Near; MOST_NEAR],
    /// List of farther neighbors that remain to be visited.
    visits: Visits,
    /// Smallest keys of each position so far, in ascending order.
    best: [[u32; GROUP]; MAX_NEAREST],
    /// For each position, the smallest key of all points that are not among the nearest.
    next: [u32; GROUP],
    /// Nearest points found by the last search, by rank.
    points: [Points<N>; MAX_NEAREST],
}

/// One neighbor (or the own cell) of each of sixteen positions: hash words and point counts.
#[derive(Clone, Copy, Debug)]
struct Near {
    words: [[u32; LANES]; 2],
    counts: [u32; LANES],
    /// Maximum number of points in any of the cells.
    most: u32,
}

/// Number of cells to visit at once in four dimensions: the own cell and the nearer neighbors.
const MOST_NEAR: usize = 1 << 4;

/// The farther neighbors that are still to be visited.
#[derive(Debug)]
struct Visits {
    /// The visits. The low bits hold a neighbor's code; the bits starting at [`PLACE_SHIFT`] hold a position's index in
    /// the group.
    list: [u32; FULL + (MOST_FAR + 1) * LANES],
    len: usize,
}

/// Lowest bit of the index in the group, in [`Visits::list`].
const PLACE_SHIFT: u32 = 8;

/// Length above which the list is processed early; groups in 2-D and 3-D hardly ever exceed it.
const FULL: usize = 512;

/// Number of farther neighbors in four dimensions.
const MOST_FAR: usize = 81 - MOST_NEAR;

/// The points of one rank for all positions of a group.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<const N: usize> {
    /// Distance from each position to its point, in cells.
    pub(crate) distances: [f32; GROUP],
    /// Vector from the point to each position, in cells, axis by axis.
    pub(crate) vectors: [[f64; GROUP]; N],
    pub(crate) ids: [u64; GROUP],
}

impl<'a> Search<'a> {
    #[inline(always)]
    pub(crate) fn new(n_axes: usize, lattice: &'a Lattice, metric: Metric) -> Self {
        let index_bits = lattice.index_bits();
        Self {
            lattice,
            exact: Exact(metric),
            index_bits,
            code_mask: (1 << (2 * n_axes as u32 + index_bits)) - 1,
        }
    }
}

impl<const N: usize> Group<N> {
    pub(crate) const fn new(depth: usize) -> Self {
        Self {
            depth,
            unused: 0,
            positions: [[0.0; GROUP]; N],
            len: 0,
            has_place: 0,
            cells: [[[0; GROUP]; 2]; N],
            steps: [[0; GROUP]; N],
            near: [Near {
                words: [[0; LANES]; 2],
                counts: [0; LANES],
                most: 0,
            }; MOST_NEAR],
            visits: Visits {
                list: [0; FULL + (MOST_FAR + 1) * LANES],
                len: 0,
            },
            best: [[NOTHING; GROUP]; MAX_NEAREST],
            next: [NOTHING; GROUP],
            points: [Points {
                distances: [0.0; GROUP],
                vectors: [[0.0; GROUP]; N],
                ids: [0; GROUP],
            }; MAX_NEAREST],
        }
    }

    /// Returns the points that the last search found, one element per rank, nearest first.
    pub(crate) fn points(&self) -> &[Points<N>] {
        &self.points[..self.depth]
    }

    /// Finds the nearest points of the positions. Returns a bit mask of the positions for which the result is known to
    /// be exact.
    pub(crate) fn search(&mut self, worley: &Worley<N>, level: Level) -> u64 {
        // Powers are so slow that SIMD gains nothing, and the counts of a varying density are drawn one by one.
        let is_scalar = worley.metric.is_slow();
        if is_scalar || worley.lattice.density.is_some() {
            return 0;
        }
        let search = Search::new(N, &worley.lattice, worley.metric);
        let holds = self.search_by_depth(search, level);
        wide!(level, simd => self.finish_with(simd, search));
        holds.unwrap_or(0)
    }

    /// Finds the keys of the nearest points. Selects the loop that is compiled for the requested number of points.
    fn search_by_depth(&mut self, search: Search<'_>, level: Level) -> Option<u64> {
        // Four-dimensional positions are rare, and share one loop.
        if const { N < MOST_AXES } && self.depth == 1 {
            return wide!(level, simd => self.search_with::<_, 1>(simd, search));
        }
        if const { N < MOST_AXES } && self.depth == 2 {
            return wide!(level, simd => self.search_with::<_, 2>(simd, search));
        }
        wide!(level, simd => self.search_with::<_, MAX_NEAREST>(simd, search))
    }

    #[inline(always)]
    fn search_with<S: Simd, const K: usize>(&mut self, simd: S, search: Search<'_>) -> u64 {
        // If sixteen lanes take several hardware registers, their operations are already interleaved.
        if const { <S::u32s as SimdBase<S>>::LEN < LANES } {
            return self.search_in_step::<S, K, 1>(simd, search);
        }
        self.search_in_step::<S, K, 4>(simd, search)
    }

    /// Computes the ids, distances and vectors of the nearest points from the codes in their keys.
    #[inline(always)]
    fn finish_with<S: Simd>(&mut self, simd: S, search: Search<'_>) {
        // The arrays also have registers beyond the last position, whose contents are ignored.
        let registers = 0..self.len.div_ceil(LANES) * self.depth;
        if const { <S::u32s as SimdBase<S>>::LEN < LANES } {
            for first in registers {
                self.finish::<S, 1>(simd, search, first);
            }
        } else {
            for first in registers.step_by(4) {
                self.finish::<S, 4>(simd, search, first);
            }
        }
    }

    /// Finds the nearest points of all positions, sixteen at a time. Hashes for `C` registers are computed together.
    #[inline(always)]
    fn search_in_step<S: Simd, const K: usize, const C: usize>(
        &mut self,
        simd: S,
        search: Search<'_>,
    ) -> u64 {
        let n_registers = self.len.div_ceil(LANES);
        self.unused = K - self.depth;
        self.has_place = 0;
        // Visit the nearer neighbors of each register; process the list when it is full, and at the end.
        for register in 0..n_registers {
            self.visit_near::<S, K, C>(simd, search, register);
            if register + 1 == n_registers || self.visits.len > FULL {
                while self.visits.len > 0 {
                    self.visit_far::<S, K>(simd, search);
                }
            }
        }
        // Find the positions whose points are certain.
        let mut holds = 0;
        for register in 0..n_registers {
            holds |= self.holds::<S, K>(simd, search, register) << (register * LANES);
        }
        holds & self.has_place
    }

    /// Visits the own cells and nearer neighbors of sixteen positions, and appends their farther neighbors to the
    /// list.
    #[inline(always)]
    fn visit_near<S: Simd, const K: usize, const C: usize>(
        &mut self,
        simd: S,
        search: Search<'_>,
        register: usize,
    ) {
        // Split the positions, and hash the own cells and nearer neighbors.
        let (places, has_place) = Places::new(simd, &self.positions, register);
        self.has_place |= has_place << (register * LANES);
        places.store(&mut self.cells, &mut self.steps, register);
        self.hash_near::<S, C>(simd, search.lattice, &places);
        let gaps = gaps(simd, search.exact, &places);
        let numbers = u32x16::from_slice(simd, &ASCENDING) + (register * LANES) as u32;
        let mut found = Found::<S, K>::new(simd, self.unused);
        for &neighbor in cells_by_distance::<N>() {
            // Skip neighbors that are farther than the nearest points so far.
            let neighbor = u32::from(neighbor);
            let mut gap = gaps[N - 1][digit(neighbor, N - 1)];
            for axis in (0..N - 1).rev() {
                gap = search
                    .exact
                    .accumulate(gaps[axis][digit(neighbor, axis)], gap);
            }
            // Setting all bits of the code rounds the key up, so no neighbor with a nearer point is skipped.
            let reach = (found.best[K - 1] | search.code_mask).bitcast::<f32x16<S>>();
            let matters = gap.simd_le(reach);
            if neighbor & FARTHER != 0 {
                // Few lanes need a farther neighbor. Collect the visits until they fill registers.
                self.visits.push(numbers << PLACE_SHIFT | neighbor, matters);
                continue;
            }
            if matters.all_false() {
                continue;
            }
            // Compare the points of the neighbor.
            let mut origins = places.steps;
            for axis in 0..N {
                if digit(neighbor, axis) > 0 {
                    origins[axis] -= places.nearer(simd, axis) * i32x16::splat(simd, STEPS);
                }
            }
            let near = &self.near[near_index::<N>(neighbor)];
            let points = SixteenCells {
                words: [load(simd, &near.words[0], 0), load(simd, &near.words[1], 0)],
                counts: load(simd, &near.counts, 0),
            };
            let codes = u32x16::splat(simd, neighbor << search.index_bits);
            found.look(search, &points, &origins, codes, near.most);
        }
        // Store the keys found so far.
        for rank in 0..K {
            store(found.best[rank], &mut self.best[rank], register);
        }
        store(found.next, &mut self.next, register);
    }

    /// Computes the hash words and point counts of the own cells and nearer neighbors. Done before the visits, so that
    /// the loops over points do not wait for the counts.
    #[inline(always)]
    fn hash_near<S: Simd, const C: usize>(
        &mut self,
        simd: S,
        lattice: &Lattice,
        places: &Places<S, N>,
    ) {
        let mut cells = [[places.cells[0]; 2]; N];
        for axis in 0..N {
            let nearer = places.nearer(simd, axis);
            let zero = i32x16::splat(simd, 0);
            cells[axis] = [
                places.shifted(lattice, axis, zero),
                places.shifted(lattice, axis, nearer),
            ];
        }
        let (columns, rows) = columns_and_rows(simd, lattice, cells);
        for first in (0..1 << N).step_by(C) {
            let mut words = [rows[0]; C];
            for i in 0..C {
                words[i] = both(rows[(first + i) >> 1], columns[(first + i) & 1]);
            }
            let cells = SixteenCells::new_each(simd, lattice, words);
            for i in 0..C {
                let near = &mut self.near[first + i];
                for which in 0..2 {
                    store(cells[i].words[which], &mut near.words[which], 0);
                }
                store(cells[i].counts, &mut near.counts, 0);
                near.most = cells[i].most(lattice);
            }
        }
    }

    /// Visits up to sixteen cells of the list.
    #[inline(always)]
    fn visit_far<S: Simd, const K: usize>(&mut self, simd: S, search: Search<'_>) {
        let (visits, n_visits) = self.visits.take();
        // Gather the positions of the visits.
        let mut cells = [[[0; LANES]; 2]; N];
        let mut steps = [[0; LANES]; N];
        let mut reach = [0; LANES];
        for lane in 0..LANES {
            let place = place(visits[lane]);
            for axis in 0..N {
                cells[axis][0][lane] = self.cells[axis][0][place];
                cells[axis][1][lane] = self.cells[axis][1][place];
                steps[axis][lane] = self.steps[axis][place];
            }
            reach[lane] = self.best[K - 1][place];
        }
        // Compare the points of their neighbors.
        let places = Places::load(simd, &cells, &steps, 0);
        let neighbors = u32x16::from_slice(simd, &visits) & ((1 << PLACE_SHIFT) - 1);
        let [cells] = Places::neighbors_each(simd, search.lattice, &[places], [neighbors]);
        let is_there = mask32x16::from_bitmask(simd, u64::MAX >> (64 - n_visits));
        let mut points = SixteenCells::new(simd, search.lattice, cells.words);
        points.counts = is_there.select(points.counts, u32x16::splat(simd, 0));
        let mut found = Found::<S, K>::new(simd, 0);
        let codes = neighbors << search.index_bits;
        let most = points.most(search.lattice);
        found.look(search, &points, &cells.origins, codes, most);
        // Insert the keys that can be among the nearest.
        let reach = u32x16::from_slice(simd, &reach) | search.code_mask;
        let mut matters = found.best[0].simd_le(reach).to_bitmask();
        let mut best = [[0; LANES]; K];
        let mut next = [0; LANES];
        for rank in 0..K {
            store(found.best[rank], &mut best[rank], 0);
        }
        store(found.next, &mut next, 0);
        while matters != 0 {
            let lane = matters.trailing_zeros() as usize;
            let place = place(visits[lane]);
            for best in &best {
                self.insert::<K>(place, best[lane]);
            }
            // The smallest key that is not among the nearest decides whether the last rank is known, so insert it, too.
            self.insert::<K>(place, next[lane]);
            matters &= matters - 1;
        }
    }

    /// Inserts a key into the sorted keys of the position with index `place`. `coded` is the key with the code in its
    /// low bits.
    #[inline(always)]
    fn insert<const K: usize>(&mut self, place: usize, mut coded: u32) {
        for best in &mut self.best[..K] {
            let larger = best[place].max(coded);
            best[place] = best[place].min(coded);
            coded = larger;
        }
        self.next[place] = self.next[place].min(coded);
    }

    /// Returns a bit mask of the sixteen positions in `register` for which the nearest points are known to be exact.
    #[inline(always)]
    fn holds<S: Simd, const K: usize>(&self, simd: S, search: Search<'_>, register: usize) -> u64 {
        let mask = search.code_mask;
        // Points beyond the neighbors must be farther than the last key, and the order of keys must be known.
        let last = load(simd, &self.best[K - 1], register) | mask;
        let places = Places::load(simd, &self.cells, &self.steps, register);
        let border = border(simd, search.exact, &places);
        let mut holds = last.bitcast::<f32x16<S>>().simd_lt(border);
        for rank in self.unused..K {
            let after = if rank + 1 < K {
                &self.best[rank + 1]
            } else {
                &self.next
            };
            // Keys that differ only in their codes become equal here, and their order is unknown.
            let best = load(simd, &self.best[rank], register) | mask;
            holds &= best.simd_lt(load(simd, after, register) | mask);
        }
        holds.to_bitmask()
    }

    /// Decodes `C` registers of nearest points, starting at register `first`: computes their vectors, distances and
    /// ids. The registers of one group of sixteen positions are consecutive, one per rank.
    #[inline(always)]
    fn finish<S: Simd, const C: usize>(&mut self, simd: S, search: Search<'_>, first: usize) {
        let lattice = search.lattice;
        // The depth is a power of two.
        let (shift, ranks) = (self.depth.trailing_zeros(), self.depth - 1);
        let mut places = [Places::load(simd, &self.cells, &self.steps, first >> shift); C];
        let [mut neighbors, mut index] = [[u32x16::splat(simd, 0); C]; 2];
        // Decode the neighbor and the point's index.
        for i in 0..C {
            let (register, rank) = ((first + i) >> shift, (first + i) & ranks);
            places[i] = Places::load(simd, &self.cells, &self.steps, register);
            let best = load(simd, &self.best[self.unused + rank], register);
            let code = best & search.code_mask;
            neighbors[i] = code >> search.index_bits;
            index[i] = code & ((1 << search.index_bits) - 1);
        }
        // Compute the ids and positions of the points.
        let cells = Places::neighbors_each(simd, lattice, &places, neighbors);
        let mut words = [cells[0].words; C];
        let mut hashes = [CellHashes::of_words(words[0]); C];
        let mut counters = index;
        for i in 0..C {
            words[i] = cells[i].words;
            hashes[i] = CellHashes::of_words(words[i]);
            counters[i] += IDS;
        }
        let ids = CellHashes::at_each(hashes, counters);
        let points = SixteenCells::new_each(simd, lattice, words);
        let points = SixteenCells::steps_each(points, index, lattice.jitter);
        for i in 0..C {
            let (register, rank) = ((first + i) >> shift, (first + i) & ranks);
            let vector = vector(&cells[i].origins, &points[i]);
            self.points[rank].put(search.exact, register, vector, ids[i]);
        }
    }
}

impl<const N: usize> Points<N> {
    /// Stores sixteen points. Their vectors are given in steps, their ids as high and low words.
    #[inline(always)]
    fn put<S: Simd>(
        &mut self,
        exact: Exact,
        register: usize,
        mut vector: [f32x16<S>; N],
        [high, low]: Words<S>,
    ) {
        let from = register * LANES;
        let (middle, to) = (from + LANES / 2, from + LANES);
        for axis in 0..N {
            vector[axis] *= STEP;
            let (first, second) = vector[axis].widen();
            first.store_slice(&mut self.vectors[axis][from..middle]);
            second.store_slice(&mut self.vectors[axis][middle..to]);
        }
        // Scaling by a step, a power of two, is exact. So these keys equal the keys of the search for one position.
        exact
            .distances(exact.keys(vector))
            .store_slice(&mut self.distances[from..to]);
        let [first, second] = [low.zip_low(high), low.zip_high(high)];
        let [first, second]: [u64x8<S>; 2] = [first.bitcast(), second.bitcast()];
        first.store_slice(&mut self.ids[from..middle]);
        second.store_slice(&mut self.ids[middle..to]);
    }
}

impl Visits {
    /// Appends the visits whose lanes are set in `which`.
    #[inline(always)]
    fn push<S: Simd>(&mut self, visits: u32x16<S>, which: mask32x16<S>) {
        let visits = visits.compress(which);
        visits.store_slice(&mut self.list[self.len..][..LANES]);
        self.len += which.to_bitmask().count_ones() as usize;
    }

    /// Removes up to sixteen visits from the list, and returns them with their number. The remaining array elements
    /// are undefined.
    #[inline(always)]
    fn take(&mut self) -> ([u32; LANES], usize) {
        let n_visits = self.len.min(LANES);
        self.len -= n_visits;
        let mut visits = [0; LANES];
        visits.copy_from_slice(&self.list[self.len..][..LANES]);
        (visits, n_visits)
    }
}

/// Returns the index in the group of the position that a visit is for.
#[inline(always)]
fn place(visit: u32) -> usize {
    // All indices are below `GROUP`; the remainder proves it to the compiler.
    (visit >> PLACE_SHIFT) as usize % GROUP
}

/// The smallest keys found for sixteen positions, with codes in the low bits.
pub(crate) struct Found<S: Simd, const K: usize> {
    /// The `K` smallest keys in ascending order. Unused ranks come first, and stay zero.
    best: [u32x16<S>; K],
    /// Smallest key of all other points.
    next: u32x16<S>,
}

impl<S: Simd, const K: usize> Found<S, K> {
    #[inline(always)]
    pub(crate) fn new(simd: S, unused: usize) -> Self {
        let nothing = u32x16::splat(simd, NOTHING);
        let mut best = [nothing; K];
        for rank in 0..K - 1 {
            if rank < unused {
                best[rank] = u32x16::splat(simd, 0);
            }
        }
        Self {
            best,
            next: nothing,
        }
    }

    /// Removes the smallest key of all lanes, and returns it. Used if all lanes belong to a single position.
    #[inline(always)]
    pub(crate) fn pop(&mut self) -> u32 {
        let least = self.best[0].reduce_min();
        // All codes differ, so only one lane has this key.
        let is_least = self.best[0].simd_eq(least);
        for rank in 1..K {
            self.best[rank - 1] = is_least.select(self.best[rank], self.best[rank - 1]);
        }
        self.best[K - 1] = is_least.select(self.next, self.best[K - 1]);
        least
    }

    /// Inserts the keys of all points in sixteen cells, one cell in each lane. `origins` are the positions relative to
    /// the cells, `codes` identify the cells, and `most` is the maximum number of points in any of the cells.
    #[inline(always)]
    pub(crate) fn look<const N: usize>(
        &mut self,
        search: Search<'_>,
        points: &SixteenCells<S>,
        origins: &[i32x16<S>; N],
        codes: u32x16<S>,
        most: u32,
    ) {
        let simd = codes.token();
        for index in 0..most {
            let index = u32x16::splat(simd, index);
            let point: [_; N] = points.steps(index, search.lattice.jitter);
            // Replace the low bits of the key by the code, and insert it.
            let key = search.exact.keys(vector(origins, &point));
            let coded = (key.bitcast::<u32x16<S>>() & !search.code_mask) | (codes | index);
            let is_there = points.counts.simd_gt(index);
            let mut coded = is_there.select(coded, u32x16::splat(simd, NOTHING));
            // At each rank, the smaller key stays and the larger one moves to the next rank. This needs no branch.
            for best in &mut self.best {
                let larger = best.max(coded);
                *best = best.min(coded);
                coded = larger;
            }
            self.next = self.next.min(coded);
        }
    }
}

/// Returns the vector from a point to the position, in steps. Both are relative to the lower corner of the point's
/// cell.
#[inline(always)]
pub(crate) fn vector<S: Simd, const N: usize>(
    origins: &[i32x16<S>; N],
    point: &[u32x16<S>; N],
) -> [f32x16<S>; N] {
    let mut vector = [origins[0].to_float(); N];
    for axis in 0..N {
        vector[axis] = (origins[axis] - point[axis].bitcast::<i32x16<S>>()).to_float();
    }
    vector
}

/// Returns, for each axis, the key terms of the distances from the positions to the own cell (zero), the nearer and
/// the farther neighbor, in steps.
#[inline(always)]
fn gaps<S: Simd, const N: usize>(
    simd: S,
    exact: Exact,
    places: &Places<S, N>,
) -> [[f32x16<S>; 3]; N] {
    let mut gaps = [[f32x16::splat(simd, 0.0); 3]; N];
    for axis in 0..N {
        let below = places.steps[axis];
        let above = i32x16::splat(simd, STEPS) - below;
        // The distance to the own cell is 0; its terms stay zero.
        let [near, far] = [below.min(above).to_float(), below.max(above).to_float()];
        [gaps[axis][1], gaps[axis][2]] = exact.terms([near, far]);
    }
    gaps
}

/// Returns a lower bound on the keys of all points beyond the neighboring cells. Lengths are in steps.
#[inline(always)]
fn border<S: Simd, const N: usize>(simd: S, exact: Exact, places: &Places<S, N>) -> f32x16<S> {
    // Cells beyond the neighbors begin a whole cell past the nearest side.
    let mut nearest = i32x16::splat(simd, STEPS);
    for axis in 0..N {
        let above = i32x16::splat(simd, STEPS) - places.steps[axis];
        nearest = nearest.min(places.steps[axis]).min(above);
    }
    exact.terms([(nearest + STEPS).to_float()])[0]
}

/// Mask for a neighbor's code. A set bit means that the neighbor is the farther one along some axis.
const FARTHER: u32 = 0b1010_1010;

/// Returns the index in [`Group::near`] of the own cell or a nearer neighbor. Bit `k` is set if the cell is the nearer
/// neighbor along axis `k`.
#[inline(always)]
fn near_index<const N: usize>(neighbor: u32) -> usize {
    (0..N).fold(0, |index, axis| index | digit(neighbor, axis) << axis)
}

/// Returns the hashed coordinates of the two columns (own cell and nearer neighbor along the first axis), and the
/// combined hashed coordinates of the rows along the other axes. The index of a row has one bit for each axis except
/// the first.
#[inline(always)]
fn columns_and_rows<S: Simd, const N: usize>(
    simd: S,
    lattice: &Lattice,
    cells: [[Words<S>; 2]; N],
) -> ([Words<S>; 2], [Words<S>; MOST_NEAR / 2]) {
    let columns = parts_each(simd, lattice, 0, cells[0]);
    let mut rows = [[u32x16::splat(simd, 0); 2]; MOST_NEAR / 2];
    let mut n_rows = 1;
    for axis in (1..N).rev() {
        let [own, near] = parts_each(simd, lattice, axis, cells[axis]);
        for row in (0..n_rows).rev() {
            [rows[2 * row], rows[2 * row + 1]] = [both(rows[row], own), both(rows[row], near)];
        }
        n_rows *= 2;
    }
    (columns, rows)
}

/// Index of each lane.
const ASCENDING: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
