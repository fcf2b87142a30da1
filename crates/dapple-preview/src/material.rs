//! The material of a surface at a point.
//!
//! Light is reflected after Lambert and, for highlights, after Blinn, "Models of Light Reflection for Computer
//! Synthesized Pictures", SIGGRAPH 1977, doi 10.1145/563858.563893: `color · light · (n·l)` and `specular · light ·
//! (n·h)^shininess`. There is no factor of π: white, lit perpendicularly by a light of 1, is 1. Mirrors may follow
//! Fresnel's law in the form of Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Computer Graphics
//! Forum 13(3), 1994, doi 10.1111/1467-8659.1330233.

use dapple_color::LinearRgb;
use glam::DVec3;

/// The material of a surface at a point.
///
/// A number that is not finite counts as zero, so that invalid texture values give a dark spot instead of NaN.
///
#[cfg_attr(doc, doc = include_str!("../docs/material.md"))]
///
/// # Examples
///
/// ```
/// use dapple_color::LinearRgb;
/// use dapple_preview::{Material, glam::DVec3};
///
/// let hide = Material::matte(LinearRgb::new(0.2, 0.4, 0.1))
///     .with_bump(DVec3::new(0.3, 0.0, 0.0))
///     .with_specular(0.3, 40.0);
/// assert_eq!(hide.shininess, 40.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The fraction of the light that is scattered, per channel, usually from 0 to 1.
    pub color: LinearRgb,
    /// The light that the surface emits. Default: black.
    pub emission: LinearRgb,
    /// The gradient of a height over the surface, as a vector in object space. Its length is the rise in height per
    /// unit of length. Its component along the normal has no effect. Default: zero, a smooth surface.
    pub bump: DVec3,
    /// The strength of highlights, at least 0. Default: 0.
    pub specular: f32,
    /// The exponent of highlights, at least 0: 10 is dull, 1000 is sharp. Default: 1.
    pub shininess: f32,
    /// The reflectance of the surface as a mirror. Default: none.
    pub mirror: Mirror,
}

/// Fraction of the light that is reflected specularly. The rest is scattered.
///
#[cfg_attr(doc, doc = include_str!("../docs/mirror.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Mirror {
    /// No mirror.
    #[default]
    None,
    /// A fraction, from 0 to 1, that does not depend on the angle.
    Constant(f32),
    /// Schlick's approximation. The number is the reflectance at perpendicular view, from 0 to 1; it rises to 1 at
    /// grazing angles. Water has 0.02.
    Fresnel(f32),
}

impl Material {
    /// Creates a material that only scatters light.
    #[must_use]
    pub fn matte(color: LinearRgb) -> Self {
        Self {
            color,
            emission: LinearRgb::BLACK,
            bump: DVec3::ZERO,
            specular: 0.0,
            shininess: 1.0,
            mirror: Mirror::None,
        }
    }

    /// Sets the gradient of the height over the surface.
    #[must_use]
    pub fn with_bump(self, bump: DVec3) -> Self {
        Self { bump, ..self }
    }

    /// Sets the strength and the exponent of highlights.
    #[must_use]
    pub fn with_specular(self, specular: f32, shininess: f32) -> Self {
        Self {
            specular,
            shininess,
            ..self
        }
    }

    /// Sets the mirror.
    #[must_use]
    pub fn with_mirror(self, mirror: Mirror) -> Self {
        Self { mirror, ..self }
    }

    /// Sets the emitted light.
    #[must_use]
    pub fn with_emission(self, emission: LinearRgb) -> Self {
        Self { emission, ..self }
    }

    /// Returns the material with zero in place of numbers that are not finite.
    pub(crate) fn cleaned(self) -> Self {
        Self {
            color: clean(self.color),
            emission: clean(self.emission),
            bump: if self.bump.is_finite() {
                self.bump
            } else {
                DVec3::ZERO
            },
            specular: finite(self.specular).max(0.0),
            shininess: finite(self.shininess).max(0.0),
            mirror: self.mirror,
        }
    }
}

impl Mirror {
    /// Returns the reflectance, from 0 to 1. `cosine` is the cosine of the angle between the normal and the direction
    /// to the eye.
    pub(crate) fn part(self, cosine: f64) -> f32 {
        match self {
            Self::None => 0.0,
            Self::Constant(part) => finite(part).clamp(0.0, 1.0),
            Self::Fresnel(straight) => {
                let straight = finite(straight).clamp(0.0, 1.0);
                let rest = (1.0 - cosine.clamp(0.0, 1.0)) as f32;
                let square = rest * rest;
                straight + (1.0 - straight) * (square * square * rest)
            }
        }
    }
}

fn finite(value: f32) -> f32 {
    if value.is_finite() { value } else { 0.0 }
}

/// Returns the color with zero in place of components that are not finite.
pub(crate) fn clean(color: LinearRgb) -> LinearRgb {
    color.to_array().map(finite).into()
}

#[cfg(test)]
mod tests {
    use super::Mirror;

    #[test]
    fn fresnel_is_its_number_seen_straight_and_one_at_a_slant() {
        assert_eq!(Mirror::Fresnel(0.02).part(1.0), 0.02, "straight");
        assert_eq!(Mirror::Fresnel(0.02).part(0.0), 1.0, "at a slant");
        // 0.5^5 = 1/32 is exact, and so are all other operations.
        assert_eq!(Mirror::Fresnel(0.5).part(0.5), 0.5 + 0.5 / 32.0, "between");
    }

    #[test]
    fn mirrors_that_are_not_numbers_are_none() {
        assert_eq!(Mirror::Constant(f32::NAN).part(0.5), 0.0, "NaN");
        assert_eq!(Mirror::Constant(7.0).part(0.5), 1.0, "more than all");
        assert_eq!(
            Mirror::Fresnel(f32::INFINITY).part(1.0),
            0.0,
            "infinitely much"
        );
    }
}
