//! Cross-sections of bumps, such as raised spots and inset channels.
//!
//! Worley makes "raised spots or inset channels" of F1 and of F2 − F1 ("A Cellular Texture Basis Function", SIGGRAPH
//! 1996, <https://doi.org/10.1145/237170.237267>), as is usual with noise. A profile converts such a value to a height.
//! Its slope times the gradient of the value is the gradient of the height, which perturbs a normal (James F. Blinn,
//! "Simulation of Wrinkled Surfaces", SIGGRAPH 1978, <https://doi.org/10.1145/965139.507101>). Both profiles are
//! smooth, so they add no creases to the normals.

use crate::{WorleyError, WorleyErrorKind};

/// Cross-section of bumps, which maps the value of a texture to a height.
///
/// # Examples
///
/// ```
/// use dapple_worley::{Combination, Profile, Worley3, hash::Seed};
///
/// let cracks = Worley3::new(Seed(7)).combine(Combination::F2_MINUS_F1);
/// let channels = Profile::channels(0.1)?;
/// let position = [0.5, 0.25, 3.0];
/// let height = channels.height(cracks.value(position));
/// let slope = f64::from(channels.slope(cracks.value(position)));
/// let gradient = cracks.gradient(position) * slope;
/// assert!((0.0..=1.0).contains(&height) && gradient.is_finite());
/// # Ok::<(), dapple_worley::WorleyError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum Profile {
    /// Dome: height 1 at the value 0, falling to height 0 at `radius`, by `(1 − (value / radius)²)²`.
    ///
    /// With F1, this gives a raised spot around every feature point.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/profile-spots.md"))]
    Spots {
        /// Radius of a spot, in units of the value, above 0.
        radius: f32,
    },
    /// Channel: height 0 at the value 0, rising to height 1 at `width`, by `3 t² − 2 t³` with `t = value / width`.
    ///
    /// With F2 − F1, this gives channels between raised stones; with F1, round pits.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/profile-channels.md"))]
    Channels {
        /// Half-width of a channel, in units of the value, above 0.
        width: f32,
    },
}

impl Profile {
    /// Creates raised spots with this radius.
    ///
    /// # Errors
    ///
    /// [`WorleyErrorKind::Range`] if the radius is not finite and above 0.
    pub fn spots(radius: f32) -> Result<Self, WorleyError> {
        check("radius of the spots", radius)?;
        Ok(Self::Spots { radius })
    }

    /// Creates inset channels with this half-width.
    ///
    /// # Errors
    ///
    /// [`WorleyErrorKind::Range`] if the width is not finite and above 0.
    pub fn channels(width: f32) -> Result<Self, WorleyError> {
        check("width of the channels", width)?;
        Ok(Self::Channels { width })
    }

    /// Checks the parameters of a profile that was deserialized or built without a constructor.
    ///
    /// # Errors
    ///
    /// [`WorleyErrorKind::Range`] if its radius or width is not finite and above 0.
    pub fn check(self) -> Result<(), WorleyError> {
        match self {
            Self::Spots { radius } => Self::spots(radius).map(drop),
            Self::Channels { width } => Self::channels(width).map(drop),
        }
    }

    /// Returns the height for a value of the texture, from 0 to 1.
    #[must_use]
    pub fn height(self, value: f32) -> f32 {
        match self {
            Self::Spots { radius } => {
                let t = (value / radius).clamp(-1.0, 1.0);
                (1.0 - t * t) * (1.0 - t * t)
            }
            Self::Channels { width } => {
                let t = (value / width).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            }
        }
    }

    /// Returns the derivative of the height with respect to the value.
    #[must_use]
    pub fn slope(self, value: f32) -> f32 {
        match self {
            Self::Spots { radius } => {
                let t = (value / radius).clamp(-1.0, 1.0);
                -4.0 * t * (1.0 - t * t) / radius
            }
            Self::Channels { width } => {
                let t = (value / width).clamp(0.0, 1.0);
                6.0 * t * (1.0 - t) / width
            }
        }
    }
}

fn check(what: &'static str, value: f32) -> Result<(), WorleyError> {
    if value > 0.0 && value.is_finite() && value.recip().is_finite() {
        return Ok(());
    }
    Err(WorleyError::new(WorleyErrorKind::Range {
        what,
        value: f64::from(value),
        range: "finite and above 0",
    }))
}
