//! Tests that the seams of tiles that repeat by construction look like any other boundary.
//!
//! Every periodic generator of the workspace draws one period of 32 × 32 units, with 8 or 16 pixels per unit, for
//! each of 50 seeds. On average and at every scale, the step across the seam must equal the step across inner
//! boundaries of the same kind. These are cell boundaries for cellular textures, and any boundary between pixels for
//! textures without a lattice.

mod generators;

use anyhow::Result;
use dapple_hash::Seed;
use dapple_raster::{Raster, Window, glam::DVec2};
use dapple_tile::{SeamOptions, SeamReport};
use generators::GENERATORS;
use rayon::prelude::*;

/// Period of a tile, in units. A unit is a cell of cellular noise.
const PERIOD: u32 = 32;

/// Width of a unit in pixels.
const UNIT: u32 = 8;

/// Number of tiles averaged per generator.
const N_TILES: u64 = 50;

/// Number of tiles per generator that must pass individually. With more tiles, some would fail by chance.
const N_PASSING: usize = 8;

/// Number of crops averaged. It is smaller than the number of tiles, since the crops' ratios are far from 1.
const N_CROPS: u64 = 8;

/// Maximum standard error of a mean ratio. Most errors are below 0.01. The error for spots is near the limit, since
/// spots have few edges.
const LARGEST_ERROR: f64 = 0.03;

/// A generator that draws a window of a periodic texture.
struct Generator {
    name: &'static str,
    options: SeamOptions,
    /// Pixels per unit.
    unit: u32,
    draw: fn(Seed, &Window) -> Result<Raster<f32>>,
}

/// A mean seam ratio over all seeds, with its standard error.
#[derive(Debug)]
struct Ratio {
    width: u32,
    mean: f64,
    error: f64,
}

#[test]
fn tiles_of_generators_have_no_seam() -> Result<()> {
    let mut problems = Vec::new();
    for generator in GENERATORS {
        let name = generator.name;
        let reports = generator.reports(PERIOD, N_TILES)?;
        for (seed, report) in reports.iter().take(N_PASSING).enumerate() {
            if !report.passes() {
                problems.push(format!("{name}, {seed}: {report}"));
            }
        }
        for Ratio { width, mean, error } in ratios(&reports) {
            let off = (mean - 1.0).abs() / error;
            if !(off <= 3.0 && error < LARGEST_ERROR) {
                problems.push(format!("{name} at {width} px: {mean:.4} ± {error:.4}"));
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
    Ok(())
}

#[test]
fn crops_of_generators_have_a_seam() -> Result<()> {
    for generator in GENERATORS {
        let [Ratio { mean, error, .. }, ..] = ratios(&generator.reports(PERIOD * 3 / 4, N_CROPS)?);
        let clearly = mean - 1.0 > 5.0 * error && mean > 1.25;
        assert!(clearly, "{}: {mean:.4} ± {error:.4}", generator.name);
    }
    Ok(())
}

impl Generator {
    /// Returns the seam reports of square images with sides of `units` units, one per seed.
    fn reports(&self, units: u32, n_seeds: u64) -> Result<Vec<SeamReport>> {
        let extent = DVec2::splat(f64::from(units));
        let window = &Window::new(DVec2::ZERO, extent, [units * self.unit; 2])?;
        let report = |seed| -> Result<SeamReport> {
            let tile = (self.draw)(Seed(seed), window)?;
            Ok(SeamReport::of(&tile, &self.options)?)
        };
        (0..n_seeds).into_par_iter().map(report).collect()
    }
}

/// Returns the mean ratios over all axes that repeat, at widths of 1, 2, 4 and 8 pixels.
fn ratios(reports: &[SeamReport]) -> [Ratio; 4] {
    core::array::from_fn(|index| {
        let both = reports.iter().filter_map(|report| report.seams[index].both);
        let ratios: Vec<f64> = both.map(|both| both.ratio).collect();
        let n = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / n;
        let squares: f64 = ratios
            .iter()
            .map(|ratio| (ratio - mean) * (ratio - mean))
            .sum();
        Ratio {
            width: reports[0].seams[index].width,
            mean,
            error: (squares / (n - 1.0) / n).sqrt(),
        }
    })
}
