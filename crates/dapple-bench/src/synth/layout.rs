//! Atlases of large meshes, timed together with the synthesis and the bake. Charts are compared with triangles laid
//! out by area, and loose squares with the default options are compared with the paper's synthesis.

use super::scene::{Picture, leaves};
use crate::harness::Bench;
use crate::row::{Case, Goal, Unit};
use anyhow::Result;
use dapple_color::LinearRgb;
use dapple_mesh::{Mesh, Surface};
use dapple_models::bunny;
use dapple_raster::Raster;
use dapple_synth::{
    Atlas, Direction, HierarchyOptions, Options, SynthError, Synthesizer, bake_colors,
};
use glam::DVec3;

const CHARTS: Case = Case {
    group: "synth",
    case: "synthesis and bake with charts, 100,000 triangles, map 2048×2048",
    peer: "ours, triangles by area",
    unit: Unit::S,
    must: Goal::CostAtMost(2.5),
    note: "wall time on two threads, 65,536 sites; the model is a procedural animal",
};

const LOOSE: Case = Case {
    case: "synthesis and bake of 40,344 loose squares, map 2048×2048",
    peer: "ours, as in the paper",
    must: Goal::CostAtMost(3.0),
    note: "wall time on two threads, 65,536 sites; the squares cover a cube",
    ..CHARTS
};

/// Number of squares along an edge of the cube.
const SQUARES: u32 = 82;

/// Width and height of the texture map in texels.
const MAP_SIDE: u32 = 2048;

/// Number of runs of each side; the fastest one counts.
const RUNS: u32 = 2;

/// Function that builds an atlas. The number is the side of the atlas in texels.
type Layout = fn(&Surface, u32) -> Result<Atlas, SynthError>;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if bench.wants(&CHARTS) {
        charts(bench)?;
    }
    if bench.wants(&LOOSE) {
        loose(bench)?;
    }
    Ok(())
}

/// Measures charts compared with triangles laid out by area.
fn charts(bench: &mut Bench) -> Result<()> {
    let (mesh, _) = bunny(100_000)?.repair();
    let down = Direction {
        at: bunny::TAIL,
        vector: DVec3::NEG_Y,
    };
    let picture = leaves(64)?;
    let (mut charts, mut area) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let sides: [(Layout, _); 2] = [(Atlas::charts, &mut charts), (Atlas::by_area, &mut area)];
        for (layout, least) in sides {
            let (seconds, made) =
                bench.on_two(|| baked(&mesh, &picture, &[down], layout, &Options::default()));
            made?;
            *least = f64::min(*least, seconds);
        }
    }
    bench.measured(&CHARTS, charts, area);
    Ok(())
}

/// Measures a mesh of loose squares, with the default options and with the paper's options.
fn loose(bench: &mut Bench) -> Result<()> {
    let mesh = loose_squares()?;
    let picture = leaves(64)?;
    let (mut ours, mut paper) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let sides = [
            (Options::default(), &mut ours),
            (Options::paper(), &mut paper),
        ];
        for (options, least) in sides {
            let (seconds, made) =
                bench.on_two(|| baked(&mesh, &picture, &[], Atlas::by_area, &options));
            made?;
            *least = f64::min(*least, seconds);
        }
    }
    bench.measured(&LOOSE, ours, paper);
    Ok(())
}

/// Returns the surface of a cube as a mesh of squares that share no vertices.
fn loose_squares() -> Result<Mesh> {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    let edge = 2.0 / f64::from(SQUARES);
    for side in 0..6 {
        let axis = side / 2;
        let out = if side % 2 == 0 { 1.0 } else { -1.0 };
        for square in 0..SQUARES * SQUARES {
            let first = positions.len() as u32;
            for corner in [[0.05, 0.05], [0.95, 0.05], [0.95, 0.95], [0.05, 0.95]] {
                let [x, y] = [square % SQUARES, square / SQUARES].map(f64::from);
                // On the opposite side the square is flipped, so that all squares face out.
                let along = [
                    (x + corner[0]) * edge - 1.0,
                    ((y + corner[1]) * edge - 1.0) * out,
                ];
                let mut position = [out; 3];
                position[(axis + 1) % 3] = along[0];
                position[(axis + 2) % 3] = along[1];
                positions.push(DVec3::from(position));
            }
            faces.extend([[0, 1, 2], [0, 2, 3]].map(|face| face.map(|corner| first + corner)));
        }
    }
    Ok(Mesh::new(positions, &faces)?)
}

/// Synthesizes a texture from an exemplar on a mesh, and bakes it into a texture map.
fn baked(
    mesh: &Mesh,
    picture: &Picture,
    directions: &[Direction],
    layout: Layout,
    options: &Options,
) -> Result<Raster<LinearRgb>> {
    let surface = Surface::new(mesh.clone())?;
    let atlas = layout(&surface, MAP_SIDE)?;
    let synthesizer = Synthesizer::new(surface, directions, &HierarchyOptions::default())?;
    let texture = synthesizer.synthesize(&picture.exemplar()?, options)?;
    Ok(bake_colors(&synthesizer, &texture, &picture.image, &atlas)?)
}
