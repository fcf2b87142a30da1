//! Tests that every field of the workspace repeats with its stated period.

use anyhow::Result;
use dapple_hash::Seed;
use dapple_noise::{GradientNoise2, GradientNoise3};
use dapple_points::Domain;
use dapple_pups::{NoiseOptions, OctavesOptions, noise, octaves};
use dapple_raster::glam::DVec2;
use dapple_raster::{Constant, Field, FieldExt, FractalShape, Window};
use dapple_wavelet::WaveletNoise2;
use dapple_worley::{Combination, Octaves, Worley2, Worley4};

const SEED: Seed = Seed(7);

/// Returns fields with periods of 4 and 2 units along x and y.
fn fields() -> Result<Vec<(&'static str, Box<dyn Field>)>> {
    let periods = [Some(4), Some(2)];
    let worley = Worley2::new(SEED).with_period(periods)?;
    let f1 = worley.combine(Combination::F1);
    let moving = Worley4::new(SEED).with_period([Some(4), Some(2), None, Some(3)])?;
    let moving = moving.combine(Combination::F2_MINUS_F1).slice([0.3, 1.7]);
    let gradient = GradientNoise2::new(SEED).with_period(periods)?;
    let slice = GradientNoise3::new(SEED).with_period([Some(4), Some(2), None])?;
    let domain = Domain {
        origin: DVec2::ZERO,
        size: DVec2::new(4.0, 2.0),
        wrap: [true; 2],
    };
    let pups = NoiseOptions {
        domain,
        spacing: 0.4.into(),
        ..NoiseOptions::default()
    };
    let sum = OctavesOptions {
        domain,
        spacing: 0.5.into(),
        ..OctavesOptions::default()
    };
    Ok(vec![
        ("cells", Box::new(f1.clone())),
        ("fractal cells", Box::new(f1.fractal(Octaves::default())?)),
        ("values of cells", Box::new(worley.cell_values())),
        ("distances to edges", Box::new(worley.edge_distances())),
        ("cells in four dimensions", Box::new(moving)),
        ("gradient noise", Box::new(gradient)),
        ("gradient noise in space", Box::new(slice.slice([0.3]))),
        (
            "ridges",
            Box::new(gradient.fractal(3, 0.5, 2.0, FractalShape::Ridged)?),
        ),
        (
            "wavelet noise",
            Box::new(WaveletNoise2::of_size([8, 4], SEED)?.frequency(2.0)),
        ),
        ("partitions of unity", Box::new(noise(&pups, SEED)?)),
        ("octaves of them", Box::new(octaves(&sum, SEED)?)),
        (
            "warped cells",
            Box::new(f1.warp((gradient, Constant(0.5)), 0.25)),
        ),
    ])
}

#[test]
fn fields_repeat_after_the_period_that_they_state() -> Result<()> {
    for (name, field) in fields()? {
        assert_eq!(field.period(), [Some(4.0), Some(2.0)], "{name}");
        let tile = field.tile_raster([64, 32])?;
        // The pixel size is a power of two, so that positions one period apart are exact.
        let window = Window::new(DVec2::new(-4.0, 2.0), DVec2::new(12.0, 6.0), [192, 96])?;
        let repeats = field.to_raster(&window)?;
        assert!(
            repeats == tile.tile([3, 3])?,
            "{name} repeats to the last bit"
        );
    }
    Ok(())
}
