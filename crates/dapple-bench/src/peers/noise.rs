//! Renders grids with `simdnoise` and evaluates scattered positions with `noise-functions`.
//!
//! * `simdnoise` computes whole grids, with the widest of SSE2, SSE4.1 and AVX2 that it finds at run time. It
//!   always returns a grid in a new `Vec`, with its minimum and maximum, which cannot be avoided; the last grid is
//!   freed outside the timed section. Of all tested crates it has the fastest cellular grids and the fastest grid of
//!   one octave of gradient noise, which is simplex noise (compared with Perlin and simplex noise of
//!   `noise-functions`, `fastnoise-lite`, `libnoise` and `noise`). Its cellular distances are squared. They come from
//!   one feature point per cell on a circle or sphere around the cell's corner; it searches only the 3×3 or 3×3×3
//!   cells around the position. In space it steps `z` from `y`, so that it visits 18 cells rather than 27, some of
//!   them wrong; its times are used unchanged.
//! * `noise-functions` has the fastest function for one position (compared with `fastnoise-lite`, `libnoise` and
//!   `noise`), with the square root that Euclidean distances need. Its feature points also lie on a circle or sphere.

use noise_functions::{CellDistance, Noise as _, Perlin};
use simdnoise::{Cell2ReturnType, CellReturnType, NoiseBuilder};

/// A grid from `simdnoise`: the values, their minimum and their maximum.
pub(crate) type Grid = (Vec<f32>, f32, f32);

/// Distance from feature points to the corners of their cells. It does not affect the time.
const JITTER: f32 = 0.45;

/// Returns cellular noise from `simdnoise` in the plane: squared F1.
pub(crate) fn simdnoise_f1([width, height]: [usize; 2], frequency: f32) -> Grid {
    NoiseBuilder::cellular_2d(width, height)
        .with_freq(frequency)
        .with_jitter(JITTER)
        .with_return_type(CellReturnType::Distance)
        .generate()
}

/// Returns `simdnoise`'s second cellular noise in the plane: squared F1 minus squared F2.
pub(crate) fn simdnoise_f1_minus_f2([width, height]: [usize; 2], frequency: f32) -> Grid {
    NoiseBuilder::cellular2_2d(width, height)
        .with_freq(frequency)
        .with_jitter(JITTER)
        .with_return_type(Cell2ReturnType::Distance2Sub)
        .generate()
}

/// Returns `simdnoise`'s second cellular noise in space: squared F1 minus squared F2.
pub(crate) fn simdnoise_f1_minus_f2_in_space(
    [width, height, depth]: [usize; 3],
    frequency: f32,
) -> Grid {
    NoiseBuilder::cellular2_3d(width, height, depth)
        .with_freq(frequency)
        .with_jitter(JITTER)
        .with_return_type(Cell2ReturnType::Distance2Sub)
        .generate()
}

/// Returns one octave of simplex noise from `simdnoise` in the plane.
pub(crate) fn simdnoise_simplex([width, height]: [usize; 2], frequency: f32) -> Grid {
    NoiseBuilder::gradient_2d(width, height)
        .with_freq(frequency)
        .generate()
}

/// Returns one octave of simplex noise from `simdnoise` in space.
pub(crate) fn simdnoise_simplex_in_space(
    [width, height, depth]: [usize; 3],
    frequency: f32,
) -> Grid {
    NoiseBuilder::gradient_3d(width, height, depth)
        .with_freq(frequency)
        .generate()
}

/// Computes the distance from each position in the plane to its nearest feature point, mapped from [0, 1] to [−1, 1].
pub(crate) fn noise_functions_f1_2(positions: &[[f32; 2]], values: &mut [f32]) {
    let noise = CellDistance::default();
    for (value, &position) in values.iter_mut().zip(positions) {
        *value = noise.sample2(position);
    }
}

/// Computes the distance from each position in space to its nearest feature point, mapped from [0, 1] to [−1, 1].
pub(crate) fn noise_functions_f1_3(positions: &[[f32; 3]], values: &mut [f32]) {
    let noise = CellDistance::default();
    for (value, &position) in values.iter_mut().zip(positions) {
        *value = noise.sample3(position);
    }
}

/// Computes one octave of Perlin noise at positions in the plane, from −1 to 1.
pub(crate) fn noise_functions_perlin_2(positions: &[[f32; 2]], values: &mut [f32]) {
    for (value, &position) in values.iter_mut().zip(positions) {
        *value = Perlin.sample2(position);
    }
}

/// Computes one octave of Perlin noise at positions in space, from −1 to 1.
pub(crate) fn noise_functions_perlin_3(positions: &[[f32; 3]], values: &mut [f32]) {
    for (value, &position) in values.iter_mut().zip(positions) {
        *value = Perlin.sample3(position);
    }
}

/// Fills a square of terrain with `side` by `side` positions, `step` cells apart. The terrain is six octaves plus
/// five ridged octaves, warped by up to half a cell by two more fields.
pub(crate) fn noise_functions_terrain(side: usize, step: f32, values: &mut [f32]) {
    let hills = Perlin.seed(1).fbm(6, 0.5, 2.0);
    let ridges = Perlin.seed(2).ridged().fbm(5, 0.5, 2.0);
    let ways = [Perlin.seed(3), Perlin.seed(4)];
    for (row, values) in values.chunks_exact_mut(side).enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            let at = [column as f32 * step, row as f32 * step];
            let [x, y] = [0, 1].map(|axis| at[axis] + 0.5 * ways[axis].sample2(at));
            *value = hills.sample2([x, y]) + 0.5 * ridges.sample2([x, y]);
        }
    }
}

/// Fills a raster with Perlin noise at positions that two more fields move by up to half a cell, pixel by pixel.
pub(crate) fn noise_functions_warp(side: usize, px_per_cell: f32, values: &mut [f32]) {
    let base = Perlin.seed(1);
    let ways = [Perlin.seed(2), Perlin.seed(3)];
    for (row, values) in values.chunks_exact_mut(side).enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            let at = [column as f32 / px_per_cell, row as f32 / px_per_cell];
            *value = base.sample2([0, 1].map(|axis| at[axis] + 0.5 * ways[axis].sample2(at)));
        }
    }
}

/// Fills a raster with the distance to the nearest feature point, pixel by pixel.
pub(crate) fn noise_functions_cells(side: usize, px_per_cell: f32, values: &mut [f32]) {
    let noise = CellDistance::default();
    for (row, values) in values.chunks_exact_mut(side).enumerate() {
        let y = row as f32 / px_per_cell;
        for (column, value) in values.iter_mut().enumerate() {
            *value = noise.sample2([column as f32 / px_per_cell, y]);
        }
    }
}

/// Fills a raster with fractal Perlin noise, pixel by pixel. Each of the `octaves` octaves has half the feature size
/// and half the amplitude of the previous one; the first has cells of `px_per_cell` pixels.
pub(crate) fn noise_functions_fbm(side: usize, octaves: u32, px_per_cell: f32, values: &mut [f32]) {
    let noise = Perlin.fbm(octaves, 0.5, 2.0);
    for (row, values) in values.chunks_exact_mut(side).enumerate() {
        let y = row as f32 / px_per_cell;
        for (column, value) in values.iter_mut().enumerate() {
            *value = noise.sample2([column as f32 / px_per_cell, y]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_a_value_for_every_pixel() {
        for (values, ..) in [
            simdnoise_f1([40, 30], 0.1),
            simdnoise_f1_minus_f2([40, 30], 0.1),
            simdnoise_simplex([40, 30], 0.1),
            simdnoise_f1_minus_f2_in_space([10, 12, 10], 0.1),
            simdnoise_simplex_in_space([10, 12, 10], 0.1),
        ] {
            assert_eq!(values.len(), 1200, "as many values as pixels");
        }
    }

    #[test]
    fn frequency_is_in_cells_per_pixel() {
        // Feature points of neighboring cells are nearer or farther than the corners of the cells by at most 2 · 0.45.
        // So F1 along 64 cells has some 64 valleys, at most one per cell.
        let (values, ..) = simdnoise_f1([64 * 16, 1], 1.0 / 16.0);
        let valleys = values
            .windows(3)
            .filter(|near| near[1] < near[0] && near[1] < near[2])
            .count();
        assert!(
            (32..=80).contains(&valleys),
            "{valleys} valleys along 64 cells"
        );
    }

    #[test]
    fn distances_of_noise_functions_stay_in_their_range() {
        let positions: Vec<[f32; 3]> = (0..1000)
            .map(|i| [0.37, 0.11, 0.73].map(|step| step * i as f32))
            .collect();
        let in_plane: Vec<[f32; 2]> = positions.iter().map(|&[x, y, _]| [x, y]).collect();
        let mut values = vec![f32::NAN; 1000];
        noise_functions_f1_3(&positions, &mut values);
        assert!(
            values.iter().all(|value| (-1.0..=2.0).contains(value)),
            "F1 in space"
        );
        values.fill(f32::NAN);
        noise_functions_f1_2(&in_plane, &mut values);
        assert!(
            values.iter().all(|value| (-1.0..=2.0).contains(value)),
            "F1 in the plane"
        );
    }
}
