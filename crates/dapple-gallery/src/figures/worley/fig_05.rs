//! The hide of a creature: a fractal version of F1 makes its spots and its bumps, and a linear gradient varies the color
//! from the back to the belly. The tongue is fractal noise.
//!
//! The paper's creature is Richard Payne's Gator; this one is a handful of blended cones.

use super::creature::{Creature, EYE, Part};
use super::polygonize::polygonize;
use super::{FractalNoise, photo};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorError, ColorRamp, ColorStop, LinearRgb};
use dapple_preview::{Camera, Environment, Light, Material, Object, Scene, Shape, Sky, Surface};
use dapple_worley::{CellularFractal, Combination, Octaves, Worley3, hash::Seed};
use glam::{DVec2, DVec3};

pub(super) const FIGURE: Figure = Figure {
    number: "5",
    parameters: &[
        (
            "hide",
            "Σ 2^−i F1(2^i x), i from 0 to 3, as colors and bumps",
        ),
        ("gradient", "from belly to back"),
        ("tongue", "5 octaves of noise"),
        ("recipe", "crusty-skin"),
    ],
    source: source!(),
    render,
};

/// Number of cells per unit length on the hide. The creature is about 8 units long.
const FREQUENCY: f64 = 3.2;
/// Height of the bumps, in cells.
const BUMP: f64 = 0.3;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let octaves = Octaves {
        count: 4,
        ..Octaves::paper()
    };
    let hide = Worley3::new(Seed(55))
        .combine(Combination::F1)
        .fractal(octaves)?;
    let hide = hide
        .clone()
        .with_range(hide.measure_range(Seed(1), 4000)?)?;
    let look = Look {
        hide,
        back: spots(["#141a0c", "#4f7226", "#9aa346"])?,
        belly: spots(["#4a3a1a", "#c4ad6a", "#ece0b2"])?,
        tongue: FractalNoise::new(0.15, Seed(56))?,
    };
    let mesh = polygonize(&Creature, 14.0 / f64::from(size.clamp(64, 1024)))?;
    let sky = Sky {
        nadir: LinearRgb::gray(0.1),
        horizon: LinearRgb::new(0.75, 0.72, 0.62),
        zenith: LinearRgb::new(0.25, 0.4, 0.55),
    };
    let grains = FractalNoise::new(0.1, Seed(57))?;
    let sand = |surface: &Surface| {
        let at = DVec2::new(surface.position.x, surface.position.z);
        // Omit grains finer than an image sample.
        let samples = surface.footprint / surface.incidence / 0.2;
        let grain = (grains.at(at * 0.25) - 0.5) / (1.0 + samples * samples) as f32;
        Material::matte(LinearRgb::new(0.4, 0.32, 0.2) * (1.0 + 0.6 * grain))
    };
    let camera =
        Camera::look_at(DVec3::new(5.4, 2.1, 6.2), DVec3::new(0.68, 0.68, 0.25)).with_fov(0.49);
    let scene = Scene::new(camera)
        .with_object(Object::new(Shape::Plane, sand))
        .with_object(Object::new(Shape::mesh(mesh), |surface: &Surface| {
            look.at(surface)
        }))
        .with_light(Light::directional(
            DVec3::new(0.9, 1.6, 0.5),
            LinearRgb::new(1.15, 1.08, 0.95),
        ))
        .with_ambient(LinearRgb::new(0.22, 0.24, 0.27))
        .with_environment(Environment::Sky(sky));
    Ok(vec![photo(&scene, [size, size * 5 / 8])?])
}

/// Returns a ramp with dark spots near feature points, and the other two colors between them.
fn spots([spot, hide, far]: [&str; 3]) -> Result<ColorRamp, ColorError> {
    let [spot, hide, far] = [(0.3, spot), (0.46, hide), (0.9, far)]
        .map(|(position, hex)| LinearRgb::from_hex(hex).map(|color| ColorStop { position, color }));
    ColorRamp::new([spot?, hide?, far?])
}

/// Textures and colors of the creature's parts.
struct Look {
    hide: CellularFractal<3>,
    back: ColorRamp,
    belly: ColorRamp,
    tongue: FractalNoise,
}

impl Look {
    fn at(&self, surface: &Surface) -> Material {
        let at = surface.position;
        match Creature.part(at) {
            Part::Hide => self.hide(at),
            Part::Tongue => {
                let noise = self.tongue.at(DVec2::new(at.x, at.z));
                let color =
                    LinearRgb::new(0.35, 0.02, 0.03).lerp(LinearRgb::new(0.9, 0.28, 0.25), noise);
                Material::matte(color).with_specular(0.35, 40.0)
            }
            Part::Eye => {
                // The pupil is a slit.
                let pupil = (at.x - EYE.x - 0.03).abs() < 0.022;
                let color = if pupil {
                    LinearRgb::BLACK
                } else {
                    LinearRgb::new(0.8, 0.55, 0.06)
                };
                Material::matte(color).with_specular(0.8, 120.0)
            }
            Part::Tooth => {
                Material::matte(LinearRgb::new(0.85, 0.8, 0.66)).with_specular(0.3, 60.0)
            }
        }
    }

    fn hide(&self, at: DVec3) -> Material {
        let cells = at * FREQUENCY;
        let value = self.hide.value(cells);
        let up = ((at.y - 0.1) / 0.9).clamp(0.0, 1.0) as f32;
        let color = self.belly.at(value).lerp(self.back.at(value), up);
        // The hide is higher near feature points.
        let bump = self.hide.gradient(cells) * -BUMP;
        Material::matte(color)
            .with_bump(bump)
            .with_specular(0.2, 25.0)
    }
}
