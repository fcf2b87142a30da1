//! Handles NaN and infinite values in images, by error messages or replacement.

use crate::args::NonFinite;
use crate::error::Hint;
use anyhow::{Result, anyhow};
use dapple::image::ExrPlane;
use dapple::raster::Raster;

/// The planes of an image that have NaN or infinite values, as stored in the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Faults(Vec<ExrPlane>);

impl Faults {
    /// Replaces all NaN and infinite values in `planes`. For [`NonFinite::Error`], returns the original planes that
    /// have such values, so that [`check`](Self::check) can report them; otherwise returns an empty list.
    pub(crate) fn replace(planes: &mut [ExrPlane], how: NonFinite) -> Self {
        let mut faults = Vec::new();
        for plane in planes {
            if plane.values.pixels().iter().all(|value| value.is_finite()) {
                continue;
            }
            let values = match how {
                NonFinite::Zero => plane.values.map(finite_or_zero),
                NonFinite::Error | NonFinite::Repair => filled(&plane.values),
            };
            let values = std::mem::replace(&mut plane.values, values);
            if how == NonFinite::Error {
                faults.push(ExrPlane::new(plane.name.clone(), values));
            }
        }
        Self(faults)
    }

    /// Crops the planes to a region of the image.
    pub(crate) fn crop(&self, first: [u32; 2], size: [u32; 2]) -> Result<Self> {
        let planes = self.0.iter().map(|plane| {
            let values = plane.values.crop(first, size)?;
            Ok(ExrPlane::new(plane.name.clone(), values))
        });
        planes.collect::<Result<_>>().map(Self)
    }

    /// Returns whether there are no faults.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns an error about the first fault at a pixel for which `is_used` returns true.
    ///
    /// # Errors
    ///
    /// If there is such a fault. The message has the name of the image, the channel, the column, the row and the value.
    pub(crate) fn check(&self, name: &str, is_used: impl Fn(u32, u32) -> bool) -> Result<()> {
        for plane in &self.0 {
            let width = plane.values.size()[0] as usize;
            for (at, &value) in plane.values.pixels().iter().enumerate() {
                let (column, row) = ((at % width) as u32, (at / width) as u32);
                if !value.is_finite() && is_used(column, row) {
                    let error = anyhow!(
                        "{name}: the channel {} is {value} in column {column} and row {row}, but all numbers must be finite",
                        plane.name
                    );
                    return Err(error.hint("--nonfinite repair takes the mean of the pixels around, --nonfinite zero takes 0"));
                }
            }
        }
        Ok(())
    }
}

fn finite_or_zero(&value: &f32) -> f32 {
    if value.is_finite() { value } else { 0.0 }
}

/// Fills holes of NaN and infinite values from their borders inward, ring by ring. Each pixel gets the mean of those of
/// its eight neighbors that are finite or already filled. If no value is finite, all become 0.
fn filled(values: &Raster<f32>) -> Raster<f32> {
    let [width, height] = values.size().map(|side| side as usize);
    let mut pixels: Vec<f32> = values.pixels().to_vec();
    // The indices of a pixel and its neighbors within the raster.
    let around = |at: usize| {
        let (x, y) = (at % width, at / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |row| {
            (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column)
        })
    };
    // Begin with the holes' pixels that have a finite neighbor.
    let mut ring: Vec<usize> = (0..pixels.len())
        .filter(|&at| !pixels[at].is_finite())
        .filter(|&at| around(at).any(|other| pixels[other].is_finite()))
        .collect();
    while !ring.is_empty() {
        // Compute all pixels of the ring before any is filled, so that the order does not matter.
        let means: Vec<f32> = ring
            .iter()
            .map(|&at| mean(around(at).map(|at| pixels[at])))
            .collect();
        for (&at, mean) in ring.iter().zip(means) {
            pixels[at] = mean;
        }
        // The next ring has the unfilled neighbors of this one.
        let mut next: Vec<usize> = ring
            .iter()
            .flat_map(|&at| around(at))
            .filter(|&at| !pixels[at].is_finite())
            .collect();
        next.sort_unstable();
        next.dedup();
        ring = next;
    }
    let mut filled = pixels.iter().map(finite_or_zero);
    values.map(|_| filled.next().unwrap_or_default())
}

/// Returns the mean of the finite values; 0 without any.
fn mean(values: impl Iterator<Item = f32>) -> f32 {
    let (mut sum, mut count) = (0.0_f64, 0.0_f64);
    for value in values.filter(|value| value.is_finite()) {
        sum += f64::from(value);
        count += 1.0;
    }
    (sum / count.max(1.0)) as f32
}

#[cfg(test)]
mod tests {
    use super::{Faults, filled};
    use crate::args::NonFinite;
    use dapple::image::ExrPlane;
    use dapple::raster::Raster;

    const NAN: f32 = f32::NAN;

    fn raster(size: [u32; 2], values: &[f32]) -> Raster<f32> {
        Raster::from_vec(size, values.to_vec()).unwrap()
    }

    #[test]
    fn holes_are_filled_ring_by_ring() {
        let hole = raster([3, 3], &[1.0, 2.0, 3.0, 4.0, NAN, 5.0, 6.0, 7.0, 8.0]);
        assert_eq!(filled(&hole).pixels()[4], 4.5, "the mean of eight");
        let row = raster([5, 1], &[1.0, f32::INFINITY, NAN, NAN, NAN]);
        assert_eq!(filled(&row).pixels(), [1.0; 5], "over several rings");
        let none = raster([2, 2], &[NAN; 4]);
        assert_eq!(filled(&none).pixels(), [0.0; 4], "nothing to fill from");
    }

    #[test]
    fn faults_name_the_channel_and_the_pixel() {
        let planes = |how| {
            let mut planes = vec![
                ExrPlane::new("R", raster([2, 1], &[1.0, 2.0])),
                ExrPlane::new("G", raster([2, 1], &[1.0, NAN])),
            ];
            let faults = Faults::replace(&mut planes, how);
            (planes.remove(1).values.pixels().to_vec(), faults)
        };
        let (values, faults) = planes(NonFinite::Error);
        assert_eq!(values, [1.0, 1.0]);
        let error = faults.check("a.exr", |_, _| true).unwrap_err().to_string();
        assert!(
            error.starts_with("a.exr: the channel G is NaN in column 1 and row 0"),
            "{error}"
        );
        assert!(
            faults.check("a.exr", |column, _| column == 0).is_ok(),
            "not used"
        );
        assert!(
            faults
                .crop([0, 0], [1, 1])
                .unwrap()
                .check("", |_, _| true)
                .is_ok()
        );
        let (values, faults) = planes(NonFinite::Zero);
        assert!(faults.is_empty() && values == [1.0, 0.0], "{values:?}");
        let (values, faults) = planes(NonFinite::Repair);
        assert!(faults.is_empty() && values == [1.0, 1.0], "{values:?}");
    }
}
