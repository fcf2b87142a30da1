//! Divides up to 64 points into connected groups, by a backtracking search with a limited number of steps.

/// Maximum number of steps of the search. Each step tries one candidate group.
const TRIALS: u32 = 20_000;

/// Divides points into connected groups of `sizes[0]` to `sizes[1]` points. Returns `None` if no division is found.
pub(super) fn divide(
    neighbors: &[Vec<u32>],
    points: &[u32],
    sizes: [u32; 2],
) -> Option<Vec<Vec<u32>>> {
    if points.len() > 64 {
        return None;
    }
    // Represent the points by bits, and the neighbors of each by a mask.
    let bit = |point: &u32| points.iter().position(|other| other == point);
    let adjacent = |&point: &u32| {
        let bits = neighbors[point as usize].iter().filter_map(bit);
        bits.fold(0, |mask, bit| mask | 1 << bit)
    };
    let mut search = Search {
        adjacent: points.iter().map(adjacent).collect(),
        sizes,
        trials: TRIALS,
        parts: Vec::new(),
    };
    let all = u64::MAX >> (64 - points.len());
    let members = |part: &u64| bits(*part).map(|bit| points[bit]).collect();
    search
        .divide(all)
        .then(|| search.parts.iter().map(members).collect())
}

/// Backtracking search. Sets of points are bit masks.
struct Search {
    adjacent: Vec<u64>,
    sizes: [u32; 2],
    trials: u32,
    parts: Vec<u64>,
}

impl Search {
    /// Returns whether the points of the mask `free` can be divided. If so, the groups are appended to `parts`.
    fn divide(&mut self, free: u64) -> bool {
        // Some group contains the first free point.
        free == 0 || self.extend(1 << free.trailing_zeros(), 0, free)
    }

    /// Returns whether the free points can be divided such that one group contains the points of `part` and none of
    /// `banned`. All are masks.
    fn extend(&mut self, part: u64, mut banned: u64, free: u64) -> bool {
        if self.trials == 0 {
            return false;
        }
        self.trials -= 1;
        // If the group is large enough, divide the remaining points.
        let size = part.count_ones();
        if size >= self.sizes[0] {
            self.parts.push(part);
            if self.divide(free & !part) {
                return true;
            }
            self.parts.pop();
        }
        if size == self.sizes[1] {
            return false;
        }
        // Extend the group by one adjacent point. Exclude each point after its trial, so that every group is tried once.
        let around = bits(part).fold(0, |mask, bit| mask | self.adjacent[bit]);
        for bit in bits(around & free & !part & !banned) {
            if self.extend(part | 1 << bit, banned, free) {
                return true;
            }
            banned |= 1 << bit;
        }
        false
    }
}

/// Iterates over the indices of the set bits, from the lowest.
fn bits(mask: u64) -> impl Iterator<Item = usize> {
    let next = |&mask: &u64| Some(mask & mask.wrapping_sub(1));
    core::iter::successors(Some(mask), next)
        .take_while(|&mask| mask != 0)
        .map(|mask| mask.trailing_zeros() as usize)
}
