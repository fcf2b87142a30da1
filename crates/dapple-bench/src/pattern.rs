//! The pattern group: patterns, filters and warps, compared with other crates or with plain loops.
//!
//! Images have 1024×1024 pixels. Confirmed: pixels of fields equal single evaluations, filters equal plain loops at some
//! pixels, and no image is flat.

use crate::harness::{Bench, Done, Side};
use crate::peers::{filter, noise};
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::{Result, ensure};
use dapple_filter::{Part, disk_halo, distances, gaussian, gaussian_halo};
use dapple_noise::GradientNoise2;
use dapple_pattern::{BrickOptions, BrickValue, Bricks, StampOptions, StampValue, Stamps};
use dapple_raster::{Field, FieldExt as _, Raster, Window};
use glam::DVec2;

const BRICKS: Case = Case {
    group: "pattern",
    case: "`bricks`, height, 1024×1024, 64 px per brick",
    peer: "noise-functions Perlin, four octaves, pixel by pixel",
    unit: Unit::NsPerPixel,
    must: Goal::CostAtMost(1.0),
    note: "no other crate draws bricks; a pattern should not cost more than plain noise",
};

const SCATTER: Case = Case {
    case: "`scatter`, height of domes, 1024×1024, 64 px per cell",
    peer: "noise-functions CellDistance, pixel by pixel",
    must: Goal::CostAtMost(2.0),
    note: "the peer looks at the points of 9 cells, too, but its points have no shape, size and rotation",
    ..BRICKS
};

const WARP: Case = Case {
    case: "`warp` of noise by noise, 1024×1024, 32 px per cell",
    peer: "noise-functions Perlin, the same, pixel by pixel",
    must: Goal::CostAtMost(0.6),
    note: "three samples for each pixel",
    ..BRICKS
};

const BLUR: Case = Case {
    case: "`blur`, standard deviation 4 px, 1024×1024",
    peer: "image::imageops::blur",
    must: Goal::Faster(2.0),
    note: "the peer's kernel reaches two standard deviations, ours three",
    ..BRICKS
};

const DISTANCE: Case = Case {
    case: "`distance_to`, up to 16 px, 1024×1024",
    peer: "plain loop over the square of each pixel",
    must: Goal::Faster(20.0),
    note: "one of 64 pixels is in the mask; the loop runs for 16 of the rows",
    ..BRICKS
};

/// Width and height of the images in pixels.
const SIDE: u32 = 1024;

/// Number of turns per row. Each turn runs both sides.
const TURNS: u32 = 11;

/// Standard deviation of the blur, and the largest distance, in pixels.
const DEVIATION: f64 = 4.0;
const REACH: u32 = 16;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    let bricks = Bricks::new(SEED, BrickOptions::default())?.field(BrickValue::Height);
    let octaves =
        |values: &mut Vec<f32>| noise::noise_functions_fbm(SIDE as usize, 4, 64.0, values);
    field(bench, &BRICKS, &bricks, 4.0, octaves)?;
    let stamps = Stamps::new(SEED, StampOptions::default())?.field(StampValue::Height);
    let cells = |values: &mut Vec<f32>| noise::noise_functions_cells(SIDE as usize, 64.0, values);
    field(bench, &SCATTER, &stamps, 16.0, cells)?;
    let [base, x, y] = [1, 2, 3].map(|child| GradientNoise2::new(SEED.child("warp", child)));
    let warped = base.warp([x, y], 0.5);
    let theirs = |values: &mut Vec<f32>| noise::noise_functions_warp(SIDE as usize, 32.0, values);
    field(bench, &WARP, &warped, 32.0, theirs)?;
    blur(bench)?;
    distance(bench)
}

/// Measures rendering a field in a square window with sides of `extent` units.
fn field(
    bench: &mut Bench,
    case: &Case,
    field: &impl Field,
    extent: f64,
    peer: impl FnMut(&mut Vec<f32>) + Send,
) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let window = Window::new(DVec2::ZERO, DVec2::splat(extent), [SIDE; 2])?;
    let ours = Side::new(Raster::filled([SIDE; 2], 0.0)?, |raster| {
        field
            .render(&window, raster.view_mut())
            .expect("the raster has the window's size");
    });
    let theirs = Side::new(vec![0.0; window.n_pixels()], peer);
    bench.beside(case, TURNS, ours, theirs, |raster: &Raster<f32>, theirs| {
        for index in (0..SIDE * SIDE).step_by(1009) {
            let (column, row) = (index % SIDE, index / SIDE);
            let expected = field.value(window.position(column, row));
            ensure!(
                raster.row(row)[column as usize] == expected,
                "not as sampled alone"
            );
        }
        confirm_spread(raster.pixels())?;
        confirm_spread(theirs)?;
        Ok(Done::both(window.n_pixels()))
    })
}

/// Returns an area of pixels with side length 1, and random values for its pixels and the halo around them.
fn part_and_values(halo: [u32; 2]) -> (Part, Vec<f32>) {
    let part = Part {
        size: [SIDE; 2],
        halo,
        pixel: DVec2::ONE,
    };
    let n: u32 = part.input_size().iter().product();
    (part, crate::sets::values(n as usize))
}

fn blur(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&BLUR) {
        return Ok(());
    }
    let (part, values) = part_and_values(gaussian_halo(DEVIATION, DVec2::ONE));
    let ours = Side::new(Vec::new(), |out: &mut Vec<f32>| {
        *out = gaussian(&values, &part, DEVIATION);
    });
    let image = filter::image(
        SIDE,
        (0..SIDE).flat_map(|row| part.line(&values, row as usize)),
    );
    let theirs = Side::new(Vec::new(), |out: &mut Vec<f32>| {
        *out = filter::image_blur(&image, DEVIATION as f32);
    });
    bench.beside(&BLUR, TURNS, ours, theirs, |ours, theirs| {
        // Away from the border, the kernels differ by the weights beyond two standard deviations, which are 5 %.
        for row in (100..SIDE - 100).step_by(97) {
            for column in (100..SIDE - 100).step_by(89) {
                let at = (row * SIDE + column) as usize;
                ensure!(
                    (ours[at] - theirs[at]).abs() < 0.03,
                    "{} beside {}",
                    ours[at],
                    theirs[at]
                );
            }
        }
        Ok(Done::both((SIDE * SIDE) as usize))
    })
}

fn distance(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&DISTANCE) {
        return Ok(());
    }
    let (part, values) = part_and_values(disk_halo(f64::from(REACH), DVec2::ONE));
    let mask: Vec<f32> = values
        .iter()
        .map(|&value| f32::from(value < 1.0 / 64.0))
        .collect();
    let ours = Side::new(Vec::new(), |out: &mut Vec<f32>| {
        *out = distances(&mask, &part, REACH as f32);
    });
    let rows = (SIDE / 32..SIDE).step_by(64);
    let theirs = Side::new(Vec::new(), |out: &mut Vec<f32>| {
        *out = rows
            .clone()
            .flat_map(|row| plain_distances(&mask, &part, row))
            .collect();
    });
    bench.beside(&DISTANCE, TURNS, ours, theirs, |ours, theirs| {
        for (theirs, row) in theirs.chunks_exact(SIDE as usize).zip(rows.clone()) {
            let ours = &ours[(row * SIDE) as usize..][..SIDE as usize];
            ensure!(ours == theirs, "row {row} is not that of the loop");
        }
        Ok(Done {
            ours: ours.len(),
            theirs: theirs.len(),
        })
    })
}

/// Returns the distance from each pixel of a row to the mask, found by searching the square around the pixel.
fn plain_distances(mask: &[f32], part: &Part, row: u32) -> Vec<f32> {
    let [left, above] = part.halo;
    let wide = part.input_size()[0].cast_signed();
    let reach = REACH.cast_signed();
    let distance = |column: u32| {
        let mut least = reach * reach;
        for down in -reach..=reach {
            for across in -reach..=reach {
                let x = (column + left).cast_signed() + across;
                let y = (row + above).cast_signed() + down;
                if mask[(y * wide + x) as usize] > 0.5 {
                    least = least.min(across * across + down * down);
                }
            }
        }
        (least as f32).sqrt()
    };
    (0..SIDE).map(distance).collect()
}

/// Checks that the values of an image are not all equal.
fn confirm_spread(values: &[f32]) -> Result<()> {
    let range = values
        .iter()
        .fold([f32::MAX, f32::MIN], |[low, high], &value| {
            [low.min(value), high.max(value)]
        });
    ensure!(range[1] - range[0] > 0.2, "flat: {range:?}");
    Ok(())
}
