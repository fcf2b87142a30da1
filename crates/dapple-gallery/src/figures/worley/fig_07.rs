//! Sea water: only a reflecting plane with "crumple", a fractal version of F1, as its bump map, under a sky with a low
//! sun.
//!
//! An octave that is finer than a sample of the image is faded out, so that the water toward the horizon is calm and
//! not noisy.

use super::photo;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_preview::{
    Camera, Environment, Material, Mirror, Object, Scene, Shape, Sky, Sun, Surface,
};
use dapple_worley::{Combination, Worley3, hash::Seed};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "7",
    parameters: &[
        ("waves", "Σ 2^−i F1(2^i x), i from 0 to 4"),
        ("mirror", "Fresnel, 0.02 seen straight"),
        ("recipe", "sea-water"),
    ],
    source: source!(),
    render,
};

/// Number of octaves in the waves.
const OCTAVES: u32 = 5;
/// Height of the first octave's waves, as a fraction of their length.
const STEEPNESS: f64 = 0.11;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let crumple = Worley3::new(Seed(7)).combine(Combination::F1);
    let water = |surface: &Surface| {
        let mut bump = DVec3::ZERO;
        for octave in 0..OCTAVES {
            let frequency = f64::from(1 << octave);
            // Number of waves of this octave per sample along the view direction.
            let waves = frequency * surface.footprint / surface.incidence;
            if waves >= 1.0 {
                break;
            }
            bump += crumple.gradient(surface.position * frequency) * (1.0 - waves * waves);
        }
        Material::matte(LinearRgb::BLACK)
            .with_emission(LinearRgb::new(0.004, 0.03, 0.04))
            .with_bump(bump * STEEPNESS)
            .with_mirror(Mirror::Fresnel(0.02))
    };
    let sky = Sky {
        nadir: LinearRgb::new(0.02, 0.05, 0.07),
        horizon: LinearRgb::new(0.8, 0.72, 0.62),
        zenith: LinearRgb::new(0.08, 0.2, 0.45),
    };
    let sun = Sun {
        toward: DVec3::new(0.25, 0.1, -1.0),
        color: LinearRgb::new(6.0, 5.0, 3.5),
        radius: 0.035,
        glow: LinearRgb::new(0.5, 0.32, 0.14),
        glow_radius: 0.15,
    };
    let camera = Camera::look_at(DVec3::new(0.0, 2.2, 0.0), DVec3::new(0.0, 0.45, -8.0));
    let scene = Scene::new(camera)
        .with_object(Object::new(Shape::Plane, water))
        .with_environment(Environment::Sun(sky, sun))
        .with_bounces(0);
    Ok(vec![photo(&scene, [size, size * 3 / 4])?])
}
