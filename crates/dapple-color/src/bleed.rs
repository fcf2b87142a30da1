//! Color bleeding, which gives transparent pixels the color of the nearest visible pixel.
//!
//! A mip level averages the straight (not premultiplied) colors of all pixels, transparent ones too. If the color of
//! the visible area does not continue into pixels with alpha 0, their color shows as a rim around that area. Game
//! engines call this step "fix alpha border" or "alpha is transparency".
//!
//! Reference: Pedro F. Felzenszwalb and Daniel P. Huttenlocher, "Distance Transforms of Sampled Functions", Theory of
//! Computing 8 (2012), <https://doi.org/10.4086/toc.2012.v008a019>. Two sweeps find the distances along columns. The
//! distances in the plane come from the lower envelope of the parabolas of each row, here in integers. Ties between
//! pixels at equal distance are broken by position, so the result is the same on all machines.

use crate::LinearRgba;
use dapple_raster::{Raster, parallel};

/// Gives each pixel with alpha 0 the color of the nearest pixel with alpha above 0. Its alpha remains 0.
///
/// Along an axis that wraps, the nearest pixel may be across the image's edge. An image without a visible pixel stays
/// unchanged. The time is proportional to the number of pixels.
///
/// # Examples
///
/// ```
/// use dapple_color::{LinearRgb, LinearRgba, bleed_color};
/// use dapple_raster::Raster;
///
/// let leaf = LinearRgba::opaque(LinearRgb::new(0.1, 0.4, 0.1));
/// let mut image = Raster::from_fn([8, 8], |x, _| if x < 4 { leaf } else { LinearRgba::default() })?;
/// bleed_color(&mut image, [false; 2]);
/// assert_eq!(image.row(0)[7], LinearRgba { alpha: 0.0, ..leaf });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bleed_color(image: &mut Raster<LinearRgba>, wraps: [bool; 2]) {
    let is_clear = |pixel: &LinearRgba| !is_seen(pixel);
    if !image.pixels().iter().any(is_clear) || !image.pixels().iter().any(is_seen) {
        return;
    }
    let width = image.width() as usize;
    let steps = steps_to_seen(image, wraps[1]);
    let source = image.clone();
    parallel::for_each_chunk(image.pixels_mut(), width, |row, pixels| {
        let steps = &steps[row * width..][..width];
        if !pixels.iter().any(is_clear) {
            return;
        }
        let envelope = Envelope::new(steps, wraps[0]);
        for (pixel, column) in pixels.iter_mut().zip(envelope.nearest(width)) {
            if is_seen(pixel) {
                continue;
            }
            let height = i64::from(source.height());
            let from = (row as i64 + i64::from(steps[column])).rem_euclid(height);
            pixel.color = source.row(from as u32)[column].color;
        }
    });
}

fn is_seen(pixel: &LinearRgba) -> bool {
    pixel.alpha > 0.0
}

/// Value for columns without a visible pixel.
const NONE: i32 = i32::MAX;

/// Returns, for each pixel, the signed number of rows (positive downward) to the nearest visible pixel in its column,
/// or [`NONE`] if the column has none. Of two pixels at equal distance, the upper one wins.
fn steps_to_seen(image: &Raster<LinearRgba>, wraps: bool) -> Vec<i32> {
    let [width, height] = image.size().map(|side| side as usize);
    let mut steps = vec![NONE; width * height];
    // In a column that wraps, the second sweep in a direction starts with the pixels found past the edge.
    let n_sweeps = if wraps { 2 } else { 1 };
    let sweep = |steps: &mut [i32], rows: &mut dyn Iterator<Item = usize>, back: i32| {
        let mut last = vec![NONE; width];
        for row in rows {
            let line = row * width..(row + 1) * width;
            let pixels = image.pixels()[line.clone()].iter().zip(&mut last);
            for (step, (pixel, last)) in steps[line].iter_mut().zip(pixels) {
                *last = match *last {
                    _ if is_seen(pixel) => 0,
                    NONE => NONE,
                    rows => rows + back,
                };
                // The downward sweep comes first and only a shorter distance replaces it, so the upper pixel wins a
                // tie.
                if *last != NONE && (*step == NONE || last.abs() < step.abs()) {
                    *step = *last;
                }
            }
        }
    };
    let down = |_| 0..height;
    sweep(&mut steps, &mut (0..n_sweeps).flat_map(down), -1);
    let up = |_| (0..height).rev();
    sweep(&mut steps, &mut (0..n_sweeps).flat_map(up), 1);
    steps
}

/// The lower envelope of a row's distance parabolas. It lists the columns that are nearest to at least one pixel, from
/// left to right.
struct Envelope {
    /// A column (counted past the edges of a row that wraps), and the first pixel that is nearest to it.
    parts: Vec<(i64, i64)>,
    /// Width of the row if it wraps; `None` if it does not.
    period: Option<i64>,
}

impl Envelope {
    fn new(steps: &[i32], wraps: bool) -> Self {
        let width = steps.len() as i64;
        let copies = if wraps { -1..2 } else { 0..1 };
        let mut parts: Vec<(i64, i64)> = Vec::new();
        let square = |column: i64| {
            let step = i64::from(steps[column.rem_euclid(width) as usize]);
            step * step
        };
        for column in copies.flat_map(|copy| copy * width..(copy + 1) * width) {
            if steps[column.rem_euclid(width) as usize] == NONE {
                continue;
            }
            let mut from = i64::MIN;
            while let Some(&(before, first)) = parts.last() {
                // Last pixel that is at least as close to the column `before` as to `column`.
                let rise = square(column) + column * column - square(before) - before * before;
                let last = rise.div_euclid(2 * (column - before));
                if last >= first {
                    from = last + 1;
                    break;
                }
                // The column `before` is nearest to no pixel: drop it from the envelope.
                parts.pop();
            }
            parts.push((column, from));
        }
        Self {
            parts,
            period: wraps.then_some(width),
        }
    }

    /// Returns the nearest column for each pixel in the row. At least one column must have a visible pixel.
    fn nearest(&self, width: usize) -> impl Iterator<Item = usize> {
        let mut part = 0;
        (0..width as i64).map(move |pixel| {
            while self
                .parts
                .get(part + 1)
                .is_some_and(|&(_, first)| first <= pixel)
            {
                part += 1;
            }
            let (column, _) = self.parts[part];
            self.period
                .map_or(column, |period| column.rem_euclid(period)) as usize
        })
    }
}

#[cfg(test)]
mod tests {
    use super::bleed_color;
    use crate::{LinearRgb, LinearRgba};
    use dapple_raster::Raster;

    /// Returns an image with a few visible pixels, each of a different color, among transparent ones.
    fn scattered(size: [u32; 2], one_in: u32) -> Raster<LinearRgba> {
        Raster::from_fn(size, |x, y| {
            let random = (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA6B))
                .wrapping_mul(0xC2B2_AE35);
            let is_seen = (random >> 8).is_multiple_of(one_in);
            LinearRgba {
                color: LinearRgb::new(x as f32, y as f32, if is_seen { 1.0 } else { -1.0 }),
                alpha: if is_seen { 0.5 } else { 0.0 },
            }
        })
        .unwrap()
    }

    /// Returns the squared distance between two pixels.
    fn distance_sq(a: [i64; 2], b: [i64; 2], size: [i64; 2], wraps: [bool; 2]) -> i64 {
        let along = |axis: usize| {
            let distance = (a[axis] - b[axis]).abs();
            match wraps[axis] {
                true => distance.min(size[axis] - distance),
                false => distance,
            }
        };
        along(0) * along(0) + along(1) * along(1)
    }

    #[test]
    fn clear_pixels_have_the_color_of_the_nearest_one_that_is_seen() {
        for size in [[1, 1], [9, 1], [1, 12], [31, 17], [16, 40]] {
            for one_in in [1, 3, 40, 400] {
                let image = scattered(size, one_in);
                let all = (0..i64::from(size[1]))
                    .flat_map(|y| (0..i64::from(size[0])).map(move |x| [x, y]));
                let seen = || {
                    let is_seen =
                        |at: &[i64; 2]| image.row(at[1] as u32)[at[0] as usize].alpha > 0.0;
                    all.clone().filter(is_seen)
                };
                for wraps in [[false; 2], [true, false], [false, true], [true; 2]] {
                    let mut bled = image.clone();
                    bleed_color(&mut bled, wraps);
                    for at in all.clone() {
                        let [was, is] =
                            [&image, &bled].map(|map| map.row(at[1] as u32)[at[0] as usize]);
                        assert_eq!(was.alpha, is.alpha, "alpha stays");
                        if was.alpha > 0.0 || seen().next().is_none() {
                            assert_eq!(was, is, "{at:?} of {size:?} stays");
                            continue;
                        }
                        let to = |other| distance_sq(at, other, size.map(i64::from), wraps);
                        let least = seen().map(to).min().unwrap();
                        assert_eq!(is.color.b, 1.0, "a color that is seen");
                        let from = [is.color.r as i64, is.color.g as i64];
                        assert_eq!(
                            to(from),
                            least,
                            "{at:?} of {size:?} from {from:?}, {wraps:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn mip_levels_are_no_darker_than_what_is_seen() {
        let green = |x: u32, y: u32| 0.3 + 0.01 * f32::from((x * 7 + y) as u8 % 16);
        let is_leaf = |x: u32, y: u32| {
            let [dx, dy] = [x % 48, y % 48].map(|at| f64::from(at) - 23.5);
            dx * dx + dy * dy < 256.0
        };
        let mut image = Raster::from_fn([96, 96], |x, y| match is_leaf(x, y) {
            true => LinearRgba::opaque(LinearRgb::new(0.0, green(x, y), 0.0)),
            false => LinearRgba::default(),
        })
        .unwrap();
        bleed_color(&mut image, [true; 2]);
        for level in 1..5 {
            let side = 1 << level;
            for row in 0..96 / side {
                for column in 0..96 / side {
                    let part = image.crop([column * side, row * side], [side; 2]).unwrap();
                    let mean = |channel: fn(&LinearRgba) -> f32| {
                        part.pixels().iter().map(channel).sum::<f32>() / (side * side) as f32
                    };
                    if mean(|pixel| pixel.alpha) > 0.0 {
                        let green = mean(|pixel| pixel.color.g);
                        // The minimum of the visible colors is 0.3; the difference is rounding.
                        assert!(green > 0.2999, "{green} on level {level}");
                    }
                }
            }
        }
    }
}
