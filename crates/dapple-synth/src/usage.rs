//! Penalizes pixels of the exemplar that were used often.
//!
//! If distance alone decides, a few pixels that are moderately similar to everything are used again and
//! again, and rare colors of the exemplar vanish. So usage is penalized, as Kaspar, Neubert, Lischinski, Pauly and Kopf
//! do for patches ("Self Tuning Texture Optimization", Computer Graphics Forum 34, 2015). Here each pixel has a factor
//! for its squared distances: 1 plus a cost per use, which [`Options::evenness`](crate::Options::evenness) determines.
//!
//! A use counts for all pixels within [`REACH`] pixels along each axis. If it counted for the pixel alone, its
//! neighbors would cost less. The texture would then break off in the middle of a brick instead of continuing with a
//! pixel that was used once more than others.
//!
//! Usage depends on all earlier sites, so a pass that counts it is sequential. Only passes that do not read a coarser
//! level count usage. In the paper's schedule this is the pass over the coarsest level, which the finer levels follow.

use crate::Candidates;

/// Distance along each axis, in pixels, within which a use counts.
const REACH: i32 = 1;

/// Number of pixels for which a use counts.
const N_PIXELS: i32 = (2 * REACH + 1) * (2 * REACH + 1);

/// Number of uses near each row's pixel, and the row's factor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Usage {
    /// Increment of a factor per use within reach.
    cost: f64,
    counts: Vec<u32>,
    /// Factor of each row, at least 1; empty if usage is not counted.
    factors: Vec<f32>,
}

impl Usage {
    /// Creates the state before any use. `evenness` is the cost of a pixel if `n_sites` sites use all pixels equally
    /// often.
    pub(crate) fn new(evenness: f32, n_rows: usize, n_sites: usize) -> Self {
        if evenness == 0.0 {
            return Self::default();
        }
        // Mean number of uses of a row. At this number, the factor is 1 + evenness.
        let n_uses = f64::from(N_PIXELS) * n_sites.max(1) as f64 / n_rows as f64;
        Self {
            cost: f64::from(evenness) / n_uses,
            counts: vec![0; n_rows],
            factors: vec![1.0; n_rows],
        }
    }

    /// Returns the factors on the squared distances of the rows, at least 1; `None` if usage is not counted.
    pub(crate) fn factors(&self) -> Option<&[f32]> {
        (!self.factors.is_empty()).then_some(&self.factors)
    }

    /// Counts a use of a row for all pixels within reach of the row's pixel. A value that is not the index of a row is
    /// ignored.
    pub(crate) fn add(&mut self, row: u32, candidates: &Candidates) {
        if row as usize >= self.counts.len() {
            return;
        }
        let pixel = candidates.pixels[row as usize];
        for j in -REACH..=REACH {
            for i in -REACH..=REACH {
                if let Some(row) = candidates.row_beside(pixel, [i, j]) {
                    let row = row as usize;
                    self.counts[row] = self.counts[row].saturating_add(1);
                    self.factors[row] = (1.0 + self.cost * f64::from(self.counts[row])) as f32;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Usage;
    use crate::{Candidates, CoarserCenter, Edges, Exemplar, Schedule};
    use dapple_raster::Raster;

    /// Returns the candidates of the first pass, for an image of 8 × 8 pixels.
    fn candidates(edges: Edges) -> Candidates {
        let plane = Raster::filled([8, 8], 0.5).unwrap();
        let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], edges).unwrap();
        let pass = &Schedule::paper(1).passes[0];
        Candidates::new(&exemplar.pyramid(1).unwrap(), pass, CoarserCenter::Exact).unwrap()
    }

    #[test]
    fn factors_grow_by_the_evenness_when_all_pixels_are_used() {
        // Where the exemplar wraps, each pixel has 9 within reach; 192 sites use each of 64 three times.
        let candidates = candidates(Edges::Wrap);
        let mut usage = Usage::new(0.75, 64, 192);
        assert_eq!(usage.factors(), Some(&[1.0; 64][..]), "nothing is used");
        for site in 0..192 {
            usage.add(site % 64, &candidates);
        }
        assert_eq!(usage.factors(), Some(&[1.75; 64][..]), "all are used");
    }

    #[test]
    fn a_use_costs_the_pixels_within_reach() {
        for edges in [Edges::Wrap, Edges::Cut] {
            let candidates = candidates(edges);
            let mut usage = Usage::new(1.0, 64, 64);
            // Use the pixel in column 0 of row 5, and then an index that is not a row.
            usage.add(40, &candidates);
            usage.add(u32::MAX, &candidates);
            let factors = usage.factors().unwrap();
            for (at, &factor) in (0..).zip(factors) {
                let [x, y]: [i32; 2] = [at % 8, at / 8];
                let near_x = x <= 1 || (edges == Edges::Wrap && x == 7);
                let is_near = near_x && (4..7).contains(&y);
                let expected = if is_near { 1.0 + 1.0 / 9.0 } else { 1.0 };
                assert_eq!(factor, expected, "{edges:?} {x} {y}");
            }
        }
    }

    #[test]
    fn nothing_is_counted_without_a_penalty() {
        let mut usage = Usage::new(0.0, 64, 12);
        usage.add(3, &candidates(Edges::Cut));
        assert_eq!(usage.factors(), None, "no factors");
    }

    #[test]
    fn no_sites_and_no_rows_are_no_division_by_zero() {
        let none = Usage::new(1.0, 2, 0);
        assert_eq!(none.factors(), Some(&[1.0; 2][..]), "no sites");
        let mut usage = Usage::new(1.0, 0, 5);
        usage.add(0, &candidates(Edges::Cut));
        assert_eq!(usage.factors(), None, "no rows");
    }
}
