//! Histogram equalization by ranks, which makes a threshold cover exactly its share of the area.
//!
//! A mask that is only stretched to its range covers hardly anything at a low threshold, and almost everything at a
//! high one, since its values are concentrated in the middle. Ranks are evenly distributed by construction: this is
//! histogram equalization without bins. Values are mapped by an increasing function, so a seamless raster stays
//! seamless.
//!
//! Equal values are ordered by a hash of their position. So their ranks are scattered over the area where they occur,
//! and the share is exact even for a raster of a few gray levels.
//!
//! Reference: our own.

use crate::TileError;
use crate::map::check_finite;
use dapple_hash::{Seed, hash2};
use dapple_raster::{Raster, parallel};

/// Replaces every value by `(rank + ½) / n`, where `rank` counts from 0 and `n` is the number of pixels.
///
/// The values are between 0 and 1, and the share of pixels below a threshold `t` is `t`. It is exact if `t · n` is an
/// integer and `n` is at most 2^23, and otherwise within one pixel or 2^-24, whichever is more.
///
/// This turns any raster into a blend mask: a [`BlendMap`](crate::BlendMap), a height, or noise of any kind.
///
#[cfg_attr(doc, doc = include_str!("../docs/rank-equalize.md"))]
///
/// # Errors
///
/// [`NotFinite`](crate::TileErrorKind::NotFinite) if a pixel is NaN or infinite.
///
/// # Examples
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_tile::rank_equalize;
///
/// let noise = Raster::from_vec([4, 1], vec![0.1, 0.4, -7.0, 0.2])?;
/// assert_eq!(rank_equalize(&noise)?.pixels(), [0.375, 0.875, 0.125, 0.625]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rank_equalize(raster: &Raster<f32>) -> Result<Raster<f32>, TileError> {
    check_finite(raster)?;
    // Sort the pixels by value, and equal values by the hash of their position.
    let mut order = keys(raster)?.into_pixels();
    parallel::sort(&mut order);
    let n = order.len() as f64;
    let mut ranks = raster.clone();
    let pixels = ranks.pixels_mut();
    // Divide the range from 0 to 1 evenly among the ranks, and assign the middle of each part.
    for (rank, &key) in order.iter().enumerate() {
        pixels[key as u32 as usize] = ((rank as f64 + 0.5) / n) as f32;
    }
    Ok(ranks)
}

/// Returns a unique sort key for each pixel. From high to low bits, it holds the value as an integer in the same order,
/// the hash of the position, and the index of the pixel.
fn keys(raster: &Raster<f32>) -> Result<Raster<u128>, TileError> {
    const PLACES: Seed = Seed(0).child("rank", 0);
    let width = raster.width();
    Ok(Raster::from_rows(raster.size(), |row| {
        let values = raster.row(row).iter().zip(0..width);
        values.map(move |(&value, column)| {
            let hash = hash2(PLACES, [column.into(), row.into()], 0);
            let key = u64::from(ordered_bits(value)) << 32 | hash >> 32;
            u128::from(key) << 32 | u128::from(row * width + column)
        })
    })?)
}

/// Converts values to integers in the same order. Both zeros become the same integer.
fn ordered_bits(value: f32) -> u32 {
    // Adding zero turns a negative zero into a positive one.
    let bits = (value + 0.0).to_bits();
    let sign = 1 << 31;
    if bits & sign == 0 { bits | sign } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::{ordered_bits, rank_equalize};
    use crate::TileErrorKind;
    use dapple_hash::{Seed, hash2, unit_f64};
    use dapple_raster::Raster;
    use proptest::prelude::*;

    /// Returns noise that is concentrated around ½, like sums of random numbers.
    fn bell(size: [u32; 2], seed: u64) -> Raster<f32> {
        Raster::from_fn(size, |column, row| {
            let cell = [column.into(), row.into()];
            let parts = [0, 1, 2, 3].map(|part| unit_f64(hash2(Seed(seed), cell, part)));
            (parts.iter().sum::<f64>() / 4.0) as f32
        })
        .unwrap()
    }

    fn below(raster: &Raster<f32>, threshold: f32) -> usize {
        let pixels = raster.pixels().iter();
        pixels.filter(|&&value| value < threshold).count()
    }

    #[test]
    fn thresholds_cover_their_share_exactly_where_it_is_a_whole_number_of_pixels() {
        for size in [[32, 32], [100, 10], [1, 1000]] {
            let n = size[0] * size[1];
            let ranks = rank_equalize(&bell(size, 1)).unwrap();
            for part in 0..=n {
                let threshold = (f64::from(part) / f64::from(n)) as f32;
                assert_eq!(below(&ranks, threshold), part as usize, "{part} of {n}");
            }
        }
        // For comparison: the same noise, only stretched to its range, covers a quarter of the share.
        let noise = bell([128, 128], 1);
        let range = noise.statistics();
        let stretched = noise.map(|value| (value - range.min) / (range.max - range.min));
        assert!(below(&stretched, 0.25) < 128 * 128 / 10, "stretched noise");
    }

    #[test]
    fn thresholds_cover_their_share_to_one_pixel_everywhere() {
        let ranks = rank_equalize(&bell([37, 29], 2)).unwrap();
        for step in 0..=1000 {
            let threshold = step as f32 / 1000.0;
            let share = f64::from(threshold) * 37.0 * 29.0;
            let off = below(&ranks, threshold) as f64 - share;
            assert!(off.abs() <= 1.0, "{threshold}: {off} pixels too many");
        }
    }

    #[test]
    fn ranks_equal_those_of_a_naive_count() {
        // Use few levels, so that most values occur often.
        let levels = bell([23, 17], 3).map(|value| (value * 6.0).floor() - 3.0);
        let ranks = rank_equalize(&levels).unwrap();
        let n = 23.0 * 17.0;
        let mut seen = vec![false; 23 * 17];
        for (value, rank) in levels.pixels().iter().zip(ranks.pixels()) {
            let lower = levels.pixels().iter().filter(|&other| other < value);
            let equal = levels.pixels().iter().filter(|&other| other == value);
            let place = (f64::from(*rank) * n - 0.5).round() as usize;
            let [first, count] = [lower.count(), equal.count()];
            assert!((first..first + count).contains(&place), "value {value}");
            assert!(!seen[place], "rank {place} came twice");
            seen[place] = true;
        }
    }

    #[test]
    fn equal_values_scatter_over_the_raster() {
        let flat = Raster::filled([64, 64], 0.3_f32).unwrap();
        let ranks = rank_equalize(&flat).unwrap();
        // Half of the pixels lie below ½. In each quarter that is 512 ± 14 (of a hypergeometric distribution); 5
        // deviations are allowed.
        for first in [[0, 0], [32, 0], [0, 32], [32, 32]] {
            let count = below(&ranks.crop(first, [32, 32]).unwrap(), 0.5);
            assert!(count.abs_diff(512) < 70, "{count} from {first:?}");
        }
    }

    #[test]
    fn a_growing_function_changes_no_rank() {
        let noise = bell([40, 31], 4);
        let grown = noise.map(|value| value * value * 1000.0 - 5.0);
        assert_eq!(
            rank_equalize(&noise).unwrap(),
            rank_equalize(&grown).unwrap()
        );
    }

    #[test]
    fn ordered_bits_keep_the_order_and_join_the_zeros() {
        let rising = [f32::MIN, -1.0, -1e-40, 0.0, 1e-40, 0.5, 1.0, f32::MAX];
        for pair in rising.windows(2) {
            assert!(ordered_bits(pair[0]) < ordered_bits(pair[1]), "{pair:?}");
        }
        assert_eq!(ordered_bits(-0.0), ordered_bits(0.0));
    }

    #[test]
    fn value_stability_rank_equalize() {
        let ranks = rank_equalize(&Raster::filled([3, 2], 1.0).unwrap()).unwrap();
        let sixths = ranks.map(|rank| (rank * 6.0 - 0.5).round() as u32);
        assert_eq!(sixths.pixels(), [2, 0, 4, 5, 1, 3]);
    }

    #[test]
    fn rank_equalize_refuses_pixels_that_are_not_finite() {
        let mut raster = bell([5, 4], 5);
        raster.pixels_mut()[7] = f32::NEG_INFINITY;
        let error = rank_equalize(&raster).unwrap_err();
        let expected = TileErrorKind::NotFinite {
            column: 2,
            row: 1,
            value: f32::NEG_INFINITY,
        };
        assert_eq!(error.kind(), &expected);
    }

    proptest! {
        #[test]
        fn ranks_lie_between_zero_and_one(
            width in 1_u32..9,
            height in 1_u32..9,
            values in prop::collection::vec(prop::num::f32::NORMAL | prop::num::f32::ZERO, 64),
        ) {
            let n = width as usize * height as usize;
            let raster = Raster::from_vec([width, height], values[..n].to_vec()).unwrap();
            let ranks = rank_equalize(&raster).unwrap();
            let mut sorted = ranks.into_pixels();
            sorted.sort_by(f32::total_cmp);
            for (place, rank) in sorted.iter().enumerate() {
                prop_assert_eq!(*rank, ((place as f64 + 0.5) / n as f64) as f32, "place {}", place);
            }
        }
    }
}
