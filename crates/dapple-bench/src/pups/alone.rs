//! Rows that compare our method with itself and with the naive evaluation, and need no other crate.

use super::{SIDE, Scene, image, window};
use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use crate::sets;
use anyhow::{Result, ensure};
use dapple_hash::{hash1, unit_f64};
use dapple_pups::{Orientation, Pups, PupsOptions, Texture};
use dapple_raster::{Field as _, Raster, Window};
use glam::DVec3;
use std::time::Duration;

const NAIVE: Case = Case {
    group: "pups",
    case: "raster, 700 points",
    peer: "naive: all points at all pixels",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(900.0),
    note: "the naive side is measured on 40 of the 1000 rows, spread evenly",
};

const POINTS_10K: Case = Case {
    case: "raster, 10 k points",
    peer: "ours, 1 k points",
    must: Goal::CostAtMost(2.0),
    note: "",
    ..NAIVE
};

const POINTS_100K: Case = Case {
    case: "raster, 100 k points",
    must: Goal::CostAtMost(5.0),
    ..POINTS_10K
};

const ORIENTED: Case = Case {
    case: "raster with orientations, 700 points",
    peer: "ours, without",
    must: Goal::CostAtMost(2.5),
    note: "equation 4 with ε = 0.5 and a random orientation for each point",
    ..NAIVE
};

const TWO_THREADS: Case = Case {
    case: "raster 8192×8192 on two threads, 10 k points",
    peer: "ours, one thread",
    unit: Unit::Ms,
    must: Goal::Faster(1.75),
    note: "",
    ..NAIVE
};

/// Width and height, in pixels, of the image for two threads: large enough for a job of at least 100 ms.
const TWO_THREADS_SIDE: u32 = 8192;

/// Row stride of the naive evaluation: only rows whose index is a multiple of it are evaluated.
const NAIVE_STRIDE: usize = 25;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    naive(bench)?;
    more_points(bench, &POINTS_10K, 10_000)?;
    more_points(bench, &POINTS_100K, 100_000)?;
    oriented(bench)?;
    two_threads(bench)
}

/// Returns a side that renders `texture` into an image.
pub(super) fn raster<'a>(
    texture: &'a Texture,
    window: &'a Window,
) -> Result<Side<'a, Raster<f32>>> {
    let image = Raster::filled(window.size, 0.0)?;
    Ok(Side::new(image, move |image: &mut Raster<f32>| {
        texture
            .render(window, image.view_mut())
            .expect("the image has the window's size");
    }))
}

fn naive(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&NAIVE) {
        return Ok(());
    }
    let scene = Scene::new(700)?;
    let (window, naive) = (window(SIDE)?, scene.naive());
    let n_rows = SIDE as usize / NAIVE_STRIDE;
    let rows = vec![0.0; n_rows * SIDE as usize];
    let theirs = Side::new(rows, |rows: &mut Vec<f32>| {
        for (index, row) in rows.chunks_exact_mut(SIDE as usize).enumerate() {
            naive.row(window.row_y((index * NAIVE_STRIDE) as u32), row);
        }
    });
    bench.beside(
        &NAIVE,
        11,
        raster(&scene.texture, &window)?.times(10),
        theirs,
        |image, rows| {
            for (index, expected) in rows.chunks_exact(SIDE as usize).enumerate() {
                scene.confirm_values(image.row((index * NAIVE_STRIDE) as u32), expected)?;
            }
            Ok(Done {
                ours: window.n_pixels(),
                theirs: rows.len(),
            })
        },
    )
}

fn more_points(bench: &mut Bench, case: &Case, n_points: u32) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let (many, few) = (Scene::new(n_points)?, Scene::new(1000)?);
    let window = window(SIDE)?;
    let (ours, theirs) = (
        raster(&many.texture, &window)?,
        raster(&few.texture, &window)?,
    );
    bench.beside(case, 51, ours, theirs, |image_of_many, image_of_few| {
        many.confirm(image_of_many)?;
        few.confirm(image_of_few)?;
        Ok(Done::both(window.n_pixels()))
    })
}

fn oriented(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&ORIENTED) {
        return Ok(());
    }
    let scene = Scene::new(700)?;
    let seed = sets::SEED.child("bench orientations", 0);
    let coordinate = |index, axis| 2.0 * unit_f64(hash1(seed, [index], axis)) - 1.0;
    let vectors = (0..scene.points.len() as i64)
        .map(|i| DVec3::from_array([0, 1, 2].map(|axis| coordinate(i, axis))));
    let orientation = Some(Orientation::new(vectors.collect()));
    let options = PupsOptions {
        orientation,
        ..PupsOptions::default()
    };
    let texture = Pups::new(&scene.points, &scene.graph, options)?.texture(scene.values.clone())?;
    let window = window(SIDE)?;
    let (ours, theirs) = (raster(&texture, &window)?, raster(&scene.texture, &window)?);
    bench.beside(&ORIENTED, 51, ours, theirs, |oriented, plain| {
        scene.confirm(plain)?;
        ensure!(
            oriented.pixels() != plain.pixels(),
            "orientations change the image"
        );
        let least = oriented
            .pixels()
            .iter()
            .copied()
            .fold(f32::INFINITY, f32::min);
        let largest = oriented
            .pixels()
            .iter()
            .copied()
            .fold(f32::NEG_INFINITY, f32::max);
        ensure!(
            least >= 0.0 && largest <= 1.0 + 1e-6,
            "rounded means of [0, 1) lie in [{least}, {largest}]"
        );
        ensure!(
            largest - least > 0.5,
            "the image is flat: [{least}, {largest}]"
        );
        Ok(Done::both(window.n_pixels()))
    })
}

fn two_threads(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&TWO_THREADS) {
        return Ok(());
    }
    let scene = Scene::new(10_000)?;
    let window = window(TWO_THREADS_SIDE)?;
    let images = [image(TWO_THREADS_SIDE)?, image(TWO_THREADS_SIDE)?];
    let render = |image: &mut Raster<f32>| {
        scene
            .texture
            .render(&window, image.view_mut())
            .expect("the image has the window's size");
    };
    let bits = |image: &Raster<f32>| {
        image
            .pixels()
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    bench.two_threads(
        &TWO_THREADS,
        Duration::from_secs(20),
        images,
        render,
        |one, two| bits(one) == bits(two),
    )
}
