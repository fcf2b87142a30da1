//! Lists all periodic generators of the workspace.
//!
//! Two groups are left out. Progressions and the ramp of labels are the cow and the giraffe with other options.
//! Textures that follow a reference image are only as uniform as the image, so their seams prove nothing.

use super::{Generator, PERIOD, UNIT};
use anyhow::Result;
use core::f64::consts::{PI, TAU};
use dapple_hash::Seed;
use dapple_noise::{GradientNoise2, GradientNoise4};
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{
    CellsOptions, CellularNoiseOptions, ColorNoiseOptions, CowOptions, NoiseOptions, OctaveSource,
    OctavesOptions, SpaceGiraffeOptions, Spacing, cells, cellular_noise, color_noise, cow, noise,
    octaves, space_giraffe, turbulence,
};
use dapple_raster::glam::{DVec2, DVec3, DVec4};
use dapple_raster::{Field, FieldExt, FractalShape, Raster, Window};
use dapple_tile::SeamOptions;
use dapple_wavelet::{WaveletNoise2, WaveletNoise3, wavelet_tile};
use dapple_worley::{
    Cellular, Combination, FeatureSet, Metric, OctaveSeeds, Octaves, Plane, Radial, RadialCells,
    Worley2, Worley3, Worley4,
};

/// Seam options for textures with a lattice of one cell per unit, or two per unit. Cell boundaries may differ from
/// other boundaries.
const CELLS: SeamOptions = SeamOptions {
    axes: [true; 2],
    lattice: [UNIT; 2],
};

/// Seam options for a map of a sphere, which has cells and repeats only along x.
const AROUND: SeamOptions = SeamOptions {
    axes: [true, false],
    ..CELLS
};

/// Seam options for textures without a lattice, whose statistics are the same everywhere.
const ANYWHERE: SeamOptions = SeamOptions {
    axes: [true; 2],
    lattice: [1; 2],
};

/// All generators.
pub(super) const GENERATORS: &[Generator] = &[
    Generator::new("F1", CELLS, f1),
    Generator::new("F2 - F1", CELLS, f2_minus_f1),
    Generator::new("Manhattan F1", CELLS, manhattan_f1),
    Generator::new("Manhattan F2 - F1", CELLS, manhattan_f2_minus_f1),
    Generator::new("Chebyshev F1", CELLS, chebyshev_f1),
    Generator::new("Minkowski F1", CELLS, minkowski_f1),
    Generator::new("distance to the edge", CELLS, edge_distance),
    Generator::new("smooth F1", CELLS, smooth_f1),
    Generator::new("F1 in space", CELLS, f1_in_space),
    Generator::new("F1 in four dimensions", CELLS, f1_in_four_dimensions),
    Generator::new("fractal F1", CELLS, fractal),
    Generator::new("fractal F1 of one field", CELLS, fractal_of_one_field),
    Generator::new("cell values", CELLS, cell_values),
    Generator::new("radial F1", AROUND, radial),
    Generator::new("F1 of placed points", ANYWHERE, placed_points),
    Generator::new("noise", ANYWHERE, pups_noise),
    Generator::new("octaves", ANYWHERE, separate_octaves),
    Generator::new("rescaled octaves", ANYWHERE, rescaled_octaves),
    Generator::new("turbulence", ANYWHERE, folded_octaves),
    Generator::new("cells", ANYWHERE, pups_cells).twice_as_fine(),
    Generator::new("cellular noise", ANYWHERE, layers_of_cells),
    Generator::new("color noise", ANYWHERE, red_of_color_noise),
    Generator::new("cow", ANYWHERE, pups_cow).twice_as_fine(),
    Generator::new("space giraffe", ANYWHERE, giraffe),
    Generator::new("gradient noise", CELLS, gradient_noise),
    Generator::new(
        "ridged gradient noise in space and time",
        CELLS,
        ridged_noise,
    ),
    Generator::new("wavelet noise", CELLS, wavelet_noise),
    Generator::new("wavelet noise in space", CELLS, wavelet_noise_in_space),
    Generator::new("wavelet tile", CELLS, tile_of_wavelets),
];

impl Generator {
    const fn new(
        name: &'static str,
        options: SeamOptions,
        draw: fn(Seed, &Window) -> Result<Raster<f32>>,
    ) -> Self {
        Self {
            name,
            options,
            unit: UNIT,
            draw,
        }
    }

    /// Returns the generator with twice as many pixels per unit, for patches, whose edges vary more than smooth fields.
    const fn twice_as_fine(self) -> Self {
        Self {
            unit: 2 * UNIT,
            ..self
        }
    }
}

// Worley's cellular basis.

/// Distance over which the nearest feature points are blended, in cells.
const SMOOTH: f32 = 0.25;

/// Returns the 2-D cellular basis with the period of the tiles.
fn worley(seed: Seed) -> Result<Worley2> {
    Ok(Worley2::new(seed).with_period([Some(PERIOD); 2])?)
}

fn manhattan(seed: Seed) -> Result<Worley2> {
    Ok(worley(seed)?.with_metric(Metric::Manhattan)?)
}

fn f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let texture = worley(seed)?.combine(Combination::F1);
    Ok(texture.to_raster(window)?)
}

fn f2_minus_f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let texture = worley(seed)?.combine(Combination::F2_MINUS_F1);
    Ok(texture.to_raster(window)?)
}

fn chebyshev_f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let worley = worley(seed)?.with_metric(Metric::Chebyshev)?;
    Ok(worley.combine(Combination::F1).to_raster(window)?)
}

fn minkowski_f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let worley = worley(seed)?.with_metric(Metric::Minkowski(4.0))?;
    Ok(worley.combine(Combination::F1).to_raster(window)?)
}

fn edge_distance(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let worley = worley(seed)?;
    Ok(Raster::from_window(window, |at| worley.edge_distance(at))?)
}

fn smooth_f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let worley = worley(seed)?;
    worley.smooth_f1(DVec2::ZERO, SMOOTH)?;
    let value = |at| worley.smooth_f1(at, SMOOTH).unwrap_or(f32::NAN);
    Ok(Raster::from_window(window, value)?)
}

fn manhattan_f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let texture = manhattan(seed)?.combine(Combination::F1);
    Ok(texture.to_raster(window)?)
}

fn manhattan_f2_minus_f1(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let texture = manhattan(seed)?.combine(Combination::F2_MINUS_F1);
    Ok(texture.to_raster(window)?)
}

fn f1_in_space(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let period = [Some(PERIOD), Some(PERIOD), None];
    let texture = Worley3::new(seed)
        .with_period(period)?
        .combine(Combination::F1);
    let slice = Plane::slice(DVec3::new(0.0, 0.0, 4.625));
    let mut raster = Raster::filled(window.size, 0.0)?;
    texture.render_plane(&slice, window, raster.view_mut())?;
    Ok(raster)
}

fn f1_in_four_dimensions(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let period = [Some(PERIOD), Some(PERIOD), Some(3), None];
    let texture = Worley4::new(seed)
        .with_period(period)?
        .combine(Combination::F1);
    let slice = Plane::slice(DVec4::new(0.0, 0.0, 2.875, -7.25));
    let mut raster = Raster::filled(window.size, 0.0)?;
    texture.render_plane(&slice, window, raster.view_mut())?;
    Ok(raster)
}

fn fractal_sum(texture: &Cellular<2>, seeds: OctaveSeeds, window: &Window) -> Result<Raster<f32>> {
    let octaves = Octaves {
        count: 3,
        seeds,
        ..Octaves::default()
    };
    Ok(texture.fractal(octaves)?.to_raster(window)?)
}

fn fractal(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    fractal_sum(
        &worley(seed)?.combine(Combination::F1),
        OctaveSeeds::Own,
        window,
    )
}

fn fractal_of_one_field(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    fractal_sum(
        &worley(seed)?.combine(Combination::F1),
        OctaveSeeds::Same,
        window,
    )
}

fn cell_values(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let worley = worley(seed)?;
    let value = |at| worley.sample::<1>(at)[0].cell_value();
    Ok(Raster::from_window(window, value)?)
}

/// Renders a map of the unit sphere by azimuth and polar angle, with one square cell per unit.
fn radial(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let cells = RadialCells {
        around: PERIOD,
        polar: f64::from(PERIOD),
        radial: 0.0,
    };
    let texture = Radial::new(Worley3::new(seed).combine(Combination::F1), cells)?;
    let value = |at: DVec2| {
        let (sin_azimuth, cos_azimuth) = libm::sincos(at.x / cells.polar * TAU);
        let (sin_polar, cos_polar) = libm::sincos(at.y / cells.polar * PI);
        texture.value(DVec3::new(
            cos_azimuth * sin_polar,
            sin_azimuth * sin_polar,
            cos_polar,
        ))
    };
    Ok(Raster::from_window(window, value)?)
}

fn placed_points(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let points = poisson_disk(domain(), 1.0, seed)?;
    let period = [Some(f64::from(PERIOD)); 2];
    let set = FeatureSet::<2>::new(points.positions(), period)?;
    let value = |at: DVec2| set.sample::<1>(at)[0].distance;
    Ok(Raster::from_window(window, value)?)
}

// Partition-of-unity parametrics.

/// Returns the torus that contains the control points.
fn domain() -> Domain {
    Domain::torus(DVec2::ZERO, DVec2::splat(f64::from(PERIOD)))
}

fn pups_noise(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let options = NoiseOptions {
        domain: domain(),
        spacing: Spacing::from(0.75),
        ..NoiseOptions::default()
    };
    Ok(noise(&options, seed)?.to_raster(window)?)
}

fn octaves_options(spacing: f64, source: OctaveSource) -> OctavesOptions {
    OctavesOptions {
        domain: domain(),
        spacing: Spacing::from(spacing),
        octaves: 3,
        source,
        ..OctavesOptions::default()
    }
}

fn separate_octaves(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let octaves = octaves(&octaves_options(1.5, OctaveSource::Separate), seed)?;
    Ok(octaves.to_raster(window)?)
}

fn rescaled_octaves(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let octaves = octaves(&octaves_options(0.75, OctaveSource::Rescaled), seed)?;
    Ok(octaves.to_raster(window)?)
}

fn folded_octaves(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let octaves = turbulence(&octaves_options(0.75, OctaveSource::Rescaled), seed)?;
    Ok(octaves.to_raster(window)?)
}

fn pups_cells(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let options = CellsOptions {
        domain: domain(),
        spacing: Spacing::from(0.25),
        ..CellsOptions::default()
    };
    Ok(cells(&options, seed)?.to_raster(window)?)
}

fn layers_of_cells(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let options = CellularNoiseOptions {
        domain: domain(),
        spacing: Spacing::from(0.75),
        layers: 2,
        ..CellularNoiseOptions::default()
    };
    Ok(cellular_noise(&options, seed)?.to_raster(window)?)
}

fn red_of_color_noise(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let options = ColorNoiseOptions {
        domain: domain(),
        spacing: Spacing::from(0.75),
        ..ColorNoiseOptions::default()
    };
    let colors = color_noise(&options, seed)?.to_raster(window)?;
    Ok(colors.map(|color| color[0]))
}

fn pups_cow(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let options = CowOptions {
        domain: domain(),
        spacing: Spacing::from(0.25),
        ..CowOptions::default()
    };
    Ok(cow(&options, seed)?.to_raster(window)?)
}

fn giraffe(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let options = SpaceGiraffeOptions {
        domain: domain(),
        spacing: Spacing::from(1.3),
        ..SpaceGiraffeOptions::default()
    };
    Ok(space_giraffe(&options, seed)?.to_raster(window)?)
}

// Gradient noise.

fn gradient_noise(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let noise = GradientNoise2::new(seed).with_period([Some(PERIOD); 2])?;
    Ok(noise
        .fractal(3, 0.5, 2.0, FractalShape::Sum)?
        .to_raster(window)?)
}

fn ridged_noise(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let noise = GradientNoise4::new(seed).with_period([Some(PERIOD), Some(PERIOD), None, None])?;
    Ok(noise
        .fractal(3, 0.5, 2.0, FractalShape::Ridged)?
        .slice([0.375, 7.625])
        .to_raster(window)?)
}

// Wavelets.

/// Weights of the wavelet noise bands; the first band has two cells per unit.
const WEIGHTS: [f32; 2] = [1.0, 0.5];

/// Converts a window in units to a window in cells of wavelet noise. A period has `2 * PERIOD` cells.
fn in_half_units(window: &Window) -> Result<Window> {
    let extent = DVec2::new(f64::from(window.size[0]), f64::from(window.size[1]));
    Ok(Window::new(
        DVec2::ZERO,
        extent * 2.0 / f64::from(UNIT),
        window.size,
    )?)
}

fn wavelet_noise(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let noise = WaveletNoise2::new(2 * PERIOD, seed)?.with_weights(&WEIGHTS)?;
    Ok(noise.to_raster(&in_half_units(window)?)?)
}

fn wavelet_noise_in_space(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let noise = WaveletNoise3::new(2 * PERIOD, seed)?.with_weights(&WEIGHTS)?;
    Ok(noise.slice([4.625]).to_raster(&in_half_units(window)?)?)
}

/// Renders a tile with three bands, whose lattice cells are 2^3 pixels wide.
fn tile_of_wavelets(seed: Seed, window: &Window) -> Result<Raster<f32>> {
    let tile = wavelet_tile([PERIOD * UNIT; 2], &[0.5, 1.0, 1.0], seed)?;
    Ok(tile.crop([0; 2], window.size)?)
}
