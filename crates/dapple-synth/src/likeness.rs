//! Similarity of two textures: the sliced Wasserstein distances between their colors and between their patches.
//!
//! Reference: Julien Rabin, Gabriel Peyré, Julie Delon and Marc Bernot, "Wasserstein Barycenter and Its Application to
//! Texture Mixing", SSVM 2011, DOI 10.1007/978-3-642-24785-9_37.
//!
//! Both sets of points are projected onto 64 fixed directions. Along a direction, the distance between two sets is the
//! area between their quantile functions (W1). This is the mean distance that points must move to turn one set into the
//! other. The result is the mean over the directions, in the units of the values. The sets may differ in size.
//!
//! Results have the same bits on every machine.

use crate::Exemplar;
use crate::error::{SynthError, SynthErrorKind};
use dapple_hash::{Seed, hash1, unit_f64};

/// Number of projection directions.
const N_DIRECTIONS: u64 = 64;

/// Side of a patch in pixels.
const PATCH: usize = 5;

/// Distance between two textures; 0 if they are identical.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Likeness {
    /// Distance between the sets of pixel colors; 0 if the images have the same proportion of each color.
    pub colors: f64,
    /// Distance between the sets of 5 × 5 patches; small if the colors are arranged in the same way.
    pub patches: f64,
}

impl Likeness {
    /// Compares two images by the values that synthesis matches, which are sRGB codes from 0 to 1 for colors.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if the images have different numbers of channels, and [`SynthErrorKind::Exemplar`] if
    /// an image is smaller than a patch.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::Raster;
    /// use dapple_synth::{Edges, Exemplar, Likeness};
    ///
    /// let [gray, brighter] = [0.25, 0.5].map(|value| Raster::filled([8, 8], value));
    /// let gray = Exemplar::from_planes(&[(&gray?, 1.0)], Edges::Cut)?;
    /// let brighter = Exemplar::from_planes(&[(&brighter?, 1.0)], Edges::Cut)?;
    /// assert_eq!(Likeness::new(&gray, &brighter)?.colors, 0.25);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(a: &Exemplar, b: &Exemplar) -> Result<Self, SynthError> {
        if a.n_channels != b.n_channels {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "channels of the second image",
                count: b.n_channels,
                needed: "as many as of the first",
            }));
        }
        for &Exemplar { size, .. } in [a, b] {
            if size.iter().any(|&side| (side as usize) < PATCH) {
                let (level, side) = (0, PATCH as u32);
                return Err(SynthError::new(SynthErrorKind::Exemplar {
                    level,
                    size,
                    side,
                }));
            }
        }
        let planes = [a, b].map(Planes::new);
        let [colors, patches] = [1, PATCH].map(|side| distance(&planes, side));
        Ok(Self { colors, patches })
    }
}

/// Channels of an image, stored as separate planes so that adjacent patches can be projected together.
struct Planes {
    size: [usize; 2],
    channels: Vec<Vec<f32>>,
}

impl Planes {
    fn new(image: &Exemplar) -> Self {
        let channel = |first: usize| {
            let values = image.pixels.iter().skip(first);
            values.step_by(image.n_channels).copied().collect()
        };
        Self {
            size: image.size.map(|side| side as usize),
            channels: (0..image.n_channels).map(channel).collect(),
        }
    }

    /// Returns the projections of all patches onto `direction`, in ascending order. Patches are `side` pixels wide.
    fn project(&self, side: usize, direction: &[f32]) -> Vec<f32> {
        let [width, height] = self.size;
        let [columns, rows] = [width - side + 1, height - side + 1];
        let mut projected = vec![0.0; columns * rows];
        for (row, sums) in projected.chunks_exact_mut(columns).enumerate() {
            // Sum one row of patches at a time: each factor multiplies a shifted row of values.
            let mut factors = direction.iter();
            for channel in &self.channels {
                for line in channel[row * width..].chunks_exact(width).take(side) {
                    for (first, &factor) in factors.by_ref().take(side).enumerate() {
                        for (sum, value) in sums.iter_mut().zip(&line[first..]) {
                            *sum += factor * value;
                        }
                    }
                }
            }
        }
        projected.sort_unstable_by(f32::total_cmp);
        projected
    }
}

/// Returns the sliced Wasserstein distance between the sets of patches of two images. Patches are `side` pixels wide.
fn distance(images: &[Planes; 2], side: usize) -> f64 {
    let dims = images[0].channels.len() * side * side;
    let mut sum = 0.0;
    for number in 0..N_DIRECTIONS {
        let direction = direction(number, dims);
        let [a, b] = [0, 1].map(|image: usize| images[image].project(side, &direction));
        // Sorted projections are quantile functions; the area between them is W1.
        sum += area_between(&a, &b);
    }
    sum / N_DIRECTIONS as f64
}

/// Returns the pseudorandom direction with index `number`, a unit vector with `dims` components.
fn direction(number: u64, dims: usize) -> Vec<f32> {
    let seed = Seed(0).child("directions of the likeness", number);
    // The sum of twelve uniform numbers is close enough to a normal distribution to make all directions equally likely.
    let normal = |at| {
        let uniform = |index| unit_f64(hash1(seed, [at], index));
        (0..12).map(uniform).sum::<f64>() - 6.0
    };
    let parts: Vec<f64> = (0..dims as i64).map(normal).collect();
    let length = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    parts.iter().map(|part| (part / length) as f32).collect()
}

/// Returns the area between the quantile functions of `a` and `b`, which are in ascending order. This is the
/// Wasserstein distance W1.
fn area_between(a: &[f32], b: &[f32]) -> f64 {
    // Each number has an equal share of 1. In units of 1 / (a.len() · b.len()) all shares are integers.
    let [share_a, share_b] = [b.len() as u64, a.len() as u64];
    let [mut i, mut j] = [0, 0];
    let [mut left_a, mut left_b] = [share_a, share_b];
    let mut sum = 0.0;
    while i < a.len() && j < b.len() {
        let share = left_a.min(left_b);
        // Advance by the smaller remaining share.
        sum += share as f64 * (f64::from(a[i]) - f64::from(b[j])).abs();
        left_a -= share;
        left_b -= share;
        if left_a == 0 {
            (i, left_a) = (i + 1, share_a);
        }
        if left_b == 0 {
            (j, left_b) = (j + 1, share_b);
        }
    }
    sum / (share_a as f64 * share_b as f64)
}

#[cfg(test)]
mod tests {
    use super::{Likeness, N_DIRECTIONS, area_between, direction};
    use crate::{Edges, Exemplar, SynthErrorKind};
    use dapple_hash::{Seed, hash2, unit_f32};
    use dapple_raster::Raster;

    /// Returns an image with `channels` channels.
    fn image(size: [u32; 2], channels: u64, value: impl Fn(u32, u32, u64) -> f32) -> Exemplar {
        let plane = |channel| Raster::from_fn(size, |x, y| value(x, y, channel)).unwrap();
        let planes: Vec<Raster<f32>> = (0..channels).map(plane).collect();
        let planes: Vec<_> = planes.iter().map(|plane| (plane, 1.0)).collect();
        Exemplar::from_planes(&planes, Edges::Cut).unwrap()
    }

    fn noise(x: u32, y: u32, channel: u64) -> f32 {
        unit_f32((hash2(Seed(channel), [x.into(), y.into()], 0) >> 32) as u32)
    }

    #[test]
    fn an_image_is_at_zero_from_itself() {
        let noise = image([12, 9], 3, noise);
        let expected = Likeness {
            colors: 0.0,
            patches: 0.0,
        };
        assert_eq!(Likeness::new(&noise, &noise).unwrap(), expected, "itself");
    }

    #[test]
    fn colors_do_not_depend_on_places_but_patches_do() {
        let [a, b] = [
            image([12, 12], 3, noise),
            image([12, 12], 3, |x, y, channel| noise(y, 11 - x, channel)),
        ];
        let turned = Likeness::new(&a, &b).unwrap();
        assert_eq!(turned.colors, 0.0, "the same colors in other places");
        assert!(turned.patches > 0.01, "{turned:?}");
        let [a, b] = [
            image([16, 16], 1, |x, _, _| (x % 2) as f32),
            image([16, 16], 1, |_, y, _| (y % 2) as f32),
        ];
        let stripes = Likeness::new(&a, &b).unwrap();
        assert_eq!(stripes.colors, 0.0, "as many black pixels");
        assert!(stripes.patches > 0.1, "{stripes:?}");
    }

    #[test]
    fn distances_do_not_depend_on_the_size_of_a_set() {
        let [small, large] =
            [[8, 8], [8, 24]].map(|size| image(size, 2, |x, y, channel| noise(x, y % 8, channel)));
        let likeness = Likeness::new(&small, &large).unwrap();
        // Three copies of each color have the same quantile function. The distance is exactly 0, without rounding
        // errors.
        assert_eq!(likeness.colors, 0.0, "three times each color");
    }

    #[test]
    fn a_shift_moves_everything_by_its_part_along_each_direction() {
        let shift = [0.5_f32, -0.25, 0.125];
        let a = image([16, 16], 3, noise);
        let b = image([16, 16], 3, |x, y, channel| {
            noise(x, y, channel) + shift[channel as usize]
        });
        let likeness = Likeness::new(&a, &b).unwrap();
        let expected = |side: usize| -> f64 {
            let along = |number| {
                let direction = direction(number, 3 * side * side);
                let parts = direction.chunks_exact(side * side).zip(shift);
                parts
                    .map(|(parts, shift)| {
                        parts
                            .iter()
                            .map(|part| f64::from(part * shift))
                            .sum::<f64>()
                    })
                    .sum::<f64>()
                    .abs()
            };
            (0..N_DIRECTIONS).map(along).sum::<f64>() / N_DIRECTIONS as f64
        };
        // 75 terms of f32, each up to 1.
        assert!((likeness.colors - expected(1)).abs() < 1e-6, "{likeness:?}");
        assert!(
            (likeness.patches - expected(5)).abs() < 1e-5,
            "{likeness:?}"
        );
        assert!(likeness.colors > 0.2, "{likeness:?}");
    }

    #[test]
    fn directions_have_length_one_and_are_spread() {
        for dims in [1, 3, 75] {
            let mut sums = vec![0.0_f64; dims];
            for number in 0..N_DIRECTIONS {
                let direction = direction(number, dims);
                let length_sq: f32 = direction.iter().map(|part| part * part).sum();
                // Each component is rounded to f32.
                assert!((length_sq - 1.0).abs() < 1e-5, "{dims} {number}");
                for (sum, part) in sums.iter_mut().zip(direction) {
                    *sum += f64::from(part * part) * dims as f64 / N_DIRECTIONS as f64;
                }
            }
            // Means of 64 squares with the mean 1 and a deviation below 1.5.
            assert!(
                sums.iter().all(|sum| (sum - 1.0).abs() < 0.75),
                "{dims} {sums:?}"
            );
        }
    }

    #[test]
    fn the_area_between_quantiles_is_exact_for_small_sets() {
        assert_eq!(area_between(&[1.0, 3.0], &[2.0, 7.0]), 2.5, "pairs");
        assert_eq!(
            area_between(&[0.0], &[1.0, 2.0, 6.0]),
            3.0,
            "one against three"
        );
        // Shares of sixths: 0-1 twice, 0-4, 3-4, 3-5 twice.
        assert_eq!(
            area_between(&[0.0, 3.0], &[1.0, 4.0, 5.0]),
            11.0 / 6.0,
            "two against three"
        );
    }

    #[test]
    fn images_that_cannot_be_compared_are_refused() {
        let [one, two, small] =
            [([8, 8], 1), ([8, 8], 2), ([8, 4], 1)].map(|(size, n)| image(size, n, noise));
        let kind = |a, b| Likeness::new(a, b).unwrap_err().kind().clone();
        assert!(
            matches!(kind(&one, &two), SynthErrorKind::Count { count: 2, .. }),
            "channels"
        );
        assert!(
            matches!(kind(&one, &small), SynthErrorKind::Exemplar { side: 5, .. }),
            "too small"
        );
    }

    #[test]
    fn value_stability_likeness() {
        let [a, b] = [
            image([9, 9], 3, noise),
            image([9, 9], 3, |x, y, channel| noise(x + 9, y, channel)),
        ];
        let likeness = Likeness::new(&a, &b).unwrap();
        assert_eq!(
            [likeness.colors, likeness.patches],
            [0.04859756643520399, 0.09797041234327482],
            "two pieces of noise"
        );
    }
}
