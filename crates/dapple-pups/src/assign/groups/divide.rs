//! The division of up to 64 points into connected parts, by exhaustive search with an end.

/// How many parts are tried before the search gives up.
const TRIALS: u32 = 20_000;

/// Parts of the points that are each connected and have between `sizes[0]` and `sizes[1]` points, if such a division
/// is found.
pub(super) fn divide(
    neighbors: &[Vec<u32>],
    points: &[u32],
    sizes: [u32; 2],
) -> Option<Vec<Vec<u32>>> {
    if points.len() > 64 {
        return None;
    }
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

/// Sets of points are masks of 64 bits.
struct Search {
    adjacent: Vec<u64>,
    sizes: [u32; 2],
    trials: u32,
    parts: Vec<u64>,
}

impl Search {
    /// Whether the free points can be divided; the parts are then in `parts`.
    fn divide(&mut self, free: u64) -> bool {
        // Some part holds the first free point.
        free == 0 || self.extend(1 << free.trailing_zeros(), 0, free)
    }

    /// Whether a part that begins with `part` and has none of `banned` leads to a division.
    fn extend(&mut self, part: u64, mut banned: u64, free: u64) -> bool {
        if self.trials == 0 {
            return false;
        }
        self.trials -= 1;
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

/// The bits that are set, from the lowest.
fn bits(mask: u64) -> impl Iterator<Item = usize> {
    let next = |&mask: &u64| Some(mask & mask.wrapping_sub(1));
    core::iter::successors(Some(mask), next)
        .take_while(|&mask| mask != 0)
        .map(|mask| mask.trailing_zeros() as usize)
}
