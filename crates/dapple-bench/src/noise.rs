//! The noise group: gradient noise compared with the fastest peers.
//!
//! Confirmed: both sides have the variance expected of noise, and ours stays within its bounds.

use crate::harness::{Bench, Done, Side};
use crate::peers::noise;
use crate::row::{Case, Goal, Unit};
use crate::sets::{SEED, positions_in};
use anyhow::{Result, ensure};
use dapple_noise::{GradientNoise2, GradientNoise3};
use dapple_raster::glam::DVec2;
use dapple_raster::{Field, FieldExt, FractalShape, Gradient, Raster, Window};

const COARSE: Case = Case {
    group: "noise",
    case: "gradient noise, 2-D, 1024×1024, 64 px per cell",
    peer: "simdnoise simplex, one octave",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(10.0),
    note: "the fastest grid of one octave of Perlin or simplex noise that was found",
};

const FINE: Case = Case {
    case: "gradient noise, 2-D, 1024×1024, 8 px per cell",
    must: Goal::Faster(4.0),
    ..COARSE
};

const ONE_POSITION: Case = Case {
    group: "noise",
    case: "gradient noise, 2-D, one position",
    peer: "noise-functions Perlin, one octave, one position",
    unit: Unit::NsPerPosition,
    must: Goal::CostAtMost(2.0),
    note: "ours takes positions of 64 bits and repeats nowhere; the peer takes 32 bits",
};

const ONE_POSITION_IN_SPACE: Case = Case {
    case: "gradient noise, 3-D, one position",
    ..ONE_POSITION
};

const MANY_POSITIONS: Case = Case {
    case: "gradient noise, 2-D, many scattered positions",
    must: Goal::CostAtMost(0.5),
    note: "`sample_many` beside the peer's only function, which takes one position",
    ..ONE_POSITION
};

const MANY_POSITIONS_IN_SPACE: Case = Case {
    case: "gradient noise, 3-D, many scattered positions",
    ..MANY_POSITIONS
};

const DERIVATIVES: Case = Case {
    case: "gradient noise, 2-D, one position, value and derivatives",
    peer: "ours, the value alone",
    must: Goal::CostAtMost(2.0),
    note: "differences take one more sample for each axis, and are not exact",
    ..ONE_POSITION
};

const DERIVATIVES_IN_SPACE: Case = Case {
    case: "gradient noise, 3-D, one position, value and derivatives",
    must: Goal::CostAtMost(3.0),
    ..DERIVATIVES
};

const DERIVATIVES_OF_SUM: Case = Case {
    case: "gradient noise, 2-D, one position, six octaves, value and derivatives",
    ..DERIVATIVES
};

const TERRAIN: Case = Case {
    group: "noise",
    case: "terrain chunk 65×65: six octaves and five ridged ones, warped",
    peer: "noise-functions Perlin, the same sums, position by position",
    unit: Unit::NsPerPosition,
    must: Goal::CostAtMost(0.6),
    note: "one thread; the warp moves positions by up to half a cell along each axis",
};

/// Width and height of a chunk of terrain, in positions. Adjacent chunks share a row.
const CHUNK: u32 = 65;

/// Distance between adjacent positions of a chunk, in cells.
const CHUNK_STEP: f64 = 1.0 / 32.0;

/// Width and height of the images in pixels.
const SIDE: u32 = 1024;

/// Number of positions per run.
const N_POSITIONS: usize = 1 << 16;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    picture(bench, &COARSE, 64)?;
    picture(bench, &FINE, 8)?;
    let plane = GradientNoise2::new(SEED);
    let perlin = noise::noise_functions_perlin_2;
    beside_perlin(
        bench,
        &ONE_POSITION,
        128,
        one_by_one(|at| plane.sample(at)),
        perlin,
        confirm,
    )?;
    let many = |at: &[[f64; 2]], values: &mut [f32]| {
        // There is one value per position, so this cannot fail.
        let _ = plane.sample_many(at, values);
    };
    beside_perlin(bench, &MANY_POSITIONS, 128, many, perlin, confirm)?;
    let space = GradientNoise3::new(SEED);
    let perlin = noise::noise_functions_perlin_3;
    let one = one_by_one(|at| space.sample(at));
    beside_perlin(
        bench,
        &ONE_POSITION_IN_SPACE,
        128,
        one,
        perlin,
        confirm_spread,
    )?;
    let many = |at: &[[f64; 3]], values: &mut [f32]| {
        // There is one value per position, so this cannot fail.
        let _ = space.sample_many(at, values);
    };
    beside_perlin(
        bench,
        &MANY_POSITIONS_IN_SPACE,
        128,
        many,
        perlin,
        confirm_spread,
    )?;
    with_derivatives(bench, &DERIVATIVES, &plane)?;
    with_derivatives(bench, &DERIVATIVES_IN_SPACE, &space)?;
    let sum = plane.fractal(6, 0.5, 2.0, FractalShape::Sum)?;
    with_derivatives(bench, &DERIVATIVES_OF_SUM, &sum)?;
    terrain(bench)
}

/// Measures evaluation of a field's value and derivatives at single positions. The other side evaluates the value
/// alone.
pub(crate) fn with_derivatives<const N: usize>(
    bench: &mut Bench,
    case: &Case,
    field: &(impl Gradient<N> + Sync),
) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let at: Vec<[f64; N]> = positions_in(N_POSITIONS, 128.0);
    let all = |values: &mut Vec<(f32, [f32; N])>| {
        for (value, &at) in values.iter_mut().zip(&at) {
            *value = field.sample_with_gradient(at);
        }
    };
    let alone = |values: &mut Vec<f32>| {
        for (value, &at) in values.iter_mut().zip(&at) {
            *value = field.sample(at);
        }
    };
    let ours = Side::new(vec![(0.0, [0.0; N]); N_POSITIONS], all);
    let theirs = Side::new(vec![0.0; N_POSITIONS], alone);
    bench.beside(case, 101, ours, theirs, |ours, theirs| {
        for ((value, gradient), expected) in ours.iter().zip(theirs) {
            ensure!(value == expected, "another value with its derivatives");
            ensure!(
                gradient.iter().all(|part| part.is_finite()),
                "a derivative is {gradient:?}"
            );
        }
        confirm_spread(theirs)?;
        Ok(Done::both(N_POSITIONS))
    })
}

/// Measures rendering a chunk of warped terrain.
fn terrain(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&TERRAIN) {
        return Ok(());
    }
    let [hills, ridges, x, y] =
        [1, 2, 3, 4].map(|child| GradientNoise2::new(SEED.child("terrain", child)));
    let hills = hills.fractal(6, 0.5, 2.0, FractalShape::Sum)?;
    let ridges = ridges.fractal(5, 0.5, 2.0, FractalShape::Ridged)?;
    let height = hills.add(ridges.mul(0.5)).warp([x, y], 0.5);
    let extent = f64::from(CHUNK) * CHUNK_STEP;
    let window = Window::new(DVec2::ZERO, DVec2::splat(extent), [CHUNK; 2])?;
    let n = (CHUNK * CHUNK) as usize;
    let ours = Side::new(Raster::filled(window.size, 0.0)?, |raster| {
        // The raster is the same size as the window, so this cannot fail.
        let _ = height.render(&window, raster.view_mut());
    });
    let theirs = Side::new(vec![0.0; n], |values: &mut Vec<f32>| {
        noise::noise_functions_terrain(CHUNK as usize, CHUNK_STEP as f32, values);
    });
    bench.beside(&TERRAIN, 201, ours, theirs, |raster, theirs| {
        for (row, column) in [(0, 0), (31, 64), (64, 7)] {
            let expected = height.sample(window.position(column, row));
            ensure!(
                raster.row(row)[column as usize] == expected,
                "not as sampled alone"
            );
        }
        confirm_spread(theirs)?;
        Ok(Done::both(n))
    })
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
            // The raster is the same size as the window, so this cannot fail.
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

/// Returns a function that fills a slice with values, evaluated at one position at a time.
pub(crate) fn one_by_one<const N: usize>(
    sample: impl Fn([f64; N]) -> f32,
) -> impl Fn(&[[f64; N]], &mut [f32]) {
    move |at, values| {
        for (value, &at) in values.iter_mut().zip(at) {
            *value = sample(at);
        }
    }
}

/// Measures evaluation at random positions in a cube with sides of `cells` cells. The other side is Perlin noise from
/// `noise-functions`.
pub(crate) fn beside_perlin<const N: usize>(
    bench: &mut Bench,
    case: &Case,
    cells: u32,
    fill: impl Fn(&[[f64; N]], &mut [f32]) + Sync,
    perlin: fn(&[[f32; N]], &mut [f32]),
    confirm: impl Fn(&[f32]) -> Result<()>,
) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let at: Vec<[f64; N]> = positions_in(N_POSITIONS, f64::from(cells));
    let their_at: Vec<[f32; N]> = at.iter().map(|at| at.map(|part| part as f32)).collect();
    let ours = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        fill(&at, values);
    });
    let theirs = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        perlin(&their_at, values);
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

/// Checks that values are within the documented bound, and that their variance is near the documented one.
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
    // The coarsest image has few cells.
    ensure!(
        (0.05..0.15).contains(&variance),
        "the variance is {variance}"
    );
    Ok(())
}
