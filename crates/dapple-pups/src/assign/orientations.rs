//! Orientations: unit vectors in 3-D that shift the weights of control points (equation 4).
//!
//! Random orientations are uniform on the sphere: by Archimedes' theorem, both the height in `[-1, 1]` and the azimuth
//! are uniform. Sines and cosines are `libm`'s, so the bits are the same on every machine.

use crate::PupsError;
use core::f64::consts::TAU;
use core::fmt;
use dapple_hash::{Seed, hash1, unit_f64};
use dapple_points::PointSet;
use dapple_raster::Varying;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Returns independent random unit vectors, uniform on the sphere.
#[must_use]
pub fn random_orientations(n_points: usize, seed: Seed) -> Vec<DVec3> {
    let vector = |index: i64| {
        // Draw the azimuth, in turns, and the height.
        let [turn, height] = [0, 1].map(|lane| unit_f64(hash1(seed, [index], lane)));
        let z = 2.0 * height - 1.0;
        let direction = DVec2::new(libm::cos(TAU * turn), libm::sin(TAU * turn));
        // The sphere's cross section at height z has the radius √(1 − z²).
        (direction * (1.0 - z * z).sqrt()).extend(z)
    };
    (0..n_points as i64).map(vector).collect()
}

/// Returns unit vectors in the plane that point away from `center`, along the shortest path across wrapped axes.
///
/// For a point at the center, the vector is the z axis, which has no direction in the plane.
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if the center is not finite.
pub fn outward_orientations(points: &PointSet, center: DVec2) -> Result<Vec<DVec3>, PupsError> {
    let finite = center.is_finite();
    PupsError::check(finite, "center", center.x + center.y, "finite")?;
    let domain = points.domain();
    let center = domain.wrap(center);
    let vector = |&position: &DVec2| {
        // Take the shortest vector from the center, across wrapped axes.
        let outward = domain.delta(center, position).normalize_or_zero();
        if outward == DVec2::ZERO {
            DVec3::Z
        } else {
            outward.extend(0.0)
        }
    };
    Ok(points.positions().iter().map(vector).collect())
}

/// Returns unit vectors in the plane at an angle that depends on the position. Angles are in radians, from the x axis
/// toward the y axis.
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if an angle is not finite.
pub fn angle_orientations(points: &PointSet, angle: &Varying) -> Result<Vec<DVec3>, PupsError> {
    let vector = |&position: &DVec2| {
        let angle = angle.at(position);
        PupsError::check(
            angle.is_finite(),
            "angle of an orientation",
            angle,
            "finite",
        )?;
        Ok(DVec3::new(libm::cos(angle), libm::sin(angle), 0.0))
    };
    points.positions().iter().map(vector).collect()
}

/// Evaluates `field` at the points. Its vectors may have any length but zero.
#[must_use]
pub fn field_orientations(points: &PointSet, field: impl Fn(DVec2) -> DVec3) -> Vec<DVec3> {
    points.positions().iter().map(|&at| field(at)).collect()
}

/// Orientations of a recipe's control points.
///
#[cfg_attr(doc, doc = include_str!("../../docs/orientations.md"))]
///
/// # Examples
///
/// ```
/// use dapple_pups::{CellsOptions, NetOptions, Orientations, cells, hash::Seed};
///
/// let net = NetOptions { orientations: Orientations::Angle(0.8.into()), ..NetOptions::default() };
/// let slanted = cells(&CellsOptions { net, ..CellsOptions::default() }, Seed(7))?;
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
#[derive(Clone, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Orientations {
    /// No orientations: the weights of equation 2.
    #[default]
    None,
    /// Independent random orientation for each point.
    ///
    /// See [`random_orientations`].
    Random,
    /// Same orientation for all points.
    Same(#[cfg_attr(feature = "schema", schemars(with = "[f64; 3]"))] DVec3),
    /// Orientations away from a center, in units of the plane.
    ///
    /// See [`outward_orientations`].
    AwayFrom(#[cfg_attr(feature = "schema", schemars(with = "[f64; 2]"))] DVec2),
    /// Orientations in the plane at an angle, in radians.
    ///
    /// See [`angle_orientations`].
    Angle(#[cfg_attr(feature = "schema", schemars(with = "crate::schema::Variable"))] Varying),
    /// Orientations as a function of the position.
    ///
    /// See [`field_orientations`].
    #[cfg_attr(feature = "serde", serde(skip))]
    Field(Arc<dyn Fn(DVec2) -> DVec3 + Send + Sync>),
}

impl Orientations {
    /// Returns the orientations of `points`: one vector for each point, a single vector for all, or `None` if there are
    /// no orientations.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PupsErrorKind::Range) if a center or an angle is not finite.
    pub fn vectors(&self, points: &PointSet, seed: Seed) -> Result<Option<Vec<DVec3>>, PupsError> {
        match self {
            Self::None => Ok(None),
            Self::Random => Ok(Some(random_orientations(points.len(), seed))),
            Self::Same(vector) => Ok(Some(vec![*vector])),
            Self::AwayFrom(center) => outward_orientations(points, *center).map(Some),
            Self::Angle(angle) => angle_orientations(points, angle).map(Some),
            Self::Field(field) => Ok(Some(field_orientations(points, |at| field(at)))),
        }
    }
}

impl fmt::Debug for Orientations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("None"),
            Self::Random => f.write_str("Random"),
            Self::Same(vector) => f.debug_tuple("Same").field(vector).finish(),
            Self::AwayFrom(center) => f.debug_tuple("AwayFrom").field(center).finish(),
            Self::Angle(angle) => f.debug_tuple("Angle").field(angle).finish(),
            Self::Field(_) => f.write_str("Field"),
        }
    }
}
