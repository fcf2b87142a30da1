//! Sorts vertices into the order in which they are inserted.

use super::patch::Image;
use super::{Refusal, check};
use crate::IsCancelled;
use core::cmp::Ordering;

/// Sorts images by their distance from their mean, farthest first.
///
/// `spade` sorts them in the same order, and then has nothing to do. If images are evenly distributed, squared
/// distances are as well, and one pass of bucket sort with as many buckets as images is faster than a comparison sort.
/// A rounding error in the mean affects the time, but not the result.
pub(super) fn farthest_first(images: &[Image]) -> Vec<Image> {
    let n = images.len();
    let share = 1.0 / n as f64;
    let sum = |coordinate: fn(&Image) -> f64| images.iter().map(coordinate).sum::<f64>() * share;
    let (x, y) = (sum(|i| i.position.x), sum(|i| i.position.y));
    let distance_sq = |image: &Image| {
        let (dx, dy) = (image.position.x - x, image.position.y - y);
        dx * dx + dy * dy
    };
    let farthest = images.iter().map(distance_sq).fold(0.0, f64::max);
    let per_step = n as f64 / farthest.max(1.0);
    // The cast saturates.
    let bucket = |image: &Image| ((farthest - distance_sq(image)) * per_step) as usize;
    // Count the images per bucket, and convert the counts to ends of ranges.
    let mut starts = vec![0_u32; n + 2];
    for image in images {
        starts[bucket(image)] += 1;
    }
    let mut end = 0;
    for start in &mut starts {
        end += *start;
        *start = end;
    }
    let Some(&any) = images.first() else {
        return Vec::new();
    };
    // Distribute the images, then sort within each bucket.
    let mut sorted = vec![any; n];
    for image in images {
        let start = &mut starts[bucket(image)];
        *start -= 1;
        sorted[*start as usize] = *image;
    }
    let order = |a: &Image, b: &Image| -> Ordering {
        (distance_sq(b).total_cmp(&distance_sq(a)))
            .then_with(|| a.position.x.total_cmp(&b.position.x))
            .then_with(|| a.position.y.total_cmp(&b.position.y))
    };
    for range in starts.windows(2) {
        if range[1] - range[0] > 1 {
            sorted[range[0] as usize..range[1] as usize].sort_unstable_by(order);
        }
    }
    sorted
}

/// Returns the images in random rounds of doubling size. Within a round, they follow Morton's space-filling curve.
pub(super) fn in_rounds(
    images: &[Image],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Image>, Refusal> {
    let low = images.iter().fold([f64::INFINITY; 2], |[x, y], image| {
        [x.min(image.position.x), y.min(image.position.y)]
    });
    // Half of the hashes end in 1, a quarter in 10, an eighth in 100.
    let round = |image: &Image| {
        let hash = u64::from(image.point)
            .wrapping_add(1)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15);
        u32::MAX - (hash >> 32).trailing_zeros()
    };
    let place = |(index, image): (usize, &Image)| {
        let at = [image.position.x - low[0], image.position.y - low[1]];
        (round(image), morton(at.map(|at| at as u64)), index)
    };
    let mut places: Vec<_> = images.iter().enumerate().map(place).collect();
    sort(&mut places, &|&place| place, is_cancelled)?;
    Ok(places.iter().map(|&(.., index)| images[index]).collect())
}

/// Interleaves the bits of two numbers below 2^53.
fn morton([x, y]: [u64; 2]) -> u128 {
    let spread = |number: u64| {
        let mut bits = u128::from(number);
        for shift in [32, 16, 8, 4, 2, 1] {
            // Keep the lower half of each group in place, and move the upper half up.
            let mask = u128::MAX / ((1 << shift) + 1);
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    spread(x) | spread(y) << 1
}

/// Sorts items by a key, in parts that take some milliseconds. The callback is called before each part but the last.
pub(super) fn sort<T, K: Ord>(
    items: &mut [T],
    key: &impl Fn(&T) -> K,
    is_cancelled: &IsCancelled,
) -> Result<(), Refusal> {
    const PART: usize = 1 << 16;
    if items.len() <= PART {
        items.sort_unstable_by_key(key);
        return Ok(());
    }
    check(is_cancelled)?;
    let (below, _, above) = items.select_nth_unstable_by_key(items.len() / 2, key);
    sort(below, key, is_cancelled)?;
    sort(above, key, is_cancelled)
}

#[cfg(test)]
mod tests {
    use super::{morton, sort};

    #[test]
    fn morton_takes_bits_in_turn() {
        assert_eq!(morton([0b1011, 0b0110]), 0b0110_1101);
        let most = (1 << 53) - 1;
        assert_eq!(morton([most, most]), (1 << 106) - 1);
        assert_eq!(morton([most, 0]) | morton([0, most]), (1 << 106) - 1);
    }

    #[test]
    fn sort_in_parts_equals_sort() {
        let mut numbers: Vec<u32> = (0..300_000)
            .map(|i: u32| i.wrapping_mul(2_654_435_761))
            .collect();
        let mut expected = numbers.clone();
        expected.sort_unstable();
        sort(&mut numbers, &|&number| number, &|| false).unwrap();
        assert_eq!(numbers, expected);
    }
}
