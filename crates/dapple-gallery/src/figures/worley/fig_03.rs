//! The hull of a space ship: F1 with the Manhattan metric, not fractal, in steps. Its regions are rigidly rectangular, and
//! still random, and leave right-angled channels between them.
//!
//! The corners of the regions point along the axes, so the texture is turned by an eighth of a turn. Each face of the hull
//! shows a slice that is parallel to it.

use super::hull::{axes, hull};
use super::photo;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_preview::{Camera, Light, Material, Object, Scene, Shape, Surface};
use dapple_worley::{Combination, Metric, Profile, Worley3, hash::Seed};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "3",
    parameters: &[
        ("metric", "Manhattan"),
        ("steps", "where F1 is 0.25, 0.4, 0.55 and 0.7"),
        ("height of a step", "0.025"),
    ],
    source: source!(),
    render,
};

/// Where F1 has a step.
const LEVELS: [f32; 4] = [0.25, 0.4, 0.55, 0.7];
/// How many units of the ship a step is high.
const STEP: f64 = 0.025;
/// Cells per unit of the ship.
const FREQUENCY: f64 = 2.2;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let plates = Worley3::new(Seed(33))
        .with_metric(Metric::Manhattan)?
        .combine(Combination::F1);
    let step = Profile::channels(0.03)?;
    let look = |surface: &Surface| {
        let [u, v, n] = axes(surface.geometric_normal);
        let eighth = 0.5_f64.sqrt();
        let [a, b] = [(u + v) * eighth, (v - u) * eighth];
        let at = surface.position * FREQUENCY;
        let at = DVec3::new(at.dot(a), at.dot(b), at.dot(n) + 0.3);
        let value = plates.value(at);
        let slope = LEVELS
            .iter()
            .map(|level| -f64::from(step.slope(level - value)))
            .sum::<f64>();
        let height = LEVELS
            .iter()
            .map(|level| step.height(level - value))
            .sum::<f32>();
        let gradient = plates.gradient(at) * (slope * FREQUENCY * STEP);
        Material::matte(LinearRgb::gray(0.16 + 0.08 * height))
            .with_bump(a * gradient.x + b * gradient.y)
            .with_specular(0.12, 16.0)
    };
    let camera =
        Camera::look_at(DVec3::new(-5.3, 3.3, -7.2), DVec3::new(-0.2, 0.3, -0.7)).with_fov(0.52);
    let scene = Scene::new(camera)
        .with_object(Object::new(Shape::mesh(hull()?), look))
        .with_light(Light::directional(
            DVec3::new(-1.8, 1.1, -0.25),
            LinearRgb::gray(1.45),
        ))
        .with_ambient(LinearRgb::gray(0.04));
    Ok(vec![photo(&scene, [size, size * 5 / 8])?])
}
