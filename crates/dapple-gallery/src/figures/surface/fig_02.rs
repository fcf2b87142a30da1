//! From a few directions to an order: the user's directions, the field interpolated from them, and the distance along
//! the field, whose colors repeat as it grows. The last two are also shown from behind, where the distance jumps along
//! tears: it cannot grow all the way around a tube.

use super::stage::lit;
use super::subject::TORI;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorError, ColorRamp, LinearRgb};
use dapple_preview::Surface as Point;
use dapple_synth::Synthesizer;
use dapple_synth::mesh::Surface;
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

/// Length and half width of the arrow for a direction given by the user, in units of the mesh.
const DIRECTION: [f64; 2] = [0.3, 0.02];
/// Length and half width of the arrow for a vector of the field, in multiples of the drawn level's site spacing.
const FIELD: [f64; 2] = [0.8, 0.1];
/// Sweep distance covered by one cycle of colors, in units of the mesh.
const CYCLE: f64 = 0.35;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let surface = Surface::new((TORI.model)(14_000)?)?;
    let mut sites = TORI.sites(1024);
    // The field and its sweep distance look the same with fewer points.
    sites.n_sites = 16_000;
    let synthesizer = Synthesizer::new(surface, &TORI.directions(), &sites)?;
    let mesh = synthesizer.surface().mesh();
    let clay = LinearRgb::gray(0.7);
    let ink = LinearRgb::new(0.45, 0.02, 0.02);
    let directions = TORI.directions();
    let given = |at: &Point| {
        let hit = directions
            .iter()
            .any(|direction| is_arrow(at.position - direction.at, direction.vector, DIRECTION));
        if hit { ink } else { clay }
    };
    let field = |at: &Point| {
        if is_field(&synthesizer, at.position) {
            ink
        } else {
            clay
        }
    };
    let ramp = cycle()?;
    let sweep = |at: &Point| {
        let turns = distance(&synthesizer, at.position) / CYCLE;
        ramp.at((turns - turns.floor()) as f32)
    };
    Ok(vec![
        Panel::color(
            "the user's directions",
            lit(mesh, &TORI.view, [size; 2], given)?,
        ),
        Panel::color("the field", lit(mesh, &TORI.view, [size; 2], field)?),
        Panel::color("sweep distance", lit(mesh, &TORI.view, [size; 2], sweep)?),
        Panel::color(
            "the field from behind",
            lit(mesh, &TORI.view.opposite(), [size; 2], field)?,
        ),
        Panel::color(
            "sweep distance from behind",
            lit(mesh, &TORI.view.opposite(), [size; 2], sweep)?,
        ),
    ])
}

/// Returns whether a position is in an arrow. `from` is the position relative to the start of the arrow. The arrow
/// points along `vector`, is `length` long, and has half the width `half_width`.
fn is_arrow(from: DVec3, vector: DVec3, [length, half_width]: [f64; 2]) -> bool {
    let vector = vector.normalize_or(DVec3::X);
    let along = from.dot(vector) / length;
    let aside = (from - vector * (along * length)).length();
    // The last third of the arrow is its head.
    let width = if along < 0.66 {
        half_width
    } else {
        3.0 * half_width * (1.0 - along) / 0.34
    };
    (0.0..1.0).contains(&along) && aside < width
}

/// Returns whether a position is in the arrow of any site of the second coarsest level.
fn is_field(synthesizer: &Synthesizer, position: DVec3) -> bool {
    let (hierarchy, level) = (
        synthesizer.hierarchy(),
        &synthesizer.hierarchy().levels()[2],
    );
    let size = FIELD.map(|part| part * level.spacing());
    let mut hit = false;
    level.grid().visit(position, size[0], |site| {
        let vector = synthesizer.orientation().vectors()[site.index()];
        // Each arrow is centered at its site.
        let start = hierarchy.sites().positions()[site.index()] - vector * (0.5 * size[0]);
        hit |= is_arrow(position - start, vector, size);
    });
    hit
}

/// Returns the sweep distance at a position: the distance of the nearest site, plus the offset of the position from
/// that site along the field. A mean over several sites would blur the lines where the distance jumps.
fn distance(synthesizer: &Synthesizer, position: DVec3) -> f64 {
    let (hierarchy, level) = (
        synthesizer.hierarchy(),
        &synthesizer.hierarchy().levels()[0],
    );
    let mut nearest = (f64::INFINITY, 0.0);
    level.grid().visit(position, level.spacing(), |site| {
        let from = position - hierarchy.sites().positions()[site.index()];
        if from.length_squared() < nearest.0 {
            let ahead = from.dot(synthesizer.orientation().vectors()[site.index()]);
            let distance = synthesizer.sweep().distances(0)[site.index()] + ahead;
            nearest = (from.length_squared(), distance);
        }
    });
    nearest.1
}

/// Returns a color ramp for one cycle, which ends with its first color.
fn cycle() -> Result<ColorRamp, ColorError> {
    ColorRamp::from_hex(&[
        "#1b2a6b", "#2f9bd0", "#f4f0c8", "#e8743b", "#7a1b4b", "#1b2a6b",
    ])
}
