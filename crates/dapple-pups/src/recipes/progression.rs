//! Progressions from left to right (section 3.3): denser cows and giraffes (figures 15 and 16), and a label ramp
//! (figure 17).
//!
//! The recipes are [`cow`] and [`space_giraffe`] with a spacing or a probability that depends on x. Their domain wraps
//! from top to bottom only: on a torus, a progression from left to right would end in a step. The paper gives no
//! numbers. Here distances change geometrically, by equal ratios over equal lengths, so that the relative change is
//! uniform.

use crate::{
    CowOptions, LabelTexture, NetOptions, PupsError, PupsField, PupsRecipe, SpaceGiraffeOptions,
    Spacing, cow, space_giraffe,
};
use dapple_hash::Seed;
use dapple_points::Domain;
use dapple_raster::{Ramp, Varying};
use glam::DVec2;

/// Options for [`cow_progression`] and [`giraffe_progression`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ProgressionOptions {
    /// Domain of the control points [default: the square `[-1, 1]²`, which wraps along y only].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Minimum distances of points at the left and at the right, in units of the plane.
    ///
    /// Between the two sides, distances have equal ratios over equal lengths.
    pub distances: [f64; 2],
    /// Weighting of the control points.
    pub net: NetOptions,
}

/// Options for [`cow_progression`].
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(transparent)
)]
pub struct CowProgressionOptions(pub ProgressionOptions);

/// Options for [`giraffe_progression`].
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(transparent)
)]
pub struct GiraffeProgressionOptions(pub ProgressionOptions);

/// Options for [`label_ramp`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LabelRampOptions {
    /// Domain of the control points [default: the square `[-1, 1]²`, which wraps along y only].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the control points: minimum distance in units of the plane, density, or number of points.
    pub spacing: Spacing,
    /// Probabilities of white at the left and at the right, from 0 to 1, interpolated linearly.
    pub probabilities: [f64; 2],
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for ProgressionOptions {
    fn default() -> Self {
        Self {
            domain: cylinder(),
            distances: [0.2, 0.025],
            net: NetOptions::default(),
        }
    }
}

impl Default for LabelRampOptions {
    fn default() -> Self {
        Self {
            domain: cylinder(),
            spacing: Spacing::from(0.05),
            probabilities: [0.0, 1.0],
            net: NetOptions::default(),
        }
    }
}

/// Builds a cow whose patches become smaller to the right (figure 15).
///
#[cfg_attr(doc, doc = include_str!("../../docs/cow-progression.md"))]
///
/// # Errors
///
/// Same as [`cow`].
///
/// # Examples
///
/// ```
/// use dapple_pups::{ProgressionOptions, cow_progression, hash::Seed};
///
/// let texture = cow_progression(&ProgressionOptions::default(), Seed(7))?;
/// assert_eq!(texture.pups().domain().wrap, [false, true]);
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn cow_progression(
    options: &ProgressionOptions,
    seed: Seed,
) -> Result<LabelTexture, PupsError> {
    cow(&options.cow(), seed)
}

/// Builds a space giraffe whose spots become smaller to the right (figure 16).
///
#[cfg_attr(doc, doc = include_str!("../../docs/giraffe-progression.md"))]
///
/// # Errors
///
/// Same as [`space_giraffe`].
pub fn giraffe_progression(
    options: &ProgressionOptions,
    seed: Seed,
) -> Result<LabelTexture, PupsError> {
    space_giraffe(&options.giraffe(), seed)
}

/// Builds black and white cells. The fraction of white ones increases to the right (figure 17).
///
#[cfg_attr(doc, doc = include_str!("../../docs/label-ramp.md"))]
///
/// # Errors
///
/// Same as [`cow`].
pub fn label_ramp(options: &LabelRampOptions, seed: Seed) -> Result<LabelTexture, PupsError> {
    let cow_options = CowOptions {
        domain: options.domain,
        spacing: options.spacing.clone(),
        probability: Varying::Ramp(left_to_right(&options.domain, options.probabilities)),
        net: options.net.clone(),
        ..CowOptions::default()
    };
    cow(&cow_options, seed)
}

impl ProgressionOptions {
    /// Returns the spacing of the cow's points, or of the giraffe's spot centers.
    #[must_use]
    pub fn spacing(&self) -> Spacing {
        let ramp = left_to_right(&self.domain, self.distances);
        Spacing::Distance(Varying::GeometricRamp(ramp))
    }

    fn cow(&self) -> CowOptions {
        CowOptions {
            domain: self.domain,
            spacing: self.spacing(),
            net: self.net.clone(),
            ..CowOptions::default()
        }
    }

    fn giraffe(&self) -> SpaceGiraffeOptions {
        SpaceGiraffeOptions {
            domain: self.domain,
            spacing: self.spacing(),
            net: self.net.clone(),
            ..SpaceGiraffeOptions::default()
        }
    }
}

/// Returns the paper's square domain, wrapped from top to bottom only.
fn cylinder() -> Domain {
    Domain {
        wrap: [false, true],
        ..Domain::paper_torus()
    }
}

fn left_to_right(domain: &Domain, [start, end]: [f64; 2]) -> Ramp {
    Ramp {
        from: domain.origin,
        to: domain.origin + DVec2::new(domain.size.x, 0.0),
        start,
        end,
    }
}

impl PupsRecipe for CowProgressionOptions {
    net_of!(.0);

    fn expected_points(&self) -> f64 {
        self.0.cow().expected_points()
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(cow_progression(&self.0, seed)?))
    }
}

impl PupsRecipe for GiraffeProgressionOptions {
    net_of!(.0);

    fn expected_points(&self) -> f64 {
        self.0.giraffe().expected_points()
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(giraffe_progression(&self.0, seed)?))
    }
}

impl PupsRecipe for LabelRampOptions {
    net_of!(points);

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(label_ramp(self, seed)?))
    }
}
