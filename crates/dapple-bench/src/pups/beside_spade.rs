//! Our textures compared with the interpolators of `spade`.

use super::alone::raster;
use super::{SIDE, Scene, image, window};
use crate::harness::{Bench, Done, Side};
use crate::peers::{ScanlineSpade, ScatteredSpade};
use crate::row::{Case, Goal, Unit};
use crate::sets;
use anyhow::{Context as _, Result, ensure};
use dapple_graph::delaunay;
use dapple_hash::Seed;
use dapple_points::PointSet;
use dapple_pups::{Pups, PupsOptions};
use dapple_raster::{Field as _, FieldExt as _, Raster, Window};

const NATURAL_NEIGHBOR: Case = Case {
    group: "pups",
    case: "raster, 700 points",
    peer: "spade natural neighbor",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(65.0),
    note: "",
};

const BARYCENTRIC: Case = Case {
    peer: "spade barycentric",
    must: Goal::Faster(17.0),
    ..NATURAL_NEIGHBOR
};

const WHOLE_CHAIN: Case = Case {
    case: "seed to image, 700 points",
    peer: "spade natural neighbor, image alone",
    must: Goal::Faster(50.0),
    note: "ours makes points, values, graph, net and image",
    ..NATURAL_NEIGHBOR
};

const POSITIONS_700: Case = Case {
    case: "one position at a time, 700 points",
    unit: Unit::NsPerPosition,
    must: Goal::Faster(5.0),
    ..NATURAL_NEIGHBOR
};

const POSITIONS_40K: Case = Case {
    case: "one position at a time, 40 k points",
    must: Goal::Faster(12.0),
    ..POSITIONS_700
};

/// The number of positions per run, scattered over the square.
const N_POSITIONS: usize = 1 << 17;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if bench.wants_any(&[NATURAL_NEIGHBOR, BARYCENTRIC, WHOLE_CHAIN]) {
        let scene = Scene::new(700)?;
        let spade = ScanlineSpade::new(scene.points.positions(), &scene.values, MARGIN);
        beside_raster(bench, &NATURAL_NEIGHBOR, &scene, |image| {
            spade.natural_neighbor(SIDE as usize, image);
        })?;
        beside_raster(bench, &BARYCENTRIC, &scene, |image| {
            spade.barycentric(SIDE as usize, image);
        })?;
        whole_chain(bench, &spade)?;
    }
    one_position(bench, &POSITIONS_700, 700, 15)?;
    one_position(bench, &POSITIONS_40K, 40_000, 9)
}

/// Margin around the square within which `spade` gets copies of points: more than four radii of 700 points, so that
/// every pixel has all of its natural neighbors.
const MARGIN: f64 = 0.15;

fn beside_raster(
    bench: &mut Bench,
    case: &Case,
    scene: &Scene,
    fill: impl Fn(&mut [f32]) + Sync,
) -> Result<()> {
    let window = window(SIDE)?;
    let theirs = Side::new(image(SIDE)?, |image: &mut Raster<f32>| {
        fill(image.pixels_mut());
    });
    bench.beside(
        case,
        15,
        raster(&scene.texture, &window)?.times(10),
        theirs,
        |ours, theirs| {
            scene.confirm(ours)?;
            has_values(theirs.pixels())?;
            Ok(Done::both(window.n_pixels()))
        },
    )
}

/// Checks that a peer has a value in [0, 1] at every position, and that the values are not all equal.
fn has_values(values: &[f32]) -> Result<()> {
    // Weighted means of numbers in [0, 1] stay in this range up to the rounding of the weights; NaN is in no range.
    let bad = values
        .iter()
        .position(|value| !(-1e-4..=1.0001).contains(value));
    ensure!(bad.is_none(), "the peer has no value at position {bad:?}");
    ensure!(
        values.iter().any(|value| *value > 0.8) && values.iter().any(|value| *value < 0.2),
        "the values are flat"
    );
    Ok(())
}

fn whole_chain(bench: &mut Bench, spade: &ScanlineSpade) -> Result<()> {
    let window = window(SIDE)?;
    let ours = Side::new((sets::SEED, None, image(SIDE)?), |(seed, points, image)| {
        *points = seed_to_image(*seed, &window, image).ok();
    })
    .prepared(|(seed, ..)| seed.0 += 1)
    .times(10);
    let theirs = Side::new(image(SIDE)?, |image: &mut Raster<f32>| {
        spade.natural_neighbor(SIDE as usize, image.pixels_mut());
    });
    bench.beside(
        &WHOLE_CHAIN,
        15,
        ours,
        theirs,
        |(_, points, image), theirs| {
            let points: &PointSet = points.as_ref().context("no image")?;
            let (graph, values) = (delaunay(points)?, sets::values(points.len()));
            let texture =
                Pups::new(points, &graph, PupsOptions::default())?.texture(values.clone())?;
            Scene {
                points: points.clone(),
                graph,
                values,
                texture,
            }
            .confirm(image)?;
            has_values(theirs.pixels())?;
            Ok(Done::both(window.n_pixels()))
        },
    )
}

/// Runs the entire chain from a seed to the pixels, and returns the points.
fn seed_to_image(seed: Seed, window: &Window, image: &mut Raster<f32>) -> Result<PointSet> {
    let points = sets::poisson_disk_from(seed, 700)?;
    let texture = Pups::delaunay(&points)?.texture(sets::values(points.len()))?;
    texture.render(window, image.view_mut())?;
    Ok(points)
}

fn one_position(bench: &mut Bench, case: &Case, n_points: u32, turns: u32) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let scene = Scene::new(n_points)?;
    let spade = ScatteredSpade::new(scene.points.positions(), &scene.values, MARGIN);
    let positions = sets::positions(N_POSITIONS);
    let ours = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        for (value, &position) in values.iter_mut().zip(&positions) {
            *value = scene.texture.sample(position);
        }
    })
    .times(8);
    let theirs = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        spade.natural_neighbor_at(&positions, values);
    });
    bench.beside(case, turns, ours, theirs, |ours, theirs| {
        has_values(ours)?;
        has_values(theirs)?;
        let naive = scene.naive();
        let expected: Vec<f32> = positions
            .iter()
            .take(500)
            .map(|at| naive.sample(at.to_array()))
            .collect();
        scene.confirm_values(&ours[..expected.len()], &expected)?;
        Ok(Done::both(N_POSITIONS))
    })
}
