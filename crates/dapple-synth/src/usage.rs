//! How often the pixels of the exemplar were used, and what that costs them.
//!
//! Where the least distance alone decides, a few pixels are used again and again: those that are like everything a
//! little. Colors that are rare in the exemplar vanish. The remedy here is a penalty on what was used, as Kaspar,
//! Neubert, Lischinski, Pauly and Kopf have it for patches ("Self Tuning Texture Optimization", Computer Graphics Forum
//! 34, 2015). Here it is one factor for each pixel: its squared distances are multiplied by 1, and by as much more as
//! [`Options::evenness`](crate::Options::evenness) says for the uses around it.
//!
//! A use is spread over [`REACH`] pixels to all sides. Where only the pixel itself cost more, its neighbors would not,
//! and the texture would rather break off in the middle of a brick than go on with a pixel that was used once more than
//! others.
//!
//! Usage depends on all sites before, so such a pass goes one site after the other on one thread. Only passes that
//! read no coarser level count, those of the coarsest level in the paper's schedule: the finer levels follow it.

use crate::Candidates;

/// How many pixels a use reaches to all sides.
const REACH: i32 = 1;

/// The pixels that a use is spread over.
const N_PIXELS: i32 = (2 * REACH + 1) * (2 * REACH + 1);

/// The uses around the pixel of each row, and its factor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Usage {
    /// The increment of a factor for one use within reach.
    cost: f64,
    counts: Vec<u32>,
    /// At least 1 each; empty if nothing is counted.
    factors: Vec<f32>,
}

impl Usage {
    /// Counts without any use. `evenness` is the cost if all pixels were used equally often by `n_sites` sites.
    pub(crate) fn new(evenness: f32, n_rows: usize, n_sites: usize) -> Self {
        if evenness == 0.0 {
            return Self::default();
        }
        let n_uses = f64::from(N_PIXELS) * n_sites.max(1) as f64 / n_rows as f64;
        Self {
            cost: f64::from(evenness) / n_uses,
            counts: vec![0; n_rows],
            factors: vec![1.0; n_rows],
        }
    }

    /// By how much the squared distances of the rows are multiplied, at least 1; none if nothing is counted.
    pub(crate) fn factors(&self) -> Option<&[f32]> {
        (!self.factors.is_empty()).then_some(&self.factors)
    }

    /// Counts a use of a row for all pixels within reach of its pixel; what is no row does not count.
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

    /// The candidates of the first pass, for an image of 8 × 8 pixels.
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
            // The pixel in column 0 of row 5, and what is no row.
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
