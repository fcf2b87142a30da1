//! Distant light, visible in the background and in mirrors.

use crate::PreviewError;
use core::fmt;
use dapple_color::LinearRgb;
use glam::DVec3;

/// Distant light as a function of the direction. It fills the background and appears in mirrors, but does not light
/// objects.
///
/// Up is +y.
#[non_exhaustive]
pub enum Environment<'a> {
    /// One color in all directions.
    Constant(LinearRgb),
    /// A sky without a sun.
    Sky(Sky),
    /// A sky with a sun.
    Sun(Sky, Sun),
    /// Any function of a unit vector that points away from the scene.
    Function(Box<dyn Fn(DVec3) -> LinearRgb + Send + Sync + 'a>),
}

/// A sky whose color depends on the elevation above the horizon.
///
/// With `y` the sine of the elevation, the color above the horizon is interpolated by `y (2 - y)` from the horizon to
/// the zenith. Below the horizon, it is interpolated by the same factor of `-y` to the nadir.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// The color straight down.
    pub nadir: LinearRgb,
    /// The color at the horizon.
    pub horizon: LinearRgb,
    /// The color straight up.
    pub zenith: LinearRgb,
}

/// A disk in the sky with a glow around it. Both are added to the sky.
///
/// Angles are given as the chord between two unit vectors, which for small angles is the angle in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction to the sun. Any length except zero.
    pub toward: DVec3,
    /// The light of the disk. Values of 10 and more are realistic.
    pub color: LinearRgb,
    /// Radius of the disk as a chord, from 0 to 2. The real sun has 0.0047. The outer fifth fades out.
    pub radius: f64,
    /// The light of the glow at the center of the disk. At chord `c`, it is scaled by
    /// `1 / (1 + (c / glow_radius)²)²`.
    pub glow: LinearRgb,
    /// The chord at which the glow has fallen to a quarter, above zero.
    pub glow_radius: f64,
}

impl<'a> Environment<'a> {
    /// Creates an environment defined by a function of a unit vector that points away from the scene.
    #[must_use]
    pub fn function(light: impl Fn(DVec3) -> LinearRgb + Send + Sync + 'a) -> Self {
        Self::Function(Box::new(light))
    }

    /// Returns the light that arrives from `direction`, a unit vector that points away from the scene.
    #[must_use]
    pub fn light(&self, direction: DVec3) -> LinearRgb {
        match self {
            Self::Constant(color) => *color,
            Self::Sky(sky) => sky.light(direction),
            Self::Sun(sky, sun) => sky.light(direction) + sun.light(direction),
            Self::Function(light) => light(direction),
        }
    }

    pub(crate) fn check(&self) -> Result<(), PreviewError> {
        let Self::Sun(_, sun) = self else {
            return Ok(());
        };
        PreviewError::direction("direction to the sun", sun.toward)?;
        let holds = (0.0..=2.0).contains(&sun.radius);
        PreviewError::check(holds, "radius of the sun", sun.radius, "from 0 to 2")?;
        PreviewError::check_length("radius of the glow of the sun", sun.glow_radius)
    }
}

impl Sky {
    fn light(&self, direction: DVec3) -> LinearRgb {
        let sine = direction.y.clamp(-1.0, 1.0);
        let (end, part) = if sine < 0.0 {
            (self.nadir, -sine)
        } else {
            (self.zenith, sine)
        };
        self.horizon.lerp(end, (part * (2.0 - part)) as f32)
    }
}

impl Sun {
    fn light(&self, direction: DVec3) -> LinearRgb {
        let chord_sq = (direction - self.toward.normalize_or_zero()).length_squared();
        let far = chord_sq / (self.glow_radius * self.glow_radius);
        let glow = self.glow * (1.0 / ((1.0 + far) * (1.0 + far))) as f32;
        // Weight of the disk before smoothing: 1 within four fifths of the radius, 0 at the radius and beyond.
        let inside = ((self.radius - chord_sq.sqrt()) / (0.2 * self.radius)).clamp(0.0, 1.0);
        if inside > 0.0 {
            glow + self.color * (inside * inside * (3.0 - 2.0 * inside)) as f32
        } else {
            glow
        }
    }
}

impl fmt::Debug for Environment<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(color) => f.debug_tuple("Constant").field(color).finish(),
            Self::Sky(sky) => f.debug_tuple("Sky").field(sky).finish(),
            Self::Sun(sky, sun) => f.debug_tuple("Sun").field(sky).field(sun).finish(),
            Self::Function(_) => f.write_str("Function(..)"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Environment, Sky, Sun};
    use dapple_color::LinearRgb;
    use glam::DVec3;

    const SKY: Sky = Sky {
        nadir: LinearRgb::new(0.0, 0.0, 1.0),
        horizon: LinearRgb::new(1.0, 0.0, 0.0),
        zenith: LinearRgb::new(0.0, 1.0, 0.0),
    };

    #[test]
    fn sky_has_its_three_colors_at_their_heights() {
        let sky = Environment::Sky(SKY);
        assert_eq!(sky.light(DVec3::Y), SKY.zenith, "up");
        assert_eq!(sky.light(DVec3::X), SKY.horizon, "level");
        assert_eq!(sky.light(-DVec3::Y), SKY.nadir, "down");
    }

    #[test]
    fn sun_adds_its_disk_and_its_glow_where_it_stands() {
        let sun = Sun {
            toward: DVec3::new(0.0, 0.0, 3.0),
            color: LinearRgb::gray(8.0),
            radius: 0.1,
            glow: LinearRgb::gray(0.5),
            glow_radius: 2_f64.sqrt(),
        };
        let environment = Environment::Sun(SKY, sun);
        let middle = environment.light(DVec3::Z);
        assert_eq!(middle, SKY.horizon + LinearRgb::gray(8.5), "in the disk");
        // A quarter turn is a chord of √2, the radius of the glow, where a quarter is left up to rounding.
        let side = environment.light(DVec3::X);
        assert!((side.g - 0.125).abs() < 1e-6, "beside: {side:?}");
    }
}
