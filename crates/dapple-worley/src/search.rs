//! Exact search for the feature points nearest to one position, by rings of cells.
//!
//! Cells are visited in rings of growing size around the cell of the position. Cells of a ring that are too far away
//! are skipped, and the search ends when no cell outside can contain a nearer point. Points placed by the caller are
//! searched in the same way ([`by_rings`]), in rings of bins. Worley visits the 26 neighbors and stops ("A Cellular
//! Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>). This occasionally misses points,
//! the more often the higher the n of `F_n`.
//!
//! Bounds are computed from the same exact coordinate differences, key terms and sums as the keys themselves. Rounding
//! is monotonic, so a bound never excludes a point wrongly and needs no margin.
//!
//! Points at equal distances are ordered by id, so the result does not depend on the order in which they are found.

use crate::fixed::{Place, STEP, STEPS, cells};
use crate::lattice::{IDS, Lattice, both};
use crate::places::{cells_by_distance, digit};
use crate::{MAX_NEAREST, Metric};
use core::cmp::Ordering;
use dapple_hash::CellHash;

/// The identity of a point in a lattice: its cell, and its index in that cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointId {
    /// Hash words of the cell.
    pub(crate) words: [u32; 2],
    pub(crate) index: u32,
}

impl PointId {
    /// Returns the point's id.
    #[inline]
    pub(crate) fn id(self) -> u64 {
        CellHash::of_words(self.words).at(IDS + self.index)
    }
}

/// A feature point that a search has found.
#[derive(Clone, Copy, Debug)]
pub struct Hit<const N: usize> {
    /// Key of the distance from the point to the position.
    pub(crate) key: f32,
    /// Vector from the feature point to the position, in cells.
    pub(crate) vector: [f32; N],
    /// Identity of the point; `None` if no point was found.
    pub(crate) name: Option<PointId>,
}

impl<const N: usize> Hit<N> {
    /// The result for a position that is out of range, with NaN as key and vector.
    pub(crate) const NOWHERE: Self = Self {
        key: f32::NAN,
        vector: [f32::NAN; N],
        name: None,
    };

    /// A missing point, infinitely far away.
    pub(crate) const NONE: Self = Self {
        key: f32::INFINITY,
        vector: [f32::INFINITY; N],
        name: None,
    };
}

/// Maximum ring of a search, in cells. At the smallest density, a void of this size has a probability below 2^-200 even
/// in two dimensions.
const LAST_RING: i64 = 96;

/// Finds the `n` nearest points, at most four, in rings of growing size. `visit` adds the points of a ring, and returns
/// a lower bound on the keys of all points beyond the ring, or infinity if there are no such points.
#[inline(always)]
pub(crate) fn by_rings<const N: usize>(
    n: usize,
    metric: Metric,
    mut visit: impl FnMut(i64, &mut Ranking<N>) -> f32,
) -> Ranking<N> {
    let mut ranking = Ranking::new(n);
    for ring in 0.. {
        let border = visit(ring, &mut ranking);
        // Stop only if the bound is strictly larger: a point with an equal key and a smaller id would still enter.
        if border == f32::INFINITY || ranking.reach * metric.rounding_slack() < border {
            break;
        }
    }
    ranking
}

/// Finds the points nearest to `place`, nearest first; at most four.
pub(crate) fn nearest<const N: usize>(
    lattice: &Lattice,
    metric: Metric,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) {
    let rounding_slack = metric.rounding_slack();
    let search = Search {
        lattice,
        metric,
        place,
    };
    let ranking = by_rings(hits.len(), metric, |ring, ranking| {
        // Visit the position's cell and the ring around it at once.
        let ring = ring + 1;
        if ring == 1 {
            search.neighbors(ranking);
        } else {
            search.ring(ring, |shift, gap| {
                if gap <= ranking.reach * rounding_slack {
                    search.cell(shift, |hit| ranking.add(hit, PointId::id));
                }
            });
        }
        // Stop if all further cells repeat empty ones, or at the maximum ring.
        let is_empty = ranking.hits[0].name.is_none() && lattice.repeats_within(ring);
        if is_empty || ring == LAST_RING {
            return f32::INFINITY;
        }
        search.border(ring)
    });
    hits.copy_from_slice(ranking.hits());
}

/// Finds all points whose keys are at most the key of `distance`, unordered.
pub(crate) fn within<const N: usize>(
    lattice: &Lattice,
    metric: Metric,
    place: &Place<N>,
    distance: f32,
) -> Vec<Hit<N>> {
    let mut hits = Vec::new();
    // Rounding of Minkowski's powers may put the bound of a cell above the keys of its points; the slack covers it.
    let key = metric.term(distance) * metric.rounding_slack();
    let search = Search {
        lattice,
        metric,
        place,
    };
    for ring in 0..=LAST_RING {
        search.ring(ring, |shift, gap| {
            if gap <= key {
                search.cell(shift, |hit| {
                    if hit.key <= key {
                        hits.push(hit);
                    }
                });
            }
        });
        if key < search.border(ring) {
            break;
        }
    }
    hits
}

/// The nearest points found so far, nearest first.
pub(crate) struct Ranking<const N: usize> {
    hits: [Hit<N>; MAX_NEAREST],
    /// Number of points to find.
    len: usize,
    /// Keys above this value cannot enter the ranking.
    reach: f32,
}

impl<const N: usize> Ranking<N> {
    pub(crate) fn new(len: usize) -> Self {
        Self {
            hits: [Hit::NONE; MAX_NEAREST],
            len,
            reach: f32::INFINITY,
        }
    }

    pub(crate) fn hits(&self) -> &[Hit<N>] {
        &self.hits[..self.len]
    }

    /// Returns the largest key that can still enter the ranking.
    pub(crate) fn reach(&self) -> f32 {
        self.reach
    }

    /// Inserts a point if it is among the nearest.
    #[inline(always)]
    pub(crate) fn add(&mut self, hit: Hit<N>, id: impl Fn(PointId) -> u64) {
        if hit.key <= self.reach {
            self.insert(hit, id);
        }
    }

    #[inline]
    fn insert(&mut self, hit: Hit<N>, id: impl Fn(PointId) -> u64) {
        let hits = &mut self.hits[..self.len];
        // Insertion sort, as in the paper: farther points move down one rank, and the last one drops out.
        let mut at = hits.len();
        while at > 0 && order(&hit, &hits[at - 1], &id).is_lt() {
            if at < hits.len() {
                hits[at] = hits[at - 1];
            }
            at -= 1;
        }
        if at < hits.len() {
            hits[at] = hit;
            // Empty ranks have infinite keys, so the reach is finite only if `len` points are known.
            self.reach = hits[hits.len() - 1].key;
        }
    }
}

/// Orders hits by key, then by id, then (for repeats of one point) by vector.
#[inline]
pub(crate) fn order<const N: usize>(
    a: &Hit<N>,
    b: &Hit<N>,
    id: impl Fn(PointId) -> u64,
) -> Ordering {
    match a.key.total_cmp(&b.key) {
        Ordering::Equal => order_of_equal(a, b, id),
        order => order,
    }
}

/// Orders hits with equal keys.
#[cold]
fn order_of_equal<const N: usize>(a: &Hit<N>, b: &Hit<N>, id: impl Fn(PointId) -> u64) -> Ordering {
    let [a_id, b_id] = [a, b].map(|hit| hit.name.map(&id));
    let parts = a.vector.iter().zip(&b.vector);
    a_id.cmp(&b_id)
        .then(parts.fold(Ordering::Equal, |order, (a, b)| order.then(b.total_cmp(a))))
}

/// Number of cells whose points are added in one batch.
const BATCH: usize = 4;

/// The cell of a position and its neighbors. Each axis lists the own cell, the nearer and the farther neighbor.
struct Around<const N: usize> {
    /// Coordinates of the cells, wrapped by the period.
    cells: [[i64; 3]; N],
    /// Coordinates of the position, in steps from the lower edges of the cells.
    origins: [[i32; 3]; N],
    /// Key terms of the distances from the position to the cells.
    gaps: [[f32; 3]; N],
    /// Hashed coordinates of the cells, for both hash words.
    parts: [[[u32; 2]; 3]; N],
}

impl<const N: usize> Around<N> {
    #[inline(always)]
    fn new(search: &Search<'_, N>) -> Self {
        let Search {
            lattice,
            metric,
            place,
        } = search;
        let mut around = Self {
            cells: [[0; 3]; N],
            origins: [[0; 3]; N],
            gaps: [[0.0; 3]; N],
            parts: [[[0; 2]; 3]; N],
        };
        for axis in 0..N {
            let below = place.steps[axis];
            let above = STEPS - below;
            let nearer = if below < above { -1 } else { 1 };
            // All points of a neighbor are beyond the side that it shares with the own cell.
            let shifts = [0, nearer, -nearer];
            let sides = [0, below.min(above), below.max(above)];
            around.cells[axis] =
                shifts.map(|shift| lattice.wrap(axis, place.cell[axis] + i64::from(shift)));
            around.parts[axis] = around.cells[axis].map(|cell| lattice.parts(axis, cell));
            around.origins[axis] = shifts.map(|shift| below - shift * STEPS);
            around.gaps[axis] = sides.map(|steps| metric.term(steps as f32 * STEP));
        }
        around
    }

    /// Returns a lower bound on the keys of all points in a neighbor.
    #[inline(always)]
    fn gap(&self, metric: Metric, neighbor: u8) -> f32 {
        let gap = |axis: usize| self.gaps[axis][digit(neighbor.into(), axis)];
        let mut key = gap(N - 1);
        for axis in (0..N - 1).rev() {
            key = metric.accumulate(gap(axis), key);
        }
        key
    }
}

/// State of a search by rings.
struct Search<'a, const N: usize> {
    lattice: &'a Lattice,
    metric: Metric,
    place: &'a Place<N>,
}

impl<const N: usize> Search<'_, N> {
    /// Adds the points of the position's cell and of its neighbors to a ranking. Cells are visited in the order of
    /// their mean distance.
    fn neighbors(&self, ranking: &mut Ranking<N>) {
        let rounding_slack = self.metric.rounding_slack();
        let around = Around::new(self);
        let mut batch = [0; BATCH];
        let mut n = 0;
        for &neighbor in cells_by_distance::<N>() {
            // Skip cells that are too far away to contribute. The paper tests whole rows of cubes in this way.
            if around.gap(self.metric, neighbor) > ranking.reach * rounding_slack {
                continue;
            }
            batch[n] = neighbor;
            n += 1;
            if n == BATCH {
                self.batch(&around, &batch, ranking);
                n = 0;
            }
        }
        self.batch(&around, &batch[..n], ranking);
    }

    /// Adds the points of several neighbors to a ranking. A batch of cells is hashed before its points are added,
    /// since the numbers of points are unpredictable branches.
    #[inline]
    fn batch(&self, around: &Around<N>, neighbors: &[u8], ranking: &mut Ranking<N>) {
        let rounding_slack = self.metric.rounding_slack();
        for &neighbor in neighbors {
            // Test again: cells earlier in the batch may have reduced the reach.
            if around.gap(self.metric, neighbor) > ranking.reach * rounding_slack {
                continue;
            }
            let digit = |axis| digit(neighbor.into(), axis);
            let cell: [i64; N] = core::array::from_fn(|axis| around.cells[axis][digit(axis)]);
            let origin: [i32; N] = core::array::from_fn(|axis| around.origins[axis][digit(axis)]);
            // Combine the hash parts that are shared by the cells of a row.
            let words = (0..N).fold([0; 2], |words, axis| {
                both(words, around.parts[axis][digit(axis)])
            });
            // Add the points with their exact vectors and keys.
            self.lattice.visit_words(cell, words, |steps, name| {
                let mut vector = [0.0; N];
                for axis in 0..N {
                    vector[axis] = (origin[axis] - steps[axis]) as f32 * STEP;
                }
                let key = self.metric.key(vector);
                let name = Some(name);
                ranking.add(Hit { key, vector, name }, PointId::id);
            });
        }
    }

    /// Returns the coordinates of the cell that is offset by `shift` from the position's cell.
    #[inline(always)]
    fn shifted(&self, shift: [i64; N]) -> [i64; N] {
        core::array::from_fn(|axis| self.place.cell[axis] + shift[axis])
    }

    /// Returns the hit for a point in the cell that is offset by `shift` from the position's cell.
    #[inline(always)]
    fn hit(&self, shift: [i64; N], steps: [i32; N], name: PointId) -> Hit<N> {
        let mut vector = [0.0; N];
        for axis in 0..N {
            // Subtract in integers, so that the only rounding is the conversion to `f32`.
            let ahead = i64::from(self.place.steps[axis]) - i64::from(steps[axis]);
            vector[axis] = cells(ahead - shift[axis] * i64::from(STEPS));
        }
        Hit {
            key: self.metric.key(vector),
            vector,
            name: Some(name),
        }
    }

    /// Calls `each` with the offset of every cell in a ring, and with a lower bound on the keys of its points. The
    /// largest component of these offsets is `ring` cells.
    fn ring(&self, ring: i64, mut each: impl FnMut([i64; N], f32)) {
        let mut shift = [-ring; N];
        loop {
            if shift.iter().any(|part| part.abs() == ring) {
                each(shift, self.gap(shift));
            }
            // Advance to the next cell, the first axis fastest. Skip the interior of the ring.
            let inside = shift[1..].iter().all(|part| part.abs() < ring);
            shift[0] += if inside && shift[0] == -ring {
                2 * ring.max(1)
            } else {
                1
            };
            let mut axis = 0;
            while shift[axis] > ring {
                shift[axis] = -ring;
                axis += 1;
                if axis == N {
                    return;
                }
                shift[axis] += 1;
            }
        }
    }

    /// Calls `each` with the points in the cell that is offset by `shift` from the position's cell.
    #[inline(always)]
    fn cell(&self, shift: [i64; N], mut each: impl FnMut(Hit<N>)) {
        self.lattice.visit(self.shifted(shift), |steps, name| {
            each(self.hit(shift, steps, name));
        });
    }

    /// Returns a lower bound on the keys of all points in the cell that is offset by `shift` from the position's cell.
    #[inline]
    fn gap(&self, shift: [i64; N]) -> f32 {
        let mut gap = [0.0; N];
        for axis in 0..N {
            let inside = i64::from(self.place.steps[axis]);
            // Count the steps to the nearest side of the cell; 0 if the cell contains the coordinate.
            let near = match shift[axis] {
                0 => 0,
                1.. => shift[axis] * i64::from(STEPS) - inside,
                _ => inside - (shift[axis] + 1) * i64::from(STEPS),
            };
            gap[axis] = cells(near);
        }
        self.metric.key(gap)
    }

    /// Returns a lower bound on the keys of all points beyond `ring` rings.
    fn border(&self, ring: i64) -> f32 {
        // A point beyond the ring is beyond one of its sides. The key of a vector is at least the term of each
        // component, so the term of the smallest distance to a side is a lower bound.
        let sides = self.place.steps.map(|steps| steps.min(STEPS - steps));
        let nearest = sides.into_iter().fold(STEPS, i32::min);
        self.metric
            .term(cells(i64::from(nearest) + ring * i64::from(STEPS)))
    }
}
