//! Halves and doubles rasters by plain convolution: 32 taps, applied one at a time, in `f32`.
//!
//! The taps are the first 16 of the exact filter on either side; the rest sums to less than 1e-3. The code is simple,
//! but not deliberately slow: rows are split into even and odd pixels with a margin, so that no index wraps in a loop.
//! Each tap is added to a whole row at a time, which the compiler turns into vector code.

/// Number of taps on either side.
const HALF: usize = 16;

/// A filter pair with its buffers.
#[derive(Clone, Debug)]
pub(crate) struct Straight {
    side: usize,
    /// The filter's taps. Tap `k` applies to the pixels `k + 1` and `-k`, since the filter is symmetric about the
    /// midpoint between two pixels.
    taps: [f32; HALF],
    even: Vec<f32>,
    odd: Vec<f32>,
    /// Raster halved along x only.
    narrow: Vec<f32>,
    coarse: Vec<f32>,
    tall: Vec<f32>,
    /// Result of the last run.
    pub(crate) fine: Vec<f32>,
}

impl Straight {
    /// Returns the filters for a raster of `side`×`side` pixels.
    pub(crate) fn new(side: usize) -> Self {
        let half = side / 2;
        Self {
            side,
            taps: taps(),
            even: vec![0.0; half + 2 * HALF],
            odd: vec![0.0; half + 2 * HALF],
            narrow: vec![0.0; side * half],
            coarse: vec![0.0; half * half],
            tall: vec![0.0; side * half],
            fine: vec![0.0; side * side],
        }
    }

    /// Halves a raster and doubles it again.
    pub(crate) fn run(&mut self, raster: &[f32]) {
        self.down_rows(raster);
        self.down_columns();
        self.up_columns();
        self.up_rows();
    }

    fn down_rows(&mut self, raster: &[f32]) {
        let half = self.side / 2;
        for (row, out) in raster
            .chunks_exact(self.side)
            .zip(self.narrow.chunks_exact_mut(half))
        {
            for (j, pair) in row.chunks_exact(2).enumerate() {
                self.even[j + HALF] = pair[0];
                self.odd[j + HALF] = pair[1];
            }
            for line in [&mut self.even, &mut self.odd] {
                line.copy_within(half..half + HALF, 0);
                line.copy_within(HALF..2 * HALF, half + HALF);
            }
            out.fill(0.0);
            // Pixel 2j + k + 1 and pixel 2j − k have the same tap.
            for (k, &tap) in self.taps.iter().enumerate() {
                let (after, before) = if k % 2 == 0 {
                    (&self.odd[HALF + k / 2..], &self.even[HALF - k / 2..])
                } else {
                    (
                        &self.even[HALF + k.div_ceil(2)..],
                        &self.odd[HALF - k.div_ceil(2)..],
                    )
                };
                add_pairs(out, after, before, tap);
            }
        }
    }

    fn down_columns(&mut self) {
        let (side, half) = (self.side, self.side / 2);
        for (j, out) in self.coarse.chunks_exact_mut(half).enumerate() {
            out.fill(0.0);
            for (k, &tap) in self.taps.iter().enumerate() {
                let after = (2 * j + k + 1) % side * half;
                let before = (2 * j + side - k) % side * half;
                let [after, before] = [after, before].map(|at| &self.narrow[at..at + half]);
                add_pairs(out, after, before, tap);
            }
        }
    }

    fn up_columns(&mut self) {
        let half = self.side / 2;
        let row = |j: usize| &self.coarse[j % half * half..][..half];
        for (j, pair) in self.tall.chunks_exact_mut(2 * half).enumerate() {
            let (top, bottom) = pair.split_at_mut(half);
            let [above, here, below] = [row(j + half - 1), row(j), row(j + 1)];
            for i in 0..half {
                top[i] = 0.25 * above[i] + 0.75 * here[i];
                bottom[i] = 0.75 * here[i] + 0.25 * below[i];
            }
        }
    }

    fn up_rows(&mut self) {
        let half = self.side / 2;
        for (coarse, fine) in self
            .tall
            .chunks_exact(half)
            .zip(self.fine.chunks_exact_mut(self.side))
        {
            for (j, pair) in fine.chunks_exact_mut(2).enumerate() {
                let left = coarse[if j == 0 { half - 1 } else { j - 1 }];
                let right = coarse[if j + 1 == half { 0 } else { j + 1 }];
                pair[0] = 0.25 * left + 0.75 * coarse[j];
                pair[1] = 0.75 * coarse[j] + 0.25 * right;
            }
        }
    }
}

/// Adds `tap * (after + before)` to the row `out`.
fn add_pairs(out: &mut [f32], after: &[f32], before: &[f32], tap: f32) {
    for ((out, after), before) in out.iter_mut().zip(after).zip(before) {
        *out += tap * (after + before);
    }
}

/// Returns the taps of pixels 1 to 16: the inverse Gram filter, convolved with the kernel `q`.
fn taps() -> [f32; HALF] {
    // `g` is the inverse of the Gram matrix, which has two poles.
    let inverse = |n: i32| {
        let pole =
            |scale: f64, pole: f64| (0..n.abs()).fold(scale, |product: f64, _| product * pole);
        pole(3.094_986_498_686_653_5, -0.430_575_347_099_973_8)
            + pole(-0.252_815_576_665_031, -0.043_096_288_203_264_65)
    };
    let q = [1.0, 29.0, 147.0, 303.0, 303.0, 147.0, 29.0, 1.0].map(|q: f64| q / 960.0);
    std::array::from_fn(|index| {
        let k = index as i32 + 1;
        // `q` starts three pixels before pixel 2j.
        let terms = (-40..=40).filter_map(|n| {
            let at = usize::try_from(k - 2 * n + 3).ok()?;
            Some(inverse(n) * q.get(at)?)
        });
        terms.sum::<f64>() as f32
    })
}

#[cfg(test)]
mod tests {
    use super::{Straight, taps};

    #[test]
    fn taps_are_those_of_the_exact_filter() {
        for (tap, expected) in
            taps()
                .into_iter()
                .zip([0.6553403417, 0.0339789750, -0.2437804297, -0.0259359777])
        {
            // The expected taps have ten digits; `f32` has seven.
            assert!(
                (f64::from(tap) - expected).abs() < 1e-7,
                "{tap} and not {expected}"
            );
        }
    }

    #[test]
    fn a_constant_is_kept_up_to_the_taps_that_are_left_out() {
        let mut straight = Straight::new(64);
        straight.run(&[1.0; 64 * 64]);
        // The taps after the first 16 sum to less than 1e-3 on either side and axis.
        assert!(
            straight.fine.iter().all(|value| (value - 1.0).abs() < 4e-3),
            "a flat picture stays flat"
        );
    }
}
