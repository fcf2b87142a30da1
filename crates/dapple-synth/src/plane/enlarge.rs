//! The pixels of a larger version of the exemplar for a texture in the plane that is as much larger.
//!
//! Every pixel of the texture near a place predicts a pixel of the larger exemplar: its own source, and from there the way
//! to the place. The one that most of them predict is taken, those nearer counting more: so the borders between pieces
//! are smooth, and nothing is mixed.

use crate::Edges;
use crate::sites::weight;
use dapple_raster::{Raster, Wrap};

/// How far pixels have a say, in pixels: so far that corners are round, and not so far that a pixel alone among others is
/// outvoted.
const RADIUS: f64 = 1.25;

/// A texture, and how many times as large it is to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enlarged<'a> {
    pub(super) sources: &'a Raster<[u32; 2]>,
    pub(super) wrap: [Wrap; 2],
    /// Columns and rows of the exemplar.
    pub(super) size: [i64; 2],
    pub(super) edges: Edges,
    pub(super) factor: i64,
}

impl Enlarged<'_> {
    /// The column and row in the larger exemplar of the pixel at a place of the larger texture.
    pub(super) fn source(&self, place: [u32; 2]) -> [u32; 2] {
        let place = place.map(i64::from);
        let own = place.map(|at| at / self.factor);
        let mut votes = [([0; 2], 0.0_f64); 9];
        let mut n_votes = 0;
        // The own pixel is first, and its prediction is within the exemplar.
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
            // Distances in pixels of the texture between middles.
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
        let mut best = votes[0];
        for &vote in &votes[1..n_votes] {
            if vote.1 > best.1 {
                best = vote;
            }
        }
        best.0.map(|at| at as u32)
    }

    /// The pixel that a site predicts for a place; none past the edges of the texture or of the exemplar.
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
