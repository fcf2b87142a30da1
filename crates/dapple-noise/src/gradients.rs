//! The gradient vectors at the corners of cells.
//!
//! Perlin's improved noise uses the directions from the center of a cube to the midpoints of its edges, listing four
//! of them twice to get sixteen. Here all directions are equally likely. In four dimensions there are 32, from the
//! hypercube. In two dimensions there are eight, to the corners and sides of a square, all with the same length.

use core::f32::consts::SQRT_2;
#[cfg(feature = "simd")]
use fearless_simd::{f32x16, prelude::*, u32x16};

/// Number of gradients in two dimensions.
const N_PLANE: u32 = 8;
/// Number of gradients in three dimensions.
const N_SPACE: u32 = 12;
/// Number of gradients in four dimensions.
const N_TIME: u32 = 32;

static PLANE: [[f32; 2]; N_PLANE as usize] = [
    [1.0, 1.0],
    [-1.0, 1.0],
    [1.0, -1.0],
    [-1.0, -1.0],
    [SQRT_2, 0.0],
    [-SQRT_2, 0.0],
    [0.0, SQRT_2],
    [0.0, -SQRT_2],
];

static SPACE: [[f32; 3]; N_SPACE as usize] = edges();

static TIME: [[f32; 4]; N_TIME as usize] = edges();

/// Returns the midpoints of the `COUNT` edges of a (hyper)cube from -1 to 1.
const fn edges<const N: usize, const COUNT: usize>() -> [[f32; N]; COUNT] {
    let mut edges = [[0.0; N]; COUNT];
    let mut index = 0;
    while index < COUNT {
        // An edge is parallel to one axis; the signs along the other axes distinguish parallel edges.
        let along = index >> (N - 1);
        let mut signs = index;
        let mut axis = 0;
        while axis < N {
            if axis != along {
                edges[index][axis] = if signs & 1 == 0 { 1.0 } else { -1.0 };
                signs >>= 1;
            }
            axis += 1;
        }
        index += 1;
    }
    edges
}

/// Maps the upper 24 of 32 random bits to a number below `count`, which is at most 256.
#[inline(always)]
const fn picked(bits: u32, count: u32) -> u32 {
    ((bits >> 8) * count) >> 24
}

/// Returns the gradients that random bits select, with one register per component. This is the SIMD form of
/// [`gradient`].
#[cfg(feature = "simd")]
#[inline(always)]
pub(crate) fn gradient_lanes<S: Simd, const N: usize>(simd: S, bits: u32x16<S>) -> [f32x16<S>; N] {
    let count = [N_PLANE, N_SPACE, N_TIME][N - 2];
    let index = ((bits >> 8) * count) >> 24;
    let one = u32x16::splat(simd, 1.0_f32.to_bits());
    let zero = u32x16::splat(simd, 0);
    let mut gradient = [f32x16::splat(simd, 0.0); N];
    for axis in 0..N {
        let this_axis = u32x16::splat(simd, axis as u32);
        let bits = if N == 2 {
            // The first four gradients are diagonal. Of the other four, the first two are along x.
            let is_side = index.simd_ge(u32x16::splat(simd, 4));
            let along = (index >> 1) & u32x16::splat(simd, 1);
            let is_along = along.simd_eq(this_axis);
            let root = u32x16::splat(simd, SQRT_2.to_bits());
            let size = is_side.select(is_along.select(root, zero), one);
            let sign = is_side.select(is_along.select(index, zero), index >> axis as u32);
            size | sign << 31
        } else {
            // The edge is parallel to one axis; the lower bits are the signs along the other axes, in order.
            let along = index >> (N as u32 - 1);
            let earlier = index >> axis as u32;
            let later = index >> (axis as u32).saturating_sub(1);
            let sign = along.simd_gt(this_axis).select(earlier, later) << 31;
            along.simd_eq(this_axis).select(zero, one | sign)
        };
        gradient[axis] = bits.bitcast();
    }
    gradient
}

/// Returns the gradient that 32 random bits select.
#[inline(always)]
pub(crate) fn gradient<const N: usize>(bits: u32) -> [f32; N] {
    let pick = |count: u32| picked(bits, count) as usize;
    let mut gradient = [0.0; N];
    gradient.copy_from_slice(match N {
        2 => &PLANE[pick(N_PLANE)],
        3 => &SPACE[pick(N_SPACE)],
        _ => &TIME[pick(N_TIME)],
    });
    gradient
}

/// Returns all gradients in `N` dimensions.
#[cfg(test)]
pub(crate) fn all<const N: usize>() -> Vec<[f32; N]> {
    let count = [0, 0, PLANE.len(), SPACE.len(), TIME.len()][N] as u64;
    let bits = |index: u64| (((index << 32) + (1 << 31)) / count) as u32;
    (0..count).map(|index| gradient(bits(index))).collect()
}

#[cfg(test)]
mod tests {
    use super::all;

    fn check<const N: usize>(expected: usize, length_sq: f32) {
        let gradients = all::<N>();
        assert_eq!(gradients.len(), expected, "how many");
        for (at, one) in gradients.iter().enumerate() {
            let square: f32 = one.iter().map(|part| part * part).sum();
            // √2 is rounded.
            assert!((square - length_sq).abs() < 1e-6, "the length of {one:?}");
            assert!(!gradients[..at].contains(one), "{one:?} is there once");
        }
        for axis in 0..N {
            let sum: f32 = gradients.iter().map(|one| one[axis]).sum();
            assert_eq!(sum, 0.0, "no direction is preferred along axis {axis}");
        }
    }

    #[test]
    fn gradients_differ_and_have_one_length_and_no_direction_in_common() {
        check::<2>(8, 2.0);
        check::<3>(12, 2.0);
        check::<4>(32, 3.0);
    }
}
