//! Views, which are borrowed rectangles of pixels with a stride.

use crate::parallel;
use crate::{RasterError, RasterErrorKind};

/// A rectangle of pixels, borrowed for reading.
#[derive(Clone, Copy, Debug)]
pub struct RasterView<'a, T> {
    data: &'a [T],
    stride: usize,
    size: [u32; 2],
}

/// A rectangle of pixels, borrowed for writing.
#[derive(Debug)]
pub struct RasterViewMut<'a, T> {
    data: &'a mut [T],
    stride: usize,
    size: [u32; 2],
}

impl<'a, T> RasterView<'a, T> {
    /// Creates a view of existing memory. It holds rows of `size[0]` pixels, whose starts are `stride` elements
    /// apart.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Length`] if `data` is too short, or if the stride is smaller than the width.
    pub fn new(data: &'a [T], stride: usize, size: [u32; 2]) -> Result<Self, RasterError> {
        check(data.len(), stride, size)?;
        Ok(Self { data, stride, size })
    }

    /// Creates a view of all pixels of a raster. The caller has checked the length of `data`.
    pub(crate) fn whole(data: &'a [T], size: [u32; 2]) -> Self {
        Self {
            data,
            stride: size[0] as usize,
            size,
        }
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the pixels of a row, from left to right.
    ///
    /// # Panics
    ///
    /// If `row` is not below the height.
    #[must_use]
    #[inline]
    pub fn row(&self, row: u32) -> &'a [T] {
        assert!(row < self.size[1], "row {row} of {}", self.size[1]);
        let start = row as usize * self.stride;
        &self.data[start..start + self.size[0] as usize]
    }

    /// Returns the rows from top to bottom.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &'a [T]> {
        let view = RasterView {
            data: self.data,
            ..*self
        };
        (0..view.size[1]).map(move |row| view.row(row))
    }

    /// Returns a view of the rectangle of `size` pixels whose top left pixel is at `first` (column, row).
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::OutOfBounds`] if the rectangle extends beyond this view.
    pub fn crop(&self, first: [u32; 2], size: [u32; 2]) -> Result<Self, RasterError> {
        let range = crop_range(self.stride, self.size, first, size)?;
        Ok(Self {
            data: &self.data[range],
            stride: self.stride,
            size,
        })
    }
}

impl<'a, T> RasterViewMut<'a, T> {
    /// Creates a view of existing memory. It holds rows of `size[0]` pixels, whose starts are `stride` elements
    /// apart.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Length`] if `data` is too short, or if the stride is smaller than the width.
    pub fn new(data: &'a mut [T], stride: usize, size: [u32; 2]) -> Result<Self, RasterError> {
        check(data.len(), stride, size)?;
        Ok(Self { data, stride, size })
    }

    /// Creates a view of all pixels of a raster. The caller has checked the length of `data`.
    pub(crate) fn whole(data: &'a mut [T], size: [u32; 2]) -> Self {
        Self {
            data,
            stride: size[0] as usize,
            size,
        }
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the pixels of a row, from left to right.
    ///
    /// # Panics
    ///
    /// If `row` is not below the height.
    #[must_use]
    #[inline]
    pub fn row_mut(&mut self, row: u32) -> &mut [T] {
        assert!(row < self.size[1], "row {row} of {}", self.size[1]);
        let start = row as usize * self.stride;
        &mut self.data[start..start + self.size[0] as usize]
    }

    /// Returns the rows from top to bottom.
    pub fn rows_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        let [width, height] = self.size.map(|side| side as usize);
        self.data
            .chunks_mut(self.stride)
            .take(height)
            .map(move |row| &mut row[..width])
    }

    /// Consumes the view and returns its rows from top to bottom, borrowed for the lifetime of the pixels.
    pub fn into_rows(self) -> impl Iterator<Item = &'a mut [T]> {
        let [width, height] = self.size.map(|side| side as usize);
        let rows = self.data.chunks_mut(self.stride).take(height);
        rows.map(move |row| &mut row[..width])
    }

    /// Reborrows the pixels for a shorter lifetime.
    #[must_use]
    pub fn reborrow(&mut self) -> RasterViewMut<'_, T> {
        RasterViewMut {
            data: self.data,
            stride: self.stride,
            size: self.size,
        }
    }

    /// Returns a view of the rectangle of `size` pixels whose top left pixel is at `first` (column, row).
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::OutOfBounds`] if the rectangle extends beyond this view.
    pub fn crop(self, first: [u32; 2], size: [u32; 2]) -> Result<Self, RasterError> {
        let range = crop_range(self.stride, self.size, first, size)?;
        Ok(Self {
            data: &mut self.data[range],
            stride: self.stride,
            size,
        })
    }

    /// Splits the view into bands of `height` rows; the last one may have fewer. Bands share no pixels, so that
    /// separate threads can fill them.
    ///
    /// # Panics
    ///
    /// If `height` is zero.
    pub fn bands(self, height: u32) -> impl ExactSizeIterator<Item = RasterViewMut<'a, T>> {
        assert!(height > 0, "a band has at least one row");
        let (stride, [width, rows]) = (self.stride, self.size);
        let bands = self.data.chunks_mut(stride * height as usize).enumerate();
        bands
            .take(rows.div_ceil(height) as usize)
            .map(move |(band, data)| {
                // There are at most `u32::MAX` rows, so the product fits.
                let above = band as u32 * height;
                RasterViewMut {
                    data,
                    stride,
                    size: [width, height.min(rows - above)],
                }
            })
    }
}

impl<T: Send> RasterViewMut<'_, T> {
    /// Calls `fill` with the first row and the view of every band of `height` rows (the last one may have fewer), on
    /// all cores if the feature `rayon` is enabled.
    ///
    /// # Panics
    ///
    /// If `height` is zero.
    pub fn for_each_band(self, height: u32, fill: impl Fn(u32, RasterViewMut<'_, T>) + Sync) {
        // There are at most `u32::MAX` rows, so the product fits.
        parallel::consume(self.bands(height).collect(), |band, view| {
            fill(band as u32 * height, view);
        });
    }
}

impl<T: Copy> RasterViewMut<'_, T> {
    /// Sets every pixel to `value`.
    pub fn fill(&mut self, value: T) {
        self.rows_mut().for_each(|row| row.fill(value));
    }
}

/// Checks that the memory is long enough for all rows.
fn check(length: usize, stride: usize, size: [u32; 2]) -> Result<(), RasterError> {
    let [width, height] = size.map(|side| side as usize);
    if width == 0 || height == 0 {
        return Err(RasterError::new(RasterErrorKind::Empty { size }));
    }
    if stride < width {
        return Err(RasterError::new(RasterErrorKind::Length {
            length: stride,
            needed: width,
        }));
    }
    match (height - 1)
        .checked_mul(stride)
        .and_then(|above| above.checked_add(width))
    {
        Some(needed) if needed <= length => Ok(()),
        needed => Err(RasterError::new(RasterErrorKind::Length {
            length,
            needed: needed.unwrap_or(usize::MAX),
        })),
    }
}

/// Returns the range of memory elements from the first to the last pixel of a rectangle.
fn crop_range(
    stride: usize,
    bounds: [u32; 2],
    first: [u32; 2],
    size: [u32; 2],
) -> Result<core::ops::Range<usize>, RasterError> {
    if size.contains(&0) {
        return Err(RasterError::new(RasterErrorKind::Empty { size }));
    }
    let fits = |axis: usize| {
        first[axis]
            .checked_add(size[axis])
            .is_some_and(|end| end <= bounds[axis])
    };
    if !fits(0) || !fits(1) {
        return Err(RasterError::new(RasterErrorKind::OutOfBounds {
            first,
            size,
            bounds,
        }));
    }
    let [x, y] = first.map(|side| side as usize);
    let [width, height] = size.map(|side| side as usize);
    let start = y * stride + x;
    Ok(start..start + (height - 1) * stride + width)
}
