//! Searches the nearest points of one position, with one cell in each lane.
//!
//! Keys have codes in their low bits, as in [`many`](crate::many). The result is inexact if two points are at nearly
//! the same distance, or if a cell that was not visited can contain a nearer point. Then the search by rings is used.

use crate::Metric;
use crate::fixed::{Place, STEP, STEP_BITS, STEPS};
use crate::lattice::{Lattice, SixteenCells, both};
use crate::levels::wide;
use crate::many::{Found, NOTHING, Search, vector};
use crate::metric::Measure as _;
use crate::places::{LANES, cells_by_distance, digit};
use crate::search::{self, Hit, PointId, Ranking};
use dapple_hash::mix32_pairs;
use dapple_raster::simd;
use fearless_simd::{i32x16, mask32x16, prelude::*, u32x16};

/// Returns the number of visited cells: the own cell and the neighbors with the smallest mean distance. Neighbors that
/// are the farther one along several axes are not visited.
const fn n_visited(n_axes: usize) -> usize {
    [0, 0, 8, 24][n_axes]
}

/// Finds the points nearest to `place` in 2-D or 3-D, nearest first; at most four.
pub(crate) fn nearest<const N: usize>(
    lattice: &Lattice,
    metric: Metric,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) {
    if !finds(lattice, metric, place, hits) {
        search::nearest(lattice, metric, place, hits);
    }
}

/// Finds the nearest points in the visited cells. Returns whether the result is known to be exact.
#[inline(always)]
fn finds<const N: usize>(
    lattice: &Lattice,
    metric: Metric,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) -> bool {
    // Powers gain nothing from registers, and the counts of a varying density are not in a table.
    if metric.is_slow() || lattice.density.is_some() {
        return false;
    }
    let search = Search::new(N, lattice, metric);
    let level = simd::level();
    let counts = &lattice.counts;
    let is_certain = if counts.thresholds().is_empty() && counts.least() == 1 {
        wide!(level, simd => search_by_axes::<_, N, 0>(simd, search, place, hits))
    } else if hits.len() <= 2 {
        wide!(level, simd => search_by_axes::<_, N, 2>(simd, search, place, hits))
    } else {
        wide!(level, simd => search_by_axes::<_, N, 4>(simd, search, place, hits))
    };
    is_certain.unwrap_or(false)
}

/// The cell of a position and its neighbors. For each axis, the elements are the own cell, the nearer and the farther
/// neighbor.
struct Around<const N: usize> {
    /// Coordinates of the cells, wrapped by the period.
    cells: [[i64; 3]; N],
    /// Coordinates of the position, in steps from the lower edges of the cells.
    origins: [[i32; 3]; N],
}

impl<const N: usize> Around<N> {
    #[inline(always)]
    fn new(lattice: &Lattice, place: &Place<N>) -> Self {
        let mut around = Self {
            cells: [[0; 3]; N],
            origins: [[0; 3]; N],
        };
        for axis in 0..N {
            let below = place.steps[axis];
            let above = STEPS - below;
            let nearer = if below < above { -1 } else { 1 };
            // Order the neighbors by distance: the codes 1 and 2 are the nearer and the farther one.
            around.cells[axis] = lattice.cells_around(axis, place.cell[axis], nearer.into());
            around.origins[axis] = [below, below - nearer * STEPS, below + nearer * STEPS];
        }
        around
    }

    /// Returns whether the coordinates of all cells fit into 32 bits, which makes them cheaper to hash.
    #[inline(always)]
    fn is_near(&self, lattice: &Lattice) -> bool {
        let mut is_near = true;
        for axis in 0..N {
            is_near &= match lattice.period[axis] {
                0 => self.cells[axis][0].unsigned_abs() < (1 << 31) - 1,
                period => period <= 1 << 31,
            };
        }
        is_near
    }

    /// Returns the hash words of the visited cells, and the position relative to each, one cell per lane of `C`
    /// registers.
    #[inline(always)]
    fn lanes<S: Simd, const C: usize>(&self, simd: S, lattice: &Lattice) -> Lanes<S, N, C> {
        let mut words = [[u32x16::splat(simd, 0); 2]; C];
        let mut origins = [[i32x16::splat(simd, 0); N]; C];
        let parts = self.parts(simd, lattice);
        for axis in 0..N {
            let origin = self.origins[axis].map(i32::cast_unsigned);
            for register in 0..C {
                let [first, second] = &parts;
                let parts = [
                    pick::<S, N>(simd, axis, register, &first[3 * axis..]),
                    pick::<S, N>(simd, axis, register, &second[3 * axis..]),
                ];
                words[register] = both(words[register], parts);
                origins[register][axis] = pick::<S, N>(simd, axis, register, &origin).bitcast();
            }
        }
        Lanes::new(simd, lattice, words, origins)
    }

    /// Returns the hashed coordinates of the cells for both hash words. Each axis has three elements: own cell, nearer
    /// and farther neighbor.
    #[inline(always)]
    fn parts<S: Simd>(&self, simd: S, lattice: &Lattice) -> [[u32; LANES]; 2] {
        let mut parts = [[0; LANES]; 2];
        if self.is_near(lattice) {
            let mut words = [0; LANES];
            for axis in 0..N {
                for which in 0..3 {
                    words[3 * axis + which] = self.cells[axis][which] as u32;
                }
            }
            // Mix the coordinates of all axes for both words in one pair of registers.
            let words = u32x16::from_slice(simd, &words);
            let [keys, more_keys] = &lattice.lane_keys;
            let keys = [
                u32x16::from_slice(simd, keys),
                u32x16::from_slice(simd, more_keys),
            ];
            let [mixed] = mix32_pairs([[words ^ keys[0], words ^ keys[1]]]);
            mixed[0].store_slice(&mut parts[0]);
            mixed[1].store_slice(&mut parts[1]);
        } else {
            for axis in 0..N {
                for which in 0..3 {
                    // Coordinates beyond 32 bits need a second mixing, of their high words.
                    let [first, second] = lattice.parts(axis, self.cells[axis][which]);
                    parts[0][3 * axis + which] = first;
                    parts[1][3 * axis + which] = second;
                }
            }
        }
        parts
    }

    /// Searches cells that may contain several points. Returns whether the result is known to be exact.
    #[inline(always)]
    fn search_several<S: Simd, const K: usize, const C: usize>(
        &self,
        simd: S,
        search: Search<'_>,
        hits: &mut [Hit<N>],
    ) -> bool {
        let (index_bits, code_mask) = (search.index_bits, search.code_mask);
        let mut lanes = self.lanes::<S, C>(simd, search.lattice);
        let mut found = Found::<S, K>::new(simd, 0);
        // Compare the points of all visited cells.
        for register in 0..C {
            let numbers = u32x16::from_slice(simd, &const { numbers() }[register]);
            // Lanes without a visited cell have no points.
            let cells = &mut lanes.cells[register];
            let zero = u32x16::splat(simd, 0);
            cells.counts = is_visited::<S, N>(simd, register).select(cells.counts, zero);
            let most = cells.counts.reduce_max();
            let codes = numbers << index_bits;
            found.look(search, cells, &lanes.origins[register], codes, most);
        }
        // Decode the smallest keys one by one.
        let mut coded = found.pop();
        for rank in 0..K {
            let Some(hit) = hits.get_mut(rank) else {
                break;
            };
            let next = found.pop();
            // The order of keys that differ only in their codes is unknown. The keys of missing points also compare
            // equal.
            if coded | code_mask == next | code_mask {
                return false;
            }
            let code = coded & code_mask;
            // The remainder proves to the compiler that the index is in range.
            let number = (code >> index_bits) as usize % n_visited(N);
            let index = code & ((1 << index_bits) - 1);
            let neighbor = cells_by_distance::<N>()[number];
            *hit = self.hit(search, neighbor, lanes.words(number), index);
            coded = next;
        }
        true
    }

    /// Returns the hit for point `index` of a neighbor, given the neighbor's code and hash words.
    #[inline(always)]
    fn hit(&self, search: Search<'_>, neighbor: u8, words: [u32; 2], index: u32) -> Hit<N> {
        let steps: [i32; N] = search.lattice.steps(words, index);
        let mut vector = [0.0; N];
        for axis in 0..N {
            let ahead = self.origins[axis][digit(neighbor.into(), axis)] - steps[axis];
            vector[axis] = ahead as f32 * STEP;
        }
        let key = search.exact.0.key(vector);
        let name = Some(PointId { words, index });
        Hit { key, vector, name }
    }
}

/// Distances along each axis, in steps, from a position to its own cell (zero), the nearer and the farther neighbor.
struct Sides<const N: usize>([[i32; 3]; N]);

impl<const N: usize> Sides<N> {
    #[inline(always)]
    fn new(place: &Place<N>) -> Self {
        let mut sides = [[0; 3]; N];
        for axis in 0..N {
            let below = place.steps[axis];
            let above = STEPS - below;
            sides[axis] = [0, below.min(above), below.max(above)];
        }
        Self(sides)
    }

    /// Returns a lower bound on the keys of all points in cells that are not visited.
    #[inline(always)]
    fn border(&self, metric: Metric) -> f32 {
        // Cells that are not visited are beyond the neighbors, or among the few neighbors that are left out.
        let mut border = self.outer_border(metric);
        for &neighbor in &cells_by_distance::<N>()[n_visited(N)..] {
            border = border.min(self.gap(metric, neighbor));
        }
        border
    }

    /// Returns a lower bound on the keys of all points in a neighbor.
    #[inline(always)]
    fn gap(&self, metric: Metric, neighbor: u8) -> f32 {
        let mut sides = [0.0; N];
        for axis in 0..N {
            sides[axis] = self.0[axis][digit(neighbor.into(), axis)] as f32 * STEP;
        }
        metric.key(sides)
    }

    /// Returns a lower bound on the keys of all points beyond the neighbors.
    #[inline(always)]
    fn outer_border(&self, metric: Metric) -> f32 {
        let mut nearest = STEPS;
        for side in &self.0 {
            nearest = nearest.min(side[1]);
        }
        metric.term((nearest + STEPS) as f32 * STEP)
    }
}

/// Visits the remaining neighbors that can contain a nearer point. Returns whether no cell beyond the neighbors can
/// contain one.
#[cold]
fn visit_rest<const N: usize>(search: Search<'_>, place: &Place<N>, hits: &mut [Hit<N>]) -> bool {
    let Search { lattice, exact, .. } = search;
    let (around, sides) = (Around::new(lattice, place), Sides::new(place));
    let mut ranking = Ranking::new(hits.len());
    for &hit in &*hits {
        ranking.add(hit, PointId::id);
    }
    for &neighbor in &cells_by_distance::<N>()[n_visited(N)..] {
        // A cell exactly at the reach counts: its point may have an equal key and a smaller id.
        if sides.gap(exact.0, neighbor) <= ranking.reach() {
            let mut cell = [0; N];
            for axis in 0..N {
                cell[axis] = around.cells[axis][digit(neighbor.into(), axis)];
            }
            let words = lattice.words(cell);
            for index in 0..lattice.count(&cell, words[0]) {
                ranking.add(around.hit(search, neighbor, words, index), PointId::id);
            }
        }
    }
    hits.copy_from_slice(ranking.hits());
    ranking.reach() < sides.outer_border(exact.0)
}

/// The cells that a search visits, one in each lane.
struct Lanes<S: Simd, const N: usize, const C: usize> {
    cells: [SixteenCells<S>; C],
    /// Position relative to the lower corner of each cell, in steps.
    origins: [[i32x16<S>; N]; C],
    /// Hash words of the cells, stored in memory for lookups, eight cells at a time.
    halves: [[[u32; 8]; 2]; 4],
}

impl<S: Simd, const N: usize> Lanes<S, N, 1> {
    /// Builds the lanes for a position without periods, whose cell coordinates fit into 32 bits. Coordinates are
    /// hashed in each lane, which is cheaper for one register than to distribute hashed coordinates.
    #[inline(always)]
    fn near(simd: S, lattice: &Lattice, place: &Place<N>) -> Self {
        let mut coordinates = [[u32x16::splat(simd, 0); 2]; N];
        let mut origins = [[i32x16::splat(simd, 0); N]; 1];
        let [first, second] = &lattice.hashes;
        for axis in 0..N {
            let below = place.steps[axis];
            // -1 or 1
            let nearer = (below - STEPS / 2) >> 31 | 1;
            let directions = i32x16::from_slice(simd, &const { directions::<N>() }[axis]);
            let shift = directions * i32x16::splat(simd, nearer);
            let cell = shift + i32x16::splat(simd, place.cell[axis] as i32);
            let cell = cell.bitcast::<u32x16<S>>();
            coordinates[axis] = [cell ^ first.key(axis), cell ^ second.key(axis)];
            // Count the position from the corner of the shifted cell.
            origins[0][axis] = i32x16::splat(simd, below) - (shift << STEP_BITS);
        }
        let mut words = [[u32x16::splat(simd, 0); 2]; 1];
        let parts = mix32_pairs(coordinates);
        for axis in 0..N {
            words[0] = both(words[0], parts[axis]);
        }
        Self::new(simd, lattice, words, origins)
    }
}

impl<S: Simd, const N: usize, const C: usize> Lanes<S, N, C> {
    #[inline(always)]
    fn new(
        simd: S,
        lattice: &Lattice,
        words: [[u32x16<S>; 2]; C],
        origins: [[i32x16<S>; N]; C],
    ) -> Self {
        let mut halves = [[[0; 8]; 2]; 4];
        for register in 0..C {
            for which in 0..2 {
                let (low, high) = words[register][which].split();
                low.store_slice(&mut halves[2 * register][which]);
                high.store_slice(&mut halves[2 * register + 1][which]);
            }
        }
        Self {
            cells: SixteenCells::new_each(simd, lattice, words),
            origins,
            halves,
        }
    }

    /// Searches cells that contain one point each. Returns whether the result is known to be exact.
    #[inline(always)]
    fn search_single(&self, simd: S, search: Search<'_>, hits: &mut [Hit<N>]) -> bool {
        let mut keys = [u32x16::splat(simd, NOTHING); C];
        let mut vectors = [[[0.0; 8]; N]; 4];
        // Compute the vector and the key of the point in each cell.
        for register in 0..C {
            let index = u32x16::splat(simd, 0);
            let point: [_; N] = self.cells[register].steps(index, search.lattice.jitter);
            let mut vector = vector(&self.origins[register], &point);
            for axis in 0..N {
                vector[axis] *= STEP;
            }
            let key = search.exact.keys(vector);
            keys[register] =
                is_visited::<S, N>(simd, register).select(key.bitcast(), keys[register]);
            for axis in 0..N {
                let (low, high) = vector[axis].split();
                low.store_slice(&mut vectors[2 * register][axis]);
                high.store_slice(&mut vectors[2 * register + 1][axis]);
            }
        }
        for hit in &mut *hits {
            // Remove the smallest key for each hit.
            let mut least = keys[0].reduce_min();
            for register in 1..C {
                least = least.min(keys[register].reduce_min());
            }
            let mut lanes_of_least = 0;
            for register in 0..C {
                let is_least = keys[register].simd_eq(least);
                lanes_of_least |= is_least.to_bitmask() << (register * LANES);
                keys[register] = is_least.select(u32x16::splat(simd, NOTHING), keys[register]);
            }
            // Points with equal keys are ordered by id, in the search by rings.
            if !lanes_of_least.is_power_of_two() {
                return false;
            }
            // Look up the point's vector and identity.
            let number = lanes_of_least.trailing_zeros() as usize % n_visited(N);
            let (half, lane) = (number / 8, number % 8);
            for axis in 0..N {
                hit.vector[axis] = vectors[half][axis][lane];
            }
            hit.key = f32::from_bits(least);
            let words = self.words(number);
            hit.name = Some(PointId { words, index: 0 });
        }
        true
    }

    /// Returns the two hash words of the cell with this number.
    #[inline(always)]
    fn words(&self, number: usize) -> [u32; 2] {
        let [first, second] = &self.halves[number / 8];
        [first[number % 8], second[number % 8]]
    }
}

/// Returns a mask of the visited cells in a register. On processors with eight-lane registers, the compiler removes the
/// computations for the other cells.
#[inline(always)]
fn is_visited<S: Simd, const N: usize>(simd: S, register: usize) -> mask32x16<S> {
    let numbers = u32x16::from_slice(simd, &const { numbers() }[register]);
    numbers.simd_lt(n_visited(N) as u32)
}

/// Searches the visited cells for up to `K` points. With `K` = 0, cells contain one point each, and any number of
/// points can be found. Returns whether the result is known to be exact.
#[inline(always)]
fn search_by_axes<S: Simd, const N: usize, const K: usize>(
    simd: S,
    search: Search<'_>,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) -> bool {
    let around = || Around::new(search.lattice, place);
    let is_certain = match const { (N, K) } {
        (2, 0) if is_simple(search.lattice, place) => {
            Lanes::near(simd, search.lattice, place).search_single(simd, search, hits)
        }
        (2, 0) => {
            let lanes = around().lanes::<S, 1>(simd, search.lattice);
            lanes.search_single(simd, search, hits)
        }
        (_, 0) => {
            let lanes = around().lanes::<S, 2>(simd, search.lattice);
            lanes.search_single(simd, search, hits)
        }
        (2, _) => around().search_several::<S, K, 1>(simd, search, hits),
        _ => around().search_several::<S, K, 2>(simd, search, hits),
    };
    // The result is certain if no cell that is not visited can contain a point as near as the last one.
    let reach = hits.last().map_or(0.0, |hit| hit.key);
    is_certain
        && (reach < Sides::new(place).border(search.exact.0) || visit_rest(search, place, hits))
}

/// Returns whether no axis repeats, and all cells have coordinates that are signed 32-bit integers.
#[inline(always)]
fn is_simple<const N: usize>(lattice: &Lattice, place: &Place<N>) -> bool {
    let mut is_simple = true;
    for axis in 0..N {
        is_simple &= lattice.period[axis] == 0;
        is_simple &= place.cell[axis].unsigned_abs() < (1 << 31) - 1;
    }
    is_simple
}

/// Returns, for each axis and visited cell, the cell's offset as a multiple of the nearer neighbor's: 0, 1 or -1.
const fn directions<const N: usize>() -> [[i32; LANES]; N] {
    let mut directions = [[0; LANES]; N];
    let digits = digits::<N>();
    let mut axis = 0;
    while axis < N {
        let mut lane = 0;
        while lane < LANES {
            directions[axis][lane] = [0, 1, -1][digits[axis][0][lane] as usize];
            lane += 1;
        }
        axis += 1;
    }
    directions
}

/// Returns, for each axis, the neighbor codes of the visited cells in two registers; see [`places`](crate::places).
const fn digits<const N: usize>() -> [[[u32; LANES]; 2]; N] {
    let mut digits = [[[0; LANES]; 2]; N];
    let cells = cells_by_distance::<N>();
    let mut number = 0;
    while number < n_visited(N) {
        let mut axis = 0;
        while axis < N {
            digits[axis][number / LANES][number % LANES] = digit(cells[number] as u32, axis) as u32;
            axis += 1;
        }
        number += 1;
    }
    digits
}

/// Returns the numbers of the visited cells, counted in order of their mean distance, in two registers.
const fn numbers() -> [[u32; LANES]; 2] {
    let mut numbers = [[0; LANES]; 2];
    let mut number = 0;
    while number < 2 * LANES {
        numbers[number / LANES][number % LANES] = number as u32;
        number += 1;
    }
    numbers
}

/// Selects an element of `of` in each lane: `of[0]` for the own cell, `of[1]` for the nearer and `of[2]` for the
/// farther neighbor along an axis.
#[inline(always)]
fn pick<S: Simd, const N: usize>(simd: S, axis: usize, register: usize, of: &[u32]) -> u32x16<S> {
    let digits = u32x16::from_slice(simd, &const { digits::<N>() }[axis][register]);
    let own = u32x16::splat(simd, of[0]);
    let near = u32x16::splat(simd, of[1]);
    let far = u32x16::splat(simd, of[2]);
    let other = digits.simd_eq(1).select(near, far);
    digits.simd_eq(0).select(own, other)
}
