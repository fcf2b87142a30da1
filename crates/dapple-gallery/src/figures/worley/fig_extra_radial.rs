//! The radial variant of figure 3, "similar to the Death Star": cells in azimuth and polar angle cover a sphere with
//! plates along its meridians and parallels.
//!
//! Figure 3 rotates the Manhattan metric by an eighth of a turn, so that its corners do not point along the axes.
//! Cells that have to close around a sphere cannot be rotated; the Chebyshev metric is equivalent in a plane. The
//! trench along the equator and the dish are bumps of a few lines each.

use super::photo;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_mesh::rotation;
use dapple_preview::{Camera, Light, Material, Object, Scene, Shape, Surface, Transform};
use dapple_worley::{Combination, Metric, Profile, Radial, RadialCells, Worley3, hash::Seed};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("metric", "Chebyshev"),
        ("cells around", "48"),
        ("cells from pole to pole", "24"),
        ("recipe", "radial-hull"),
    ],
    source: source!(),
    render,
};

/// Values of F1 at which the surface has a step. The height of each is [`STEP`].
const LEVELS: [f32; 3] = [0.2, 0.32, 0.44];
const STEP: f64 = 0.005;
/// Center of the dish, and its radius.
const DISH: DVec3 = DVec3::new(-0.12, -0.84, 0.529);
const DISH_RADIUS: f64 = 0.3;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let hull = Worley3::new(Seed(77)).with_metric(Metric::Chebyshev)?;
    let cells = RadialCells {
        around: 48,
        polar: 24.0,
        radial: 0.0,
    };
    let plates = Radial::new(hull.combine(Combination::F1), cells)?;
    let [step, trench] = [Profile::channels(0.04)?, Profile::channels(0.03)?];
    let look = |surface: &Surface| {
        let at = surface.position;
        let value = plates.value(at);
        let height: f32 = LEVELS.iter().map(|level| step.height(level - value)).sum();
        let slope: f64 = LEVELS
            .iter()
            .map(|level| -f64::from(step.slope(level - value)))
            .sum();
        let depth = trench.height(at.z.abs() as f32);
        let mut bump = plates.gradient(at) * (STEP * slope * f64::from(depth))
            + DVec3::Z * (0.03 * at.z.signum() * f64::from(trench.slope(at.z.abs() as f32)));
        let mut gray = (0.25 + 0.08 * height) * (0.3 + 0.7 * depth);
        let from_dish = at - DISH;
        if from_dish.length() < DISH_RADIUS {
            // A spherical bowl that is half as deep as its radius.
            bump = from_dish * (1.2 / DISH_RADIUS);
            gray = 0.36;
        }
        Material::matte(LinearRgb::gray(gray)).with_bump(bump)
    };
    let tilt = rotation(DVec3::Z, 0.2) * rotation(DVec3::X, -1.45);
    let scene = Scene::new(Camera::look_at(DVec3::new(0.0, 0.0, 6.4), DVec3::ZERO).with_fov(0.35))
        .with_object(
            Object::new(Shape::sphere(1.0), look)
                .with_transform(Transform::default().with_rotation(tilt)),
        )
        .with_light(Light::directional(
            DVec3::new(-1.0, 0.5, 0.65),
            LinearRgb::new(1.6, 1.57, 1.5),
        ))
        .with_ambient(LinearRgb::new(0.006, 0.008, 0.012));
    Ok(vec![photo(&scene, [size; 2])?])
}
