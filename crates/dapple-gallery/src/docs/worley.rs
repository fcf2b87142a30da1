//! Renders the rows of images for the documentation of `dapple-worley`.

mod cells;
mod combinations;
mod fractals;
mod placing;
mod scatters;
mod spaces;

use super::Documented;
use super::picture::{SAMPLES, SIDE, banner, colored, shaded};
use crate::Panel;
use crate::draw::shrink;
use dapple_color::LinearRgb;
use dapple_raster::{Raster, Window};
use dapple_worley::{Cellular, Dimensions, Space, Worley2, WorleyError, hash::Seed};
use glam::DVec2;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-worley",
    strips: &[
        spaces::AXES,
        scatters::SEED,
        scatters::POISSON,
        scatters::UNCLAMPED,
        scatters::JITTERED,
        scatters::VARYING,
        scatters::PERIOD,
        scatters::CELL_POINTS,
        combinations::METRIC,
        combinations::F1,
        combinations::F2,
        combinations::F3,
        combinations::F4,
        combinations::F2_MINUS_F1,
        combinations::F1_PLUS_F2,
        combinations::F3_MINUS_F1,
        combinations::F3_MINUS_F2,
        combinations::F4_MINUS_F1,
        combinations::F4_MINUS_F3,
        combinations::TWO_F3_MINUS_F2_MINUS_F1,
        combinations::NEW,
        combinations::NORMALIZED,
        combinations::RANGE,
        combinations::GRADIENT,
        cells::FEATURE,
        cells::CELL_VALUE,
        cells::EDGE_DISTANCE,
        cells::SPHERE_RADIUS,
        cells::SMOOTH_F1,
        cells::SPOTS,
        cells::CHANNELS,
        fractals::FRACTAL,
        fractals::COUNT,
        fractals::LACUNARITY,
        fractals::GAIN,
        fractals::SEEDS,
        spaces::PLANE,
        placing::RADIAL,
        placing::RADIAL_CELLS,
        placing::FEATURE_SET,
    ],
    banner: || {
        let figures = [
            ("worley-fig-01", 0),
            ("worley-fig-02", 0),
            ("worley-fig-extra-ids", 0),
            ("worley-fig-extra-metrics", 5),
            ("worley-fig-extra-radial", 0),
        ];
        banner(&figures)
    },
};

/// Number of shades in a gray image.
const SHADES: f32 = 32.0;

/// Number of shades in an image with edges, and per channel in a color image.
const SHADES_WITH_EDGES: f32 = 16.0;

/// Number of positions at which a range is measured.
const N_POSITIONS: u32 = 4000;

/// Returns the Worley basis used by most strips.
fn basis() -> Worley2 {
    Worley2::new(Seed(3))
}

/// Returns a square window, `cells` wide, with its corner at the origin.
fn square(cells: f64) -> anyhow::Result<Window> {
    Ok(Window::new(DVec2::ZERO, DVec2::splat(cells), [SIDE; 2])?)
}

/// Renders smooth values from 0 to 1 as a gray image.
fn gray(label: &str, cells: f64, value: impl Fn(DVec2) -> f32 + Sync) -> anyhow::Result<Panel> {
    let raster = Raster::from_window(&square(cells)?, value)?;
    Ok(shaded(label, &raster, SHADES))
}

/// Renders values with edges, from 0 to 1, as a gray image.
fn gray_with_edges(
    label: &str,
    cells: f64,
    value: impl Fn(DVec2) -> f32 + Sync,
) -> anyhow::Result<Panel> {
    let fine = Raster::from_window(&fine(cells)?, value)?;
    Ok(shaded(label, &shrink(&fine, SAMPLES)?, SHADES_WITH_EDGES))
}

/// Renders colors with edges.
fn color_with_edges(
    label: &str,
    cells: f64,
    value: impl Fn(DVec2) -> LinearRgb + Sync,
) -> anyhow::Result<Panel> {
    let fine = Raster::from_window(&fine(cells)?, value)?;
    Ok(colored(label, &shrink(&fine, SAMPLES)?, SHADES_WITH_EDGES))
}

fn fine(cells: f64) -> anyhow::Result<Window> {
    let size = [SIDE * SAMPLES; 2];
    Ok(Window::new(DVec2::ZERO, DVec2::splat(cells), size)?)
}

/// Returns the texture, scaled so that its measured range becomes 0 to 1.
fn ranged<const N: usize>(texture: Cellular<N>) -> Result<Cellular<N>, WorleyError>
where
    Dimensions: Space<N>,
{
    let range = texture.measure_range(Seed(1), N_POSITIONS)?;
    texture.with_range(range)
}

/// Renders the Voronoi cells of a basis in flat grays, with its feature points as black dots.
fn flat(label: &str, cells: f64, worley: &Worley2) -> anyhow::Result<Panel> {
    let dot = 1.6 * cells as f32 / SIDE as f32;
    gray_with_edges(label, cells, |at| {
        let [nearest] = worley.sample(at);
        if nearest.distance < dot {
            0.0
        } else {
            0.4 + 0.6 * nearest.cell_value()
        }
    })
}

/// Returns a color for a vector. Red increases to the right and green downward; the zero vector is gray. Vectors of the
/// length `longest` are fully saturated.
fn color_of(vector: DVec2, longest: f64) -> LinearRgb {
    let code = |part: f64| (128.0 + 120.0 * (part / longest).clamp(-1.0, 1.0)).round() as u8;
    LinearRgb::from_srgb([code(vector.x), code(vector.y), 128])
}
