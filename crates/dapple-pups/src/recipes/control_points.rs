//! Textures of control points that are given one by one.

use crate::{
    LabelTexture, NetOptions, Orientation, Orientations, Pups, PupsError, PupsErrorKind, PupsField,
    PupsOptions, PupsRecipe, own_labels,
};
use dapple_graph::delaunay;
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet};
use glam::{DVec2, DVec3};

/// Control points that are given one by one.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ControlPoints {
    /// Where the points lie, and after which distances the texture repeats.
    #[cfg_attr(feature = "serde", serde(skip, default = "Domain::paper_torus"))]
    pub domain: Domain,
    /// The points, in units of the plane.
    pub points: Vec<ControlPoint>,
    /// How they are weighted; where points have an orientation, `orientations` is not to be given.
    #[cfg_attr(feature = "serde", serde(default))]
    pub net: NetOptions,
    /// Whether the value of the strongest point counts alone; all count by default.
    #[cfg_attr(feature = "serde", serde(default))]
    pub cells: Cells,
}

/// Whether a texture of control points mixes their values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Cells {
    /// The weighted mean of the values.
    #[default]
    Mixed,
    /// The value of the control point with the largest weight.
    Hard,
}

/// A control point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ControlPoint {
    /// To the right, in units of the plane.
    pub x: f64,
    /// Down, in units of the plane.
    pub y: f64,
    /// The value of the texture there.
    pub value: f32,
    /// Where it is strong: a vector in the plane, of any length. All points have one, or none has.
    #[cfg_attr(
        feature = "serde",
        serde(default, skip_serializing_if = "Option::is_none")
    )]
    pub orientation: Option<[f64; 2]>,
}

impl Default for ControlPoints {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            points: Vec::new(),
            net: NetOptions::default(),
            cells: Cells::default(),
        }
    }
}

/// The values of control points, interpolated or as cells.
///
/// # Errors
///
/// [`NoPoints`](PupsErrorKind::NoPoints) if there are none, [`Points`](PupsErrorKind::Points) for points outside of the
/// domain, [`Conflict`](PupsErrorKind::Conflict) if only some points have an orientation, or the options give
/// orientations too, and what [`PupsOptions::check`] refuses.
pub fn control_points(options: &ControlPoints, seed: Seed) -> Result<PupsField, PupsError> {
    let given = options.points.iter();
    let positions = given.map(|point| DVec2::new(point.x, point.y)).collect();
    let points = PointSet::new(options.domain, positions)?;
    let values: Vec<f32> = options.points.iter().map(|point| point.value).collect();
    let net = &options.net;
    let pups = match options.orientations()? {
        Some(vectors) => {
            let options = PupsOptions {
                axis_scale: net.axis_scale,
                weight: net.weight,
                orientation: Some(Orientation::new(vectors).with_strength(net.strength)),
            };
            Pups::new(&points, &delaunay(&points)?, options)?
        }
        None => net.pups(&points, seed)?,
    };
    Ok(match options.cells {
        Cells::Mixed => PupsField::numbers(pups.texture(values)?),
        Cells::Hard => {
            PupsField::numbers(LabelTexture::new(pups, own_labels(values.len()), values)?)
        }
    })
}

impl ControlPoints {
    /// The orientations that the points have, if they have any.
    fn orientations(&self) -> Result<Option<Vec<DVec3>>, PupsError> {
        let given: Vec<_> = self.points.iter().filter_map(|p| p.orientation).collect();
        let conflict = |rule| Err(PupsError::new(PupsErrorKind::Conflict { rule }));
        if given.is_empty() {
            return Ok(None);
        }
        if given.len() != self.points.len() {
            return conflict("all points have an `orientation`, or none has");
        }
        if !matches!(self.net.orientations, Orientations::None) {
            return conflict("`orientations` are not given where the points have them");
        }
        let vectors = given.into_iter().map(|[x, y]| DVec3::new(x, y, 0.0));
        Ok(Some(vectors.collect()))
    }
}

impl PupsRecipe for ControlPoints {
    fn domain_mut(&mut self) -> &mut Domain {
        &mut self.domain
    }

    fn expected_points(&self) -> f64 {
        self.points.len() as f64
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        control_points(self, seed)
    }
}
