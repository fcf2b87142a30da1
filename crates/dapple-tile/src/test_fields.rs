//! Textures for tests, and measurements of them.

use crate::axis::transpose;
use crate::{IsCancelled, TileError, TileErrorKind};
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::Raster;
use dapple_raster::glam::DVec2;

/// Returns five octaves of gradient noise. The first octave has 5 cells per side if it repeats, and otherwise cells of
/// 25 pixels at a random offset.
pub(crate) fn fbm(seed: u64, size: [u32; 2], repeats: bool) -> Raster<f32> {
    let octave = |octave: u32| {
        let seed = Seed(seed).child("octave", octave.into());
        let n_cells = 5 << octave;
        let lattice = Lattice::new(seed, size, n_cells, repeats, 25.3 / f64::from(1 << octave));
        let amplitude = 1.0 / f64::from(1 << octave);
        move |x: u32, y: u32| amplitude * lattice.gradient_noise(lattice.place(x, y))
    };
    let octaves = [0, 1, 2, 3, 4].map(octave);
    let value = |x, y| octaves.iter().map(|octave| octave(x, y)).sum::<f64>();
    Raster::from_fn(size, |x, y| value(x, y) as f32).unwrap()
}

/// Returns stones of about 9 pixels with dark joints. Each stone has a constant shade.
pub(crate) fn gravel(seed: u64, size: [u32; 2], repeats: bool) -> Raster<f32> {
    let seed = Seed(seed).child("gravel", 0);
    let lattice = Lattice::new(seed, size, size[0] / 9, repeats, 9.3);
    Raster::from_fn(size, |x, y| lattice.stone(lattice.place(x, y)) as f32).unwrap()
}

/// A square lattice of random numbers over the pixels.
struct Lattice {
    seed: Seed,
    /// Width and height of a cell, in pixels.
    cell: DVec2,
    /// Position of the first pixel, in cells.
    offset: DVec2,
    /// Period of the numbers, in cells.
    period: i64,
}

impl Lattice {
    fn new(seed: Seed, size: [u32; 2], n_cells: u32, repeats: bool, cell: f64) -> Self {
        let hash = CellHash::new(seed.child("offset", 0), []);
        let offset = DVec2::new(unit_f64(hash.at(0)), unit_f64(hash.at(1)));
        let side = DVec2::new(size[0].into(), size[1].into());
        if repeats {
            let (cell, period) = (side / f64::from(n_cells), n_cells.into());
            Self {
                seed,
                cell,
                offset,
                period,
            }
        } else {
            let (cell, period) = (DVec2::splat(cell), i64::MAX);
            Self {
                seed,
                cell,
                offset,
                period,
            }
        }
    }

    fn place(&self, x: u32, y: u32) -> DVec2 {
        DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / self.cell + self.offset
    }

    fn hash(&self, node: DVec2) -> CellHash {
        let node = [node.x as i64, node.y as i64].map(|at| at.rem_euclid(self.period));
        CellHash::new(self.seed, node)
    }

    fn gradient_noise(&self, place: DVec2) -> f64 {
        let node = place.floor();
        let [x, y] = (place - node).to_array();
        let smooth = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let corner = |at: DVec2| {
            let angle = unit_f64(self.hash(node + at).at(0)) * core::f64::consts::TAU;
            DVec2::new(libm::cos(angle), libm::sin(angle)).dot(place - node - at)
        };
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let above = mix(corner(DVec2::ZERO), corner(DVec2::X), smooth(x));
        let below = mix(corner(DVec2::Y), corner(DVec2::ONE), smooth(x));
        mix(above, below, smooth(y))
    }

    fn stone(&self, place: DVec2) -> f64 {
        let (mut nearest, mut next, mut shade) = (f64::INFINITY, f64::INFINITY, 0.0);
        for y in -2..=2 {
            for x in -2..=2 {
                let node = place.floor() + DVec2::new(x.into(), y.into());
                let hash = self.hash(node);
                let point = node + DVec2::new(unit_f64(hash.at(0)), unit_f64(hash.at(1)));
                let distance = point.distance(place);
                if distance < nearest {
                    (next, nearest, shade) = (nearest, distance, unit_f64(hash.at(2)));
                } else if distance < next {
                    next = distance;
                }
            }
        }
        ((next - nearest) / 0.4).min(1.0) * (0.3 + 0.7 * shade)
    }
}

/// Exchanges the rows and columns of a raster.
pub(crate) fn turned(raster: &Raster<f32>) -> Raster<f32> {
    transpose(raster).unwrap()
}

/// Joins two rasters horizontally.
pub(crate) fn beside(left: &Raster<f32>, right: &Raster<f32>) -> Raster<f32> {
    let size = [left.width() + right.width(), left.height()];
    Raster::from_rows(size, |row| {
        left.row(row).iter().chain(right.row(row)).copied()
    })
    .unwrap()
}

/// Returns the mean absolute difference of the means of `px` pixels on both sides of a column's left border.
pub(crate) fn step_at(raster: &Raster<f32>, column: u32, px: u32) -> f64 {
    let [from, at, to] = [column - px, column, column + px].map(|column| column as usize);
    let mean = |values: &[f32]| values.iter().map(|v| f64::from(*v)).sum::<f64>() / f64::from(px);
    let rows = raster.view();
    let steps = rows
        .rows()
        .map(|row| (mean(&row[from..at]) - mean(&row[at..to])).abs());
    steps.sum::<f64>() / f64::from(raster.height())
}

/// Returns the step where two rasters meet, divided by the mean of all steps inside both.
pub(crate) fn seam_ratio_of(left: &Raster<f32>, right: &Raster<f32>, px: u32) -> f64 {
    let seam = step_at(&beside(left, right), left.width(), px);
    let inside = |raster: &Raster<f32>| {
        let columns = px..=raster.width() - px;
        let count = f64::from(raster.width() - 2 * px + 1);
        columns
            .map(|column| step_at(raster, column, px))
            .sum::<f64>()
            / count
    };
    seam / (0.5 * (inside(left) + inside(right)))
}

/// Returns the mean seam ratio of a tile with itself along both axes.
pub(crate) fn seam_ratio(tile: &Raster<f32>, px: u32) -> f64 {
    let turned = turned(tile);
    0.5 * (seam_ratio_of(tile, tile, px) + seam_ratio_of(&turned, &turned, px))
}

/// Returns the power of the highest frequencies, as the mean square of fourth differences along both axes inside the
/// raster.
pub(crate) fn top_power(raster: &Raster<f32>) -> f64 {
    let along_rows = |raster: &Raster<f32>| {
        let rows = raster.view();
        let squares = rows.rows().flat_map(|row| row.windows(5)).map(|v| {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|at| f64::from(v[at]));
            let difference = a - 4.0 * b + 6.0 * c - 4.0 * d + e;
            difference * difference
        });
        squares.sum::<f64>() / f64::from((raster.width() - 4) * raster.height())
    };
    0.5 * (along_rows(raster) + along_rows(&turned(raster)))
}

/// Returns the mean variance of many rasters around their common mean.
pub(crate) fn variance(rasters: &[Raster<f32>]) -> f64 {
    let statistics: Vec<_> = rasters.iter().map(Raster::statistics).collect();
    let mean_of = |value: &dyn Fn(usize) -> f64| {
        (0..rasters.len()).map(value).sum::<f64>() / rasters.len() as f64
    };
    let mean = mean_of(&|index| statistics[index].mean);
    mean_of(&|index| {
        let off = statistics[index].mean - mean;
        statistics[index].deviation * statistics[index].deviation + off * off
    })
}

/// Returns whether the result has the same bits on one, two and seven threads.
pub(crate) fn same_on_threads(result: impl Fn() -> Raster<f32> + Send + Sync) -> bool {
    let on = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let raster = pool.unwrap().install(&result);
        raster.map(|value| value.to_bits())
    };
    let one = on(1);
    [2, 7].into_iter().all(|count| on(count) == one)
}

/// Checks that cancellation at each call gives the typed error, and that the result is unchanged without cancellation.
/// Returns the number of calls.
pub(crate) fn check_cancel<T: PartialEq + core::fmt::Debug>(
    made: &T,
    make: impl Fn(&IsCancelled) -> Result<T, TileError>,
) -> usize {
    let calls = AtomicUsize::new(0);
    let count = |last| {
        calls.store(0, Relaxed);
        move |calls: &AtomicUsize| calls.fetch_add(1, Relaxed) >= last
    };
    let never = count(usize::MAX);
    assert_eq!(make(&|| never(&calls)).as_ref(), Ok(made));
    let n_calls = calls.load(Relaxed);
    for last in 0..n_calls {
        let is_over = count(last);
        let error = make(&|| is_over(&calls)).unwrap_err();
        assert_eq!(error.kind(), &TileErrorKind::Cancelled, "at call {last}");
    }
    n_calls
}
