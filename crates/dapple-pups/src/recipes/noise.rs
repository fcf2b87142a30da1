//! Noise (section 3.1): interpolated random values at Poisson-disk control points. One octave of figure 7.

use crate::{NetOptions, PupsError, PupsField, PupsRecipe, Spacing, Texture, random_values};
use dapple_hash::Seed;
use dapple_points::Domain;

/// Options for [`noise`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct NoiseOptions {
    /// Domain of the control points, in which the texture repeats [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the control points: minimum distance in units of the plane, density, or number of points.
    pub spacing: Spacing,
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for NoiseOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.1),
            net: NetOptions::default(),
        }
    }
}

/// Builds one octave of noise: a smooth field with values in `[0, 1]`, up to rounding in single precision.
///
#[cfg_attr(doc, doc = include_str!("../../docs/noise.md"))]
///
/// # Errors
///
/// [`Points`](crate::PupsErrorKind::Points) if points cannot be placed. If net options are invalid, same as
/// [`PupsOptions::check`](crate::PupsOptions::check).
///
/// # Examples
///
/// ```
/// use dapple_pups::{NoiseOptions, glam::DVec2, hash::Seed, noise, raster::FieldExt};
///
/// let texture = noise(&NoiseOptions::default(), Seed(7))?;
/// let position = DVec2::new(0.25, -0.5);
/// assert_eq!(texture.sample(position), texture.sample(position + DVec2::new(2.0, -2.0)));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn noise(options: &NoiseOptions, seed: Seed) -> Result<Texture, PupsError> {
    let points = options
        .net
        .points(&options.spacing, options.domain, seed.child("points", 0))?;
    let values = random_values(points.len(), seed.child("value", 0));
    options.net.pups(&points, seed)?.texture(values)
}

impl PupsRecipe for NoiseOptions {
    net_of!(points);

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(noise(self, seed)?))
    }
}
