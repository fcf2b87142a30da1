//! From a few directions to an order: the user's directions, the field that they are interpolated to, and the distance along
//! the field, whose colors repeat as it grows.

use super::stage::lit;
use super::subject::TORI;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{LinearRgb, Ramp};
use dapple_synth::mesh::{Hierarchy, Surface};
use dapple_synth::Synthesizer;
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "2",
    parameters: &[
        ("model", "three blended tori"),
        ("directions", "6"),
        ("a cycle of colors", "0.35 units; the tori are 2 wide"),
    ],
    source: source!(),
    render,
};

/// The length of a drawn vector, in units of the mesh, and half its width.
const DIRECTION: [f64; 2] = [0.3, 0.02];
/// The same for the vectors of the field, in spacings of the level that they are drawn for.
const FIELD: [f64; 2] = [0.8, 0.1];
/// How far the sweep goes in one cycle of colors, in units of the mesh.
const CYCLE: f64 = 0.35;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let surface = Surface::new((TORI.model)(14_000)?)?;
    let mut sites = TORI.sites(1024);
    // The field and its sweep look the same with fewer points.
    sites.n_sites = 16_000;
    let synthesizer = Synthesizer::new(surface, &TORI.directions(), &sites)?;
    let hierarchy = synthesizer.hierarchy();
    let mesh = synthesizer.surface().mesh();
    let clay = LinearRgb::gray(0.7);
    let ink = LinearRgb::new(0.45, 0.02, 0.02);
    let directions = TORI.directions();
    let given = |at: &dapple_preview::Surface| {
        let hit = directions.iter().any(|direction| {
            let vector = direction.vector - at.normal * direction.vector.dot(at.normal);
            is_arrow(at.position - direction.at, vector, DIRECTION) && near(direction.at, at)
        });
        if hit { ink } else { clay }
    };
    let vectors = synthesizer.orientation().vectors();
    let field = |at: &dapple_preview::Surface| {
        if is_field(hierarchy, vectors, at.position) { ink } else { clay }
    };
    let ramp = cycle()?;
    let distances = synthesizer.sweep().distances(0);
    let sweep = |at: &dapple_preview::Surface| {
        let value = hierarchy.interpolate(0, distances, at.position, at.geometric_normal);
        let turns = value.ok().flatten().unwrap_or(0.0) / CYCLE;
        ramp.color((turns - turns.floor()) as f32)
    };
    Ok(vec![
        Panel::color("the user's directions", lit(mesh, &TORI.view, [size; 2], given)?),
        Panel::color("the field", lit(mesh, &TORI.view, [size; 2], field)?),
        Panel::color("sweep distance", lit(mesh, &TORI.view, [size; 2], sweep)?),
    ])
}
