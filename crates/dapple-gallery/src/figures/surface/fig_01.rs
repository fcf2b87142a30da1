//! The colors of the points on three levels, from the coarsest to the finest: points are drawn as flattened spheres.
//! The orientation field flows from left to right over the sphere, and the texture is the one on the ray in figure 5.

use super::stage::{View, lit};
use super::subject::RAY;
use super::textured::srgb;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_models::{polygonize_n, solid};
use dapple_preview::Surface;
use dapple_synth::{
    Exemplar, Hierarchy, HierarchyOptions, Options, Orientation, SurfaceTexture, Synthesizer,
};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "1",
    parameters: &[
        ("points", "750, 3000 and 12,000"),
        ("exemplar", "wiggly checker, 64²"),
        ("orientation", "+x, projected"),
    ],
    source: source!(),
    render,
};

/// Radius of a drawn point, in multiples of its level's site spacing, small enough that points do not touch.
const RADIUS: f64 = 0.45;

const VIEW: View = View {
    eye: DVec3::new(0.0, 0.0, 4.0),
    target: DVec3::ZERO,
    fov: 0.55,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let (image, edges) = RAY.image()?;
    let ball = solid::Ball {
        center: DVec3::ZERO,
        radius: 1.0,
    };
    let surface = dapple_synth::mesh::Surface::new(polygonize_n(&ball, 0.2, 4000)?)?;
    let options = HierarchyOptions {
        n_sites: 12_000,
        ..HierarchyOptions::default()
    };
    let hierarchy = Hierarchy::new(&surface, &options)?;
    let orientation = Orientation::from_fn(&hierarchy, |_, _| DVec3::X);
    let synthesizer = Synthesizer::from_parts(surface, hierarchy, orientation, None)?;
    let texture = synthesizer.synthesize(&Exemplar::new(&image, edges)?, &Options::default())?;
    let mesh = synthesizer.surface().mesh();
    let panel = |level: usize| {
        let color =
            |at: &Surface| point_color(synthesizer.hierarchy(), &texture, level, at.position);
        let picture = lit(mesh, &VIEW, [size; 2], color)?;
        let n_points = synthesizer.hierarchy().levels()[level].n_sites();
        Ok(Panel::color(
            format!("M{}, {n_points} points", level + 1),
            picture,
        ))
    };
    (0..3).rev().map(panel).collect()
}

/// Returns the color at a position for the points of a level: a point's color, darker toward the edge of the point,
/// or dark gray between points.
fn point_color(
    hierarchy: &Hierarchy,
    texture: &SurfaceTexture,
    level: usize,
    position: DVec3,
) -> LinearRgb {
    let radius = RADIUS * hierarchy.levels()[level].spacing();
    let mut nearest = (radius, None);
    hierarchy.levels()[level]
        .grid()
        .visit(position, radius, |site| {
            let distance = hierarchy.sites().positions()[site.index()].distance(position);
            if distance < nearest.0 {
                nearest = (distance, Some(site));
            }
        });
    let (distance, Some(site)) = nearest else {
        return LinearRgb::gray(0.1);
    };
    let values = &texture.values(level)[3 * site.index()..];
    let part = distance / radius;
    srgb([values[0], values[1], values[2]]) * (1.0 - 0.5 * part * part * part) as f32
}
