//! Builds textures from an explicit list of control points.

use crate::{
    LabelTexture, NetOptions, Orientation, Orientations, PupsError, PupsErrorKind, PupsField,
    PupsRecipe, Range, own_labels, range,
};
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet};
use glam::{DVec2, DVec3};

/// Texture of control points that are given one by one.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ControlPoints {
    /// Domain of the points, which sets the periods of the texture.
    #[cfg_attr(feature = "serde", serde(skip, default = "Domain::paper_torus"))]
    pub domain: Domain,
    /// Control points, in units of the plane.
    pub points: Vec<ControlPoint>,
    /// Values of the labels, from label 0 on.
    #[cfg_attr(
        feature = "serde",
        serde(default, skip_serializing_if = "Vec::is_empty")
    )]
    pub values: Vec<f32>,
    /// Weighting of the control points. `orientations` must not be set if the points have orientations.
    #[cfg_attr(feature = "serde", serde(default))]
    pub net: NetOptions,
    /// Combination of the values: the weighted mean, or the value of the point with the largest weight.
    #[cfg_attr(feature = "serde", serde(default))]
    pub cells: Cells,
    /// Whether the texture repeats along each axis, x first.
    ///
    /// The texture repeats only along axes along which the domain wraps, too.
    #[cfg_attr(
        feature = "serde",
        serde(default = "both_wrap", skip_serializing_if = "is_both_wrap")
    )]
    pub wrap: [bool; 2],
    /// Permitted distance of points outside of the tile, along each axis that does not repeat, in units of the plane.
    #[cfg_attr(
        feature = "serde",
        serde(default, skip_serializing_if = "is_no_margin")
    )]
    #[cfg_attr(feature = "schema", schemars(transform = { MARGIN }))]
    pub margin: [f64; 2],
}

/// Valid width of the margin around the domain in which points are permitted.
const MARGIN: Range = range!(at least 0);

#[cfg(feature = "serde")]
fn both_wrap() -> [bool; 2] {
    [true; 2]
}

#[cfg(feature = "serde")]
fn is_both_wrap(wrap: &[bool; 2]) -> bool {
    *wrap == [true; 2]
}

#[cfg(feature = "serde")]
fn is_no_margin(margin: &[f64; 2]) -> bool {
    *margin == [0.0; 2]
}

/// Combination of the values of control points at a position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Cells {
    /// Weighted mean of the values.
    #[default]
    Mixed,
    /// Value of the control point with the largest weight.
    Hard,
}

/// Control point with a value, or with a label that stands for a shared value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ControlPoint {
    /// X coordinate, to the right, in units of the plane.
    pub x: f64,
    /// Y coordinate, down, in units of the plane.
    pub y: f64,
    /// Value of the texture at the point; cannot be combined with `label`.
    #[cfg_attr(
        feature = "serde",
        serde(
            default,
            skip_serializing_if = "Option::is_none",
            deserialize_with = "number"
        )
    )]
    pub value: Option<f32>,
    /// Index of the point's value in the `values` of labels, from 0.
    #[cfg_attr(
        feature = "serde",
        serde(default, skip_serializing_if = "Option::is_none")
    )]
    pub label: Option<u32>,
    /// Direction in which the point is strong: a vector `[x, y]` or `[x, y, z]` of any length. All points have an
    /// orientation, or none has.
    ///
    /// The z component reduces the strength without adding a direction.
    #[cfg_attr(
        feature = "serde",
        serde(default, skip_serializing_if = "Option::is_none", with = "orientation")
    )]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<crate::schema::Direction>")
    )]
    pub orientation: Option<DVec3>,
}

/// Deserializes a number. `null` is an error, since JSON represents numbers that are not finite by `null`.
#[cfg(feature = "serde")]
fn number<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<f32>, D::Error> {
    <f32 as serde::Deserialize>::deserialize(deserializer).map(Some)
}

impl Default for ControlPoints {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            points: Vec::new(),
            values: Vec::new(),
            net: NetOptions::default(),
            cells: Cells::default(),
            wrap: [true; 2],
            margin: [0.0; 2],
        }
    }
}

/// Builds a texture from an explicit list of control points, either interpolated or as cells.
///
/// # Errors
///
/// * [`NoPoints`](PupsErrorKind::NoPoints) without points
/// * [`Points`](PupsErrorKind::Points) if a point is outside of the domain
/// * [`Conflict`](PupsErrorKind::Conflict) if only some points have an orientation, if the options have orientations,
///   too, or if a point does not have exactly one of value and label
/// * [`Count`](PupsErrorKind::Count) if a label has no value
/// * same as [`PupsOptions::check`](crate::PupsOptions::check) if the net options are invalid
pub fn control_points(options: &ControlPoints, seed: Seed) -> Result<PupsField, PupsError> {
    let points = options.point_set()?;
    let net = &options.net;
    // Use the points' own orientations if they have any, else the orientations from the net's options.
    let pups = match options.orientations()? {
        Some(vectors) => {
            let orientation = Orientation::new(vectors).with_strength(net.strength);
            let graph = net.delaunay(&points)?;
            net.of_delaunay(&points, &graph, Some(orientation), seed)?
        }
        None => net.pups(&points, seed)?,
    };
    // The texture has hard cells with shared labels only if every point has a label.
    let numbers = options.numbers()?;
    let labels: Option<Vec<u32>> = options.points.iter().map(|point| point.label).collect();
    Ok(match (options.cells, labels) {
        (Cells::Mixed, _) => PupsField::numbers(pups.texture(numbers)?),
        (Cells::Hard, Some(labels)) => {
            let values = options.values.clone();
            PupsField::numbers(LabelTexture::new(pups, labels, values)?)
        }
        (Cells::Hard, None) => {
            let labels = own_labels(numbers.len());
            PupsField::numbers(LabelTexture::new(pups, labels, numbers)?)
        }
    })
}

impl ControlPoints {
    /// Returns the positions of the points, in order, with their domain.
    fn point_set(&self) -> Result<PointSet, PupsError> {
        let positions = self.points.iter().map(|point| DVec2::new(point.x, point.y));
        Ok(PointSet::new(self.points_domain()?, positions.collect())?)
    }

    /// Returns the domain of the points: the options' domain, extended by the margin. It wraps along the axes on which
    /// the texture repeats.
    fn points_domain(&self) -> Result<Domain, PupsError> {
        for margin in self.margin {
            PupsError::check_in(MARGIN, "margin of the control points", margin)?;
        }
        let wrap = [0, 1].map(|axis| self.domain.wrap[axis] && self.wrap[axis]);
        let domain = Domain {
            wrap,
            ..self.domain
        };
        Ok(domain.grown(self.margin.into()))
    }

    /// Returns the value of each point: its individual value, or the value of its label.
    fn numbers(&self) -> Result<Vec<f32>, PupsError> {
        // A point has either its own value or its label's value.
        let number = |point: &ControlPoint| match (point.value, point.label) {
            (Some(value), None) => Ok(value),
            (None, Some(label)) => {
                let missing = PupsErrorKind::Count {
                    what: "values of labels",
                    count: self.values.len(),
                    needed: (label as usize).saturating_add(1),
                };
                let value = self.values.get(label as usize).copied();
                value.ok_or_else(|| PupsError::new(missing))
            }
            _ => {
                let rule = "a control point has either a `value` or a `label`";
                Err(PupsError::new(PupsErrorKind::Conflict { rule }))
            }
        };
        self.points.iter().map(number).collect()
    }

    /// Returns the points' orientations; `None` if no point has one.
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
        Ok(Some(given))
    }
}

/// Serializes orientations as two or three numbers.
#[cfg(feature = "serde")]
mod orientation {
    use glam::DVec3;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    #[expect(clippy::ref_option, reason = "serde calls it like this")]
    pub(super) fn serialize<S: Serializer>(
        orientation: &Option<DVec3>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match orientation {
            Some(vector) if vector.z == 0.0 => [vector.x, vector.y].serialize(serializer),
            Some(vector) => vector.to_array().serialize(serializer),
            None => serializer.serialize_none(),
        }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<DVec3>, D::Error> {
        match Option::<Vec<f64>>::deserialize(deserializer)?.as_deref() {
            None => Ok(None),
            Some(&[x, y]) => Ok(Some(DVec3::new(x, y, 0.0))),
            Some(&[x, y, z]) => Ok(Some(DVec3::new(x, y, z))),
            Some(numbers) => {
                let expected = &"two or three numbers for an orientation";
                Err(D::Error::invalid_length(numbers.len(), expected))
            }
        }
    }
}

impl PupsRecipe for ControlPoints {
    net_of!();

    fn expected_points(&self) -> f64 {
        self.points.len() as f64
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        control_points(self, seed)
    }
}
