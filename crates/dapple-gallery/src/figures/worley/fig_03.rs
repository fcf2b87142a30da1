//! The hull of a space ship: F1 with the Manhattan metric, not fractal. Its regions are rigidly rectangular but
//! random, and make right-angled channels. The hull sinks in steps, which are in its mesh, so that they cast shadows
//! in the light of a low sun; on the bridge they rise.
//!
//! The corners of the regions point along the axes, so the texture is rotated by an eighth of a turn. Each panel of
//! the hull has a slice that is parallel to it.

use super::hull::{Panel, hull};
use super::photo;
use crate::figure::source;
use crate::{Figure, Panel as Picture};
use dapple_color::LinearRgb;
use dapple_preview::{Camera, Light, Material, Object, Scene, Shape};
use dapple_worley::{Metric, Worley3, hash::Seed};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "3",
    parameters: &[
        ("metric", "Manhattan"),
        ("steps", "where F1 is 0.68, 0.5, 0.33 and 0.17"),
        (
            "depths of the steps",
            "0.035, 0.03, 0.025, 0.02; a cell is 0.42 wide",
        ),
        ("recipe", "spaceship-hull"),
    ],
    source: source!(),
    render,
};

/// Steps of the hull. Where F1 is below the first number, the hull has a step whose depth is the second number.
const STEPS: [(f32, f64); 4] = [(0.68, 0.035), (0.5, 0.03), (0.33, 0.025), (0.17, 0.02)];
/// Number of cells per unit of the ship.
const FREQUENCY: f64 = 2.4;
/// Step of the mesh's grid at distance 1, in pixels of an image that is about 1 unit wide there.
const GRID: f64 = 3.0;

fn render(size: u32) -> anyhow::Result<Vec<Picture>> {
    let cells = Worley3::new(Seed(33)).with_metric(Metric::Manhattan)?;
    let relief = |panel: &Panel, at: DVec3| {
        let [u, v, n] = panel.axes();
        let [a, b] = [u + v, v - u].map(DVec3::normalize);
        let at = at * FREQUENCY;
        let [nearest] = cells.sample(DVec3::new(at.dot(a), at.dot(b), at.dot(n) + 0.3));
        let steps = STEPS.iter().filter(|(f1, _)| nearest.distance < *f1);
        steps.map(|(_, depth)| depth).sum()
    };
    let mesh = hull(GRID / f64::from(size), relief)?;
    let paint = LinearRgb::new(0.4, 0.42, 0.45);
    let look = |_: &_| Material::matte(paint).with_specular(0.08, 12.0);
    let camera =
        Camera::look_at(DVec3::new(1.9, 2.3, 0.6), DVec3::new(0.5, 0.75, -6.0)).with_fov(0.62);
    let scene = Scene::new(camera)
        .with_object(Object::new(Shape::mesh(mesh), look))
        .with_light(Light::directional(
            DVec3::new(1.0, 0.55, -0.5),
            LinearRgb::new(1.75, 1.68, 1.55),
        ))
        .with_light(Light::directional(
            DVec3::new(-0.6, 0.5, 1.0),
            LinearRgb::new(0.05, 0.07, 0.11),
        ))
        .with_ambient(LinearRgb::new(0.025, 0.028, 0.035));
    Ok(vec![photo(&scene, [size, size * 5 / 8])?])
}
