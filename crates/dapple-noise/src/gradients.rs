//! The gradients at the corners of cells.
//!
//! Perlin's improved noise takes the directions from the center of a cube to the middles of its edges, four of them twice
//! to make sixteen. Here all of them are equally likely; in four dimensions they are the 32 of the hypercube, and in two
//! the eight to corners and sides of a square, all of the same length.

use core::f32::consts::SQRT_2;

static PLANE: [[f32; 2]; 8] = [
    [1.0, 1.0],
    [-1.0, 1.0],
    [1.0, -1.0],
    [-1.0, -1.0],
    [SQRT_2, 0.0],
    [-SQRT_2, 0.0],
    [0.0, SQRT_2],
    [0.0, -SQRT_2],
];

static SPACE: [[f32; 3]; 12] = edges();

static TIME: [[f32; 4]; 32] = edges();

/// The middles of the edges of a cube from -1 to 1, of which there are `COUNT`.
const fn edges<const N: usize, const COUNT: usize>() -> [[f32; N]; COUNT] {
    let mut edges = [[0.0; N]; COUNT];
    let mut index = 0;
    while index < COUNT {
        // An edge lies along one axis, and the signs of the others tell the parallel ones apart.
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

/// The gradient that 32 random bits choose.
#[inline(always)]
pub(crate) fn gradient<const N: usize>(bits: u32) -> [f32; N] {
    let pick = |count: usize| ((u64::from(bits) * count as u64) >> 32) as usize;
    let mut gradient = [0.0; N];
    gradient.copy_from_slice(match N {
        2 => &PLANE[pick(PLANE.len())],
        3 => &SPACE[pick(SPACE.len())],
        _ => &TIME[pick(TIME.len())],
    });
    gradient
}

/// All gradients.
#[cfg(test)]
pub(crate) fn all<const N: usize>() -> Vec<[f32; N]> {
    let count = [0, 0, PLANE.len(), SPACE.len(), TIME.len()][N] as u64;
    (0..count)
        .map(|index| gradient((((index << 32) + (1 << 31)) / count) as u32))
        .collect()
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
