//! Sorts vertices into the insertion order that `spade` expects.

use super::patch::Image;
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
