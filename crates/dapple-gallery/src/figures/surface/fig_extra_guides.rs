//! Textures with guides: two exemplars and a map of their positions; an engraving whose lines grow, and a shaded ball
//! drawn with these lines, light where the ball is light; and a ball with one exemplar above and the other below.
//!
//! The lightness of the engraving and of the ball is blurred by two pixels, so that lines are compared by their mean
//! darkness.

use super::exemplar::cut_out;
use super::stage::{View, lit};
use super::textured::{Job, SiteGuide, srgb};
use crate::draw::enlarged;
use crate::figure::source;
use crate::{Figure, Panel};
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_models::{polygonize_n, solid};
use dapple_raster::{Raster, Wrap};
use dapple_synth::{
    Coherence, Direction, Edges, Exemplar, HierarchyOptions, Options, SideBySide, Sources,
    synthesize_plane_guided,
};
use dapple_tile::blur;
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("examples", "scales and woven hooks, 96² each"),
        ("textures", "192²"),
        ("guides", "which example, of the weight 3; lightness, 1"),
        ("points of the ball", "40,000"),
        ("sizes on the ball", "0.3 to 1, by its directions"),
    ],
    source: source!(),
    render,
};

/// Width and height of the exemplars and the textures, in pixels.
const SIDE: u32 = 96;
const LARGE: u32 = 192;

const VIEW: View = View {
    eye: DVec3::new(0.0, 0.8, 3.5),
    target: DVec3::new(0.0, 0.0, 0.0),
    fov: 0.62,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let examples = [cut_out("scales", SIDE)?, cut_out("woven hooks", SIDE)?];
    let layout = SideBySide::new(&examples.each_ref().map(Raster::size))?;
    let both = layout.join(&examples.each_ref(), LinearRgb::WHITE)?;
    let members = [layout.membership(0)?, layout.membership(1)?];
    let exemplar = Exemplar::new(&both, Edges::Cut)?.with_mask(&layout.mask()?)?;
    let exemplar = exemplar.with_guides(&members.each_ref().map(|member| (member, 3.0)))?;
    let which = Raster::from_fn([LARGE; 2], |x, y| {
        let [x, y] = [x, y].map(|at| f64::from(at) / f64::from(LARGE));
        f32::from(libm::hypot(x - 0.62, y - 0.4) < 0.27 || y > 0.75 + 0.08 * libm::sin(9.0 * x))
    })?;
    let targets = [which.map(|&which| 1.0 - which), which.clone()];
    let mixed = guided(&exemplar, &targets.each_ref())?.transfer(&both)?;

    let lines = Raster::from_fn([2 * SIDE, SIDE], engraving)?;
    let ball = Raster::from_fn([LARGE; 2], shaded)?;
    let soft = |image: &Raster<f32>| blur(image, 2.0, [Wrap::Mirror; 2]);
    let exemplar = Exemplar::from_planes(&[(&lines, 1.0)], Edges::Cut)?;
    let exemplar = exemplar.with_guides(&[(&soft(&lines)?, 1.0)])?;
    let drawn = guided(&exemplar, &[&soft(&ball)?])?.transfer(&lines)?;

    let gray = |values: &Raster<f32>| values.map(|&value| srgb([value; 3]));
    Ok(vec![
        Panel::color("two examples", enlarged(&both, size)?),
        Panel::color("which goes where", enlarged(&gray(&which), size)?),
        Panel::color("the texture", enlarged(&mixed, size)?),
        Panel::color("an engraving", enlarged(&gray(&lines), size)?),
        Panel::color("a picture", enlarged(&gray(&ball), size)?),
        Panel::color("engraved", enlarged(&gray(&drawn), size)?),
        Panel::color("on a model", on_ball(size, both, &layout)?),
    ])
}

/// Synthesizes a texture with guides from an exemplar.
fn guided(
    exemplar: &Exemplar,
    targets: &[&Raster<f32>],
) -> anyhow::Result<dapple_synth::PlaneTexture> {
    let options = Options::default();
    let keep_on = |_| ControlFlow::Continue(());
    let edges = [Edges::Cut; 2];
    Ok(synthesize_plane_guided(
        exemplar, targets, edges, &options, keep_on,
    )?)
}

/// Renders a ball with the first exemplar above a wavy line and the second one below it.
fn on_ball(
    size: u32,
    both: Raster<LinearRgb>,
    layout: &SideBySide,
) -> anyhow::Result<Raster<LinearRgb>> {
    let ball = solid::Ball {
        center: DVec3::ZERO,
        radius: 1.0,
    };
    let guide = |example, at| SiteGuide {
        example,
        at,
        weight: 3.0,
    };
    let job = Job {
        mesh: polygonize_n(&ball, 0.2, 2000)?,
        image: both,
        edges: Edges::Cut,
        directions: vec![Direction {
            at: DVec3::Z,
            vector: DVec3::NEG_Y,
        }],
        sites: HierarchyOptions {
            n_sites: 40_000,
            ..HierarchyOptions::default()
        },
        coherence: Coherence::Auto,
        sources: Sources::SubPixel,
        sizes: Some([0.3, 1.0]),
        detail: None,
        map_side: (4 * size).max(512),
        mask: Some(layout.mask()?),
        guides: vec![
            guide(layout.membership(0)?, is_above),
            guide(layout.membership(1)?, |at| 1.0 - is_above(at)),
        ],
    };
    let textured = job.run()?;
    let mesh = textured.synthesizer.surface().mesh();
    lit(mesh, &VIEW, [size; 2], |surface| textured.color(surface))
}

/// Returns 1 above the wavy line and 0 below it.
fn is_above(at: DVec3) -> f32 {
    f32::from(at.y > 0.1 + 0.15 * libm::sin(4.0 * at.x))
}

/// Returns the lightness of lines that are thin on the left and thick on the right.
fn engraving(x: u32, y: u32) -> f32 {
    let part = f64::from(x) / f64::from(2 * SIDE);
    let bent = f64::from(y) + 2.0 * libm::sin(f64::from(x) / 9.0);
    let from_middle = (bent.rem_euclid(6.0) - 3.0).abs();
    // Edges are soft and one pixel wide.
    (from_middle - 3.2 * part + 0.5).clamp(0.0, 1.0) as f32
}

/// Returns the lightness of a ball lit from the upper left, in front of a wall that is darker at the top.
fn shaded(x: u32, y: u32) -> f32 {
    let [x, y] = [x, y].map(|at| 2.0 * f64::from(at) / f64::from(LARGE) - 1.0);
    let radius_sq = (x * x + y * y) / 0.6;
    if radius_sq >= 1.0 {
        return (0.55 + 0.25 * y) as f32;
    }
    let light = -0.45 * x - 0.55 * y + 0.7 * libm::sqrt(0.6 * (1.0 - radius_sq));
    (light / 0.75).clamp(0.05, 1.0) as f32
}
