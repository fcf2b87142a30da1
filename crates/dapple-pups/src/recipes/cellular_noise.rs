//! Cellular noise in layers (section 3.2, figure 10): cells of several sizes, summed.
//!
//! "We created 4 layers of cellular textures of increasing density and summed them; higher densities have lower
//! amplitude." The paper does not give the numbers; the defaults are those of equation 5.

use super::octaves::{check_series, expected_in_series};

use crate::{
    CellsOptions, LabelTexture, Layers, NetOptions, PupsError, PupsField, PupsRecipe, Spacing,
    cells,
};
use dapple_hash::Seed;
use dapple_points::Domain;

/// Options for [`cellular_noise`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CellularNoiseOptions {
    /// Domain of the control points, in which the texture repeats [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the first layer's control points: minimum distance in units of the plane, density, or number of
    /// points.
    pub spacing: Spacing,
    /// Number of layers, from 1 to 16.
    #[cfg_attr(feature = "schema", schemars(transform = { super::octaves::COUNT }))]
    pub layers: u32,
    /// Frequency ratio of successive layers, above 1 and at most 16.
    #[cfg_attr(feature = "schema", schemars(transform = { super::octaves::LACUNARITY }))]
    pub lacunarity: f64,
    /// Amplitude ratio of successive layers, above 0 and at most 1.
    #[cfg_attr(feature = "serde", serde(alias = "persistence"))]
    #[cfg_attr(feature = "schema", schemars(transform = { super::octaves::GAIN }))]
    pub gain: f64,
    /// Minimum and maximum number of control points per cell, from 1 to 16.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::assign::POINTS_PER_CELL }))]
    pub points_per_cell: [u32; 2],
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for CellularNoiseOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.4),
            layers: 4,
            lacunarity: 2.0,
            gain: 0.5,
            points_per_cell: [1, 1],
            net: NetOptions::randomly_oriented(),
        }
    }
}

/// Builds layers of [`cells`]. As a field, the result is their sum, which is between 0 and 1.875 by default.
///
#[cfg_attr(doc, doc = include_str!("../../docs/cellular-noise.md"))]
///
/// # Errors
///
/// Same as [`cells`], and [`Range`](crate::PupsErrorKind::Range) if an option is out of its range.
///
/// # Examples
///
/// ```
/// use dapple_pups::{CellularNoiseOptions, cellular_noise, glam::DVec2, hash::Seed, raster::FieldExt};
///
/// let texture = cellular_noise(&CellularNoiseOptions::default(), Seed(7))?.normalized();
/// assert!((0.0..=1.0).contains(&texture.sample(DVec2::new(0.25, -0.5))));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn cellular_noise(
    options: &CellularNoiseOptions,
    seed: Seed,
) -> Result<Layers<LabelTexture>, PupsError> {
    check_series(
        "number of layers",
        options.layers,
        options.lacunarity,
        options.gain,
    )?;
    let mut layers = Vec::with_capacity(options.layers as usize);
    let mut spacing = options.spacing.clone();
    // Each layer has its own points, spaced more closely by the lacunarity.
    for layer in 0..u64::from(options.layers) {
        let finer = spacing.finer(options.lacunarity);
        let options = CellsOptions {
            domain: options.domain,
            spacing,
            points_per_cell: options.points_per_cell,
            net: options.net.clone(),
        };
        layers.push(cells(&options, seed.child("layer", layer))?);
        spacing = finer;
    }
    Ok(Layers::geometric(layers, options.gain))
}

impl PupsRecipe for CellularNoiseOptions {
    net_of!();

    fn expected_points(&self) -> f64 {
        expected_in_series(&self.spacing, self.domain, self.layers, self.lacunarity)
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(cellular_noise(self, seed)?.normalized()))
    }
}
