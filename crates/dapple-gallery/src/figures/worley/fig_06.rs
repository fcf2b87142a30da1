//! Fractal versions of other primitives, in a row of cut tori. They are solid textures: a cut shows the same texture
//! as the skin.
//!
//! From left to right: F2 − F1, F1, F3 − F2 and 2 F3 − F2 − F1, each as Σ 2^−i F(2^i x) with its measured range scaled
//! to 0 to 1.

use super::{N_POSITIONS, photo};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_preview::{Camera, Cut, Light, Material, Object, Part, Scene, Shadows, Shape, Surface};
use dapple_worley::{CellularFractal, Combination, Octaves, Worley3, hash::Seed};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "6",
    parameters: &[
        ("primitives", "F2 − F1, F1, F3 − F2, 2 F3 − F2 − F1"),
        ("octaves", "5"),
    ],
    source: source!(),
    render,
};

/// The tori. Each has its primitive, the number of cells per unit, its colors from low to high, and the depth of its
/// bumps.
const TORI: [(Combination, f64, [&str; 4], f64); 4] = [
    (
        Combination::F2_MINUS_F1,
        1.1,
        ["#1c120d", "#6e3b1f", "#c98f4e", "#f2dcae"],
        0.25,
    ),
    (
        Combination::F1,
        1.3,
        ["#f4efe2", "#b9a98c", "#5d6b52", "#26332b"],
        -0.2,
    ),
    (
        Combination::F3_MINUS_F2,
        1.0,
        ["#0f1d33", "#27548a", "#7fb2c9", "#eef5f2"],
        0.2,
    ),
    (
        Combination::TWO_F3_MINUS_F2_MINUS_F1,
        1.0,
        ["#2b0d16", "#86222f", "#d9774a", "#f7e2a8"],
        0.15,
    ),
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let camera =
        Camera::look_at(DVec3::new(-1.6, 5.6, 10.5), DVec3::new(-0.8, 0.2, -0.3)).with_fov(0.455);
    let floor = |_: &Surface| Material::matte(LinearRgb::gray(0.32));
    let mut scene = Scene::new(camera)
        .with_object(Object::new(Shape::Plane, floor))
        .with_light(
            Light::directional(DVec3::new(0.9, 1.0, 0.9), LinearRgb::new(1.15, 1.1, 1.0))
                .with_shadows(Shadows::Soft {
                    radius: 0.08,
                    rays: 6,
                }),
        )
        .with_ambient(LinearRgb::new(0.17, 0.18, 0.2));
    for (place, (primitive, frequency, colors, depth)) in (0_u32..).zip(TORI) {
        let texture = solid(primitive, Seed(60 + u64::from(place)))?;
        let ramp = ColorRamp::from_hex(&colors)?;
        let look = move |surface: &Surface| {
            let at = surface.position * frequency;
            let color = ramp.at(texture.value(at));
            match surface.part {
                Part::Skin => {
                    let bump = texture.gradient(at) * (frequency * depth);
                    Material::matte(color * 0.75)
                        .with_bump(bump)
                        .with_specular(0.2, 30.0)
                }
                Part::Cut => Material::matte(color),
            }
        };
        let torus = Object::new(Shape::torus(1.0, 0.5), look)
            .with_cut(Cut::HalfSpace {
                normal: DVec3::Z,
                offset: 0.25,
            })
            .at(DVec3::new(1.95, 0.0, -1.6) * (f64::from(place) - 1.5) + DVec3::Y * 0.5);
        scene = scene.with_object(torus);
    }
    Ok(vec![photo(&scene, [size, size * 5 / 8])?])
}

/// Returns the fractal version of a primitive, with its measured range scaled to 0 to 1.
fn solid(primitive: Combination, seed: Seed) -> anyhow::Result<CellularFractal<3>> {
    let octaves = Octaves {
        count: 5,
        ..Octaves::paper()
    };
    let texture = Worley3::new(seed).combine(primitive).fractal(octaves)?;
    let range = texture.measure_range(seed, N_POSITIONS)?;
    Ok(texture.with_range(range)?)
}
