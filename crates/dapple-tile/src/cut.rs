//! Finds a cut between two images along the path where they are most similar.
//!
//! The first image is visible to the left of the cut, the second to the right. In each row the cut passes through one
//! pixel, and it moves at most one column from row to row. The cheapest of all such paths is used, as by Alexei A.
//! Efros and William T. Freeman, "Image Quilting for Texture Synthesis and Transfer", SIGGRAPH 2001,
//! <https://doi.org/10.1145/383259.383296>.
//!
//! The difference of two images at a pixel is the sum over all planes of their squared differences. Each plane is
//! divided by its variance, so a height in meters counts as much as a color. Across the cut, the images are blended
//! along a short smooth ramp. They are similar there, so a mean does no harm. All other pixels are copies. In each row,
//! the cost of a cut is the variance that the mean loses: the sum over the ramp's pixels of the difference times w (1 -
//! w), where w is the weight.

use crate::cut_path::{closed_path, open_path, path_between};
use crate::error::check;
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;

/// Half-width of the ramp across a cut between different tiles, in pixels.
const HALF_WIDTH: f64 = 2.0;

/// The columns that a cut and its ramp may occupy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Band {
    /// First column.
    pub(crate) first: u32,
    /// Number of columns.
    pub(crate) count: u32,
}

/// Constraint on the first and the last pixel of a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// The cut may start and end in any column.
    Free,
    /// The last pixel is at most one column from the first one. Used for rows that repeat.
    Closed,
    /// The cut starts and ends in the given columns.
    At([u32; 2]),
}

/// A cut. In each row it has one pixel, at which both weights are ½.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    columns: Vec<u32>,
    half_width: f64,
}

impl Cut {
    /// Finds the cheapest cut in a band. `scales` are the factors of the planes' differences; see [`scales`].
    pub(crate) fn cheapest(
        images: [&[Raster<f32>]; 2],
        scales: &[f64],
        band: Band,
        ends: Ends,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, TileError> {
        let half_width = half_width(band);
        // Even if the band has no columns, there is a column to its right.
        let size = [
            band.count.max(1),
            images[0].first().map_or(1, Raster::height),
        ];
        // Sum the squared differences of all planes.
        let mut differences = Raster::filled(size, 0.0)?;
        for ((a, b), scale) in images[0].iter().zip(images[1]).zip(scales) {
            check(is_cancelled)?;
            add_differences([a, b], band.first as usize, *scale, &mut differences);
        }
        check(is_cancelled)?;
        // Find the path with the lowest total cost, among the columns in which the ramp fits into the band.
        let costs = costs(&differences, half_width)?;
        // Paths are relative to the columns at which the whole ramp fits into the band.
        let first = band.first + inset(half_width);
        let mut columns = match ends {
            Ends::Free => open_path(&costs, is_cancelled),
            Ends::Closed => closed_path(&costs, is_cancelled),
            Ends::At(ends) => path_between(&costs, ends.map(|column| column - first), is_cancelled),
        }?;
        columns.iter_mut().for_each(|column| *column += first);
        Ok(Self {
            columns,
            half_width,
        })
    }

    /// Builds a cut straight down the middle of a band.
    pub(crate) fn straight(band: Band, height: u32) -> Self {
        Self {
            columns: vec![band.first + band.count / 2; height as usize],
            half_width: half_width(band),
        }
    }

    /// Returns the columns of the cut's first and last pixel.
    pub(crate) fn ends(&self) -> [u32; 2] {
        [self.columns[0], self.columns[self.columns.len() - 1]]
    }

    /// Returns the weight of the second image at a pixel.
    pub(crate) fn weight(&self, column: u32, row: u32) -> f64 {
        let cut = self.columns[row as usize];
        weight(f64::from(column) - f64::from(cut), self.half_width)
    }

    /// Joins the two images along the cut.
    pub(crate) fn join(&self, [a, b]: [&Raster<f32>; 2]) -> Result<Raster<f32>, TileError> {
        a.check_same_size(b.size())?;
        Ok(Raster::from_rows(a.size(), |row| {
            let pixels = a.row(row).iter().zip(b.row(row)).zip(0..);
            pixels.map(move |((&a, &b), column)| mix(a, b, self.weight(column, row)))
        })?)
    }
}

/// Returns the half-width of the ramp across a cut in a band, limited so that the ramp fits into the band.
fn half_width(band: Band) -> f64 {
    HALF_WIDTH.min(f64::from(band.count) / 2.0)
}

/// Computes the cost of a cut through each pixel whose ramp fits into the band.
fn costs(differences: &Raster<f64>, half_width: f64) -> Result<Raster<f64>, TileError> {
    let inset = inset(half_width);
    // Loss of variance at each pixel of the ramp, w (1 - w).
    let factors: Vec<f64> = (0..=2 * inset)
        .map(|column| weight(f64::from(column) - f64::from(inset), half_width))
        .map(|weight| weight * (1.0 - weight))
        .collect();
    let size = [differences.width() - 2 * inset, differences.height()];
    // Sum the differences over the ramp, multiplied by that loss.
    Ok(Raster::from_fn(size, |column, row| {
        let pixels = &differences.row(row)[column as usize..][..factors.len()];
        let products = pixels.iter().zip(&factors);
        products
            .map(|(difference, factor)| difference * factor)
            .sum()
    })?)
}

/// Interpolates linearly between two values. The result is exact at both ends.
pub(crate) fn mix(a: f32, b: f32, weight: f64) -> f32 {
    match weight {
        0.0 => a,
        1.0 => b,
        _ => (f64::from(a) * (1.0 - weight) + f64::from(b) * weight) as f32,
    }
}

/// Returns the weight of the image to the right of a cut, given the distance from the cut in columns. It is 0 to the
/// left, 1 to the right, and ½ on the cut.
pub(crate) fn weight(from_cut: f64, half_width: f64) -> f64 {
    if half_width > 0.0 {
        cubic_ramp((from_cut + half_width) / (2.0 * half_width))
    } else {
        f64::from(u8::from(from_cut >= 0.0))
    }
}

/// Returns the number of columns at each end of a band that the cut avoids, so that its ramp stays inside.
pub(crate) fn inset(half_width: f64) -> u32 {
    (half_width.ceil() as u32).saturating_sub(1)
}

/// Adds the squared differences of two planes to the costs, whose columns start at `first`.
pub(crate) fn add_differences(
    [a, b]: [&Raster<f32>; 2],
    first: usize,
    scale: f64,
    costs: &mut Raster<f64>,
) {
    for (row, costs) in (0..).zip(costs.view_mut().rows_mut()) {
        let [a, b] = [a, b].map(|plane| &plane.row(row)[first..]);
        for ((cost, a), b) in costs.iter_mut().zip(a).zip(b) {
            let difference = (f64::from(*a) - f64::from(*b)) * scale;
            *cost += difference * difference;
        }
    }
}

/// Returns, for each plane, the reciprocal of the root of its mean variance over all materials; 0 if it is constant in
/// each.
pub(crate) fn scales(materials: &[&[Raster<f32>]]) -> Vec<f64> {
    let n_planes = materials.first().map_or(0, |planes| planes.len());
    let scale = |plane: usize| {
        let deviations = materials
            .iter()
            .map(|planes| planes[plane].statistics().deviation);
        let variance = deviations.map(|d| d * d).sum::<f64>() / materials.len() as f64;
        if variance > 0.0 {
            1.0 / variance.sqrt()
        } else {
            0.0
        }
    };
    (0..n_planes).map(scale).collect()
}

/// Returns the cubic 3t² − 2t³, which rises from 0 to 1 for `t` from 0 to 1 and is constant outside.
fn cubic_ramp(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::{Band, Cut, Ends, scales};
    use dapple_hash::{Seed, hash2};
    use dapple_raster::Raster;

    /// Returns an image of small integers, so that sums are exact in any order.
    fn image(seed: u64, size: [u32; 2]) -> Raster<f32> {
        let value = |x: u32, y: u32| hash2(Seed(seed), [x.into(), y.into()], 0) % 8;
        Raster::from_fn(size, |x, y| value(x, y) as f32).unwrap()
    }

    /// Returns the cost of a cut, Σ w (1 - w) d² over all pixels.
    fn price(cut: &Cut, images: [&Raster<f32>; 2]) -> f64 {
        let [width, height] = images[0].size();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let lost = pixels.map(|(x, y)| {
            let [a, b] = images.map(|image| f64::from(image.row(y)[x as usize]));
            let weight = cut.weight(x, y);
            weight * (1.0 - weight) * (a - b) * (a - b)
        });
        lost.sum()
    }

    /// Returns all cuts in columns `from..=to` that move at most one column from row to row.
    fn all_cuts(from: u32, to: u32, height: usize, half_width: f64) -> Vec<Cut> {
        let mut paths: Vec<Vec<u32>> = (from..=to).map(|column| vec![column]).collect();
        for _ in 1..height {
            let longer = |path: Vec<u32>| {
                let end = path[path.len() - 1];
                let next = (from..=to).filter(move |column| column.abs_diff(end) <= 1);
                next.map(move |column| [path.as_slice(), &[column]].concat())
            };
            paths = paths.into_iter().flat_map(longer).collect();
        }
        let cut = |columns| Cut {
            columns,
            half_width,
        };
        paths.into_iter().map(cut).collect()
    }

    #[test]
    fn cheapest_loses_no_more_than_any_other_cut_of_its_kind() {
        for (size, band, [from, to], half_width) in [
            ([9, 5], [1, 7], [2, 6], 2.0),
            ([6, 6], [0, 6], [1, 4], 2.0),
            ([5, 4], [1, 3], [2, 2], 1.5),
            ([4, 6], [1, 2], [1, 2], 1.0),
            ([3, 5], [1, 1], [1, 1], 0.5),
        ] {
            let band = Band {
                first: band[0],
                count: band[1],
            };
            for seed in 0..20 {
                let images = [seed, seed + 100].map(|seed| image(seed, size));
                let [a, b] = [&images[..1], &images[1..]];
                for ends in [Ends::Free, Ends::Closed, Ends::At([from, to.min(from + 2)])] {
                    let found = Cut::cheapest([a, b], &[1.0], band, ends, &|| false).unwrap();
                    let holds = |cut: &Cut| match ends {
                        Ends::Free => true,
                        Ends::Closed => cut.ends()[0].abs_diff(cut.ends()[1]) <= 1,
                        Ends::At(ends) => cut.ends() == ends,
                    };
                    let all = all_cuts(from, to, size[1] as usize, half_width);
                    let all = all.iter().filter(|cut| holds(cut));
                    let prices = all.map(|cut| price(cut, [&a[0], &b[0]]));
                    let best = prices.fold(f64::INFINITY, f64::min);
                    let price = price(&found, [&a[0], &b[0]]);
                    assert!(holds(&found), "{ends:?}: {found:?}");
                    // The sums have the same terms in another order.
                    let gap = price - best;
                    assert!(
                        gap <= 1e-12 * best,
                        "{gap}: seed {seed}, {size:?}, {ends:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn join_is_the_first_image_on_the_left_and_the_second_on_the_right() {
        let images = [1.0, 2.0].map(|value| Raster::filled([20, 9], value).unwrap());
        let band = Band { first: 5, count: 8 };
        let cut = Cut::straight(band, 9);
        let joined = cut.join([&images[0], &images[1]]).unwrap();
        for row in joined.view().rows() {
            assert!(row[..8].iter().all(|value| *value == 1.0), "{row:?}");
            assert!(row[8..11].is_sorted() && row[9] == 1.5, "{row:?}");
            assert!(row[11..].iter().all(|value| *value == 2.0), "{row:?}");
        }
    }

    #[test]
    fn scales_make_planes_of_unlike_units_count_alike() {
        let plane = image(1, [20, 20]);
        let flat = plane.map(|_| 3.0);
        let planes = [plane.clone(), plane.map(|value| 1000.0 * value), flat];
        let [one, thousand, none] = scales(&[&planes, &planes])[..] else {
            panic!("a scale for each plane")
        };
        assert!((one / thousand / 1000.0 - 1.0).abs() < 1e-6);
        assert_eq!(none, 0.0);
    }
}
