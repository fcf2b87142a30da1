//! Flagstones: each cell has an individual color from the identity of its feature point, F1 and F2 carve the joints
//! between cells as a bump, and fractal noise discolors each stone differently.
//!
//! F2 − F1 alone makes joints that widen into dents between feature points that are close together. (F2² − F1²) / 2d,
//! where d is the distance between the two feature points, is the distance to the border between them, and makes
//! joints of constant width. F3 and F4 are also needed, for the corners where three stones meet.

use super::{FractalNoise, photo};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_preview::{Camera, Light, Material, Object, Scene, Shadows, Shape, Surface};
use dapple_worley::{Combination, Feature, Octaves, Profile, Scatter, Worley2, hash::Seed};
use glam::{DVec2, DVec3};

pub(super) const FIGURE: Figure = Figure {
    number: "2",
    parameters: &[
        ("joints", "nearer than 0.035 to the border"),
        ("depth of the joints", "0.035"),
        ("feature points", "one in each cell, jittered by 0.8"),
        (
            "discoloration",
            "5 octaves of noise, another place for each stone",
        ),
        ("grain", "fractal F1"),
        ("recipe", "flagstone"),
    ],
    source: source!(),
    render,
};

/// Depth of the joints, in cells.
const DEPTH: f64 = 0.035;
/// Height of the grain of the stones, in cells.
const GRAIN: f64 = 0.01;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let stones = [
        "#6b5f53", "#8d7b66", "#a58f72", "#75757a", "#96877c", "#b39b7d", "#7d6a5a", "#5f6468",
    ];
    let stones = ColorRamp::from_hex(&stones)?;
    let rust = LinearRgb::from_srgb([104_u8, 66, 38]);
    let joint = LinearRgb::from_srgb([58_u8, 54, 48]);
    let worley = Worley2::new(Seed(2)).with_scatter(Scatter::Jittered { jitter: 0.8 })?;
    let channels = Profile::channels(0.035)?;
    let grain = Worley2::new(Seed(3))
        .combine(Combination::F1)
        .fractal(Octaves {
            count: 2,
            ..Octaves::paper()
        })?;
    let stain = FractalNoise::new(0.2, Seed(4))?;

    let flags = |surface: &Surface| {
        let at = DVec2::new(surface.position.x, surface.position.z);
        let [first, others @ ..] = worley.sample::<4>(at);
        let (border, across) = nearest_border(&first, &others);
        // The edges of the stones are chipped.
        let chips = stain.at(at * 2.0) - 0.5;
        let border = border + 0.03 * chips;
        let height = channels.height(border);
        let bump = across * (DEPTH * f64::from(channels.slope(border)))
            + grain.gradient(at * 4.0) * (4.0 * GRAIN);
        let shift = DVec2::new(
            f64::from(first.cell_value()),
            (first.id & 0xff) as f64 / 256.0,
        );
        let stain = stain.at(at * 0.3 + shift * 7.0);
        let stone = stones.at(first.cell_value()) * (0.25 + 1.4 * stain);
        let stone = stone.lerp(rust, 0.6 * (1.0 - 2.0 * stain).clamp(0.0, 1.0));
        Material::matte(joint.lerp(stone, height))
            .with_bump(DVec3::new(bump.x, 0.0, bump.y))
            .with_specular(0.06 * height, 20.0)
    };
    let camera = Camera::look_at(DVec3::new(0.0, 3.6, 4.2), DVec3::new(0.0, 0.0, 0.0));
    let scene = Scene::new(camera)
        .with_object(Object::new(Shape::Plane, flags))
        .with_light(
            Light::directional(DVec3::new(-2.0, 1.3, -0.6), LinearRgb::new(1.9, 1.75, 1.5))
                .with_shadows(Shadows::None),
        )
        .with_ambient(LinearRgb::new(0.2, 0.23, 0.3));
    Ok(vec![photo(&scene, [size, size * 3 / 4])?])
}

/// Returns the distance to the nearest border of the first point's cell, and the gradient of this distance.
fn nearest_border(first: &Feature<DVec2>, others: &[Feature<DVec2>]) -> (f32, DVec2) {
    let border = |other: &Feature<DVec2>| {
        let way = other.vector - first.vector;
        let gap = other.vector.length_squared() - first.vector.length_squared();
        let distance = gap / (2.0 * way.length());
        (distance as f32, way.normalize_or_zero())
    };
    let borders = others.iter().map(border);
    let nearest = borders.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.unwrap_or((f32::INFINITY, DVec2::ZERO))
}
