//! Cow (section 3.2, figure 11): control points with random binary labels.
//!
//! A varying spacing gives figure 15, a varying probability figure 17.

use crate::{LabelTexture, NetOptions, PupsError, PupsField, PupsRecipe, Spacing, biased_labels};
use dapple_hash::Seed;
use dapple_points::Domain;
use dapple_raster::Varying;

/// Options for [`cow`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CowOptions {
    /// Domain of the control points, in which the texture repeats [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the control points: minimum distance in units of the plane, density, or number of points.
    pub spacing: Spacing,
    /// Probability that a control point gets label 1, from 0 to 1.
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Variable"))]
    pub probability: Varying,
    /// Values of labels 0 and 1.
    ///
    /// The defaults are black (0) and white (1).
    pub values: [f32; 2],
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for CowOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.1),
            probability: Varying::Constant(0.5),
            values: [0.0, 1.0],
            net: NetOptions::default(),
        }
    }
}

/// Builds patches of two values, like a cow's coat.
///
#[cfg_attr(doc, doc = include_str!("../../docs/cow.md"))]
///
/// # Errors
///
/// [`Points`](crate::PupsErrorKind::Points) if points cannot be placed, [`Range`](crate::PupsErrorKind::Range) if a
/// probability is outside of `[0, 1]`. If net options are invalid, same as
/// [`PupsOptions::check`](crate::PupsOptions::check).
///
/// # Examples
///
/// ```
/// use dapple_pups::{CowOptions, cow, glam::DVec2, hash::Seed, raster::FieldExt};
///
/// let texture = cow(&CowOptions::default(), Seed(7))?;
/// assert!([0.0, 1.0].contains(&texture.sample(DVec2::new(0.25, -0.5))));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn cow(options: &CowOptions, seed: Seed) -> Result<LabelTexture, PupsError> {
    let points = options
        .net
        .points(&options.spacing, options.domain, seed.child("points", 0))?;
    // Section 3.2: each point gets one of two labels at random.
    let labels = biased_labels(&points, &options.probability, seed.child("label", 0))?;
    let pups = options.net.pups(&points, seed)?;
    LabelTexture::new(pups, labels, options.values.to_vec())
}

impl PupsRecipe for CowOptions {
    net_of!(points);

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(cow(self, seed)?))
    }
}
