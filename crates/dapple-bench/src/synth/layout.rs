//! Charts beside triangles by area on a large mesh, each with the synthesis and the bake around it.

use super::scene::{Picture, leaves};
use crate::harness::Bench;
use crate::row::{Case, Must, Unit};
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
    must: Must::CostAtMost(2.5),
    note: "wall time on two threads, 65,536 sites; the model is a procedural animal",
};

/// The side of the texture map in texels.
const MAP_SIDE: u32 = 2048;

/// The number of runs of each side, of which the fastest counts.
const RUNS: u32 = 2;

/// A way to lay out a map with a side in texels.
type Layout = fn(&Surface, u32) -> Result<Atlas, SynthError>;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&CHARTS) {
        return Ok(());
    }
    let (mesh, _) = bunny(100_000)?.repair();
    let picture = leaves(64)?;
    let (mut charts, mut area) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let sides: [(Layout, _); 2] = [(Atlas::charts, &mut charts), (Atlas::by_area, &mut area)];
        for (layout, least) in sides {
            let (seconds, made) = bench.on_two(|| baked(&mesh, &picture, layout));
            made?;
            *least = f64::min(*least, seconds);
        }
    }
    bench.measured(&CHARTS, charts, area);
    Ok(())
}

/// Covers a mesh with an example and bakes it.
fn baked(mesh: &Mesh, picture: &Picture, layout: Layout) -> Result<Raster<LinearRgb>> {
    let surface = Surface::new(mesh.clone())?;
    let atlas = layout(&surface, MAP_SIDE)?;
    let down = Direction {
        at: bunny::TAIL,
        vector: DVec3::NEG_Y,
    };
    let synthesizer = Synthesizer::new(surface, &[down], &HierarchyOptions::default())?;
    let texture = synthesizer.synthesize(&picture.exemplar()?, &Options::default())?;
    Ok(bake_colors(&synthesizer, &texture, &picture.image, &atlas)?)
}
