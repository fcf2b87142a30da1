//! The pixels that a filter computes and reads.

use glam::DVec2;

/// Returns the number of whole pixels (or other steps) of length `pixel` within a distance.
pub(crate) fn pixels_within(distance: f64, pixel: f64) -> u32 {
    // The small factor keeps a whole number of pixels whole, whatever the rounding error of the pixel size.
    (distance / pixel * (1.0 + 1e-9)).floor() as u32
}

/// The pixels that a filter computes, and the halo around them that it reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Columns and rows of the result.
    pub size: [u32; 2],
    /// Columns and rows of the halo at each side.
    pub halo: [u32; 2],
    /// Width and height of a pixel, in units of the plane, above 0.
    pub pixel: DVec2,
}

impl Part {
    /// Returns the columns and rows of the result and its halo, which a filter reads.
    ///
    /// # Panics
    ///
    /// In debug builds, if a side is above `u32::MAX`.
    #[must_use]
    pub fn input_size(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.size[axis] + 2 * self.halo[axis])
    }

    /// Returns a row of the result's pixels, given the values of the part and its halo.
    ///
    /// # Panics
    ///
    /// If the row is past the last one, or if there are too few values.
    #[must_use]
    pub fn line<'a, T>(&self, values: &'a [T], row: usize) -> &'a [T] {
        let [width, wide] = [self.size[0], self.input_size()[0]].map(|side| side as usize);
        let [left, above] = self.halo.map(|side| side as usize);
        &values[(row + above) * wide + left..][..width]
    }
}
