//! The worley group: rasters and scattered positions of Worley's cellular basis.
//!
//! A raster has 1024×1024 pixels in the plane, 128×128×128 in space, slice by slice, or 64×64×16×16 in four
//! dimensions, in preallocated memory. `px_per_cell` is the number of pixels of a unit cell along each axis. Our side
//! has three feature points per cell on average and is exact, and its time includes creating the points. Confirmed:
//! the values equal [`Cellular::value`] or [`Worley::sample`] bit for bit, none is negative, and their mean equals the
//! known mean.
//!
//! [`Worley::sample`]: dapple_worley::Worley::sample

mod alone;
#[cfg(feature = "peers")]
mod beside_peers;
mod digest;
mod edges;
mod features;
#[cfg(feature = "peers")]
mod scattered;
mod two_builds;

use crate::harness::{Bench, Side};
use crate::sets::SEED;
use anyhow::{Result, ensure};
use dapple_raster::{Raster, Window};
use dapple_worley::{Cellular, Combination, Dimensions, Plane, Space, Vector, Worley};
use glam::DVec2;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    {
        beside_peers::run(bench)?;
        scattered::run(bench)?;
    }
    alone::run(bench)?;
    features::run(bench)?;
    edges::run(bench)?;
    two_builds::run(bench)
}

/// Size of a raster in the plane, in pixels.
const PLANE: [u32; 2] = [1024; 2];

/// Size of a raster in space, in pixels.
const SPACE: [u32; 3] = [128; 3];

/// A combination of distances and its known mean over all positions, with three feature points per cell.
#[derive(Clone, Copy, Debug)]
struct Known {
    combination: Combination,
    mean: f64,
}

/// F1 in the plane.
#[cfg(feature = "peers")]
const F1: Known = Known {
    combination: Combination::F1,
    mean: 0.282,
};

/// F2 − F1 in the plane.
const F2_MINUS_F1: Known = Known {
    combination: Combination::F2_MINUS_F1,
    mean: 0.145,
};

/// F2 − F1 in space.
const F2_MINUS_F1_IN_SPACE: Known = Known {
    mean: 0.128,
    ..F2_MINUS_F1
};

/// A cellular texture, and a raster divided into slices along the first two axes.
struct Grid<const N: usize>
where
    Dimensions: Space<N>,
{
    size: [u32; N],
    px_per_cell: u32,
    cellular: Cellular<N>,
    mean: f64,
    window: Window,
    slices: Vec<Plane<N>>,
}

impl<const N: usize> Grid<N>
where
    Dimensions: Space<N>,
{
    /// Creates a raster of `size` pixels that starts at the origin, with `px_per_cell` pixels per cell along each axis.
    fn new(known: Known, size: [u32; N], px_per_cell: u32) -> Result<Self> {
        Self::of(&Worley::new(SEED), known, size, px_per_cell)
    }

    /// Creates a raster like [`new`](Self::new), from the given basis.
    fn of(worley: &Worley<N>, known: Known, size: [u32; N], px_per_cell: u32) -> Result<Self> {
        let px = f64::from(px_per_cell);
        let extent = DVec2::new(f64::from(size[0]), f64::from(size[1])) / px;
        let n_slices: u32 = size[2..].iter().product();
        let slices = (0..n_slices).map(|mut index| {
            let mut origin = [0.0; N];
            for (coordinate, &side) in origin.iter_mut().zip(&size).skip(2) {
                *coordinate = (f64::from(index % side) + 0.5) / px;
                index /= side;
            }
            Plane::slice(Vector::<N>::from(origin))
        });
        Ok(Self {
            size,
            px_per_cell,
            cellular: worley.combine(known.combination),
            mean: known.mean,
            window: Window::new(DVec2::ZERO, extent, [size[0], size[1]])?,
            slices: slices.collect(),
        })
    }

    /// Returns the number of pixels of the raster.
    fn n_pixels(&self) -> usize {
        self.window.n_pixels() * self.slices.len()
    }

    /// Returns a black raster in which the slices are stacked vertically.
    fn image(&self) -> Result<Raster<f32>> {
        let [width, height] = self.window.size;
        Ok(Raster::filled(
            [width, height * self.slices.len() as u32],
            0.0,
        )?)
    }

    /// Renders all slices.
    fn render(&self, image: &mut Raster<f32>) {
        let bands = image.view_mut().bands(self.window.size[1]);
        let slices = self.slices.iter().copied().zip(bands);
        self.cellular
            .render_slices(&self.window, slices.collect())
            .expect("a band has the window's size");
    }

    /// Returns a side that renders the raster.
    fn side(&self) -> Result<Side<'_, Raster<f32>>> {
        Ok(Side::new(self.image()?, |image: &mut Raster<f32>| {
            self.render(image);
        }))
    }

    /// Checks a raster: its values at some pixels, and the range, mean and spread of all values.
    fn confirm(&self, image: &Raster<f32>) -> Result<()> {
        let [width, height] = self.window.size;
        // The stride is a prime, so that the checked pixels cover all positions within a tile.
        for index in (0..self.n_pixels() as u32).step_by(1009) {
            let (column, row) = (index % width, index / width);
            let plane = &self.slices[(row / height) as usize];
            let position = plane.position(self.window.position(column, row % height));
            let (found, expected) = (
                image.row(row)[column as usize],
                self.cellular.value(position),
            );
            ensure!(
                found.to_bits() == expected.to_bits(),
                "pixel {column}, {row} is {found}, and {expected} at its position"
            );
        }
        let found = image.statistics();
        ensure!(
            found.n_not_finite == 0 && found.min >= 0.0,
            "differences of sorted distances are not negative: {found:?}"
        );
        // The values in `n` cells are counted as `n` independent values. The tolerance is three relative standard
        // deviations of their mean (0.5 for one value), plus the rounding of the known mean to three digits.
        let px = f64::from(self.px_per_cell);
        let n_cells: f64 = self.size.iter().map(|&side| f64::from(side) / px).product();
        let stray = 0.01 + 1.5 / n_cells.sqrt();
        ensure!(
            (found.mean / self.mean - 1.0).abs() <= stray,
            "a mean of {} is not known, {} up to {stray} of it is",
            found.mean,
            self.mean
        );
        ensure!(
            f64::from(found.min) < 0.5 * self.mean && f64::from(found.max) > 1.5 * self.mean,
            "the raster is flat: {found:?}"
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn confirm_accepts_a_raster_and_refuses_a_changed_pixel() {
        let grid = Grid::new(F2_MINUS_F1_IN_SPACE, [64, 48, 32], 4).expect("a raster of space");
        let mut image = grid.image().expect("memory");
        assert!(
            grid.confirm(&image).is_err(),
            "a black raster is not F2 − F1"
        );
        grid.render(&mut image);
        grid.confirm(&image).expect("what was rendered");
        let first = &mut image.pixels_mut()[0];
        *first = f32::from_bits(first.to_bits() + 1);
        assert!(
            grid.confirm(&image).is_err(),
            "one bit of one pixel is wrong"
        );
    }

    #[test]
    fn slices_go_through_all_axes_but_two() {
        let grid = Grid::new(F2_MINUS_F1, [8, 4, 3, 2], 2).expect("a raster of four dimensions");
        let origins: Vec<[f64; 4]> = grid
            .slices
            .iter()
            .map(|slice| slice.origin.to_array())
            .collect();
        assert_eq!(grid.n_pixels(), 8 * 4 * 3 * 2, "every pixel is in a slice");
        assert_eq!(
            origins[0],
            [0.0, 0.0, 0.25, 0.25],
            "pixel centers are half a pixel in"
        );
        assert_eq!(
            origins[1],
            [0.0, 0.0, 0.75, 0.25],
            "the third axis goes first"
        );
        assert_eq!(
            origins[5],
            [0.0, 0.0, 1.25, 0.75],
            "3×2 slices, the last one"
        );
    }
}
