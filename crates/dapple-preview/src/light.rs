//! Lights and their shadows.

use crate::PreviewError;
use crate::ray::frame;
use core::f64::consts::PI;
use dapple_color::LinearRgb;
use glam::{DVec2, DVec3};

/// A light source with a color and a method for shadows.
///
/// # Examples
///
/// ```
/// use dapple_color::LinearRgb;
/// use dapple_preview::{Light, Shadows, glam::DVec3};
///
/// let sun = Light::directional(DVec3::new(1.0, 2.0, 1.0), LinearRgb::gray(0.9));
/// let lamp = Light::point(DVec3::new(0.0, 5.0, 0.0), LinearRgb::gray(0.4)).with_shadows(Shadows::None);
/// assert_eq!(sun.shadows, Shadows::Hard);
/// # let _ = lamp;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The source of the light.
    pub source: LightSource,
    /// The color of a white surface that is lit perpendicularly, at any distance if the light has no falloff.
    pub color: LinearRgb,
    /// The method for shadows. Default: hard.
    pub shadows: Shadows,
}

/// The source of a light: a direction or a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightSource {
    /// Parallel light from an infinite distance.
    Directional {
        /// The direction to the light, in the world. Any length except zero.
        toward: DVec3,
    },
    /// Light that radiates from a point.
    Point {
        /// The position of the light, in the world.
        position: DVec3,
        /// The falloff with distance.
        falloff: Falloff,
    },
}

/// The falloff of a point light with distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Falloff {
    /// No falloff: the intensity is the same at any distance.
    #[default]
    None,
    /// Falloff with the square of the distance. The number is the distance, in units of the world, at which the light
    /// has its color.
    InverseSquare(f64),
}

/// The method for computing shadows.
///
#[cfg_attr(doc, doc = include_str!("../docs/shadows.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shadows {
    /// No shadows: the light passes through all objects.
    None,
    /// Hard shadows, with one ray.
    #[default]
    Hard,
    /// Soft shadows, with rays to a disk. The pattern of rays is the same at every point, so with few rays, the edges of
    /// shadows have visible steps.
    Soft {
        /// The radius of the disk. For a point light, in units of the world. For a directional light, the disk is at
        /// distance 1, so the radius is the tangent of an angle.
        radius: f64,
        /// The number of rays, from 1 to 1024; 16 to 64 is usual.
        rays: u32,
    },
}

impl Light {
    /// Creates a distant light in the direction `toward`, with hard shadows.
    #[must_use]
    pub fn directional(toward: DVec3, color: LinearRgb) -> Self {
        Self {
            source: LightSource::Directional { toward },
            color,
            shadows: Shadows::Hard,
        }
    }

    /// Creates a point light without falloff, with hard shadows.
    #[must_use]
    pub fn point(position: DVec3, color: LinearRgb) -> Self {
        let falloff = Falloff::None;
        Self {
            source: LightSource::Point { position, falloff },
            color,
            shadows: Shadows::Hard,
        }
    }

    /// Sets the method for shadows.
    #[must_use]
    pub fn with_shadows(self, shadows: Shadows) -> Self {
        Self { shadows, ..self }
    }

    pub(crate) fn prepare(&self) -> Result<Lamp, PreviewError> {
        let mut source = self.source;
        match &mut source {
            LightSource::Directional { toward } => {
                *toward = PreviewError::direction("direction to a light", *toward)?;
            }
            LightSource::Point { position, falloff } => {
                PreviewError::check_vector("position of a light", *position)?;
                if let Falloff::InverseSquare(distance) = *falloff {
                    PreviewError::check_length("distance of the falloff of a light", distance)?;
                }
            }
        }
        Ok(Lamp {
            source,
            color: crate::material::clean(self.color),
            pattern: self.shadows.pattern()?,
        })
    }
}

impl Shadows {
    /// Returns the targets of shadow rays on the unit disk, placed along a Vogel spiral so that each stands for the
    /// same area.
    ///
    /// Reference: Helmut Vogel, "A better way to construct the sunflower head", Mathematical Biosciences 44, 1979.
    fn pattern(self) -> Result<Vec<DVec2>, PreviewError> {
        let (radius, rays) = match self {
            Self::None => return Ok(Vec::new()),
            Self::Hard => return Ok(vec![DVec2::ZERO]),
            Self::Soft { radius, rays } => (radius, rays),
        };
        let what = "radius of a light";
        PreviewError::check(
            (0.0..=1e30).contains(&radius),
            what,
            radius,
            "from 0 to 1e30",
        )?;
        let what = "number of shadow rays";
        let holds = (1..=1024).contains(&rays);
        PreviewError::check(holds, what, rays.into(), "from 1 to 1024")?;
        // Vogel's spiral. The radius grows with the square root of the index, and each point turns by the golden angle.
        let golden_angle = PI * (3.0 - 5_f64.sqrt());
        let point = |ray: u32| {
            let out = radius * ((f64::from(ray) + 0.5) / f64::from(rays)).sqrt();
            let angle = golden_angle * f64::from(ray);
            DVec2::new(libm::cos(angle), libm::sin(angle)) * out
        };
        Ok((0..rays).map(point).collect())
    }
}

/// A validated light.
#[derive(Clone, Debug)]
pub(crate) struct Lamp {
    source: LightSource,
    color: LinearRgb,
    /// The targets of shadow rays on the disk. Empty for a light without shadows.
    pattern: Vec<DVec2>,
}

/// The direction, distance and color of a light at a point, before shadows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incoming {
    pub(crate) color: LinearRgb,
    /// The unit vector to the light.
    pub(crate) toward: DVec3,
    /// The distance to the light. Infinite for a directional light.
    pub(crate) distance: f64,
}

impl Lamp {
    /// Returns the light that arrives at `point`, or `None` at the light's own position.
    pub(crate) fn incoming(&self, point: DVec3) -> Option<Incoming> {
        let color = self.color;
        match self.source {
            LightSource::Directional { toward } => Some(Incoming {
                color,
                toward,
                distance: f64::INFINITY,
            }),
            LightSource::Point { position, falloff } => {
                let offset = position - point;
                let distance = offset.length();
                let weight = match falloff {
                    Falloff::None => 1.0,
                    Falloff::InverseSquare(unit) => (unit / distance) * (unit / distance),
                };
                Some(Incoming {
                    color: color * weight.min(1e30) as f32,
                    toward: offset.try_normalize()?,
                    distance,
                })
            }
        }
    }

    /// Returns the fraction of the light, from 0 to 1, that is not blocked. `blocked` receives the unit direction of a
    /// shadow ray and its length.
    pub(crate) fn visible(
        &self,
        incoming: &Incoming,
        mut blocked: impl FnMut(DVec3, f64) -> bool,
    ) -> f32 {
        if self.pattern.is_empty() {
            return 1.0;
        }
        // Count the shadow rays to the disk that are not blocked.
        let [right, up] = frame(incoming.toward);
        let reach = match self.source {
            LightSource::Directional { .. } => 1.0,
            LightSource::Point { .. } => incoming.distance,
        };
        let free = self.pattern.iter().filter(|offset| {
            let to_disk = incoming.toward * reach + right * offset.x + up * offset.y;
            let length = to_disk.length();
            let distance = incoming.distance.max(length);
            !blocked(to_disk / length, distance)
        });
        free.count() as f32 / self.pattern.len() as f32
    }
}

#[cfg(test)]
mod tests {
    use super::{Falloff, Light, LightSource, Shadows};
    use dapple_color::LinearRgb;
    use glam::DVec3;

    #[test]
    fn point_light_falls_off_with_the_square_of_the_distance() {
        let light = Light {
            source: LightSource::Point {
                position: DVec3::ZERO,
                falloff: Falloff::InverseSquare(3.0),
            },
            color: LinearRgb::WHITE,
            shadows: Shadows::None,
        };
        let lamp = light.prepare().unwrap();
        let at = |x: f64| lamp.incoming(DVec3::X * x).map(|light| light.color);
        assert_eq!(at(3.0), Some(LinearRgb::WHITE), "at its distance");
        assert_eq!(at(6.0), Some(LinearRgb::gray(0.25)), "twice as far");
        assert_eq!(at(0.0), None, "where the light is");
    }

    #[test]
    fn soft_light_is_seen_through_a_hole_in_the_middle_by_its_share() {
        let soft = Shadows::Soft {
            radius: 0.2,
            rays: 100,
        };
        let light = Light::point(DVec3::Z * 4.0, LinearRgb::WHITE).with_shadows(soft);
        let lamp = light.prepare().unwrap();
        let incoming = lamp.incoming(DVec3::ZERO).unwrap();
        // Half of the radius is a quarter of the disk, and the pattern has equal shares of area.
        let edge = 0.1 / 4.0;
        let part = lamp.visible(&incoming, |direction, _| {
            (direction / direction.z).truncate().length() > edge
        });
        assert_eq!(part, 0.25);
    }
}
