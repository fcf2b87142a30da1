//! Transforms lengths with small prime factors only, by one pass over all lines for each factor.

use super::{BAND, Element, LANES, turn};

/// Radices, in the order in which they are divided out of a length.
const RADICES: [usize; 5] = [4, 2, 3, 5, 7];

/// A pass, which splits transforms into `radix` times as many transforms of 1/`radix` of the length.
///
/// Before the pass there are `stride` interleaved transforms of `radix * blocks` elements.
#[derive(Debug)]
pub(super) struct Pass {
    radix: usize,
    blocks: usize,
    stride: usize,
    /// Twiddle factors for the butterfly's outputs, by block and output, as cosine and sine.
    twiddles: Vec<[f64; 2]>,
    /// Roots of unity `exp(−2πi j/radix)`.
    roots: Vec<[f64; 2]>,
}

/// Returns the passes for a length; `None` if it has a prime factor other than 2, 3, 5 and 7.
pub(super) fn plan(length: usize) -> Option<Vec<Pass>> {
    let mut passes = Vec::new();
    let mut rest = length;
    // Divide out the radices. The number of transforms before a pass is its stride.
    for radix in RADICES {
        while rest.is_multiple_of(radix) {
            passes.push(Pass::new(radix, rest, length / rest));
            rest /= radix;
        }
    }
    (rest == 1).then_some(passes)
}

/// Transforms all lines, in place.
pub(super) fn run(passes: &[Pass], lines: &mut Vec<Element>) {
    // Passes alternate between two buffers.
    let mut other = vec![[0.0; BAND]; lines.len()];
    for pass in passes {
        match pass.radix {
            4 => pass.run(lines, &mut other, butterfly4),
            2 => pass.run(lines, &mut other, butterfly2),
            3 => pass.run(lines, &mut other, butterfly_odd::<3>),
            5 => pass.run(lines, &mut other, butterfly_odd::<5>),
            _ => pass.run(lines, &mut other, butterfly_odd::<7>),
        }
        core::mem::swap(lines, &mut other);
    }
}

/// Real and imaginary parts of a small transform's elements.
type Parts<const R: usize> = ([f64; R], [f64; R]);

impl Pass {
    fn new(radix: usize, length: usize, stride: usize) -> Self {
        let blocks = length / radix;
        // The twiddle factor of output j in block b is exp(−2πi bj/length).
        let outputs = |block| (0..radix).map(move |output| (block * output) as u64);
        Self {
            radix,
            blocks,
            stride,
            twiddles: (0..blocks)
                .flat_map(outputs)
                .map(|step| turn(step, length as u64))
                .collect(),
            roots: (0..radix as u64)
                .map(|step| turn(step, radix as u64))
                .collect(),
        }
    }

    /// Applies the butterfly of radix `R` to all elements.
    #[inline(always)]
    fn run<const R: usize>(
        &self,
        from: &[Element],
        to: &mut [Element],
        butterfly: impl Fn(Parts<R>, &[[f64; 2]; R]) -> Parts<R>,
    ) {
        let roots: [[f64; 2]; R] = core::array::from_fn(|j| self.roots[j]);
        // The inputs of a butterfly are this far apart.
        let step = self.blocks * self.stride;
        for (block, to) in to.chunks_exact_mut(R * self.stride).enumerate() {
            let twiddles: [[f64; 2]; R] = core::array::from_fn(|j| self.twiddles[block * R + j]);
            // All transforms share the twiddle factors of the block.
            for at in 0..self.stride {
                let first = block * self.stride + at;
                let inputs: [&Element; R] = core::array::from_fn(|j| &from[first + j * step]);
                let mut outputs = [[0.0; BAND]; R];
                // Apply the butterfly to all lines, and multiply its outputs by the twiddle factors.
                for lane in 0..LANES {
                    let re = core::array::from_fn(|j| inputs[j][lane]);
                    let im = core::array::from_fn(|j| inputs[j][LANES + lane]);
                    let (re, im) = butterfly((re, im), &roots);
                    for j in 0..R {
                        let [cos, sin] = twiddles[j];
                        outputs[j][lane] = re[j] * cos - im[j] * sin;
                        outputs[j][LANES + lane] = re[j] * sin + im[j] * cos;
                    }
                }
                // Store the outputs one stride apart, which leaves the result in its natural order.
                for j in 0..R {
                    to[at + j * self.stride] = outputs[j];
                }
            }
        }
    }
}

/// Transforms two elements.
#[inline(always)]
fn butterfly2((re, im): Parts<2>, _: &[[f64; 2]; 2]) -> Parts<2> {
    (
        [re[0] + re[1], re[0] - re[1]],
        [im[0] + im[1], im[0] - im[1]],
    )
}

/// Transforms four elements.
#[inline(always)]
fn butterfly4((re, im): Parts<4>, _: &[[f64; 2]; 4]) -> Parts<4> {
    // Transform the elements with even indices and those with odd indices, then combine both.
    let even_re = [re[0] + re[2], re[0] - re[2]];
    let even_im = [im[0] + im[2], im[0] - im[2]];
    // The difference of the odd elements is multiplied by −i, the first root.
    let odd_re = [re[1] + re[3], im[1] - im[3]];
    let odd_im = [im[1] + im[3], re[3] - re[1]];
    let join = |even: [f64; 2], odd: [f64; 2]| {
        [
            even[0] + odd[0],
            even[1] + odd[1],
            even[0] - odd[0],
            even[1] - odd[1],
        ]
    };
    (join(even_re, odd_re), join(even_im, odd_im))
}

/// Transforms an odd number of elements. Outputs `j` and `R − j` share their sums.
#[inline(always)]
fn butterfly_odd<const R: usize>((re, im): Parts<R>, roots: &[[f64; 2]; R]) -> Parts<R> {
    let mut out = ([0.0; R], [0.0; R]);
    // Output 0 is the sum of all elements.
    out.0[0] = re[0];
    out.1[0] = im[0];
    for l in 1..=R / 2 {
        out.0[0] += re[l] + re[R - l];
        out.1[0] += im[l] + im[R - l];
    }
    for j in 1..=R / 2 {
        // Multiply sums of the elements l and R − l by cosines, and their differences by sines.
        let mut cosines = [re[0], im[0]];
        let mut sines = [0.0, 0.0];
        for l in 1..=R / 2 {
            let [cos, sin] = roots[(j * l) % R];
            cosines[0] += (re[l] + re[R - l]) * cos;
            cosines[1] += (im[l] + im[R - l]) * cos;
            sines[0] += (re[l] - re[R - l]) * sin;
            sines[1] += (im[l] - im[R - l]) * sin;
        }
        // Output j adds i times the sines, output R − j subtracts them.
        out.0[j] = cosines[0] - sines[1];
        out.1[j] = cosines[1] + sines[0];
        out.0[R - j] = cosines[0] + sines[1];
        out.1[R - j] = cosines[1] - sines[0];
    }
    out
}
