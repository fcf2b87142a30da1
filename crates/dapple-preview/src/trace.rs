//! Ray tracing: the light along a ray.
//!
//! Reference: Turner Whitted, "An Improved Illumination Model for Shaded Display", Communications of the ACM 23(6),
//! 1980, doi 10.1145/358876.358882: a ray to every light tests for shadows, and a ray in the mirrored direction
//! samples the reflection. Indirect light and transparency are not simulated.

use crate::bump::{bump_shadow, bumped, facing};
use crate::light::{Incoming, Lamp};
use crate::material::clean;
use crate::object::Placed;
use crate::ray::Ray;
use crate::shape::Detail;
use crate::shape::Hit;
use crate::{Environment, Material, PreviewError, Scene, Surface};
use dapple_color::LinearRgb;
use glam::DVec3;

/// Offset of the origin of secondary rays from a surface, relative to the largest number from which the point was
/// computed. It is well above their rounding, which is about 1e-15, and too small to see.
const LIFT: f64 = 1e-9;

/// A ray along which light is traced, and its history.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    ray: Ray,
    /// The length of the path before this ray.
    length: f64,
    /// The width of an image sample at distance 1.
    sample: f64,
    bounces: u32,
}

impl Path {
    /// Starts a path at the eye.
    pub(crate) fn new(ray: Ray, sample: f64, bounces: u32) -> Self {
        Self {
            ray,
            length: 0.0,
            sample,
            bounces,
        }
    }
}

/// A validated scene.
pub(crate) struct World<'a> {
    objects: Vec<Placed<'a>>,
    lamps: Vec<Lamp>,
    ambient: LinearRgb,
    environment: &'a Environment<'a>,
}

/// A surface point in the world, with the data for its lighting.
struct Lit {
    /// The unit vector to the eye.
    to_eye: DVec3,
    /// The unit normal of the smooth surface.
    smooth: DVec3,
    /// The unit normal with its bumps.
    normal: DVec3,
    /// The position at which the light is evaluated.
    position: DVec3,
    /// Origin of shadow rays.
    shadow_origin: DVec3,
}

impl<'a> World<'a> {
    pub(crate) fn new(scene: &'a Scene<'_>) -> Result<Self, PreviewError> {
        scene.environment.check()?;
        let objects: Result<_, _> = scene
            .objects
            .iter()
            .map(|object| object.prepare())
            .collect();
        let lamps: Result<_, _> = scene.lights.iter().map(|light| light.prepare()).collect();
        Ok(World {
            objects: objects?,
            lamps: lamps?,
            ambient: clean(scene.ambient),
            environment: &scene.environment,
        })
    }

    /// Returns the light along a path. The result is always finite.
    pub(crate) fn light(&self, path: &Path) -> LinearRgb {
        let light = match self.nearest(&path.ray) {
            Some((object, hit, distance)) => self.surface_light(path, object, &hit, distance),
            None => self.background(path.ray.direction),
        };
        // Materials and lights with very large numbers overflow. Clamp to finite numbers.
        let finite = |part: f32| match part {
            part if part.is_nan() => 0.0,
            part => part.clamp(f32::MIN, f32::MAX),
        };
        light.to_array().map(finite).into()
    }

    fn background(&self, direction: DVec3) -> LinearRgb {
        clean(self.environment.light(direction))
    }

    /// Returns the nearest object that a ray hits. If several are equally near, returns the first in the list.
    fn nearest(&self, ray: &Ray) -> Option<(&Placed<'a>, Hit, f64)> {
        let mut best = None;
        let mut limit = f64::INFINITY;
        for object in &self.objects {
            // Search in the space of the object, whose lengths are scaled.
            let scale = object.placement.scale;
            let own_ray = object.placement.ray_to_object(ray);
            if let Some(hit) = object
                .body
                .hit(&own_ray, limit * object.placement.inverse_scale)
            {
                limit = hit.distance * scale;
                best = Some((object, hit, limit));
            }
        }
        best
    }

    /// Returns whether an object blocks a ray at a distance below `distance`.
    fn blocked(&self, ray: &Ray, distance: f64) -> bool {
        self.objects.iter().any(|object| {
            let own_ray = object.placement.ray_to_object(ray);
            let limit = distance * object.placement.inverse_scale;
            object.body.blocks(&own_ray, limit)
        })
    }

    fn surface_light(
        &self,
        path: &Path,
        object: &Placed<'_>,
        hit: &Hit,
        distance: f64,
    ) -> LinearRgb {
        // Describe the hit to the material function, in the space of the object.
        let placement = &object.placement;
        let own_ray = placement.ray_to_object(&path.ray);
        let detail = seen(object.body.detail(&own_ray, hit), -own_ray.direction);
        let length = path.length + distance;
        let position = placement.point_to_world(detail.position);
        let surface = Surface {
            position: detail.position,
            world_position: position,
            normal: detail.normal,
            geometric_normal: detail.geometric_normal,
            part: detail.part,
            footprint: length * path.sample * placement.inverse_scale,
            incidence: -detail.geometric_normal.dot(own_ray.direction),
            chart: detail.chart,
        };
        let material = (object.look)(&surface).cleaned();
        // Tilt the normal by the bump, and move secondary rays off the surface.
        let normal = bumped(detail.normal, material.bump, -own_ray.direction);
        let geometric_normal = placement.direction_to_world(detail.geometric_normal);
        let size = position.abs().max_element().max(length);
        let lift = geometric_normal * (LIFT * size);
        let lit = Lit {
            to_eye: -path.ray.direction,
            smooth: placement.direction_to_world(detail.normal),
            normal: placement.direction_to_world(normal),
            position,
            shadow_origin: placement.point_to_world(detail.lit_position) + lift,
        };
        // Combine the scattered light, the highlights and the emission.
        let part = material.mirror.part(lit.normal.dot(lit.to_eye));
        let [scattered, highlights] = self.local_light(&lit, &material);
        let mut light = scattered * (1.0 - part) + highlights + material.emission;
        // Trace the mirrored ray. After the last bounce it sees only the environment.
        if part > 0.0 {
            let ray = Ray {
                origin: position + lift,
                direction: mirrored(path.ray.direction, lit.normal, geometric_normal),
            };
            let seen = match path.bounces.checked_sub(1) {
                None => self.background(ray.direction),
                Some(bounces) => self.light(&Path {
                    ray,
                    length,
                    sample: path.sample,
                    bounces,
                }),
            };
            light = light + seen * part;
        }
        light
    }

    /// Returns the scattered light from lights and ambient light, and the highlights.
    fn local_light(&self, lit: &Lit, material: &Material) -> [LinearRgb; 2] {
        let mut scattered = times(material.color, self.ambient);
        let mut highlights = LinearRgb::BLACK;
        let slope = lit.smooth.dot(lit.normal);
        for lamp in &self.lamps {
            let Some(incoming) = lamp.incoming(lit.position) else {
                continue;
            };
            // Skip lights behind the surface or hidden by its bumps.
            let toward = incoming.toward;
            let cosine = lit.normal.dot(toward);
            let seen = bump_shadow(lit.smooth.dot(toward), slope);
            if cosine <= 0.0 || seen <= 0.0 {
                continue;
            }
            // Trace shadow rays.
            let free = lamp.visible(&incoming, |direction, distance| {
                let origin = lit.shadow_origin;
                self.blocked(&Ray { origin, direction }, distance)
            });
            if free <= 0.0 {
                continue;
            }
            let color = incoming.color * (free * seen as f32);
            scattered = scattered + times(material.color, color) * cosine as f32;
            highlights = highlights + color * highlight(lit, &incoming, material);
        }
        [scattered, highlights]
    }
}

/// Returns the detail with its normals flipped to the side of the eye.
fn seen(mut detail: Detail, to_eye: DVec3) -> Detail {
    if detail.geometric_normal.dot(to_eye) < 0.0 {
        detail.geometric_normal = -detail.geometric_normal;
    }
    if detail.normal.dot(detail.geometric_normal) < 0.0 {
        detail.normal = -detail.normal;
    }
    detail.normal = facing(detail.normal, to_eye);
    detail
}

/// Returns the strength of the highlight of a light, after Blinn.
fn highlight(lit: &Lit, incoming: &Incoming, material: &Material) -> f32 {
    if material.specular <= 0.0 {
        return 0.0;
    }
    // The half vector between the directions to the eye and to the light.
    let half = (lit.to_eye + incoming.toward).normalize_or_zero();
    let cosine = lit.normal.dot(half).clamp(0.0, 1.0);
    material.specular * libm::pow(cosine, material.shininess.into()) as f32
}

/// Returns the direction of a ray reflected by a bumped mirror. A reflection that points into the surface is reflected
/// out of it again.
fn mirrored(direction: DVec3, normal: DVec3, geometric_normal: DVec3) -> DVec3 {
    // Reflect at the bumped normal, then reflect any part that points into the actual surface.
    let away = direction - normal * (2.0 * direction.dot(normal));
    let depth = away.dot(geometric_normal).min(0.0);
    (away - geometric_normal * (2.0 * depth)).normalize_or(geometric_normal)
}

/// Returns the product of two colors, channel by channel.
fn times(a: LinearRgb, b: LinearRgb) -> LinearRgb {
    LinearRgb::new(a.r * b.r, a.g * b.g, a.b * b.b)
}

#[cfg(test)]
mod tests {
    use super::mirrored;
    use glam::DVec3;

    #[test]
    fn mirrored_ray_leaves_the_surface_when_a_bump_turns_it_inward() {
        // A ray straight down onto a bump that leans by 53 degrees is mirrored 16 degrees below the horizon.
        let bumped = DVec3::new(0.8, 0.6, 0.0);
        let away = mirrored(DVec3::NEG_Y, bumped, DVec3::Y);
        let expected = DVec3::new(0.96, 0.28, 0.0);
        // A handful of roundings of numbers of size 1.
        assert!((away - expected).length() < 1e-15, "{away}");
        let plain = mirrored(DVec3::NEG_Y, DVec3::Y, DVec3::Y);
        assert_eq!(plain, DVec3::Y, "a flat mirror");
    }
}
