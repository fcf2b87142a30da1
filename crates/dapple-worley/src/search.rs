//! The nearest feature points of one position, exactly.
//!
//! Cells are visited in rings of growing size about the position's own, those of a ring that lie too far away are
//! left out, and the search ends when no cell outside can hold a nearer point. Worley visits the 26 neighbors and
//! stops ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>); that misses
//! points now and then, and more often the higher n is.
//!
//! Bounds are computed from the same exact differences, terms and joins as the keys themselves. Rounding does not
//! turn a smaller sum into a larger one, so a bound never excludes a point wrongly, and needs no margin.
//!
//! Of two points at the same distance, the one with the smaller id comes first, so that the result does not depend
//! on the order in which they were found.

use crate::fixed::{Place, STEPS, cells};
use crate::metric::Norm;
use core::cmp::Ordering;
use dapple_hash::CellHash;

/// Where feature points come from.
pub(crate) trait Source<const N: usize> {
    /// Calls `each` with the steps from the cell's lower corner and the name of every point of a cell.
    fn visit(&self, cell: [i64; N], each: impl FnMut([i32; N], Name));

    /// The id of a point.
    fn id(&self, name: Name) -> u64;
}

/// What a source knows a point by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Name {
    pub(crate) hash: CellHash,
    pub(crate) index: u32,
}

/// A point that was found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit<const N: usize> {
    pub(crate) key: f32,
    /// From the feature point to the position, in cells.
    pub(crate) vector: [f32; N],
    /// Of what was not found there is none.
    pub(crate) name: Option<Name>,
}

impl<const N: usize> Hit<N> {
    /// Nothing, infinitely far away.
    pub(crate) const NONE: Self = Self {
        key: f32::INFINITY,
        vector: [f32::INFINITY; N],
        name: None,
    };
}

/// What a place sees of a point in the cell that is `shift` cells from its own.
#[inline(always)]
pub(crate) fn hit<M: Norm, const N: usize>(
    norm: M,
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
        key: norm.key(vector),
        vector,
        name: Some(name),
    }
}

/// No search goes further than this many cells. The least density makes a void of that size less likely than 2^-200
/// even in two dimensions.
const LAST_RING: i64 = 96;

/// The `K` nearest points of a place, nearest first.
pub(crate) fn nearest<Q: Source<N>, M: Norm, const N: usize, const K: usize>(
    source: &Q,
    norm: M,
    place: Place<N>,
) -> [Hit<N>; K] {
    let mut search = Search {
        source,
        norm,
        place,
        hits: [Hit::NONE; K],
    };
    for ring in 0..=LAST_RING {
        search.ring(ring);
        if search.reach() < search.border(ring) {
            break;
        }
    }
    search.hits
}

/// A search under way.
struct Search<'a, Q, M, const N: usize, const K: usize> {
    source: &'a Q,
    norm: M,
    place: Place<N>,
    hits: [Hit<N>; K],
}

impl<Q: Source<N>, M: Norm, const N: usize, const K: usize> Search<'_, Q, M, N, K> {
    /// Visits the cells that are `ring` cells away along their furthest axis.
    fn ring(&mut self, ring: i64) {
        let mut shift = [-ring; N];
        loop {
            let on_ring = shift.iter().any(|part| part.abs() == ring);
            if on_ring && self.gap(shift) <= self.reach() {
                self.cell(shift);
            }
            // The next cell, the first axis fastest; inside of the ring, straight to its other side.
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

    /// Takes in the points of a cell.
    #[inline(always)]
    fn cell(&mut self, shift: [i64; N]) {
        let (place, source) = (self.place, self.source);
        let cell = core::array::from_fn(|axis| place.cell[axis] + shift[axis]);
        source.visit(cell, |steps, name| {
            let hit = hit(self.norm, &place, shift, steps, name);
            if hit.key <= self.hits[K - 1].key {
                self.insert(hit);
            }
        });
    }

    fn insert(&mut self, hit: Hit<N>) {
        let mut at = K;
        while at > 0 && self.order(&hit, &self.hits[at - 1]).is_lt() {
            at -= 1;
        }
        if at < K {
            self.hits[at..].rotate_right(1);
            self.hits[at] = hit;
        }
    }

    /// By key, then by id; repeats of one point, by where they lie.
    fn order(&self, a: &Hit<N>, b: &Hit<N>) -> Ordering {
        a.key.total_cmp(&b.key).then_with(|| {
            let [a_id, b_id] = [a, b].map(|hit| hit.name.map(|name| self.source.id(name)));
            let places = a.vector.iter().zip(&b.vector);
            a_id.cmp(&b_id)
                .then(places.fold(Ordering::Equal, |order, (a, b)| order.then(b.total_cmp(a))))
        })
    }

    /// A bound for the keys that still matter: that of the last hit, loosened where rounding asks for it.
    #[inline]
    fn reach(&self) -> f32 {
        self.hits[K - 1].key * M::LOOSE
    }

    /// No point of a cell has a smaller key.
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
        self.norm.key(gap)
    }

    /// No point beyond the rings visited has a smaller key.
    fn border(&self, ring: i64) -> f32 {
        self.norm
            .key_along_one_axis(cells(border(&self.place, ring)))
    }
}

/// The steps from a place to what lies beyond the `ring` rings about its cell.
#[inline(always)]
pub(crate) fn border<const N: usize>(place: &Place<N>, ring: i64) -> i64 {
    let sides = place.steps.map(|steps| steps.min(STEPS - steps));
    let nearest = sides.into_iter().fold(STEPS, i32::min);
    i64::from(nearest) + ring * i64::from(STEPS)
}
