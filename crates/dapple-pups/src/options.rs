//! Options of a net of control points.

use crate::{AxialWeight, PupsError, Range, range};
use glam::DVec3;

/// Options for the weights of control points.
///
/// # Examples
///
/// ```
/// use dapple_pups::{Orientation, PupsOptions};
///
/// let figure_4b = PupsOptions { axis_scale: 2.0, ..PupsOptions::default() };
/// assert!(figure_4b.check(700).is_ok());
/// let too_short = PupsOptions { axis_scale: 0.5, ..PupsOptions::default() };
/// assert!(too_short.check(700).is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct PupsOptions {
    /// Length of every axis as a multiple of its edge: above ½, at most 16. The default is 1; figure 4b uses 2.
    ///
    /// Up to 1 the texture interpolates the values of its control points; above 1 it approximates them. The support of
    /// a control point is its Voronoi cell scaled by twice this number, so on average `4 · axis_scale²` control points
    /// have a weight at a position. At ½ the supports would be the Voronoi cells themselves, and at their borders no
    /// control point would have a weight.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/axis-scale.md"))]
    pub axis_scale: f64,
    /// Falloff of the weight along an axis. The default is the cubic of equation 1.
    pub weight: AxialWeight,
    /// Orientations, which shift weights by equation 4. The default is none.
    pub orientation: Option<Orientation>,
    /// Ratio of border length to edge length below which an axis fades, from 0 to 1. The default is 0, which disables
    /// fading; moving points use 0.25. The border of an axis is the side of its control point's Voronoi cell that
    /// crosses the axis.
    ///
    /// When points move, edges of the Delaunay triangulation appear and disappear, and their axes with them. An edge
    /// does so while the length of its border is zero. With `fade`, the axial weight has the exponent
    /// `min(1, border / (fade · edge))`. It removes the influence of the axis before the edge disappears, so the
    /// texture changes as little as its points move. Fading never gives a pixel a weight where it had none; it
    /// increases weights elsewhere, and the weights at a position still sum to 1. At a short border a weight ends
    /// steeply, but only between other axes, where it is almost zero. At 0.25, a position inside the border by a
    /// thousandth of its axis has a share below 1e-4; at 1, a share of up to 2 %. With a graph that is not the Delaunay
    /// graph, the cell is the polygon around the point that its own axes bound at half their length.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_never"))]
    pub fade: f64,
}

/// Value of [`fade`](PupsOptions::fade) for moving points, with which textures have no visible jumps.
pub(crate) const MOVING_FADE: f64 = 0.25;

/// Returns whether fading is disabled.
#[cfg(feature = "serde")]
#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde calls it like this"
)]
pub(crate) fn is_never(fade: &f64) -> bool {
    *fade == 0.0
}

/// Orientations of the control points, and how strongly they shift the weights (equation 4).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Orientation {
    /// Strength ε, in `[0, 1)`; 0.5 in the paper.
    ///
    /// Below ½ the gradient of the texture is continuous. From ½ on, the texture has a kink at the border of a support
    /// where the orientation points directly away from the control point. There the weight falls like
    /// `(1 − p)^(2 − 2ε)`. Near 1, weights on the opposite side and the denominator of equation 3 almost vanish. Where
    /// the denominator is below 1e-30, the value of the nearest control point is used.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/strength.md"))]
    pub strength: f64,
    /// One vector for each control point, or a single one for all. They are normalized. Components x and y are in the
    /// texture's plane. A z component reduces the strength without adding a direction.
    pub vectors: Vec<DVec3>,
}

impl Default for PupsOptions {
    fn default() -> Self {
        Self {
            axis_scale: 1.0,
            weight: AxialWeight::Cubic,
            orientation: None,
            fade: 0.0,
        }
    }
}

impl Orientation {
    /// Creates orientations with the paper's strength, 0.5.
    #[must_use]
    pub fn new(vectors: Vec<DVec3>) -> Self {
        Self {
            strength: 0.5,
            vectors,
        }
    }

    /// Replaces the strength of the orientations.
    #[must_use]
    pub fn with_strength(self, strength: f64) -> Self {
        Self { strength, ..self }
    }
}

/// Range of [`PupsOptions::axis_scale`]. At ½ or less, supports would not cover the plane.
pub(crate) const AXIS_SCALE: Range = range!(above 0.5 to 16);
/// Range of the strength ε in equation 4.
pub(crate) const STRENGTH: Range = range!(from 0 below 1);
/// Range of [`PupsOptions::fade`].
pub(crate) const FADE: Range = range!(from 0 to 1);
/// Range of the number of dips of an axial weight.
pub(crate) const DIPS: Range = range!(from 1 to 16);

impl PupsOptions {
    /// Checks the options for a texture of `n_points` control points.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PupsErrorKind::Range) if the axis scale is not in `(½, 16]`, if a parameter of the weight, the
    /// fade or the strength is out of its range, or if a vector has no length. [`Count`](crate::PupsErrorKind::Count)
    /// if the number of vectors is neither 1 nor the number of points.
    pub fn check(&self, n_points: usize) -> Result<(), PupsError> {
        PupsError::check_in(AXIS_SCALE, "axis scale", self.axis_scale)?;
        PupsError::check_in(FADE, "fade of the axes", self.fade)?;
        if let AxialWeight::Oscillating { dips, depth } = self.weight {
            PupsError::check_in(DIPS, "number of dips", dips.into())?;
            let holds = (0.0..=0.99).contains(&depth);
            PupsError::check(
                holds,
                "depth of the dips",
                f64::from(depth),
                "between 0 and 0.99",
            )?;
        }
        let Some(orientation) = &self.orientation else {
            return Ok(());
        };
        let strength = orientation.strength;
        PupsError::check_in(STRENGTH, "strength of the orientations", strength)?;
        let count = orientation.vectors.len();
        if count != 1 {
            PupsError::check_count("orientations", count, n_points)?;
        }
        for vector in &orientation.vectors {
            let length = vector.length();
            let holds = length > 0.0 && length.is_finite();
            PupsError::check(
                holds,
                "length of an orientation",
                length,
                "above 0 and finite",
            )?;
        }
        Ok(())
    }
}

impl Orientation {
    /// Maximum length of a shift (ε times an orientation). It ensures that no exponent of equation 4 divides by zero,
    /// even after rounding.
    const LONGEST_SHIFT: f64 = 1.0 - 1e-6;

    /// Returns the shift of control point `index`: the strength ε times its orientation in the plane.
    pub(crate) fn shift(&self, index: usize) -> [f32; 2] {
        let vector = self.vectors[if self.vectors.len() == 1 { 0 } else { index }];
        // Project the unit vector to the plane, and scale it by ε.
        let shift = vector.truncate() * (self.strength / vector.length());
        let length = shift.length();
        // K of equation 4 must stay above -1, where the exponent 1 / (1 + K) is unbounded.
        let shorten = if length > Self::LONGEST_SHIFT {
            Self::LONGEST_SHIFT / length
        } else {
            1.0
        };
        (shift * shorten).as_vec2().to_array()
    }
}
