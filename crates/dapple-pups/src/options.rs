//! Options of a net of control points.

use crate::{AxialWeight, PupsError, Range, range};
use glam::DVec3;

/// How the weights of control points are computed.
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
    /// The length of every axis as a multiple of its edge: above ½, at most 16; 1 by default, 2 in figure 4b.
    ///
    /// Up to 1 the texture passes through the values of its control points; above it approximates them. The support of
    /// a control point is its Voronoi cell scaled by twice this number, so on average `4 · axis_scale²` control points
    /// have a weight at a position. At ½ the supports would be the Voronoi cells themselves, and on their borders
    /// nothing would have a weight.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/axis-scale.md"))]
    pub axis_scale: f64,
    /// How the weight falls off along an axis; equation 1 by default.
    pub weight: AxialWeight,
    /// Orientations, which shift weights after equation 4; none by default.
    pub orientation: Option<Orientation>,
    /// How short the border that an axis leaves on the Voronoi cell of its control point is beside its edge when the axis
    /// begins to fade, from 0 to 1; 0 by default, which is never. For points that move it is 0.25.
    ///
    /// When points move, edges of a Delaunay triangulation appear and disappear, and with them axes, all at once. An edge
    /// does so while its border has no length. With `fade`, the axial weight has the exponent
    /// `min(1, border / (fade · edge))`, which takes the axis away before the edge disappears, so that a texture changes
    /// as little as its points move. A pixel has no weight where it had none, and elsewhere more than it had, so that the
    /// weights of a position still sum to 1. At a short border a weight ends steeply, but between other axes, at which it has all
    /// but ended: at 0.25, one that is a thousandth of its axis inside has a share below 1e-4, at 1 of up to 2 %. With a graph that is not the Delaunay graph, the cell is the polygon about
    /// the point that its own axes leave at half their length.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_never"))]
    pub fade: f64,
}

/// The [`fade`](PupsOptions::fade) at which textures of points that move have no jumps that one sees.
pub(crate) const MOVING_FADE: f64 = 0.25;

/// Whether no axis fades.
#[cfg(feature = "serde")]
#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde calls it like this"
)]
pub(crate) fn is_never(fade: &f64) -> bool {
    *fade == 0.0
}

/// The orientations of the control points, and how strongly they shift the weights (equation 4).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Orientation {
    /// ε, in `[0, 1)`; the paper's default is 0.5.
    ///
    /// Below ½ the texture keeps its continuous gradient. From ½ on it has a kink at the border of a support where the
    /// orientation points straight away from the control point: there the weight falls like `(1 − p)^(2 − 2ε)`. Near 1
    /// weights that look the other way all but vanish, and so does the denominator of equation 3: where it falls below
    /// 1e-30, the value of the nearest control point is taken.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/strength.md"))]
    pub strength: f64,
    /// One vector for each control point, or a single one for all. They are scaled to length 1; x and y lie in the
    /// plane of the texture, and z takes strength away without a direction.
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
    /// Orientations with the paper's default strength of 0.5.
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

/// Lengths of axes as multiples of their edges. From one half down, supports would not cover the plane.
pub(crate) const AXIS_SCALE: Range = range!(above 0.5 to 16);
/// ε of equation 4.
pub(crate) const STRENGTH: Range = range!(from 0 below 1);
/// Borders beside edges at which axes begin to fade.
pub(crate) const FADE: Range = range!(from 0 to 1);
/// Dips of an axial weight.
pub(crate) const DIPS: Range = range!(from 1 to 16);

impl PupsOptions {
    /// Refuses options that break a limit, for a texture of `n_points` control points.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PupsErrorKind::Range) if the axis scale is not in `(½, 16]`, a weight's parameters, the fade or the
    /// strength are outside of their ranges, or a vector has no length; [`Count`](crate::PupsErrorKind::Count) if the
    /// number of vectors is neither 1 nor that of the points.
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
    /// The largest length of a shift: with it no exponent of equation 4 divides by zero, even after rounding.
    const LONGEST_SHIFT: f64 = 1.0 - 1e-6;

    /// ε times the part of the orientation that lies in the plane, for point `index`.
    pub(crate) fn shift(&self, index: usize) -> [f32; 2] {
        let vector = self.vectors[if self.vectors.len() == 1 { 0 } else { index }];
        let shift = vector.truncate() * (self.strength / vector.length());
        let length = shift.length();
        let shorten = if length > Self::LONGEST_SHIFT {
            Self::LONGEST_SHIFT / length
        } else {
            1.0
        };
        (shift * shorten).as_vec2().to_array()
    }
}
