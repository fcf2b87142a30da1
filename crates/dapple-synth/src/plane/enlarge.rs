//! Enlarges a texture in the plane by an integer factor, from a larger version of its exemplar.
//!
//! Each texture pixel near an output pixel predicts a pixel of the larger exemplar: its own source plus the offset to
//! the output pixel. Predictions are weighted by the nearness of the texture pixel, and the one with the largest sum of
//! weights is taken. So the borders between pieces are smooth, and no values are mixed.

use crate::Edges;
use crate::sites::weight;
use dapple_raster::{Raster, Wrap};

/// Radius of the weights, in texture pixels: large enough for round corners, and small enough that a single pixel
/// between others is not outvoted.
const RADIUS: f64 = 1.25;

/// A texture and its magnification, an integer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enlarged<'a> {
    pub(super) sources: &'a Raster<[u32; 2]>,
    pub(super) wrap: [Wrap; 2],
    /// Columns and rows of the exemplar before enlargement.
    pub(super) size: [i64; 2],
    pub(super) edges: Edges,
    pub(super) factor: i64,
}

impl Enlarged<'_> {
    /// Returns the pixel (column and row) of the larger exemplar that appears at a pixel of the larger texture.
    pub(super) fn source(&self, place: [u32; 2]) -> [u32; 2] {
        let place = place.map(i64::from);
        let own = place.map(|at| at / self.factor);
        let mut votes = [([0; 2], 0.0_f64); 9];
        let mut n_votes = 0;
        // Sum the weights of each distinct prediction. The pixel's own site comes first: its prediction is always
        // within the exemplar, so there is at least one.
        for [x, y] in [
            [0, 0],
            [-1, -1],
            [0, -1],
            [1, -1],
            [-1, 0],
            [1, 0],
            [-1, 1],
            [0, 1],
            [1, 1],
        ] {
            let site = [own[0] + x, own[1] + y];
            let Some(predicted) = self.predicted(site, place) else {
                continue;
            };
            // Distance between pixel centers, in pixels of the texture.
            let away = [0, 1].map(|axis| {
                let middle = (place[axis] as f64 + 0.5) / self.factor as f64 - 0.5;
                middle - site[axis] as f64
            });
            let distance = (away[0] * away[0] + away[1] * away[1]).sqrt() / RADIUS;
            let say = if distance < 1.0 {
                weight(distance)
            } else {
                0.0
            };
            match votes[..n_votes].iter_mut().find(|vote| vote.0 == predicted) {
                Some(vote) => vote.1 += say,
                None => {
                    votes[n_votes] = (predicted, say);
                    n_votes += 1;
                }
            }
        }
        // Take the prediction with the largest weight; of equal ones, the first.
        let mut best = votes[0];
        for &vote in &votes[1..n_votes] {
            if vote.1 > best.1 {
                best = vote;
            }
        }
        best.0.map(|at| at as u32)
    }

    /// Returns the larger exemplar's pixel that `site` predicts at `place`; `None` past a cut edge of the texture or of
    /// the exemplar.
    fn predicted(&self, site: [i64; 2], place: [i64; 2]) -> Option<[i64; 2]> {
        let mut at = [0; 2];
        for axis in 0..2 {
            let n = self.sources.size()[axis];
            let within = (0..i64::from(n)).contains(&site[axis]);
            if !within && self.wrap[axis] != Wrap::Repeat {
                return None;
            }
            at[axis] = site[axis].rem_euclid(i64::from(n)) as u32;
        }
        let source = self.sources.row(at[1])[at[0] as usize].map(i64::from);
        let mut predicted = [0; 2];
        for axis in 0..2 {
            let n = self.size[axis] * self.factor;
            let pixel = (source[axis] - site[axis]) * self.factor + place[axis];
            predicted[axis] = match self.edges {
                Edges::Cut if !(0..n).contains(&pixel) => return None,
                Edges::Cut => pixel,
                Edges::Wrap => pixel.rem_euclid(n),
            };
        }
        Some(predicted)
    }
}
