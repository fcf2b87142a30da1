//! The row that is nearest to a query: exactly the one that comparing with all of them finds.

/// What [`Matcher::nearest`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The row.
    pub row: u32,
    /// Its distance: [`distance_sq`].
    pub distance_sq: f32,
}

/// Rows prepared for finding the nearest one.
#[derive(Clone, Debug)]
pub struct Matcher {
    dims: usize,
    rows: Vec<f32>,
}

/// Memory that a search works in, kept between searches.
#[derive(Clone, Debug, Default)]
pub struct MatcherMemory {}

impl Matcher {
    /// Prepares rows of `dims` numbers each, one after the other.
    #[must_use]
    pub fn new(dims: usize, rows: &[f32]) -> Self {
        Self {
            dims,
            rows: rows.to_vec(),
        }
    }

    /// The row nearest to a query; of several at one distance the first. Nothing if none is nearer than `below`.
    ///
    /// `below` is a squared distance, infinity for no limit. `hint` is a row that may be near, which saves time.
    #[must_use]
    pub fn nearest(
        &self,
        query: &[f32],
        below: f32,
        hint: Option<u32>,
        memory: &mut MatcherMemory,
    ) -> Option<Match> {
        // SKELETON: compares with all rows.
        let _ = (hint, memory);
        let mut best = None;
        let mut least = below;
        for (row, values) in (0..).zip(self.rows.chunks_exact(self.dims)) {
            let distance_sq = distance_sq(query, values);
            if distance_sq < least {
                least = distance_sq;
                best = Some(Match { row, distance_sq });
            }
        }
        best
    }
}

/// The paper's D(M, N): the sum of squared differences in `f32`, summed in the one fixed order that defines which row is nearest.
///
/// Sixteen sums, each of every sixteenth term, are added in pairs.
#[must_use]
#[inline(always)]
pub fn distance_sq(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0_f32; 16];
    for (a, b) in a.chunks(16).zip(b.chunks(16)) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += (a - b) * (a - b);
        }
    }
    let mut n = 8;
    while n > 0 {
        for lane in 0..n {
            sums[lane] += sums[lane + n];
        }
        n /= 2;
    }
    sums[0]
}
