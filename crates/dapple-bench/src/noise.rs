//! The noise group: gradient noise beside the fastest peers.
//!
//! Confirmed: both sides have the spread expected of noise, and ours stays within its bounds.

use crate::harness::{Bench, Done, Side};
use crate::peers::noise;
use crate::row::{Case, Must, Unit};
use crate::sets::{SEED, positions};
use anyhow::{Result, ensure};
use dapple_noise::GradientNoise2;
use dapple_raster::glam::DVec2;
use dapple_raster::{Field, Raster, Window};

const COARSE: Case = Case {
    group: "noise",
    case: "gradient noise, 2-D, 1024×1024, 64 px per cell",
    peer: "simdnoise simplex, one octave",
    unit: Unit::NsPerPixel,
    must: Must::Faster(10.0),
    note: "the fastest grid of one octave of Perlin or simplex noise that was found",
};

const FINE: Case = Case {
    case: "gradient noise, 2-D, 1024×1024, 8 px per cell",
    must: Must::Faster(4.0),
    ..COARSE
};

const ONE_POSITION: Case = Case {
    group: "noise",
    case: "gradient noise, 2-D, one position",
    peer: "noise-functions Perlin, one octave",
    unit: Unit::NsPerPosition,
    must: Must::CostAtMost(6.0),
    note: "ours hashes 64-bit cells with a 64-bit seed and repeats nowhere",
};

/// Columns and rows of the pictures.
const SIDE: u32 = 1024;

/// The number of positions per run.
const N_POSITIONS: usize = 1 << 16;

/// Measures the rows of the group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    picture(bench, &COARSE, 64)?;
    picture(bench, &FINE, 8)?;
    if bench.wants(&ONE_POSITION) {
        let field = GradientNoise2::new(SEED);
        beside_perlin(bench, &ONE_POSITION, 128, |at| field.sample(at), confirm)?;
    }
    Ok(())
}

fn picture(bench: &mut Bench, case: &Case, px_per_cell: u32) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let cells = f64::from(SIDE / px_per_cell);
    let window = Window::new(DVec2::ZERO, DVec2::splat(cells), [SIDE; 2])?;
    let field = GradientNoise2::new(SEED);
    let ours = Side::new(
        Raster::filled([SIDE; 2], 0.0)?,
        |raster: &mut Raster<f32>| {
            // The raster has the size of the window, so this cannot fail.
            let _ = field.render(&window, raster.view_mut());
        },
    );
    let theirs = Side::new((Vec::new(), 0.0, 0.0), |grid: &mut noise::Grid| {
        *grid = noise::simdnoise_simplex([SIDE as usize; 2], 1.0 / px_per_cell as f32);
    })
    .prepared(|grid| grid.0 = Vec::new());
    bench.beside(
        case,
        51,
        ours.times(2),
        theirs,
        |raster, (grid, least, largest)| {
            confirm(raster.pixels())?;
            ensure!(
                largest - least > 0.03,
                "the peer's grid is flat: {least} to {largest}"
            );
            Ok(Done {
                ours: raster.pixels().len(),
                theirs: grid.len(),
            })
        },
    )
}

/// Measures single positions, anywhere in a square of `cells`, beside Perlin noise of `noise-functions`.
pub(crate) fn beside_perlin(
    bench: &mut Bench,
    case: &Case,
    cells: u32,
    sample: impl Fn(DVec2) -> f32 + Sync,
    confirm: impl Fn(&[f32]) -> Result<()>,
) -> Result<()> {
    let at: Vec<DVec2> = positions(N_POSITIONS)
        .into_iter()
        .map(|at| at * f64::from(cells))
        .collect();
    let their_at: Vec<[f32; 2]> = at.iter().map(|at| at.as_vec2().to_array()).collect();
    let ours = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        for (value, &at) in values.iter_mut().zip(&at) {
            *value = sample(at);
        }
    });
    let theirs = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        noise::noise_functions_perlin(&their_at, values);
    });
    bench.beside(case, 101, ours, theirs, |ours, theirs| {
        confirm(ours)?;
        confirm_spread(theirs)?;
        Ok(Done::both(N_POSITIONS))
    })
}

/// Checks that the mean square of noise values is above 0.01.
pub(crate) fn confirm_spread(values: &[f32]) -> Result<()> {
    let spread = values.iter().map(|value| value * value).sum::<f32>();
    ensure!(
        spread > 0.01 * values.len() as f32,
        "the noise is flat: {spread}"
    );
    Ok(())
}

/// Checks that values are within the bound, and that their variance is near the stated one.
fn confirm(values: &[f32]) -> Result<()> {
    let past = values
        .iter()
        .find(|value| value.abs() > GradientNoise2::BOUND);
    ensure!(past.is_none(), "{past:?} is past the bound");
    let sum: f64 = values
        .iter()
        .map(|&value| f64::from(value) * f64::from(value))
        .sum();
    let variance = sum / values.len() as f64;
    // The coarsest picture has few cells.
    ensure!(
        (0.05..0.15).contains(&variance),
        "the variance is {variance}"
    );
    Ok(())
}
