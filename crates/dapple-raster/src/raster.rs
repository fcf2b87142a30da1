//! Rasters, which are images that own their pixels.

use crate::parallel;
use crate::window::check_size;
use crate::{RasterError, RasterErrorKind, RasterView, RasterViewMut, Window, Wrap};
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
use glam::DVec2;

/// An image of `width × height` values, stored row by row from the top without gaps.
///
/// A raster is never empty and has at most 2^31 pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster<T> {
    data: Vec<T>,
    size: [u32; 2],
}

impl<T> Raster<T> {
    /// Creates a raster of `size` pixels from their values, row by row.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`] for an invalid size, [`RasterErrorKind::Length`] if
    /// the number of values does not match the number of pixels.
    pub fn from_vec(size: [u32; 2], data: Vec<T>) -> Result<Self, RasterError> {
        check_size(size)?;
        let needed = size[0] as usize * size[1] as usize;
        RasterError::check_length(data.len(), needed)?;
        Ok(Self { data, size })
    }

    /// Creates a raster of `size` pixels with the values `value(column, row)`.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`] for an invalid size.
    pub fn from_fn(
        size: [u32; 2],
        mut value: impl FnMut(u32, u32) -> T,
    ) -> Result<Self, RasterError> {
        check_size(size)?;
        let mut data = Vec::with_capacity(size[0] as usize * size[1] as usize);
        for row in 0..size[1] {
            data.extend((0..size[0]).map(|column| value(column, row)));
        }
        Ok(Self { data, size })
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.size[0]
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.size[1]
    }

    /// Returns the pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[T] {
        &self.data
    }

    /// Returns the pixels for writing, row by row from the top.
    #[must_use]
    pub fn pixels_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// Consumes the raster and returns its pixels, row by row from the top.
    #[must_use]
    pub fn into_pixels(self) -> Vec<T> {
        self.data
    }

    /// Returns the pixels of a row, from left to right.
    ///
    /// # Panics
    ///
    /// If `row` is not below the height.
    #[must_use]
    pub fn row(&self, row: u32) -> &[T] {
        self.view().row(row)
    }

    /// Returns a view of all pixels, for reading.
    #[must_use]
    pub fn view(&self) -> RasterView<'_, T> {
        RasterView::whole(&self.data, self.size)
    }

    /// Returns a view of all pixels, for writing.
    #[must_use]
    pub fn view_mut(&mut self) -> RasterViewMut<'_, T> {
        RasterViewMut::whole(&mut self.data, self.size)
    }

    /// Returns a raster of the same size with the results of `change` for every pixel.
    #[must_use]
    pub fn map<U>(&self, change: impl FnMut(&T) -> U) -> Raster<U> {
        Raster {
            data: self.data.iter().map(change).collect(),
            size: self.size,
        }
    }

    /// Combines two rasters of the same size, pixel by pixel.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::SizeMismatch`] if the sizes differ.
    pub fn zip_map<U, V>(
        &self,
        other: &Raster<U>,
        mut combine: impl FnMut(&T, &U) -> V,
    ) -> Result<Raster<V>, RasterError> {
        self.check_same_size(other.size)?;
        let data = self
            .data
            .iter()
            .zip(&other.data)
            .map(|(a, b)| combine(a, b))
            .collect();
        Ok(Raster {
            data,
            size: self.size,
        })
    }

    /// Checks that `size` equals this raster's size.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::SizeMismatch`] if the sizes differ.
    pub fn check_same_size(&self, size: [u32; 2]) -> Result<(), RasterError> {
        check_same_size(size, self.size)
    }

    /// Returns the pixel at `[column, row]`. A position outside the raster is wrapped by the mode for each axis.
    #[must_use]
    #[inline]
    pub fn at(&self, column: i64, row: i64, wrap: [Wrap; 2]) -> &T {
        let [x, y] = [
            wrap[0].index(column, self.size[0]),
            wrap[1].index(row, self.size[1]),
        ];
        &self.data[y as usize * self.size[0] as usize + x as usize]
    }
}

impl<T: Copy> Raster<T> {
    /// Creates a raster of `size` pixels that all have the same value.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`] for an invalid size.
    pub fn filled(size: [u32; 2], value: T) -> Result<Self, RasterError> {
        check_size(size)?;
        Ok(Self {
            data: vec![value; size[0] as usize * size[1] as usize],
            size,
        })
    }

    /// Copies the pixels of a view.
    #[must_use]
    pub fn from_view(view: RasterView<'_, T>) -> Self {
        let mut data = Vec::with_capacity(view.size()[0] as usize * view.size()[1] as usize);
        view.rows().for_each(|row| data.extend_from_slice(row));
        Self {
            data,
            size: view.size(),
        }
    }

    /// Copies the rectangle of `size` pixels whose top left pixel is at `first` (column, row).
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::OutOfBounds`] if the rectangle extends beyond the raster, [`RasterErrorKind::Empty`] if it
    /// contains no pixel.
    pub fn crop(&self, first: [u32; 2], size: [u32; 2]) -> Result<Self, RasterError> {
        Ok(Self::from_view(self.view().crop(first, size)?))
    }

    /// Repeats the raster `count[0]` times along x and `count[1]` times along y, which makes seams visible.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`] if the resulting size is invalid.
    pub fn tile(&self, count: [u32; 2]) -> Result<Self, RasterError> {
        let size = [
            self.size[0].saturating_mul(count[0]),
            self.size[1].saturating_mul(count[1]),
        ];
        check_size(size)?;
        let row = |row: u32| self.row(row % self.size[1]).repeat(count[0] as usize);
        Ok(Self {
            data: (0..size[1]).flat_map(row).collect(),
            size,
        })
    }
}

impl<T: Sync> Raster<T> {
    /// Returns a raster of the same size with the results of `change` for every pixel. Runs on all cores if the
    /// feature `rayon` is enabled.
    #[must_use]
    pub fn par_map<U: Send>(&self, change: impl Fn(&T) -> U + Sync) -> Raster<U> {
        let data = parallel::map_parts(BAND_PIXELS, self.data.len(), &|part| {
            self.data[part].iter().map(&change).collect()
        });
        let size = self.size;
        Raster { data, size }
    }
}

/// Number of pixels that are computed at a time, unless a single row has more.
const BAND_PIXELS: usize = 4096;

/// Number of pixels between two calls of a callback that cancels, unless a single row has more.
const CANCEL_PIXELS: u32 = 1 << 16;

impl<T: Send> Raster<T> {
    /// Computes `value` at the pixel centers of `window`, on all cores if the feature `rayon` is enabled.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`] for an invalid size.
    pub fn from_window(
        window: &Window,
        value: impl Fn(DVec2) -> T + Sync,
    ) -> Result<Self, RasterError> {
        Self::of_window(window, &value)
    }

    /// Implements [`from_window`](Self::from_window) through a trait object.
    #[inline(never)]
    fn of_window(
        window: &Window,
        value: &(dyn Fn(DVec2) -> T + Sync),
    ) -> Result<Self, RasterError> {
        Self::from_rows(window.size, |row| {
            let y = window.row_y(row);
            (0..window.size[0]).map(move |column| value(DVec2::new(window.column_x(column), y)))
        })
    }

    /// Creates a raster from independently computed rows, on all cores if the feature `rayon` is enabled.
    ///
    /// `row` returns the values of a row from left to right; values beyond the width are ignored.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::Empty`] or [`RasterErrorKind::TooLarge`] for an invalid size, [`RasterErrorKind::Length`] if
    /// a row is too short.
    pub fn from_rows<I>(size: [u32; 2], row: impl Fn(u32) -> I + Sync) -> Result<Self, RasterError>
    where
        I: IntoIterator<Item = T>,
    {
        Self::until(size, &|_| false, row)
    }

    /// Creates a raster from independently computed rows like [`from_rows`](Self::from_rows), or returns `None` if
    /// `is_cancelled` returns true. It is called once per 65,536 pixels, or for each row if a row has more; from any
    /// thread, and not again after it has returned true.
    ///
    /// # Errors
    ///
    /// Same as [`from_rows`](Self::from_rows).
    pub fn from_rows_cancellable<I>(
        size: [u32; 2],
        is_cancelled: &(dyn Fn() -> bool + Sync),
        row: impl Fn(u32) -> I + Sync,
    ) -> Result<Option<Self>, RasterError>
    where
        I: IntoIterator<Item = T>,
    {
        let n_rows = (CANCEL_PIXELS / size[0].max(1)).max(1);
        let is_over = AtomicBool::new(false);
        let made = Self::until(
            size,
            &|row| {
                let asks = row.is_multiple_of(n_rows) && !is_over.load(Relaxed);
                if asks && is_cancelled() {
                    is_over.store(true, Relaxed);
                }
                is_over.load(Relaxed)
            },
            row,
        );
        // The rows that are missing are an error of the length.
        match is_over.into_inner() {
            true => Ok(None),
            false => made.map(Some),
        }
    }

    /// Creates a raster from rows. Stops at rows for which `is_over` is true.
    fn until<I>(
        size: [u32; 2],
        is_over: &(dyn Fn(u32) -> bool + Sync),
        row: impl Fn(u32) -> I + Sync,
    ) -> Result<Self, RasterError>
    where
        I: IntoIterator<Item = T>,
    {
        check_size(size)?;
        let width = size[0] as usize;
        // Group narrow rows into pieces.
        let n_rows = BAND_PIXELS / width;
        let data = parallel::map_parts(n_rows, size[1] as usize, &|rows| {
            let mut values = Vec::with_capacity(width * rows.len());
            for index in rows.map(|index| index as u32) {
                if is_over(index) {
                    break;
                }
                values.extend(row(index).into_iter().take(width));
            }
            values
        });
        Self::from_vec(size, data)
    }
}

/// Checks that two sizes are equal.
pub(crate) fn check_same_size(size: [u32; 2], needed: [u32; 2]) -> Result<(), RasterError> {
    if size == needed {
        Ok(())
    } else {
        Err(RasterError::new(RasterErrorKind::SizeMismatch {
            size,
            needed,
        }))
    }
}

#[cfg(test)]
mod tests;
