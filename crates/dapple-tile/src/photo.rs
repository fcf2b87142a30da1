//! Prepares photographs for tiles: evens out their light, and resamples the tile.

use crate::map::{color_from_planes, exactly};
use crate::{Map, TileError};
use dapple_color::LinearRgb;
use dapple_raster::glam::DVec2;
use dapple_raster::{Range, Raster, Wrap, parallel, range};

/// The radius of [`even_out`], in pixels.
const RADIUS: Range = range!(from 1 to 65536);

/// Ratio of the light removed from a color to the mean light, at least: dark corners get at most 16 times brighter.
const LEAST_LIGHT: f64 = 1.0 / 16.0;

/// Removes changes of light and tone over distances of more than `radius` pixels, such as vignettes and shadows.
///
/// The slow part of each plane is a local linear fit with Gaussian weights, whose standard deviation is `radius`. So a
/// linear change is removed up to the borders of the image. Colors are divided by their slow part and multiplied by
/// their mean, each channel on its own. The slow part of values is subtracted and their mean added. Normals are
/// returned unchanged.
///
/// # Errors
///
/// [`TileErrorKind::Range`](crate::TileErrorKind::Range) if the radius is not from 1 to 65536.
///
/// # Examples
///
/// ```
/// use dapple_tile::raster::Raster;
/// use dapple_tile::{Map, even_out};
///
/// // A ramp has no detail: its mean is left.
/// let ramp = Raster::from_fn([64, 48], |x, _| x as f32)?;
/// let Map::Value(flat) = even_out(&Map::Value(ramp), 16.0)? else { unreachable!() };
/// assert!(flat.pixels().iter().all(|value| (value - 31.5).abs() < 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn even_out(map: &Map, radius: f64) -> Result<Map, TileError> {
    TileError::check(
        RADIUS.holds(radius),
        "radius of the light",
        radius,
        RADIUS.text,
    )?;
    let is_color = match map {
        Map::Normal(_) => return Ok(map.clone()),
        Map::Color(_) => true,
        Map::Value(_) => false,
    };
    let planes = map.planes();
    let even = planes
        .iter()
        .map(|plane| even_plane(plane, radius, is_color));
    map.with_planes(even.collect::<Result<_, _>>()?)
}

fn even_plane(plane: &Raster<f32>, radius: f64, is_color: bool) -> Result<Raster<f32>, TileError> {
    let [columns, rows] = plane.size().map(|side| Cells::new(side, radius));
    let slow = slow_part(plane, &columns, &rows, radius);
    let mean = plane.statistics().mean;
    let mut even = plane.clone();
    let width = plane.width() as usize;
    parallel::for_each_chunk(even.pixels_mut(), width, |row, pixels| {
        // Interpolate between the rows of the cells, then between their columns.
        let (at, share) = rows.place(row as f64 + 0.5);
        let across: Vec<f64> = (0..columns.n())
            .map(|column| {
                let [top, bottom] = [at, at + 1].map(|row| slow[row * columns.n() + column]);
                top + (bottom - top) * share
            })
            .collect();
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let (at, share) = columns.place(column as f64 + 0.5);
            let light = across[at] + (across[at + 1] - across[at]) * share;
            let value = f64::from(*pixel);
            // Light multiplies colors; other values only drift.
            *pixel = match is_color {
                true if mean > 0.0 => value * (mean / light.max(mean * LEAST_LIGHT)),
                true => value,
                false => value + (mean - light),
            } as f32;
        }
    });
    Ok(even)
}

/// A line of pixels divided into cells of similar length, each a quarter of the radius.
struct Cells {
    /// The first pixel of each cell, and the end of the last one.
    bounds: Vec<u32>,
    centers: Vec<f64>,
}

impl Cells {
    fn new(side: u32, radius: f64) -> Self {
        // Two cells at least, so that positions have a cell on both sides; a line of one pixel has it twice.
        let n = ((4.0 * f64::from(side) / radius).ceil() as u32).clamp(2, side.max(2));
        let bound = |cell: u32| (u64::from(side) * u64::from(cell) / u64::from(n)) as u32;
        let mut bounds: Vec<u32> = (0..=n).map(bound).collect();
        if side == 1 {
            bounds = vec![0, 1, 1];
        }
        let center = |ends: &[u32]| f64::from(ends[0] + ends[1]) / 2.0;
        let centers = bounds.windows(2).map(center).collect();
        Self { bounds, centers }
    }

    fn n(&self) -> usize {
        self.centers.len()
    }

    /// Returns the cell before a position, and the share of the next cell. Positions before the first center and past
    /// the last one are extrapolated.
    fn place(&self, position: f64) -> (usize, f64) {
        let after = self.centers.partition_point(|&center| center <= position);
        let at = after.saturating_sub(1).min(self.n() - 2);
        let [from, to] = [self.centers[at], self.centers[at + 1]];
        (at, (position - from) / (to - from))
    }

    /// Returns, for each cell, the weights of all cells in the local linear fit at its center.
    fn fits(&self, radius: f64) -> Vec<Vec<f64>> {
        let lengths = self
            .bounds
            .windows(2)
            .map(|ends| f64::from(ends[1] - ends[0]));
        let lengths: Vec<f64> = lengths.collect();
        let fit = |&center: &f64| {
            let steps: Vec<f64> = self.centers.iter().map(|other| other - center).collect();
            let bell = |step: f64| libm::exp(-0.5 * (step / radius) * (step / radius));
            let bells: Vec<f64> = steps
                .iter()
                .zip(&lengths)
                .map(|(&step, length)| length * bell(step))
                .collect();
            // The value at the center of the weighted least-squares line, as weights of the samples.
            let moment = |power: i32| -> f64 {
                let terms = steps.iter().zip(&bells);
                terms
                    .map(|(step, bell)| bell * (0..power).fold(1.0, |product, _| product * step))
                    .sum()
            };
            let [s0, s1, s2] = [moment(0), moment(1), moment(2)];
            let scale = s0 * s2 - s1 * s1;
            match scale > 0.0 {
                true => steps
                    .iter()
                    .zip(&bells)
                    .map(|(step, bell)| bell * (s2 - s1 * step) / scale)
                    .collect(),
                // One cell has all the weight.
                false => bells.iter().map(|bell| bell / s0).collect(),
            }
        };
        self.centers.iter().map(fit).collect()
    }
}

/// Returns the slow part of a plane at the centers of the cells, row by row.
fn slow_part(plane: &Raster<f32>, columns: &Cells, rows: &Cells, radius: f64) -> Vec<f64> {
    let means = parallel::map(rows.n(), |row| {
        let lines = rows.bounds[row]..rows.bounds[row + 1];
        let mean = |ends: &[u32]| {
            let pixels = lines
                .clone()
                .flat_map(|line| &plane.row(line)[ends[0] as usize..ends[1] as usize]);
            let (sum, count) = pixels.fold((0.0, 0.0), |(sum, count), &pixel| {
                (sum + f64::from(pixel), count + 1.0)
            });
            if count > 0.0 { sum / count } else { 0.0 }
        };
        columns.bounds.windows(2).map(mean).collect::<Vec<f64>>()
    });
    let sum = |weights: &[f64], value: &dyn Fn(usize) -> f64| -> f64 {
        weights
            .iter()
            .enumerate()
            .map(|(at, weight)| weight * value(at))
            .sum()
    };
    let across = columns.fits(radius);
    let rows_of: Vec<Vec<f64>> = means
        .iter()
        .map(|row| {
            across
                .iter()
                .map(|weights| sum(weights, &|at| row[at]))
                .collect()
        })
        .collect();
    let down = rows.fits(radius);
    let columns_of = |weights: &Vec<f64>| -> Vec<f64> {
        (0..columns.n())
            .map(|column| sum(weights, &|row| rows_of[row][column]))
            .collect()
    };
    down.iter().flat_map(columns_of).collect()
}

/// Resamples a map to `size` pixels. Each pixel of a smaller map is the mean of the area that it covers, and pixels of a
/// larger map are interpolated. Colors are resampled in linear light, normals as slopes.
///
/// `wrap` is the continuation past the borders along each axis: [`Wrap::Repeat`] for tiles, which then still repeat.
///
/// # Errors
///
/// [`TileErrorKind::Raster`](crate::TileErrorKind::Raster) if the new size has no pixels or too many.
pub fn resize(map: &Map, size: [u32; 2], wrap: [Wrap; 2]) -> Result<Map, TileError> {
    let planes = map.planes().into_iter();
    let resized = planes.map(|plane| resize_plane(&plane, size, wrap));
    map.with_planes(resized.collect::<Result<_, TileError>>()?)
}

/// Resamples a plane; see [`resize`].
pub(crate) fn resize_plane(
    plane: &Raster<f32>,
    size: [u32; 2],
    wrap: [Wrap; 2],
) -> Result<Raster<f32>, TileError> {
    let area = DVec2::new(1.0 / f64::from(size[0]), 1.0 / f64::from(size[1]));
    let mut resized = Raster::filled(size, 0.0)?;
    parallel::for_each_chunk(resized.pixels_mut(), size[0] as usize, |row, pixels| {
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let uv = (DVec2::new(column as f64, row as f64) + 0.5) * area;
            *pixel = plane.sample_area(uv, area, wrap);
        }
    });
    Ok(resized)
}

/// Resamples colors with straight alpha by `resample`, such as [`resize`]. Each color counts by its alpha, so that the
/// colors of clear pixels do not bleed in. Where the new alpha is 0, the color is 0.
///
/// # Errors
///
/// Those of `resample`, and [`TileErrorKind::Raster`](crate::TileErrorKind::Raster) if the sizes differ.
///
/// # Examples
///
/// ```
/// use dapple_tile::color::LinearRgb;
/// use dapple_tile::raster::{Raster, Wrap};
/// use dapple_tile::{resample_with_alpha, resize};
///
/// // Every other pixel is white and opaque, and the others are black and clear.
/// let alpha = Raster::from_fn([4, 4], |x, _| (x % 2) as f32)?;
/// let colors = alpha.map(|&alpha| LinearRgb::gray(alpha));
/// let half = |map: &_| resize(map, [2, 2], [Wrap::Repeat; 2]);
/// let (colors, alpha) = resample_with_alpha(&colors, &alpha, half)?;
/// assert_eq!((colors.row(0)[0], alpha.row(0)[0]), (LinearRgb::WHITE, 0.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn resample_with_alpha(
    colors: &Raster<LinearRgb>,
    alpha: &Raster<f32>,
    resample: impl Fn(&Map) -> Result<Map, TileError>,
) -> Result<(Raster<LinearRgb>, Raster<f32>), TileError> {
    // Resample premultiplied colors, so that hidden colors do not bleed into visible pixels.
    let weighted = colors.zip_map(alpha, |&color, &alpha| color * alpha)?;
    let planes = |map: &Map| Ok::<_, TileError>(resample(map)?.planes());
    let sums = color_from_planes(planes(&Map::Color(weighted))?)?;
    let [alpha] = exactly(planes(&Map::Value(alpha.clone()))?)?;
    let color = |&sum: &LinearRgb, &alpha: &f32| match alpha > 0.0 {
        true => sum * (1.0 / alpha),
        false => sum,
    };
    Ok((sums.zip_map(&alpha, color)?, alpha))
}

#[cfg(test)]
mod tests {
    use super::{Cells, even_out, resize};
    use crate::test_fields::{fbm, gravel, same_on_threads, seam_ratio};
    use crate::{Map, Method, Seamless, TileErrorKind};
    use dapple_color::{LinearRgb, Normal};
    use dapple_raster::{Raster, Wrap};

    fn values(map: Map) -> Raster<f32> {
        match map {
            Map::Value(raster) => raster,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn even_out_removes_slow_changes_and_keeps_the_mean_and_detail() {
        let detail = gravel(1, [240, 200], false);
        let lit = Raster::from_fn([240, 200], |x, y| {
            detail.row(y)[x as usize] + 0.0125 * x as f32 - 0.01 * y as f32
        })
        .unwrap();
        let mean = lit.statistics().mean;
        let even = values(even_out(&Map::Value(lit.clone()), 60.0).unwrap());
        assert!(
            (even.statistics().mean - mean).abs() < 0.01,
            "{:?}",
            even.statistics()
        );
        // The detail alone, evened out in the same way: the ramp is gone up to rounding, since the fit is linear.
        let shift = mean - detail.statistics().mean;
        let alone = values(even_out(&Map::Value(detail), 60.0).unwrap());
        for (a, b) in even.pixels().iter().zip(alone.pixels()) {
            assert!((f64::from(a - b) - shift).abs() < 1e-4, "{a} {b}");
        }
    }

    #[test]
    fn even_out_of_light_that_multiplies_leaves_one_color() {
        let lit = Raster::from_fn([120, 90], |x, y| {
            let light = 0.2 + 0.005 * x as f32 + 0.003 * y as f32;
            LinearRgb::new(light, 0.5 * light, 0.25 * light)
        })
        .unwrap();
        let Map::Color(even) = even_out(&Map::Color(lit), 30.0).unwrap() else {
            panic!("the kind stays");
        };
        let first = even.pixels()[0];
        for color in even.pixels() {
            // Interpolation between the cells rounds in f64; the products round to f32.
            assert!(
                (color.r - first.r).abs() < 1e-5 && (color.b - first.b).abs() < 1e-5,
                "{color:?}"
            );
        }
        assert!((first.g / first.r - 0.5).abs() < 1e-5, "{first:?}");
    }

    #[test]
    fn even_out_takes_away_the_step_across_the_wrap() {
        let size = [200, 160];
        let source = fbm(4, size, true);
        let lit =
            Raster::from_fn(size, |x, y| source.row(y)[x as usize] + 0.02 * x as f32).unwrap();
        let [before, after] = [
            Map::Value(lit.clone()),
            even_out(&Map::Value(lit), 50.0).unwrap(),
        ]
        .map(values);
        let [before, after] = [before, after].map(|raster| seam_ratio(&raster, 1));
        assert!(before > 4.0 && after < 0.5 * before, "{before} {after}");
    }

    #[test]
    fn even_out_leaves_normals_and_refuses_radii() {
        let up = Map::Normal(
            Raster::filled(
                [4, 4],
                Normal {
                    x: 0.6,
                    y: 0.0,
                    z: 0.8,
                },
            )
            .unwrap(),
        );
        assert_eq!(even_out(&up, 2.0).unwrap(), up);
        let flat = Map::Value(Raster::filled([1, 3], 2.0).unwrap());
        assert_eq!(even_out(&flat, 1.0).unwrap(), flat);
        for radius in [0.0, 0.99, 65537.0, f64::NAN, f64::INFINITY] {
            let error = even_out(&flat, radius).unwrap_err();
            assert!(
                matches!(error.kind(), TileErrorKind::Range { .. }),
                "{radius}"
            );
        }
    }

    #[test]
    fn cells_cover_the_line_once() {
        for side in [1, 2, 3, 7, 100, 3001] {
            for radius in [1.0, 3.0, 64.0, 9000.0] {
                let cells = Cells::new(side, radius);
                assert_eq!(
                    (cells.bounds[0], cells.bounds[cells.n()]),
                    (0, side),
                    "{side} {radius}"
                );
                assert!(
                    cells.n() >= 2 && cells.bounds.is_sorted(),
                    "{side} {radius}"
                );
                for x in 0..side {
                    assert!(
                        cells.place(f64::from(x) + 0.5).1.is_finite(),
                        "{side} {radius} {x}"
                    );
                }
            }
        }
    }

    #[test]
    fn resize_averages_areas_and_keeps_periods() {
        let image = fbm(2, [64, 48], true);
        let half = values(resize(&Map::Value(image.clone()), [32, 24], [Wrap::Repeat; 2]).unwrap());
        for (x, y) in [(0, 0), (31, 23), (7, 11)] {
            let four = [0, 1].map(|dy| [0, 1].map(|dx| image.row(2 * y + dy)[2 * x + dx]));
            let mean = (four[0][0] + four[0][1] + four[1][0] + four[1][1]) / 4.0;
            assert!((half.row(y)[x] - mean).abs() < 1e-6, "{x} {y}");
        }
        // A tile resized and repeated is the repeated tile resized.
        let twice = image.tile([2, 2]).unwrap();
        let of_twice = values(resize(&Map::Value(twice), [80, 60], [Wrap::Repeat; 2]).unwrap());
        let once = values(resize(&Map::Value(image.clone()), [40, 30], [Wrap::Repeat; 2]).unwrap());
        for (a, b) in of_twice
            .pixels()
            .iter()
            .zip(once.tile([2, 2]).unwrap().pixels())
        {
            // The positions are rounded at another scale.
            assert!((a - b).abs() < 1e-5, "{a} {b}");
        }
        assert_eq!(
            values(resize(&Map::Value(image.clone()), [64, 48], [Wrap::Repeat; 2]).unwrap()),
            image
        );
        assert!(resize(&Map::Value(image), [0, 4], [Wrap::Repeat; 2]).is_err());
    }

    #[test]
    fn resized_normals_are_unit_vectors() {
        let tilted = Raster::from_fn([8, 8], |x, _| match x % 2 {
            0 => Normal {
                x: 0.6,
                y: 0.0,
                z: 0.8,
            },
            _ => Normal {
                x: 0.0,
                y: 0.6,
                z: 0.8,
            },
        })
        .unwrap();
        let Map::Normal(small) = resize(&Map::Normal(tilted), [4, 4], [Wrap::Repeat; 2]).unwrap()
        else {
            panic!("the kind stays");
        };
        // The mean of the slopes 0.75 and 0 is 0.375 along both axes.
        let length = (0.375_f32 * 0.375 * 2.0 + 1.0).sqrt();
        for normal in small.pixels() {
            assert!(
                (normal.x - 0.375 / length).abs() < 1e-6 && (normal.z - 1.0 / length).abs() < 1e-6,
                "{normal:?}"
            );
        }
    }

    #[test]
    fn even_out_and_resize_have_the_same_bits_on_any_number_of_threads() {
        let image = Map::Value(gravel(3, [90, 70], false));
        assert!(same_on_threads(|| values(even_out(&image, 20.0).unwrap())));
        assert!(same_on_threads(|| values(
            resize(&image, [50, 200], [Wrap::Repeat; 2]).unwrap()
        )));
        let tile = Seamless::new(Method::Periodic).apply_maps(&[even_out(&image, 20.0).unwrap()]);
        assert!(tile.is_ok());
    }
}
