//! Runs the halving filter and prefilters, which are a short sum followed by recursions, on several lines in SIMD
//! lanes.
//!
//! A recursion depends on the values before the first one. The lines are therefore extended beyond their ends, far
//! enough that starting with zero influences a result by less than its last bit. This rule covers periodic and
//! mirrored lines of any length. For a periodic line it equals, up to rounding, the usual initial value
//! `s / (1 − pⁿ)`, where `p` is the pole, `n` the length and `s` the result of one period that starts with zero.
//!
//! All arithmetic is `f64`, with the same operations in the same order for every lane. The bits of a line do not
//! depend on the lines in other lanes.

use crate::ends::{Halving, Line};
use crate::kernel::Kernel;
use crate::{Border, SplineFilter, WaveletError};

/// A filter that maps a line to a line of the same or half the length.
#[derive(Clone, Debug)]
pub(crate) struct LineFilter {
    kernel: Kernel,
    pub(crate) source: Line,
    pub(crate) target: Line,
    /// Number of source values per target value: 1 or 2.
    step: usize,
    /// Source index of the first tap of the first target value.
    start: i64,
    /// Length of the target's extension at each end, in values. There the recursions forget their initial value.
    reach: usize,
}

/// Scratch memory for filtering `L` lines in SIMD lanes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lanes<const L: usize> {
    source: Vec<[f64; L]>,
    target: Vec<[f64; L]>,
}

impl LineFilter {
    /// Creates the filter of equation 7 for lines of length `len`.
    pub(crate) fn halving(
        filter: SplineFilter,
        len: usize,
        border: Border,
    ) -> Result<Self, WaveletError> {
        let halving = Halving::new(filter, len, border)?;
        let kernel = Kernel::halving(filter);
        Ok(Self {
            start: kernel.first + 2 * halving.offset,
            source: halving.fine,
            target: halving.coarse,
            step: 2,
            reach: kernel.reach(),
            kernel,
        })
    }

    /// Creates a filter whose target is as long as its source.
    pub(crate) fn in_place(kernel: Kernel, line: Line) -> Self {
        Self {
            start: kernel.first,
            source: line,
            target: line,
            step: 1,
            reach: kernel.reach(),
            kernel,
        }
    }

    /// Filters `L` lines. `load` writes their values into a slice of the source's length.
    #[inline(always)]
    pub(crate) fn run<'lanes, const L: usize>(
        &self,
        lanes: &'lanes mut Lanes<L>,
        load: impl FnOnce(&mut [[f64; L]]),
    ) -> &'lanes [[f64; L]] {
        let Lanes { source, target } = lanes;
        // Extend the source by the reach of the taps.
        let end = self.start + (self.step * (self.target.len - 1) + self.kernel.taps.len()) as i64;
        let before = (-self.start).max(0) as usize;
        let after = (end - self.source.len as i64).max(0) as usize;
        source.resize(before + self.source.len + after, [0.0; L]);
        load(&mut source[before..before + self.source.len]);
        go_on(&self.source, source, before);

        // Compute the weighted sums, and extend them by the reach of the recursions.
        let kept = self.reach..self.reach + self.target.len;
        target.resize(self.target.len + 2 * self.reach, [0.0; L]);
        let first = (before as i64 + self.start) as usize;
        weigh(
            &self.kernel.taps,
            &source[first..],
            self.step,
            &mut target[kept.clone()],
        );
        go_on(&self.target, target, self.reach);
        // Run the recursions of all poles in one pass.
        match *self.kernel.poles {
            [p] => recur([p], target),
            [p, q] => recur([p, q], target),
            [p, q, r] => recur([p, q, r], target),
            ref poles => {
                for &pole in poles {
                    recur([pole], target);
                }
            }
        }
        &target[kept]
    }
}

/// Fills both ends of `values` with the extension of a line, whose first value is at index `before`.
#[inline(always)]
fn go_on<const L: usize>(line: &Line, values: &mut [[f64; L]], before: usize) {
    let after = before + line.len..values.len();
    for place in (0..before).chain(after) {
        values[place] = values[before + line.index(place as i64 - before as i64)];
    }
}

/// Computes each target value as the sum of symmetric `taps` times consecutive source values, `step` source values
/// apart.
#[inline(always)]
fn weigh<const L: usize>(taps: &[f64], source: &[[f64; L]], step: usize, target: &mut [[f64; L]]) {
    // The filter of the paper has eight taps, which then stay in registers.
    match <&[f64; 8]>::try_from(taps) {
        Ok(taps) => weigh_by(taps, source, step, target),
        Err(_) => weigh_by(taps, source, step, target),
    }
}

#[inline(always)]
fn weigh_by<const L: usize>(
    taps: &[f64],
    source: &[[f64; L]],
    step: usize,
    target: &mut [[f64; L]],
) {
    let (half, middle) = (taps.len() / 2, taps.len() % 2 == 1);
    for (values, target) in source.windows(taps.len()).step_by(step).zip(target) {
        let mut sum = [0.0; L];
        for (tap, weight) in taps[..half].iter().enumerate() {
            let (a, b) = (&values[tap], &values[taps.len() - 1 - tap]);
            for lane in 0..L {
                sum[lane] += weight * (a[lane] + b[lane]);
            }
        }
        if middle {
            for lane in 0..L {
                sum[lane] += taps[half] * values[half][lane];
            }
        }
        *target = sum;
    }
}

/// Runs the recursions of all poles over the lines, forward and then backward.
#[inline(always)]
fn recur<const L: usize, const P: usize>(poles: [f64; P], lines: &mut [[f64; L]]) {
    sweep(poles, lines.iter_mut());
    sweep(poles, lines.iter_mut().rev());
}

/// Runs first-order recursions: for each pole in turn, adds to each value the pole times the previous result.
#[inline(always)]
fn sweep<'lines, const L: usize, const P: usize>(
    poles: [f64; P],
    lines: impl Iterator<Item = &'lines mut [f64; L]>,
) {
    let mut last = [[0.0; L]; P];
    for values in lines {
        for (last, pole) in last.iter_mut().zip(poles) {
            for (value, last) in values.iter_mut().zip(&*last) {
                *value += pole * last;
            }
            *last = *values;
        }
    }
}
