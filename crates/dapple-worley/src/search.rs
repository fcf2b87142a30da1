//! The exact search for the nearest feature points of one position.
//!
//! Cells are visited in rings of growing size around the position's own; cells of a ring that lie too far away are
//! skipped, and the search ends when no cell outside can hold a nearer point. Worley visits the 26 neighbors and stops
//! ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>); that misses points
//! now and then, and more often the higher n is.
//!
//! Bounds are computed from the same exact differences, terms and joins as the keys themselves. Rounding does not
//! turn a smaller sum into a larger one, so a bound never excludes a point wrongly, and needs no margin.
//!
//! Of two points at the same distance, the one with the smaller id comes first, so that the result does not depend
//! on the order in which they were found.

use crate::fixed::{Place, STEPS, cells};
use crate::lattice::{IDS, Lattice};
use crate::{LIMIT, Metric};
use core::cmp::Ordering;
use dapple_hash::CellHash;

/// The identity of a point in a lattice: the hash of its cell and its index there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Name {
    pub(crate) hash: CellHash,
    pub(crate) index: u32,
}

impl Name {
    /// The id of the point.
    #[inline]
    pub(crate) fn id(self) -> u64 {
        self.hash.at(IDS + self.index)
    }
}

/// A point that a search has found.
#[derive(Clone, Copy, Debug)]
pub struct Hit<const N: usize> {
    pub(crate) key: f32,
    /// The vector from the feature point to the position, in cells.
    pub(crate) vector: [f32; N],
    /// The identity of the point; `None` if no point was found.
    pub(crate) name: Option<Name>,
}

impl<const N: usize> Hit<N> {
    /// The result for a position without a place.
    pub(crate) const NOWHERE: Self = Self {
        key: f32::NAN,
        vector: [f32::NAN; N],
        name: None,
    };

    /// The absence of a point: infinitely far away.
    pub(crate) const NONE: Self = Self {
        key: f32::INFINITY,
        vector: [f32::INFINITY; N],
        name: None,
    };
}

/// The hit of a point in the cell that is `shift` cells from the place's own.
#[inline(always)]
pub(crate) fn hit<const N: usize>(
    metric: Metric,
    place: &Place<N>,
    shift: [i64; N],
    steps: [i32; N],
    name: Name,
) -> Hit<N> {
    let mut vector = [0.0; N];
    for axis in 0..N {
        let ahead = i64::from(place.steps[axis]) - i64::from(steps[axis]);
        vector[axis] = cells(ahead - shift[axis] * i64::from(STEPS));
    }
    Hit {
        key: metric.key(vector),
        vector,
        name: Some(name),
    }
}

/// The largest number of cells that a search goes away. The least density makes a void of that size less likely than
/// 2^-200 even in two dimensions.
const LAST_RING: i64 = 96;

/// The nearest points of a place, nearest first; at most four.
pub(crate) fn nearest<const N: usize>(
    lattice: &Lattice<N>,
    metric: Metric,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) {
    let mut ranking = Ranking::new(hits.len());
    let looseness = metric.looseness();
    let search = Search {
        lattice,
        metric,
        place,
    };
    for ring in 0..=LAST_RING {
        search.ring(ring, |shift| {
            if search.gap(shift) <= ranking.reach() * looseness {
                search.cell(shift, |hit| ranking.add(hit, Name::id));
            }
        });
        let is_empty = ranking.hits[0].name.is_none() && lattice.repeats_within(ring);
        if is_empty || ranking.reach() * looseness < search.border(ring) {
            break;
        }
    }
    hits.copy_from_slice(ranking.hits());
}

/// All points of a place whose keys are at most that of `distance`, in no particular order.
pub(crate) fn within<const N: usize>(
    lattice: &Lattice<N>,
    metric: Metric,
    place: &Place<N>,
    distance: f32,
) -> Vec<Hit<N>> {
    let mut hits = Vec::new();
    let key = metric.term(distance) * metric.looseness();
    let search = Search {
        lattice,
        metric,
        place,
    };
    for ring in 0..=LAST_RING {
        search.ring(ring, |shift| {
            if search.gap(shift) <= key {
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

/// The nearest points so far, nearest first.
pub(crate) struct Ranking<const N: usize> {
    hits: [Hit<N>; LIMIT],
    /// The number of points to find.
    len: usize,
}

impl<const N: usize> Ranking<N> {
    pub(crate) fn new(len: usize) -> Self {
        Self {
            hits: [Hit::NONE; LIMIT],
            len,
        }
    }

    pub(crate) fn hits(&self) -> &[Hit<N>] {
        &self.hits[..self.len]
    }

    /// The key from which on further points do not matter.
    #[inline]
    pub(crate) fn reach(&self) -> f32 {
        self.hits[self.len - 1].key
    }

    /// Inserts a point in its order.
    #[inline(always)]
    pub(crate) fn add(&mut self, hit: Hit<N>, id: impl Fn(Name) -> u64) {
        if hit.key <= self.reach() {
            self.insert(hit, id);
        }
    }

    fn insert(&mut self, hit: Hit<N>, id: impl Fn(Name) -> u64) {
        let mut at = self.len;
        while at > 0 && order(&hit, &self.hits[at - 1], &id).is_lt() {
            at -= 1;
        }
        if at < self.len {
            self.hits[at..self.len].rotate_right(1);
            self.hits[at] = hit;
        }
    }
}

/// The order of hits: by key, then by id; repeats of one point, by their vectors.
pub(crate) fn order<const N: usize>(a: &Hit<N>, b: &Hit<N>, id: impl Fn(Name) -> u64) -> Ordering {
    a.key.total_cmp(&b.key).then_with(|| {
        let [a_id, b_id] = [a, b].map(|hit| hit.name.map(&id));
        let parts = a.vector.iter().zip(&b.vector);
        a_id.cmp(&b_id)
            .then(parts.fold(Ordering::Equal, |order, (a, b)| order.then(b.total_cmp(a))))
    })
}

/// A search by rings.
struct Search<'a, const N: usize> {
    lattice: &'a Lattice<N>,
    metric: Metric,
    place: &'a Place<N>,
}

impl<const N: usize> Search<'_, N> {
    /// Calls `each` with the cells that are `ring` cells away along their furthest axis.
    fn ring(&self, ring: i64, mut each: impl FnMut([i64; N])) {
        let mut shift = [-ring; N];
        loop {
            if shift.iter().any(|part| part.abs() == ring) {
                each(shift);
            }
            // Advances to the next cell, the first axis fastest; inside of the ring, straight to its other side.
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

    /// Calls `each` with the points of a cell.
    #[inline(always)]
    fn cell(&self, shift: [i64; N], mut each: impl FnMut(Hit<N>)) {
        let cell = core::array::from_fn(|axis| self.place.cell[axis] + shift[axis]);
        self.lattice.visit(cell, |steps, name| {
            each(hit(self.metric, self.place, shift, steps, name));
        });
    }

    /// A lower bound of the keys of all points of a cell.
    #[inline]
    fn gap(&self, shift: [i64; N]) -> f32 {
        let mut gap = [0.0; N];
        for axis in 0..N {
            let inside = i64::from(self.place.steps[axis]);
            let near = match shift[axis] {
                0 => 0,
                1.. => shift[axis] * i64::from(STEPS) - inside,
                _ => inside - (shift[axis] + 1) * i64::from(STEPS),
            };
            gap[axis] = cells(near);
        }
        self.metric.key(gap)
    }

    /// A lower bound of the keys of all points beyond the visited rings.
    fn border(&self, ring: i64) -> f32 {
        self.metric.term(cells(border(self.place, ring)))
    }
}

/// The number of steps from a place to the cells beyond the `ring` rings around its cell.
#[inline(always)]
pub(crate) fn border<const N: usize>(place: &Place<N>, ring: i64) -> i64 {
    let sides = place.steps.map(|steps| steps.min(STEPS - steps));
    let nearest = sides.into_iter().fold(STEPS, i32::min);
    i64::from(nearest) + ring * i64::from(STEPS)
}
