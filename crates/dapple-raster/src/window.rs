//! Windows, which are pixel grids in the plane and in planes through space.

use crate::raster::check_same_size;
use crate::{RasterError, RasterErrorKind};

/// A pixel grid along the first two axes. Pixel `[i, j]` has its center at `(origin + (first + [i, j] + ½) · pixel) ·
/// scale`.
///
/// In three or four dimensions, the window is in a plane along the first two axes, and all pixels share the
/// coordinates `origin · scale` along the other axes. Create it with [`in_space`](Self::in_space).
///
/// `first` is the integer offset of the first pixel from the origin. A part of a window has the origin and the pixel
/// size of the whole window, and therefore the same positions, bit for bit; see [`crop`](Self::crop).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "[f64; N]: serde::Serialize",
        deserialize = "[f64; N]: serde::Deserialize<'de>"
    ))
)]
pub struct Window<const N: usize = 2> {
    /// Corner from which pixels are counted, before scaling, and the coordinates along the axes after the second.
    pub origin: [f64; N],
    /// Width and height of a pixel, in units of positions before scaling. With a negative height, y decreases from
    /// row to row.
    pub pixel: [f64; 2],
    /// Column and row of the first pixel, relative to the origin.
    pub first: [i64; 2],
    /// Number of columns and rows.
    pub size: [u32; 2],
    /// Factor that multiplies positions last, such as the frequency of a texture [default: 1]. Only
    /// [`scaled`](Self::scaled) windows have a value other than 1.
    #[cfg_attr(feature = "serde", serde(default = "one"))]
    pub scale: [f64; N],
}

impl Window {
    /// Creates a window of `size` pixels over the rectangle from `origin` with the given `extent`.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] if a side of `size` is zero, [`RasterErrorKind::TooLarge`] for more than 2^31
    /// pixels, [`RasterErrorKind::NotFinite`] if the origin or the extent is not finite or the extent is zero.
    pub fn new(
        origin: impl Into<[f64; 2]>,
        extent: impl Into<[f64; 2]>,
        size: [u32; 2],
    ) -> Result<Self, RasterError> {
        let (origin, extent) = (origin.into(), extent.into());
        check_size(size)?;
        for (what, value, zero) in [
            ("origin of the window", origin[0], true),
            ("origin of the window", origin[1], true),
            ("extent of the window", extent[0], false),
            ("extent of the window", extent[1], false),
        ] {
            if !value.is_finite() || (!zero && value == 0.0) {
                return Err(RasterError::new(RasterErrorKind::NotFinite { what, value }));
            }
        }
        Ok(Self {
            origin,
            pixel: [
                extent[0] / f64::from(size[0]),
                extent[1] / f64::from(size[1]),
            ],
            first: [0, 0],
            size,
            scale: [1.0; 2],
        })
    }

    /// Creates a window of `size` pixels over the unit square.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new) for `size`.
    pub fn unit(size: [u32; 2]) -> Result<Self, RasterError> {
        Self::new([0.0; 2], [1.0; 2], size)
    }

    /// Returns this window in the plane through `origin` that is parallel to the first two axes of space. The first
    /// two coordinates of `origin` are ignored.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::Window;
    ///
    /// let window = Window::unit([4, 4])?.in_space([0.0, 0.0, 7.5]);
    /// assert_eq!(window.position(0, 1), [0.125, 0.375, 7.5]);
    /// # Ok::<(), dapple_raster::RasterError>(())
    /// ```
    #[must_use]
    pub fn in_space<const N: usize>(&self, mut origin: [f64; N]) -> Window<N> {
        let mut scale = [1.0; N];
        origin[..2].copy_from_slice(&self.origin);
        scale[..2].copy_from_slice(&self.scale);
        Window {
            origin,
            pixel: self.pixel,
            first: self.first,
            size: self.size,
            scale,
        }
    }
}

impl<const N: usize> Window<N> {
    /// Returns the window in the plane, without the coordinates along the axes after the second.
    #[must_use]
    pub fn in_plane(&self) -> Window {
        Window {
            origin: [self.origin[0], self.origin[1]],
            pixel: self.pixel,
            first: self.first,
            size: self.size,
            scale: [self.scale[0], self.scale[1]],
        }
    }

    /// Returns the coordinate that all pixels share along `axis`, an axis after the second.
    ///
    /// # Panics
    ///
    /// If `axis` is not below `N`.
    #[must_use]
    #[inline]
    pub fn depth(&self, axis: usize) -> f64 {
        self.origin[axis] * self.scale[axis]
    }

    /// Returns the part of this window that has `size` pixels and starts `first` columns and rows after the window's
    /// first pixel (before it, if negative).
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`], as in [`new`](Window::new).
    pub fn crop(&self, first: [i64; 2], size: [u32; 2]) -> Result<Self, RasterError> {
        check_size(size)?;
        let first = [
            self.first[0].saturating_add(first[0]),
            self.first[1].saturating_add(first[1]),
        ];
        Ok(Self {
            first,
            size,
            ..*self
        })
    }

    /// Multiplies all positions by `factor`, to render a field at another frequency. Every position of the result is
    /// exactly the `f64` product of the old position and `factor`. Returns `None` if the product of the scales would
    /// be rounded.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::Window;
    ///
    /// let window = Window::unit([64, 64])?;
    /// let scaled = window.scaled([12.0, 0.3]).expect("nothing was scaled before");
    /// let [x, y] = window.position(5, 7);
    /// assert_eq!(scaled.position(5, 7), [x * 12.0, y * 0.3]);
    /// # Ok::<(), dapple_raster::RasterError>(())
    /// ```
    #[must_use]
    pub fn scaled(&self, factor: impl Into<[f64; N]>) -> Option<Self> {
        let factor = factor.into();
        let mut scale = self.scale;
        for (scale, factor) in scale.iter_mut().zip(factor) {
            if !is_power_of_two(*scale) && !is_power_of_two(factor) {
                return None;
            }
            *scale *= factor;
        }
        Some(Self { scale, ..*self })
    }

    /// Returns the x coordinate of the pixel centers in column `column` of the window.
    #[must_use]
    #[inline]
    pub fn column_x(&self, column: u32) -> f64 {
        center(self.origin[0], self.pixel[0], self.first[0], column) * self.scale[0]
    }

    /// Returns the y coordinate of the pixel centers in row `row` of the window.
    #[must_use]
    #[inline]
    pub fn row_y(&self, row: u32) -> f64 {
        center(self.origin[1], self.pixel[1], self.first[1], row) * self.scale[1]
    }

    /// Returns the position of a pixel's center.
    #[must_use]
    #[inline]
    pub fn position(&self, column: u32, row: u32) -> [f64; N] {
        let mut position = [0.0; N];
        position[0] = self.column_x(column);
        position[1] = self.row_y(row);
        for (axis, further) in position.iter_mut().enumerate().skip(2) {
            *further = self.depth(axis);
        }
        position
    }

    /// Checks that a buffer is the same size as this window.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::SizeMismatch`] if `size` differs from the size of the window.
    pub fn check_size(&self, size: [u32; 2]) -> Result<(), RasterError> {
        check_same_size(size, self.size)
    }

    /// Returns the number of pixels.
    #[must_use]
    pub fn n_pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}

/// Returns a pixel center's coordinate along one axis. The integer part is exact below 2^52; one product and one sum
/// are rounded.
#[inline]
fn center(origin: f64, pixel: f64, first: i64, index: u32) -> f64 {
    origin + (first.saturating_add(i64::from(index)) as f64 + 0.5) * pixel
}

/// Returns whether a number is a power of two, so that products with it are exact.
fn is_power_of_two(number: f64) -> bool {
    number.is_normal() && number.to_bits() << 12 == 0
}

/// Returns the default scale, for windows that were serialized without one.
#[cfg(feature = "serde")]
fn one<const N: usize>() -> [f64; N] {
    [1.0; N]
}

/// Checks that a size is not empty and within the limit.
pub(crate) fn check_size(size: [u32; 2]) -> Result<(), RasterError> {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if pixels == 0 {
        return Err(RasterError::new(RasterErrorKind::Empty { size }));
    }
    if pixels > 1 << 31 {
        return Err(RasterError::new(RasterErrorKind::TooLarge { size }));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Window;
    use crate::RasterErrorKind;
    use glam::DVec2;

    #[test]
    fn a_crop_has_the_positions_of_the_whole_bit_for_bit() {
        let whole =
            Window::new(DVec2::new(1e9 + 0.1, -0.3), DVec2::new(0.7, 1.3), [101, 57]).unwrap();
        let part = whole
            .crop([13, 8], [40, 30])
            .unwrap()
            .crop([2, 3], [5, 6])
            .unwrap();
        for row in 0..6 {
            for column in 0..5 {
                let [here, there] = [
                    part.position(column, row),
                    whole.position(column + 15, row + 11),
                ];
                assert_eq!(here.map(f64::to_bits), there.map(f64::to_bits));
            }
        }
    }

    #[test]
    fn scaled_positions_are_products_bit_for_bit() {
        let window =
            Window::new(DVec2::new(1e3 + 0.1, -0.3), DVec2::new(0.7, 1.3), [11, 7]).unwrap();
        let [odd, even] = [DVec2::new(12.0, 0.3), DVec2::new(8.0, -0.25)];
        for factors in [[DVec2::ONE, odd], [odd, even], [even, odd], [even, even]] {
            let scaled = window.scaled(factors[0]).unwrap();
            let scaled = scaled.scaled(factors[1]).unwrap();
            for column in 0..11 {
                let product = DVec2::from(window.position(column, 3)) * factors[0] * factors[1];
                let [here, there] = [scaled.position(column, 3), product.to_array()];
                assert_eq!(here.map(f64::to_bits), there.map(f64::to_bits));
            }
        }
        let twice = window.scaled(odd).unwrap().scaled(odd);
        assert_eq!(twice, None, "two products would be rounded");
    }

    #[test]
    fn windows_without_pixels_or_extent_are_refused() {
        let kind = |extent: DVec2, size| {
            Window::new(DVec2::ZERO, extent, size)
                .unwrap_err()
                .kind()
                .clone()
        };
        assert!(matches!(
            kind(DVec2::ONE, [0, 5]),
            RasterErrorKind::Empty { size: [0, 5] }
        ));
        assert!(matches!(
            kind(DVec2::ONE, [u32::MAX, 5]),
            RasterErrorKind::TooLarge { .. }
        ));
        assert!(matches!(
            kind(DVec2::new(0.0, 1.0), [5, 5]),
            RasterErrorKind::NotFinite { .. }
        ));
        assert!(matches!(
            kind(DVec2::new(1.0, f64::NAN), [5, 5]),
            RasterErrorKind::NotFinite { .. }
        ));
    }

    #[test]
    fn far_crops_do_not_overflow() {
        let window = Window::unit([4, 4])
            .unwrap()
            .crop([i64::MAX, i64::MIN], [2, 2])
            .unwrap();
        assert!(
            window
                .crop([1, -1], [2, 2])
                .unwrap()
                .position(1, 1)
                .iter()
                .all(|part| part.is_finite())
        );
    }
}
