//! Periodograms at integer frequencies.
//!
//! Each frequency needs the sum of exp(i(a ± b)) over the points, where a and b are a point's phases along x and y.
//! Four products of the sines and cosines of a and b give both signs, so that one pass over the points computes two
//! frequencies. The sines and cosines of multiples come from complex multiplication.

use crate::{IsCancelled, PointSet};
use core::f64::consts::TAU;
use dapple_raster::parallel;

/// Number of points per block: its tables stay in the second-level cache for the usual thousands of points.
const BLOCK: usize = 256;

/// Number of parallel sums in vector registers; the order of summation affects the values.
const LANES: usize = 8;

/// Accumulated power of point sets at the frequencies `[x, y]` with `0 <= x <= counts[0]` and `|y| <= counts[1]`.
#[derive(Debug)]
pub(super) struct Periodogram {
    counts: [u32; 2],
    /// Power at `[x, y]` and at `[x, -y]`, ordered by x, then by y starting at 0.
    powers: Vec<[f64; 2]>,
}

/// Sums over the points of cos a cos b, sin a sin b, sin a cos b and cos a sin b, where a and b are a point's phases
/// along x and y.
type Products = [f64; 4];

/// Cosines and sines of multiples of the points' phases along an axis. Each multiple has a row, padded with zeros to
/// whole lanes.
struct Multiples {
    cos: Vec<[f64; LANES]>,
    sin: Vec<[f64; LANES]>,
    per_row: usize,
}

impl Periodogram {
    pub(super) fn new(counts: [u32; 2]) -> Self {
        let [columns, rows] = counts.map(|count| count as usize + 1);
        Self {
            counts,
            powers: vec![[0.0; 2]; columns * rows],
        }
    }

    /// Adds the power of a nonempty set. The result is incomplete if `is_cancelled` returns true.
    pub(super) fn add(&mut self, set: &PointSet, is_cancelled: &IsCancelled) {
        let mut sums = vec![Products::default(); self.powers.len()];
        let n_rows = self.counts[1] as usize + 1;
        for block in set.positions().chunks(BLOCK) {
            if is_cancelled() {
                return;
            }
            let [xs, ys] = [0, 1].map(|axis| {
                let (origin, size) = (set.domain().origin[axis], set.domain().size[axis]);
                let angles = block.iter().map(|at| TAU * ((at[axis] - origin) / size));
                Multiples::new(angles, self.counts[axis])
            });
            parallel::for_each_chunk(&mut sums, n_rows, |x, sums| {
                if is_cancelled() {
                    return;
                }
                for (y, sums) in sums.iter_mut().enumerate() {
                    let products = xs.products(x, &ys, y);
                    for (sum, product) in sums.iter_mut().zip(products) {
                        *sum += product;
                    }
                }
            });
        }
        let n_points = set.len() as f64;
        for (power, [cc, ss, sc, cs]) in self.powers.iter_mut().zip(sums) {
            let plus = (cc - ss) * (cc - ss) + (sc + cs) * (sc + cs);
            let minus = (cc + ss) * (cc + ss) + (sc - cs) * (sc - cs);
            power[0] += plus / n_points;
            power[1] += minus / n_points;
        }
    }

    /// Calls `visit` with each frequency except `[0, 0]` and its power; only one of f and -f is visited.
    pub(super) fn for_each(&self, mut visit: impl FnMut([i32; 2], f64)) {
        let n_rows = self.counts[1] as usize + 1;
        for (x, column) in (0..).zip(self.powers.chunks(n_rows)) {
            for (y, &[plus, minus]) in (0..).zip(column) {
                if [x, y] != [0, 0] {
                    visit([x, y], plus);
                }
                if x > 0 && y > 0 {
                    visit([x, -y], minus);
                }
            }
        }
    }
}

impl Multiples {
    fn new(angles: impl ExactSizeIterator<Item = f64>, count: u32) -> Self {
        let n_points = angles.len();
        let per_row = n_points.div_ceil(LANES);
        let n_multiples = count as usize + 1;
        let mut multiples = Self {
            cos: vec![[0.0; LANES]; per_row * n_multiples],
            sin: vec![[0.0; LANES]; per_row * n_multiples],
            per_row,
        };
        for (point, angle) in angles.enumerate() {
            let (step_sin, step_cos) = libm::sincos(angle);
            let (mut cos, mut sin) = (1.0, 0.0);
            for multiple in 0..n_multiples {
                let at = multiple * per_row + point / LANES;
                multiples.cos[at][point % LANES] = cos;
                multiples.sin[at][point % LANES] = sin;
                (cos, sin) = (
                    cos * step_cos - sin * step_sin,
                    sin * step_cos + cos * step_sin,
                );
            }
        }
        multiples
    }

    /// Returns the sums over the points of the products for multiple `a` of these phases and multiple `b` of the
    /// phases along the other axis.
    fn products(&self, a: usize, others: &Self, b: usize) -> Products {
        let [a, b] = [a, b].map(|multiple| multiple * self.per_row..(multiple + 1) * self.per_row);
        let mut sums = [[0.0; LANES]; 4];
        let these = self.cos[a.clone()].iter().zip(&self.sin[a]);
        let those = others.cos[b.clone()].iter().zip(&others.sin[b]);
        for ((cos_a, sin_a), (cos_b, sin_b)) in these.zip(those) {
            for lane in 0..LANES {
                sums[0][lane] += cos_a[lane] * cos_b[lane];
                sums[1][lane] += sin_a[lane] * sin_b[lane];
                sums[2][lane] += sin_a[lane] * cos_b[lane];
                sums[3][lane] += cos_a[lane] * sin_b[lane];
            }
        }
        sums.map(|lanes| lanes.iter().sum())
    }
}
